//! The machine that a measurement was made on, as far as the system tells.

use serde::Serialize;
use std::process::Command;

/// What stands beside every table.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// The processor's name for itself.
    pub processor: String,
    /// Logical processors that this program may use.
    pub processors: usize,
    /// The widest vector instructions of the list below that it has.
    pub vectors: String,
    /// Memory in GiB.
    pub memory_gib: u64,
    /// Kernel and its release.
    pub system: String,
    /// Processes that wanted to run, on average over the last minute before the measurement.
    pub load_before: f64,
    /// The day, UTC.
    pub date: String,
}

impl Machine {
    /// Looks around.
    pub fn here() -> Self {
        let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let field = |name: &str| {
            let line = cpuinfo.lines().find(|line| line.split(':').next().unwrap_or_default().trim() == name);
            line.and_then(|line| Some(line.split_once(':')?.1.trim().to_owned())).unwrap_or_default()
        };
        let flags = field("flags");
        let widest = ["avx512f", "avx2", "avx", "sse4_2"].into_iter().find(|v| flags.split(' ').any(|flag| flag == *v));
        let meminfo = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
        let kilobytes = meminfo.split_whitespace().nth(1).and_then(|word| word.parse::<u64>().ok()).unwrap_or(0);
        let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        Self {
            processor: field("model name"),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            vectors: widest.unwrap_or("unknown").to_owned(),
            memory_gib: (kilobytes + (1 << 19)) >> 20,
            system: said("uname", &["-sr"]),
            load_before: load.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or(0.0),
            date: said("date", &["-u", "+%Y-%m-%d"]),
        }
    }

    /// One line.
    pub fn line(&self) -> String {
        format!(
            "{}, {} processors, {}, {} GiB, {}, load {:.1}, {}",
            self.processor, self.processors, self.vectors, self.memory_gib, self.system, self.load_before, self.date
        )
    }
}

/// What a program printed, or nothing.
pub fn said(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    output.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned()).unwrap_or_default()
}
