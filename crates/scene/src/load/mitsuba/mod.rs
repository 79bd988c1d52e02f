//! Mitsuba XML, versions 0.4 to 3.0.

use super::{Context, Draft, LoadError, Place};
use std::path::Path;

/// Whether `head`, a file's first bytes, look like Mitsuba XML.
pub fn looks_like(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    text.trim_start_matches('\u{feff}').trim_start().starts_with('<') && text.contains("<scene")
}

/// Reads the scene file at `path`.
///
/// # Errors
/// [`LoadError`] with file and line.
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    let _ = context.read(&Place::file(path), path)?;
    Err(LoadError::invalid(Place::file(path), "Mitsuba XML is not read yet"))
}
