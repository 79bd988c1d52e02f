//! The one error type of this crate: where, what is wrong, what to do.

use std::path::{Path, PathBuf};

/// What sort of trouble an [`ImageError`] reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageErrorKind {
    /// The file cannot be opened or read.
    Unreadable,
    /// The file is damaged: its header or its data break the format's rules.
    Malformed,
    /// The file is sound, but uses a format or a feature that this crate does not read.
    Unsupported,
    /// The file declares more pixels or bytes than [`crate::Limits`] allow.
    TooLarge,
    /// The file cannot be written.
    Unwritable,
    /// The caller's data do not fit together (sizes, names).
    Mismatch,
}

/// Why an image could not be read, written or compared; prints as one line `PLACE: WHAT; REMEDY`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {what}; {remedy}", .path.display())]
pub struct ImageError {
    /// What sort of trouble it is.
    pub kind: ImageErrorKind,
    /// The file (or the name that the caller gave to bytes in memory).
    pub path: PathBuf,
    /// What is wrong.
    pub what: String,
    /// What the user can do about it.
    pub remedy: String,
}

/// Result of this crate's fallible functions.
pub type Result<T> = std::result::Result<T, ImageError>;

impl ImageError {
    /// Makes an error from its four parts.
    pub fn new(
        kind: ImageErrorKind,
        path: impl AsRef<Path>,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self { kind, path: path.as_ref().to_path_buf(), what: what.into(), remedy: remedy.into() }
    }

    /// A damaged file.
    pub(crate) fn malformed(path: &Path, what: impl Into<String>) -> Self {
        Self::new(ImageErrorKind::Malformed, path, what, "export the image again or use another file")
    }

    /// A sound file that uses a feature outside this crate's reach.
    pub(crate) fn unsupported(path: &Path, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::new(ImageErrorKind::Unsupported, path, what, remedy)
    }
}
