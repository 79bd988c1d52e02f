//! The mixer of SplitMix64: 64 bits that look random for every 64 bits given (Steele, Lea and Flood, "Fast splittable
//! pseudorandom number generators", OOPSLA 2014, section 2.2, with the constants of Stafford's variant 13 that its Figure 17
//! uses).

/// Step between the states of one sequence: 2^64 over the golden ratio, odd.
pub const GAMMA: u64 = 0x9E37_79B9_7F4A_7C15;

/// Mixes `state`; a one-to-one map. Word `i` of the sequence that starts at `s` is `mix64(s + i * GAMMA)`, `i` from 1.
#[inline]
pub fn mix64(state: u64) -> u64 {
    let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::{GAMMA, mix64};

    /// The first numbers of java.util.SplittableRandom's sequence for seeds 0 and 1234567, as published with ports of it.
    #[test]
    fn known_answers() {
        let word = |seed: u64, i: u64| mix64(seed.wrapping_add(GAMMA.wrapping_mul(i)));
        assert_eq!(
            [1, 2, 3].map(|i| word(0, i)),
            [0xE220_A839_7B1D_CDAF, 0x6E78_9E6A_A1B9_65F4, 0x06C4_5D18_8009_454F]
        );
        assert_eq!(word(1_234_567, 1), 6_457_827_717_110_365_317);
        assert_eq!(word(1_234_567, 2), 3_203_168_211_198_807_973);
    }

    /// A flipped bit of the state flips each bit of the result half of the time: over 10 000 states the share of each of
    /// the 4096 pairs has a standard error of 0.005; six of them give a false alarm in 10^5 runs.
    #[test]
    fn every_bit_matters_to_every_bit() {
        let mut flips = vec![[0u32; 64]; 64];
        for i in 0..10_000u64 {
            let state = i.wrapping_mul(GAMMA);
            for (bit, flips) in flips.iter_mut().enumerate() {
                let change = mix64(state) ^ mix64(state ^ 1 << bit);
                flips.iter_mut().enumerate().for_each(|(out, count)| *count += (change >> out & 1) as u32);
            }
        }
        for (bit, flips) in flips.iter().enumerate() {
            for (out, &count) in flips.iter().enumerate() {
                assert!((f64::from(count) / 1e4 - 0.5).abs() < 0.03, "{bit} to {out}: {count}");
            }
        }
    }
}
