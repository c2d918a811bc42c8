//! Convex hulls in space.
