//! The planes of touched triangles, each cut into cells along its contacts.

use super::Birth;
use super::contacts::Contacts;
use super::scene::Scene;
use crate::mesh::Topology;
use crate::numeric::DisjointSets;
use crate::polygon::exact::{Chart, Jump, Line, Overlay, Plane, PointId, Segment, SubEdge, overlay};
use std::collections::HashMap;

/// A plane with the faces of all operands that lie in it, as cells.
#[derive(Debug)]
pub(super) struct Carrier {
    pub(super) chart: Chart,
    pub(super) lines: Vec<Line>,
    pub(super) overlay: Overlay,
    /// For each cell, a triangle of the first operand that covers it.
    pub(super) births: Vec<Option<Birth>>,
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
pub(super) fn cut(scene: &mut Scene, contacts: Contacts) -> Carriers {
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
    /// The draft of a plane of the scene.
    by_plane: HashMap<u32, u32>,
    /// For each touched triangle, its draft and whether its normal is the chart's.
    home: HashMap<u32, (u32, bool)>,
}

struct Draft {
    chart: Chart,
    lines: Vec<Line>,
    segments: Vec<Segment>,
    marks: Vec<PointId>,
    /// The line of another plane of the scene.
    line_of_plane: HashMap<u32, u32>,
}

impl Drafts {
    fn add_triangle(&mut self, scene: &mut Scene, triangle: u32) {
        let (plane, outward) = scene.shared_plane(triangle);
        let next = self.drafts.len() as u32;
        let draft = *self.by_plane.entry(plane).or_insert(next);
        if draft == next {
            self.drafts.push(Draft::new(scene.plane(plane)));
        }
        self.home.insert(triangle, (draft, outward));
    }

    /// Adds the sides of a triangle that do not continue in its plane.
    fn add_sides(&mut self, scene: &Scene, triangle: u32) {
        let (home, outward) = self.home[&triangle];
        let Scene { triangles, twins, .. } = scene;
        let owner = &triangles[triangle as usize];
        for side in 0..3 {
            let twin = twins[3 * triangle as usize + side];
            if twin != Topology::NONE && self.home.get(&(twin / 3)) == Some(&(home, outward)) {
                continue;
            }
            let (from, to) = (owner.corners[side], owner.corners[(side + 1) % 3]);
            let draft = &mut self.drafts[home as usize];
            let line = draft.chart.line_through(scene.points(), from, to).expect("sides have length");
            let line = draft.add_line(line);
            // Seen against its normal a triangle runs clockwise and counts as uncovering what is on its left.
            let (ends, amount) = if outward { ([from, to], 1) } else { ([to, from], -1) };
            let jump = Some(Jump { operand: owner.operand, amount, face: triangle });
            draft.segments.push(Segment { ends, line, jump });
        }
    }

    /// Adds to the carrier of `triangle` what it has in common with `other`.
    fn add_trace(&mut self, scene: &mut Scene, triangle: u32, other: u32, ends: [PointId; 2]) {
        let draft = &mut self.drafts[self.home[&triangle].0 as usize];
        if ends[0] == ends[1] {
            draft.marks.push(ends[0]);
            return;
        }
        let (plane, _) = scene.shared_plane(other);
        let line = draft.line_of(plane, scene.plane(plane));
        draft.segments.push(Segment { ends, line, jump: None });
    }
}

impl Draft {
    fn new(plane: &Plane) -> Draft {
        Draft {
            chart: Chart::new(plane),
            lines: Vec::new(),
            segments: Vec::new(),
            marks: Vec::new(),
            line_of_plane: HashMap::new(),
        }
    }

    fn add_line(&mut self, line: Line) -> u32 {
        self.lines.push(line);
        self.lines.len() as u32 - 1
    }

    fn line_of(&mut self, index: u32, plane: &Plane) -> u32 {
        if let Some(&line) = self.line_of_plane.get(&index) {
            return line;
        }
        let line = self.chart.line(plane).expect("planes with a common segment cross");
        let line = self.add_line(line);
        self.line_of_plane.insert(index, line);
        line
    }

    fn finish(mut self, scene: &mut Scene) -> Carrier {
        self.marks.sort_unstable();
        self.marks.dedup();
        let Draft { chart, lines, segments, marks, .. } = self;
        let overlay = overlay(&chart, &mut scene.places.points, &lines, &segments, &marks);
        let births = find_births(scene, &chart, &overlay);
        Carrier { chart, lines, overlay, births, first_cell: 0 }
    }
}

/// For each covered cell, the least triangle of its first operand among those whose sides bound the part of the plane
/// that this operand covers around the cell.
fn find_births(scene: &Scene, chart: &Chart, overlay: &Overlay) -> Vec<Option<Birth>> {
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
    for edge in &overlay.edges {
        for jump in overlay.jumps_of(edge) {
            let cell = if lies_above(scene, chart, jump) { edge.above } else { edge.below };
            if let Some(sheet) = sheet(cell, jump.operand) {
                let triangle = scene.triangles[jump.face as usize].index;
                let birth = Birth { operand: jump.operand, triangle };
                let known = &mut births[sheets.find(sheet) as usize];
                *known = Some(known.map_or(birth, |known| known.min(birth)));
            }
        }
    }
    let first_of = |cell: usize| (first_sheet[cell] < first_sheet[cell + 1]).then(|| first_sheet[cell]);
    let mut birth_of = |cell: usize| births[sheets.find(first_of(cell)?) as usize];
    (0..overlay.coverage.len()).map(&mut birth_of).collect()
}

/// Whether the triangle behind a jump lies above the edge: coverage then grows upward with its own sign.
fn lies_above(scene: &Scene, chart: &Chart, jump: &Jump) -> bool {
    let [a, b, c] = scene.triangles[jump.face as usize].corners;
    chart.orientation(scene.points(), a, b, c) == jump.amount
}

impl Carrier {
    /// The numbers of the cells below and above an edge among all cells, and whether something covers them.
    pub(super) fn beside(&self, edge: &SubEdge) -> [(u32, bool); 2] {
        [edge.below, edge.above]
            .map(|cell| (self.first_cell + cell, !self.overlay.coverage[cell as usize].is_empty()))
    }
}
