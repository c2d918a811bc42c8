//! x
#[allow(dead_code)]
mod check;
#[allow(dead_code)]
mod nasty;
#[allow(dead_code)]
mod oracle;
#[allow(dead_code)]
mod solids;
use ogee::boolean::*;
use ogee::math::*;
use ogee::mesh::*;
#[test]
fn dbg() {
    for axis in [Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, -2.0, 0.5), Vec3::Z] {
        for angle in [1e-9, 1e-6, 1e-12, 1e-15] {
            for off in [0.0, 1.0] {
                let cubes: Vec<Mesh> = (0..30)
                    .map(|i| {
                        let q = Quat::from_axis_angle(axis.normalize(), angle * f64::from(i));
                        let mut m = cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)).into_mesh();
                        m.positions.iter_mut().for_each(|p| *p = q * *p + off * Vec3::new(0.3, 0.2, 0.1));
                        m
                    })
                    .collect();
                let c: Vec<&Mesh> = cubes.iter().collect();
                let x = evaluate(&Tree::flat(Op::Union, 30), &c).unwrap();
                println!(
                    "{axis} {angle:e} {off} round: {} triangles {:?} {:?} {}",
                    x.solid.triangles().len(),
                    x.certificate,
                    check::crossing::crossings(x.solid.mesh()),
                    x.solid.measures().volume
                );
            }
        }
    }
    let ball = sphere(1.0, 48).unwrap();
    for k in 1..5 {
        let mut m = ball.mesh().clone();
        m.positions
            .iter_mut()
            .for_each(|p| *p = *p * (1.0 + f64::from(k) * 1e-16) + Vec3::new(1e-16, 2e-16, 0.0));
        for op in [Op::Union, Op::Difference, Op::Intersection, Op::SymmetricDifference] {
            let x = evaluate(&Tree::flat(op, 2), &[ball.mesh(), &m]).unwrap();
            println!(
                "ball {op:?} round: {} triangles {:?} {:?} {}",
                x.solid.triangles().len(),
                x.certificate,
                check::crossing::crossings(x.solid.mesh()),
                x.solid.measures().volume
            );
        }
    }
}
