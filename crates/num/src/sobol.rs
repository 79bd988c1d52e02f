//! Owen-scrambled Sobol points in four dimensions (Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020).

/// Direction words of the first four Sobol dimensions, combined a byte of the index at a time, all bits of words and index
/// in reverse: entry `[b][v]` is the exclusive or of the direction words of the bits set in byte `b`, of value `v`, of the
/// reversed index; one word a dimension.
static TABLE: [[[u32; 4]; 256]; 4] = table();

/// Direction words of dimension `d` (Joe and Kuo 2008: degree, polynomial and first numbers).
const fn directions(d: usize) -> [u32; 32] {
    let mut v = [0u32; 32];
    if d == 0 {
        let mut i = 0;
        while i < 32 {
            v[i] = 1 << (31 - i);
            i += 1;
        }
        return v;
    }
    let (degree, polynomial, first): (usize, u32, [u32; 3]) =
        [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])][d - 1];
    let mut i = 0;
    while i < 32 {
        if i < degree {
            v[i] = first[i] << (31 - i);
        } else {
            let mut x = v[i - degree] ^ (v[i - degree] >> degree);
            let mut k = 1;
            while k < degree {
                if (polynomial >> (degree - 1 - k)) & 1 == 1 {
                    x ^= v[i - k];
                }
                k += 1;
            }
            v[i] = x;
        }
        i += 1;
    }
    v
}

const fn table() -> [[[u32; 4]; 256]; 4] {
    let mut out = [[[0u32; 4]; 256]; 4];
    let mut d = 0;
    while d < 4 {
        let v = directions(d);
        let mut byte = 0;
        while byte < 4 {
            let mut value = 0;
            while value < 256 {
                let mut x = 0;
                let mut bit = 0;
                while bit < 8 {
                    if (value >> bit) & 1 == 1 {
                        x ^= v[31 - (8 * byte + bit)].reverse_bits();
                    }
                    bit += 1;
                }
                out[byte][value][d] = x;
                value += 1;
            }
            byte += 1;
        }
        d += 1;
    }
    out
}

/// The point of the four-dimensional Sobol sequence whose index has the bits of `index` in reverse, itself reversed.
#[inline]
fn sobol4_reversed(index: u32) -> [u32; 4] {
    let [a, b, c, d] = index.to_le_bytes();
    let (a, b, c, d) = (&TABLE[0][a as usize], &TABLE[1][b as usize], &TABLE[2][c as usize], &TABLE[3][d as usize]);
    std::array::from_fn(|i| a[i] ^ b[i] ^ c[i] ^ d[i])
}

/// Nested uniform scrambles of bit-reversed words: each bit is flipped by a hash of the bits below it (the constants of
/// Burley's section 4, after Laine and Karras 2011). Step by step over all words, which makes one vector of them.
#[inline]
fn scramble_reversed<const N: usize>(mut x: [u32; N], seeds: [u32; N]) -> [u32; N] {
    x = std::array::from_fn(|d| x[d].wrapping_add(seeds[d]));
    for factor in [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6u32] {
        x = std::array::from_fn(|d| x[d] ^ x[d].wrapping_mul(factor));
    }
    x
}

/// A point of an independently shuffled and Owen-scrambled sequence for each choice of `shuffle` and `seeds`, as 32-bit
/// fractions. `reversed_index` has the bits of the point's index in reverse.
#[inline]
pub(crate) fn sobol_owen4(reversed_index: u32, shuffle: u32, seeds: [u32; 4]) -> [u32; 4] {
    let [index] = scramble_reversed([reversed_index], [shuffle]);
    scramble_reversed(sobol4_reversed(index), seeds).map(u32::reverse_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A (0,2)-sequence puts one point in every elementary interval; scrambling keeps that.
    #[test]
    fn pairs_of_dimensions_are_stratified() {
        for (seed, first) in [(0u32, 0u32), (7, 0), (7, 64), (99, 128)] {
            let points: Vec<[u32; 4]> = (first..first + 64)
                .map(|i| {
                    let seeds = [seed, seed ^ 1, seed ^ 2, seed ^ 3].map(|s| s.wrapping_mul(0x9E37_79B9));
                    sobol_owen4(i.reverse_bits(), seed, seeds)
                })
                .collect();
            for log_x in 0..=6 {
                let mut seen = [false; 64];
                for p in &points {
                    let x = if log_x == 0 { 0 } else { p[0] >> (32 - log_x) };
                    let log_y = 6 - log_x;
                    let y = if log_y == 0 { 0 } else { p[1] >> (32 - log_y) };
                    let cell = ((x << log_y) | y) as usize;
                    assert!(!seen[cell], "two points in one interval: seed {seed}, 2^{log_x} columns");
                    seen[cell] = true;
                }
            }
            for d in 0..4 {
                let mut seen = [false; 64];
                for p in &points {
                    seen[(p[d] >> 26) as usize] = true;
                }
                assert!(seen.iter().all(|&s| s), "dimension {d} is not stratified");
            }
        }
    }
}
