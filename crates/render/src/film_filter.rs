//! Reconstruction filters, in two ways.
//!
//! By importance sampling a sample's place in the film is drawn from the filter's magnitude, its weight carries the sign:
//! a pixel is the mean of its own samples and pixels stay independent (Ernst, Stamminger and Greiner, "Filter importance
//! sampling", RT 2006). By sharing, samples are spread evenly and count for all pixels whose filter they lie under (Pharr,
//! Jakob and Humphreys, "Physically Based Rendering", third edition, section 7.8): for as many samples the noise is
//! weaker, by the integral of the squared filter, 4/9 for the tent.

use photinus_scene::Filter;

const TABLE: usize = 1024;

/// A filter ready to be sampled; the two axes are separable.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Box,
    Tent { radius: f32 },
    Table { radius: f32, cumulative: Vec<f32>, negative: Vec<bool>, weight: f32 },
}

impl FilterSampler {
    /// Prepares `filter`.
    pub fn new(filter: Filter) -> Self {
        let kind = match filter {
            Filter::Box => Kind::Box,
            Filter::Tent { radius } => Kind::Tent { radius },
            Filter::Gaussian { stddev } => {
                let radius = 4.0 * stddev;
                let edge = libm::expf(-radius * radius / (2.0 * stddev * stddev));
                table(radius, |x| (libm::expf(-x * x / (2.0 * stddev * stddev)) - edge).max(0.0))
            }
            Filter::Mitchell { b, c } => table(2.0, |x| cubic(x, b, c)),
            Filter::CatmullRom => table(2.0, |x| cubic(x, 0.0, 0.5)),
            Filter::Lanczos { lobes } => {
                let radius = lobes.max(1) as f32;
                table(radius, |x| sinc(x) * sinc(x / radius))
            }
        };
        Self { kind }
    }

    /// The filter as shared samples need it. None for the box, where no pixel shares anything, and for filters with
    /// negative parts, whose sums of weights may vanish.
    pub fn shared(&self) -> Option<SharedFilter> {
        let (radius, table) = match &self.kind {
            Kind::Tent { radius } => {
                let weight = |i: usize| 1.0 - ((i as f32 + 0.5) * (2.0 / TABLE as f32) - 1.0).abs();
                (*radius, (0..TABLE).map(weight).collect())
            }
            Kind::Table { radius, cumulative, negative, .. } if !negative.contains(&true) => {
                let before = |i: usize| if i == 0 { 0.0 } else { cumulative[i - 1] };
                let weight = |i: usize| (cumulative[i] - before(i)) * (TABLE as f32 / 2.0);
                (*radius, (0..TABLE).map(weight).collect::<Vec<f32>>())
            }
            _ => return None,
        };
        // Own samples must count, and tiles reach no farther than their neighbours.
        (radius > 0.5 && radius < 8.0).then_some(SharedFilter { radius, reach: (radius + 0.5) as u32, table })
    }

    /// Offset from the pixel's middle in pixels, and the factor on the sample's radiance.
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        match &self.kind {
            Kind::Box => ([u[0] - 0.5, u[1] - 0.5], 1.0),
            Kind::Tent { radius } => (u.map(|v| radius * tent(v)), 1.0),
            Kind::Table { radius, cumulative, negative, weight } => {
                let axis = |v: f32| {
                    let i = cumulative.partition_point(|&c| c <= v).min(TABLE - 1);
                    let low = if i == 0 { 0.0 } else { cumulative[i - 1] };
                    let within = ((v - low) / (cumulative[i] - low).max(1e-12)).clamp(0.0, 1.0);
                    let x = (i as f32 + within) * (2.0 * radius / TABLE as f32) - radius;
                    (x, if negative[i] { -1.0 } else { 1.0 })
                };
                let ((x, sx), (y, sy)) = (axis(u[0]), axis(u[1]));
                ([x, y], sx * sy * weight * weight)
            }
        }
    }
}

/// A filter whose samples several pixels share.
#[derive(Clone, Debug)]
pub(crate) struct SharedFilter {
    radius: f32,
    /// How many pixels away a sample still counts.
    pub reach: u32,
    table: Vec<f32>,
}

impl SharedFilter {
    /// Most pixels along an axis that share a sample.
    pub const MOST: usize = 17;

    /// Weights along one axis of a sample `offset` from the middle of its pixel (-0.5..0.5) for the pixels from `reach`
    /// before its own to `reach` behind; the others are zero.
    pub fn weights(&self, offset: f32) -> [f32; Self::MOST] {
        let mut weights = [0.0; Self::MOST];
        for (k, weight) in weights.iter_mut().enumerate().take(2 * self.reach as usize + 1) {
            let x = offset - (k as f32 - self.reach as f32);
            let slot = (x / self.radius + 1.0) * (0.5 * TABLE as f32);
            if x.abs() < self.radius {
                *weight = self.table[(slot as usize).min(TABLE - 1)];
            }
        }
        weights
    }
}

/// Inverse of the tent's distribution over -1..1.
fn tent(u: f32) -> f32 {
    if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 * (1.0 - u)).sqrt() }
}

fn table(radius: f32, f: impl Fn(f32) -> f32) -> Kind {
    let values: Vec<f64> =
        (0..TABLE).map(|i| f64::from(f((i as f32 + 0.5) * (2.0 * radius / TABLE as f32) - radius))).collect();
    let magnitude: f64 = values.iter().map(|v| v.abs()).sum();
    let signed: f64 = values.iter().sum();
    let mut sum = 0.0;
    let cumulative = values
        .iter()
        .map(|v| {
            sum += v.abs();
            (sum / magnitude) as f32
        })
        .collect();
    Kind::Table {
        radius,
        cumulative,
        negative: values.iter().map(|&v| v < 0.0).collect(),
        weight: (magnitude / signed) as f32,
    }
}

/// Mitchell and Netravali's family of cubics (SIGGRAPH 1988, equation 8).
fn cubic(x: f32, b: f32, c: f32) -> f32 {
    let x = x.abs();
    let (x2, x3) = (x * x, x * x * x);
    let y = if x < 1.0 {
        (12.0 - 9.0 * b - 6.0 * c) * x3 + (-18.0 + 12.0 * b + 6.0 * c) * x2 + (6.0 - 2.0 * b)
    } else if x < 2.0 {
        (-b - 6.0 * c) * x3 + (6.0 * b + 30.0 * c) * x2 + (-12.0 * b - 48.0 * c) * x + (8.0 * b + 24.0 * c)
    } else {
        0.0
    };
    y / 6.0
}

fn sinc(x: f32) -> f32 {
    let y = std::f32::consts::PI * x;
    if y.abs() < 1e-4 { 1.0 } else { libm::sinf(y) / y }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spread over a row of pixels, shared samples weigh as the filter says: the weights of a fine row of samples for the
    /// middle pixel against the filter itself.
    #[test]
    fn shared_samples_weigh_as_the_filter_says() {
        type Shape = (Filter, f32, fn(f32) -> f32);
        let shapes: [Shape; 2] = [
            (Filter::Tent { radius: 1.0 }, 1.0, |x| 1.0 - x.abs()),
            (Filter::Gaussian { stddev: 0.5 }, 2.0, |x| libm::expf(-2.0 * x * x) - libm::expf(-8.0)),
        ];
        for (filter, radius, f) in shapes {
            let shared = FilterSampler::new(filter).shared().expect("nowhere negative");
            assert!(2 * (shared.reach as usize) < SharedFilter::MOST);
            let ratio = shared.weights(0.0)[shared.reach as usize] / f(0.0);
            for i in 0..4000 {
                let x = 3.0 * (i as f32 / 2000.0 - 1.0) + 1e-4;
                let pixel = (x + 0.5).floor();
                let weights = shared.weights(x - pixel);
                let k = shared.reach as f32 - pixel;
                let weight = if (0.0..SharedFilter::MOST as f32).contains(&k) { weights[k as usize] } else { 0.0 };
                if x.abs() < radius {
                    // Steps of the table are 1/512 of the radius.
                    assert!((weight / ratio - f(x)).abs() < 0.01, "{filter:?} at {x}: {weight}");
                } else if x.abs() > radius {
                    assert_eq!(weight, 0.0, "{filter:?} at {x}");
                }
            }
        }
        for filter in [Filter::Box, Filter::CatmullRom, Filter::Lanczos { lobes: 3 }] {
            assert!(FilterSampler::new(filter).shared().is_none());
        }
    }

    /// Mean of g(x) under the sampled filter against the integral of filter * g over the filter's integral.
    #[test]
    fn samples_reproduce_the_filter() {
        type Shape = (Filter, f32, fn(f32) -> f32);
        let shapes: [Shape; 6] = [
            (Filter::Box, 0.5, |_| 1.0),
            (Filter::Tent { radius: 1.0 }, 1.0, |x| 1.0 - x.abs()),
            (Filter::Gaussian { stddev: 0.5 }, 2.0, |x| libm::expf(-2.0 * x * x) - libm::expf(-8.0)),
            (Filter::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 }, 2.0, |x| cubic(x, 1.0 / 3.0, 1.0 / 3.0)),
            (Filter::CatmullRom, 2.0, |x| cubic(x, 0.0, 0.5)),
            (Filter::Lanczos { lobes: 3 }, 3.0, |x| sinc(x) * sinc(x / 3.0)),
        ];
        for (filter, radius, f) in shapes {
            let sampler = FilterSampler::new(filter);
            let g = |x: f32| f64::from((1.0 + 0.3 * x) * (1.0 + 0.3 * x));
            let n = 1536;
            let mut mean = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let ([x, y], w) = sampler.sample([(i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32]);
                    mean += f64::from(w) * g(x) * g(y) / f64::from(n * n);
                }
            }
            let (mut top, mut bottom) = (0.0, 0.0);
            for i in 0..20_000 {
                let x = radius * ((i as f32 + 0.5) / 10_000.0 - 1.0);
                top += f64::from(f(x)) * g(x);
                bottom += f64::from(f(x));
            }
            let expected = (top / bottom) * (top / bottom);
            assert!((mean / expected - 1.0).abs() < 5e-3, "{filter:?}: {mean} {expected}");
        }
    }
}
