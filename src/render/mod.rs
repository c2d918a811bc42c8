//! Solids to pictures.
