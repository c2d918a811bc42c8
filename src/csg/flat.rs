//! Carrying out a plan in the plane.

use super::arena::NodeId;
use super::build::BuildError;
use super::plan::{Kind, Plan, Spot};
use super::solve::Solver;
use super::{Csg, Flat};
use crate::boolean::Tree;
use crate::math::{Affine3, Vec2, Vec3, unit_circle};
use crate::polygon::{self, FillRule, Region};

type Contours = Vec<Vec<Vec2>>;

impl Solver<'_, '_> {
    /// The region of a plan whose leaves are plane.
    pub(super) fn region_of(&mut self, plan: &Plan) -> Result<Region, BuildError> {
        match &plan.kind {
            Kind::Leaf(spot) => self.lone_region(*spot),
            Kind::Frame { map, inner } => {
                let region = self.region_of(inner)?;
                Ok(Region::new(&mapped(region.contours(), map)?, FillRule::Positive)?)
            }
            Kind::Node { .. } => {
                let mut operands = Vec::new();
                let tree = self.flat_tree(plan, &mut operands)?;
                let operands: Vec<&[Vec<Vec2>]> = operands.iter().map(Vec::as_slice).collect();
                self.report.booleans += 1;
                self.step();
                Ok(polygon::combine(&operands, self.resolution, |winding| tree.holds(winding)))
            }
        }
    }

    /// The plan as an expression over contours that wind around their insides once.
    fn flat_tree(&mut self, plan: &Plan, operands: &mut Vec<Contours>) -> Result<Tree, BuildError> {
        let operand = match &plan.kind {
            Kind::Node { op, parts, .. } => {
                let trees: Result<Vec<Tree>, BuildError> =
                    parts.iter().map(|part| self.flat_tree(part, operands)).collect();
                return Ok(Tree::Node(*op, trees?));
            }
            Kind::Leaf(spot) => self.lone_region(*spot)?.contours().to_vec(),
            Kind::Frame { map, inner } => mapped(self.region_of(inner)?.contours(), map)?,
        };
        operands.push(operand);
        Ok(Tree::Leaf(operands.len() - 1))
    }

    fn lone_region(&mut self, spot: Spot) -> Result<Region, BuildError> {
        let (contours, rule) = self.contours(spot.node)?;
        self.step();
        let contours = mapped(&contours, &spot.map)?;
        match rule {
            // Convex contours stay what they are.
            None => Ok(Region::assume(contours)),
            Some(rule) => Ok(Region::new(&contours, rule)?),
        }
    }

    /// The contours of a plane leaf in its own coordinates, and how they are filled where they may cross.
    fn contours(&mut self, node: NodeId) -> Result<(Contours, Option<FillRule>), BuildError> {
        self.report.made += 1;
        match self.arena.get(node).recipe {
            Csg::Flat(Flat::Rectangle { min, max }) => {
                let corners = vec![*min, Vec2::new(max.x, min.y), *max, Vec2::new(min.x, max.y)];
                Ok((vec![corners], None))
            }
            Csg::Flat(Flat::Circle { radius, fragments }) => {
                let count = u64::from(*fragments);
                self.check_limit(count)?;
                let contour: Vec<Vec2> = (0..count).map(|i| *radius * unit_circle(i, count)).collect();
                Ok((if count < 3 { Vec::new() } else { vec![contour] }, None))
            }
            Csg::Flat(Flat::Polygon { contours }) => Ok((contours.to_vec(), Some(FillRule::EvenOdd))),
            Csg::Hull { .. } => {
                let points: Vec<Vec2> = self.hull_points(node)?.into_iter().map(Vec3::truncate).collect();
                Ok((polygon::convex_hull(&points)?.contours().to_vec(), None))
            }
            _ => unreachable!("plans have no such leaf in the plane"),
        }
    }
}

/// The contours with every vertex mapped, in the other direction where the map mirrors.
fn mapped(contours: &[Vec<Vec2>], map: &Affine3) -> Result<Contours, BuildError> {
    let point = |p: &Vec2| map.transform_point3(p.extend(0.0)).truncate();
    let mirrors = map.matrix3.determinant() < 0.0;
    let image = |contour: &Vec<Vec2>| -> Vec<Vec2> {
        if mirrors { contour.iter().rev().map(point).collect() } else { contour.iter().map(point).collect() }
    };
    let contours: Contours = contours.iter().map(image).collect();
    if contours.iter().flatten().all(|p| p.is_finite()) {
        Ok(contours)
    } else {
        Err(BuildError::NonFinite { what: "transform" })
    }
}
