//! Rays per second: our default structure against others', over the same meshes and the same rays.

mod driver;
mod peers;
mod sources;

use super::machine::{Machine, said};
use super::report::{Report, Row, fill_ratios_of_errors, fill_ratios_of_rates};
use super::{Options, program};
use crate::Failure;
use driver::Measured;
use peers::Provided;
use std::path::Path;

/// What a rate is in.
const RATE: &str = "mrays_per_s";
/// What a build is in.
const SECONDS: &str = "build_s";

/// Makes the table.
pub fn run(root: &Path, options: &Options) -> Result<(), Failure> {
    let machine = Machine::here();
    let commit = said("git", &["-C", &root.display().to_string(), "describe", "--always", "--dirty"]);
    let version = format!("photinus {} ({commit})", env!("CARGO_PKG_VERSION"));
    let folder = root.join("target/peers/rays");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let program = program::build(root, &folder, "rays")?;
    let mut notes = Vec::new();
    let embree = peers::embree(root, &folder).map_err(|why| notes.push(format!("no Embree: {why}"))).ok();
    let (meshes, missing): (Vec<Provided>, Vec<Provided>) =
        sources::meshes(&folder, options.quick).into_iter().partition(|mesh| mesh.word.is_ok());
    notes.push(format!("Embree {}", peers::EMBREE_VERSION));
    let repeats = options.repeats.unwrap_or(if options.quick { 3 } else { 7 });
    let mut rows = Vec::new();
    let mut threads = vec![1];
    if machine.processors > 1 {
        threads.push(machine.processors);
    }
    for threads in threads {
        let words: Vec<&str> = meshes.iter().filter_map(|mesh| mesh.word.as_deref().ok()).collect();
        let task = driver::Task { meshes: &words, embree: embree.as_deref(), only: &options.only, repeats, threads };
        rows.extend(driver::run(&program, &task)?.iter().map(row));
    }
    for mesh in missing {
        let why = mesh.word.err().unwrap_or_default();
        eprintln!("{}: {why}", mesh.name);
        rows.push(Row { note: why, ..Row::empty(mesh.name, String::new(), "all", 1, RATE) });
    }
    let (mut rates, mut builds): (Vec<Row>, Vec<Row>) = rows.into_iter().partition(|row| row.unit == RATE);
    fill_ratios_of_rates(&mut rates);
    fill_ratios_of_errors(&mut builds);
    rates.extend(builds);
    let report = Report { bench: "rays", version, machine, notes, rows: rates };
    println!("{}", if options.json { report.json() } else { report.wide_tables() });
    Ok(())
}

fn row(measured: &Measured) -> Row {
    let unit = if measured.set == "build" { SECONDS } else { RATE };
    let size = format!("{} {}", measured.mesh, measured.triangles);
    let mut out = Row::empty(&measured.set, size, &measured.engine, measured.threads, unit);
    out.set_values(&measured.values);
    out.note.clone_from(&measured.note);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn builds_are_seconds_and_all_else_rates() {
        let measured = |set: &str, values: Vec<f64>| Measured {
            mesh: "room-1".into(),
            triangles: 54_841,
            set: set.into(),
            engine: "photinus".into(),
            threads: 1,
            values,
            note: "0 of 9 rays differ".into(),
        };
        let rate = row(&measured("bounce", vec![3.0, 4.0, 3.5]));
        assert_eq!((rate.unit, rate.median, rate.size.as_str()), (RATE, Some(3.5), "room-1 54841"));
        assert_eq!((rate.set.as_str(), rate.note.as_str()), ("bounce", "0 of 9 rays differ"));
        assert_eq!(row(&measured("build", vec![0.03])).unit, SECONDS);
        assert_eq!(row(&measured("deep", Vec::new())).median, None);
    }
}
