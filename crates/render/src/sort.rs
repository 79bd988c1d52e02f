//! Sorting of places by keys that differ in few of their bits: as whole numbers, by counting their digits.

/// Bits of a key that are counted at a time.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;
/// Below so many elements comparing is faster than counting.
const FEW: usize = 1024;

/// Makes `order` the places, numbers of `place_bits` bits, of pairs of a key and a place, sorted by keys and where
/// those are equal in the order of the pairs; false where keys differ in too many bits for that.
pub(crate) fn sorted_places(
    pairs: impl Iterator<Item = (u64, u64)> + Clone,
    place_bits: u32,
    order: &mut Vec<u64>,
    scratch: &mut Vec<u64>,
) -> bool {
    let first = pairs.clone().next().map_or(0, |pair| pair.0);
    let (differ, used) =
        pairs.clone().fold((0, 0), |(differ, used), (key, place)| (differ | key ^ first, used | place));
    // The bits above the highest that differs are the same everywhere, and say nothing.
    let bits = u64::BITS - differ.leading_zeros();
    if bits > u64::BITS - place_bits || used >> place_bits != 0 {
        return false;
    }
    let common = if bits == 0 { 0 } else { u64::MAX << (bits - 1) << 1 };
    order.clear();
    order.extend(pairs.map(|(key, place)| (key & !common) << place_bits | place));
    if order.len() < FEW {
        order.sort_by_key(|key| key >> place_bits);
    } else {
        sort_by_digits(order, place_bits, bits, scratch);
    }
    order.iter_mut().for_each(|key| *key &= (1 << place_bits) - 1);
    true
}

/// Sorts numbers by `bits` bits above those of their places, the lowest digit first.
fn sort_by_digits(keys: &mut Vec<u64>, place_bits: u32, bits: u32, scratch: &mut Vec<u64>) {
    scratch.resize(keys.len(), 0);
    // Digits of one length.
    let digit_bits = bits.div_ceil(bits.div_ceil(DIGIT_BITS).max(1)).max(1);
    for shift in (0..bits).step_by(digit_bits as usize) {
        let digit = |key: u64| (key >> (place_bits + shift)) as usize % (1 << digit_bits);
        let mut ends = [0u32; DIGITS];
        keys.iter().for_each(|key| ends[digit(*key)] += 1);
        let mut before = 0;
        for end in &mut ends {
            before += std::mem::replace(end, before);
        }
        for key in &*keys {
            let place = &mut ends[digit(*key)];
            scratch[*place as usize] = *key;
            *place += 1;
        }
        std::mem::swap(keys, scratch);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    #[test]
    fn places_are_ordered_as_by_the_library() {
        const PLACE_BITS: u32 = 17;
        let (mut order, mut scratch) = (Vec::new(), Vec::new());
        for (case, count) in [0, 1, 2, 100, FEW - 1, FEW, 5000, 1 << 16].into_iter().enumerate() {
            // Keys of all bits, of few bits high up and low down, and of one bit.
            for mask in [u64::MAX, 0xFFFF_0000_0000, 0x8000_0000_0000, 0x7FFF_FFFF_FFFF, 0x3FF_FFFF, 0b1010_0000, 1, 0]
            {
                let pairs: Vec<(u64, u64)> = (0..count as u64)
                    .map(|i| {
                        let mut s = Sampler::new(case as u64, StreamKind::Test, i, 0);
                        let [high, low] = s.next_2d().map(|u| u64::from(u.to_bits().wrapping_mul(0x9E37_79B9)));
                        ((high << 32 | low) & mask | !mask & 0x0123_4567_89AB_CDEF, i)
                    })
                    .collect();
                let done = sorted_places(pairs.iter().copied(), PLACE_BITS, &mut order, &mut scratch);
                let fits = pairs.iter().all(|pair| (pair.0 ^ pairs[0].0) >> (64 - PLACE_BITS) == 0);
                assert_eq!(done, fits, "{count} elements, mask {mask:x}");
                if done {
                    let mut by_library = pairs;
                    by_library.sort_by_key(|pair| pair.0);
                    let by_library: Vec<u64> = by_library.into_iter().map(|pair| pair.1).collect();
                    assert!(order == by_library, "{count} elements, mask {mask:x}");
                }
            }
        }
        assert!(!sorted_places([(0, 1 << 17)].into_iter(), PLACE_BITS, &mut order, &mut scratch), "no such place");
    }
}
