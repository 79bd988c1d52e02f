//! Measures every ray-triangle method in single precision on one thread: time of a test, wrong answers against doubles,
//! rays that leave closed meshes, and the nearest hits of a room.
//!
//! `cargo run --release -p photinus-intersect --example measure_methods [-- [--json] [--seed N] [METHOD...]]`

#![allow(clippy::print_stdout, clippy::print_stderr)]

#[path = "../../tests/common/mod.rs"]
mod common;
mod leaks;
mod room;
mod speed;
mod wrong;

use photinus_intersect::{METHODS, MethodInfo};

/// A named figure of one method.
type Figure = (String, f64);

fn main() {
    let (mut json, mut seed, mut names) = (false, 1, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--json" => json = true,
            "--seed" => seed = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(seed),
            name => names.push(name.replace('_', "-")),
        }
    }
    let methods: Vec<&MethodInfo> =
        METHODS.iter().filter(|m| names.is_empty() || names.iter().any(|name| name == m.name)).collect();
    if methods.is_empty() {
        eprintln!("no such method; there are {}", METHODS.iter().map(|m| m.name).collect::<Vec<_>>().join(", "));
        std::process::exit(2);
    }
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
    if json {
        let rows: Vec<String> = methods
            .iter()
            .zip(&figures)
            .map(|(method, row)| {
                let fields: Vec<String> = row.iter().map(|(name, value)| format!("\"{name}\": {value:.2}")).collect();
                format!("    {{\"method\": \"{}\", {}}}", method.name, fields.join(", "))
            })
            .collect();
        println!("{{\"seed\": {seed}, \"methods\": [\n{}\n]}}", rows.join(",\n"));
    } else {
        println!("seed {seed}");
        print_table(&methods, &figures);
    }
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
