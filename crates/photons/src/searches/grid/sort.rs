//! Photons in the order of their keys.
//!
//! One pass moves photons into buckets by the highest bits of their keys, reading in order; the photons of a bucket
//! lie in a few pages, and its keys are sorted where they fit a core's cache.

use crate::Photon;
use rayon::prelude::*;
use std::ops::Range;

/// Bits of an id in a packed item.
const ID_BITS: u32 = 30;
/// Most bits of the digit that makes a bucket.
const BUCKET_BITS: u32 = 11;
/// Photons of a bucket, on the mean, as a power of two: what a core's first-level cache holds.
const BUCKET_SIZE_BITS: u32 = 9;
/// Most bits of a digit inside a bucket.
const DIGIT_BITS: u32 = 8;
/// Fewer items than this are left to the library's sort.
const FEW: usize = 64;
/// Items that are worth a task of their own.
pub(crate) const ITEMS_A_TASK: usize = 1 << 15;

/// A key and an id, ordered by both.
pub(crate) trait Item: Copy + Ord + Send + Sync {
    /// Most bits of a key.
    const KEY_BITS: u32;
    fn new(key: u64, id: u32) -> Self;
    fn key(self) -> u64;
    fn id(self) -> u32;
}

/// Short keys: half the memory to move.
impl Item for u64 {
    const KEY_BITS: u32 = 64 - ID_BITS;

    #[inline]
    fn new(key: u64, id: u32) -> Self {
        key << ID_BITS | u64::from(id)
    }

    #[inline]
    fn key(self) -> u64 {
        self >> ID_BITS
    }

    #[inline]
    fn id(self) -> u32 {
        (self & ((1 << ID_BITS) - 1)) as u32
    }
}

/// Keys of any length.
impl Item for (u64, u32) {
    const KEY_BITS: u32 = 64;

    #[inline]
    fn new(key: u64, id: u32) -> Self {
        (key, id)
    }

    #[inline]
    fn key(self) -> u64 {
        self.0
    }

    #[inline]
    fn id(self) -> u32 {
        self.1
    }
}

/// The six words of a photon, and its id: plain words, because the system hands out zeroed memory as it is touched.
pub(crate) type Staged = [u32; 7];

/// Photons in an order that is close to that of their keys, and the order itself.
pub(crate) struct Sorted<I> {
    /// By bucket, inside a bucket as they came.
    pub(crate) staged: Vec<Staged>,
    /// Keys in ascending order, equal keys by id, with the places of their photons.
    pub(crate) items: Vec<I>,
}

/// Sorts photons by `key`, equal keys by id; keys have at most `key_bits` bits. Takes the photons, so that their memory
/// is given back before blocks are made.
pub(crate) fn sort_by_key<I: Item>(
    photons: Vec<Photon>,
    key_bits: u32,
    key: impl Fn(&Photon) -> u64 + Send + Sync,
) -> Sorted<I> {
    let count = photons.len();
    let bucket_bits = (count.max(1).ilog2()).saturating_sub(BUCKET_SIZE_BITS).min(BUCKET_BITS).min(key_bits);
    let low_bits = key_bits - bucket_bits;
    let keys: Vec<u64> = photons.par_iter().with_min_len(ITEMS_A_TASK).map(key).collect();
    let bucket = |key: u64| (key >> low_bits) as usize;
    let counts = count_buckets(&keys, bucket, 1 << bucket_bits);
    let mut sorted = Sorted { staged: vec![[0; 7]; count], items: vec![I::new(0, 0); count] };
    // Each task owns a range of buckets, so a piece of the result, and reads all keys: more reading, no shared writing.
    let share = count.div_ceil(rayon::current_num_threads()).max(ITEMS_A_TASK);
    let tasks = split(&counts, share, &mut sorted);
    tasks.into_par_iter().with_max_len(1).for_each(|task| {
        let mut places = task.places(&counts);
        for (id, key) in keys.iter().enumerate() {
            if let Some(place) = places.get_mut(bucket(*key).wrapping_sub(task.buckets.start)) {
                let at = *place as usize;
                let [x, y, z, flux, direction, surface] = photons[id].to_words();
                task.staged[at] = [x, y, z, flux, direction, surface, id as u32];
                task.items[at] = I::new(*key, (task.first + at) as u32);
                *place += 1;
            }
        }
        let mut scratch = Vec::new();
        let mut rest = &mut *task.items;
        for count in &counts[task.buckets.clone()] {
            let (items, others) = rest.split_at_mut(*count as usize);
            sort_items(items, low_bits, &mut scratch);
            rest = others;
        }
    });
    sorted
}

/// A range of buckets and the piece of the result that they fill.
struct Task<'a, I> {
    buckets: Range<usize>,
    /// Photons before the piece.
    first: usize,
    staged: &'a mut [Staged],
    items: &'a mut [I],
}

impl<I> Task<'_, I> {
    /// Where each bucket begins in the piece.
    fn places(&self, counts: &[u32]) -> Vec<u32> {
        let mut sum = 0;
        let place = |count: &u32| {
            sum += count;
            sum - count
        };
        counts[self.buckets.clone()].iter().map(place).collect()
    }
}

/// Tasks of about `share` photons each.
fn split<'a, I>(counts: &[u32], share: usize, sorted: &'a mut Sorted<I>) -> Vec<Task<'a, I>> {
    let mut tasks = Vec::new();
    let (mut staged, mut items) = (&mut sorted.staged[..], &mut sorted.items[..]);
    let (mut first_bucket, mut first, mut size) = (0, 0, 0);
    for bucket in 0..counts.len() {
        size += counts[bucket] as usize;
        if size >= share || bucket + 1 == counts.len() {
            let (task_staged, other_staged) = staged.split_at_mut(size);
            let (task_items, other_items) = items.split_at_mut(size);
            tasks.push(Task { buckets: first_bucket..bucket + 1, first, staged: task_staged, items: task_items });
            (staged, items) = (other_staged, other_items);
            (first_bucket, first, size) = (bucket + 1, first + size, 0);
        }
    }
    tasks
}

/// How many keys each bucket has.
fn count_buckets(keys: &[u64], bucket: impl Fn(u64) -> usize + Sync, buckets: usize) -> Vec<u32> {
    let share = keys.len().div_ceil(rayon::current_num_threads()).max(ITEMS_A_TASK);
    let count_share = |keys: &[u64]| {
        let mut counts = vec![0; buckets];
        for key in keys {
            counts[bucket(*key)] += 1;
        }
        counts
    };
    let add = |mut a: Vec<u32>, b: Vec<u32>| {
        a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        a
    };
    keys.par_chunks(share).map(count_share).reduce_with(add).unwrap_or_else(|| vec![0; buckets])
}

/// Sorts items whose keys differ in their lowest `bits` bits only, and which are in the order of their ids.
pub(super) fn sort_items<I: Item>(items: &mut [I], bits: u32, scratch: &mut Vec<I>) {
    if items.len() < FEW || bits == 0 {
        items.sort_unstable();
        return;
    }
    scratch.clear();
    scratch.extend_from_slice(items);
    let passes = bits.div_ceil(DIGIT_BITS);
    let digit_bits = bits.div_ceil(passes);
    let (mut from, mut to) = (&mut scratch[..], &mut *items);
    for pass in 0..passes {
        let digit = |item: I| (item.key() >> (pass * digit_bits)) as usize & ((1 << digit_bits) - 1);
        let mut places = [0u32; 1 << DIGIT_BITS];
        for item in &*from {
            places[digit(*item)] += 1;
        }
        let mut sum = 0;
        for place in &mut places {
            sum += std::mem::replace(place, sum);
        }
        for item in &*from {
            let place = &mut places[digit(*item)];
            to[*place as usize] = *item;
            *place += 1;
        }
        std::mem::swap(&mut from, &mut to);
    }
    // The last pass wrote to what is called `from` now: `scratch` after an even number of passes.
    if passes.is_multiple_of(2) {
        items.copy_from_slice(scratch);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    #[test]
    fn sorting_is_stable_on_any_number_of_threads() {
        let hash = |i: u64| i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 20;
        for (count, bits) in [(0, 5), (1, 0), (1000, 1), (100_000, 34), (100_000, 13), (100_000, 20)] {
            let photon = |i: u64| {
                let key = hash(i) & ((1u64 << bits) - 1);
                let [high, low] = [key >> 20, key & 0xF_FFFF].map(|half| half as f32);
                Photon::new(Vec3::new(high, low, i as f32), Vec3::ONE, Vec3::Z, Vec3::Z, 1, false).unwrap()
            };
            let photons: Vec<Photon> = (0..count).map(photon).collect();
            let key = |p: &Photon| (p.position().x as u64) << 20 | p.position().y as u64;
            let mut expected: Vec<(u64, u32)> = photons.iter().map(key).zip(0..).collect();
            expected.sort_unstable();
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let check = |key: u64, staged: Staged, expected: (u64, u32)| {
                    let [words @ .., id] = staged;
                    assert_eq!((key, id), expected, "{count} of {bits} bits, {threads} threads");
                    assert_eq!(words, photons[id as usize].to_words());
                };
                let short = pool.install(|| sort_by_key::<u64>(photons.clone(), bits, key));
                let long = pool.install(|| sort_by_key::<(u64, u32)>(photons.clone(), bits, key));
                assert_eq!((short.items.len(), long.items.len()), (expected.len(), expected.len()));
                for ((short_item, long_item), expected) in short.items.iter().zip(&long.items).zip(expected.clone()) {
                    check(short_item.key(), short.staged[short_item.id() as usize], expected);
                    check(long_item.key(), long.staged[long_item.id() as usize], expected);
                }
            }
        }
    }
}
