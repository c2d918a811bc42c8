//! The operations of free formulas: those of fidget and libfive, under the names that their text format has.

use super::real::Real;

/// An operation on one number. Angles are radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// -a.
    Neg,
    /// |a|.
    Abs,
    /// 1 / a.
    Recip,
    /// The square root; NaN of negative numbers.
    Sqrt,
    /// The cube root.
    Cbrt,
    /// a^2.
    Square,
    /// The greatest whole number not above.
    Floor,
    /// The least whole number not below.
    Ceil,
    /// The nearest whole number, halves away from zero.
    Round,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Arc sine; NaN beyond 1.
    Asin,
    /// Arc cosine; NaN beyond 1.
    Acos,
    /// Arc tangent.
    Atan,
    /// e^a.
    Exp,
    /// Natural logarithm; NaN of negative numbers.
    Ln,
    /// 1 where a is zero, otherwise 0.
    Not,
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// a + b.
    Add,
    /// a - b.
    Sub,
    /// a b.
    Mul,
    /// a / b.
    Div,
    /// The angle of the point (b, a), in radians.
    Atan2,
    /// The lesser; NaN where either is.
    Min,
    /// The greater; NaN where either is.
    Max,
    /// -1, 0 or 1 as a is less than, equal to or greater than b.
    Compare,
    /// The least remainder of a / b that is not negative.
    Mod,
    /// a^b, as C's `pow`.
    Pow,
    /// a where a is zero, otherwise b.
    And,
    /// a where a is not zero, otherwise b.
    Or,
}

impl Unary {
    /// All of them.
    pub const ALL: [Unary; 18] = [
        Unary::Neg,
        Unary::Abs,
        Unary::Recip,
        Unary::Sqrt,
        Unary::Cbrt,
        Unary::Square,
        Unary::Floor,
        Unary::Ceil,
        Unary::Round,
        Unary::Sin,
        Unary::Cos,
        Unary::Tan,
        Unary::Asin,
        Unary::Acos,
        Unary::Atan,
        Unary::Exp,
        Unary::Ln,
        Unary::Not,
    ];

    /// Its name in texts.
    pub fn name(self) -> &'static str {
        match self {
            Unary::Neg => "neg",
            Unary::Abs => "abs",
            Unary::Recip => "recip",
            Unary::Sqrt => "sqrt",
            Unary::Cbrt => "cbrt",
            Unary::Square => "square",
            Unary::Floor => "floor",
            Unary::Ceil => "ceil",
            Unary::Round => "round",
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "asin",
            Unary::Acos => "acos",
            Unary::Atan => "atan",
            Unary::Exp => "exp",
            Unary::Ln => "ln",
            Unary::Not => "not",
        }
    }

    /// The operation of this name.
    pub fn from_name(name: &str) -> Option<Unary> {
        Unary::ALL.into_iter().find(|op| op.name() == name)
    }

    #[inline(always)]
    pub(super) fn apply<T: Real>(self, a: T) -> T {
        match self {
            Unary::Neg => -a,
            Unary::Abs => a.abs(),
            Unary::Recip => a.recip(),
            Unary::Sqrt => a.sqrt(),
            Unary::Cbrt => a.cbrt(),
            Unary::Square => a.square(),
            Unary::Floor => a.floor(),
            Unary::Ceil => a.ceil(),
            Unary::Round => a.round(),
            Unary::Sin => a.sin(),
            Unary::Cos => a.cos(),
            Unary::Tan => a.tan(),
            Unary::Asin => a.asin(),
            Unary::Acos => a.acos(),
            Unary::Atan => a.atan(),
            Unary::Exp => a.exp(),
            Unary::Ln => a.ln(),
            Unary::Not => a.not(),
        }
    }
}

impl Binary {
    /// All of them.
    pub const ALL: [Binary; 12] = [
        Binary::Add,
        Binary::Sub,
        Binary::Mul,
        Binary::Div,
        Binary::Atan2,
        Binary::Min,
        Binary::Max,
        Binary::Compare,
        Binary::Mod,
        Binary::Pow,
        Binary::And,
        Binary::Or,
    ];

    /// Its name in texts.
    pub fn name(self) -> &'static str {
        match self {
            Binary::Add => "add",
            Binary::Sub => "sub",
            Binary::Mul => "mul",
            Binary::Div => "div",
            Binary::Atan2 => "atan2",
            Binary::Min => "min",
            Binary::Max => "max",
            Binary::Compare => "compare",
            Binary::Mod => "mod",
            Binary::Pow => "pow",
            Binary::And => "and",
            Binary::Or => "or",
        }
    }

    /// The operation of this name.
    pub fn from_name(name: &str) -> Option<Binary> {
        Binary::ALL.into_iter().find(|op| op.name() == name)
    }

    #[inline(always)]
    pub(super) fn apply<T: Real>(self, a: T, b: T) -> T {
        match self {
            Binary::Add => a + b,
            Binary::Sub => a - b,
            Binary::Mul => a * b,
            Binary::Div => a / b,
            Binary::Atan2 => a.atan2(b),
            Binary::Min => a.min(b),
            Binary::Max => a.max(b),
            Binary::Compare => a.compare(b),
            Binary::Mod => a.modulo(b),
            Binary::Pow => a.pow(b),
            Binary::And => a.and(b),
            Binary::Or => a.or(b),
        }
    }
}

/// How the edge between two shapes is filled. The radius is that of the fillet where the shapes meet at a right angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blend {
    /// A parabola: smooth wherever both shapes are, no steeper than they. The radius is that of its sharpest
    /// curvature, in the middle; it reaches sqrt 2 times as far, and swells two coincident surfaces by
    /// sqrt 2 / 4 times the radius. (Quilez, Smooth minimum, 2013, quadratic.)
    Quadratic {
        /// In model units.
        radius: f64,
    },
    /// An arc of a circle, which reaches as far as its radius; its slope grows up to sqrt 2 times where
    /// the gradients of the shapes agree. (Mercury, hg_sdf, 2015.)
    Circular {
        /// In model units.
        radius: f64,
    },
    /// A flat face at equal angles to both, cutting each at this distance from the edge; its slope grows up to
    /// sqrt 2 times.
    Chamfer {
        /// In model units.
        distance: f64,
    },
}

impl Blend {
    /// The lesser of two numbers, with the edge filled.
    #[inline(always)]
    pub(super) fn min<T: Real>(self, a: T, b: T) -> T {
        match self {
            Blend::Quadratic { radius } => {
                let (reach, difference) = (Blend::quadratic_reach(radius), a - b);
                let filled =
                    (a + b) * T::of(0.5) - (difference.square() + T::of(reach * reach)) * T::of(0.25 / reach);
                (difference.abs() - T::of(reach)).spliced(filled, a.min(b))
            }
            Blend::Circular { radius } => {
                let r = T::of(radius);
                (a.max(b) - r).spliced(r - T::norm([r - a, r - b]), a.min(b))
            }
            Blend::Chamfer { distance } => {
                let cut = (a + b - T::of(distance)) * T::of(std::f64::consts::FRAC_1_SQRT_2);
                a.min(b).min(cut)
            }
        }
    }

    /// How far the values of the arms may be apart and still blend.
    pub(super) fn quadratic_reach(radius: f64) -> f64 {
        std::f64::consts::SQRT_2 * radius
    }

    pub(crate) fn kind(self) -> u64 {
        match self {
            Blend::Quadratic { .. } => 0,
            Blend::Circular { .. } => 1,
            Blend::Chamfer { .. } => 2,
        }
    }

    /// The radius or distance.
    pub fn size(self) -> f64 {
        match self {
            Blend::Quadratic { radius } | Blend::Circular { radius } => radius,
            Blend::Chamfer { distance } => distance,
        }
    }
}
