//! Processor time of the calling thread: that of other programs on the same processor does not count.

use rustix::time::{ClockId, clock_gettime};

/// Nanoseconds that the calling thread has been running. Two looks cost about half a microsecond, so that they are for
/// batches, never for single queries.
pub fn thread_nanoseconds() -> u64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    (time.tv_sec as u64).wrapping_mul(1_000_000_000).wrapping_add(time.tv_nsec as u64)
}

/// Runs work and says whether the thread had its processor to itself all the while, so that ticks in it are those of
/// the work: the clock on the wall ran on for no more than a twentieth longer than the thread, or the few microseconds
/// that looking takes.
pub fn undisturbed(work: impl FnOnce()) -> bool {
    let wall = || {
        let time = clock_gettime(ClockId::Monotonic);
        (time.tv_sec as u64).wrapping_mul(1_000_000_000).wrapping_add(time.tv_nsec as u64)
    };
    let (wall_begun, begun) = (wall(), thread_nanoseconds());
    work();
    let ran = thread_nanoseconds().saturating_sub(begun);
    let passed = wall().saturating_sub(wall_begun);
    passed <= ran + ran / 20 + 2000
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nap_is_a_disturbance() {
        assert!(!undisturbed(|| std::thread::sleep(std::time::Duration::from_millis(2))));
        // Other programs may disturb any one of these, not all of them.
        assert!((0..1000).any(|_| undisturbed(|| ())));
    }

    #[test]
    fn sleep_takes_no_processor_time_and_work_does() {
        let before = thread_nanoseconds();
        std::thread::sleep(std::time::Duration::from_millis(50));
        let slept = thread_nanoseconds() - before;
        assert!(slept < 25_000_000, "{slept} ns");
        let mut x = 1u64;
        while thread_nanoseconds() - before < slept + 5_000_000 {
            x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        }
        assert_ne!(x, 0);
    }
}
