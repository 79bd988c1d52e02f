//! The photons that a scan finds, and the nearest among them.

use crate::Neighbor;

/// Candidates beyond k that are collected before the farthest are dropped.
const SURPLUS: usize = 192;

/// Photons as keys of distance and id, cut down to the nearest k whenever they get many.
#[derive(Debug)]
pub(crate) struct Candidates {
    keys: Vec<u64>,
    len: usize,
    k: usize,
}

impl Candidates {
    /// None yet, of which the `k` nearest are to be kept.
    pub(crate) fn new(k: usize) -> Self {
        Self { keys: vec![0; 256], len: 0, k }
    }

    /// Starts again.
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// Room for `count` keys behind those held.
    #[inline]
    pub(crate) fn free(&mut self, count: usize) -> &mut [u64] {
        if self.keys.len() < self.len + count {
            self.keys.resize((self.len + count).max(2 * self.keys.len()), 0);
        }
        &mut self.keys[self.len..]
    }

    /// Keeps `count` keys that were written to [`Candidates::free`]; returns the squared distance beyond which nothing
    /// more can be among the nearest, when that is news.
    #[inline]
    pub(crate) fn push(&mut self, count: usize) -> Option<f32> {
        self.len += count;
        (self.len >= self.k.saturating_add(SURPLUS)).then(|| self.cut())
    }

    /// Drops all but the nearest k; returns the squared distance of the farthest left.
    fn cut(&mut self) -> f32 {
        let (_, farthest, _) = self.keys[..self.len].select_nth_unstable(self.k - 1);
        let farthest = distance_sq(*farthest);
        self.len = self.k;
        farthest
    }

    /// Photons held.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// The nearest k in order.
    pub(crate) fn finish(mut self, found: &mut Vec<Neighbor>) {
        if self.len > self.k {
            self.cut();
        }
        self.keys[..self.len].sort_unstable();
        self.take_all(found);
    }

    /// All that were collected, in no order.
    pub(crate) fn take_all(&self, found: &mut Vec<Neighbor>) {
        found.clear();
        let neighbor = |key: &u64| Neighbor { distance_sq: distance_sq(*key), photon: *key as u32 };
        found.extend(self.keys[..self.len].iter().map(neighbor));
    }
}

/// A key: distances are not negative, so that their bits sort as they do.
#[inline]
pub(crate) fn key(distance_sq: f32, id: u32) -> u64 {
    u64::from(distance_sq.to_bits()) << 32 | u64::from(id)
}

#[inline]
fn distance_sq(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_come_in_order_from_any_distances() {
        let hash = |i: u64| i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
        let even = |i: u64| hash(i) as f32 * 1e-3;
        let clustered = |i: u64| if i < 3 { 1e30 } else { (hash(i) % 7) as f32 };
        let far = |i: u64| if i.is_multiple_of(2) { f32::INFINITY } else { hash(i) as f32 };
        let tiny = |i: u64| f32::from_bits((hash(i) % 5) as u32);
        for distance in [&even as &dyn Fn(u64) -> f32, &clustered, &far, &tiny, &|_| 0.0, &|_| 7.5] {
            for count in [0, 1, 2, 40, 100, 511, 513, 2000] {
                let mut keys: Vec<u64> = (0..count).map(|i| key(distance(i), hash(i ^ 0x55) as u32)).collect();
                for k in [1, 2, 39, 50, 300, usize::MAX] {
                    let mut candidates = Candidates::new(k);
                    for &key in &keys {
                        candidates.free(1)[0] = key;
                        candidates.push(1);
                    }
                    let mut found = Vec::new();
                    candidates.finish(&mut found);
                    let found: Vec<u64> = found.iter().map(|n| key(n.distance_sq, n.photon)).collect();
                    keys.sort_unstable();
                    assert_eq!(found, &keys[..k.min(keys.len())], "{k} of {count}");
                    // Another order for the next.
                    keys.sort_unstable_by_key(|key| key.wrapping_mul(0x9E37_79B9_7F4A_7C15));
                }
            }
        }
    }
}
