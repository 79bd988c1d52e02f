//! Where photons start, as a point of the unit cube: what aims photons moves such points and knows no kind of light.

use photinus_num::Sampler;

/// Random numbers that start a photon, uniform over the unit cube where nothing aims it: the primary sample space of
/// Kelemen et al., "A Simple and Robust Mutation Strategy for the Metropolis Light Transport Algorithm", CGF 21(3),
/// 2002, section 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EmissionPoint(pub [f32; EmissionPoint::AXES]);

impl EmissionPoint {
    /// Place on the light (2), direction (2), choice of the light, choice of the disc for light from infinity.
    pub const AXES: usize = 6;

    /// The first numbers of a photon.
    pub fn draw(sampler: &mut Sampler) -> Self {
        let ([x, y], [u, v]) = (sampler.next_2d(), sampler.next_2d());
        Self([x, y, u, v, sampler.next_1d(), sampler.next_1d()])
    }

    pub fn place(&self) -> [f32; 2] {
        [self.0[0], self.0[1]]
    }

    pub fn direction(&self) -> [f32; 2] {
        [self.0[2], self.0[3]]
    }

    pub fn light(&self) -> f32 {
        self.0[4]
    }

    pub fn disc(&self) -> f32 {
        self.0[5]
    }
}

/// The choice of a light by inversion: neighbours in the scene stay neighbours along the axis, which an alias table would
/// scatter.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightChoice {
    /// Sum of the shares up to and with each light; the last with a share holds 1.
    cumulative: Vec<f64>,
}

impl LightChoice {
    /// In proportion to `powers`, each finite and at least 0; all zero: each light alike.
    pub fn new(powers: &[f64]) -> Self {
        let sum: f64 = powers.iter().sum();
        let mut before = 0.0;
        let share = |p: f64| if sum > 0.0 { p / sum } else { 1.0 / powers.len() as f64 };
        let mut cumulative: Vec<f64> = powers
            .iter()
            .map(|&p| {
                before += share(p);
                before
            })
            .collect();
        // Rounding must leave no gap at the end, nor choose a dark light there.
        let last = powers.iter().rposition(|&p| p > 0.0).unwrap_or(powers.len().saturating_sub(1));
        cumulative[last..].fill(1.0);
        Self { cumulative }
    }

    /// The light at `u`, its probability, and what is left of `u` as a fresh number in 0..1; none without lights.
    pub fn at(&self, u: f32) -> Option<(usize, f32, f32)> {
        let u = f64::from(u);
        let index = self.cumulative.partition_point(|&c| c <= u).min(self.cumulative.len().checked_sub(1)?);
        let before = if index == 0 { 0.0 } else { self.cumulative[index - 1] };
        let share = self.cumulative[index] - before;
        let rest = ((u - before) / share) as f32;
        (share > 0.0).then_some((index, share as f32, rest.clamp(0.0, 0.999_999_94)))
    }

    /// Probability of a light; 0 where there is no such one.
    pub fn share(&self, index: usize) -> f32 {
        (self.cumulative.get(index).copied().unwrap_or(0.0) - self.before(index)) as f32
    }

    /// Probability that a light is `first` or behind it.
    pub fn share_from(&self, first: usize) -> f32 {
        (1.0 - self.before(first)) as f32
    }

    /// What is left of `u`, which chose a light from `first` on, as a fresh number in 0..1.
    pub fn within(&self, first: usize, u: f32) -> f32 {
        let before = self.before(first);
        (((f64::from(u) - before) / (1.0 - before)) as f32).clamp(0.0, 0.999_999_94)
    }

    pub fn bytes(&self) -> usize {
        self.cumulative.len() * size_of::<f64>()
    }

    fn before(&self, index: usize) -> f64 {
        if index == 0 { 0.0 } else { self.cumulative.get(index - 1).copied().unwrap_or(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_are_chosen_by_their_powers() {
        let powers = [0.0, 1.0, 2.5, 0.001, 10.0, 0.0, 3.0, 0.0];
        let choice = LightChoice::new(&powers);
        let n = 1_000_000;
        let (mut counts, mut rests) = ([0u32; 8], [0.0f64; 8]);
        for i in 0..n {
            let (light, probability, rest) = choice.at((i as f32 + 0.5) / n as f32).expect("there are lights");
            assert!((f64::from(probability) - powers[light] / 16.501).abs() < 1e-6);
            assert!((0.0..1.0).contains(&rest));
            counts[light] += 1;
            rests[light] += f64::from(rest);
        }
        for (i, power) in powers.iter().enumerate() {
            assert!((f64::from(counts[i]) / f64::from(n) - power / 16.501).abs() < 1e-5, "light {i}: {}", counts[i]);
            assert!(counts[i] < 1000 || (rests[i] / f64::from(counts[i]) - 0.5).abs() < 0.01);
        }
        assert_eq!(choice.at(0.999_999_94).expect("there are lights").0, 6);
        assert!(LightChoice::new(&[]).at(0.5).is_none());
        assert_eq!(LightChoice::new(&[0.0, 0.0]).at(0.75).map(|c| (c.0, c.1)), Some((1, 0.5)));
    }
}
