//! Reads recorded queries block by block.

use super::bytes::{BLOCK_BYTES, Counts, Cursor, HEADER_BYTES, MAGIC, record_bytes};
use super::record::{Block, BlockKey};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Why a file of queries cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum QueryFileError {
    /// The system says so.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// It is something else.
    #[error("is no file of recorded queries")]
    NotQueries,
    /// It ends before it should.
    #[error("ends in the middle of the block at byte {at}")]
    Truncated {
        /// Where the block begins.
        at: u64,
    },
    /// A block holds what no renderer writes.
    #[error("makes no sense in the block at byte {at}")]
    Damaged {
        /// Where the block begins.
        at: u64,
    },
}

/// A file of recorded queries.
#[derive(Debug)]
pub struct QueryFile {
    file: File,
    scene_hash: u64,
    triangles: u64,
    spheres: u64,
    blocks: Vec<Place>,
}

/// Where a block is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    key: BlockKey,
    at: u64,
    counts: Counts,
}

impl QueryFile {
    /// Opens a file and finds its blocks; memory is a few bytes a block.
    ///
    /// # Errors
    /// [`QueryFileError`] for a file that cannot be read, is no such file, or ends too early.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, QueryFileError> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut header = [0; HEADER_BYTES];
        file.read_exact(&mut header).map_err(|_| QueryFileError::NotQueries)?;
        let mut cursor = Cursor(header.strip_prefix(&MAGIC).ok_or(QueryFileError::NotQueries)?);
        let mut number = || cursor.long().ok_or(QueryFileError::NotQueries);
        let (scene_hash, triangles, spheres) = (number()?, number()?, number()?);
        let mut blocks = Vec::new();
        let mut at = HEADER_BYTES as u64;
        while at < length {
            let mut header = [0; BLOCK_BYTES];
            file.read_exact(&mut header).map_err(|_| QueryFileError::Truncated { at })?;
            let (key, counts) = Cursor(&header).block_header().ok_or(QueryFileError::Damaged { at })?;
            let end = at + BLOCK_BYTES as u64 + record_bytes(counts);
            if end > length {
                return Err(QueryFileError::Truncated { at });
            }
            blocks.push(Place { key, at, counts });
            at = file.seek(SeekFrom::Start(end))?;
        }
        blocks.sort_unstable();
        Ok(Self { file, scene_hash, triangles, spheres, blocks })
    }

    /// Hash of the scene's geometry: equal hashes number equal primitives alike.
    pub fn scene_hash(&self) -> u64 {
        self.scene_hash
    }

    /// Triangles and spheres of the scene: ids below the first number are triangles.
    pub fn primitives(&self) -> (u64, u64) {
        (self.triangles, self.spheres)
    }

    /// Blocks.
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Names of the blocks, in order.
    pub fn keys(&self) -> impl Iterator<Item = BlockKey> {
        self.blocks.iter().map(|place| place.key)
    }

    /// Reads block `index`, below [`QueryFile::block_count`]. Parents are checked: they come before their children.
    ///
    /// # Errors
    /// [`QueryFileError`] for a block that cannot be read or makes no sense.
    ///
    /// # Panics
    /// Where there is no such block.
    pub fn read(&mut self, index: usize) -> Result<Block, QueryFileError> {
        let Place { key, at, counts } = self.blocks[index];
        self.file.seek(SeekFrom::Start(at + BLOCK_BYTES as u64))?;
        // The length was checked against the file's when it was opened.
        let mut bytes = vec![0; record_bytes(counts) as usize];
        self.file.read_exact(&mut bytes)?;
        let mut cursor = Cursor(&bytes);
        let [rays, searches, photons] = counts;
        let block = (|| {
            Some(Block {
                key,
                rays: (0..rays).map(|_| cursor.ray()).collect::<Option<_>>()?,
                searches: (0..searches).map(|_| cursor.search()).collect::<Option<_>>()?,
                photons: (0..photons).map(|_| cursor.photon()).collect::<Option<_>>()?,
            })
        })();
        block.filter(parents_come_first).ok_or(QueryFileError::Damaged { at })
    }
}

fn parents_come_first(block: &Block) -> bool {
    let ray =
        |(child, ray): (usize, &super::RayRecord)| ray.parent == super::NO_PARENT || (ray.parent as usize) < child;
    block.rays.iter().enumerate().all(ray)
        && block.searches.iter().all(|search| (search.parent as usize) < block.rays.len())
}
