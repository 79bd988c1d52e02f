//! The processor's own clock: a stamp costs some twenty cycles, so that it can stand around a handful of tests.

/// The clock's count now. It runs at one steady rate while the machine is awake; what a tick is in seconds is not known
/// here, so that only ratios of differences mean anything.
#[inline(always)]
pub fn ticks() -> u64 {
    #[cfg(target_arch = "x86_64")]
    {
        // SAFETY: every x86-64 processor has the instruction, and no system that Rust's standard library runs on
        // forbids it to programs.
        unsafe { std::arch::x86_64::_rdtsc() }
    }
    #[cfg(not(target_arch = "x86_64"))]
    portable_ticks()
}

/// The same from the system's clock, in nanoseconds.
#[cfg(any(test, not(target_arch = "x86_64")))]
fn portable_ticks() -> u64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::Monotonic);
    (time.tv_sec as u64).wrapping_mul(1_000_000_000).wrapping_add(time.tv_nsec as u64)
}

/// Ticks that one stamp adds to what lies between two of them: the least mean over a few short runs, as interrupts only
/// ever add.
pub fn ticks_of_a_stamp() -> f64 {
    const STAMPS: u32 = 256;
    let run = || {
        let begun = ticks();
        let mut last = begun;
        for _ in 0..STAMPS {
            last = std::hint::black_box(ticks());
        }
        last.saturating_sub(begun) as f64 / f64::from(STAMPS)
    };
    (0..16).map(|_| run()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_run_as_fast_as_the_clock() {
        // Both clocks at one moment: of many looks the one with the least between two looks at the system's clock, so
        // that no interruption stands between them.
        let both = || {
            let look = |_| {
                let (before, ticks, after) = (portable_ticks(), ticks(), portable_ticks());
                (after - before, ticks, before)
            };
            let (_, ticks, clock) = (0..200).map(look).min().expect("two hundred looks");
            (ticks, clock)
        };
        let rate = |wait_ms: u64| {
            let (from, clock_from) = both();
            std::thread::sleep(std::time::Duration::from_millis(wait_ms));
            let (to, clock_to) = both();
            (to - from) as f64 / (clock_to - clock_from) as f64
        };
        // Ratios of differences over waits of different lengths agree.
        let (short, long) = (rate(20), rate(60));
        assert!(short > 0.0 && (short / long - 1.0).abs() < 0.02, "{short} and {long} ticks a nanosecond");
        let stamp = ticks_of_a_stamp();
        assert!(stamp >= 0.0 && stamp / long < 10_000.0, "{stamp} ticks a stamp");
    }
}
