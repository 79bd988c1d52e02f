//! A triangle that shines, with all that its points have in common: photons start there by the million.

use super::area::uniform_triangle;
use crate::{SurfacePoint, world::World};
use photinus_geometry::Vec3;
use photinus_scene::ColorInput;

/// A point on a surface that shines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShiningPoint {
    pub position: Vec3,
    /// Unit face normal, outwards.
    pub normal: Vec3,
    /// How far off the surface rays start.
    offset: f32,
    /// Radiance to the outside.
    pub radiance: Vec3,
}

impl ShiningPoint {
    /// Where a ray along `dir` starts.
    pub fn ray_origin(&self, dir: Vec3) -> Vec3 {
        let step = self.normal * self.offset;
        self.position + if self.normal.dot(dir) >= 0.0 { step } else { -step }
    }

    /// A point whose surface has been made.
    pub fn of_surface(world: &World, point: &SurfacePoint) -> Self {
        Self {
            position: point.position,
            normal: point.geometric_normal,
            offset: point.offset,
            radiance: world.emitted(point, point.geometric_normal),
        }
    }

    /// Radiance that leaves towards `wo`.
    pub fn radiance_to(&self, wo: Vec3) -> Vec3 {
        if self.normal.dot(wo) > 0.0 { self.radiance } else { Vec3::ZERO }
    }
}

/// A triangle, cut into parts that light may be sampled from one by one.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    prim: u32,
    /// Parts along each edge; squared: all parts.
    pub cuts: u32,
    corner: Vec3,
    edges: [Vec3; 2],
    /// Unit face normal, outwards where `alike`.
    normal: Vec3,
    /// Area of the whole.
    area: f32,
    offset: f32,
    /// Radiance, where it is the same all over and all vertex normals agree on which side is out.
    alike: Option<Vec3>,
}

impl Panel {
    pub fn new(world: &World, prim: u32) -> Self {
        let [a, b, c] = world.primitives.triangle(prim as usize);
        let edges = [b - a, c - a];
        let cross = edges[0].cross(edges[1]);
        let face = cross.try_normalize().unwrap_or(Vec3::Z);
        let side = world.outer_side(prim);
        let radiance = match world.shapes[world.shape_of(prim)].emission {
            Some(ColorInput::Constant(radiance)) => Some(radiance),
            _ => None,
        };
        Self {
            prim,
            cuts: 1,
            corner: a,
            edges,
            normal: face * side.unwrap_or(1.0),
            area: 0.5 * cross.length(),
            offset: crate::facet::offset_on(a, edges),
            alike: radiance.filter(|_| side.is_some()),
        }
    }

    /// The longest edge.
    pub fn widest(&self) -> f32 {
        let [u, v] = self.edges;
        u.length().max((v - u).length()).max(v.length())
    }

    /// Unit normal on either side.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Area of the whole.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// Area of a part.
    pub fn part_area(&self) -> f32 {
        self.area / (self.cuts * self.cuts) as f32
    }

    /// The place at these barycentrics.
    pub fn place(&self, [alpha, beta]: [f32; 2]) -> Vec3 {
        self.corner + self.edges[0] * alpha + self.edges[1] * beta
    }

    /// The point at these barycentrics.
    #[inline]
    pub fn point(&self, world: &World, [alpha, beta]: [f32; 2]) -> ShiningPoint {
        match self.alike {
            Some(radiance) => {
                ShiningPoint { position: self.place([alpha, beta]), normal: self.normal, offset: self.offset, radiance }
            }
            None => ShiningPoint::of_surface(world, &world.triangle_point(self.prim, alpha, beta)),
        }
    }

    /// A point of a part from a point of the unit square, evenly by area.
    pub fn sample(&self, world: &World, part: u32, u: [f32; 2]) -> ShiningPoint {
        self.point(world, within_part(self.cuts, part, uniform_triangle(u)))
    }

    /// The part that a place on the triangle belongs to.
    pub fn part_of(&self, place: Vec3) -> u32 {
        if self.cuts == 1 {
            return 0;
        }
        let ([u, v], w) = (self.edges, place - self.corner);
        let normal = u.cross(v);
        let scale = 1.0 / normal.length_squared().max(f32::MIN_POSITIVE);
        part_at(self.cuts, [w.cross(v).dot(normal) * scale, u.cross(w).dot(normal) * scale])
    }
}

/// Barycentrics in a triangle of the point with barycentrics `at` in one of its parts. Row `i` of parts, counted along
/// the first barycentric, has `cuts - i` upright parts and between them `cuts - i - 1` that stand on their heads.
pub(super) fn within_part(cuts: u32, part: u32, at: [f32; 2]) -> [f32; 2] {
    if cuts == 1 {
        return at;
    }
    let (mut row, mut rest) = (0, part);
    while rest > 2 * (cuts - row - 1) {
        rest -= 2 * (cuts - row) - 1;
        row += 1;
    }
    let (i, j, n) = (row as f32, (rest / 2) as f32, cuts as f32);
    if rest % 2 == 0 { [(i + at[0]) / n, (j + at[1]) / n] } else { [(i + 1.0 - at[0]) / n, (j + 1.0 - at[1]) / n] }
}

/// The part that holds the point with these barycentrics, each clamped into the triangle.
fn part_at(cuts: u32, [alpha, beta]: [f32; 2]) -> u32 {
    let n = cuts as f32;
    let (x, y) = (alpha.clamp(0.0, 1.0) * n, beta.clamp(0.0, 1.0) * n);
    let i = (x as u32).min(cuts - 1);
    let j = (y as u32).min(cuts - 1 - i);
    let upside_down = (x - i as f32) + (y - j as f32) > 1.0 && j < cuts - 1 - i;
    i * (2 * cuts - i) + 2 * j + u32::from(upside_down)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::emitter::MOST_CUTS;

    #[test]
    fn parts_hold_their_points_and_fill_the_triangle() {
        for cuts in [1, 2, 3, 7, MOST_CUTS] {
            let mut sum = [0.0f64; 2];
            for part in 0..cuts * cuts {
                for at in [[0.3, 0.3], [0.02, 0.9], [0.9, 0.02], [0.02, 0.02]] {
                    let [alpha, beta] = within_part(cuts, part, at);
                    assert!(alpha >= 0.0 && beta >= 0.0 && alpha + beta <= 1.0, "{cuts} {part} {alpha} {beta}");
                    assert_eq!(part_at(cuts, [alpha, beta]), part, "{cuts} {alpha} {beta}");
                }
                let middle = within_part(cuts, part, [1.0 / 3.0; 2]);
                (0..2).for_each(|k| sum[k] += f64::from(middle[k]) / f64::from(cuts * cuts));
            }
            // Parts of equal area: their middles have the triangle's as their mean.
            assert!((sum[0] - 1.0 / 3.0).abs() < 1e-5 && (sum[1] - 1.0 / 3.0).abs() < 1e-5);
        }
        assert!(part_at(4, [1.0, 0.0]) < 16 && part_at(4, [0.0, 1.0]) < 16 && part_at(4, [0.7, 0.7]) < 16);
    }
}
