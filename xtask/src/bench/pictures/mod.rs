//! The equal-time table: pictures of one scene by all engines in the same processor time, against a reference.

mod engines;
mod environment;
mod icosphere;
mod luxcore;
mod measure;
mod ply;
mod radiance;
mod references;
mod scene;
mod setting;

use super::Options;
use super::machine::{Machine, said};
use super::report::{OURS, Report, Row, fill_ratios_of_errors, median};
use crate::{Failure, tools};
use engines::{ENGINES, Engine};
use environment::{DENOISER, Environment};
use measure::{Bench, Outcome};
use setting::{LAMPS, SIZE, Setting};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is measured: the error of all that counts, and that of the caustic.
const UNITS: [&str; 2] = ["relmse_trimmed", "relmse_caustic"];

/// Makes the table.
pub fn run(root: &Path, options: &Options) -> Result<(), Failure> {
    if let Some(name) = options.only.iter().find(|name| ENGINES.iter().all(|engine| engine.name != **name)) {
        let known: Vec<&str> = ENGINES.iter().map(|engine| engine.name).collect();
        return Err(format!("no engine `{name}`: there are {}", known.join(", ")));
    }
    let machine = Machine::here();
    let photinus = build(root)?;
    let commit = said("git", &["-C", &root.display().to_string(), "describe", "--always", "--dirty"]);
    let version = format!("photinus {} ({commit})", env!("CARGO_PKG_VERSION"));
    let (environment, no_peers) = match Environment::make(root) {
        Ok(environment) => (Some(environment), None),
        Err(reason) => (None, Some(reason)),
    };
    let below = root.join("target/peers/pictures");
    let mut bench = Bench::new(photinus, environment, below, options.quick);
    let settings = setting::settings(options.quick);
    let mut notes = Vec::new();
    notes.extend(no_peers.as_ref().map(|reason| format!("no peers: {reason}")));
    for lamp in LAMPS {
        notes.push(bench.prepare(lamp)?);
    }
    notes.push(format!("peers: {}", bench.pins()));
    let chosen = |engine: &&Engine| {
        options.only.is_empty() || engine.name == OURS || options.only.iter().any(|name| name == engine.name)
    };
    let engines: Vec<&Engine> = ENGINES.iter().filter(chosen).collect();
    // Why an engine does not run, by its place; of the denoiser likewise.
    let mut excluded: Vec<Option<Failure>> = engines.iter().map(|engine| bench.provide(engine.package).err()).collect();
    let no_denoiser = bench.provide(DENOISER).err();
    notes.extend(no_denoiser.iter().map(|reason| format!("nothing denoised: {reason}")));
    for (engine, reason) in engines.iter().zip(&mut excluded) {
        if reason.is_none() {
            match bench.agrees(engine, &settings) {
                Ok(note) => notes.extend(note),
                Err(why) => {
                    eprintln!("{}: {why}", engine.name);
                    *reason = Some(why);
                }
            }
        }
    }
    let mut rows = Vec::new();
    for setting in &settings {
        let repeats = options.repeats.unwrap_or(setting.repeats);
        let mut results: Vec<Result<Vec<Outcome>, Failure>> = Vec::new();
        for (engine, reason) in engines.iter().zip(&excluded) {
            results.push(match (reason, engine.left_out_of(setting.seconds)) {
                (Some(reason), _) => Err(reason.clone()),
                (None, Some(why)) => Err(why.to_owned()),
                (None, None) => Ok(Vec::new()),
            });
        }
        for repeat in 0..repeats {
            for (engine, result) in engines.iter().zip(&mut results) {
                let Ok(outcomes) = result else { continue };
                let which = format!("{} {}, {} of {repeats}", setting.name(), engine.name, repeat + 1);
                match bench.measure(engine, setting, repeat, no_denoiser.is_none()) {
                    Ok(outcome) => {
                        eprintln!("{which}: {}", outcome.line());
                        outcomes.push(outcome);
                    }
                    Err(reason) => {
                        eprintln!("{which}: {reason}");
                        *result = Err(reason);
                    }
                }
            }
        }
        rows.extend(rows_of(setting, &engines, &results, no_denoiser.is_none()));
    }
    fill_ratios_of_errors(&mut rows);
    let report = Report { bench: "pictures", version, machine, notes, rows };
    println!("{}", if options.json { report.json() } else { report.tables() });
    Ok(())
}

/// Builds our program and says where it is.
fn build(root: &Path) -> Result<PathBuf, Failure> {
    let arguments =
        ["build", "--release", "--locked", "--quiet", "--package", "photinus-cli", "--message-format", "json"];
    let output = Command::new(tools::cargo()).args(arguments).current_dir(root).output();
    let output = output.map_err(|e| format!("cargo could not be started: {e}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned());
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let messages = text.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let mut programs = messages.filter_map(|message| message["executable"].as_str().map(PathBuf::from));
    programs
        .find(|path| path.file_stem().is_some_and(|name| name == OURS))
        .ok_or_else(|| "cargo built no photinus".into())
}

/// The rows of a setting: those of the pictures as rendered, then those of the same pictures denoised.
fn rows_of(
    setting: &Setting,
    engines: &[&Engine],
    results: &[Result<Vec<Outcome>, Failure>],
    denoised: bool,
) -> Vec<Row> {
    let mut rows = Vec::new();
    for after_denoising in [false, true] {
        if after_denoising && !denoised {
            continue;
        }
        let set = format!("{}{}", setting.name(), if after_denoising { "-denoised" } else { "" });
        for (engine, result) in engines.iter().zip(results) {
            for (i, unit) in UNITS.into_iter().enumerate() {
                let mut row = Row::empty(&set, format!("{SIZE}x{SIZE}"), engine.name, 1, unit);
                match result {
                    Err(reason) => row.note = reason.clone(),
                    Ok(outcomes) => {
                        let judged =
                            outcomes.iter().filter_map(|o| if after_denoising { o.denoised } else { Some(o.plain) });
                        let judged: Vec<measure::Judged> = judged.collect();
                        row.set_values(&judged.iter().map(|j| j.errors[i]).collect::<Vec<_>>());
                        row.cpu_seconds = median(&judged.iter().map(|j| j.cpu_seconds).collect::<Vec<_>>());
                        row.note = outcomes.first().map(|o| o.work.clone()).unwrap_or_default();
                    }
                }
                rows.push(row);
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::measure::Judged;
    use super::*;

    #[test]
    fn each_engine_has_a_row_for_each_unit_and_a_missing_one_says_why() {
        let settings = setting::settings(true);
        let engines: Vec<&Engine> = ENGINES.iter().take(3).collect();
        let outcome = |error: f64| Outcome {
            plain: Judged { errors: [error, 2.0 * error], cpu_seconds: 10.0 },
            denoised: Some(Judged { errors: [0.5 * error, error], cpu_seconds: 10.7 }),
            work: "9 passes".into(),
        };
        let results = vec![
            Ok(vec![outcome(0.001), outcome(0.003), outcome(0.002)]),
            Ok(vec![outcome(0.04)]),
            Err("pip could not install it".to_owned()),
        ];
        let mut rows = rows_of(&settings[0], &engines, &results, true);
        fill_ratios_of_errors(&mut rows);
        assert_eq!(rows.len(), 3 * 2 * 2);
        assert_eq!((rows[0].set.as_str(), rows[0].unit), ("large-lamp-10s", "relmse_trimmed"));
        assert_eq!((rows[0].median, rows[0].low, rows[0].high), (Some(0.002), Some(0.001), Some(0.003)));
        assert_eq!(rows[0].ratio_to_best_peer, Some(20.0));
        assert_eq!((rows[1].unit, rows[1].median), ("relmse_caustic", Some(0.004)));
        assert_eq!((rows[4].median, rows[4].note.as_str()), (None, "pip could not install it"));
        assert_eq!((rows[6].set.as_str(), rows[6].cpu_seconds), ("large-lamp-10s-denoised", Some(10.7)));
        assert_eq!(rows_of(&settings[0], &engines, &results, false).len(), 6);
    }
}
