//! Runs a program and measures its processor time from outside, with that of every process it started and waited for.

use crate::Failure;
use std::path::Path;
use std::process::{Command, Stdio};

/// What a program did.
pub struct Outcome {
    /// User and system seconds since its start.
    pub cpu_seconds: f64,
    /// Its standard output.
    pub stdout: String,
}

/// The shell keeps the times of its children (POSIX `times`): the second line is theirs, user and system.
const SCRIPT: &str =
    r#"log=$1; times=$2; shift 2; timeout --foreground "$@" 2> "$log"; code=$?; times > "$times"; exit $code"#;

/// Runs `arguments` (program first) with further environment variables. Standard error goes into a file in `folder`.
/// What runs longer than `limit_seconds` is ended. An error is one line that ends with the program's own last line.
pub fn run(
    arguments: &[String],
    environment: &[(String, String)],
    folder: &Path,
    limit_seconds: u32,
) -> Result<Outcome, Failure> {
    let (log, times) = (folder.join("stderr.log"), folder.join("times.txt"));
    let name = |word: &String| Path::new(word).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let shown = arguments.iter().take(2).map(name).collect::<Vec<_>>().join(" ");
    let output = Command::new("sh")
        .args(["-c", SCRIPT, "sh"])
        .args([&log, &times])
        .arg(limit_seconds.to_string())
        .args(arguments)
        .envs(environment.iter().map(|(name, value)| (name, value)))
        .env("LC_ALL", "C")
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .map_err(|e| format!("`{shown}` could not be started: {e}"))?;
    let errors = std::fs::read_to_string(&log).unwrap_or_default();
    if !output.status.success() {
        let last = errors.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
        let why = match output.status.code() {
            Some(124) => format!("still ran after {limit_seconds} s"),
            _ => format!("failed: {}", last.trim()),
        };
        return Err(format!("`{shown}` {why}"));
    }
    let text = std::fs::read_to_string(&times).map_err(|e| format!("{}: {e}", times.display()))?;
    let cpu_seconds = children_seconds(&text).ok_or_else(|| format!("`times` said {text:?}"))?;
    Ok(Outcome { cpu_seconds, stdout: String::from_utf8_lossy(&output.stdout).into_owned() })
}

/// Seconds of the children in what `times` prints: `0m0.01s 0m0.00s` for the shell, then the same for its children.
fn children_seconds(text: &str) -> Option<f64> {
    text.lines().nth(1)?.split_whitespace().map(seconds).sum()
}

fn seconds(word: &str) -> Option<f64> {
    let (minutes, rest) = word.strip_suffix('s')?.split_once('m')?;
    Some(60.0 * minutes.parse::<f64>().ok()? + rest.parse::<f64>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sh(script: &str, folder: &Path, limit: u32) -> Result<Outcome, Failure> {
        run(&["sh".into(), "-c".into(), script.into()], &[("GREETING".into(), "hello".into())], folder, limit)
    }

    #[test]
    fn times_of_children_are_read() {
        let text = "0m0.01s 0m0.02s\n2m3.50s 0m1.25s\n";
        assert_eq!(children_seconds(text), Some(124.75));
        assert_eq!(children_seconds("0m0.01s 0m0.02s\n"), None);
        assert_eq!(children_seconds("a\nb c\n"), None);
    }

    #[test]
    fn a_program_is_measured_with_its_children() {
        let folder = tempfile::tempdir().unwrap();
        let work = "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done";
        let outcome = sh(&format!("sh -c '{work}'; echo $GREETING"), folder.path(), 60).unwrap();
        assert_eq!(outcome.stdout, "hello\n");
        assert!(outcome.cpu_seconds > 0.0 && outcome.cpu_seconds < 60.0, "{}", outcome.cpu_seconds);
    }

    #[test]
    fn failures_say_why() {
        let folder = tempfile::tempdir().unwrap();
        let said = sh("echo first >&2; echo no glass >&2; exit 3", folder.path(), 60).err().unwrap();
        assert!(said.ends_with("failed: no glass"), "{said}");
        let said = sh("exec sleep 20", folder.path(), 1).err().unwrap();
        assert!(said.contains("still ran after 1 s"), "{said}");
    }
}
