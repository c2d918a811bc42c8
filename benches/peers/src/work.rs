//! One side of a measurement: runs a case through ogee and prints what it cost as JSON.

use crate::cases::{Case, Work};
use crate::files;
use cpu_time::ProcessTime;
use ogee::boolean::{self, Combined, Operand, Tree};
use ogee::mesh::Solid;
use std::fs;
use std::path::Path;

/// Runs the case until it has taken a fifth of a second; the result goes into the folder.
pub(crate) fn run(case: &Case, folder: &Path) -> std::io::Result<()> {
    let Work { tree, operands, .. } = case.work();
    let solids: Vec<Solid> = if case.imported {
        Vec::new()
    } else {
        let alone = |mesh| boolean::evaluate(&Tree::Leaf(0), &[mesh]).expect("a closed mesh").solid;
        operands.iter().map(alone).collect()
    };
    let call = || -> Combined {
        let handed: Vec<Operand<'_>> = if case.imported {
            operands.iter().map(Operand::from).collect()
        } else {
            solids.iter().map(Operand::from).collect()
        };
        boolean::evaluate(&tree, &handed).expect("closed operands")
    };
    let (mut best, mut peak, mut spent) = (f64::INFINITY, 0, 0.0);
    let mut result = Combined::default();
    while spent < 0.2 {
        drop(std::mem::take(&mut result));
        // Lets the peak start afresh; where that cannot be, it is the whole life's.
        let _ = fs::write("/proc/self/clear_refs", "5");
        let before = status("VmRSS:");
        let start = ProcessTime::now();
        result = call();
        let cost = start.elapsed().as_secs_f64();
        peak = peak.max(status("VmHWM:").saturating_sub(before));
        best = f64::min(best, cost);
        spent += cost.max(1e-4);
    }
    files::write_meshes(&folder.join("ours.bin"), &[result.solid.into_mesh()])?;
    println!("{}", serde_json::json!({ "cpu": best, "peak": peak }));
    Ok(())
}

/// A line of the process's status, in bytes; 0 where there is none.
fn status(name: &str) -> u64 {
    let text = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name));
    let kilobytes =
        line.and_then(|rest| rest.split_whitespace().next()).and_then(|number| number.parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}
