//! Carrying out a plan.

use super::arena::{Arena, NodeId};
use super::build::{BuildError, BuildOptions, Color, Note, Progress, Report, Stage};
use super::field::{Faces, Sewn, Surface, sew};
use super::frame::{is_identity, widened};
use super::plan::{self, Kind, Plan, Spot, Uses};
use crate::boolean::{self, Op, Operand, Tree};
use crate::math::{Aabb, Affine3, Vec3};
use crate::mesh::{Mesh, Solid};
use crate::numeric::DisjointSets;
use crate::polygon::Region;
use std::collections::HashMap;
use std::sync::Arc;

/// What a build knows while it goes on.
pub(super) struct Solver<'a, 'b> {
    pub(super) arena: &'a Arena<'b>,
    pub(super) uses: &'a Uses,
    pub(super) report: Report,
    options: &'a BuildOptions,
    /// What is below this is a rounding error, in model units.
    pub(super) resolution: f64,
    progress: &'a mut dyn FnMut(Progress),
    steps: Progress,
    spent: u64,
    pub(super) leaves: HashMap<u128, Leaf>,
    pub(super) regions: HashMap<u128, Arc<Region>>,
    solids: HashMap<Key, Part>,
    /// What maps do to the errors of fields, once that is asked for.
    pub(super) stretches: Option<HashMap<u128, f64>>,
}

/// What the solid of a repeated boolean depends on but for a translation: content, linear part, colour.
type Key = (u128, [u64; 9], Option<[u32; 4]>);

/// A mesh with or without the promises of a solid.
#[derive(Clone)]
pub(super) enum Geometry {
    Solid(Arc<Solid>),
    Mesh(Arc<Mesh>),
}

/// A leaf in its own coordinates.
#[derive(Clone)]
pub(super) struct Leaf {
    pub(super) geometry: Geometry,
    /// Whether the surface does not cross itself, so that it may stay as it is when nothing is done to it.
    pub(super) clean: bool,
    /// The curved surface that all triangles stand for.
    pub(super) surface: Option<Surface>,
}

/// A leaf or a result in the coordinates where it takes part.
#[derive(Clone)]
struct Part {
    geometry: Geometry,
    clean: bool,
    paint: Paint,
    faces: Arc<Faces>,
}

/// Colours of triangles.
#[derive(Clone)]
enum Paint {
    All(Option<Color>),
    Each(Vec<Option<Color>>),
}

impl<'a, 'b> Solver<'a, 'b> {
    pub(super) fn new(
        arena: &'a Arena<'b>,
        uses: &'a Uses,
        options: &'a BuildOptions,
        report: Report,
        progress: &'a mut dyn FnMut(Progress),
        total: u64,
    ) -> Solver<'a, 'b> {
        Solver {
            arena,
            uses,
            report,
            options,
            resolution: options.resolution * arena.root().bounds.size().max_element(),
            progress,
            steps: Progress { done: 0, total, stage: Stage::Solids },
            spent: 0,
            leaves: HashMap::new(),
            regions: HashMap::new(),
            solids: HashMap::new(),
            stretches: None,
        }
    }

    pub(super) fn into_report(self) -> Report {
        self.report
    }

    /// The solid of a plan, and the colours of its triangles, none where nothing is coloured.
    pub(super) fn solid_of(&mut self, plan: &Plan) -> Result<(Solid, Vec<Option<Color>>), BuildError> {
        let Part { geometry, paint, faces, .. } = self.solve(plan)?;
        let solid = match geometry {
            Geometry::Solid(solid) => Arc::unwrap_or_clone(solid),
            Geometry::Mesh(_) => unreachable!("solving makes solids"),
        };
        let colors = match paint {
            Paint::All(None) => Vec::new(),
            Paint::All(color) => vec![color; solid.triangles().len()],
            Paint::Each(colors) => colors,
        };
        let Some(Sewn { solid, parents, seams }) = sew(&solid, &faces) else { return Ok((solid, colors)) };
        self.check_limit(solid.triangles().len() as u64)?;
        self.report.seams = self.report.seams.and(seams);
        let of_parent = |&parent: &u32| colors.get(parent as usize).copied();
        let colors = parents.iter().filter_map(of_parent).collect();
        Ok((solid, colors))
    }

    /// Refuses what is larger than the options allow.
    pub(super) fn check_limit(&self, triangles: u64) -> Result<(), BuildError> {
        let most = self.options.max_triangles;
        if triangles > most { Err(BuildError::Limit { triangles, most }) } else { Ok(()) }
    }

    /// Most triangles of a leaf.
    pub(super) fn max_triangles(&self) -> u64 {
        self.options.max_triangles
    }

    /// Whether meshes of fields lose the triangles that their tolerance does not need.
    pub(super) fn coarsens(&self) -> bool {
        self.options.coarsen
    }

    pub(super) fn step(&mut self) {
        let done = self.steps.done + 1;
        self.steps = Progress { done, total: self.steps.total.max(done), ..self.steps };
        (self.progress)(self.steps);
    }

    /// Tells what is done from now on.
    pub(super) fn show(&mut self, stage: Stage) {
        self.steps.stage = stage;
        (self.progress)(self.steps);
    }

    /// The solid of a plan.
    fn solve(&mut self, plan: &Plan) -> Result<Part, BuildError> {
        match &plan.kind {
            Kind::Node { origin: Some(spot), .. } if self.is_repeated(spot.node) => self.repeated(*spot),
            _ => self.solve_afresh(plan),
        }
    }

    fn solve_afresh(&mut self, plan: &Plan) -> Result<Part, BuildError> {
        match &plan.kind {
            Kind::Leaf(spot) => {
                let part = self.part(*spot)?;
                if part.clean { Ok(part) } else { self.evaluate(&Tree::Leaf(0), &[part]) }
            }
            Kind::Frame { map, inner } => moved(self.solve(inner)?, map),
            Kind::Node { op: Op::Union, parts, .. } => {
                let mut solved = Vec::new();
                for cluster in clusters(parts, self.resolution) {
                    solved.push(match cluster[..] {
                        [part] => self.solve(part)?,
                        _ => self.boolean(Op::Union, &cluster)?,
                    });
                }
                Ok(side_by_side(solved))
            }
            Kind::Node { op, parts, .. } => self.boolean(*op, &parts.iter().collect::<Vec<_>>()),
        }
    }

    fn is_repeated(&self, node: NodeId) -> bool {
        self.uses.is_repeated(self.arena.get(node).key)
    }

    /// A boolean that occurs more than once is solved without its translation, and then put in its places.
    fn repeated(&mut self, spot: Spot) -> Result<Part, BuildError> {
        let linear = spot.map.matrix3;
        let key = (
            self.arena.get(spot.node).key,
            linear.to_cols_array().map(|c| (c + 0.0).to_bits()),
            spot.color.map(|color| color.map(f32::to_bits)),
        );
        let part = if let Some(part) = self.solids.get(&key) {
            self.report.reused += 1;
            part.clone()
        } else {
            let here = Spot { map: Affine3::from_mat3(linear), ..spot };
            let part = match plan::plan(self.arena, self.uses, here, &mut Report::default())? {
                Some(plan) => self.solve_afresh(&plan)?,
                None => Part::empty(),
            };
            self.solids.insert(key, part.clone());
            part
        };
        self.spend(&part)?;
        moved(part, &Affine3::from_translation(spot.map.translation))
    }

    fn boolean(&mut self, op: Op, plans: &[&Plan]) -> Result<Part, BuildError> {
        let mut operands = Vec::new();
        let trees: Result<Vec<Tree>, BuildError> =
            plans.iter().map(|plan| self.tree(plan, &mut operands)).collect();
        self.evaluate(&Tree::Node(op, trees?), &operands)
    }

    /// The plan as an expression over operands, which are appended.
    fn tree(&mut self, plan: &Plan, operands: &mut Vec<Part>) -> Result<Tree, BuildError> {
        let operand = match &plan.kind {
            Kind::Node { op, parts, .. } => {
                let trees: Result<Vec<Tree>, BuildError> =
                    parts.iter().map(|part| self.tree(part, operands)).collect();
                return Ok(Tree::Node(*op, trees?));
            }
            Kind::Leaf(spot) => self.part(*spot)?,
            Kind::Frame { map, inner } => moved(self.solve(inner)?, map)?,
        };
        operands.push(operand);
        Ok(Tree::Leaf(operands.len() - 1))
    }

    fn part(&mut self, spot: Spot) -> Result<Part, BuildError> {
        let Leaf { geometry, clean, surface } = self.leaf(spot.node)?;
        let faces = surface.map(|surface| Faces::on(&surface, geometry.mesh().triangles.len()));
        let faces = Arc::new(faces.unwrap_or_default());
        let part = Part { geometry, clean, paint: Paint::All(spot.color), faces };
        self.spend(&part)?;
        moved(part, &spot.map)
    }

    fn spend(&mut self, part: &Part) -> Result<(), BuildError> {
        self.spent = self.spent.saturating_add(part.mesh().triangles.len() as u64);
        self.check_limit(self.spent)
    }

    fn evaluate(&mut self, tree: &Tree, parts: &[Part]) -> Result<Part, BuildError> {
        let materials = materials(parts);
        let painted = parts.iter().zip(&materials);
        let operands: Vec<Operand<'_>> = painted
            .map(|(part, materials)| match materials {
                Materials::One(material) => part.operand().with_material(*material),
                Materials::Each(materials) => part.operand().with_materials(materials),
            })
            .collect();
        let combined = boolean::evaluate_with(
            tree,
            &operands,
            &boolean::Options { resolution: self.resolution, ..Default::default() },
        )?;
        self.report.booleans += 1;
        self.report.certificate = self.report.certificate.and(combined.certificate);
        if combined.certificate.crossings_left > 0 {
            self.report.note(Note::CrossingsLeft);
        }
        self.step();
        self.check_limit(combined.solid.triangles().len() as u64)?;
        let color_of = |birth: &boolean::Birth| parts[birth.operand as usize].color(birth.triangle as usize);
        let same =
            parts.iter().map(Part::single_color).reduce(|a, b| if a == b { a } else { None }).flatten();
        let paint = match same {
            Some(color) => Paint::All(color),
            None => Paint::Each(combined.birth.iter().map(color_of).collect()),
        };
        let births = combined.birth.iter().map(|birth| [birth.operand, birth.triangle].map(|i| i as usize));
        let faces = Faces::chosen(&parts.iter().map(|part| &*part.faces).collect::<Vec<_>>(), births);
        let geometry = Geometry::Solid(Arc::new(combined.solid));
        Ok(Part { geometry, clean: true, paint, faces: Arc::new(faces) })
    }
}

/// Labels of a part.
enum Materials {
    One(u32),
    Each(Vec<u32>),
}

/// Labels of the triangles of each part, equal for equal colours.
fn materials(parts: &[Part]) -> Vec<Materials> {
    let mut known: HashMap<Option<[u32; 4]>, u32> = HashMap::new();
    let mut label = |color: &Option<Color>| {
        let next = known.len() as u32;
        *known.entry(color.map(|c| c.map(f32::to_bits))).or_insert(next)
    };
    let mut labels = |part: &Part| match &part.paint {
        Paint::All(color) => Materials::One(label(color)),
        Paint::Each(colors) => Materials::Each(colors.iter().map(&mut label).collect()),
    };
    parts.iter().map(&mut labels).collect()
}

impl Geometry {
    pub(super) fn mesh(&self) -> &Mesh {
        match self {
            Geometry::Solid(solid) => solid.mesh(),
            Geometry::Mesh(mesh) => mesh,
        }
    }
}

impl Leaf {
    pub(super) fn of(solid: Solid) -> Leaf {
        Leaf { clean: solid.is_embedded(), geometry: Geometry::Solid(Arc::new(solid)), surface: None }
    }

    /// A mesh of which nothing is known.
    pub(super) fn unknown(mesh: Arc<Mesh>) -> Leaf {
        Leaf { clean: false, geometry: Geometry::Mesh(mesh), surface: None }
    }

    /// The same, all its triangles within a tolerance of a curved surface.
    pub(super) fn near(self, surface: Surface) -> Leaf {
        Leaf { surface: Some(surface), ..self }
    }
}

impl Part {
    fn empty() -> Part {
        let geometry = Geometry::Solid(Arc::default());
        Part { geometry, clean: true, paint: Paint::All(None), faces: Arc::default() }
    }

    fn mesh(&self) -> &Mesh {
        self.geometry.mesh()
    }

    fn operand(&self) -> Operand<'_> {
        match &self.geometry {
            Geometry::Solid(solid) => (&**solid).into(),
            Geometry::Mesh(mesh) => (&**mesh).into(),
        }
    }

    fn color(&self, triangle: usize) -> Option<Color> {
        match &self.paint {
            Paint::All(color) => *color,
            Paint::Each(colors) => colors[triangle],
        }
    }

    fn single_color(&self) -> Option<Option<Color>> {
        match self.paint {
            Paint::All(color) => Some(color),
            Paint::Each(_) => None,
        }
    }
}

/// The part with every vertex mapped, turned inside out where the map mirrors.
fn moved(part: Part, map: &Affine3) -> Result<Part, BuildError> {
    if is_identity(map) {
        return Ok(part);
    }
    let mesh = part.mesh();
    let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| map.transform_point3(p)).collect();
    if positions.iter().any(|p| !p.is_finite()) {
        return Err(BuildError::NonFinite { what: "transform" });
    }
    let image = Mesh { positions, triangles: mesh.triangles.clone() };
    let image = if map.matrix3.determinant() < 0.0 { image.flipped() } else { image };
    let geometry = match &part.geometry {
        Geometry::Solid(solid) => {
            let embedded = solid.is_embedded() && is_exact(map, &mesh.positions);
            Geometry::Solid(Arc::new(Solid::assume(image, embedded)))
        }
        Geometry::Mesh(_) => Geometry::Mesh(Arc::new(image)),
    };
    let faces = if part.faces.is_flat() { part.faces } else { Arc::new(part.faces.moved(map)) };
    Ok(Part { geometry, faces, ..part })
}

/// Whether a map only exchanges, mirrors and shifts coordinates, and moves all points without rounding.
fn is_exact(map: &Affine3, positions: &[Vec3]) -> bool {
    let linear = map.matrix3;
    let is_unit = |c: f64| c == 0.0 || c.abs() == 1.0;
    let units = super::frame::keeps_axes(map) && linear.to_cols_array().into_iter().all(is_unit);
    let shift = map.translation;
    // The rounding error of a sum of two numbers, itself exact (Knuth).
    let rounding = |a: Vec3| {
        let sum = a + shift;
        let part = sum - a;
        (a - (sum - part)) + (shift - part)
    };
    units && positions.iter().all(|&p| rounding(linear * p) == Vec3::ZERO)
}

/// Parts gathered so that different clusters are more than `gap` apart. Clusters and their parts keep their order.
fn clusters(parts: &[Plan], gap: f64) -> Vec<Vec<&Plan>> {
    let wide = |bounds: Aabb| Aabb { min: bounds.min - Vec3::splat(gap), max: bounds.max + Vec3::splat(gap) };
    let boxes: Vec<Aabb> = parts.iter().map(|part| wide(widened(part.bounds, 0.0))).collect();
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by(|&a, &b| boxes[a].min.x.total_cmp(&boxes[b].min.x));
    let mut sets = DisjointSets::new(parts.len());
    // Those before in the order that may still reach the next one.
    let mut open: Vec<usize> = Vec::new();
    for index in order {
        open.retain(|&other| boxes[other].max.x >= boxes[index].min.x);
        for &other in open.iter().filter(|&&other| boxes[other].touches(boxes[index])) {
            sets.join(other as u32, index as u32);
        }
        open.push(index);
    }
    let mut cluster_of: HashMap<u32, usize> = HashMap::new();
    let mut clusters: Vec<Vec<&Plan>> = Vec::new();
    for (index, part) in (0..).zip(parts) {
        let cluster = *cluster_of.entry(sets.find(index)).or_insert(clusters.len());
        if cluster == clusters.len() {
            clusters.push(Vec::new());
        }
        clusters[cluster].push(part);
    }
    clusters
}

/// Solids that are apart from each other as one.
fn side_by_side(mut parts: Vec<Part>) -> Part {
    if parts.len() == 1 {
        return parts.swap_remove(0);
    }
    let first = parts.first().map_or(Some(None), Part::single_color);
    let paint = match first {
        Some(color) if parts.iter().all(|part| part.single_color() == first) => Paint::All(color),
        _ => {
            let colors =
                |part: &Part| (0..part.mesh().triangles.len()).map(|t| part.color(t)).collect::<Vec<_>>();
            Paint::Each(parts.iter().flat_map(colors).collect())
        }
    };
    let embedded = |part: &Part| matches!(&part.geometry, Geometry::Solid(s) if s.is_embedded());
    let all_embedded = parts.iter().all(embedded);
    let mut mesh = Mesh::default();
    parts.iter().for_each(|part| mesh.append(part.mesh()));
    let births =
        (0..).zip(&parts).flat_map(|(i, part)| (0..part.mesh().triangles.len()).map(move |t| [i, t]));
    let faces = Faces::chosen(&parts.iter().map(|part| &*part.faces).collect::<Vec<_>>(), births);
    let solid = Solid::assume(mesh, all_embedded);
    Part { geometry: Geometry::Solid(Arc::new(solid)), clean: true, paint, faces: Arc::new(faces) }
}
