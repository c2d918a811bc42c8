//! What is known of a result after rounding, and what was done about it.

use super::leave::Rounded;
use super::repair::Patient;
use super::tree::Tree;
use super::world::Labels;
use super::{Birth, Combined, Operand, Steps, arrive, strategy};
use crate::mesh::{Exact, Mesh, Solid, Topology, Unmended, components, crossing_pairs};
use crate::polygon::exact::Origin;

/// What a result is known to be. That it is closed and two-manifold is part of what a [`Solid`] is.
///
/// The exact result never passes through itself. Its positions rounded to doubles may, where features are smaller than an
/// ulp; all triangles that rounding moved are therefore looked at, by exact signs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// Number of triangles with an altitude below four ulps of the largest coordinate.
    pub slivers: usize,
    /// Pairs of triangles that rounding had made to pass through each other.
    pub crossings_found: usize,
    /// How many such pairs are left. Where not all could be repaired nothing was.
    pub crossings_left: usize,
    /// Bound on the distance from the exact surface to the rounded one, in model units: for a vertex half an ulp in each
    /// coordinate, more where crossings were repaired.
    pub movement: f64,
}

impl Certificate {
    /// What is known of two results together.
    #[must_use]
    pub fn and(self, other: Certificate) -> Certificate {
        Certificate {
            slivers: self.slivers + other.slivers,
            crossings_found: self.crossings_found + other.crossings_found,
            crossings_left: self.crossings_left + other.crossings_left,
            movement: self.movement.max(other.movement),
        }
    }
}

/// A triangle thinner than this many ulps of the largest coordinate is a sliver.
const SLIVER: f64 = 4.0;

/// Rounds of repair. Each takes out features twice as large as the one before, up to a limit.
const ROUNDS: i32 = 20;

/// Rounds without fewer crossings after which another way is tried.
const PATIENCE: i32 = 4;

/// Crossings beyond which that way is not taken: sheets that run through each other all over have no end of them.
const MOST_TO_CUT: usize = 256;

/// How often the size of features to take out is doubled, at most: what is a thousand times as large as the rounding stays.
const MOST_DOUBLINGS: i32 = 10;

/// Makes a result of a rounded surface: looks for crossings and repairs them.
pub(super) fn certify(rounded: Rounded, operands: &[Operand<'_>]) -> Combined {
    let Rounded { mesh, birth, twins, embedded, origin, unparted, movement } = rounded;
    let suspects = origin.as_ref().map_or_else(Vec::new, |origin| moved_triangles(&mesh, origin));
    let found = crossing_pairs(&mesh, &suspects);
    let ulp = f64::EPSILON * mesh.positions.iter().fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
    let mut certificate =
        Certificate { slivers: 0, crossings_found: found.len(), crossings_left: found.len(), movement };
    let exact = unparted.or_else(|| origin.map(|origin| Exact { origin, unmended: None }));
    let repaired = if found.is_empty() { None } else { repair(&mesh, &birth, &found, ulp, operands) };
    let (solid, birth) = match repaired {
        Some(repaired) => {
            certificate.crossings_left = 0;
            certificate.movement += repaired.movement;
            let rounded = (mesh, Topology::of_twins(twins), birth);
            let exact = exact.map(|exact| behind(exact, rounded, &repaired.birth, operands));
            (Solid::assume(repaired.mesh, false).rounded_from(exact), repaired.birth)
        }
        None => {
            let solid = Solid::assume(mesh, embedded).with_twins(twins);
            (solid.rounded_from(exact), birth)
        }
    };
    certificate.slivers = slivers(solid.mesh(), SLIVER * ulp);
    Combined { solid, birth, certificate }
}

/// The exact surface behind a rounded one that was repaired, whose triangles then had the births given last.
fn behind(
    exact: Exact,
    (mesh, topology, birth): (Mesh, Topology, Vec<Birth>),
    repaired: &[Birth],
    operands: &[Operand<'_>],
) -> Exact {
    let Exact { origin, unmended } = exact;
    let unmended = unmended.unwrap_or_else(|| {
        let stand_ins = (0..mesh.triangles.len() as u32).collect();
        Unmended { mesh, topology, stand_ins }
    });
    let births = unmended.stand_ins.iter().map(|&t| birth[t as usize]);
    let stand_ins = stand_ins(births, repaired, operands);
    Exact { origin, unmended: Some(Unmended { stand_ins, ..unmended }) }
}

/// For each birth, one of the triangles that were born from the same, or, where that face was too thin to be left, one
/// with the same label.
fn stand_ins(births: impl Iterator<Item = Birth>, left: &[Birth], operands: &[Operand<'_>]) -> Vec<u32> {
    let mut by_birth: Vec<(Birth, u32)> = left.iter().copied().zip(0..).collect();
    let mut by_label: Vec<(u32, u32)> = by_birth.iter().map(|&(b, t)| (label_of(b, operands), t)).collect();
    by_birth.sort_unstable();
    by_label.sort_unstable();
    let stand_in = |birth: Birth| {
        let at = by_birth.partition_point(|known| known.0 < birth);
        if let Some(&(_, t)) = by_birth.get(at).filter(|known| known.0 == birth) {
            return t;
        }
        let label = label_of(birth, operands);
        let at = by_label.partition_point(|known| known.0 < label);
        by_label.get(at).or(by_label.last()).map_or(0, |known| known.1)
    };
    births.map(stand_in).collect()
}

fn label_of(birth: Birth, operands: &[Operand<'_>]) -> u32 {
    match operands[birth.operand as usize].labels {
        Labels::One(label) => label,
        Labels::Each(labels) => labels[birth.triangle as usize],
    }
}

/// Triangles with a vertex that leaving the lattice has moved, in order. Vertices of operands went the other way.
fn moved_triangles(mesh: &Mesh, origin: &Origin) -> Vec<u32> {
    let mut is_moved = vec![false; mesh.positions.len()];
    for &(vertex, site) in &origin.sites {
        is_moved[vertex as usize] = origin.lattice.snap(mesh.positions[vertex as usize]) != site;
    }
    origin.fractions.iter().for_each(|&(vertex, _)| is_moved[vertex as usize] = true);
    let triangles = (0_u32..).zip(&mesh.triangles);
    triangles.filter(|(_, corners)| corners.iter().any(|&v| is_moved[v as usize])).map(|(t, _)| t).collect()
}

/// Number of triangles with an altitude below `thickness`.
fn slivers(mesh: &Mesh, thickness: f64) -> usize {
    let is_sliver = |&t: &usize| {
        let [a, b, c] = mesh.corners(t);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        (b - a).cross(c - a).length_squared() < thickness * thickness * longest
    };
    (0..mesh.triangles.len()).filter(is_sliver).count()
}

/// A surface without crossings.
struct Repaired {
    mesh: Mesh,
    birth: Vec<Birth>,
    movement: f64,
}

impl Repaired {
    fn of(patient: Patient) -> Repaired {
        let (mesh, birth, movement) = patient.discharged();
        Repaired { mesh, birth, movement }
    }
}

/// Takes out what is thin around crossings, thicker things every time, until there are none. Where nothing thin is left to
/// take out, or that does not help, the surface is cut along its crossings as an operand would be. `None` when crossings
/// stay, or when handles or parts would come or go: cutting joins a solid to itself where it pinches itself at an edge.
fn repair(
    mesh: &Mesh,
    birth: &[Birth],
    found: &[[u32; 2]],
    ulp: f64,
    operands: &[Operand<'_>],
) -> Option<Repaired> {
    let mut patient = Patient::new(mesh.clone(), birth.to_vec(), 0.0);
    let mut crossings = found.to_vec();
    let (mut fewest, mut in_vain) = (found.len(), 0);
    for round in 0..ROUNDS {
        let taken = patient.thin_out(&crossings, ulp * f64::from(round.min(MOST_DOUBLINGS)).exp2());
        crossings = patient.crossings(&crossings);
        in_vain = if crossings.len() < fewest { 0 } else { in_vain + 1 };
        fewest = fewest.min(crossings.len());
        if !crossings.is_empty() && (taken == 0 || in_vain == PATIENCE) {
            if crossings.len() > MOST_TO_CUT {
                return None;
            }
            let Repaired { mesh, birth, movement } = rearranged(&Repaired::of(patient), operands)?;
            let all: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
            crossings = crossing_pairs(&mesh, &all);
            patient = Patient::new(mesh, birth, movement);
            in_vain = 0;
        }
        if crossings.is_empty() {
            return Some(Repaired::of(patient)).filter(|repaired| shape_of(&repaired.mesh) == shape_of(mesh));
        }
    }
    None
}

/// What repair must not change: components, and vertices less edges plus faces.
fn shape_of(mesh: &Mesh) -> (usize, i64) {
    (components(mesh).len(), mesh.positions.len() as i64 - mesh.triangles.len() as i64 / 2)
}

/// The surface as an operand that crosses itself, made sound and rounded again.
fn rearranged(state: &Repaired, operands: &[Operand<'_>]) -> Option<Repaired> {
    let labels: Vec<u32> = state.birth.iter().map(|&birth| label_of(birth, operands)).collect();
    let operand = Operand::from(&state.mesh).with_materials(&labels);
    let (world, bodies) = arrive::enter(&[operand], 0.0).ok()?;
    let (world, body) = strategy::evaluate(world, bodies, &Tree::Leaf(0), Steps::Once);
    let Rounded { mesh, birth, movement, .. } = world.round(body);
    let birth = birth.into_iter().map(|birth| state.birth[birth.triangle as usize]).collect();
    Some(Repaired { mesh, birth, movement: state.movement + movement })
}
