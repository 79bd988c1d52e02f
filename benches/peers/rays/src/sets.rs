//! The rays: what a photon-mapping renderer traces, made with our own structure once and for all engines.

use crate::meshes::Mesh;
use photinus_accel::Structure;
use photinus_geometry::{Hit, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};

/// Rays of one kind.
pub struct Set {
    /// Its name.
    pub name: &'static str,
    /// The rays in the order in which a renderer has them.
    pub rays: Vec<Ray>,
    /// Whether any hit will do.
    pub any: bool,
}

/// Pixels of a tile's edge: a renderer follows pictures in tiles.
const TILE: usize = 32;
/// Seed of all random numbers.
const SEED: u64 = 4;

/// All sets of about `count` rays.
pub fn all(mesh: &Mesh, structure: &dyn Structure, count: usize) -> Vec<Set> {
    let primary = primary(mesh, count);
    let hits = trace(structure, &primary);
    let bounce = bounce(mesh, &primary, &hits, 1);
    let second = self::bounce(mesh, &bounce, &trace(structure, &bounce), 2);
    let deep = self::bounce(mesh, &second, &trace(structure, &second), 3);
    let shadow = shadow(mesh, &primary, &hits);
    let photon = photons(mesh, count);
    let photon2 = self::bounce(mesh, &photon, &trace(structure, &photon), 5);
    let mut shuffled = deep.clone();
    shuffle(&mut shuffled);
    let closest = |name, rays| Set { name, rays, any: false };
    vec![
        closest("primary", primary),
        closest("bounce", bounce),
        closest("deep", deep),
        closest("deep-shuffled", shuffled),
        closest("photon", photon),
        closest("photon2", photon2),
        Set { name: "any-hit", rays: shadow, any: true },
    ]
}

fn trace(structure: &dyn Structure, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    structure.closest_hit(rays, &mut hits);
    hits
}

fn numbers(stage: u32, i: usize) -> Sampler {
    Sampler::new(SEED, StreamKind::Test, u64::from(stage), i as u32)
}

/// A picture of 4 : 3 in tiles, 60 degrees wide.
fn primary(mesh: &Mesh, count: usize) -> Vec<Ray> {
    let [origin, target, up] = mesh.camera;
    let view = (target - origin).normalize();
    let right = view.cross(up).normalize();
    let up = right.cross(view);
    let tiles = ((count as f64 / 12.0).sqrt() / TILE as f64).round().max(1.0) as usize;
    let (columns, rows) = (4 * tiles, 3 * tiles);
    let half = 0.57735;
    let mut out = Vec::with_capacity(columns * rows * TILE * TILE);
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        for place in 0..TILE * TILE {
            // Blocks of four times four in blocks of eight times eight, as the renderer follows them: what packets like best.
            let bits = |low: usize, count: usize| place >> low & ((1 << count) - 1);
            let x = bits(6, 2) * 8 + bits(4, 1) * 4 + bits(0, 2);
            let y = bits(8, 2) * 8 + bits(5, 1) * 4 + bits(2, 2);
            let mut s = numbers(0, out.len());
            let u = ((column * TILE + x) as f32 + s.next_1d()) / (columns * TILE) as f32 * 2.0 - 1.0;
            let v = 1.0 - ((row * TILE + y) as f32 + s.next_1d()) / (rows * TILE) as f32 * 2.0;
            out.push(Ray::new(origin, view + right * (u * half) + up * (v * half * 0.75)));
        }
    }
    out
}

/// Diffusely reflected from what was hit; rays that left are dropped.
fn bounce(mesh: &Mesh, rays: &[Ray], hits: &[Hit], stage: u32) -> Vec<Ray> {
    let mut out = Vec::with_capacity(rays.len());
    for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
        let Some((point, normal)) = surface(mesh, ray, hit) else { continue };
        let mut s = numbers(stage, i);
        out.push(Ray::new(point, cosine(normal, s.next_1d(), s.next_1d())));
    }
    out
}

/// The point off the surface, and the normal on the ray's side.
fn surface(mesh: &Mesh, ray: &Ray, hit: &Hit) -> Option<(Vec3, Vec3)> {
    if !hit.is_hit() {
        return None;
    }
    let [a, b, c] = mesh.primitives.triangle(hit.prim as usize);
    let normal = (b - a).cross(c - a).normalize();
    let normal = if normal.dot(ray.dir) > 0.0 { -normal } else { normal };
    let size = ray.origin.abs().max_element() + hit.t * ray.dir.length();
    Some((ray.at(hit.t) + normal * (1e-5 * size), normal))
}

fn cosine(normal: Vec3, u: f32, v: f32) -> Vec3 {
    // A point on the sphere around the tip of the normal.
    let (z, phi) = (1.0 - 2.0 * u, v * std::f32::consts::TAU);
    let r = (1.0 - z * z).max(0.0).sqrt();
    let direction = normal + Vec3::new(r * phi.cos(), r * phi.sin(), z);
    if direction.length_squared() > 1e-6 { direction.normalize() } else { normal }
}

/// From the lamp downwards, in no order.
fn photons(mesh: &Mesh, count: usize) -> Vec<Ray> {
    let down = -mesh.camera[2].normalize();
    (0..count)
        .map(|i| {
            let mut s = numbers(4, i);
            Ray::new(lamp_point(mesh, s.next_1d(), s.next_1d()), cosine(down, s.next_1d(), s.next_1d()))
        })
        .collect()
}

fn lamp_point(mesh: &Mesh, u: f32, v: f32) -> Vec3 {
    let (x, y) = mesh.camera[2].normalize().any_orthonormal_pair();
    mesh.lamp + x * ((u - 0.5) * mesh.lamp_size) + y * ((v - 0.5) * mesh.lamp_size)
}

/// From what the camera sees to the lamp.
fn shadow(mesh: &Mesh, rays: &[Ray], hits: &[Hit]) -> Vec<Ray> {
    let mut out = Vec::with_capacity(rays.len());
    for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
        let Some((point, _)) = surface(mesh, ray, hit) else { continue };
        let mut s = numbers(6, i);
        let to = lamp_point(mesh, s.next_1d(), s.next_1d()) - point;
        out.push(Ray { t_max: 0.999, ..Ray::new(point, to) });
    }
    out
}

fn shuffle(rays: &mut [Ray]) {
    for i in (1..rays.len()).rev() {
        let j = (f64::from(numbers(7, i).next_1d()) * (i + 1) as f64) as usize;
        rays.swap(i, j.min(i));
    }
}
