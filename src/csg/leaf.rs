//! What is made by itself: primitives, extrusions, hulls.

use super::arena::NodeId;
use super::build::{BuildError, Note, Report};
use super::frame::plane_part;
use super::plan::{self, Spot};
use super::solve::{Leaf, Solver};
use super::{Body, Csg, Dimension};
use crate::boolean::Op;
use crate::hull::convex_hull;
use crate::math::{Affine3, Vec3};
use crate::mesh::{self, Mesh, Solid};
use crate::polygon::Region;
use crate::tessellate::{linear_extrude, rotate_extrude};
use std::sync::Arc;

impl Solver<'_, '_> {
    /// The mesh of a leaf in its own coordinates, made once.
    pub(super) fn leaf(&mut self, node: NodeId) -> Result<Leaf, BuildError> {
        let key = self.arena.get(node).key;
        if let Some(leaf) = self.leaves.get(&key) {
            self.report.reused += 1;
            return Ok(leaf.clone());
        }
        let leaf = self.make_leaf(node)?;
        self.report.made += 1;
        self.step();
        self.leaves.insert(key, leaf.clone());
        Ok(leaf)
    }

    fn make_leaf(&mut self, node: NodeId) -> Result<Leaf, BuildError> {
        let (recipe, children) = (self.arena.get(node).recipe, &self.arena.get(node).children);
        match recipe {
            Csg::Body(body) => self.body(node, body),
            Csg::LinearExtrude { sweep, .. } => {
                let region = self.region(children[0])?;
                self.check_limit(sweep.most_triangles(&region))?;
                Ok(Leaf::of(linear_extrude(&region, sweep)?))
            }
            Csg::RotateExtrude { sweep, .. } => {
                let region = self.region(children[0])?;
                self.check_limit(sweep.most_triangles(&region))?;
                Ok(Leaf::of(rotate_extrude(&region, sweep)?))
            }
            Csg::Hull { .. } => Ok(Leaf::of(convex_hull(&self.hull_points(node)?)?)),
            Csg::Blend { .. } | Csg::Offset { .. } => self.smooth_leaf(node),
            Csg::Nothing | Csg::Flat(_) | Csg::Transform { .. } | Csg::Color { .. } | Csg::Combine { .. } => {
                unreachable!("plans have no such leaf in space")
            }
        }
    }

    fn body(&mut self, node: NodeId, body: &Body) -> Result<Leaf, BuildError> {
        Ok(match body {
            Body::Cuboid { min, max } => Leaf::of(mesh::cuboid(*min, *max)),
            Body::Sphere { radius, fragments } => {
                self.check_limit(mesh::sphere_triangles(*fragments))?;
                Leaf::of(mesh::sphere(*radius, *fragments)?)
            }
            Body::Frustum { heights, radii, fragments } => {
                self.check_limit(mesh::frustum_triangles(*radii, *fragments))?;
                Leaf::of(mesh::frustum(*heights, *radii, *fragments)?)
            }
            Body::Mesh(mesh) => Leaf::unknown(mesh.clone()),
            Body::Surface(surface) => {
                let mesh = surface.mesh(self.max_triangles())?;
                self.check_limit(mesh.triangles.len() as u64)?;
                Leaf::unknown(Arc::new(mesh))
            }
            Body::Field(field) => self.field_leaf(node, field)?,
        })
    }

    /// The region of a plane recipe in its own coordinates, made once; empty for a solid, with a note.
    pub(super) fn region(&mut self, node: NodeId) -> Result<Arc<Region>, BuildError> {
        let (key, dimension) = (self.arena.get(node).key, self.arena.get(node).dimension);
        if dimension == Some(Dimension::Three) {
            self.report.note(Note::MixedDimensions);
            return Ok(Arc::default());
        }
        if let Some(region) = self.regions.get(&key) {
            self.report.reused += 1;
            return Ok(region.clone());
        }
        let spot = Spot { node, map: Affine3::IDENTITY, color: None };
        let region = match plan::plan(self.arena, self.uses, spot, &mut self.report)? {
            Some(plan) => Arc::new(self.region_of(&plan)?),
            None => Arc::default(),
        };
        self.regions.insert(key, region.clone());
        Ok(region)
    }

    /// Points whose hull is the hull of a node. Of unions and hulls the operands will do; other booleans are solved.
    pub(super) fn hull_points(&mut self, hull: NodeId) -> Result<Vec<Vec3>, BuildError> {
        let dimension = self.arena.get(hull).dimension;
        let mut points = Vec::new();
        let mut stack = vec![(hull, Affine3::IDENTITY)];
        while let Some((id, map)) = stack.pop() {
            let node = self.arena.get(id);
            if node.dimension != dimension {
                if node.dimension.is_some() {
                    self.report.note(Note::MixedDimensions);
                }
                continue;
            }
            match node.recipe {
                Csg::Transform { map: own, .. } => {
                    let own = if dimension == Some(Dimension::Two) { plane_part(own) } else { *own };
                    if own.matrix3.determinant() == 0.0 {
                        self.report.note(Note::SingularMap);
                    } else {
                        stack.push((node.children[0], map * own));
                    }
                }
                Csg::Color { .. } | Csg::Hull { .. } | Csg::Combine { op: Op::Union, .. } => {
                    stack.extend(node.children.iter().rev().map(|&child| (child, map)));
                }
                _ => {
                    let corners = self.corners(id)?;
                    points.extend(corners.into_iter().map(|p| map.transform_point3(p)));
                    self.check_limit(points.len() as u64)?;
                }
            }
        }
        Ok(points)
    }

    /// The vertices of a leaf or of a boolean that must be solved; those of regions lie in z = 0.
    fn corners(&mut self, node: NodeId) -> Result<Vec<Vec3>, BuildError> {
        let is_boolean = matches!(self.arena.get(node).recipe, Csg::Combine { .. });
        if self.arena.get(node).dimension == Some(Dimension::Two) {
            let region = self.region(node)?;
            return Ok(region.contours().iter().flatten().map(|p| p.extend(0.0)).collect());
        }
        if !is_boolean {
            return Ok(used_positions(self.leaf(node)?.geometry.mesh()));
        }
        let spot = Spot { node, map: Affine3::IDENTITY, color: None };
        let solid = match plan::plan(self.arena, self.uses, spot, &mut Report::default())? {
            Some(plan) => self.solid_of(&plan)?.0,
            None => Solid::default(),
        };
        Ok(solid.into_mesh().positions)
    }
}

fn used_positions(mesh: &Mesh) -> Vec<Vec3> {
    let mut is_used = vec![false; mesh.positions.len()];
    // An index out of range has no position; the boolean reports it where the mesh itself is built.
    let corners = mesh.triangles.iter().flatten();
    corners.for_each(|&v| is_used.get_mut(v as usize).into_iter().for_each(|used| *used = true));
    mesh.positions.iter().zip(is_used).filter(|(_, used)| *used).map(|(&p, _)| p).collect()
}
