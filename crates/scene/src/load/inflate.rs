//! Bounded decompression: a small file must not become a huge one in memory.

use flate2::read::MultiGzDecoder;
use std::io::Read;

/// Most bytes that one compressed mesh may unpack to.
pub(super) const MAX_UNPACKED: u64 = 1 << 30;

/// Whether the bytes are gzip's.
pub(super) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// Unpacks a gzip file.
///
/// # Errors
/// What is wrong, as a message.
pub(super) fn gunzip(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    let mut limited = MultiGzDecoder::new(bytes).take(MAX_UNPACKED + 1);
    limited.read_to_end(&mut out).map_err(|e| format!("the gzip data is damaged: {e}"))?;
    if out.len() as u64 > MAX_UNPACKED {
        return Err(format!("the gzip data unpacks to more than {MAX_UNPACKED} bytes: unpack the file first"));
    }
    Ok(out)
}
