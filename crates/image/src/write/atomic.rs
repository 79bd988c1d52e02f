//! Replacing a file in one step, so that nobody ever sees half of it.

use crate::error::{ImageError, ImageErrorKind, Result};
use std::io::Write;
use std::path::Path;

/// Writes `bytes` to `path`: into a temporary file of the same folder, flushed to disk, then renamed. Whoever looks,
/// even after a crash, finds the old file or the new one, whole. A file that was there keeps its permissions; a new
/// one gets the usual ones (0666 without the umask).
pub fn write_atomic(path: impl AsRef<Path>, bytes: &[u8]) -> Result<()> {
    let path = path.as_ref();
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let unwritable = |what: String, remedy: &str| ImageError::new(ImageErrorKind::Unwritable, path, what, remedy);
    if path.is_dir() {
        return Err(unwritable("this is a folder".to_string(), "give the name of a file"));
    }
    if !folder.is_dir() {
        return Err(unwritable(
            format!("the folder {} does not exist", folder.display()),
            "create it or choose another place",
        ));
    }
    let failed = |error: std::io::Error| {
        unwritable(
            format!("the file cannot be written ({error})"),
            "check the folder's permissions and the free space, or choose another place",
        )
    };
    if std::fs::metadata(path).is_ok_and(|metadata| metadata.permissions().readonly()) {
        return Err(unwritable(
            "the file is there already and write-protected".to_string(),
            "remove it or choose another name",
        ));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".photinus-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Unlike the builder's own default of 0600; the system takes the umask off.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    if let Ok(metadata) = std::fs::metadata(path) {
        file.as_file().set_permissions(metadata.permissions()).map_err(failed)?;
    }
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    // The rename itself reaches the disk with the folder. Some systems cannot flush folders: then it stays in the cache.
    if let Ok(folder) = std::fs::File::open(folder) {
        let _ = folder.sync_all();
    }
    Ok(())
}
