//! Photons in the order of their cells: a stable radix sort of (key, id) pairs.

/// A Morton key and a photon's id; in order of keys, then ids, once sorted.
pub(crate) type Keyed = (u64, u32);

/// Bits of a digit.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;

/// Sorts by key, equal keys in the order that they came in; all keys are below `key_end`.
pub(crate) fn sort_by_key(mut keyed: Vec<Keyed>, key_end: u64) -> Vec<Keyed> {
    let bits = 64 - key_end.saturating_sub(1).leading_zeros();
    let mut other = vec![(0, 0); keyed.len()];
    for shift in (0..bits).step_by(DIGIT_BITS as usize) {
        scatter(&keyed, &mut other, shift);
        std::mem::swap(&mut keyed, &mut other);
    }
    keyed
}

fn scatter(from: &[Keyed], to: &mut [Keyed], shift: u32) {
    let digit = |key: u64| (key >> shift) as usize & (DIGITS - 1);
    let mut at = [0u32; DIGITS];
    for (key, _) in from {
        at[digit(*key)] += 1;
    }
    let mut sum = 0;
    for place in &mut at {
        sum += std::mem::replace(place, sum);
    }
    for item in from {
        let place = &mut at[digit(item.0)];
        to[*place as usize] = *item;
        *place += 1;
    }
}
