//! Photons and queries that the tests and the measurements share; everything follows from a seed.

#![allow(dead_code)]

use photinus_geometry::Vec3;
use photinus_num::{Sampler, StreamKind};
use photinus_photons::{GatherQuery, Photon};

/// Seed of everything below; printed by the tests that use it.
pub const SEED: u64 = 20_110;

/// A uniform direction.
pub fn direction(s: &mut Sampler) -> Vec3 {
    let [a, b] = s.next_2d();
    let z = 1.0 - 2.0 * a;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = libm::sincosf(b * std::f32::consts::TAU);
    Vec3::new(r * cos, r * sin, z)
}

/// The sampler of item `index` of a set.
pub fn sampler(set: u64, index: usize) -> Sampler {
    Sampler::new(SEED, StreamKind::Test, set, index as u32)
}

/// `count` photons at the places and with the normals that `place` gives.
pub fn photons(set: u64, count: usize, place: impl Fn(&mut Sampler) -> (Vec3, Vec3)) -> Vec<Photon> {
    (0..count)
        .map(|i| {
            let mut s = sampler(set, i);
            let (position, normal) = place(&mut s);
            let flux = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 1e-3;
            let depth = 1 + (s.next_1d() * 6.0) as u32;
            Photon::new(position, flux, direction(&mut s), normal, depth, s.next_1d() < 0.1).unwrap()
        })
        .collect()
}

/// A point on the inside of a box's faces and the face's normal; areas in proportion.
pub fn on_box(s: &mut Sampler, size: Vec3) -> (Vec3, Vec3) {
    let areas = [size.y * size.z, size.z * size.x, size.x * size.y];
    let total: f32 = areas.iter().sum();
    let mut pick = s.next_1d() * total;
    let mut axis = 0;
    while axis < 2 && pick >= areas[axis] {
        pick -= areas[axis];
        axis += 1;
    }
    let far = s.next_1d() < 0.5;
    let [a, b] = s.next_2d();
    let mut p = size * Vec3::new(a, b, s.next_1d());
    p[axis] = if far { size[axis] } else { 0.0 };
    let mut n = Vec3::ZERO;
    n[axis] = if far { -1.0 } else { 1.0 };
    (p, n)
}

/// A set of photons to search, and the radius that suits it.
pub struct Set {
    pub name: &'static str,
    pub photons: Vec<Photon>,
    pub radius: f32,
}

/// Photons of every kind: surfaces, volumes, clusters and everything degenerate.
pub fn sets() -> Vec<Set> {
    let set = |name, radius, photons| Set { name, photons, radius };
    let at = |p: Vec3| move |_: &mut Sampler| (p, Vec3::Z);
    let mut sets = vec![
        set("none", 1.0, Vec::new()),
        set("one", 0.1, photons(1, 1, at(Vec3::new(0.3, -0.2, 5.0)))),
        set("seventeen", 0.5, photons(2, 17, |s| (Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()), Vec3::Z))),
        set("box", 0.25, photons(3, 6000, |s| on_box(s, Vec3::new(4.0, 3.0, 5.0)))),
        set("volume", 0.15, photons(4, 5000, |s| (Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()), direction(s)))),
        set(
            "sphere",
            0.3,
            photons(5, 4000, |s| {
                let d = direction(s);
                (d * 2.0 + Vec3::new(1.0, 7.0, -3.0), d)
            }),
        ),
        set(
            "far away",
            0.5,
            photons(6, 3000, |s| {
                let (p, n) = on_box(s, Vec3::new(8.0, 6.0, 10.0));
                (p + Vec3::new(1e6, -1e6, 1e6), n)
            }),
        ),
        set("line", 0.01, photons(7, 2000, |s| (Vec3::new(1.0, 2.0, 3.0) * s.next_1d(), Vec3::Y))),
        set("axis", 0.001, photons(8, 2000, |s| (Vec3::new(0.0, s.next_1d(), 0.0), Vec3::X))),
        set("point", 0.1, photons(9, 3000, at(Vec3::new(1e3, 2e3, 3e3)))),
        set(
            "lattice",
            1.0,
            photons(10, 4000, |s| {
                let mut c = || (s.next_1d() * 9.0).floor();
                (Vec3::new(c(), c(), c()), Vec3::Z)
            }),
        ),
        set("tiny", 1e-22, photons(11, 1000, |s| (Vec3::new(s.next_1d(), s.next_1d(), 0.0) * 1e-21, Vec3::Z))),
        set(
            "huge",
            1e17,
            photons(12, 1000, |s| (Vec3::new(s.next_1d() - 0.5, s.next_1d() - 0.5, s.next_1d() - 0.5) * 2e18, Vec3::Z)),
        ),
        set("wide", 1e15, photons(13, 1000, |s| (Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 1e17, Vec3::Z))),
    ];
    // A small room on a plane of 5000 units: far more cells than photons.
    sets.push(set(
        "room on a plane",
        0.05,
        photons(14, 6000, |s| {
            if s.next_1d() < 0.2 {
                (Vec3::new(s.next_1d() - 0.5, 0.0, s.next_1d() - 0.5) * 5000.0, Vec3::Y)
            } else {
                on_box(s, Vec3::new(1.0, 0.5, 1.0))
            }
        }),
    ));
    sets
}

/// Questions about a set: at and near its photons, between them, outside, and what makes no sense.
pub fn queries(set: &Set, count: usize) -> Vec<GatherQuery> {
    let mut queries = Vec::new();
    for i in 0..count {
        let mut s = sampler(100, i);
        let n = set.photons.len();
        let photon = (n > 0).then(|| set.photons[((s.next_1d() * n as f32) as usize).min(n - 1)]);
        let (mut position, mut normal) = photon.map_or((Vec3::ONE, Vec3::Z), |p| (p.position(), p.normal()));
        let mut radius = set.radius;
        match i % 8 {
            0 => {}
            1 => position += direction(&mut s) * radius * s.next_1d(),
            2 => position += direction(&mut s) * radius * 3.0 * s.next_1d(),
            3 => radius *= 0.1 * s.next_1d(),
            4 => radius *= 4.0 * s.next_1d(),
            5 => radius = 0.0,
            6 => position = (position * 3.0).clamp(Vec3::splat(-3e38), Vec3::splat(3e38)),
            _ => normal = direction(&mut s),
        }
        if i % 5 == 0 {
            normal = (normal + 0.7 * direction(&mut s)).normalize();
        }
        queries.push(GatherQuery { position, radius, normal, max_depth: [1, 3, 5, 127, u32::MAX][i % 5] });
    }
    let base = queries.first().copied().unwrap();
    for radius in [f32::INFINITY, 1e30, 1e4 * set.radius, -1.0, f32::NAN, 1e-40] {
        queries.push(GatherQuery { radius, max_depth: 200, ..base });
    }
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        queries.push(GatherQuery { position: Vec3::new(0.0, bad, 0.0), ..base });
        queries.push(GatherQuery { position: Vec3::new(bad, 0.0, 0.0), radius: f32::INFINITY, ..base });
    }
    queries.push(GatherQuery { position: Vec3::splat(1e18), radius: f32::INFINITY, ..base });
    queries.push(GatherQuery { position: Vec3::splat(1.1e18), radius: f32::INFINITY, ..base });
    queries.push(GatherQuery { normal: Vec3::ZERO, ..base });
    queries.push(GatherQuery { normal: Vec3::NAN, ..base });
    queries.push(GatherQuery { max_depth: 0, ..base });
    queries.push(GatherQuery { position: Vec3::splat(-1e18), radius: f32::MAX, ..base });
    queries
}

/// Crowds of queries around some of [`queries`], close enough to one another to be answered together: with one normal and
/// with many, with one radius and with many, some too wide for the photons that suit the others.
pub fn crowds(set: &Set, count: usize) -> Vec<GatherQuery> {
    let crowd = |(i, base): (usize, GatherQuery)| {
        (0..13).map(move |j| {
            let mut s = sampler(101, 16 * i + j);
            let mut query = base;
            query.position += direction(&mut s) * (0.2 * set.radius * s.next_1d());
            if i % 3 == 1 {
                query.normal = (query.normal + 0.3 * direction(&mut s)).normalize_or(Vec3::Z);
            }
            if i % 4 == 1 {
                query.radius *= 1.0 + s.next_1d();
            }
            if j == 7 && i % 2 == 0 {
                query.radius *= 6.0;
            }
            query
        })
    };
    let mut bases = queries(set, count);
    bases.iter_mut().step_by(3).for_each(|query| query.radius *= 2.5);
    bases.into_iter().enumerate().flat_map(crowd).collect()
}
