use super::Surface;
use crate::math::{Aabb, Vec3};

/// A side of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Smallest v, along u.
    Bottom,
    /// Largest v.
    Top,
    /// Smallest u, along v.
    Left,
    /// Largest u.
    Right,
}

impl Side {
    /// All sides; bottom and top, left and right are opposite.
    pub const ALL: [Side; 4] = [Side::Bottom, Side::Top, Side::Left, Side::Right];

    /// The axis of the parameter that varies along the side: 0 for u.
    pub fn axis(self) -> usize {
        usize::from(matches!(self, Side::Left | Side::Right))
    }

    /// The parameters of the side at `t` of its own axis.
    pub fn at(self, domain: [[f64; 2]; 2], t: f64) -> [f64; 2] {
        match self {
            Side::Bottom => [t, domain[1][0]],
            Side::Top => [t, domain[1][1]],
            Side::Left => [domain[0][0], t],
            Side::Right => [domain[0][1], t],
        }
    }
}

/// How two opposite sides of a domain lie together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gluing {
    /// They do not.
    #[default]
    Open,
    /// They are one curve, run the same way.
    Closed,
    /// They are one curve, run opposite ways, as of a Moebius strip.
    Twisted,
}

/// How the sides of a domain lie together in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sides {
    /// The sides of smallest and largest u.
    pub u: Gluing,
    /// The sides of smallest and largest v.
    pub v: Gluing,
    /// Which sides are a single point, in the order of [`Side::ALL`].
    pub poles: [bool; 4],
}

impl Sides {
    /// Nothing lies together.
    pub const OPEN: Sides = Sides { u: Gluing::Open, v: Gluing::Open, poles: [false; 4] };

    /// What lies together up to a distance, as far as points at 33 parameters of each side tell.
    pub fn found<S: Surface + ?Sized>(surface: &S, within: f64) -> Sides {
        const SAMPLES: usize = 33;
        let domain = surface.domain();
        let samples = Side::ALL.map(|side| {
            let [low, high] = domain[side.axis()];
            let at = |k: usize| {
                let share = k as f64 / (SAMPLES - 1) as f64;
                let [u, v] = side.at(domain, low * (1.0 - share) + high * share);
                surface.point(u, v)
            };
            (0..SAMPLES).map(at).collect::<Vec<Vec3>>()
        });
        let near = |(p, q): (&Vec3, &Vec3)| p.distance(*q) <= within;
        let gluing = |low: &[Vec3], high: &[Vec3]| {
            if low.iter().zip(high).all(near) {
                Gluing::Closed
            } else if low.iter().zip(high.iter().rev()).all(near) {
                Gluing::Twisted
            } else {
                Gluing::Open
            }
        };
        let poles = [0, 1, 2, 3].map(|side| {
            let first: &Vec3 = &samples[side][0];
            samples[side].iter().all(|point| point.distance(*first) <= within)
        });
        let [bottom, top, left, right] = &samples;
        let pair = |low: usize, high: usize, a: &[Vec3], b: &[Vec3]| {
            if poles[low] || poles[high] { Gluing::Open } else { gluing(a, b) }
        };
        Sides { u: pair(2, 3, left, right), v: pair(0, 1, bottom, top), poles }
    }

    /// The size of a surface as 81 of its points tell, to choose a distance for [`Sides::found`].
    pub fn extent<S: Surface + ?Sized>(surface: &S) -> f64 {
        let [[a, b], [c, d]] = surface.domain();
        let share = |low: f64, high: f64, k: usize| low + (high - low) * k as f64 / 8.0;
        let points = (0..81).map(|k| surface.point(share(a, b, k / 9), share(c, d, k % 9)));
        Aabb::of(points).size().max_element()
    }
}
