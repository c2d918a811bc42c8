//! The same booleans through manifold3d and ogee, in one run. See README.md.

#[allow(dead_code, reason = "shared with the tests")]
#[path = "../../../tests/check/mod.rs"]
mod check;
#[allow(dead_code, reason = "shared with the tests")]
#[path = "../../../tests/oracle/mod.rs"]
mod oracle;
#[allow(dead_code, reason = "shared with the tests")]
#[path = "../../../tests/solids/mod.rs"]
mod solids;
#[allow(dead_code, reason = "shared with the tests")]
#[path = "../../../tests/zoo/specimens.rs"]
mod specimens;

mod cases;
mod files;
mod real;
mod work;

use cases::{Case, Known};
use check::Shape;
use clap::Parser;
use serde_json::Value;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[derive(Parser)]
#[command(about = "The same booleans through manifold3d and ogee, in one run")]
struct Options {
    /// Only cases whose name has this in it.
    #[arg(long, default_value = "")]
    case: String,
    /// Processors for each side.
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Processes for each side; the best one counts.
    #[arg(long, default_value_t = 3)]
    repeat: usize,
    /// Seconds after which a process is ended.
    #[arg(long, default_value_t = 300)]
    limit: u64,
    /// The Python that makes the virtual environment.
    #[arg(long, default_value = "python3")]
    python: String,
    /// Print the names of the cases and stop.
    #[arg(long)]
    list: bool,
    /// Be our side of this case, in this folder.
    #[arg(long, hide = true, num_args = 2, value_names = ["CASE", "FOLDER"])]
    work: Option<Vec<String>>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let is_ours = options.work.is_some() || options.list;
    let python = if is_ours { PathBuf::new() } else { environment(&options.python)? };
    if !is_ours {
        real::fetch(&python);
    }
    let cases = cases::all();
    if let Some([name, folder]) = options.work.as_deref() {
        let case = cases.iter().find(|case| case.name == *name).ok_or("no such case")?;
        return Ok(work::run(case, Path::new(folder))?);
    }
    let chosen: Vec<&Case> = cases.iter().filter(|case| case.name.contains(&options.case)).collect();
    if options.list {
        chosen.iter().for_each(|case| println!("{}", case.name));
        return Ok(());
    }
    println!(
        "case,threads,triangles in,ours s,manifold3d s,ratio,ours MB,manifold3d MB,memory ratio,ours triangles,\
         manifold3d triangles,ours volume error,manifold3d volume error,note"
    );
    for case in chosen {
        eprintln!("{}", case.name);
        println!("{}", measure(case, &options, &python)?);
    }
    Ok(())
}

/// The Python that has the pinned manifold3d; made on the first run.
fn environment(python: &str) -> Result<PathBuf, Box<dyn Error>> {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    let inside = home.join(".venv/bin/python");
    let works =
        || Command::new(&inside).args(["-c", "import manifold3d, numpy"]).status().is_ok_and(|s| s.success());
    if !inside.exists() || !works() {
        eprintln!("making {}", home.join(".venv").display());
        let made = Command::new(python).args(["-m", "venv"]).arg(home.join(".venv")).status()?;
        let requirements = home.join("requirements.txt");
        let pip = Command::new(&inside)
            .args(["-m", "pip", "install", "--quiet", "-r"])
            .arg(requirements)
            .status()?;
        if !made.success() || !pip.success() || !works() {
            return Err("manifold3d could not be installed".into());
        }
    }
    Ok(inside)
}

/// What one side came to.
struct Side {
    cpu: f64,
    peak: f64,
    shape: Shape,
    triangles: usize,
}

/// The row of a case.
fn measure(case: &Case, options: &Options, python: &Path) -> Result<String, Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("ogee-peers-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let work = case.work();
    files::write_meshes(&folder.join("operands.bin"), &work.operands)?;
    case.write(&folder, &work.tree)?;
    let triangles: usize = work.operands.iter().map(|mesh| mesh.triangles.len()).sum();
    drop(work.operands);

    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for _ in 0..options.repeat {
        let mut own = held_to(options.threads, &std::env::current_exe()?);
        own.args(["--work", &case.name]).arg(&folder).env("RAYON_NUM_THREADS", options.threads.to_string());
        ours.push(run(own, options.limit));
        let mut peer = held_to(options.threads, python);
        peer.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("peer.py"))
            .arg(&folder)
            .arg(options.threads.to_string());
        theirs.push(run(peer, options.limit));
    }
    let sides = [side(&ours, &folder.join("ours.bin")), side(&theirs, &folder.join("peer.bin"))];
    fs::remove_dir_all(&folder)?;
    Ok(row(case, options.threads, triangles, work.known, &sides))
}

/// A command that runs on so many processors only, where `taskset` is to be had.
fn held_to(threads: usize, program: &Path) -> Command {
    let has_taskset = Command::new("taskset").arg("--version").stdout(Stdio::null()).status().is_ok();
    if !has_taskset {
        eprintln!("no taskset: the two sides are not held to {threads} processors");
        return Command::new(program);
    }
    let mut command = Command::new("taskset");
    command.args(["--cpu-list", &format!("0-{}", threads - 1)]).arg(program);
    command
}

/// Runs a side in its own process: CPU seconds and bytes, or why there are none.
fn run(mut command: Command, limit: u64) -> Result<(f64, f64), String> {
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| error.to_string())?;
    let start = Instant::now();
    while child.try_wait().map_err(|error| error.to_string())?.is_none() {
        if start.elapsed() > Duration::from_secs(limit) {
            child.kill().map_err(|error| error.to_string())?;
            child.wait().map_err(|error| error.to_string())?;
            return Err(format!("took longer than {limit} s"));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().map_err(|error| error.to_string())?;
    let value: Value =
        serde_json::from_slice(&output.stdout).map_err(|_| format!("failed: {}", output.status))?;
    let number = |name: &str| value[name].as_f64().ok_or_else(|| format!("said no {name}"));
    Ok((number("cpu")?, number("peak")?))
}

fn side(runs: &[Result<(f64, f64), String>], result: &Path) -> Result<Side, String> {
    let mut best = (f64::INFINITY, f64::INFINITY);
    for run in runs {
        let (cpu, peak) = run.clone()?;
        best = (best.0.min(cpu), best.1.min(peak));
    }
    let mesh = files::read_meshes(result).map_err(|error| error.to_string())?.pop().ok_or("no mesh")?;
    Ok(Side { cpu: best.0, peak: best.1, shape: Shape::of(&mesh), triangles: mesh.triangles.len() })
}

fn row(
    case: &Case,
    threads: usize,
    triangles: usize,
    known: Known,
    sides: &[Result<Side, String>; 2],
) -> String {
    let mut notes = Vec::new();
    for (side, name) in sides.iter().zip(["ours", "manifold3d"]) {
        match side {
            Err(error) => notes.push(format!("{name} {error}")),
            Ok(side) => {
                notes.extend(faults(&side.shape, known).into_iter().map(|fault| format!("{name}: {fault}")))
            }
        }
    }
    if let [Ok(ours), Ok(theirs)] = sides {
        let (a, b) = (&ours.shape, &theirs.shape);
        if known.components.is_none() && (a.components.len(), a.genus()) != (b.components.len(), b.genus()) {
            let pair = |s: &Shape| format!("{} components of genus {}", s.components.len(), s.genus());
            notes.push(format!("ours has {} and manifold3d {}", pair(a), pair(b)));
        }
        if known.volume.is_none() && (a.volume_f64() - b.volume_f64()).abs() > 1e-9 * a.volume_f64() {
            notes.push(format!("volumes {} and {}", a.volume_f64(), b.volume_f64()));
        }
    }
    let [ours, theirs] = sides;
    let bracket = |text: String| if notes.is_empty() { text } else { format!("({text})") };
    let of = |side: &Result<Side, String>, value: &dyn Fn(&Side) -> String| {
        side.as_ref().map_or(String::new(), value)
    };
    let ratio = |value: &dyn Fn(&Side) -> f64| match (ours, theirs) {
        (Ok(a), Ok(b)) => format!("{:.3}", value(a) / value(b)),
        _ => String::new(),
    };
    let cpu = |s: &Side| bracket(format!("{:.6}", s.cpu));
    let peak = |s: &Side| format!("{:.1}", s.peak / 1e6);
    // Against the volume known by hand, or against the exact side.
    let reference = known.volume.or(ours.as_ref().ok().map(|side| side.shape.volume_f64()));
    let error = |s: &Side| {
        let off = reference.map_or(f64::NAN, |v| (s.shape.volume_f64() - v).abs() / v.max(f64::MIN_POSITIVE));
        format!("{off:.1e}")
    };
    let count = |s: &Side| s.triangles.to_string();
    [
        case.name.clone(),
        threads.to_string(),
        triangles.to_string(),
        of(ours, &cpu),
        of(theirs, &cpu),
        bracket(ratio(&|s| s.cpu)),
        of(ours, &peak),
        of(theirs, &peak),
        ratio(&|s| s.peak),
        of(ours, &count),
        of(theirs, &count),
        of(ours, &error),
        of(theirs, &error),
        notes.join("; ").replace(',', " "),
    ]
    .join(",")
}

/// What is wrong with a result by itself or against what is known.
fn faults(shape: &Shape, known: Known) -> Vec<String> {
    let mut found = shape.faults.clone();
    if !found.is_empty() {
        return found;
    }
    if known.components.is_some_and(|count| count != shape.components.len()) {
        found.push(format!("{} components instead of {:?}", shape.components.len(), known.components));
    }
    if known.genus.is_some_and(|genus| genus != shape.genus()) {
        found.push(format!("genus {} instead of {:?}", shape.genus(), known.genus));
    }
    if known.volume.is_some_and(|volume| (shape.volume_f64() - volume).abs() > 1e-9 * volume) {
        found.push(format!("volume {} instead of {:?}", shape.volume_f64(), known.volume));
    }
    found
}
