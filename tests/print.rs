//! Printed recipes, read back by the script language.

use ogee::boolean::Op;
use ogee::csg::{Body, BuildOptions, Csg, Flat, LinearSweep, RotateSweep, Shape, build, print};
use ogee::math::{Affine3, Vec2, Vec3};
use ogee::mesh::{Mesh, cuboid};
use ogee::script::{self, Host, Loaded, Message, Options};
use std::sync::Arc;

/// A world without files, which expects no complaint.
struct Nowhere;

impl Host for Nowhere {
    fn script(&mut self, name: &str, _: &str) -> Result<Loaded, String> {
        Err(format!("no script {name}"))
    }

    fn mesh(&mut self, name: &str, _: &str) -> Result<Arc<Mesh>, String> {
        Err(format!("no mesh {name}"))
    }

    fn say(&mut self, message: Message) {
        panic!("{message:?}");
    }
}

fn read_back(text: String) -> Arc<Csg> {
    let main = Loaded { name: "printed".to_owned(), text };
    script::evaluate(main, &mut Nowhere, &Options::default()).unwrap().recipe
}

fn shape(recipe: &Csg) -> Shape {
    build(recipe, &BuildOptions::default()).unwrap().shape
}

/// Corners of all triangles or contours, sorted: the shape without the order of its parts.
fn corners(shape: &Shape) -> Vec<[u64; 3]> {
    let mut corners: Vec<[u64; 3]> = match shape {
        Shape::Solid(solid) => solid.positions().iter().map(Vec3::to_array).collect::<Vec<_>>(),
        Shape::Region(region) => {
            region.contours().iter().flatten().map(|p| p.extend(0.0).to_array()).collect()
        }
    }
    .into_iter()
    .map(|p| p.map(|c| (c + 0.0).to_bits()))
    .collect();
    corners.sort_unstable();
    corners
}

#[test]
fn what_is_printed_reads_back_to_the_same_bits() {
    let arc = Arc::<Csg>::new;
    let ring: Vec<Vec2> = [(1.0, 0.1), (2.0, 0.0), (1.5, 1.0 / 3.0)].map(Vec2::from).to_vec();
    let polygon = Csg::Flat(Flat::Polygon { contours: Arc::new(vec![ring]) });
    let circle = Csg::Flat(Flat::Circle { radius: 2.0 / 3.0, fragments: 7 });
    let wide = Csg::Flat(Flat::Circle { radius: 5.0 / 3.0, fragments: 12 });
    let third = Vec3::splat(1.0 / 3.0);
    let cube = Csg::Body(Body::Cuboid { min: -third, max: Vec3::ONE });
    let turn = |angle: f64, fragments| Csg::RotateExtrude {
        sweep: RotateSweep { angle: angle.to_radians(), start: 0.7, fragments },
        child: arc(polygon.clone()),
    };
    let sweep = LinearSweep {
        vector: Vec3::new(0.0, 0.0, 0.3),
        center: true,
        twist: 100_f64.to_radians(),
        slices: 3,
        scale: Vec2::new(0.5, 1.0 / 7.0),
    };
    let map = Affine3::from_axis_angle(Vec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
    let cases = [
        polygon.clone(),
        Csg::Flat(Flat::Rectangle { min: Vec2::new(0.1, 0.2), max: Vec2::new(0.3, 0.7) }),
        cube.clone(),
        Csg::Body(Body::Sphere { radius: 0.1, fragments: 9 }),
        Csg::Body(Body::Frustum { heights: [0.0, 0.7], radii: [0.1, 0.0], fragments: 5 }),
        Csg::Body(Body::Frustum { heights: [-0.35, 0.35], radii: [0.0, 3.0], fragments: 12 }),
        Csg::Body(Body::Mesh(Arc::new(cuboid(Vec3::ZERO, third).into_mesh()))),
        Csg::LinearExtrude { sweep, child: arc(circle.clone()) },
        turn(360.0, 5),
        turn(120.0, 4),
        turn(100.0, 3),
        turn(359.0, 50),
        Csg::Hull {
            children: vec![arc(cube.clone()), arc(Csg::Body(Body::Sphere { radius: 1.0, fragments: 6 }))],
        },
        Csg::Combine {
            op: Op::Difference,
            children: vec![
                arc(Csg::Transform { map, child: arc(cube.clone()) }),
                arc(Csg::Color { color: [0.1, 0.2, 0.3, 1.0], child: arc(cube) }),
            ],
        },
        Csg::Combine { op: Op::Intersection, children: vec![arc(polygon.clone()), arc(wide)] },
    ];
    for recipe in cases {
        let text = print(&recipe);
        let back = read_back(text.clone());
        assert_eq!(corners(&shape(&back)), corners(&shape(&recipe)), "{text}");
        assert!(!corners(&shape(&back)).is_empty(), "{text}");
    }
}
