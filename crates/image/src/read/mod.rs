//! Reading image files: the format comes from the content, sizes are checked before anything is allocated.

mod dwa;
mod exr;
mod format;
mod raster;
mod texels;

pub use texels::{DecodedImage, Texels};

use crate::error::{ImageError, ImageErrorKind, Result};
use crate::image::{Image, Layers};
use crate::limits::Limits;
use format::Format;
use std::cell::Cell;
use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Reads a picture in linear RGB. 8- and 16-bit formats are decoded from sRGB; EXR and Radiance HDR are linear
/// already. Alpha is dropped, grey becomes three equal channels. EXR: the layer without a name, else the first with
/// colours; its data window is the picture.
pub fn read_image(path: impl AsRef<Path>) -> Result<Image> {
    let path = path.as_ref();
    image_from_bytes(&read_bytes(path, Limits::default())?, path)
}

/// [`read_image`] for bytes in memory; `name` stands for the path in errors and may give a TGA file's extension.
pub fn image_from_bytes(bytes: &[u8], name: impl AsRef<Path>) -> Result<Image> {
    let path = name.as_ref();
    match format::recognise(bytes, path)? {
        Format::Exr => exr::picture(guarded(path, || exr::read(bytes, path, Limits::default()))?, path),
        Format::Raster(format) => {
            let decoded = guarded(path, || raster::read(bytes, path, format, Limits::default()))?;
            Ok(decoded.into_linear_image())
        }
    }
}

/// Reads a texture as stored: 8- and 16-bit samples stay what they are (the caller knows whether they are sRGB), with
/// alpha; EXR and HDR become 32-bit floats.
pub fn decode(path: impl AsRef<Path>) -> Result<DecodedImage> {
    let path = path.as_ref();
    decode_bytes(&read_bytes(path, Limits::default())?, path)
}

/// [`decode`] for bytes in memory; `name` stands for the path in errors.
pub fn decode_bytes(bytes: &[u8], name: impl AsRef<Path>) -> Result<DecodedImage> {
    let path = name.as_ref();
    match format::recognise(bytes, path)? {
        Format::Exr => {
            let layers = guarded(path, || exr::read(bytes, path, Limits::default()))?;
            exr::texels(layers, path)
        }
        Format::Raster(format) => guarded(path, || raster::read(bytes, path, format, Limits::default())),
    }
}

/// Reads every layer, channel and text attribute of an EXR file.
pub fn read_layers(path: impl AsRef<Path>) -> Result<Layers> {
    let path = path.as_ref();
    layers_from_bytes(&read_bytes(path, Limits::default())?, path)
}

/// [`read_layers`] for bytes in memory; `name` stands for the path in errors.
pub fn layers_from_bytes(bytes: &[u8], name: impl AsRef<Path>) -> Result<Layers> {
    let path = name.as_ref();
    match format::recognise(bytes, path)? {
        Format::Exr => guarded(path, || exr::read(bytes, path, Limits::default())),
        Format::Raster(_) => {
            Err(ImageError::unsupported(path, "this image has no layers", "give an EXR file where layers are needed"))
        }
    }
}

/// Reads a whole regular file of bounded length.
fn read_bytes(path: &Path, limits: Limits) -> Result<Vec<u8>> {
    let unreadable = |what: String| {
        ImageError::new(ImageErrorKind::Unreadable, path, what, "check the path and that the file may be read")
    };
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => unreadable("there is no such file".to_string()),
        std::io::ErrorKind::PermissionDenied => unreadable("the file may not be read (permission denied)".to_string()),
        _ => unreadable(format!("the file cannot be read ({error})")),
    };
    // Asked before opening: opening a pipe that nobody writes to would wait for ever.
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        let found = if metadata.is_dir() { "a folder" } else { "a device or pipe" };
        return Err(unreadable(format!("an image file is needed, this is {found}")));
    }
    if metadata.len() > limits.bytes {
        return Err(ImageError::new(
            ImageErrorKind::TooLarge,
            path,
            format!("the file has {} bytes, more than the limit of {}", metadata.len(), limits.bytes),
            "use a smaller image",
        ));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    let file = std::fs::File::open(path).map_err(failed)?;
    file.take(limits.bytes).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is inside of a third-party decoder, where a panic is an error like any other: programs may
/// have their panic hook say nothing then.
pub fn is_decoding() -> bool {
    GUARDED.get()
}

/// Runs a third-party decoder; a panic inside it (on a file that breaks an assumption of its own) is an error like
/// any other.
fn guarded<T>(path: &Path, decoder: impl FnOnce() -> Result<T>) -> Result<T> {
    let outer = GUARDED.replace(true);
    let decoded = catch_unwind(AssertUnwindSafe(decoder));
    GUARDED.set(outer);
    decoded.unwrap_or_else(|_| Err(ImageError::malformed(path, "the file is damaged (its decoder gave up)")))
}
