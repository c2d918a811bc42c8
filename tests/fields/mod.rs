//! What the tests of fields share: cells, points in them, random formulas, and shapes of every kind.

#![allow(dead_code)] // Each test uses its part.

use ogee::math::{Aabb, Vec3};
use ogee::sdf::{Binary, Blend, Expr, Field, Periodic, Primitive, Tape, Unary};
use proptest::prelude::*;
use std::sync::OnceLock;

/// A box to sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) corner: Vec3,
    pub(crate) size: Vec3,
    pub(crate) seed: u64,
}

impl Cell {
    pub(crate) fn aabb(self) -> Aabb {
        Aabb { min: self.corner, max: self.corner + self.size }
    }
}

/// The corners of the cell and random points in it.
pub(crate) fn points_in(cell: Cell, random: usize) -> Vec<Vec3> {
    let Aabb { min, max } = cell.aabb();
    let corner =
        |i: usize| Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 0 { min[k] } else { max[k] }));
    let mut state = cell.seed | 1;
    let mut unit = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let inside = (0..random).map(|_| (min + cell.size * Vec3::new(unit(), unit(), unit())).clamp(min, max));
    let inside: Vec<Vec3> = inside.collect();
    (0..8).map(corner).chain(inside).collect()
}

/// The same number, or NaN both.
pub(crate) fn same_bits(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

fn leaf() -> impl Strategy<Value = Expr> {
    let number = prop_oneof![-4.0..4.0_f64, prop::sample::select(vec![0.0, 1.0, -1.0, 0.5, 2.0, 3.0, 1e-3])];
    prop_oneof![3 => (0..3_usize).prop_map(|axis| Expr::axes()[axis].clone()), 1 => number.prop_map(Expr::constant)]
}

/// Formulas with all operations.
pub(crate) fn expression() -> impl Strategy<Value = Expr> {
    leaf().prop_recursive(5, 40, 2, |inner| {
        let unary = prop::sample::select(Unary::ALL.to_vec());
        let binary = prop::sample::select(Binary::ALL.to_vec());
        let frequent =
            prop::sample::select(vec![Binary::Add, Binary::Sub, Binary::Mul, Binary::Min, Binary::Max]);
        let blend = prop::sample::select(vec![
            Blend::Quadratic { radius: 0.3 },
            Blend::Circular { radius: 0.4 },
            Blend::Chamfer { distance: 0.2 },
        ]);
        prop_oneof![
            4 => (unary, inner.clone()).prop_map(|(op, a)| Expr::unary(op, &a)),
            2 => (binary, inner.clone(), inner.clone()).prop_map(|(op, a, b)| Expr::binary(op, &a, &b)),
            4 => (frequent, inner.clone(), inner.clone()).prop_map(|(op, a, b)| Expr::binary(op, &a, &b)),
            1 => (blend, inner.clone(), inner.clone()).prop_map(|(blend, a, b)| a.blend_min(&b, blend)),
            1 => (inner.clone(), inner.clone()).prop_map(|(a, b)| Expr::norm2(&a, &b)),
            1 => (inner.clone(), inner.clone()).prop_map(|(a, b)| Expr::corner2(&a, &b)),
            1 => (inner.clone(), inner.clone(), inner).prop_map(|(a, b, c)| a.at([b.clone(), c, b])),
        ]
    })
}

/// Every primitive.
pub(crate) fn primitives() -> Vec<(&'static str, Primitive)> {
    let half = Vec3::new(1.0, 0.6, 0.4);
    let periodic = |kind| Primitive::Periodic { kind, period: 1.5 };
    vec![
        ("sphere", Primitive::Sphere { radius: 0.8 }),
        ("ellipsoid", Primitive::Ellipsoid { radii: half }),
        ("cuboid", Primitive::Cuboid { half }),
        ("rounded cuboid", Primitive::RoundedCuboid { half, radius: 0.25 }),
        ("cylinder", Primitive::Cylinder { radius: 0.7, half_height: 0.5, rounding: 0.0 }),
        ("rounded cylinder", Primitive::Cylinder { radius: 0.7, half_height: 0.5, rounding: 0.2 }),
        ("capsule", Primitive::Capsule { half_length: 0.6, radius: 0.3 }),
        ("torus", Primitive::Torus { major: 0.8, minor: 0.25 }),
        ("octahedron", Primitive::Octahedron { radius: 0.9 }),
        ("gyroid", periodic(Periodic::Gyroid)),
        ("p", periodic(Periodic::SchwarzP)),
        ("diamond", periodic(Periodic::Diamond)),
        ("neovius", periodic(Periodic::Neovius)),
        ("i-wp", periodic(Periodic::Iwp)),
        ("blob", Primitive::Blob { radius: 0.7, weight: 1.5 }),
    ]
}

/// A field of every kind, made once.
pub(crate) fn zoo() -> impl Iterator<Item = (&'static str, &'static dyn Field)> {
    static ZOO: OnceLock<Vec<(&'static str, Tape)>> = OnceLock::new();
    let zoo = ZOO.get_or_init(|| {
        primitives().into_iter().map(|(name, p)| (name, Expr::primitive(p).compile())).collect()
    });
    zoo.iter().map(|(name, tape)| (*name, tape as &dyn Field))
}

/// How many cases: so many, times what the environment asks for.
pub(crate) fn cases(usual: u32) -> u32 {
    usual * std::env::var("OGEE_TEST_SCALE").ok().and_then(|scale| scale.parse().ok()).unwrap_or(1)
}
