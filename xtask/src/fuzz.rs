//! Fuzzing: builds the programs of `fuzz/`, writes their seeds, runs one after another and says what was found.

use crate::{Failure, tools};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Where the instrumented programs are built; fuzz/.cargo/config.toml names it.
const TRIPLE: &str = "x86_64-unknown-linux-gnu";

/// What `cargo xtask fuzz` was asked for.
#[derive(Debug, PartialEq, Eq)]
pub struct Options {
    /// One target; none: all of them.
    pub target: Option<String>,
    /// Seconds for each.
    pub seconds: u32,
}

impl Options {
    /// Of the words after `fuzz`: a target and `--seconds N`, in any order; none where they make no sense.
    pub fn parse(words: &[&str]) -> Option<Self> {
        let mut options = Self { target: None, seconds: 600 };
        let mut words = words.iter();
        while let Some(&word) = words.next() {
            match word {
                "--seconds" => options.seconds = words.next()?.parse().ok().filter(|seconds| *seconds > 0)?,
                _ if word.starts_with('-') || options.target.is_some() => return None,
                name => options.target = Some(name.to_owned()),
            }
        }
        Some(options)
    }
}

/// Fuzzes, with a line a target. Inputs that were found lie where the last line says.
pub fn run(root: &Path, options: &Options) -> Result<String, Failure> {
    let home = root.join("fuzz");
    let targets = targets(&home)?;
    let chosen: Vec<&String> =
        targets.iter().filter(|t| options.target.as_ref().is_none_or(|name| name == *t)).collect();
    if chosen.is_empty() {
        return Err(format!("there is no such fuzz target; there are {}", targets.join(", ")));
    }
    let status = Command::new(tools::cargo())
        .args(["build", "--release", "--locked"])
        .current_dir(&home)
        .status()
        .map_err(|e| format!("cargo could not be started: {e}"))?;
    if !status.success() {
        return Err("the fuzz targets do not build; they need a C++ compiler (apt-get install g++)".into());
    }
    let mut found = Vec::new();
    for target in chosen {
        let outcome = fuzz(&home, target, options.seconds)?;
        println!("{target:12} {:>6} s {:>12} executions  {}", options.seconds, outcome.executions, outcome.verdict());
        if !outcome.clean {
            found.push(outcome.folder.display().to_string());
        }
    }
    if found.is_empty() { Ok("nothing found".into()) } else { Err(format!("found:\n  {}", found.join("\n  "))) }
}

/// Names of the targets, from their programs.
fn targets(home: &Path) -> Result<Vec<String>, Failure> {
    let folder = home.join("fuzz_targets");
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let stem = |path: PathBuf| path.file_stem().and_then(|s| s.to_str()).map(String::from);
    let mut names: Vec<String> = entries.flatten().filter_map(|entry| stem(entry.path())).collect();
    names.sort();
    Ok(names)
}

/// What became of one target.
struct Outcome {
    executions: String,
    clean: bool,
    /// Corpus, log and findings.
    folder: PathBuf,
}

impl Outcome {
    fn verdict(&self) -> &'static str {
        if self.clean { "nothing found" } else { "FOUND" }
    }
}

fn fuzz(home: &Path, target: &str, seconds: u32) -> Result<Outcome, Failure> {
    let program = home.join("target").join(TRIPLE).join("release").join(target);
    let folder = home.join("target/runs").join(target);
    let [corpus, found, seeds] = ["corpus", "found", "seeds"].map(|name| folder.join(name));
    for place in [&corpus, &found] {
        std::fs::create_dir_all(place).map_err(|e| format!("{}: {e}", place.display()))?;
    }
    let failed = |e: std::io::Error| format!("{}: {e}", program.display());
    // The program writes its seeds where this variable says, and ends.
    let mut writer = Command::new(&program);
    writer.env("PHOTINUS_FUZZ_SEEDS", &folder).stdout(Stdio::null()).stderr(Stdio::null());
    writer.status().map_err(failed)?;
    let path = folder.join("log");
    let log = File::create(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut command = Command::new("nice");
    command.args(["-n", "19"]).arg(&program).args([&corpus, &seeds]);
    let words = folder.join("words");
    if std::fs::metadata(&words).is_ok_and(|m| m.len() > 0) {
        command.arg(format!("-dict={}", words.display()));
    }
    let status = command
        .arg(format!("-max_total_time={seconds}"))
        .arg(format!("-artifact_prefix={}/", found.display()))
        .args(["-timeout=10", "-rss_limit_mb=3000", "-max_len=4096", "-print_final_stats=1"])
        .stdout(Stdio::null())
        .stderr(log)
        .status()
        .map_err(failed)?;
    let bytes = std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let text = String::from_utf8_lossy(&bytes);
    Ok(Outcome { executions: executions(&text).to_owned(), clean: status.success(), folder })
}

/// The count in libFuzzer's final statistics.
fn executions(log: &str) -> &str {
    log.lines().rev().find_map(|line| line.strip_prefix("stat::number_of_executed_units:")).map_or("?", str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_options() {
        let options = |target: Option<&str>, seconds| Some(Options { target: target.map(String::from), seconds });
        assert_eq!(Options::parse(&[]), options(None, 600));
        assert_eq!(Options::parse(&["obj"]), options(Some("obj"), 600));
        assert_eq!(Options::parse(&["--seconds", "5", "obj"]), options(Some("obj"), 5));
        for wrong in [&["--seconds"][..], &["--seconds", "0"], &["a", "b"], &["--all"]] {
            assert_eq!(Options::parse(wrong), None, "{wrong:?}");
        }
    }

    #[test]
    fn executions_are_read_from_the_log() {
        assert_eq!(executions("#1 INITED\nstat::number_of_executed_units: 123\nstat::peak_rss_mb: 4\n"), "123");
        assert_eq!(executions(""), "?");
    }
}
