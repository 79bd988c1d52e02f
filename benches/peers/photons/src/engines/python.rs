//! Trees of Python's packages, each in a process of its own that answers commands and takes its time itself.

use super::{Answer, Cloud, Engine, Reach};
use crate::Arguments;
use crate::sets::{K, Question, Set};
use serde::Deserialize;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

struct Python {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    points: PathBuf,
    queries: PathBuf,
    answers: PathBuf,
    is_loaded: bool,
}

/// What the driver says.
#[derive(Deserialize)]
struct Reply {
    seconds: Option<f64>,
}

/// scipy's tree.
pub fn open_ckdtree(arguments: &Arguments) -> Result<Box<dyn Engine>, String> {
    open(arguments, "ckdtree")
}

/// pykdtree's.
pub fn open_pykdtree(arguments: &Arguments) -> Result<Box<dyn Engine>, String> {
    open(arguments, "pykdtree")
}

fn open(arguments: &Arguments, name: &str) -> Result<Box<dyn Engine>, String> {
    let [python, driver] = arguments.python.as_ref().ok_or("no Python was named (--python)")?;
    let mut child = Command::new(python)
        .arg(driver)
        .arg(name)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{}: {error}", python.display()))?;
    let (input, output) = child.stdin.take().zip(child.stdout.take()).ok_or("its pipes are gone")?;
    let file = |what: &str| arguments.work.join(format!("{name}-{what}.bin"));
    Ok(Box::new(Python {
        child,
        input,
        output: BufReader::new(output),
        points: file("points"),
        queries: file("queries"),
        answers: file("answers"),
        is_loaded: false,
    }))
}

impl Drop for Python {
    fn drop(&mut self) {
        // Whether it had ended by itself does not matter.
        self.child.kill().ok();
        self.child.wait().ok();
        for file in [&self.points, &self.queries, &self.answers] {
            std::fs::remove_file(file).ok();
        }
    }
}

impl Python {
    fn command(&mut self, command: &Value) -> Result<Reply, String> {
        let said = |error: std::io::Error| format!("its process ended: {error}");
        writeln!(self.input, "{command}").map_err(said)?;
        self.input.flush().map_err(said)?;
        let mut line = String::new();
        self.output.read_line(&mut line).map_err(said)?;
        serde_json::from_str(&line).map_err(|_| format!("it answered {line:?}"))
    }
}

impl Engine for Python {
    fn build(&mut self, cloud: &Cloud, threads: usize) -> Result<f64, String> {
        if !self.is_loaded {
            write(&self.points, cloud.positions.iter().copied())?;
            let points = self.points.clone();
            self.command(&json!({"do": "load", "points": points}))?;
            self.is_loaded = true;
        }
        let reply = self.command(&json!({"do": "build", "threads": threads}))?;
        reply.seconds.ok_or_else(|| "it built nothing".into())
    }

    fn builds_in_parallel(&self) -> bool {
        false
    }

    fn ask(&mut self, set: &Set, threads: usize) -> Result<(f64, Vec<Answer>), String> {
        write(&self.queries, set.queries.iter().map(|query| query.position.to_array()))?;
        let what = if set.question == Question::Flux { "within" } else { "nearest" };
        let radius = set.queries.first().ok_or("there are no queries")?.radius;
        let command = json!({
            "do": what, "queries": self.queries, "answers": self.answers, "radius": radius, "k": K, "threads": threads,
        });
        let reply = self.command(&command)?;
        let seconds = reply.seconds.ok_or("has no search by radius alone")?;
        Ok((seconds, read(&self.answers, set.queries.len())?))
    }

    fn reach(&self, _: &Set) -> Reach {
        Reach::All
    }

    fn about(&self, set: &Set) -> &'static str {
        match set.question {
            Question::Flux => "count, all normals",
            Question::Nearest => "list, all normals",
        }
    }
}

/// Points as they lie in memory.
fn write(path: &Path, points: impl Iterator<Item = [f32; 3]>) -> Result<(), String> {
    let bytes: Vec<u8> = points.flatten().flat_map(f32::to_ne_bytes).collect();
    std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}

/// Counts, then distances of the farthest.
fn read(path: &Path, count: usize) -> Result<Vec<Answer>, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let words: Vec<[u8; 4]> = bytes.chunks_exact(4).map(|word| [word[0], word[1], word[2], word[3]]).collect();
    if words.len() != 2 * count {
        return Err(format!("it gave {} words for {count} queries", words.len()));
    }
    let (counts, distances) = words.split_at(count);
    let answer = |(count, distance): (&[u8; 4], &[u8; 4])| {
        let distance = f32::from_ne_bytes(*distance);
        Answer { count: u32::from_ne_bytes(*count), flux: None, farthest_sq: distance * distance }
    };
    Ok(counts.iter().zip(distances).map(answer).collect())
}
