//! A record of the irradiance cache: what is known at a point, and how far it holds.
//!
//! Ward, Rubinstein and Clear, "A Ray Tracing Solution for Diffuse Interreflection", SIGGRAPH 1988; gradients after Ward and
//! Heckbert, "Irradiance Gradients", Eurographics Workshop on Rendering 1992.

use photinus_geometry::Vec3;

/// Least denominator of a weight: at the record's own place it would be infinite.
const LEAST_ERROR: f32 = 1e-6;
/// A point may lie behind a record by this part of its radius, for rounding.
const BEHIND: f32 = 0.01;

/// Irradiance at a point, with the distances that say how far it holds and its change with place and direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrradianceRecord {
    /// Where, scene units.
    pub position: Vec3,
    /// Unit normal of the side that is lit.
    pub normal: Vec3,
    /// W per scene unit squared, RGB.
    pub irradiance: Vec3,
    /// Harmonic mean R of the distances to what is seen from there, between the caller's bounds; scene units, above 0.
    pub radius: f32,
    /// Change of each channel with a turn of the normal: around the axis by the angle that the vector's direction and length
    /// say.
    pub rotation: [Vec3; 3],
    /// Change of each channel with place, per scene unit.
    pub translation: [Vec3; 3],
}

impl IrradianceRecord {
    /// Whether all numbers are finite and the radius is above 0.
    pub(super) fn is_valid(&self) -> bool {
        let vectors = [self.position, self.normal, self.irradiance];
        let all = vectors.iter().chain(&self.rotation).chain(&self.translation);
        all.into_iter().all(|v| v.is_finite()) && self.radius > 0.0 && self.radius.is_finite()
    }

    /// The inverse of the record's weight at a point with a unit normal: |x - x_i| / R_i + sqrt(1 - n . n_i) (Ward 1988,
    /// equation 3); none where the point lies behind the record, by the mean of both normals (there, section "Averaging").
    #[inline]
    pub fn error(&self, position: Vec3, normal: Vec3) -> Option<f32> {
        let away = position - self.position;
        // Half the sum of the normals, as there.
        let ahead = away.dot(normal + self.normal) * 0.5;
        if ahead < -BEHIND * self.radius {
            return None;
        }
        let turned = (1.0 - normal.dot(self.normal)).max(0.0);
        Some((away.length() / self.radius + turned.sqrt()).max(LEAST_ERROR))
    }

    /// The irradiance that the record and its gradients predict for a point with a unit normal; never negative (Ward and
    /// Heckbert 1992, equation 6).
    #[inline]
    pub fn predicted(&self, position: Vec3, normal: Vec3) -> Vec3 {
        let (away, turn) = (position - self.position, self.normal.cross(normal));
        let change = |channel: usize| turn.dot(self.rotation[channel]) + away.dot(self.translation[channel]);
        (self.irradiance + Vec3::new(change(0), change(1), change(2))).max(Vec3::ZERO)
    }
}
