//! A stratified hemisphere: the directions that a record is made from, its irradiance, its harmonic mean distance and its
//! gradients (Ward and Heckbert, "Irradiance Gradients", Eurographics Workshop on Rendering 1992, section 3).

use super::record::IrradianceRecord;
use photinus_geometry::{Frame, Vec3};
use std::f32::consts::{PI, TAU};

/// M rings of equal cosine-weighted solid angle by N sectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hemisphere {
    /// M.
    pub rings: u32,
    /// N.
    pub sectors: u32,
}

/// What was seen along one of its directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HemisphereSample {
    /// Radiance that arrives, W per scene unit squared and sr.
    pub radiance: Vec3,
    /// How far away it comes from, scene units; infinite where there is nothing.
    pub distance: f32,
}

impl Hemisphere {
    /// About `rays` directions, N about pi M as the paper has it; at least two rings and three sectors.
    pub fn new(rays: u32) -> Self {
        let rings = ((rays as f32 / PI).sqrt().round() as u32).max(2);
        Self { rings, sectors: (rays / rings).max(3) }
    }

    /// How many directions there are.
    pub fn len(&self) -> u32 {
        self.rings * self.sectors
    }

    /// Never: there are directions.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Direction number `index` in the frame whose z is the normal; `u`, 0 to 1, is its place in its cell.
    pub fn direction(&self, index: u32, u: [f32; 2]) -> Vec3 {
        let (ring, sector) = (index / self.sectors, index % self.sectors);
        let sin_sq = ((ring as f32 + u[0]) / self.rings as f32).min(1.0);
        let (sin, cos) = libm::sincosf(TAU * (sector as f32 + u[1]) / self.sectors as f32);
        let r = sin_sq.sqrt();
        Vec3::new(r * cos, r * sin, (1.0 - sin_sq).max(0.0).sqrt())
    }

    /// The record of what was seen along the directions, `samples`, by their numbers; none where they are not as many. The
    /// harmonic mean distance is kept within `limits`, scene units; where that makes it longer, the change with place is made
    /// smaller by as much.
    pub fn record(
        &self,
        position: Vec3,
        frame: &Frame,
        samples: &[HemisphereSample],
        limits: [f32; 2],
    ) -> Option<IrradianceRecord> {
        if samples.len() != self.len() as usize {
            return None;
        }
        let (m, n) = (self.rings as usize, self.sectors as usize);
        let at = |j: usize, k: usize| &samples[j * n + k];
        let scale = PI / (m * n) as f32;
        let irradiance = samples.iter().map(|s| s.radiance).sum::<Vec3>() * scale;
        let inverse = samples.iter().map(|s| 1.0 / s.distance.max(1e-30)).sum::<f32>() / (m * n) as f32;
        let mean = if inverse > 0.0 { 1.0 / inverse } else { f32::INFINITY };
        let radius = mean.max(limits[0]).min(limits[1]);
        // Sine at the lower bound of a ring.
        let sine = |j: usize| (j as f32 / m as f32).sqrt();
        let along = |angle: f32| {
            let (sin, cos) = libm::sincosf(angle);
            frame.s * cos + frame.t * sin
        };
        let (mut rotation, mut translation) = ([Vec3::ZERO; 3], [Vec3::ZERO; 3]);
        let add = |sum: &mut [Vec3; 3], axis: Vec3, value: Vec3| {
            sum.iter_mut().zip(value.to_array()).for_each(|(sum, value)| *sum += axis * value);
        };
        for k in 0..n {
            let (middle, lower) = (TAU * (k as f32 + 0.5) / n as f32, TAU * k as f32 / n as f32);
            let before = (k + n - 1) % n;
            // Light of a sector counts for more as the normal turns towards it: around the axis at right angles to both.
            let mut turned = Vec3::ZERO;
            // The light of a ring's border moves out of the way ...
            let mut outward = Vec3::ZERO;
            // ... and so does that of a sector's.
            let mut sideward = Vec3::ZERO;
            for j in 0..m {
                let sin_sq = (j as f32 + 0.5) / m as f32;
                turned += at(j, k).radiance * (sin_sq / (1.0 - sin_sq)).sqrt();
                if j > 0 {
                    let (inner, outer) = (at(j - 1, k), at(j, k));
                    let cos_sq = 1.0 - sine(j) * sine(j);
                    let nearer = inner.distance.min(outer.distance).max(1e-30);
                    outward += (outer.radiance - inner.radiance) * (sine(j) * cos_sq / nearer);
                }
                let (left, right) = (at(j, before), at(j, k));
                let nearer = left.distance.min(right.distance).max(1e-30);
                sideward += (right.radiance - left.radiance) * ((sine(j + 1) - sine(j)) / nearer);
            }
            add(&mut rotation, along(middle + PI / 2.0), turned * scale);
            add(&mut translation, along(middle), outward * (TAU / n as f32));
            add(&mut translation, along(lower + PI / 2.0), sideward);
        }
        let shorter = if radius > mean { mean / radius } else { 1.0 };
        translation.iter_mut().for_each(|change| *change *= shorter);
        Some(IrradianceRecord { position, normal: frame.n, irradiance, radius, rotation, translation })
    }
}
