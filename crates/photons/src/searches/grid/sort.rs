//! Photons in the order of their keys: a stable radix sort of keys with ids.

use rayon::prelude::*;
use std::ops::Range;

/// Bits of an id in a packed item.
const ID_BITS: u32 = 30;
/// Most bits of a digit: as many open cache lines as a core's second-level cache holds with ease.
const MAX_DIGIT_BITS: u32 = 11;
/// Items that are worth a task of their own.
pub(crate) const ITEMS_A_TASK: usize = 1 << 15;

/// A key and a photon's id.
pub(crate) trait Item: Copy + Send + Sync {
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

/// Sorts by key, equal keys in the order that they came in; keys have at most `key_bits` bits.
pub(crate) fn sort_by_key<I: Item>(mut items: Vec<I>, key_bits: u32) -> Vec<I> {
    let passes = key_bits.div_ceil(MAX_DIGIT_BITS).max(1);
    let digit_bits = key_bits.div_ceil(passes);
    let mut other = items.clone();
    for pass in 0..passes {
        scatter(
            &items,
            &mut other,
            |item| (item.key() >> (pass * digit_bits)) as usize & ((1 << digit_bits) - 1),
            digit_bits,
        );
        std::mem::swap(&mut items, &mut other);
    }
    items
}

/// Copies `from` to `to` in the order of digits, equal digits in the order of `from`.
///
/// Each task owns a range of digits, so a piece of `to`, and reads all of `from`: more reading, no shared writing.
fn scatter<I: Item>(from: &[I], to: &mut [I], digit: impl Fn(I) -> usize + Sync, digit_bits: u32) {
    let counts = count(from, &digit, 1 << digit_bits);
    let mut tasks: Vec<(Range<usize>, &mut [I])> = Vec::new();
    let share = from.len().div_ceil(rayon::current_num_threads()).max(ITEMS_A_TASK);
    let (mut rest, mut first, mut size) = (to, 0, 0);
    for digit in 0..counts.len() {
        size += counts[digit] as usize;
        if size >= share || digit + 1 == counts.len() {
            let (mine, others) = std::mem::take(&mut rest).split_at_mut(size);
            tasks.push((first..digit + 1, mine));
            (rest, first, size) = (others, digit + 1, 0);
        }
    }
    tasks.into_par_iter().with_max_len(1).for_each(|(digits, to)| {
        let mut places: Vec<u32> = Vec::with_capacity(digits.len());
        let mut sum = 0;
        for count in &counts[digits.clone()] {
            places.push(sum);
            sum += count;
        }
        for item in from {
            if let Some(place) = places.get_mut(digit(*item).wrapping_sub(digits.start)) {
                to[*place as usize] = *item;
                *place += 1;
            }
        }
    });
}

/// How many items have each digit.
fn count<I: Item>(items: &[I], digit: &(impl Fn(I) -> usize + Sync), digits: usize) -> Vec<u32> {
    let share = items.len().div_ceil(rayon::current_num_threads()).max(ITEMS_A_TASK);
    let count_share = |items: &[I]| {
        let mut counts = vec![0; digits];
        for item in items {
            counts[digit(*item)] += 1;
        }
        counts
    };
    let add = |mut a: Vec<u32>, b: Vec<u32>| {
        a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        a
    };
    items.par_chunks(share).map(count_share).reduce_with(add).unwrap_or_else(|| vec![0; digits])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorting_is_stable_on_any_number_of_threads() {
        let hash = |i: u64| i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 20;
        for (count, bits) in [(0, 5), (1, 0), (1000, 1), (200_000, 34), (200_000, 13)] {
            let keys: Vec<u64> = (0..count).map(|i| hash(i) & ((1u64 << bits) - 1)).collect();
            let mut expected: Vec<(u64, u32)> = keys.iter().copied().zip(0..).collect();
            expected.sort_unstable();
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let short = keys.iter().zip(0..).map(|(k, i)| <u64 as Item>::new(*k, i)).collect();
                let short = pool.install(|| sort_by_key::<u64>(short, bits));
                assert!(short.iter().map(|i| (i.key(), i.id())).eq(expected.iter().copied()), "{count}, {bits}");
                let long = keys.iter().copied().zip(0..).collect();
                assert_eq!(pool.install(|| sort_by_key::<(u64, u32)>(long, bits)), expected, "{count}, {bits}");
            }
        }
    }
}
