//! Split candidates from few samples: Hunt, Mark, Stoll, "Fast kd-tree Construction with an Adaptive Error-Bounded
//! Heuristic", RT 2006.
//!
//! The numbers of primitives below and above a plane are sampled at even steps, and again at as many places where their
//! difference, which only grows, should divide its range evenly. Between samples both numbers are taken as linear, so
//! that the cost is a parabola. Against the paper, which trusts the parabolas, the lowest point of each is counted too:
//! with sorted bounds that is cheap.

use arrayvec::ArrayVec;

/// In nodes of so many primitives every bound is as quickly counted.
pub const FEW: usize = 64;
/// Samples of each of both steps, as in the paper.
const SAMPLES: usize = 8;
/// Samples of both steps, and the ends of the cell.
const PLACES: usize = 2 * SAMPLES + 2;

/// A place along the axis, with how many primitives reach below it and above it.
#[derive(Clone, Copy, Debug)]
struct Sample {
    at: f64,
    below: f64,
    above: f64,
}

/// Hands out candidates between `low` and `high`, the ends of a cell that is `u` and `v` long along the other axes;
/// `count` says how many primitives reach below a plane, and above it.
pub fn candidates(
    [low, high]: [f32; 2],
    [u, v]: [f64; 2],
    count: impl Fn(f32) -> [usize; 2],
    mut consider: impl FnMut(f32, usize, usize),
) {
    let (start, end) = (f64::from(low), f64::from(high));
    let mut sample = |at: f64| {
        let position = at as f32;
        let [below, above] = count(position);
        consider(position, below, above);
        Sample { at: f64::from(position), below: below as f64, above: above as f64 }
    };
    let step = (end - start) / (SAMPLES + 1) as f64;
    let mut samples: ArrayVec<Sample, PLACES> = (0..SAMPLES + 2).map(|i| sample(start + step * i as f64)).collect();
    let even = samples.clone();
    let difference = |s: &Sample| s.below - s.above;
    let (first, last) = (difference(&even[0]), difference(&even[SAMPLES + 1]));
    for i in 1..=SAMPLES {
        let wanted = first + (last - first) * i as f64 / (SAMPLES + 1) as f64;
        let pair = even.windows(2).find(|pair| difference(&pair[1]) >= wanted);
        let Some([a, b]) = pair else { continue };
        let rise = difference(b) - difference(a);
        if rise > 0.0 {
            samples.push(sample(a.at + (b.at - a.at) * ((wanted - difference(a)) / rise).clamp(0.0, 1.0)));
        }
    }
    samples.sort_by(|a, b| a.at.total_cmp(&b.at));
    for pair in samples.windows(2) {
        if let Some(at) = lowest(&pair[0], &pair[1], [start, end], [u, v]) {
            sample(at);
        }
    }
}

/// Where the cost's parabola between two samples is lowest, if that is between them.
///
/// With n below and m above linear in x the cost is `(uv + (x - low)(u + v)) n + (uv + (high - x)(u + v)) m`.
fn lowest(a: &Sample, b: &Sample, [low, high]: [f64; 2], [u, v]: [f64; 2]) -> Option<f64> {
    let width = b.at - a.at;
    if !(width > 0.0) {
        return None;
    }
    let (n_slope, m_slope) = ((b.below - a.below) / width, (b.above - a.above) / width);
    let curve = (u + v) * (n_slope - m_slope);
    // The slope at `a`; it grows by twice the curve for every unit.
    let face = |length: f64| u * v + length * (u + v);
    let slope = (u + v) * (a.below - a.above) + face(a.at - low) * n_slope + face(high - a.at) * m_slope;
    let at = a.at - slope / (2.0 * curve);
    (curve > 0.0 && at > a.at && at < b.at).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One primitive at every thousandth: both numbers are linear, and the parabola is the cost itself.
    #[test]
    fn even_primitives_are_halved() {
        let mut best = (f64::INFINITY, 0.0);
        let mut tried = 0;
        let count = |p: f32| [(p * 1000.0) as usize, 1000 - (p * 1000.0) as usize];
        candidates([0.0, 1.0], [1.0, 1.0], count, |p, below, above| {
            tried += 1;
            let face = |length: f64| 1.0 + 2.0 * length;
            let cost = face(f64::from(p)) * below as f64 + face(1.0 - f64::from(p)) * above as f64;
            if cost < best.0 {
                best = (cost, p);
            }
        });
        assert!((best.1 - 0.5).abs() < 2e-3, "{best:?}");
        assert!(tried <= 2 * PLACES);
    }

    /// All primitives within a hundredth: even steps of a ninth never come near, the second samples do.
    #[test]
    fn crowds_are_found() {
        let mut nearest = f32::INFINITY;
        let count = |p: f32| {
            let below = ((p - 0.62) * 1e5).clamp(0.0, 1000.0) as usize;
            [below, 1000 - below]
        };
        candidates([0.0, 1.0], [1.0, 1.0], count, |p, _, _| nearest = nearest.min((p - 0.63).abs()));
        assert!(nearest < 0.03, "{nearest}");
    }

    #[test]
    fn senseless_cells_give_no_more_candidates() {
        for cell in [[1.0, 1.0], [f32::MIN, f32::MAX], [0.0, 1e-45]] {
            let mut tried = 0;
            candidates(cell, [0.0, f64::INFINITY], |_| [3, 3], |_, _, _| tried += 1);
            assert!(tried <= 2 * PLACES);
        }
    }
}
