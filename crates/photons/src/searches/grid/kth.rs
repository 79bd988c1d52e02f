//! The k-th least of some distances, by counting.

/// Lanes of a count.
const LANES: usize = 16;
/// Guesses by proportion before the range is halved instead.
const GUESSES: u32 = 12;

/// The `k`-th least (from 1) of `values`, full lanes of numbers above `low`; at least `k` of them are finite. Squared
/// distances, none of them negative, are all above -1.
///
/// Distances squared on a surface are spread evenly, so that a guess in proportion to the number wanted is near; a few
/// passes over the values find a number that exactly `k` are below.
#[inline(always)]
pub(crate) fn kth_least(values: &[f32], mut low: f32, k: usize) -> f32 {
    let mut low_count = 0;
    let (mut high, mut high_count) = farthest_within(values, f32::MAX);
    let mut guesses = 0;
    while high_count > k {
        let share = (k as f32 - 0.5 - low_count as f32) / (high_count - low_count) as f32;
        let low_end = low.max(0.0);
        let guess = low_end + (high - low_end) * share;
        let guess = if guesses < GUESSES && guess > low && guess < high { guess } else { between(low, high) };
        if !(guess < high) {
            // Several lie at the very distance of the k-th.
            break;
        }
        guesses += 1;
        let (farthest, count) = farthest_within(values, guess);
        if count < k {
            (low, low_count) = (guess, count);
        } else {
            (high, high_count) = (farthest, count);
        }
    }
    high
}

/// Fills the last lanes with infinities.
#[inline]
pub(crate) fn pad(values: &mut Vec<f32>) {
    let padding = values.len().wrapping_neg() % LANES;
    values.extend(std::iter::repeat_n(f32::INFINITY, padding));
}

/// The number halfway between two by their bits: as many numbers lie on either side; `high` where none is left.
#[inline(always)]
fn between(low: f32, high: f32) -> f32 {
    if low < 0.0 {
        // Nothing is known to be below: all from zero on are left.
        return if high > 0.0 { f32::from_bits(high.to_bits() / 2) } else { high };
    }
    let half = low.to_bits() + (high.to_bits() - low.to_bits()) / 2;
    if half == low.to_bits() { high } else { f32::from_bits(half) }
}

/// The largest of the values up to `limit`, and how many those are.
#[inline(always)]
fn farthest_within(values: &[f32], limit: f32) -> (f32, usize) {
    let mut counts = [0u32; LANES];
    let mut largest = [0f32; LANES];
    for lanes in values.chunks_exact(LANES) {
        for (i, &value) in lanes.iter().enumerate() {
            let within = value <= limit;
            counts[i] += u32::from(within);
            let kept = if within { value } else { 0.0 };
            largest[i] = if kept > largest[i] { kept } else { largest[i] };
        }
    }
    let farthest = largest.into_iter().fold(0f32, |a, b| if b > a { b } else { a });
    (farthest, counts.into_iter().sum::<u32>() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kth_is_that_of_a_sort() {
        let hash = |i: u64| (i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as f32;
        let sets: [&dyn Fn(u64) -> f32; 7] = [
            &|i| hash(i) * 1e-3,
            &|i| hash(i) % 5.0,
            &|_| 0.0,
            &|_| 7.5,
            &|i| f32::from_bits((hash(i) as u32) % 7),
            &|i| if i < 3 { 3e38 } else { 1e-30 * hash(i) },
            &|i| if i % 2 == 0 { 0.0 } else { 1.0 + hash(i) },
        ];
        for set in sets {
            for count in [1u64, 2, 15, 16, 17, 100, 130, 500] {
                let mut values: Vec<f32> = (0..count).map(set).collect();
                let mut sorted = values.clone();
                pad(&mut values);
                sorted.sort_unstable_by(f32::total_cmp);
                for k in (1..=count as usize).filter(|k| *k < 20 || k % 7 == 0 || *k == count as usize) {
                    assert_eq!(kth_least(&values, -1.0, k), sorted[k - 1], "{k} of {count}");
                }
            }
        }
    }
}
