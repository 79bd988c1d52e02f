//! Arrays on huge pages: what rays read here and there all over, more than the processor knows the small pages of.
//!
//! The system is asked for huge pages (madvise(2), MADV_HUGEPAGE), so that fewer addresses have to be looked up; where it
//! has none the array is as good as any.

use rayon::prelude::*;
use std::alloc::{Layout, alloc, dealloc, handle_alloc_error};
use std::ffi::c_void;
use std::fmt;
use std::mem::MaybeUninit;
use std::ops::{Deref, DerefMut};
use std::ptr::NonNull;

/// A huge page of x86-64 and of most others.
const PAGE: usize = 2 << 20;
/// Arrays of fewer bytes take what alignment their elements ask for: half a page is too much to waste.
const LEAST: usize = PAGE / 2;
/// Elements that a thread writes at a time.
const SHARE: usize = 64;

/// An array of constant length.
pub struct HugeArray<T> {
    start: NonNull<T>,
    len: usize,
    /// What it lies in, where it has pages of its own.
    pages: Option<Pages>,
}

// SAFETY: it owns its elements as a `Vec` does.
unsafe impl<T: Send> Send for HugeArray<T> {}
// SAFETY: as above; shared, it only gives out shared references.
unsafe impl<T: Sync> Sync for HugeArray<T> {}

impl<T: Send> HugeArray<T> {
    /// The array of `len` elements that `element` gives by their indices, in any order and on all threads.
    pub fn new(len: usize, element: impl Fn(usize) -> T + Sync) -> Self {
        let mut out = Self::room(len, LEAST);
        let places = out.places().into_par_iter().with_min_len(SHARE);
        places.enumerate().for_each(|(i, place)| {
            place.write(element(i));
        });
        out
    }

    /// Two arrays of `len` elements, which `element` gives by their indices; from `least` bytes on each takes huge pages.
    pub fn pair<U: Send>(len: usize, least: usize, element: impl Fn(usize) -> (T, U) + Sync) -> (Self, HugeArray<U>) {
        let (mut first, mut second) = (Self::room(len, least), HugeArray::room(len, least));
        let places = first.places().into_par_iter().zip(second.places()).with_min_len(SHARE);
        places.enumerate().for_each(|(i, (first, second))| {
            let (a, b) = element(i);
            first.write(a);
            second.write(b);
        });
        (first, second)
    }

    /// The elements of an array that was just made, all to be written. Should whoever does it panic, nothing that was
    /// written needs to be dropped, and the array frees its room.
    fn places(&mut self) -> &mut [MaybeUninit<T>] {
        // SAFETY: there is room for `len` elements, which need not be written yet, and nobody else has a reference to it.
        unsafe { std::slice::from_raw_parts_mut(self.start.as_ptr().cast::<MaybeUninit<T>>(), self.len) }
    }

    /// Room for `len` elements, on huge pages from `least` bytes on.
    fn room(len: usize, least: usize) -> Self {
        const { assert!(!std::mem::needs_drop::<T>() && size_of::<T>() > 0 && align_of::<T>() <= PAGE) }
        let layout = Self::layout(len);
        let own = if layout.size() >= least { Pages::new(layout.size()) } else { None };
        if let Some(pages) = own {
            return Self { start: pages.first().cast(), len, pages: own };
        }
        if len == 0 {
            return Self { start: NonNull::dangling(), len, pages: None };
        }
        // SAFETY: the layout's size is not zero.
        let start = unsafe { alloc(layout) };
        let Some(start) = NonNull::new(start.cast()) else { handle_alloc_error(layout) };
        Self { start, len, pages: None }
    }
}

impl<T> HugeArray<T> {
    fn layout(len: usize) -> Layout {
        Layout::array::<T>(len).expect("an array that fits the address space")
    }
}

impl<T> Deref for HugeArray<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        // SAFETY: `new` wrote all `len` elements before it gave the array away.
        unsafe { std::slice::from_raw_parts(self.start.as_ptr(), self.len) }
    }
}

impl<T> DerefMut for HugeArray<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: as above, and nobody else has a reference to any of them.
        unsafe { std::slice::from_raw_parts_mut(self.start.as_ptr(), self.len) }
    }
}

impl<T> Drop for HugeArray<T> {
    fn drop(&mut self) {
        match self.pages.take() {
            Some(pages) => pages.give_back(),
            // SAFETY: `room` allocated it with the same layout; its elements need no drop.
            None if self.len > 0 => unsafe { dealloc(self.start.as_ptr().cast(), Self::layout(self.len)) },
            None => {}
        }
    }
}

impl<T: fmt::Debug> fmt::Debug for HugeArray<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self[..].fmt(f)
    }
}

/// Pages that nobody used before, which an allocator does not promise: those that it hands out again stay small.
#[derive(Clone, Copy)]
struct Pages {
    start: NonNull<c_void>,
    bytes: usize,
}

#[cfg(all(target_os = "linux", not(miri)))]
impl Pages {
    /// Room for so many bytes on huge pages; `None` where the system gives none.
    fn new(bytes: usize) -> Option<Self> {
        use rustix::mm::{Advice, MapFlags, ProtFlags, madvise, mmap_anonymous};
        // A page more, of which the part before the first whole one stays untouched and so takes no memory.
        let bytes = bytes.checked_next_multiple_of(PAGE)?.checked_add(PAGE)?;
        let (access, flags) = (ProtFlags::READ | ProtFlags::WRITE, MapFlags::PRIVATE);
        // SAFETY: a new mapping anywhere overlaps nothing.
        let start = unsafe { mmap_anonymous(std::ptr::null_mut(), bytes, access, flags) }.ok()?;
        let out = Self { start: NonNull::new(start)?, bytes };
        // SAFETY: the mapping is this one's own, and holds nothing yet. Where the system refuses, pages stay small.
        let _ = unsafe { madvise(out.first().as_ptr(), bytes - PAGE, Advice::LinuxHugepage) };
        Some(out)
    }

    /// Unmaps them.
    fn give_back(self) {
        // SAFETY: they were mapped by `new`, and whoever calls this has no reference to them left.
        let _ = unsafe { rustix::mm::munmap(self.start.as_ptr(), self.bytes) };
    }
}

#[cfg(not(all(target_os = "linux", not(miri))))]
impl Pages {
    fn new(_: usize) -> Option<Self> {
        None
    }

    fn give_back(self) {}
}

impl Pages {
    /// The first whole huge page.
    fn first(&self) -> NonNull<c_void> {
        let before = self.start.as_ptr().addr().wrapping_neg() % PAGE;
        // SAFETY: that is less than a huge page, of which there is one more than asked for.
        unsafe { self.start.byte_add(before) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_hold_what_they_were_given() {
        for len in [0, 1, 63, 1000, LEAST / 8 - 1, LEAST / 8, 3 * PAGE / 8 + 5] {
            let array = HugeArray::new(len, |i| i as u64 * 3);
            assert_eq!(array.len(), len);
            assert!(array.iter().zip(0..).all(|(x, i)| *x == 3 * i), "{len}");
            let has_pages = cfg!(all(target_os = "linux", not(miri))) && len >= LEAST / 8;
            assert!(!has_pages || array.as_ptr().addr().is_multiple_of(PAGE));
        }
    }

    #[test]
    fn pairs_hold_what_they_were_given() {
        for len in [0, 1, 100, PAGE / 8 - 1, PAGE / 8, PAGE / 2] {
            let (longs, bytes) = HugeArray::pair(len, PAGE, |i| (i as u64 * 3, i as u8));
            assert!(longs.iter().zip(&bytes[..]).zip(0..).all(|((x, y), i)| *x == 3 * i && *y == i as u8), "{len}");
            assert_eq!((longs.len(), bytes.len()), (len, len));
        }
    }

    #[test]
    fn a_panic_of_an_element_is_passed_on() {
        let made = std::panic::catch_unwind(|| HugeArray::new(100_000, |i| [i; 4].map(|i| 1 / (i ^ 777))));
        assert!(made.is_err());
    }
}
