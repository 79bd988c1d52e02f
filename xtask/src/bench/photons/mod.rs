//! Photon searches: our default search against others', over the same photons of a scene at the same places of its picture.

mod driver;
mod peers;

use super::machine::{Machine, said};
use super::report::{Report, Row, fill_ratios_of_errors, fill_ratios_of_rates, less_is_better};
use super::{Options, program};
use crate::Failure;
use driver::Measured;
use std::path::{Path, PathBuf};

/// Units of the driver's rows.
const UNITS: &[&str] = &["ns_per_search", "ns_per_photon", "g_tests_per_s"];
/// Numbers of photons; the first alone where it is to be quick.
const PHOTONS: &[usize] = &[65_536, 1_000_000, 10_000_000];
/// Queries of a set, about; fewer where it is to be quick.
const QUERIES: usize = 1 << 17;
const FEW_QUERIES: usize = 1 << 16;
/// Measurements of each.
const REPEATS: usize = 3;
/// Folder of the suite of real scenes, where it is set.
const SCENES: &str = "PHOTINUS_SCENES";
/// The real scene.
const LIVING_ROOM: (&str, &str) = ("living-room", "rooms/living-room-mitsuba/scene.xml");

/// Makes the table.
pub fn run(root: &Path, options: &Options) -> Result<(), Failure> {
    let machine = Machine::here();
    let commit = said("git", &["-C", &root.display().to_string(), "describe", "--always", "--dirty"]);
    let version = format!("photinus {} ({commit})", env!("CARGO_PKG_VERSION"));
    let folder = root.join("target/peers/photons");
    let work = folder.join("work");
    std::fs::create_dir_all(&work).map_err(|e| format!("{}: {e}", work.display()))?;
    let program = program::build(root, &folder, "photons")?;
    let mut notes = Vec::new();
    let nanoflann = peers::nanoflann(root, &folder).map_err(|why| notes.push(format!("no nanoflann: {why}"))).ok();
    let python = peers::python(root, &folder).map_err(|why| notes.push(format!("no Python peers: {why}"))).ok();
    let nanoflann_version = peers::nanoflann_version(&folder).unwrap_or_else(|| "is missing".into());
    notes.push(format!("nanoflann {nanoflann_version}; {}", peers::pinned(root)));

    let (mut scenes, mut rows) = (vec!["room-1".to_owned()], Vec::new());
    if !options.quick {
        match living_room(std::env::var_os(SCENES).map(PathBuf::from)) {
            Ok(word) => scenes.push(word),
            Err(why) => {
                eprintln!("{}: {why}", LIVING_ROOM.0);
                rows.push(Row { note: why, ..Row::empty("all", LIVING_ROOM.0.to_owned(), "all", 1, UNITS[0]) });
            }
        }
    }
    let mut threads = vec![1];
    if machine.processors > 1 {
        threads.push(machine.processors);
    }
    let scenes: Vec<&str> = scenes.iter().map(String::as_str).collect();
    let task = driver::Task {
        scenes: &scenes,
        photons: if options.quick { &PHOTONS[..1] } else { PHOTONS },
        nanoflann: nanoflann.as_deref(),
        python: python.as_ref(),
        work: &work,
        only: &options.only,
        repeats: options.repeats.unwrap_or(REPEATS),
        threads: &threads,
        queries: if options.quick { FEW_QUERIES } else { QUERIES },
    };
    rows.extend(driver::run(&program, &task)?.iter().map(row));
    let (mut times, mut rates): (Vec<Row>, Vec<Row>) = rows.into_iter().partition(|row| less_is_better(row.unit));
    fill_ratios_of_errors(&mut times);
    fill_ratios_of_rates(&mut rates);
    times.extend(rates);
    let report = Report { bench: "photons", version, machine, notes, rows: times };
    println!("{}", if options.json { report.json() } else { report.wide_tables() });
    Ok(())
}

/// The word of the real scene, from the folder of the suite.
fn living_room(suite: Option<PathBuf>) -> Result<String, Failure> {
    let file = suite.ok_or_else(|| format!("{SCENES} is not set"))?.join(LIVING_ROOM.1);
    let word = format!("{}={}", LIVING_ROOM.0, file.display());
    if file.is_file() { Ok(word) } else { Err(format!("{} is missing", file.display())) }
}

fn row(measured: &Measured) -> Row {
    let unit = UNITS.iter().copied().find(|unit| *unit == measured.unit).unwrap_or("unknown");
    let size = format!("{} {}", measured.scene, measured.photons);
    let mut out = Row::empty(&measured.set, size, &measured.engine, measured.threads, unit);
    out.set_values(&measured.values);
    out.note.clone_from(&measured.note);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_the_drivers_units_and_what_is_missing_is_named() {
        let measured = |unit: &str, values: Vec<f64>| Measured {
            scene: "room-1".into(),
            photons: 65_536,
            set: "flux".into(),
            engine: "photinus".into(),
            threads: 1,
            unit: unit.into(),
            values,
            note: "flux, facing normals".into(),
        };
        let found = row(&measured("ns_per_search", vec![300.0, 200.0, 250.0]));
        assert_eq!((found.unit, found.median, found.size.as_str()), ("ns_per_search", Some(250.0), "room-1 65536"));
        assert_eq!((found.set.as_str(), found.note.as_str()), ("flux", "flux, facing normals"));
        assert_eq!(row(&measured("furlongs", Vec::new())).unit, "unknown");
        assert_eq!(UNITS.iter().map(|unit| less_is_better(unit)).collect::<Vec<_>>(), [true, true, false]);

        let folder = tempfile::tempdir().unwrap();
        assert!(living_room(None).is_err_and(|why| why.contains(SCENES)));
        assert!(living_room(Some(folder.path().into())).is_err_and(|why| why.contains("missing")));
    }
}
