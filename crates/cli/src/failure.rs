//! How a command ends.

/// How a command that did its work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All of it.
    Done,
    /// Somebody stopped it; what was done by then is kept.
    Interrupted,
}

/// Why a command could not do its work.
#[derive(Debug)]
pub enum Failure {
    /// The input is bad: exit code 1.
    Input(String),
    /// The command was used wrongly: exit code 2.
    Usage(String),
    /// Standard output was closed by its reader.
    OutputClosed,
}

/// Result of a command.
pub type Result = std::result::Result<Outcome, Failure>;

impl From<photinus::Error> for Failure {
    fn from(error: photinus::Error) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        match error.kind() {
            std::io::ErrorKind::BrokenPipe => Self::OutputClosed,
            _ => Self::Input(format!("standard output: {error}; write somewhere else")),
        }
    }
}
