//! The planes of touched triangles, each cut into cells along its contacts.

use super::Birth;
use super::contacts::Contacts;
use super::scene::Scene;
use super::world::{Facing, Lookup, NONE};
use crate::numeric::DisjointSets;
use crate::polygon::exact::{Chart, Jump, Line, Overlay, Plane, PointId, Segment, SubEdge, overlay};

/// A plane with the faces of all operands that lie in it, as cells.
#[derive(Debug)]
pub(super) struct Carrier {
    /// Index of the plane in the world.
    pub(super) plane: u32,
    pub(super) chart: Chart,
    pub(super) lines: Vec<Line>,
    /// For each line, the line of the world it came as, or [`NONE`].
    pub(super) world_lines: Vec<u32>,
    pub(super) overlay: Overlay,
    /// For each cell, a triangle of the first operand that covers it.
    pub(super) births: Vec<Option<Birth>>,
    /// Points inside of cells at which something else touches them.
    pub(super) marks: Vec<PointId>,
    /// Number of the first cell of this carrier among all.
    pub(super) first_cell: u32,
}

/// All faces of a scene: whole triangles that touch nothing, and carriers for the rest.
#[derive(Debug)]
pub(super) struct Carriers {
    pub(super) touched: Vec<bool>,
    pub(super) carriers: Vec<Carrier>,
    /// Number of cells of all carriers.
    pub(super) cell_count: u32,
}

/// Gathers touched triangles by plane and cuts each plane.
pub(super) fn cut(scene: &mut Scene<'_>, contacts: Contacts) -> Carriers {
    let mut drafts = Drafts::default();
    let touched = contacts.touched;
    for t in (0..touched.len() as u32).filter(|&t| touched[t as usize]) {
        drafts.add_triangle(scene, t);
    }
    for t in (0..touched.len() as u32).filter(|&t| touched[t as usize]) {
        drafts.add_sides(scene, t);
    }
    for trace in &contacts.traces {
        let [t, s] = trace.triangles;
        drafts.add_trace(scene, t, s, trace.ends);
        drafts.add_trace(scene, s, t, trace.ends);
    }
    let mut cell_count = 0;
    let mut carriers = Vec::with_capacity(drafts.drafts.len());
    for draft in drafts.drafts {
        let mut carrier = draft.finish(scene);
        carrier.first_cell = cell_count;
        cell_count += carrier.overlay.coverage.len() as u32;
        carriers.push(carrier);
    }
    Carriers { touched, carriers, cell_count }
}

/// Carriers before they are cut.
#[derive(Default)]
struct Drafts {
    drafts: Vec<Draft>,
    /// The draft of a plane of the world.
    by_plane: Lookup<u32, u32>,
}

struct Draft {
    plane: u32,
    chart: Chart,
    lines: Vec<Line>,
    world_lines: Vec<u32>,
    segments: Vec<Segment>,
    marks: Vec<PointId>,
    /// The line of another plane of the world.
    line_of_plane: Lookup<u32, u32>,
}

impl Drafts {
    fn add_triangle(&mut self, scene: &mut Scene<'_>, triangle: u32) {
        let plane = scene.shared_facing(triangle).plane();
        let next = self.drafts.len() as u32;
        if *self.by_plane.entry(plane).or_insert(next) == next {
            self.drafts.push(Draft::new(plane, scene.world.plane(plane)));
        }
    }

    /// The facing of a touched triangle, and the draft of its plane.
    fn home(&mut self, scene: &Scene<'_>, triangle: u32) -> (Facing, &mut Draft) {
        let facing = scene.facing(triangle).expect("touched triangles were asked for it");
        (facing, &mut self.drafts[self.by_plane[&facing.plane()] as usize])
    }

    /// Adds the sides of a triangle across which its face does not go on.
    fn add_sides(&mut self, scene: &Scene<'_>, triangle: u32) {
        let (facing, draft) = self.home(scene, triangle);
        for half_edge in 3 * triangle..3 * triangle + 3 {
            if scene.goes_on(half_edge, draft.chart.plane()) {
                continue;
            }
            let line = scene.line_of_side(&draft.chart, half_edge);
            let line = draft.add_line(line, scene.line_index(half_edge));
            let [from, to] = scene.ends(half_edge);
            // Seen against its normal a triangle runs clockwise and counts as uncovering what is on its left.
            let (ends, amount) = if facing.is_with_plane() { ([from, to], 1) } else { ([to, from], -1) };
            let jump = Some(Jump { operand: scene.member_of(triangle), amount, face: triangle });
            draft.segments.push(Segment { ends, line, jump });
        }
    }

    /// Adds to the carrier of `triangle` what it has in common with `other`.
    fn add_trace(&mut self, scene: &Scene<'_>, triangle: u32, other: u32, ends: [PointId; 2]) {
        let (_, draft) = self.home(scene, triangle);
        if ends[0] == ends[1] {
            draft.marks.push(ends[0]);
            return;
        }
        let plane = scene.facing(other).expect("touched triangles were asked for it").plane();
        let line = draft.line_of(plane, scene.world.plane(plane));
        draft.segments.push(Segment { ends, line, jump: None });
    }
}

impl Draft {
    fn new(index: u32, plane: &Plane) -> Draft {
        Draft {
            plane: index,
            chart: Chart::new(plane),
            lines: Vec::new(),
            world_lines: Vec::new(),
            segments: Vec::new(),
            marks: Vec::new(),
            line_of_plane: Lookup::default(),
        }
    }

    fn add_line(&mut self, line: Line, world_line: u32) -> u32 {
        self.lines.push(line);
        self.world_lines.push(world_line);
        self.lines.len() as u32 - 1
    }

    fn line_of(&mut self, index: u32, plane: &Plane) -> u32 {
        if let Some(&line) = self.line_of_plane.get(&index) {
            return line;
        }
        let line = self.chart.line(plane).expect("planes with a common segment cross");
        let line = self.add_line(line, NONE);
        self.line_of_plane.insert(index, line);
        line
    }

    fn finish(mut self, scene: &mut Scene<'_>) -> Carrier {
        self.marks.sort_unstable();
        self.marks.dedup();
        let Draft { plane, chart, lines, world_lines, segments, marks, .. } = self;
        let overlay = overlay(&chart, &mut scene.world.places.points, &lines, &segments, &marks);
        let births = find_births(scene, &chart, &overlay);
        let marks = off_edges(marks, &overlay);
        Carrier { plane, chart, lines, world_lines, overlay, births, marks, first_cell: 0 }
    }
}

/// The points that are no ends of edges.
fn off_edges(points: Vec<PointId>, overlay: &Overlay) -> Vec<PointId> {
    if points.is_empty() {
        return points;
    }
    let mut ends: Vec<PointId> = overlay.edges.iter().flat_map(|edge| edge.ends).collect();
    ends.sort_unstable();
    points.into_iter().filter(|point| ends.binary_search(point).is_err()).collect()
}

/// For each covered cell, the least triangle of its first operand among those whose sides bound the part of the plane
/// that this operand covers around the cell.
fn find_births(scene: &Scene<'_>, chart: &Chart, overlay: &Overlay) -> Vec<Option<Birth>> {
    // One sheet for each operand that covers a cell; sheets of one operand run on where it does not change.
    let mut first_sheet = vec![0];
    first_sheet.extend(overlay.coverage.iter().scan(0, |sum, cover| {
        *sum += cover.len() as u32;
        Some(*sum)
    }));
    let sheet = |cell: u32, operand: u32| {
        let place = overlay.coverage[cell as usize].binary_search_by_key(&operand, |&(k, _)| k).ok()?;
        Some(first_sheet[cell as usize] + place as u32)
    };
    let mut sheets = DisjointSets::new(first_sheet[overlay.coverage.len()] as usize);
    for edge in &overlay.edges {
        let jumps = overlay.jumps_of(edge);
        for &(operand, _) in &overlay.coverage[edge.below as usize] {
            if let (Some(below), Some(above)) = (sheet(edge.below, operand), sheet(edge.above, operand))
                && !jumps.iter().any(|jump| jump.operand == operand)
            {
                sheets.join(below, above);
            }
        }
    }
    let mut births: Vec<Option<Birth>> = vec![None; sheets.len()];
    let mut beside: Vec<Option<Birth>> = vec![None; sheets.len()];
    for edge in &overlay.edges {
        for jump in overlay.jumps_of(edge) {
            let birth = scene.births[jump.face as usize];
            let above = lies_above(scene, chart, jump);
            for (cell, is_own) in [(edge.above, above), (edge.below, !above)] {
                if let Some(sheet) = sheet(cell, jump.operand) {
                    let known = if is_own { &mut births } else { &mut beside };
                    let known = &mut known[sheets.find(sheet) as usize];
                    *known = Some(known.map_or(birth, |known| known.min(birth)));
                }
            }
        }
    }
    // An operand that overlaps itself may leave a sheet of which every side belongs to a triangle beside it.
    births.iter_mut().zip(beside).for_each(|(birth, beside)| *birth = birth.or(beside));
    let first_of = |cell: usize| (first_sheet[cell] < first_sheet[cell + 1]).then(|| first_sheet[cell]);
    let mut birth_of = |cell: usize| births[sheets.find(first_of(cell)?) as usize];
    (0..overlay.coverage.len()).map(&mut birth_of).collect()
}

/// Whether the triangle behind a jump lies above the edge: coverage then grows upward with its own sign.
fn lies_above(scene: &Scene<'_>, chart: &Chart, jump: &Jump) -> bool {
    let [a, b, c] = scene.corners[jump.face as usize];
    chart.orientation(scene.points(), a, b, c) == jump.amount
}

impl Carrier {
    /// The numbers of the cells below and above an edge among all cells, and whether something covers them.
    pub(super) fn beside(&self, edge: &SubEdge) -> [(u32, bool); 2] {
        [edge.below, edge.above]
            .map(|cell| (self.first_cell + cell, !self.overlay.coverage[cell as usize].is_empty()))
    }
}
