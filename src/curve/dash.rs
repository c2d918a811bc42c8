//! Strands cut into dashes.

use super::strand::{Element, Strand};
use super::{ArcLength, Cubic, CurveError};
use crate::math::Vec2;

/// More dashes than this are not drawn.
const MOST: usize = 1_000_000;
/// To what, in frame units, lengths along the strand are measured.
const ACCURACY: f64 = 1e-12;

/// The dashes of a strand for lengths of dashes and gaps in turn, starting `phase` into the pattern; the strand itself
/// for an empty pattern.
pub(super) fn dashed(strand: Strand, dashes: &[f64], phase: f64) -> Result<Vec<Strand>, CurveError> {
    if dashes.is_empty() {
        return Ok(vec![strand]);
    }
    let pattern = Pattern::new(dashes, phase)?;
    let lengths: Vec<ArcLength<Vec2>> = strand
        .elements
        .iter()
        .map(|element| ArcLength::new(&Cubic::assume(element.points), ACCURACY))
        .collect::<Result<_, _>>()?;
    let total: f64 = lengths.iter().map(|length| length.total().value).sum();
    let count = total / pattern.period * pattern.lengths.len() as f64;
    if count > MOST as f64 {
        return Err(CurveError::TooManyDashes { count, most: MOST });
    }
    let mut cutter = Cutter { pattern, dash: None, done: Vec::new() };
    let begins_drawn = cutter.pattern.is_drawn();
    if begins_drawn {
        cutter.begin(strand.start, strand.heading);
    }
    for (element, length) in strand.elements.iter().zip(&lengths) {
        cutter.walk(element, length);
    }
    let Some(last) = cutter.dash else { return Ok(cutter.done) };
    let mut dashes = cutter.done;
    match dashes.first_mut() {
        None if begins_drawn => return Ok(vec![strand]),
        Some(first) if strand.closed && begins_drawn => {
            first.start = last.start;
            first.elements.splice(0..0, last.elements);
        }
        _ => dashes.push(last),
    }
    Ok(dashes)
}

/// Where in the pattern a walk along a strand is.
struct Pattern {
    lengths: Vec<f64>,
    period: f64,
    index: usize,
    /// What is left of the present dash or gap.
    rest: f64,
}

impl Pattern {
    fn new(dashes: &[f64], phase: f64) -> Result<Pattern, CurveError> {
        if let Some(index) = dashes.iter().position(|dash| !(*dash >= 0.0 && dash.is_finite())) {
            return Err(CurveError::Dash { index });
        }
        let repeats = if dashes.len().is_multiple_of(2) { 1 } else { 2 };
        let lengths = dashes.repeat(repeats);
        let period: f64 = lengths.iter().sum();
        if !(period > 0.0 && period.is_finite()) {
            return Err(CurveError::Dash { index: dashes.len() - 1 });
        }
        if !phase.is_finite() {
            return Err(CurveError::Parameter { value: phase });
        }
        let mut into = phase.rem_euclid(period);
        let mut index = 0;
        // At 0 a dash of no length is still to come.
        while index + 1 < lengths.len() && into > 0.0 && into >= lengths[index] {
            into -= lengths[index];
            index += 1;
        }
        let rest = (lengths[index] - into).max(0.0);
        Ok(Pattern { lengths, period, index, rest })
    }

    fn is_drawn(&self) -> bool {
        self.index.is_multiple_of(2)
    }

    fn next(&mut self) {
        self.index = (self.index + 1) % self.lengths.len();
        self.rest = self.lengths[self.index];
    }
}

struct Cutter {
    pattern: Pattern,
    /// The dash that is being drawn.
    dash: Option<Strand>,
    done: Vec<Strand>,
}

impl Cutter {
    fn begin(&mut self, start: Vec2, heading: Vec2) {
        self.dash = Some(Strand { elements: Vec::new(), closed: false, start, heading });
    }

    /// Walks along one element.
    fn walk(&mut self, element: &Element, length: &ArcLength<Vec2>) {
        let whole = length.total().value;
        let (mut at, mut from) = (0.0, 0.0);
        while self.pattern.rest < whole - at {
            at += self.pattern.rest;
            let to = length.parameter(at).max(from);
            self.draw(element, from, to);
            self.done.extend(self.dash.take());
            self.pattern.next();
            if self.pattern.is_drawn() {
                let (point, heading) = element.ray(to);
                self.begin(point, heading);
            }
            from = to;
        }
        self.pattern.rest -= whole - at;
        self.draw(element, from, 1.0);
    }

    fn draw(&mut self, element: &Element, from: f64, to: f64) {
        if let Some(dash) = &mut self.dash {
            let whole = from == 0.0 && to == 1.0;
            dash.elements.extend(if whole { Some(*element) } else { element.part(from, to) });
        }
    }
}
