//! Ctrl-C and requests to terminate: the first asks the render to stop and keep what it has, the second ends the program
//! at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of an interrupted program.
pub const EXIT_CODE: u8 = 130;

/// What counts as an interrupt: Ctrl-C, and what `kill`, `timeout` and batch systems send. A terminal that goes away does
/// not: whoever started the program with `nohup` wants it to go on.
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// Interrupts as they come in.
#[derive(Clone)]
pub struct Interrupts {
    requested: Arc<AtomicBool>,
    /// The next interrupt ends the program: nothing is worth keeping, or it is the second.
    next_is_final: Arc<AtomicBool>,
}

impl Interrupts {
    /// Takes interrupts from now on. As long as there is nothing to keep the first one ends the program.
    pub fn listen() -> Self {
        let interrupts = Self { requested: Arc::default(), next_is_final: Arc::new(AtomicBool::new(true)) };
        for signal in SIGNALS {
            // In this order, as they run in it. Where the system takes no handler an interrupt ends the program, as it
            // always does.
            flag::register_conditional_shutdown(signal, EXIT_CODE.into(), interrupts.next_is_final.clone()).ok();
            flag::register(signal, interrupts.next_is_final.clone()).ok();
            flag::register(signal, interrupts.requested.clone()).ok();
        }
        interrupts
    }

    /// From now on the first interrupt asks to stop.
    pub fn keep_results(&self) {
        self.next_is_final.store(false, Ordering::SeqCst);
    }

    /// Whether somebody asked to stop.
    pub fn requested(&self) -> bool {
        self.requested.load(Ordering::SeqCst)
    }
}
