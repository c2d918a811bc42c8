//! Random boolean cases drawn to be nasty: small solids on a small grid that share planes, edges and vertices.

mod shrink;

pub(crate) use shrink::shrunk;

use crate::oracle::random::SplitMix;
use crate::solids::{self, IDENTITY, Rows};
use ogee::boolean::{Op, Tree};
use ogee::math::{Vec2, Vec3};
use ogee::mesh::Mesh;
use std::fmt;

/// An expression with its operands. Prints as the Rust that makes it.
#[derive(Clone, PartialEq)]
pub(crate) struct Case {
    pub(crate) tree: Tree,
    pub(crate) operands: Vec<Mesh>,
}

impl Case {
    /// The case of a seed: mostly pairs, some trees of up to five operands.
    pub(crate) fn random(seed: u64) -> Case {
        let mut random = SplitMix::new(seed);
        let count = if random.chance(70) { 2 } else { random.between(1, 5) as usize };
        let mut operands: Vec<Mesh> = Vec::new();
        for _ in 0..count {
            let next = match operands.last() {
                Some(last) if random.chance(35) => moved(last, &mut random),
                _ => solid(&mut random),
            };
            operands.push(next);
        }
        let mut leaves: Vec<Tree> = (0..count).map(Tree::Leaf).collect();
        if random.chance(15) {
            leaves.push(Tree::Leaf(0));
        }
        Case { tree: tree(leaves, &mut random), operands }
    }

    pub(crate) fn operands(&self) -> Vec<&Mesh> {
        self.operands.iter().collect()
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "use Op::*;\nuse Tree::*;")?;
        writeln!(f, "let tree = {};", literal(&self.tree))?;
        writeln!(f, "let operands = [")?;
        for mesh in &self.operands {
            let points: Vec<String> = mesh
                .positions
                .iter()
                .map(|p| format!("Vec3::new({:?}, {:?}, {:?})", p.x, p.y, p.z))
                .collect();
            writeln!(f, "    Mesh::new(vec![{}], vec!{:?}),", points.join(", "), mesh.triangles)?;
        }
        write!(f, "];")
    }
}

fn literal(tree: &Tree) -> String {
    let list = |children: &[Tree]| children.iter().map(literal).collect::<Vec<_>>().join(", ");
    match tree {
        Tree::Leaf(index) => format!("Leaf({index})"),
        Tree::Node(op, children) => format!("Node({op:?}, vec![{}])", list(children)),
        Tree::AtLeast(least, children) => format!("AtLeast({least}, vec![{}])", list(children)),
    }
}

const OPS: [Op; 4] = [Op::Union, Op::Intersection, Op::Difference, Op::SymmetricDifference];

/// Joins leaves in random groups until one tree is left.
fn tree(mut parts: Vec<Tree>, random: &mut SplitMix) -> Tree {
    loop {
        let group = random.between(2, 3).min(parts.len() as i64) as usize;
        let start = random.below((parts.len() - group + 1) as u64) as usize;
        let children: Vec<Tree> = parts.drain(start..start + group).collect();
        let node = match random.below(10) {
            0 => Tree::AtLeast(random.between(1, group as i64) as u32, children),
            _ => Tree::Node(*random.pick(&OPS), children),
        };
        parts.insert(start, node);
        if parts.len() == 1 {
            return parts.remove(0);
        }
    }
}

/// A point of the grid.
fn point(random: &mut SplitMix) -> Vec3 {
    Vec3::from_array([0; 3].map(|_| random.between(0, 4) as f64))
}

fn solid(random: &mut SplitMix) -> Mesh {
    match random.below(100) {
        0..25 => cuboid(random),
        25..45 => tetrahedron(random),
        45..60 => {
            let low = random.between(0, 3);
            let high = random.between(low + 1, 4);
            let prism = if random.chance(25) { solids::fanned_prism } else { solids::prism };
            turned(&prism(&polygon(random), low as f64, high as f64), random)
        }
        60..70 => {
            let low = random.between(0, 3) as f64;
            turned(&solids::pyramid(&polygon(random), low, point(random).with_z(low + 1.0)), random)
        }
        70..75 => solids::ball(1, random.between(1, 3) as f64, point(random)),
        75..80 => solids::together([&cuboid(random), &cuboid(random)]),
        80..85 => solids::together([&solid(random), &tetrahedron(random).flipped()]),
        85..90 => {
            let one = solid(random);
            solids::together([&one, &one])
        }
        90..95 => solid(random).flipped(),
        _ => frame(random),
    }
}

fn cuboid(random: &mut SplitMix) -> Mesh {
    loop {
        let (a, b) = (point(random), point(random));
        if a.cmpne(b).all() {
            return solids::cuboid(a.min(b), a.max(b));
        }
    }
}

/// Four points of the grid; now and then they are in one plane.
fn tetrahedron(random: &mut SplitMix) -> Mesh {
    loop {
        let points = [0; 4].map(|_| point(random));
        let [a, b, c, d] = points;
        if (b - a).cross(c - a).dot(d - a) != 0.0 || random.chance(3) {
            let distinct = points.iter().enumerate().all(|(i, p)| !points[..i].contains(p));
            if distinct {
                return solids::tetrahedron(points);
            }
        }
    }
}

/// A thick square ring, as one chain that crosses itself in its flush ends.
fn frame(random: &mut SplitMix) -> Mesh {
    let outer = solids::cuboid(Vec3::ZERO, Vec3::new(3.0, 3.0, 1.0));
    let hole = solids::cuboid(Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 2.0, 1.0)).flipped();
    turned(&solids::together([&outer, &hole]), random)
}

/// Simple polygons, counter-clockwise, most of them concave, some with three vertices on a line.
fn polygon(random: &mut SplitMix) -> Vec<Vec2> {
    let shapes: [&[[i32; 2]]; 8] = [
        &[[0, 0], [2, 0], [0, 2]],
        &[[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]],
        &[[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]],
        &[[0, 0], [4, 0], [2, 1], [0, 4]],
        &[[1, 0], [2, 0], [2, 1], [3, 1], [3, 2], [2, 2], [2, 3], [1, 3], [1, 2], [0, 2], [0, 1], [1, 1]],
        &[[0, 0], [1, 0], [3, 0], [3, 2], [0, 2]],
        &[[0, 2], [2, 0], [4, 2], [2, 4]],
        &[[0, 0], [4, 1], [1, 2], [3, 4], [0, 3]],
    ];
    random.pick(&shapes).iter().map(|&[x, y]| Vec2::new(f64::from(x), f64::from(y))).collect()
}

/// The mesh again, somewhere near: the same place, a step away, turned by right angles or mirrored.
fn moved(mesh: &Mesh, random: &mut SplitMix) -> Mesh {
    if random.chance(15) {
        return mesh.clone();
    }
    let step = Vec3::from_array([0; 3].map(|_| random.between(-1, 1) as f64));
    let step = if random.chance(40) { step } else { step * random.between(1, 2) as f64 };
    let turned = if random.chance(50) { turned(mesh, random) } else { mesh.clone() };
    solids::translated(&turned, step)
}

/// Turned by right angles, perhaps mirrored, about the middle of the grid.
fn turned(mesh: &Mesh, random: &mut SplitMix) -> Mesh {
    let axes = *random.pick(&[[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]]);
    let mut rows: Rows = IDENTITY;
    for (row, axis) in rows.iter_mut().zip(axes) {
        *row = [0.0; 4];
        row[axis] = if random.chance(50) { 1.0 } else { -1.0 };
        row[3] = if row[axis] < 0.0 { 4.0 } else { 0.0 };
    }
    solids::mapped(mesh, &rows)
}
