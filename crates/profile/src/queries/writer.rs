//! Writes recorded queries as they come.

use super::bytes::{MAGIC, put_block};
use super::record::{Block, QuerySink};
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

/// What has been recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QueryTotals {
    /// Rays.
    pub rays: u64,
    /// Searches.
    pub searches: u64,
    /// Photons.
    pub photons: u64,
    /// Bytes written.
    pub bytes: u64,
}

/// Writes a file of queries. Blocks lie in it as they are finished, which depends on the threads; readers put them in
/// order.
pub struct QueryFileWriter<W> {
    state: Mutex<State<W>>,
}

struct State<W> {
    out: W,
    totals: QueryTotals,
    /// What went wrong first: nothing is written after that.
    failed: Option<io::Error>,
}

impl<W: Write> QueryFileWriter<W> {
    /// Begins a file with the hash of the scene and its numbers of triangles and spheres. `out` should be buffered.
    ///
    /// # Errors
    /// What `out` says.
    pub fn new(mut out: W, scene_hash: u64, triangles: u64, spheres: u64) -> io::Result<Self> {
        out.write_all(&MAGIC)?;
        for number in [scene_hash, triangles, spheres] {
            out.write_all(&number.to_le_bytes())?;
        }
        let totals = QueryTotals { bytes: super::bytes::HEADER_BYTES as u64, ..QueryTotals::default() };
        Ok(Self { state: Mutex::new(State { out, totals, failed: None }) })
    }

    /// Ends the file and hands out what was written to, flushed.
    ///
    /// # Errors
    /// The first thing that went wrong.
    pub fn finish(self) -> io::Result<(W, QueryTotals)> {
        let mut state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        match state.failed {
            Some(error) => Err(error),
            None => state.out.flush().map(|()| (state.out, state.totals)),
        }
    }
}

impl<W: Write + Send> QuerySink for QueryFileWriter<W> {
    fn record(&self, block: &Block) {
        let mut bytes = Vec::new();
        put_block(&mut bytes, block);
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.failed.is_some() {
            return;
        }
        match state.out.write_all(&bytes) {
            Ok(()) => {
                state.totals.rays += block.rays.len() as u64;
                state.totals.searches += block.searches.len() as u64;
                state.totals.photons += block.photons.len() as u64;
                state.totals.bytes += bytes.len() as u64;
            }
            Err(error) => state.failed = Some(error),
        }
    }
}
