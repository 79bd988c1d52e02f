//! How often rays visit a box: by its surface, and by its volume where they start inside the scene.
//!
//! The surface-area heuristic counts lines that cross the scene: they cross a box with the chance A / A0, the box's
//! surface over the scene's. A ray of a renderer starts at some point of its line. It visits the box if it starts
//! before it or in it: with the chance (1 + c / c0) / 2, the parts c and c0 of the line in the box and in the scene,
//! where all points are alike. Of convex bodies the mean of c is 4 V / A (Cauchy), so that both together are
//! (A / A0 + V / V0) / 2. Of the scene itself that is one; of a wall, which a line always crosses, half as much: a
//! wall apart costs the rays that reach it, and within the box of other things all that start in the room.
//! (After Fabianowski, Fowler, Dingliana, "A Cost Metric for Scene-Interior Ray Origins", Eurographics 2009, who
//! approximate the same chance for rays that start evenly in the scene's volume.)

use super::binary::scaled_half_area;
use photinus_geometry::Aabb;

/// The measure of a scene: visits in a unit that is the same for all boxes.
#[derive(Clone, Copy)]
pub struct Visits {
    /// Lengths are multiplied with it before areas are taken, so that no scene is too small or too large for them.
    pub scale: f32,
    /// Half the scene's surface over its volume; 0 where it has none.
    per_volume: f32,
}

impl Visits {
    /// Of a scene of these bounds.
    pub fn new(bounds: &Aabb) -> Self {
        let size = bounds.size().max_element();
        let scale = if size > 0.0 && size.is_finite() { (1.0 / size).min(f32::MAX) } else { 1.0 };
        let ratio = scaled_half_area(bounds, scale) / scaled_volume(bounds, scale);
        Self { scale, per_volume: if ratio.is_finite() { ratio } else { 0.0 } }
    }

    /// Of a box.
    #[inline]
    pub fn of(&self, b: &Aabb) -> f32 {
        scaled_half_area(b, self.scale) + self.per_volume * scaled_volume(b, self.scale)
    }
}

#[inline]
fn scaled_volume(b: &Aabb, scale: f32) -> f32 {
    let d = b.size() * scale;
    d.x * d.y * d.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    #[test]
    fn walls_are_visited_half_as_often_as_their_surface_says() {
        for size in [1e-30, 1.0, 1e30] {
            let scene = Aabb { min: Vec3::ZERO, max: Vec3::new(4.0, 4.0, 2.0) * size };
            let visits = Visits::new(&scene);
            let share = |min: [f32; 3], max: [f32; 3]| {
                let part = Aabb { min: Vec3::from(min) * size, max: Vec3::from(max) * size };
                visits.of(&part) / visits.of(&scene)
            };
            // The surface is 64, the volume 32.
            assert!((share([0.0; 3], [4.0, 4.0, 0.0]) - 0.5 * 32.0 / 64.0).abs() < 1e-5);
            assert!((share([0.0; 3], [2.0, 4.0, 2.0]) - 0.5 * (40.0 / 64.0 + 0.5)).abs() < 1e-5);
        }
    }

    #[test]
    fn scenes_without_volume_count_surfaces() {
        let flat = Aabb { min: Vec3::ZERO, max: Vec3::new(2.0, 1.0, 0.0) };
        assert_eq!(Visits::new(&flat).of(&flat), 0.5);
        let thin = Aabb { min: Vec3::ZERO, max: Vec3::new(1.0, 1.0, 1e-42) };
        assert!(Visits::new(&thin).of(&thin).is_finite());
        let endless = Aabb { min: Vec3::MIN, max: Vec3::MAX };
        assert!(!Visits::new(&endless).of(&flat).is_nan());
        assert!(!Visits::new(&Aabb::EMPTY).of(&flat).is_nan());
    }
}
