//! Sampling an index in proportion to weights (Vose 1991, the alias method).

/// A discrete distribution.
#[derive(Clone, Debug, Default)]
pub(crate) struct AliasTable {
    /// Probability of keeping the column, the other index, and the index's own probability.
    columns: Vec<(f32, u32, f32)>,
}

impl AliasTable {
    /// In proportion to `weights`, each finite and at least 0; all zero: every index alike.
    pub fn new(weights: &[f64]) -> Self {
        let n = weights.len();
        let sum: f64 = weights.iter().sum();
        let probability = |w: f64| if sum > 0.0 { w / sum } else { 1.0 / n as f64 };
        let mut scaled: Vec<f64> = weights.iter().map(|&w| probability(w) * n as f64).collect();
        let mut columns: Vec<(f32, u32, f32)> =
            weights.iter().enumerate().map(|(i, &w)| (1.0, i as u32, probability(w) as f32)).collect();
        let mut small: Vec<usize> = (0..n).filter(|&i| scaled[i] < 1.0).collect();
        let mut large: Vec<usize> = (0..n).filter(|&i| scaled[i] >= 1.0).collect();
        while let (Some(s), Some(&l)) = (small.pop(), large.last()) {
            (columns[s].0, columns[s].1) = (scaled[s] as f32, l as u32);
            scaled[l] -= 1.0 - scaled[s];
            if scaled[l] < 1.0 {
                large.pop();
                small.push(l);
            }
        }
        Self { columns }
    }

    /// Whether there is nothing to choose.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// Number of indices.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// An index, its probability, and what is left of `u` as a fresh number in 0..1.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        let n = self.columns.len();
        let x = u * n as f32;
        let i = (x as usize).min(n - 1);
        let rest = (x - i as f32).clamp(0.0, 0.999_999_94);
        let (keep, other, probability) = self.columns[i];
        if rest < keep {
            (i, probability, (rest / keep).min(0.999_999_94))
        } else {
            let other = other as usize;
            (other, self.columns[other].2, ((rest - keep) / (1.0 - keep)).clamp(0.0, 0.999_999_94))
        }
    }

    /// Probability of index `i`.
    #[inline]
    pub fn probability(&self, i: usize) -> f32 {
        self.columns[i].2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_are_the_weights_and_the_rest_is_uniform() {
        let weights = [0.0, 1.0, 2.5, 0.001, 10.0, 0.0, 3.0];
        let table = AliasTable::new(&weights);
        let n = 1_000_000;
        let mut counts = [0u32; 7];
        let mut rest_sum = [0.0f64; 7];
        for i in 0..n {
            let (j, p, rest) = table.sample((i as f32 + 0.5) / n as f32);
            assert!((0.0..1.0).contains(&rest));
            assert_eq!(p, table.probability(j));
            counts[j] += 1;
            rest_sum[j] += f64::from(rest);
        }
        for (j, &w) in weights.iter().enumerate() {
            let share = f64::from(counts[j]) / f64::from(n);
            assert!((share - w / 16.501).abs() < 1e-3, "{j}: {share}");
            if counts[j] > 1000 {
                assert!((rest_sum[j] / f64::from(counts[j]) - 0.5).abs() < 0.02);
            }
        }
    }
}
