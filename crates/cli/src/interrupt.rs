//! Ctrl-C: the first asks the render to stop and keep what it has, the second ends the program at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of an interrupted program.
pub const EXIT_CODE: u8 = 130;

/// Interrupts as they come in.
#[derive(Clone, Default)]
pub struct Interrupts {
    requested: Arc<AtomicBool>,
    /// There is work whose results are worth keeping.
    worth_keeping: Arc<AtomicBool>,
}

impl Interrupts {
    /// Takes interrupts from now on. As long as there is nothing to keep the first one ends the program.
    pub fn listen() -> Self {
        let interrupts = Self::default();
        let heard = interrupts.clone();
        // Where the system takes no handler an interrupt ends the program, as it always does.
        ctrlc::set_handler(move || {
            let again = heard.requested.swap(true, Ordering::SeqCst);
            if again || !heard.worth_keeping.load(Ordering::SeqCst) {
                std::process::exit(i32::from(EXIT_CODE));
            }
        })
        .ok();
        interrupts
    }

    /// From now on the first interrupt asks to stop.
    pub fn keep_results(&self) {
        self.worth_keeping.store(true, Ordering::SeqCst);
    }

    /// Whether somebody asked to stop.
    pub fn requested(&self) -> bool {
        self.requested.load(Ordering::SeqCst)
    }
}
