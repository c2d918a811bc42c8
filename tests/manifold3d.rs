//! The same trees as manifold3d built, from `fixtures/manifold3d/records.json`: volume and area to 1e-9, components
//! and genus exactly. Where a record says that manifold3d is wrong, the comparison is with what is right, known by hand
//! or from the oracle.

#![allow(clippy::print_stdout, reason = "tests say how much they did")]

#[allow(dead_code, reason = "each test program uses its part")]
mod check;
#[allow(dead_code, reason = "each test program uses its part")]
mod oracle;
#[allow(dead_code, reason = "each test program uses its part")]
mod solids;

use check::Shape;
use ogee::boolean::{self, Op, Tree};
use ogee::math::{Aabb, Vec2, Vec3};
use ogee::mesh::Mesh;
use serde_json::Value;

#[test]
fn results_agree_with_manifold3d_where_it_is_right() {
    let text = std::fs::read_to_string("fixtures/manifold3d/records.json").expect("records");
    let records: Vec<Value> = serde_json::from_str(&text).expect("JSON");
    assert!(records.len() >= 60);
    let failed: Vec<String> = records.iter().filter_map(judge).collect();
    println!("{} records", records.len());
    assert!(failed.is_empty(), "{} of {} records fail:\n{}", failed.len(), records.len(), failed.join("\n"));
}

/// What is wrong with our result for a record, if anything.
fn judge(record: &Value) -> Option<String> {
    let name = record["name"].as_str().expect("a name");
    let operands: Vec<Mesh> = list(&record["leaves"]).iter().map(leaf).collect();
    let operands: Vec<&Mesh> = operands.iter().collect();
    let tree = tree(&record["tree"]);
    let mesh = match boolean::evaluate(&tree, &operands) {
        Ok(combined) => combined.solid.into_mesh(),
        Err(error) => return Some(format!("{name}: {error}")),
    };
    let theirs = Measures::recorded(&record["manifold3d"]);
    let right = match &record["truth"] {
        Value::Null => theirs,
        Value::String(_) => Measures::true_of(&tree, &operands),
        known => Measures::recorded(known),
    };
    let mut found = Measures::of(&mesh).differences(&right);
    if record["wrong"].is_string() && theirs.differences(&right).is_empty() {
        found.push("manifold3d is right after all".to_owned());
    } else if !record["wrong"].is_string() {
        found.extend(
            theirs.differences(&right).iter().map(|d| format!("manifold3d is wrong and nobody says so: {d}")),
        );
    }
    (!found.is_empty()).then(|| format!("{name}: {}", found.join("; ")))
}

#[derive(Clone, Copy)]
struct Measures {
    volume: f64,
    area: f64,
    bounds: Option<Aabb>,
    components: u64,
    genus: i64,
}

impl Measures {
    fn recorded(value: &Value) -> Measures {
        let bounds = value["box"].as_array().filter(|corners| corners.len() == 6).map(|corners| {
            let at =
                |i: usize| Vec3::new(number(&corners[i]), number(&corners[i + 1]), number(&corners[i + 2]));
            Aabb { min: at(0), max: at(3) }
        });
        Measures {
            volume: number(&value["volume"]),
            area: number(&value["area"]),
            bounds,
            components: value["components"].as_u64().expect("a count"),
            genus: value["genus"].as_i64().expect("a count"),
        }
    }

    fn of(mesh: &Mesh) -> Measures {
        let shape = Shape::of(mesh);
        assert_eq!(shape.faults, Vec::<String>::new());
        Measures {
            volume: shape.volume_f64(),
            area: shape.area,
            bounds: (!mesh.is_empty()).then(|| mesh.bounds()),
            components: shape.components.len() as u64,
            genus: shape.genus(),
        }
    }

    fn true_of(tree: &Tree, operands: &[&Mesh]) -> Measures {
        let truth = oracle::evaluate(tree, operands);
        let (volume, area, genus) = (truth.volume_f64(), truth.area, truth.genus());
        Measures { volume, area, bounds: None, components: truth.components.len() as u64, genus }
    }

    /// Volumes and areas may differ by a relative 1e-9, which a volume of slivers must be granted of the rounding of
    /// its surface.
    fn differences(&self, right: &Measures) -> Vec<String> {
        let mut found = Vec::new();
        if (self.volume - right.volume).abs() > 1e-9 * right.volume + 1e-15 * right.area {
            found.push(format!("volume {} instead of {}", self.volume, right.volume));
        }
        if (self.area - right.area).abs() > 1e-9 * right.area {
            found.push(format!("area {} instead of {}", self.area, right.area));
        }
        if (self.components, self.genus) != (right.components, right.genus) {
            let (ours, theirs) = ((self.components, self.genus), (right.components, right.genus));
            found.push(format!("components and genus {ours:?} instead of {theirs:?}"));
        }
        if let (Some(ours), Some(theirs)) = (self.bounds, right.bounds) {
            let off = (ours.min - theirs.min).abs().max((ours.max - theirs.max).abs()).max_element();
            if off > 1e-9 * theirs.size().max_element() {
                found.push(format!("box {ours:?} instead of {theirs:?}"));
            }
        }
        found
    }
}

fn tree(value: &Value) -> Tree {
    if let Some(index) = value.as_u64() {
        return Tree::Leaf(index as usize);
    }
    let parts = list(value);
    let op = match parts[0].as_str() {
        Some("union") => Op::Union,
        Some("intersection") => Op::Intersection,
        Some("difference") => Op::Difference,
        other => panic!("an unknown operation {other:?}"),
    };
    Tree::Node(op, parts[1..].iter().map(tree).collect())
}

fn leaf(value: &Value) -> Mesh {
    let arguments = list(&value["arguments"]);
    let count = |i: usize| arguments[i].as_u64().expect("a count") as u32;
    let mesh = match value["shape"].as_str() {
        Some("box") => solids::cuboid(point(&arguments[0]), point(&arguments[1])),
        Some("tetrahedron") => solids::tetrahedron([0, 1, 2, 3].map(|i| point(&arguments[i]))),
        Some("ball") => solids::ball(count(0), number(&arguments[1]), point(&arguments[2])),
        Some("tube") => {
            let center = Vec2::new(number(&arguments[2][0]), number(&arguments[2][1]));
            solids::tube(
                count(0),
                number(&arguments[1]),
                center,
                number(&arguments[3]),
                number(&arguments[4]),
            )
        }
        other => panic!("an unknown shape {other:?}"),
    };
    match &value["rows"] {
        Value::Null => mesh,
        rows => {
            let rows = [0, 1, 2].map(|i| [0, 1, 2, 3].map(|j| number(&rows[i][j])));
            solids::mapped(&mesh, &rows)
        }
    }
}

fn point(value: &Value) -> Vec3 {
    Vec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}
