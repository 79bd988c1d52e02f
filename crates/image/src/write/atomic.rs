//! Replacing a file in one step, so that nobody ever sees half of it, and clearing away what a killed program left.

use crate::error::{ImageError, ImageErrorKind, Result};
use std::io::Write;
use std::path::Path;
use std::time::Duration;

/// Names of temporary files begin and end so.
const PREFIX: &str = ".photinus-";
const SUFFIX: &str = ".tmp";

/// A temporary file that nobody has written to for so long was left by a program that was killed.
const ABANDONED: Duration = Duration::from_secs(60);

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
    let mut file = temporary_in(folder).map_err(failed)?;
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

/// A temporary file in `folder`, to be renamed, with the permissions that new files get. It is locked as long as it is
/// open, so that [`remove_abandoned`] leaves it alone.
pub fn temporary_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Unlike the builder's own default of 0600; the system takes the umask off.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder)?;
    // Some file systems know no locks: there nothing counts as abandoned.
    file.as_file().try_lock().ok();
    Ok(file)
}

/// Removes the temporary files that killed programs left in `folder`, and says how many: those of [`temporary_in`] that
/// no program holds open and that are older than a minute. What cannot be removed stays.
pub fn remove_abandoned(folder: &Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder) else { return 0 };
    let is_temporary = |name: &std::ffi::OsStr| {
        let random = name.to_str().and_then(|n| n.strip_prefix(PREFIX)?.strip_suffix(SUFFIX));
        random.is_some_and(|r| r.len() == 6 && r.bytes().all(|b| b.is_ascii_alphanumeric()))
    };
    let abandoned = entries.flatten().filter(|entry| is_temporary(&entry.file_name())).filter(is_abandoned);
    abandoned.filter(|entry| std::fs::remove_file(entry.path()).is_ok()).count()
}

fn is_abandoned(entry: &std::fs::DirEntry) -> bool {
    // Of the entry itself: links are none of ours.
    let Ok(metadata) = entry.metadata() else { return false };
    let age = metadata.modified().ok().and_then(|time| time.elapsed().ok());
    let old = metadata.is_file() && age.is_some_and(|age| age >= ABANDONED);
    old && std::fs::File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok())
}
