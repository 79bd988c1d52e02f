//! What can go wrong, each as one clear line: place, what is wrong, what to do.

use std::path::PathBuf;

/// Why something could not be done.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A scene file was refused.
    #[error(transparent)]
    Load(#[from] photinus_scene::LoadError),
    /// A scene cannot be written.
    #[error(transparent)]
    WriteScene(#[from] photinus_scene::WriteError),
    /// A picture was refused, or could not be written.
    #[error(transparent)]
    Image(#[from] photinus_image::ImageError),
    /// The acceleration structure cannot be built.
    #[error(transparent)]
    Structure(#[from] photinus_accel::BuildError),
    /// The render cannot start or go on.
    #[error(transparent)]
    Render(#[from] photinus_render::RenderError),
    /// No file and no built-in scene of that name.
    #[error("{name}: no such file and no built-in scene of that name; {hint}")]
    UnknownScene {
        /// What was asked for.
        name: String,
        /// What to do.
        hint: String,
    },
    /// No member of a family of that name.
    #[error("{name}: no {what} of that name; {hint}")]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The family, for people.
        what: &'static str,
        /// What to do.
        hint: String,
    },
    /// A setting makes no sense, by itself or for this scene.
    #[error("{option}: {what}")]
    Setting {
        /// The option as on the command line.
        option: &'static str,
        /// What is wrong and what to do.
        what: String,
    },
    /// A file or folder that cannot be written.
    #[error("{}: cannot be written: {source}; choose another place or make room", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// Result of everything here that may fail.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// A setting that makes no sense.
    pub(crate) fn setting(option: &'static str, what: impl Into<String>) -> Self {
        Self::Setting { option, what: what.into() }
    }
}
