use super::plane::MOST_NORMAL_BITS;
use super::points::Fraction;
use super::width::{Denominator, Numerator};
use super::{Lattice, Plane, Site};
use crate::math::Vec3;

/// The exact surface that the positions of a mesh were rounded from: places of vertices, planes of triangles and lines of
/// half-edges, wherever they do not follow from the positions. Half-edge `3 t + i` is side `i` of triangle `t`.
#[derive(Clone, Debug)]
pub struct Origin {
    pub(crate) lattice: Lattice,
    /// Whether the exact surface is known not to cross itself.
    pub(crate) embedded: bool,
    /// Vertices at lattice points that are not exactly their positions, by vertex.
    pub(crate) sites: Vec<(u32, Site)>,
    /// Vertices that are no lattice points, by vertex.
    pub(crate) fractions: Vec<(u32, Fraction)>,
    pub(crate) planes: Vec<Plane>,
    /// Triangles with such vertices, by triangle: the plane of each, and whether its normal points outward.
    pub(crate) faces: Vec<(u32, u32, bool)>,
    /// Planes that cross that of a face along an edge of it.
    pub(crate) lines: Vec<Plane>,
    /// Half-edges with such ends that lie on edges of faces, by half-edge: the line of each.
    pub(crate) sides: Vec<(u32, u32)>,
}

/// Where a vertex is exactly. It lives for a moment, so its size is no matter.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "a box for each would cost more than the copies do")]
pub(crate) enum Place {
    Site(Site),
    Fraction(Fraction),
}

/// Widths that everything downstream is proved for; see the table of the module.
const MOST_NUMERATOR_BITS: u32 = 443;
const MOST_DENOMINATOR_BITS: u32 = 381;

impl Origin {
    /// Nothing but positions on a lattice.
    pub(crate) fn on(lattice: Lattice, embedded: bool) -> Origin {
        Origin {
            lattice,
            embedded,
            sites: Vec::new(),
            fractions: Vec::new(),
            planes: Vec::new(),
            faces: Vec::new(),
            lines: Vec::new(),
            sides: Vec::new(),
        }
    }

    /// The same surface on another lattice, of a mesh with these positions and triangles; `None` where numbers would be
    /// too wide. On finer lattices they never are.
    pub(crate) fn at(&self, lattice: Lattice, positions: &[Vec3], triangles: &[[u32; 3]]) -> Option<Origin> {
        let exponent = self.lattice.exponent_in(lattice);
        let mut moved = Origin::on(lattice, self.embedded);
        let scaled = |planes: &[Plane]| -> Option<Vec<Plane>> {
            planes.iter().map(|plane| plane.scaled(exponent)).collect()
        };
        (moved.planes, moved.lines) = (scaled(&self.planes)?, scaled(&self.lines)?);
        (moved.faces, moved.sides) = (self.faces.clone(), self.sides.clone());
        if exponent >= 0 {
            for &(vertex, site) in &self.sites {
                moved.add(vertex, Place::Site(site).scaled(exponent)?);
            }
            for (vertex, fraction) in &self.fractions {
                moved.add(*vertex, Place::Fraction(*fraction).scaled(exponent)?);
            }
        } else {
            self.coarsen(exponent, positions, triangles, &mut moved)?;
        }
        Some(moved)
    }

    /// Adds what no longer follows from positions on a coarser lattice.
    fn coarsen(
        &self,
        exponent: i32,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        moved: &mut Origin,
    ) -> Option<()> {
        let lattice = moved.lattice;
        let old: Vec<Option<Site>> = self.old_sites(positions);
        let mut fractions = self.fractions.iter();
        for (vertex, (site, &position)) in (0_u32..).zip(old.iter().zip(positions)) {
            let place = match site {
                Some(site) => Place::Site(*site),
                None => Place::Fraction(fractions.next().expect("each was marked").1),
            };
            match place.scaled(exponent)? {
                Place::Site(site) if lattice.holds(position) && lattice.snap(position) == site => {}
                place => moved.add(vertex, place),
            }
        }
        let mut is_fraction = vec![false; positions.len()];
        moved.fractions.iter().for_each(|&(vertex, _)| is_fraction[vertex as usize] = true);
        for (t, corners) in (0_u32..).zip(triangles) {
            if !corners.iter().any(|&v| is_fraction[v as usize]) {
                continue;
            }
            let sites = corners.map(|v| old[v as usize]);
            let plane = match self.faces.binary_search_by_key(&t, |face| face.0) {
                Ok(at) => self.planes[self.faces[at].1 as usize],
                Err(_) => match sites {
                    [Some(a), Some(b), Some(c)] => match Plane::through(a, b, c) {
                        Some(plane) => {
                            moved.faces.push((t, moved.planes.len() as u32, true));
                            moved.planes.push(plane.scaled(exponent)?);
                            plane
                        }
                        None => continue,
                    },
                    _ => return None,
                },
            };
            for i in 0..3 {
                let half_edge = 3 * t + i as u32;
                if let (Some(a), Some(b)) = (sites[i], sites[(i + 1) % 3])
                    && [i, (i + 1) % 3].iter().any(|&i| is_fraction[corners[i] as usize])
                    && self.sides.binary_search_by_key(&half_edge, |side| side.0).is_err()
                {
                    let line = Plane::along_axis(a, b, plane.main_axis())?;
                    moved.sides.push((half_edge, moved.lines.len() as u32));
                    moved.lines.push(line.scaled(exponent)?);
                }
            }
        }
        moved.faces.sort_unstable();
        moved.sides.sort_unstable();
        Some(())
    }

    /// For each vertex, the lattice point it is at, if it is at one.
    fn old_sites(&self, positions: &[Vec3]) -> Vec<Option<Site>> {
        let mut sites: Vec<Option<Site>> = positions.iter().map(|&p| Some(self.lattice.snap(p))).collect();
        self.sites.iter().for_each(|&(vertex, site)| sites[vertex as usize] = Some(site));
        self.fractions.iter().for_each(|&(vertex, _)| sites[vertex as usize] = None);
        sites
    }

    /// Adds the place of a vertex, the last so far.
    pub(crate) fn add(&mut self, vertex: u32, place: Place) {
        match place {
            Place::Site(site) => self.sites.push((vertex, site)),
            Place::Fraction(fraction) => self.fractions.push((vertex, fraction)),
        }
    }
}

impl Place {
    /// All coordinates times 2^`exponent`; `None` where numbers would be too wide.
    fn scaled(&self, exponent: i32) -> Option<Place> {
        let fraction = match self {
            Place::Site(site) => match site.map(|c| scaled_integer(c, exponent)) {
                [Some(x), Some(y), Some(z)] => return Some(Place::Site([x, y, z])),
                _ => {
                    Fraction { numerators: site.map(Numerator::from), denominator: Denominator::from(1_i64) }
                }
            },
            Place::Fraction(fraction) => *fraction,
        };
        let Fraction { numerators, denominator } = fraction;
        // The numerators times 2^up over the denominator times 2^down, with as few bits as possible.
        let zeros = numerators.iter().filter(|n| !n.is_zero()).map(Numerator::trailing_zeros).min();
        let zeros = zeros.map_or(i32::MAX / 2, |zeros| zeros as i32);
        let down = (-(denominator.trailing_zeros() as i32)).max(-zeros - exponent);
        let scaled =
            |n: Numerator| n.times_power_of_two(down + exponent).filter(|n| n.bits() <= MOST_NUMERATOR_BITS);
        let [x, y, z] = numerators.map(scaled);
        let denominator = denominator.times_power_of_two(down)?;
        (denominator.bits() <= MOST_DENOMINATOR_BITS).then_some(())?;
        Some(Place::Fraction(Fraction { numerators: [x?, y?, z?], denominator }))
    }
}

/// `c` times 2^`exponent`, where that is an integer of at most 62 bits.
fn scaled_integer(c: i64, exponent: i32) -> Option<i64> {
    if c == 0 {
        return Some(0);
    }
    match exponent {
        ..0 => (c.trailing_zeros() >= exponent.unsigned_abs()).then(|| c >> -exponent),
        0.. => {
            let bits = 64 - c.unsigned_abs().leading_zeros();
            (bits + exponent.unsigned_abs() <= 62).then(|| c << exponent)
        }
    }
}

const _: () = assert!(MOST_NORMAL_BITS == 126, "the two widths above follow from it");
