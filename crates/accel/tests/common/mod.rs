//! Scenes and rays for the tests of the family, all seeded.
#![allow(dead_code)] // Each test program uses its part.

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

impl Scene {
    /// The scene with random rays around it and rays along the axes through its vertices.
    pub fn new(name: impl Into<String>, primitives: Primitives, seed: u64, center: Vec3, size: f32) -> Self {
        let mut random = Random::new(seed ^ 0xA11);
        let mut rays = random_rays(&mut random, 300, center, size);
        rays.extend(axis_rays(&mut random, &primitives, size));
        Self { name: name.into(), primitives, rays }
    }
}

/// Triangles that share no vertices.
pub fn soup(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Primitives {
    let positions: Vec<Vec3> = triangles.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Primitives { positions, triangles, spheres: Vec::new() }
}

/// Rays from around the scene to points of it, some with intervals, some along planes of the axes.
fn random_rays(random: &mut Random, count: usize, center: Vec3, size: f32) -> Vec<Ray> {
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
                5 => ray.dir[i / 8 % 3] = 0.0,
                6 => ray.dir[i / 8 % 3] *= 1e-20,
                _ => {}
            }
            ray
        })
        .collect()
}

/// Rays with two zero components through vertices and through middles of edges, from outside, inside and on them.
fn axis_rays(random: &mut Random, primitives: &Primitives, size: f32) -> Vec<Ray> {
    let count = primitives.triangle_count();
    (0..if count == 0 { 0 } else { 200 })
        .map(|i| {
            let [a, b, _] = primitives.triangle((random.unit() * count as f32) as usize % count);
            let target = if i % 2 == 0 { a } else { (a + b) * 0.5 };
            let axis = i / 2 % 3;
            let back = [3.0, 0.1, 0.0, -0.1][i / 6 % 4] * size;
            let mut origin = target;
            origin[axis] -= back;
            let mut dir = Vec3::AXES[axis] * if i % 5 == 0 { -2.0 } else { 1.0 };
            if i % 7 == 0 {
                // A negative zero is a zero.
                dir[(axis + 1) % 3] = -0.0;
            }
            Ray::new(origin, dir)
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
    Scene::new(format!("soup of {count} at {center}, size {size}"), soup(triangles), seed, center, size)
}

/// Random spheres beside what the scene holds.
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

/// Triangles a thousand times as long as wide, in all directions.
pub fn slivers(seed: u64) -> Scene {
    let mut random = Random::new(seed);
    let triangles: Vec<_> = (0..500)
        .map(|_| {
            let (a, along) = (random.vec3(), random.vec3());
            [a, a + along, a + along * random.unit() + random.vec3() * 1e-3]
        })
        .collect();
    Scene::new("slivers", soup(triangles), seed, Vec3::ZERO, 1.0)
}

/// Axis-aligned grids that share vertices, lie in one plane and partly upon each other.
pub fn coplanar_grids(seed: u64) -> Scene {
    let mut out = Primitives::default();
    for (axis, height) in [(0, 0.0), (1, 0.0), (2, 0.0), (2, 0.5), (2, 0.5)] {
        let base = out.positions.len() as u32;
        for j in 0..9 {
            for i in 0..9 {
                let mut p = [i as f32 / 4.0 - 1.0, j as f32 / 4.0 - 1.0, height];
                p.rotate_right((axis + 1) % 3);
                out.positions.push(Vec3::from(p));
            }
        }
        for j in 0..8 {
            for i in 0..8 {
                let a = base + 9 * j + i;
                out.triangles.extend([[a, a + 1, a + 10], [a, a + 10, a + 9]]);
            }
        }
    }
    Scene::new("coplanar grids", out, seed, Vec3::ZERO, 1.0)
}

/// One triangle many times.
pub fn coincident(seed: u64, count: usize) -> Scene {
    let triangle = [Vec3::new(-1.0, -1.0, 0.1), Vec3::new(1.0, -0.9, 0.0), Vec3::new(0.0, 1.0, -0.1)];
    Scene::new(format!("{count} coincident triangles"), soup(vec![triangle; count]), seed, Vec3::ZERO, 1.0)
}

/// Triangles of which each is ten times as large and as far away as the one before: no split is balanced.
pub fn geometric_series(seed: u64) -> Scene {
    let triangles = (-30..30).flat_map(|e| {
        let s = 10f32.powi(e);
        [
            [Vec3::new(s, 0.0, 0.0), Vec3::new(s, s, 0.0), Vec3::new(s, 0.0, s)],
            [Vec3::new(0.0, s, 0.0), Vec3::new(s, s, s), Vec3::new(-s, s, s)],
        ]
    });
    Scene::new("geometric series", soup(triangles), seed, Vec3::ZERO, 1.0)
}

/// A soup with what loaders should have refused: vertices that are not finite, triangles and spheres without extent,
/// one triangle as large as floats allow.
pub fn broken(seed: u64) -> Scene {
    let mut scene = with_spheres(random_soup(seed, 300, Vec3::ZERO, 1.0, 0.3), seed, 20, 1.0);
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38].into_iter().enumerate() {
        let vertex = scene.primitives.triangles[7 * i][i % 3] as usize;
        scene.primitives.positions[vertex][i % 3] = bad;
        scene.primitives.spheres[i].radius = [0.0, -1.0, f32::NAN, f32::INFINITY][i];
        scene.primitives.spheres[10 + i].center[i % 3] = bad;
    }
    scene.primitives.triangles[50] = [3, 3, 3];
    scene.primitives.triangles[51] = [3, 4, 3];
    scene.name = "broken".into();
    scene
}

/// A room-like scene: large triangles around many small ones, far from the origin of coordinates in one axis.
pub fn mixed_sizes(seed: u64) -> Scene {
    let center = Vec3::new(0.0, 1e4, 0.0);
    let mut scene = random_soup(seed, 600, center, 1.0, 0.02);
    let mut random = Random::new(seed ^ 7);
    for _ in 0..30 {
        let base = scene.primitives.positions.len() as u32;
        scene.primitives.positions.extend([0; 3].map(|_| center + random.vec3() * 50.0));
        scene.primitives.triangles.push([base, base + 1, base + 2]);
    }
    scene.name = "mixed sizes".into();
    scene
}
