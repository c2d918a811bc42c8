//! What is measured.

use crate::oracle::random::SplitMix;
use crate::real;
use crate::solids::{all_of, ball, cube, difference, mapped, union};
use crate::specimens::{self, Expected, Specimen};
use ogee::boolean::{Op, Tree};
use ogee::math::{Aabb, Vec3};
use ogee::mesh::Mesh;
use serde_json::{Value, json};
use std::path::Path;
use std::{fs, io};

/// A case by name; its operands are made when it is run.
pub(crate) struct Case {
    pub(crate) name: String,
    /// Whether nothing is known of the operands, so that taking them in is part of the work.
    pub(crate) imported: bool,
    make: Box<dyn Fn() -> Work>,
}

/// The work of a case.
pub(crate) struct Work {
    pub(crate) tree: Tree,
    pub(crate) operands: Vec<Mesh>,
    pub(crate) known: Known,
}

/// What is known of the result beforehand.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Known {
    pub(crate) volume: Option<f64>,
    pub(crate) components: Option<usize>,
    pub(crate) genus: Option<i64>,
}

impl Case {
    fn new(name: &str, make: impl Fn() -> Work + 'static) -> Case {
        Case { name: name.to_owned(), imported: false, make: Box::new(make) }
    }

    fn imported(self) -> Case {
        Case { imported: true, ..self }
    }

    /// Writes the case into a folder; the tree as lists, an operand's number or an operation and its operands.
    pub(crate) fn write(&self, folder: &Path, tree: &Tree) -> io::Result<()> {
        let value = json!({ "imported": self.imported, "tree": tree_value(tree) });
        fs::write(folder.join("case.json"), value.to_string())
    }

    pub(crate) fn work(&self) -> Work {
        (self.make)()
    }
}

const ONE_PIECE: Known = Known { volume: None, components: Some(1), genus: Some(0) };

/// All cases, in the order in which they are run.
pub(crate) fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for (size, n) in [("1k", 11), ("10k", 35), ("100k", 112), ("1M", 354)] {
        cases.push(Case::new(&format!("ball minus ball {size} solid"), move || balls(n)));
        cases.push(Case::new(&format!("ball minus ball {size} mesh"), move || balls(n)).imported());
    }
    cases.push(Case::new("two cubes", || Work {
        tree: union(2),
        operands: vec![cube(0.0, 0.0, 0.0, 1.0), cube(0.5, 0.5, 0.5, 1.0)],
        known: Known { volume: Some(1.875), ..ONE_PIECE },
    }));
    cases.push(Case::new("Menger 3", || of(specimens::sponge(3, 1409))));
    cases.push(Case::new("Menger 4", || of(specimens::sponge(4, 26433))));
    cases.push(Case::new("grid of cubes added and removed", || of(specimens::grids(10).swap_remove(0))));
    cases.push(Case::new("grid of cubes added and hollowed", || of(specimens::grids(10).swap_remove(1))));
    cases.push(Case::new("plate minus 529 cylinders flush", || plate(true, false)));
    cases.push(Case::new("plate minus 529 cylinders through", || plate(false, false)));
    cases.push(Case::new("plate minus 529 cylinders rotated", || plate(false, true)));
    cases.push(Case::new("union of 100 balls", || scattered(100)));
    cases.push(Case::new("union of 1000 balls", || scattered(1000)));
    cases.push(Case::new("90 rotated cubes", || Work {
        tree: union(90),
        operands: specimens::turned_cubes(-0.5, 90),
        known: ONE_PIECE,
    }));
    for exponent in [6, 9, 12] {
        let angle = ogee::math::pow(10.0, -f64::from(exponent));
        cases
            .push(Case::new(&format!("ball and itself turned by 1e-{exponent}"), move || turned_ball(angle)));
    }
    cases.push(Case::new("terrain of 200k triangles minus 1024 domes", terrain));
    for name in real::names() {
        for pose in 1..=3 {
            cases.push(
                Case::new(&format!("{name} minus itself posed {pose}"), move || posed(name, pose)).imported(),
            );
        }
    }
    cases
}

fn of(specimen: Specimen) -> Work {
    let known = match specimen.expected {
        Expected::Known { volume, components, genus, .. } => {
            Known { volume: Some(volume), components: Some(components), genus: Some(genus) }
        }
        Expected::Oracle => Known::default(),
    };
    Work { tree: specimen.tree, operands: specimen.operands, known }
}

fn balls(n: u32) -> Work {
    let operands = vec![ball(n, 1.0, Vec3::ZERO), ball(n, 1.0, Vec3::new(0.31, 0.47, 0.23))];
    Work { tree: difference(2), operands, known: ONE_PIECE }
}

fn plate(flush: bool, rotated: bool) -> Work {
    let turn = rotated.then(|| specimens::about(Vec3::new(1.0, 2.0, 3.0), 0.7));
    let (tree, operands) = specimens::perforated_plate(23, flush, turn);
    Work { tree, operands, known: Known { volume: None, components: Some(1), genus: Some(529) } }
}

/// Balls of random sizes in a box that grows with their number.
fn scattered(count: usize) -> Work {
    let mut random = SplitMix::new(5);
    let size = ogee::math::cbrt(count as f64) * 0.3;
    let mut one = || {
        let center = Vec3::new(random.unit(), random.unit(), random.unit()) * size;
        ball(8, 0.1 + 0.2 * random.unit(), center)
    };
    let operands = (0..count).map(|_| one()).collect();
    Work { tree: union(count), operands, known: Known::default() }
}

fn turned_ball(angle: f64) -> Work {
    let a = ball(35, 1.0, Vec3::ZERO);
    let b = mapped(&a, &specimens::about(Vec3::new(1.0, 2.0, 3.0), angle));
    Work { tree: all_of(Op::Union, 2), operands: vec![a, b], known: ONE_PIECE }
}

/// A mesh and itself, turned anyhow about its middle and moved by up to a quarter of its size.
fn posed(name: &str, pose: u64) -> Work {
    let mut random = SplitMix::new(pose);
    let mut vector = || Vec3::new(random.unit(), random.unit(), random.unit()) - Vec3::splat(0.5);
    let (axis, along) = (vector(), vector());
    let mesh = real::mesh(name);
    let bounds = Aabb::of(mesh.positions.iter().copied());
    let middle = |by: Vec3| [[1.0, 0.0, 0.0, by.x], [0.0, 1.0, 0.0, by.y], [0.0, 0.0, 1.0, by.z]];
    let centred = mapped(&mesh, &middle(-bounds.center()));
    let turned = mapped(&centred, &specimens::about(axis, 6.0 * random.unit()));
    let moved = mapped(&turned, &middle(along * 0.5 * bounds.size()));
    Work { tree: difference(2), operands: vec![centred, moved], known: Known::default() }
}

fn terrain() -> Work {
    let (ground, domes) = specimens::terrain(316, 32);
    let mut operands = vec![ground];
    operands.extend(domes);
    let chain = |sum, next| Tree::Node(Op::Difference, vec![sum, Tree::Leaf(next)]);
    Work { tree: (1..operands.len()).fold(Tree::Leaf(0), chain), operands, known: ONE_PIECE }
}

fn tree_value(tree: &Tree) -> Value {
    match tree {
        Tree::Leaf(index) => json!(index),
        Tree::Node(op, children) => {
            let mut list = vec![json!(format!("{op:?}"))];
            list.extend(children.iter().map(tree_value));
            Value::Array(list)
        }
        Tree::AtLeast(..) => unreachable!("no case has one: the peer has no such operation"),
    }
}
