//! Finding by place.
