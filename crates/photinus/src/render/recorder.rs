//! The file that `--record-queries` asks for: written while the render runs, in place once it is whole.

use crate::{Error, Result};
use photinus_profile::queries::{Block, QueryFileWriter, QuerySink, QueryTotals};
use photinus_render::World;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::NamedTempFile;

/// Bytes that are gathered before the disk is asked.
const BUFFER: usize = 1 << 20;

/// Takes the queries of a session's renders until it is finished.
pub(super) struct Recorder {
    path: PathBuf,
    writer: Mutex<Option<QueryFileWriter<BufWriter<NamedTempFile>>>>,
}

impl Recorder {
    /// Begins a file beside `path`.
    pub fn new(path: &Path, world: &World) -> Result<Self> {
        let begin = || -> io::Result<_> {
            let folder = match path.parent() {
                Some(folder) if !folder.as_os_str().is_empty() => folder,
                _ => Path::new("."),
            };
            let out = BufWriter::with_capacity(BUFFER, photinus_image::temporary_in(folder)?);
            let primitives = world.primitives();
            let (triangles, spheres) = (primitives.triangle_count() as u64, primitives.spheres.len() as u64);
            QueryFileWriter::new(out, world.geometry_hash(), triangles, spheres)
        };
        crate::check_writable(path)?;
        let writer = begin().map_err(|source| Error::Write { path: path.to_path_buf(), source })?;
        Ok(Self { path: path.to_path_buf(), writer: Mutex::new(Some(writer)) })
    }

    /// Puts the file in place; none where that has been done.
    pub fn finish(&self) -> Result<Option<QueryTotals>> {
        let Some(writer) = self.writer.lock().unwrap_or_else(PoisonError::into_inner).take() else { return Ok(None) };
        let put = || -> io::Result<QueryTotals> {
            let (out, totals) = writer.finish()?;
            let mut file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
            file.flush()?;
            file.as_file().sync_all()?;
            file.persist(&self.path).map_err(|error| error.error)?;
            Ok(totals)
        };
        put().map(Some).map_err(|source| Error::Write { path: self.path.clone(), source })
    }
}

impl QuerySink for Recorder {
    fn record(&self, block: &Block) {
        if let Some(writer) = &*self.writer.lock().unwrap_or_else(PoisonError::into_inner) {
            writer.record(block);
        }
    }
}
