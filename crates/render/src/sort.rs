//! Sorting of large elements by keys that differ in few of their bits: as whole numbers, and each element is moved once.

/// Bits of a number that hold where an element came from.
const PLACE_BITS: u32 = 16;
/// Bits of a key that are counted at a time.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;
/// Below so many elements comparing is faster than counting.
const FEW: usize = 1024;

/// Sorts `list` by `key`, equals in their order, as `slice::sort_by_cached_key` does.
pub(crate) fn sort_by_key<T: Copy>(list: &mut [T], key: impl Fn(&T) -> u64) {
    let Some(first) = list.first().map(&key) else { return };
    let mut differ = 0;
    let mut keys: Vec<u64> = list
        .iter()
        .map(|element| {
            let key = key(element);
            differ |= key ^ first;
            key
        })
        .collect();
    // The bits above the highest that differs are the same everywhere, and say nothing.
    let bits = u64::BITS - differ.leading_zeros();
    if bits > u64::BITS - PLACE_BITS || list.len() > 1 << PLACE_BITS {
        list.sort_by_cached_key(key);
        return;
    }
    keys.iter_mut().enumerate().for_each(|(place, key)| *key = *key << PLACE_BITS | place as u64);
    let common = if bits == 0 { 0 } else { u64::MAX << PLACE_BITS << (bits - 1) << 1 };
    keys.iter_mut().for_each(|key| *key &= !common);
    if keys.len() < FEW {
        keys.sort_unstable()
    } else {
        keys = sorted_by_digits(keys, bits)
    }
    permute(list, keys);
}

/// Sorts numbers by `bits` bits above those of their places, the lowest digit first.
fn sorted_by_digits(mut keys: Vec<u64>, bits: u32) -> Vec<u64> {
    let mut other = vec![0; keys.len()];
    for shift in (0..bits).step_by(DIGIT_BITS as usize) {
        let digit = |key: u64| (key >> (PLACE_BITS + shift)) as usize % DIGITS;
        let mut ends = [0u32; DIGITS];
        keys.iter().for_each(|key| ends[digit(*key)] += 1);
        let mut before = 0;
        for end in &mut ends {
            before += std::mem::replace(end, before);
        }
        for key in &keys {
            let place = &mut ends[digit(*key)];
            other[*place as usize] = *key;
            *place += 1;
        }
        std::mem::swap(&mut keys, &mut other);
    }
    keys
}

/// Moves to each place the element that its number says, along the cycles of the permutation.
fn permute<T: Copy>(list: &mut [T], mut order: Vec<u64>) {
    let from = |number: u64| number as usize % (1 << PLACE_BITS);
    for start in 0..list.len() {
        let (kept, mut hole) = (list[start], start);
        loop {
            let next = from(order[hole]);
            order[hole] = hole as u64;
            if next == start || next == hole {
                break;
            }
            list[hole] = list[next];
            hole = next;
        }
        list[hole] = kept;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    #[test]
    fn elements_are_ordered_as_by_the_library() {
        for (case, count) in
            [0, 1, 2, 100, FEW - 1, FEW, 5000, 1 << PLACE_BITS, (1 << PLACE_BITS) + 1].into_iter().enumerate()
        {
            // Keys of all bits, of few bits high up and low down, and of one bit.
            for mask in [u64::MAX, 0xFFFF_0000_0000, 0x8000_0000_0000, 0xFFFF_FFFF_FFFF, 0x3FF_FFFF, 0b1010_0000, 1, 0]
            {
                let list: Vec<(u64, usize)> = (0..count)
                    .map(|i| {
                        let mut s = Sampler::new(case as u64, StreamKind::Test, i as u64, 0);
                        let [high, low] = s.next_2d().map(|u| u64::from(u.to_bits().wrapping_mul(0x9E37_79B9)));
                        ((high << 32 | low) & mask | !mask & 0x0123_4567_89AB_CDEF, i)
                    })
                    .collect();
                let mut by_library = list.clone();
                by_library.sort_by_key(|e| e.0);
                let mut ours = list;
                sort_by_key(&mut ours, |e| e.0);
                assert!(ours == by_library, "{count} elements, mask {mask:x}");
            }
        }
    }
}
