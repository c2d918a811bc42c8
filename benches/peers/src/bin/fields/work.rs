//! One side of a measurement, in a process of its own: meshes a model and prints what it cost as JSON.

use crate::fidgets;
use crate::files;
use crate::models::{DOMAIN, Model};
use cpu_time::ProcessTime;
use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use fidget::jit::JitShape;
use fidget::mesh::{Octree, Settings};
use ogee::csg::{self, BuildOptions, Shape};
use ogee::isosurface;
use ogee::math::Vec3;
use ogee::mesh::Mesh;
use ogee::simplify;
use std::error::Error;
use std::fs;
use std::path::Path;

/// How a model is meshed in this program; Python's ways are in `fields.py`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// As a recipe.
    Recipe,
    /// The whole field as one.
    Field,
    Fidget,
    SurfaceNets,
    /// The values on a grid alone, for whom they are made.
    Grid,
}

impl Way {
    pub(crate) const ALL: [Way; 5] = [Way::Recipe, Way::Field, Way::Fidget, Way::SurfaceNets, Way::Grid];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Way::Recipe => "ogee recipe",
            Way::Field => "ogee field",
            Way::Fidget => "fidget",
            Way::SurfaceNets => "fast-surface-nets",
            Way::Grid => "grid",
        }
    }
}

/// Meshes until it has taken a fifth of a second; the last mesh goes into the folder. `level` is a tolerance, a depth or
/// a number of cells.
pub(crate) fn run(model: &Model, way: Way, level: f64, folder: &Path) -> Result<(), Box<dyn Error>> {
    let call: Box<dyn Fn() -> Result<Made, Box<dyn Error>> + '_> = match way {
        Way::Recipe => Box::new(|| by_recipe(model, level)),
        Way::Field => Box::new(|| by_field(model, level)),
        Way::Fidget => {
            let tree = fidgets::tree(&model.plain);
            Box::new(move || by_fidget(&tree, level as u8))
        }
        Way::SurfaceNets => {
            let tree = fidgets::tree(&model.plain);
            Box::new(move || by_surface_nets(&tree, level as usize))
        }
        Way::Grid => {
            let tree = fidgets::tree(&model.plain);
            Box::new(move || Ok(Made::Grid(fidgets::grid(&JitShape::from(tree.clone()), level as usize))))
        }
    };
    let (mut best, mut peak, mut spent) = (f64::INFINITY, 0, 0.0);
    let mut result = None;
    while spent < 0.2 {
        drop(result.take());
        // Lets the peak start afresh; where that cannot be, it is the whole life's.
        let _ = fs::write("/proc/self/clear_refs", "5");
        let before = status("VmRSS:");
        let start = ProcessTime::now();
        result = Some(call()?);
        let cost = start.elapsed().as_secs_f64();
        peak = peak.max(status("VmHWM:").saturating_sub(before));
        best = f64::min(best, cost);
        spent += cost.max(1e-4);
    }
    match result {
        Some(Made::Mesh(mesh)) => files::write_meshes(&folder.join("mesh.bin"), &[mesh])?,
        Some(Made::Grid(values)) => {
            let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
            fs::write(folder.join("grid.bin"), bytes)?;
        }
        None => unreachable!("at least once"),
    }
    println!("{}", serde_json::json!({ "cpu": best, "peak": peak }));
    Ok(())
}

enum Made {
    Mesh(Mesh),
    Grid(Vec<f32>),
}

fn by_recipe(model: &Model, tolerance: f64) -> Result<Made, Box<dyn Error>> {
    let built = csg::build(&(model.recipe)(tolerance), &BuildOptions::default())?;
    match built.shape {
        Shape::Solid(solid) => Ok(Made::Mesh(solid.into_mesh())),
        Shape::Region(_) => Err("no solid".into()),
    }
}

fn by_field(model: &Model, tolerance: f64) -> Result<Made, Box<dyn Error>> {
    let field = model.field.tape();
    let meshed = isosurface::mesh(&field, &isosurface::Options::new(tolerance))?;
    if meshed.report.certified.is_none() {
        eprintln!("{}: {} cells are not proven", model.name, meshed.report.unproven.count);
    }
    Ok(Made::Mesh(simplify::to_field(&field, &meshed.mesh, tolerance).mesh.into_mesh()))
}

/// Compiling counts, as it does on our side.
fn by_fidget(tree: &fidget::context::Tree, depth: u8) -> Result<Made, Box<dyn Error>> {
    let shape = JitShape::from(tree.clone());
    let settings = Settings { depth, threads: None, ..Default::default() };
    let octree = Octree::build(&shape.try_into()?, &settings).ok_or("cancelled")?;
    let mesh = octree.walk_dual();
    let positions = mesh.vertices.iter().map(|p| [p.x, p.y, p.z].map(f64::from).into()).collect();
    let triangles = mesh.triangles.iter().map(|t| [t.x, t.y, t.z].map(|v| v as u32)).collect();
    Ok(Made::Mesh(Mesh::new(positions, triangles)))
}

fn by_surface_nets(tree: &fidget::context::Tree, cells: usize) -> Result<Made, Box<dyn Error>> {
    let values = fidgets::grid(&JitShape::from(tree.clone()), cells);
    let count = cells as u32 + 1;
    let mut buffer = SurfaceNetsBuffer::default();
    let shape = RuntimeShape::<u32, 3>::new([count; 3]);
    surface_nets(&values, &shape, [0; 3], [count - 1; 3], &mut buffer);
    let step = DOMAIN.size().x / cells as f64;
    let place = |p: &[f32; 3]| DOMAIN.min + step * Vec3::from_array(p.map(f64::from));
    let positions = buffer.positions.iter().map(place).collect();
    Ok(Made::Mesh(Mesh::new(positions, buffer.indices.as_chunks().0.to_vec())))
}

/// A line of the process's status, in bytes; 0 where there is none.
fn status(name: &str) -> u64 {
    let text = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name));
    let kilobytes =
        line.and_then(|rest| rest.split_whitespace().next()).and_then(|number| number.parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}
