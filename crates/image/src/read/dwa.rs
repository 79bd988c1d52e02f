//! Sizes inside DWA-compressed EXR blocks, checked before the codec allocates by them.

use exr::error::Error;
use exr::meta::header::Header;
use exr::prelude::Vec2;

/// Bytes of the eleven 64-bit counters that lead a block.
const LEADER_BYTES: usize = 88;

/// Refuses a block whose leading counters declare more data than its pixels can need. The `exr` crate allocates by
/// these counters, and one absurd value would end the process.
///
/// `data` is the compressed block, `size` its width and height in pixels.
pub(super) fn check(data: &[u8], size: Vec2<usize>, header: &Header) -> exr::error::Result<()> {
    let channels = header.channels.list.len();
    let raw_bytes = size.area() * header.channels.bytes_per_pixel;
    // Empty blocks are black, blocks of the raw size are not compressed: neither has counters.
    if data.is_empty() || data.len() == raw_bytes {
        return Ok(());
    }
    let Some(leader) = data.get(..LEADER_BYTES) else {
        return Err(Error::Invalid("truncated DWA header".into()));
    };
    // One mean and at most 63 other coefficients for each square of 8 x 8 samples; run-length
    // data exceed the raw size where runs are short, by less than twice.
    let squares = size.0.div_ceil(8) * size.1.div_ceil(8) * channels;
    let bounds = [(1, raw_bytes), (6, 2 * raw_bytes), (7, raw_bytes), (8, 64 * squares), (9, squares)];
    for (index, bound) in bounds {
        let bytes = &leader.as_chunks::<8>().0[index];
        if u64::from_le_bytes(*bytes) > bound as u64 {
            return Err(Error::Invalid("a DWA block declares more data than it has pixels".into()));
        }
    }
    Ok(())
}
