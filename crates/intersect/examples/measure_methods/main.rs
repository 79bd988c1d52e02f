//! Measures every ray-triangle method in single precision on one thread: time of a test, wrong answers against doubles,
//! rays that leave closed meshes, and the nearest hits of a room.
//!
//! `cargo run --release -p photinus-intersect --example measure_methods [-- [--json] [--seed N] [--methods A,B...] [FOLDER]]`
//!
//! `--json` prints a JSON document instead of the table; with a folder the document is also written there.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

#[path = "../../tests/common/mod.rs"]
mod common;
mod leaks;
mod room;
mod speed;
mod wrong;

use photinus_intersect::{METHODS, MethodInfo, find_method};
use std::error::Error;
use std::path::PathBuf;

/// A named figure of one method.
type Figure = (String, f64);

/// What the command line asks for.
struct Wanted {
    json: bool,
    seed: u64,
    methods: Vec<&'static MethodInfo>,
    folder: Option<PathBuf>,
}

impl Wanted {
    fn from_arguments() -> Result<Self, String> {
        let mut wanted = Self { json: false, seed: 1, methods: METHODS.iter().collect(), folder: None };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--json" => wanted.json = true,
                "--seed" => {
                    let seed = arguments.next().and_then(|n| n.parse().ok());
                    wanted.seed = seed.ok_or("--seed takes a whole number")?;
                }
                "--methods" => {
                    let names = arguments.next().unwrap_or_default();
                    let found = names.split(',').map(|n| find_method(n).ok_or(format!("no method is called '{n}'")));
                    wanted.methods = found.collect::<Result<_, _>>()?;
                }
                option if option.starts_with('-') => return Err(format!("there is no option {option}")),
                folder => wanted.folder = Some(folder.into()),
            }
        }
        Ok(wanted)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let Wanted { json, seed, methods, folder } = Wanted::from_arguments()?;
    let mut figures: Vec<Vec<Figure>> = speed::measure(seed, &methods);
    for case in wrong::CASES {
        let pairs = wrong::pairs(case, seed);
        for (method, row) in methods.iter().zip(&mut figures) {
            row.extend(wrong::count(method, case, &pairs));
        }
    }
    let room = room::Room::new(seed);
    for (method, row) in methods.iter().zip(&mut figures) {
        row.extend(leaks::count(method, seed));
        row.extend(room.count(method));
    }
    let document = document(seed, &methods, &figures);
    if let Some(folder) = folder {
        std::fs::write(folder.join("measure_methods.json"), &document)?;
    }
    if json {
        print!("{document}");
    } else {
        println!("seed {seed}");
        print_table(&methods, &figures);
    }
    Ok(())
}

/// The figures as JSON.
fn document(seed: u64, methods: &[&MethodInfo], figures: &[Vec<Figure>]) -> String {
    let row = |(method, row): (&&MethodInfo, &Vec<Figure>)| {
        let fields: Vec<String> = row.iter().map(|(name, value)| format!("\"{name}\": {value:.2}")).collect();
        format!("    {{\"method\": \"{}\", {}}}", method.name, fields.join(", "))
    };
    let rows: Vec<String> = methods.iter().zip(figures).map(row).collect();
    format!("{{\"seed\": {seed}, \"methods\": [\n{}\n]}}\n", rows.join(",\n"))
}

/// One line a figure, one column a method: names of figures are long.
fn print_table(methods: &[&MethodInfo], figures: &[Vec<Figure>]) {
    let header: String = methods.iter().map(|m| format!("{:>17}", m.name)).collect();
    println!("{:<44}{header}", "");
    for (i, (name, _)) in figures[0].iter().enumerate() {
        let cells: String = figures
            .iter()
            .map(|row| match row[i].1 {
                x if x.fract() == 0.0 => format!("{x:>17}"),
                x => format!("{x:>17.2}"),
            })
            .collect();
        println!("{name:<44}{cells}");
    }
}
