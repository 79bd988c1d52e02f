//! Seconds of some work.

use std::time::Instant;

/// Seconds and result of some work: of a single thread by its own clock, which stands still while others have the
/// processor, of several by the wall's.
pub fn timed<T>(threads: usize, work: impl FnOnce() -> T) -> (f64, T) {
    if threads == 1 {
        let begun = thread_seconds();
        let result = work();
        (thread_seconds() - begun, result)
    } else {
        let begun = Instant::now();
        let result = work();
        (begun.elapsed().as_secs_f64(), result)
    }
}

fn thread_seconds() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
}
