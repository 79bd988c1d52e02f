//! The whole check of a change, one line a step, the same here as on any other machine.

use crate::Failure;
use crate::metadata::Metadata;
use crate::{floors, tidy, tools};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Lines of a failed step's output that are shown; all of it is in the log.
const SHOWN_LINES: usize = 80;

/// Tests counted over a whole run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Tally {
    passed: u64,
    failed: u64,
    ignored: u64,
}

/// Runs every step in turn and stops at the first that fails. Once the tests have run, the last line counts them.
/// Returns whether all is well; what is not has been said by then.
pub fn run(root: &Path, install: bool) -> bool {
    let ci = Ci { root, logs: root.join("target/ci") };
    if let Err(e) = std::fs::create_dir_all(&ci.logs) {
        eprintln!("{}: {e}", ci.logs.display());
        return false;
    }
    match std::env::var("PHOTINUS_SCENES") {
        Ok(scenes) => println!("real scenes: {scenes}"),
        Err(_) => println!("real scenes: PHOTINUS_SCENES is not set, so that suite does not run"),
    }
    let begun = Instant::now();
    let mut tally = Tally::default();
    let outcome = ci.steps(install, &mut tally);
    println!("{:>7.1} s  in all", begun.elapsed().as_secs_f64());
    if let Err(message) = &outcome {
        eprintln!("{message}");
    }
    if outcome.is_ok() || tally != Tally::default() {
        println!("{} passed, {} failed", tally.passed, tally.failed);
    }
    outcome.is_ok()
}

struct Ci<'a> {
    root: &'a Path,
    logs: PathBuf,
}

impl Ci<'_> {
    fn steps(&self, install: bool, tally: &mut Tally) -> Result<(), Failure> {
        let release = ["--release", "--locked", "--workspace"];
        self.step("tools", || tools::ensure(install))?;
        self.step("floors", || floors::run(self.root).map(drop))?;
        self.step("tidy", || tidy::run(self.root).map(drop))?;
        self.step("format", || {
            self.cargo("format", &["fmt", "--all", "--check"]).map_err(|e| format!("{e}\n`cargo fmt --all` repairs it"))
        })?;
        self.step("lints", || {
            self.cargo("lints", &[&["clippy"], &release[..], &["--all-targets", "--", "-D", "warnings"]].concat())
        })?;
        self.step("fuzz lock", || {
            let of_fuzz = ["metadata", "--locked", "--format-version=1", "--manifest-path=fuzz/Cargo.toml"];
            self.cargo("fuzz-lock", &of_fuzz)
                .map_err(|e| format!("{e}\n`cargo update --workspace` in fuzz/ repairs it"))
        })?;
        self.step("build", || self.cargo("build", &["build", "--release", "--locked"]))?;
        self.step("tests", || {
            let outcome = self.cargo("tests", &[&["test"], &release[..], &["--no-fail-fast"]].concat());
            *tally = count_tests(&std::fs::read_to_string(self.log("tests")).unwrap_or_default());
            outcome?;
            match *tally {
                Tally { passed: 0, .. } => Err("no test ran".into()),
                Tally { ignored: 0, .. } => Ok(()),
                Tally { ignored, .. } => Err(format!("{ignored} tests are ignored: a test runs or does not exist")),
            }
        })?;
        self.step("docs", || self.cargo("docs", &[&["doc"], &release[..], &["--no-deps"]].concat()))?;
        self.step("examples", || self.examples())?;
        self.step("readme", || self.readme_command())
    }

    /// Runs one step and prints its line.
    fn step(&self, name: &str, work: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
        let begun = Instant::now();
        let outcome = work();
        let verdict = if outcome.is_ok() { "ok" } else { "FAILED" };
        println!("{:>7.1} s  {name}: {verdict}", begun.elapsed().as_secs_f64());
        std::io::stdout().flush().ok();
        outcome.map_err(|message| format!("{name} failed: {message}"))
    }

    fn log(&self, step: &str) -> PathBuf {
        self.logs.join(format!("{step}.log"))
    }

    /// Runs cargo with its output in the step's log; a failure carries the end of that log.
    fn cargo(&self, step: &str, arguments: &[&str]) -> Result<(), Failure> {
        let path = self.log(step);
        let log = std::fs::File::create(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let errors = log.try_clone().map_err(|e| format!("{}: {e}", path.display()))?;
        let shown = format!("cargo {}", arguments.join(" "));
        let status = Command::new(tools::cargo())
            .args(arguments)
            .current_dir(self.root)
            .env("RUSTDOCFLAGS", "-D warnings")
            .env("CARGO_TERM_COLOR", "never")
            .stdin(Stdio::null())
            .stdout(log)
            .stderr(errors)
            .status()
            .map_err(|e| format!("`{shown}` could not be started: {e}"))?;
        if status.success() {
            return Ok(());
        }
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        Err(format!("`{shown}` ended with {status}\n{}\nall of it: {}", tail(&text), path.display()))
    }

    /// Every example of every crate runs to its end; its argument is a folder for what it writes.
    fn examples(&self) -> Result<(), Failure> {
        let folder = self.logs.join("examples");
        std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        for package in Metadata::of_workspace(self.root)?.packages {
            for target in package.targets.iter().filter(|t| t.kind.iter().any(|kind| kind == "example")) {
                if !target.required_features.is_empty() {
                    continue;
                }
                let place = folder.to_str().ok_or("the path of the repository is not UTF-8")?;
                let which = ["--package", &package.name, "--example", &target.name, "--", place];
                self.cargo("examples", &[&["run", "--release", "--locked"], &which[..]].concat())?;
            }
        }
        Ok(())
    }

    /// The README's first command, made small: it must end well and leave a picture.
    fn readme_command(&self) -> Result<(), Failure> {
        let picture = self.logs.join("readme.png");
        std::fs::remove_file(&picture).ok();
        let output = picture.to_str().ok_or("the path of the repository is not UTF-8")?;
        let small = ["--size", "96x96", "--passes", "1", "--quiet", "-o", output];
        self.cargo("readme", &[&["run", "--release", "--locked", "--", "render"], &small[..]].concat())?;
        let bytes = std::fs::metadata(&picture).map(|m| m.len()).unwrap_or(0);
        if bytes == 0 { Err(format!("{output} was not written")) } else { Ok(()) }
    }
}

/// The last lines of a log.
fn tail(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(SHOWN_LINES)..].join("\n")
}

/// Sums the summary lines of the test harness: `test result: ok. 3 passed; 0 failed; 0 ignored; ...`.
fn count_tests(log: &str) -> Tally {
    let mut tally = Tally::default();
    for line in log.lines().filter_map(|line| line.trim().strip_prefix("test result: ")) {
        let counts = line.split_once(". ").map_or("", |(_, counts)| counts);
        for part in counts.split(';') {
            let mut words = part.split_whitespace();
            if let (Some(Ok(count)), Some(what)) = (words.next().map(str::parse::<u64>), words.next()) {
                match what {
                    "passed" => tally.passed += count,
                    "failed" => tally.failed += count,
                    "ignored" => tally.ignored += count,
                    _ => {}
                }
            }
        }
    }
    tally
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn summaries_of_all_test_programs_are_summed() {
        let log = "running 3 tests\n\
            test result: ok. 3 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.01s\n\
            test result: FAILED. 39 passed; 2 failed; 1 ignored; 0 measured; 0 filtered out; finished in 1.20s\n";
        assert_eq!(count_tests(log), Tally { passed: 42, failed: 2, ignored: 1 });
        assert_eq!(count_tests("test passed ... ok"), Tally::default());
    }

    #[test]
    fn the_end_of_a_long_log_is_shown() {
        let log: String = (0..1000).map(|i| format!("line {i}\n")).collect();
        let shown = tail(&log);
        assert_eq!(shown.lines().count(), SHOWN_LINES);
        assert!(shown.ends_with("line 999"));
        assert_eq!(tail("short"), "short");
    }
}
