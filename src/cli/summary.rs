//! Measures of what was made, for people and for programs.

use crate::boolean::Certificate;
use crate::csg::{Report, Seams};
use crate::curve::{Bounds, CurveError, Path};
use crate::math::{Aabb, Vec2};
use crate::mesh::{Defects, Measures};
use crate::polygon::Region;
use clap::ValueEnum;
use serde_json::{Map, Value, json};

/// How a summary is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Form {
    Text,
    Json,
}

/// Names and values in order.
#[derive(Default)]
pub(super) struct Summary {
    rows: Map<String, Value>,
}

impl Summary {
    /// Adds a row.
    pub(super) fn row(&mut self, name: &str, value: impl Into<Value>) -> &mut Summary {
        self.rows.insert(name.to_owned(), value.into());
        self
    }

    /// Adds the measures of a mesh.
    pub(super) fn measures(&mut self, m: &Measures) -> &mut Summary {
        self.row("dimension", 3).row("triangles", m.triangles).row("vertices", m.vertices);
        self.row("closed", m.closed)
            .row("components", m.components)
            .row("euler", m.euler)
            .row("genus", m.genus);
        self.row("box", bounds(m.bounds)).row("area", m.area).row("volume", m.volume);
        self.row("centroid", m.centroid.map(|p| p.to_array().to_vec()))
    }

    /// Adds a box.
    pub(super) fn bounds(&mut self, bounds: Aabb) -> &mut Summary {
        self.row("box", self::bounds(bounds))
    }

    /// Adds the measures of a plane region.
    pub(super) fn region(&mut self, region: &Region) -> &mut Summary {
        let points = || region.contours().iter().flatten();
        let corners = points().map(|p: &Vec2| p.extend(0.0));
        self.row("dimension", 2).row("contours", region.contours().len()).row("vertices", points().count());
        self.row("box", bounds(Aabb::of(corners))).row("area", region.area())
    }

    /// Adds the defects of a mesh, as an object of counts.
    pub(super) fn defects(&mut self, defects: &Defects) -> &mut Summary {
        let counts: Map<String, Value> =
            defects.rows().iter().map(|&(name, count)| (name.to_owned(), count.into())).collect();
        self.row("defects", counts)
    }

    /// Adds how the build went.
    pub(super) fn report(&mut self, report: &Report) -> &mut Summary {
        let Report { made, booleans, reused, skipped, certificate, meshings, seams, notes: _ } = report;
        self.row(
            "steps",
            json!({ "made": made, "booleans": booleans, "reused": reused, "skipped": skipped }),
        );
        if *booleans > 0 {
            self.certificate(certificate);
        }
        if !meshings.is_empty() {
            super::meshing::rows(meshings, self);
        }
        if *seams != Seams::default() {
            self.row("seams", json!({ "moved": seams.moved, "left": seams.left }));
        }
        self
    }

    /// Adds what is known of results of booleans.
    pub(super) fn certificate(&mut self, certificate: &Certificate) -> &mut Summary {
        let Certificate { slivers, crossings_found, crossings_left, movement } = certificate;
        self.row(
            "booleans",
            json!({
                "slivers": slivers,
                "crossings found": crossings_found,
                "crossings left": crossings_left,
                "movement": movement,
            }),
        )
    }

    /// The whole as text that ends with a line end.
    pub(super) fn print(&self, form: Form) -> String {
        match form {
            Form::Json => format!("{:#}\n", Value::Object(self.rows.clone())),
            Form::Text => {
                let mut text = String::new();
                lines(&self.rows, &mut text);
                text
            }
        }
    }
}

/// The measures of a path.
pub(super) struct PathMeasures {
    length: f64,
    area: f64,
    bounds: Option<Bounds<Vec2>>,
    segments: usize,
    closed: bool,
}

impl PathMeasures {
    pub(super) fn of(path: &Path) -> Result<PathMeasures, CurveError> {
        // No piece is shorter than the longer side of its box.
        let sides = path.pieces().map(|piece| {
            let Bounds { min, max } = piece.bounding_box();
            (max - min).max_element()
        });
        let accuracy = (1e-14 * sides.sum::<f64>()).clamp(f64::MIN_POSITIVE, f64::MAX);
        let area = path.area();
        if !area.is_finite() {
            return Err(CurveError::NotFinite { index: 0 });
        }
        Ok(PathMeasures {
            length: path.length(accuracy)?.value,
            area,
            bounds: path.bounding_box(),
            segments: path.pieces().count(),
            closed: path.is_closed(),
        })
    }

    /// All of them as an object; an empty path has no box.
    pub(super) fn row(&self) -> Value {
        let bounds = self.bounds.map(|Bounds { min, max }| [min.x, min.y, max.x, max.y]);
        json!({
            "length": self.length,
            "area": self.area,
            "box": bounds,
            "segments": self.segments,
            "closed": self.closed,
        })
    }
}

/// A box as its corners; nothing for the empty one.
fn bounds(bounds: Aabb) -> Value {
    if bounds.is_empty() {
        return Value::Null;
    }
    json!({ "min": bounds.min.to_array(), "max": bounds.max.to_array() })
}

/// A line a value; values inside an object stand a step to the right, counts of zero are left out there.
fn lines(rows: &Map<String, Value>, text: &mut String) {
    const WIDTH: usize = 12;
    for (name, value) in rows {
        match value {
            Value::Object(inner) => {
                let some = inner.iter().filter(|(_, value)| **value != json!(0));
                let parts: Vec<String> =
                    some.map(|(name, value)| format!("{name} {}", plain(value))).collect();
                let parts = if parts.is_empty() { "none".to_owned() } else { parts.join(", ") };
                text.push_str(&format!("{name:WIDTH$} {parts}\n"));
            }
            value => text.push_str(&format!("{name:WIDTH$} {}\n", plain(value))),
        }
    }
}

fn plain(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::String(text) => text.clone(),
        Value::Array(items) => items.iter().map(plain).collect::<Vec<_>>().join(" "),
        value => value.to_string(),
    }
}
