//! House tasks, run as `cargo xtask TASK`: the whole check of a change, the floors of the crates, the house rules,
//! fuzzing, the benchmarks against others.

mod bench;
mod ci;
mod floors;
mod fuzz;
mod metadata;
mod tidy;
mod tools;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask TASK

tasks:
  ci [--install]   format, lints, floors, tidy, tests, docs, examples and the README's command; --install is the
                   consent to install what is missing (system packages by apt, Rust components by rustup)
  fuzz [TARGET] [--seconds N]
                   fuzz every kind of file that is read, or one, for 600 s each; needs a C++ compiler
  floors           check that every crate uses lower floors only
  tidy             check the house rules
  bench pictures [--quick] [--json] [--repeats N] [--only ENGINE,...]
                   the equal-time table: pictures by all engines in the same processor time; installs the peers below
                   target/ with pip; --quick is one repeat at 10 s, --repeats and --only make it smaller or larger
  bench rays [--quick] [--json] [--repeats N] [--only ENGINE,...]
                   rays a second of the default structure beside others'
  bench photons [--quick] [--json] [--repeats N] [--only ENGINE,...]
                   photon searches of the default search beside others'; --quick takes a minute";

/// What a task says when it did not succeed: one message for the person who ran it.
type Failure = String;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let root = root();
    let outcome = match words.as_slice() {
        ["ci"] => return verdict(ci::run(&root, false)),
        ["ci", "--install"] => return verdict(ci::run(&root, true)),
        ["fuzz", rest @ ..] => match fuzz::Options::parse(rest) {
            Some(options) => fuzz::run(&root, &options).map(|report| println!("{report}")),
            None => {
                eprintln!("{USAGE}");
                return ExitCode::from(2);
            }
        },
        ["floors"] => floors::run(&root).map(|report| println!("{report}")),
        ["tidy"] => tidy::run(&root).map(|report| println!("{report}")),
        ["bench", words @ ..] => match bench::run(&root, words) {
            Some(outcome) => outcome,
            None => {
                eprintln!("{USAGE}");
                return ExitCode::from(2);
            }
        },
        ["help" | "--help" | "-h"] => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn verdict(all_is_well: bool) -> ExitCode {
    if all_is_well { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The repository's root: the folder above this package.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the repository").to_path_buf()
}
