//! Scenes and rays for the tests of the family, all seeded.

use photinus_geometry::{Primitives, Ray, Sphere, Vec3};
use photinus_num::{Sampler, StreamKind};

/// Random numbers of one test.
pub struct Random {
    seed: u64,
    index: u32,
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Self { seed, index: 0 }
    }

    /// Three numbers in [-1, 1).
    pub fn vec3(&mut self) -> Vec3 {
        self.index += 1;
        let mut s = Sampler::new(self.seed, StreamKind::Test, 0, self.index);
        Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - Vec3::ONE
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.vec3().x * 0.5 + 0.5
    }
}

/// A named set of primitives with rays worth tracing through it.
pub struct Scene {
    pub name: String,
    pub primitives: Primitives,
    pub rays: Vec<Ray>,
}

/// Triangles that share no vertices.
pub fn soup(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Primitives {
    let positions: Vec<Vec3> = triangles.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Primitives { positions, triangles, spheres: Vec::new() }
}

/// Rays from around the scene to points of it, some with intervals.
pub fn random_rays(random: &mut Random, count: usize, center: Vec3, size: f32) -> Vec<Ray> {
    (0..count)
        .map(|i| {
            let origin = center + random.vec3() * size * 1.5;
            let target = center + random.vec3() * size;
            let mut ray = Ray::new(origin, target - origin);
            match i % 8 {
                1 => ray.t_max = 1.0,
                2 => (ray.t_min, ray.t_max) = (0.3, 0.9),
                3 => ray.dir /= size * 100.0,
                4 => ray.t_min = -2.0,
                _ => {}
            }
            ray
        })
        .collect()
}

/// Small random triangles in a cube.
pub fn random_soup(seed: u64, count: usize, center: Vec3, size: f32, triangle: f32) -> Scene {
    let mut random = Random::new(seed);
    let triangles: Vec<_> = (0..count)
        .map(|_| {
            let p = center + random.vec3() * size;
            [p, p + random.vec3() * size * triangle, p + random.vec3() * size * triangle]
        })
        .collect();
    let rays = random_rays(&mut random, 400, center, size);
    Scene { name: format!("soup of {count} at {center}, size {size}"), primitives: soup(triangles), rays }
}

/// Random spheres beside random triangles.
pub fn with_spheres(mut scene: Scene, seed: u64, count: usize, size: f32) -> Scene {
    let mut random = Random::new(seed);
    for _ in 0..count {
        let center = random.vec3() * size;
        let radius = random.unit() * size * 0.2 + 1e-6 * size;
        scene.primitives.spheres.push(Sphere { center, radius });
    }
    scene.name += &format!(" with {count} spheres");
    scene
}
