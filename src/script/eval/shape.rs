//! Shapes in the making.

use super::{Failure, Machine};
use crate::boolean::Op;
use crate::csg::{Csg, Dimension};
use crate::script::diagnostic::Span;
use crate::script::heap;
use std::sync::Arc;

/// Deepest recipe: what walks over recipes does so by recursion.
const DEEPEST: u32 = 2_000;
/// Bytes a node of a recipe takes, roughly.
const NODE: usize = 256;

/// A recipe with what is known about it.
#[derive(Clone, Debug)]
pub(in crate::script) struct Shape {
    pub(in crate::script) recipe: Arc<Csg>,
    /// `None` for nothing.
    pub(in crate::script) dimension: Option<Dimension>,
    depth: u32,
}

/// What statements make.
#[derive(Clone, Debug, Default)]
pub(in crate::script) struct Made {
    /// The shapes, one for each statement that makes any, in order.
    pub(in crate::script) shapes: Vec<Shape>,
    /// Shapes marked with `#` or `%`.
    pub(in crate::script) shown: Vec<Shape>,
}

impl Made {
    fn one(shape: Shape, shown: Vec<Shape>) -> Made {
        Made { shapes: vec![shape], shown }
    }
}

impl Shape {
    fn nothing() -> Shape {
        Shape { recipe: Arc::new(Csg::Nothing), dimension: None, depth: 0 }
    }
}

impl Machine<'_> {
    /// A shape that is not there, such as a sphere of radius 0.
    pub(in crate::script) fn nothing(&self) -> Made {
        Made::one(Shape::nothing(), Vec::new())
    }

    /// A shape without children.
    pub(in crate::script) fn leaf(&mut self, recipe: Csg, span: Span) -> Result<Made, Failure> {
        let dimension = recipe.dimension();
        Ok(Made::one(self.node(recipe, dimension, 0, span)?, Vec::new()))
    }

    fn node(
        &mut self,
        recipe: Csg,
        dimension: Option<Dimension>,
        depth: u32,
        span: Span,
    ) -> Result<Shape, Failure> {
        // Recipes stay until the end; they are counted and never given back.
        heap::took(NODE);
        if depth > DEEPEST {
            return Err(self.limit(
                span,
                format!("the shape is made of more than {DEEPEST} operations within each other"),
            ));
        }
        self.step(span)?;
        Ok(Shape { recipe: Arc::new(recipe), dimension, depth })
    }

    /// The union of all shapes as one; what is shown stays.
    pub(in crate::script) fn joined(&mut self, made: Made, span: Span) -> Result<Made, Failure> {
        self.combined(Op::Union, made, span)
    }

    /// All shapes combined to one.
    pub(in crate::script) fn combined(&mut self, op: Op, made: Made, span: Span) -> Result<Made, Failure> {
        self.combined_by(op, made, span, |children| Csg::Combine { op, children })
    }

    /// All solids combined to one by a recipe of this kind; plane shapes are left out with a warning.
    pub(in crate::script) fn combined_solids(
        &mut self,
        op: Op,
        mut made: Made,
        span: Span,
        combine: impl FnOnce(Vec<Arc<Csg>>) -> Csg,
    ) -> Result<Made, Failure> {
        let before = made.shapes.len();
        made.shapes.retain(|shape| shape.dimension != Some(Dimension::Two));
        if made.shapes.len() < before {
            self.warn(span, "this works on solids; plane shapes are left out");
        }
        self.combined_by(op, made, span, combine)
    }

    fn combined_by(
        &mut self,
        op: Op,
        made: Made,
        span: Span,
        combine: impl FnOnce(Vec<Arc<Csg>>) -> Csg,
    ) -> Result<Made, Failure> {
        let Made { shapes, shown } = made;
        let mut shapes = self.of_one_dimension(shapes, span);
        let neutral = |index: usize| match op {
            Op::Union | Op::SymmetricDifference => true,
            Op::Difference => index > 0,
            Op::Intersection => false,
        };
        let mut index = 0;
        shapes.retain(|shape| {
            index += 1;
            shape.dimension.is_some() || !neutral(index - 1)
        });
        if shapes.len() < 2 {
            return Ok(Made::one(shapes.pop().unwrap_or_else(Shape::nothing), shown));
        }
        if op == Op::Difference && shapes[0].dimension.is_none() {
            return Ok(Made::one(Shape::nothing(), shown));
        }
        let dimension = shapes.iter().find_map(|shape| shape.dimension);
        let depth = 1 + shapes.iter().map(|shape| shape.depth).max().unwrap_or(0);
        let children = shapes.into_iter().map(|shape| shape.recipe).collect();
        Ok(Made::one(self.node(combine(children), dimension, depth, span)?, shown))
    }

    /// The hull of all shapes.
    pub(in crate::script) fn hulled(&mut self, made: Made, span: Span) -> Result<Made, Failure> {
        let Made { shapes, shown } = made;
        let shapes = self.of_one_dimension(shapes, span);
        let Some(dimension) = shapes.iter().find_map(|shape| shape.dimension) else {
            return Ok(Made::one(Shape::nothing(), shown));
        };
        let depth = 1 + shapes.iter().map(|shape| shape.depth).max().unwrap_or(0);
        let children =
            shapes.into_iter().filter(|s| s.dimension.is_some()).map(|shape| shape.recipe).collect();
        Ok(Made::one(self.node(Csg::Hull { children }, Some(dimension), depth, span)?, shown))
    }

    /// All shapes joined, and what is shown, each put into an outer recipe.
    pub(in crate::script) fn wrapped(
        &mut self,
        made: Made,
        span: Span,
        wrap: impl Fn(Arc<Csg>) -> Csg,
    ) -> Result<Made, Failure> {
        let Made { shapes, shown } = self.joined(made, span)?;
        let mut all = Made::default();
        for (shapes, wrapped) in [(shapes, &mut all.shapes), (shown, &mut all.shown)] {
            for shape in shapes {
                if shape.dimension.is_none() {
                    wrapped.push(shape);
                    continue;
                }
                let recipe = wrap(shape.recipe);
                let dimension = match recipe {
                    Csg::LinearExtrude { .. } | Csg::RotateExtrude { .. } => Some(Dimension::Three),
                    _ => shape.dimension,
                };
                wrapped.push(self.node(recipe, dimension, shape.depth + 1, span)?);
            }
        }
        Ok(all)
    }

    /// Leaves out shapes whose dimension is not that of the first, with a warning.
    fn of_one_dimension(&mut self, mut shapes: Vec<Shape>, span: Span) -> Vec<Shape> {
        let first = shapes.iter().find_map(|shape| shape.dimension);
        let before = shapes.len();
        shapes.retain(|shape| shape.dimension.is_none() || shape.dimension == first);
        if shapes.len() < before {
            let (kept, dropped) = match first {
                Some(Dimension::Two) => ("plane", "solid"),
                _ => ("solid", "plane"),
            };
            let text = format!(
                "plane and solid shapes do not mix: the first is {kept}, so {dropped} ones are left out"
            );
            self.warn(span, text);
        }
        shapes
    }
}
