//! Pictures for textures and environments.

use super::{Context, LoadError, Place};
use crate::Bitmap;
use std::path::Path;
use std::sync::Arc;

/// How the numbers of a picture file are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BitmapEncoding {
    /// As the format says: 8- and 16-bit pictures are sRGB, floating-point ones linear.
    Auto,
    /// Linear: data such as normals, heights and roughness.
    Raw,
    /// sRGB.
    Srgb,
}

/// Reads the picture at `path` (from [`Context::resolve`]); `place` is who asked for it. Held once per file and
/// encoding.
///
/// # Errors
/// [`LoadError`] where the file is missing, damaged or too large; importers turn it into a warning and mid-grey.
pub fn load_bitmap(
    place: &Place,
    path: &Path,
    encoding: BitmapEncoding,
    context: &mut Context<'_>,
) -> Result<Arc<Bitmap>, LoadError> {
    if let Some(bitmap) = context.bitmaps.get(&(path.to_path_buf(), encoding)) {
        return Ok(bitmap.clone());
    }
    let _ = context.read(place, path)?;
    Err(LoadError::invalid(place.clone(), format!("{}: pictures are not read yet", path.display())))
}
