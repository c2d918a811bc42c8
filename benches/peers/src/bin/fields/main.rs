//! Fields through ogee and its peers, in one run: what a mesh costs at equal measured error. See README.md.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

mod compare;
mod fidgets;
#[path = "../../files.rs"]
mod files;
mod judge;
mod models;
mod python;
mod throughput;
mod truth;
mod work;

use clap::Parser;
use compare::Row;
use judge::Judge;
use models::Model;
use serde_json::Value;
use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use work::Way;

#[derive(Parser)]
#[command(about = "Fields through ogee, fidget, fast-surface-nets, manifold3d and scikit-image, in one run")]
struct Options {
    /// Only models whose name has this in it.
    #[arg(long, default_value = "")]
    case: String,
    /// Only methods whose name has this in it.
    #[arg(long, default_value = "")]
    method: String,
    /// Write the rows to this file instead of standard output.
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Processes a row; the fastest counts.
    #[arg(long, default_value_t = 2)]
    repeat: usize,
    /// Seconds after which a process is ended, and its method not tried any finer.
    #[arg(long, default_value_t = 60)]
    limit: u64,
    /// The Python that makes the virtual environment.
    #[arg(long, default_value = "python3")]
    python: String,
    /// Print the names of the models and stop.
    #[arg(long)]
    list: bool,
    /// Only values a second over a union of 500 balls.
    #[arg(long)]
    throughput: bool,
    /// Be one side: this model, method and level, in this folder.
    #[arg(long, hide = true, num_args = 4, value_names = ["MODEL", "METHOD", "LEVEL", "FOLDER"])]
    work: Option<Vec<String>>,
}

/// A method by name and what it is tried with, coarse first.
struct Method {
    name: &'static str,
    steps: Vec<Step>,
    levels: Vec<f64>,
}

/// A process of a method; a method's cost is that of all of them.
#[derive(Clone, Copy)]
enum Step {
    Own(Way),
    Python(&'static str),
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let models = models::all();
    if let Some([name, way, level, folder]) = options.work.as_deref() {
        let model = models.iter().find(|model| model.name == *name).ok_or("no such model")?;
        let way = Way::ALL.into_iter().find(|known| known.name() == *way).ok_or("no such method")?;
        return work::run(model, way, level.parse()?, Path::new(folder));
    }
    if options.list {
        models.iter().for_each(|model| println!("{}", model.name));
        return Ok(());
    }
    if options.throughput {
        throughput::rows();
        return Ok(());
    }
    let python = python::environment(&options.python);
    let methods: Vec<Method> =
        methods(python.is_some()).into_iter().filter(|m| m.name.contains(&options.method)).collect();
    let mut out: Box<dyn Write> = match &options.csv {
        Some(path) => Box::new(fs::File::create(path)?),
        None => Box::new(std::io::stdout()),
    };
    let mut all = Vec::new();
    writeln!(out, "{}", Row::HEADER)?;
    for model in models.iter().filter(|model| model.name.contains(&options.case)) {
        let judge = Judge::of(model);
        for method in &methods {
            eprintln!("{}: {}", model.name, method.name);
            for row in measured(model, method, &judge, &options, python.as_deref())? {
                writeln!(out, "{row}")?;
                out.flush()?;
                all.push(row);
            }
        }
    }
    compare::print(&all);
    Ok(())
}

fn methods(with_python: bool) -> Vec<Method> {
    let tolerances = vec![1e-2, 3e-3, 1e-3, 3e-4, 1e-4];
    let cells = vec![16.0, 24.0, 32.0, 48.0, 64.0, 96.0, 128.0, 192.0, 256.0];
    let own = |way: Way, levels: &[f64]| Method {
        name: way.name(),
        steps: vec![Step::Own(way)],
        levels: levels.to_vec(),
    };
    let mut all = vec![
        own(Way::Recipe, &tolerances),
        own(Way::Field, &tolerances),
        own(Way::Fidget, &[4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
        own(Way::SurfaceNets, &cells),
    ];
    if with_python {
        all.push(Method {
            name: "scikit-image",
            steps: vec![Step::Own(Way::Grid), Step::Python("grid")],
            levels: cells.clone(),
        });
        all.push(Method {
            name: "manifold3d",
            steps: vec![Step::Python("level")],
            levels: cells[..7].to_vec(),
        });
    }
    all
}

/// A method's rows over a model, until one takes too long or fails.
fn measured(
    model: &Model,
    method: &Method,
    judge: &Judge<'_>,
    options: &Options,
    python: Option<&Path>,
) -> Result<Vec<Row>, Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("ogee-fields-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("field.py"), python::source(&model.plain))?;
    let mut rows = Vec::new();
    for &level in &method.levels {
        let cost = method.cost(model, level, options, python, &folder);
        match cost {
            Ok([seconds, bytes]) => {
                let mesh = files::read_meshes(&folder.join("mesh.bin"))?.pop().ok_or("no mesh")?;
                let judgement = judge.judge(&mesh);
                rows.push(Row { model: model.name, method: method.name, level, seconds, bytes, judgement });
            }
            Err(error) => {
                eprintln!("{}: {} at {level}: {error}", model.name, method.name);
                break;
            }
        }
    }
    fs::remove_dir_all(&folder)?;
    Ok(rows)
}

impl Method {
    /// The least seconds and bytes over all repetitions.
    fn cost(
        &self,
        model: &Model,
        level: f64,
        options: &Options,
        python: Option<&Path>,
        folder: &Path,
    ) -> Result<[f64; 2], String> {
        let mut best = [f64::INFINITY; 2];
        for _ in 0..options.repeat {
            let (mut seconds, mut bytes) = (0.0, 0.0_f64);
            for &step in &self.steps {
                let [more, peak] = run(step.command(model, level, python, folder), options.limit)?;
                seconds += more;
                bytes = bytes.max(peak);
            }
            best = [best[0].min(seconds), best[1].min(bytes)];
            // What takes long is measured well enough once.
            if seconds > 5.0 {
                break;
            }
        }
        Ok(best)
    }
}

impl Step {
    fn command(self, model: &Model, level: f64, python: Option<&Path>, folder: &Path) -> Command {
        let level = level.to_string();
        let mut command = match self {
            Step::Own(way) => {
                let mut command = Command::new(std::env::current_exe().expect("a program"));
                command.args(["--work", model.name, way.name(), &level]).arg(folder);
                command
            }
            Step::Python(way) => {
                let mut command = Command::new(python.expect("asked for only where there is one"));
                command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("fields.py"));
                command.arg(way).arg(folder).arg(&level);
                command
            }
        };
        command.env("RAYON_NUM_THREADS", "1").env("OMP_NUM_THREADS", "1");
        command
    }
}

/// Runs a side in its own process: CPU seconds and bytes, or why there are none.
fn run(mut command: Command, limit: u64) -> Result<[f64; 2], String> {
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
    Ok([number("cpu")?, number("peak")?])
}
