//! Settings of the system's allocator, so that the memory of a render can be predicted.

/// Lists of this size and above are pages of their own, which the system has back as soon as they are dropped.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const OWN_PAGES_BYTES: i32 = 4 << 20;

/// So much unused memory at the end of a heap stays there: what a tile drops is what the next one asks for, and pages that
/// the system takes back in between come again one fault at a time.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const SPARE_BYTES: i32 = 16 << 20;

/// Makes large lists pages of their own. Left to itself glibc raises its bound to the largest list ever dropped, up to
/// 32 MiB, and from then on keeps what the photons of a pass leave behind between what is still used: the memory of a
/// render with a million photons grows by half within a few passes. Without glibc nothing is set.
///
/// To be called first, while there is one thread.
pub fn prepare() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: mallopt(3) takes two integers and changes settings of the allocator only; no other thread exists yet. A
    // setting that it refuses is left as it was, which costs memory and nothing else.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, OWN_PAGES_BYTES);
        libc::mallopt(libc::M_TRIM_THRESHOLD, SPARE_BYTES);
    }
}
