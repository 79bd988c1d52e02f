//! Bounds of primitives, padded so that box tests lose no hit.
//!
//! The ray-triangle test rounds: it hits triangles whose vertices lie where the true ones are up to a relative 6
//! roundings (6 x 2^-24) of their distance to the ray's start, per axis, plus as much of the distance along the ray's
//! dominant axis (two subtractions, a quotient, a product). Split into the distance of the hit and the extent of the
//! triangle around it, the first part is relative to the ray parameter and is covered by widening the slabs' parameters
//! by [`SLAB_SLACK`]; the second is relative to the triangle's size and is covered here, by [`pad`]. Together: a box
//! test with padded boxes and widened slabs never misses what `woop` hits (after Ize, "Robust BVH Ray Traversal",
//! JCGT 2(2), 2013, whose padding covers the slabs' own rounding).

use photinus_geometry::{Aabb, Primitives, Vec3};
use photinus_intersect::is_degenerate;

/// Relative widening of a slab's entry and exit parameters: 16 roundings, of which 9 are needed.
pub const SLAB_SLACK: f32 = 1.0 / (1 << 20) as f32;

/// Grows `b` by 16 roundings of its extents (6 are needed) and by one unit in the last place outward, which also
/// keeps flat boxes from being empty. The result is finite where `b` is.
pub fn pad(b: Aabb) -> Aabb {
    let size = b.max - b.min;
    let pad = Vec3::splat((size.x + size.y + size.z) * SLAB_SLACK);
    let down = |v: Vec3| Vec3::new(v.x.next_down(), v.y.next_down(), v.z.next_down());
    let up = |v: Vec3| Vec3::new(v.x.next_up(), v.y.next_up(), v.z.next_up());
    Aabb { min: down(b.min - pad).max(Vec3::MIN), max: up(b.max + pad).min(Vec3::MAX) }
}

/// Edge lengths of `b` in doubles, which no scene's areas leave; zero for the empty box.
pub(crate) fn size_f64(b: &Aabb) -> [f64; 3] {
    std::array::from_fn(|k| (f64::from(b.max[k]) - f64::from(b.min[k])).max(0.0))
}

/// Half the surface area of a box of these edge lengths.
pub(crate) fn half_area_f64([x, y, z]: [f64; 3]) -> f64 {
    x * y + y * z + z * x
}

/// The padded bounds of primitive `id`; `None` where no ray can hit it (no area, no radius, not finite).
pub fn padded_bounds(primitives: &Primitives, id: usize) -> Option<Aabb> {
    let (is_hittable, bounds) = match id.checked_sub(primitives.triangle_count()) {
        None => {
            let triangle = primitives.triangle(id);
            (!is_degenerate(&triangle.map(|v| v.to_array())), Aabb::around(triangle))
        }
        Some(j) => {
            let s = &primitives.spheres[j];
            (s.radius > 0.0 && s.radius.is_finite() && s.center.is_finite(), primitives.bounds_of(id))
        }
    };
    is_hittable.then(|| pad(bounds))
}
