//! What all importers share during one load: settings, the folder rule, warnings, caches and the triangle budget.

use super::error::open_regular;
use super::{BitmapEncoding, LoadError, LoadOptions, Place};
use crate::{Bitmap, Warning};
use std::collections::{HashMap, HashSet};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// State of one load.
pub struct Context<'a> {
    /// The caller's settings.
    pub options: &'a LoadOptions,
    /// Pictures read so far, by resolved path and encoding: the same file is held once.
    pub bitmaps: HashMap<(PathBuf, BitmapEncoding), Arc<Bitmap>>,
    /// The file that the caller named, which may be read wherever it lies.
    scene_file: PathBuf,
    /// The folder, without links, in which the scene may read.
    root: PathBuf,
    warnings: Vec<Warning>,
    warned: HashSet<(PathBuf, u32, String)>,
    triangles: u64,
    last_file: Option<(PathBuf, Arc<[u8]>)>,
}

/// Warnings kept of one load; more are counted and mentioned in the last.
const MAX_WARNINGS: usize = 1000;

impl<'a> Context<'a> {
    /// The state for loading `scene_file`, whose folder is the one that may be read.
    pub fn new(scene_file: &Path, options: &'a LoadOptions) -> Self {
        let folder = match scene_file.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        Self {
            options,
            bitmaps: HashMap::new(),
            scene_file: scene_file.to_path_buf(),
            root: folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf()),
            warnings: Vec::new(),
            warned: HashSet::new(),
            triangles: 0,
            last_file: None,
        }
    }

    /// Notes that something was read otherwise than written. The same warning for the same place is kept once.
    pub fn warn(&mut self, place: &Place, message: impl Into<String>) {
        let message = message.into();
        if self.warnings.len() < MAX_WARNINGS && self.warned.insert((place.file.clone(), place.line, message.clone())) {
            self.warnings.push(Warning { file: place.file.clone(), line: place.line, message });
        }
        if self.warnings.len() == MAX_WARNINGS - 1 {
            let message = format!("more than {MAX_WARNINGS} warnings: the rest is left out");
            self.warnings.push(Warning { file: place.file.clone(), line: 0, message });
        }
    }

    /// Hands the warnings over.
    pub fn take_warnings(&mut self) -> Vec<Warning> {
        std::mem::take(&mut self.warnings)
    }

    /// Counts `count` more triangles of the scene.
    ///
    /// # Errors
    /// [`LoadError::TooLarge`] where the scene exceeds [`LoadOptions::max_triangles`].
    pub fn add_triangles(&mut self, place: &Place, count: u64) -> Result<(), LoadError> {
        self.triangles = self.triangles.saturating_add(count);
        if self.triangles > self.options.max_triangles {
            return Err(LoadError::TooLarge {
                place: place.clone(),
                what: "the scene's triangle count".into(),
                size: self.triangles,
                limit: self.options.max_triangles,
            });
        }
        Ok(())
    }

    /// Finds the file `name` that a scene file mentions at `place`, relative to the first of `folders` that has it.
    ///
    /// Backslashes count as slashes where the literal name does not exist, and upper and lower case may differ (the
    /// scene was made on another system).
    ///
    /// # Errors
    /// [`LoadError::Io`] where no folder has it, [`LoadError::Outside`] where it is not inside the scene's folder.
    pub fn resolve(&self, place: &Place, name: &str, folders: &[PathBuf]) -> Result<PathBuf, LoadError> {
        let slashed = name.replace('\\', "/");
        let names = [name, slashed.as_str()];
        let names = if name == slashed { &names[..1] } else { &names[..] };
        let exact = folders.iter().flat_map(|f| names.iter().map(move |n| f.join(n))).find(|p| p.is_file());
        let found = exact.or_else(|| folders.iter().find_map(|f| find_ignoring_case(&f.join(&slashed))));
        let Some(found) = found else {
            let path = folders.first().map_or_else(|| PathBuf::from(name), |f| f.join(name));
            let source = std::io::Error::new(std::io::ErrorKind::NotFound, "no such file");
            return Err(LoadError::Io { place: place.clone(), path, source });
        };
        self.check_inside(place, &found)?;
        Ok(found)
    }

    /// The bytes of a file found by [`Context::resolve`] (or of the scene file itself); the last one read is kept, as
    /// many shapes may live in one file.
    ///
    /// # Errors
    /// [`LoadError::Io`], [`LoadError::Outside`], and [`LoadError::TooLarge`] beyond [`LoadOptions::max_file_bytes`].
    pub fn read(&mut self, place: &Place, path: &Path) -> Result<Arc<[u8]>, LoadError> {
        if let Some((last, bytes)) = &self.last_file
            && last == path
        {
            return Ok(bytes.clone());
        }
        self.check_inside(place, path)?;
        let bytes: Arc<[u8]> = read_limited(place, path, self.options.max_file_bytes)?.into();
        self.last_file = Some((path.to_path_buf(), bytes.clone()));
        Ok(bytes)
    }

    /// Whether the scene may read `path`: what counts is where the file really lies, behind `..` and links.
    fn check_inside(&self, place: &Place, path: &Path) -> Result<(), LoadError> {
        if self.options.allow_outside || path == self.scene_file {
            return Ok(());
        }
        match path.canonicalize() {
            Ok(real) if real.starts_with(&self.root) => Ok(()),
            Ok(_) => Err(LoadError::Outside { place: place.clone(), path: path.to_path_buf() }),
            Err(source) => Err(LoadError::Io { place: place.clone(), path: path.to_path_buf(), source }),
        }
    }
}

/// Reads a whole file of at most `limit` bytes, whatever its length is said to be.
pub(crate) fn read_limited(place: &Place, path: &Path, limit: u64) -> Result<Vec<u8>, LoadError> {
    let io = |source| LoadError::Io { place: place.clone(), path: path.to_path_buf(), source };
    let file = open_regular(place, path)?;
    let meta = file.metadata().map_err(io)?;
    let too_large = |size| LoadError::TooLarge { place: place.clone(), what: "size in bytes".into(), size, limit };
    if meta.len() > limit {
        return Err(too_large(meta.len()));
    }
    let mut bytes = Vec::new();
    file.take(limit + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > limit {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

/// `path` with its last component matched without regard to case, first in name order.
fn find_ignoring_case(path: &Path) -> Option<PathBuf> {
    let wanted = path.file_name()?.to_str()?.to_lowercase();
    let mut names: Vec<_> = std::fs::read_dir(path.parent()?)
        .ok()?
        .filter_map(|e| e.ok()?.file_name().into_string().ok())
        .filter(|n| n.to_lowercase() == wanted)
        .collect();
    names.sort();
    let found = path.with_file_name(names.first()?);
    found.is_file().then_some(found)
}
