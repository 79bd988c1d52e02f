//! What this process has used, and what machine it runs on.

use rustix::time::{ClockId, clock_gettime};
use serde::Serialize;

/// Processor time of all threads of this process so far, in seconds.
pub fn cpu_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Memory of this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Resident {
    /// Bytes in memory now.
    pub now_bytes: u64,
    /// The most so far.
    pub peak_bytes: u64,
}

/// Memory of this process as the system counts it; none where the system does not tell (only Linux does, in proc(5)).
pub fn resident() -> Option<Resident> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    Some(Resident { now_bytes: field(&status, "VmRSS:")?, peak_bytes: field(&status, "VmHWM:")? })
}

/// A field of a table of proc(5), which counts in kB of 1024 bytes.
fn field(status: &str, name: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// Memory that a program may still take; none where the system does not tell.
pub fn available_bytes() -> Option<u64> {
    field(&std::fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// The machine that a measurement was made on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// Processor's name, or its architecture where the system does not tell.
    pub cpu: String,
    /// Processors that this process may use.
    pub cores: usize,
    /// Operating system.
    pub os: &'static str,
    /// Instruction set.
    pub arch: &'static str,
}

impl Machine {
    /// This machine.
    pub fn this() -> Self {
        let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = cpuinfo.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
        Self {
            cpu: model.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned()),
            cores: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
            os: std::env::consts::OS,
            arch: std::env::consts::ARCH,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_takes_processor_time() {
        let before = cpu_seconds();
        let mut x = 1u64;
        while cpu_seconds() - before < 0.01 {
            x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        }
        assert!(x != 0 && cpu_seconds() > before);
    }

    #[test]
    fn memory_is_read_where_the_system_tells() {
        assert_eq!(field("VmPeak:\t  10 kB\nVmHWM:\t   2044 kB\nVmRSS:\t 12 kB\n", "VmHWM:"), Some(2044 * 1024));
        assert_eq!(field("VmHWM: lots\n", "VmHWM:"), None);
        if cfg!(target_os = "linux") {
            let resident = resident().expect("Linux tells");
            assert!(resident.peak_bytes >= resident.now_bytes && resident.now_bytes > 0);
        }
    }
}
