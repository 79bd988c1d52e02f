//! Counts of things that were read otherwise than written, one warning for all of a kind.

use super::text::Fault;

/// How often something happened, and the first line where it did.
#[derive(Clone, Copy, Default)]
pub(super) struct Tally {
    count: u64,
    line: u32,
}

impl Tally {
    /// Once more, in `line`.
    pub(super) fn add(&mut self, line: u32) {
        if self.count == 0 {
            self.line = line;
        }
        self.count += 1;
    }

    /// A note that begins with the count, if there is anything to say.
    pub(super) fn report(self, notes: &mut Vec<Fault>, what: &str) {
        if self.count > 0 {
            notes.push(Fault::new(self.line, format!("{} {what}", self.count)));
        }
    }
}
