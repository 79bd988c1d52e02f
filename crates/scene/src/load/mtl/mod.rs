//! OBJ material libraries: read, and turned into materials.

mod convert;
mod parse;
mod textures;

pub(super) use convert::{Converted, convert};
pub(super) use parse::{RawLibrary, RawMaterial, parse};
pub(super) use textures::check_permitted;

use std::path::PathBuf;

/// A library that was read: where it lies and what it says.
pub(super) struct Library {
    /// The file, for messages.
    pub(super) path: PathBuf,
    /// Where its pictures are looked for.
    pub(super) folders: Vec<PathBuf>,
    /// Its content.
    pub(super) raw: RawLibrary,
}

#[cfg(test)]
mod tests;
