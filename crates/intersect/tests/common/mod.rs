//! Every method over every scalar, the oracle, and what the tests of the family share; all random numbers are seeded.
#![allow(dead_code)] // Each test program uses its part.

use photinus_geometry::{Primitives, Ray, Vec3};
use photinus_intersect::methods::{
    angle_summation::AngleSummation, arenberg::Arenberg, badouel::Badouel, badouel_hardware::BadouelHardware,
    badouel_pivot::BadouelPivot, badouel_thesis::BadouelThesis, edge_crossings::EdgeCrossings, half_plane::HalfPlane,
    moller_trumbore::MollerTrumbore, pluecker::Pluecker, snyder_barr::SnyderBarr, woop::Woop,
};
use photinus_intersect::{RtiMethod, TriangleHit};
use photinus_num::{Sampler, Scalar, StreamKind};

pub type Vertices<S> = [[S; 3]; 3];

/// A call of one method over one scalar.
pub type Test<S> = fn([S; 3], [S; 3], Vertices<S>, S, S) -> Option<TriangleHit<S>>;

pub fn call<M: RtiMethod<S>, S: Scalar>(
    origin: [S; 3],
    dir: [S; 3],
    vertices: Vertices<S>,
    t_min: S,
    t_max: S,
) -> Option<TriangleHit<S>> {
    M::intersect(&M::start(origin, dir)?, &M::prepare(vertices), t_min, t_max)
}

/// Every method by name; a member of the list that is missing here fails `the_list_is_covered`.
pub fn all<S: Scalar>() -> [(&'static str, Test<S>); 12] {
    [
        ("woop", call::<Woop, S>),
        ("moller-trumbore", call::<MollerTrumbore, S>),
        ("badouel", call::<Badouel, S>),
        ("badouel-thesis", call::<BadouelThesis, S>),
        ("badouel-pivot", call::<BadouelPivot, S>),
        ("badouel-hardware", call::<BadouelHardware, S>),
        ("snyder-barr", call::<SnyderBarr, S>),
        ("arenberg", call::<Arenberg, S>),
        ("pluecker", call::<Pluecker, S>),
        ("half-plane", call::<HalfPlane, S>),
        ("edge-crossings", call::<EdgeCrossings, S>),
        ("angle-summation", call::<AngleSummation, S>),
    ]
}

pub const INF: f32 = f32::INFINITY;

/// Seeded numbers in [-1, 1).
pub fn randoms<const N: usize>(seed: u64, index: u32) -> [f64; N] {
    let mut s = Sampler::new(seed, StreamKind::Test, 0, index);
    std::array::from_fn(|_| f64::from(s.next_1d()) * 2.0 - 1.0)
}

pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn det(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Cramer's rule from determinants alone: t, alpha, beta, and the smallest weight of a vertex.
pub fn oracle(origin: [f64; 3], dir: [f64; 3], [a, b, c]: Vertices<f64>) -> ([f64; 3], f64) {
    let (e1, e2, s) = (sub(b, a), sub(c, a), sub(origin, a));
    let minus = dir.map(|x| -x);
    let whole = det(minus, e1, e2);
    let (t, alpha, beta) = (det(s, e1, e2) / whole, det(minus, s, e2) / whole, det(minus, e1, s) / whole);
    ([t, alpha, beta], alpha.min(beta).min(1.0 - alpha - beta))
}

/// A closed surface around its middle: a subdivided octahedron, bumpy, so that edges run in all directions.
pub fn closed_mesh(offset: Vec3, size: f32) -> Primitives {
    const N: usize = 12;
    let mut out = Primitives::default();
    for face in 0..8 {
        let corner = |axis: usize| Vec3::AXES[axis] * if face >> axis & 1 == 1 { -1.0 } else { 1.0 };
        let base = out.positions.len() as u32;
        let place = |i: usize, j: usize| base + (i * (i + 1) / 2 + j) as u32;
        for i in 0..=N {
            for j in 0..=i {
                // Of the octahedron's face: exact multiples, so that faces agree about their borders.
                let (a, b, c) = ((N - i) as f32, (i - j) as f32, j as f32);
                let p = (corner(0) * a + corner(1) * b + corner(2) * c) / N as f32;
                let bumps = 1.0 + 0.3 * (p.x * p.y + p.z * p.z * p.y);
                out.positions.push(p * bumps * size + offset);
            }
        }
        for i in 0..N {
            for j in 0..=i {
                out.triangles.push([place(i, j), place(i + 1, j), place(i + 1, j + 1)]);
                if j < i {
                    out.triangles.push([place(i, j), place(i + 1, j + 1), place(i, j + 1)]);
                }
            }
        }
    }
    out
}

/// A box of exact coordinates, eight squares along each edge of it, every triangle beginning at a vertex of chance.
pub fn exact_box(seed: u64) -> Primitives {
    const N: u32 = 8;
    let mut mesh = Primitives::default();
    for side in 0..6 {
        let base = mesh.positions.len() as u32;
        for (i, j) in (0..=N).flat_map(|j| (0..=N).map(move |i| (i, j))) {
            let at = |k: u32| k as f32 / 4.0 - 1.0;
            let mut p = [at(i), at(j), if side < 3 { -1.0 } else { 1.0 }];
            p.rotate_right(side as usize % 3);
            mesh.positions.push(Vec3::from(p));
        }
        for (i, j) in (0..N).flat_map(|j| (0..N).map(move |i| (i, j))) {
            let a = base + (N + 1) * j + i;
            for mut triangle in [[a, a + 1, a + N + 2], [a, a + N + 2, a + N + 1]] {
                let turn = randoms::<1>(seed, mesh.triangles.len() as u32)[0] * 1.5 + 1.5;
                triangle.rotate_left(turn as usize);
                mesh.triangles.push(triangle);
            }
        }
    }
    mesh
}

/// Rays along an axis from the middle of the box that meet edges and vertices exactly.
pub fn exact_rays(mesh: &Primitives) -> Vec<Ray> {
    let mut rays = Vec::new();
    for triangle in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.triangle(triangle);
        for target in [a, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5] {
            for axis in Vec3::AXES.into_iter().filter(|axis| target.dot(*axis).abs() == 1.0) {
                rays.push(Ray::new(target - axis * target.dot(axis), axis * target.dot(axis)));
            }
        }
    }
    rays
}
