//! Smooth to flat: polygons extruded and revolved.
