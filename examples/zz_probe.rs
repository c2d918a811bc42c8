use ogee::surface::*; use ogee::tessellate::*; use ogee::mesh::*; use std::time::Instant;
fn show(name:&str, s:&[&dyn Surface], o:&SurfaceOptions){
  let t=Instant::now();
  match surfaces(s,o){ Ok(m)=>{ let d=Defects::of(&m.mesh);
   println!("{name}: {} tris bound {:?} measured {:.3e} nm {} dup {} mis {} in {:?}",m.mesh.triangles.len(),m.error.bound,m.error.measured,d.non_manifold_edges,d.duplicate_triangles,d.misoriented_edges,t.elapsed());
  }, Err(e)=>println!("{name}: {e}") } }
fn main(){
  let text=std::fs::read("fixtures/patches/teapot.bpt").unwrap();
  let patches=ogee::io::bpt::read(&text).unwrap();
  let refs:Vec<&dyn Surface>=patches.iter().map(|p|p as &dyn Surface).collect();
  for tol in [1e-2,1e-3]{ let mut o=SurfaceOptions::within(tol); show(&format!("teapot proven {tol}"),&refs,&o); o.guarantee=Guarantee::Measured; show(&format!("teapot measured {tol}"),&refs,&o);}
  for tol in [1e-1,1e-2,1e-3]{ let o=SurfaceOptions::within(tol);
   println!("sphere ideal {}", 8.0*3.14159/(3.0*3f64.sqrt()*tol));
   show("sphere",&[&Classic::Sphere{radius:1.0}],&o);
   show("torus",&[&Classic::Torus{major:2.0,minor:1.0}],&o);
   show("cone",&[&Classic::Cone{radius:2.0,height:1.0}],&o);
   show("enneper",&[&Classic::Enneper{reach:1.0}],&o);
  }
}
