//! What can go wrong while a scene is read, as one clear line each.

use std::path::{Path, PathBuf};

/// A place in a file, for messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub file: PathBuf,
    /// Line, from 1; 0 where a line means nothing (binary files).
    pub line: u32,
}

impl Place {
    /// Line `line` of `file`.
    pub fn new(file: impl Into<PathBuf>, line: u32) -> Self {
        Self { file: file.into(), line }
    }

    /// The file as a whole.
    pub fn file(file: impl AsRef<Path>) -> Self {
        Self::new(file.as_ref(), 0)
    }
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.file.display())?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        Ok(())
    }
}

/// Why a scene was refused. Each prints as one line: place, what is wrong, what to do.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// A file is missing or cannot be read.
    #[error("{place}: {}", unreadable(place, path, source))]
    Io {
        /// Who asked for the file (the file itself where nobody did).
        place: Place,
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// No importer knows this kind of file.
    #[error("{}: {what} is not supported; supported are {supported}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Name of the format, as far as it was recognised.
        what: String,
        /// Names of the formats that can be read.
        supported: String,
    },
    /// The file's content is wrong.
    #[error("{place}: {message}")]
    Invalid {
        /// Where.
        place: Place,
        /// What is wrong and what to do.
        message: String,
    },
    /// The scene refers to a file outside its own folder.
    #[error("{place}: {} lies outside the scene's folder; pass --allow-outside to let this scene read it", path.display())]
    Outside {
        /// Who asked for the file.
        place: Place,
        /// The file.
        path: PathBuf,
    },
    /// A file or a count is larger than the limit.
    #[error("{place}: {what} ({size}) is beyond the limit of {limit}")]
    TooLarge {
        /// Where.
        place: Place,
        /// What is too large.
        what: String,
        /// Its size.
        size: u64,
        /// The limit, in the same unit.
        limit: u64,
    },
}

impl LoadError {
    /// The file's content is wrong at `place`.
    pub fn invalid(place: Place, message: impl Into<String>) -> Self {
        Self::Invalid { place, message: message.into() }
    }
}

/// What is wrong with a file and what to do; names the file where `place` is another.
fn unreadable(place: &Place, path: &Path, source: &std::io::Error) -> String {
    let what = match source.kind() {
        std::io::ErrorKind::NotFound => "there is no such file; check the path".to_string(),
        std::io::ErrorKind::PermissionDenied => "permission denied; check the file's rights".to_string(),
        _ => source.to_string(),
    };
    if place.file == path { what } else { format!("cannot read {}: {what}", path.display()) }
}

/// Opens a file that is neither a folder nor a device or pipe.
pub(super) fn open_regular(place: &Place, path: &Path) -> Result<std::fs::File, LoadError> {
    let io = |source| LoadError::Io { place: place.clone(), path: path.to_path_buf(), source };
    // Asked before opening: opening a pipe that nobody writes to would wait for ever.
    let metadata = std::fs::metadata(path).map_err(io)?;
    if !metadata.is_file() {
        let found = if metadata.is_dir() { "a folder" } else { "a device or pipe" };
        let what = format!("this is {found}, not a regular file; give a file");
        return Err(io(std::io::Error::new(std::io::ErrorKind::InvalidInput, what)));
    }
    std::fs::File::open(path).map_err(io)
}
