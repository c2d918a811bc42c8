//! A modelling kernel for curves, surfaces and CSG.
//!
//! Recipes ([`csg::Csg`]) of solids and plane regions, written in Rust or read from a script, become closed
//! two-manifold triangle meshes ([`mesh::Solid`]). Booleans decide everything by exact signs and round only the
//! positions they hand out.
//!
//! ```
//! use ogee::boolean;
//! use ogee::math::Vec3;
//! use ogee::mesh::cuboid;
//!
//! let block = cuboid(Vec3::ZERO, Vec3::splat(2.0));
//! let corner = cuboid(Vec3::splat(1.0), Vec3::splat(3.0));
//! let notched = boolean::difference(&block, &corner).solid;
//!
//! let mut obj = Vec::new();
//! ogee::io::obj::write(notched.mesh(), &mut obj)?;
//! # Ok::<(), ogee::io::WriteError>(())
//! ```
//!
//! # Conventions
//!
//! - Space is right-handed. Triangles run counter-clockwise seen from outside, so normals point outward; contours of
//!   plane regions run counter-clockwise around the inside and clockwise around holes.
//! - Lengths are in the model's own units. Angles are radians in the library and degrees in scripts.
//! - Indices start at 0; corners, sides and half-edges of a triangle are numbered in winding order.
//! - Numbers are `f64` inside; `f32` appears only in file formats and pictures.
//! - Topology rests on exact signs, never on the sign of a rounded number. Positions are rounded once, on leaving.
//! - Every approximation takes its tolerance as an argument and hands back the error it achieved.
//! - The same input gives the same bits, on any number of threads and on every platform.
//! - Wrong input is a typed error that holds the numbers; a panic is a bug. The library prints nothing.
//!
//! # Map
//!
//! Modules stand in reading order, ground first, and use only modules above them; verbs do not use each other.
//! `tests/tidy.rs` holds the code to it.
//!
//! | layer | modules |
//! |---|---|
//! | ground | [`math`], [`par`], [`numeric`] |
//! | nouns | [`spatial`], [`curve`], [`polygon`], [`mesh`], [`sdf`], [`surface`] |
//! | verbs | [`tessellate`], [`isosurface`], [`boolean`], [`hull`], [`simplify`] |
//! | worlds | [`csg`] recipe to solid, [`io`] values and bytes, [`plot`] curves and data to figures, [`render`] solids to pictures, [`script`] text to recipe |
//! | shell | `cli`, `main.rs`: paths, clock, environment, terminal; only in the program |

// ground
pub mod math;
pub mod numeric;
pub mod par;

// nouns
pub mod curve;
pub mod mesh;
pub mod polygon;
pub mod sdf;
pub mod spatial;
pub mod surface;

// verbs
pub mod boolean;
pub mod hull;
pub mod isosurface;
pub mod simplify;
pub mod tessellate;

// worlds
pub mod csg;
pub mod io;
pub mod plot;
pub mod render;
pub mod script;

// shell
#[cfg(feature = "cli")]
pub mod cli;

/// The code in README.md, compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
