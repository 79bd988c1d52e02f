//! Sorting by keys that differ in few of their bits: as whole numbers together with their places, by counting their
//! digits.

/// Most bits of a key that are counted at a time.
const DIGIT_BITS: u32 = 11;
/// Below so many elements comparing is faster than counting.
const FEW: usize = 1024;

/// Sorts, and keeps its memory from one list to the next.
#[derive(Default)]
pub(crate) struct Sorter {
    /// The sorted places, with their keys above them.
    packed: Vec<u64>,
    place_bits: u32,
    scratch: Vec<u64>,
    counts: Vec<[u32; 1 << DIGIT_BITS]>,
}

impl Sorter {
    /// Sorts the places of keys by the keys, and where those are equal in their order.
    pub fn sort(&mut self, keys: &[u64]) {
        let first = keys.first().copied().unwrap_or(0);
        let differ = keys.iter().fold(0, |differ, key| differ | key ^ first);
        // The bits above the highest that differs are the same everywhere, and say nothing.
        let bits = u64::BITS - differ.leading_zeros();
        self.place_bits = usize::BITS - keys.len().leading_zeros();
        self.packed.clear();
        if bits > u64::BITS - self.place_bits {
            self.packed.extend(0..keys.len() as u64);
            self.packed.sort_by_key(|place| keys[*place as usize]);
            return;
        }
        let common = if bits == 0 { 0 } else { u64::MAX << (bits - 1) << 1 };
        let pack = |(key, place): (&u64, u64)| (key & !common) << self.place_bits | place;
        self.packed.extend(keys.iter().zip(0..).map(pack));
        if keys.len() < FEW {
            self.packed.sort_unstable();
        } else {
            self.sort_by_digits(bits);
        }
    }

    /// The places as they were sorted.
    pub fn places(&self) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        let mask = (1 << self.place_bits) - 1;
        self.packed.iter().map(move |packed| (packed & mask) as usize)
    }

    /// Sorts by `bits` bits above those of the places, the lowest digit first.
    fn sort_by_digits(&mut self, bits: u32) {
        let Self { packed, place_bits, scratch, counts } = self;
        // Digits of one length.
        let digits = bits.div_ceil(DIGIT_BITS);
        let digit_bits = bits.div_ceil(digits.max(1));
        let digit =
            |packed: u64, number: u32| (packed >> (*place_bits + number * digit_bits)) as usize % (1 << digit_bits);
        counts.clear();
        counts.resize(digits as usize, [0; 1 << DIGIT_BITS]);
        for packed in &*packed {
            for (counts, number) in counts.iter_mut().zip(0..) {
                counts[digit(*packed, number)] += 1;
            }
        }
        scratch.resize(packed.len(), 0);
        for (ends, number) in counts.iter_mut().zip(0..) {
            let mut before = 0;
            for end in ends.iter_mut() {
                before += std::mem::replace(end, before);
            }
            for element in &*packed {
                let end = &mut ends[digit(*element, number)];
                scratch[*end as usize] = *element;
                *end += 1;
            }
            std::mem::swap(packed, scratch);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    #[test]
    fn places_are_ordered_as_by_the_library() {
        let mut sorter = Sorter::default();
        for (case, count) in [0, 1, 2, 100, FEW - 1, FEW, 5000, 1 << 16].into_iter().enumerate() {
            // Keys of all bits, of few bits high up and low down, and of one bit.
            for mask in [u64::MAX, 0xFFFF_0000_0000, 0x8000_0000_0000, 0x7FFF_FFFF_FFFF, 0x3FF_FFFF, 0b1010_0000, 1, 0]
            {
                let keys: Vec<u64> = (0..count as u64)
                    .map(|i| {
                        let mut s = Sampler::new(case as u64, StreamKind::Test, i, 0);
                        let [high, low] = s.next_2d().map(|u| u64::from(u.to_bits().wrapping_mul(0x9E37_79B9)));
                        (high << 32 | low) & mask | !mask & 0x0123_4567_89AB_CDEF
                    })
                    .collect();
                sorter.sort(&keys);
                let mut by_library: Vec<usize> = (0..count).collect();
                by_library.sort_by_key(|place| keys[*place]);
                assert!(sorter.places().eq(by_library), "{count} elements, mask {mask:x}");
            }
        }
    }
}
