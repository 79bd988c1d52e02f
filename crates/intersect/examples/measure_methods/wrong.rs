//! Wrong answers against doubles: single rays at single triangles, an eighth of them hits, of five difficult kinds.

use crate::Figure;
use crate::common::{oracle, randoms};
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::MethodInfo;

/// Pairs of a case.
const PAIRS: u32 = 200_000;

/// How rays and triangles are made.
#[derive(Clone, Copy)]
pub struct Case {
    name: &'static str,
    /// Middle of the scene in each axis; the scene reaches one unit around it.
    offset: f64,
    /// Edge lengths, times a number in [-1, 1] per axis.
    size: f64,
    /// Distance of the ray's start from its target, in sizes; 0: anywhere in the scene.
    near: f64,
    /// The third vertex lies so far from the line through the others, in sizes; 0: anywhere.
    width: f64,
    /// The first edge deviates so little from an axis, in sizes; 0: any direction.
    tilt: f64,
}

const PLAIN: Case = Case { name: "plain", offset: 0.0, size: 0.2, near: 0.0, width: 0.0, tilt: 0.0 };

/// The cases.
pub const CASES: [Case; 5] = [
    PLAIN,
    Case { name: "close-ups", near: 1e-4, ..PLAIN },
    Case { name: "slivers", width: 1e-3, ..PLAIN },
    Case { name: "offset 1000", offset: 1000.0, ..PLAIN },
    Case { name: "edges along axes", tilt: 1e-6, ..PLAIN },
];

/// Rays with their triangles.
pub struct Pairs {
    rays: Vec<Ray>,
    triangles: Primitives,
}

/// The pairs of one case, rounded to single precision.
pub fn pairs(case: Case, seed: u64) -> Pairs {
    let mut pairs = Pairs { rays: Vec::new(), triangles: Primitives::default() };
    for i in 0..PAIRS {
        let r = randoms::<18>(seed, i);
        let v = |k: usize| [r[k], r[k + 1], r[k + 2]];
        let a: [f64; 3] = v(0).map(|x| x + case.offset);
        let mut along = v(3).map(|x| x * case.size);
        if case.tilt > 0.0 {
            let axis = i as usize % 3;
            along = std::array::from_fn(|k| if k == axis { along[k] } else { along[k] * case.tilt });
        }
        let across = if case.width > 0.0 {
            std::array::from_fn(|k| along[k] * 0.5 * (1.0 + r[16]) + v(6)[k] * case.size * case.width)
        } else {
            v(6).map(|x| x * case.size)
        };
        let single = |p: [f64; 3]| p.map(|x| x as f32);
        let vertices =
            [a, std::array::from_fn(|k| a[k] + along[k]), std::array::from_fn(|k| a[k] + across[k])].map(single);
        // Aimed where weights are uniform in [-0.5, 1.5).
        let (alpha, beta) = (0.5 + r[9], 0.5 + r[10]);
        let target: [f64; 3] = std::array::from_fn(|k| a[k] + alpha * along[k] + beta * across[k]);
        let start: [f64; 3] = if case.near > 0.0 {
            std::array::from_fn(|k| target[k] + v(11)[k] * case.near * case.size)
        } else {
            v(11).map(|x| x + case.offset)
        };
        let (start, target) = (single(start), single(target));
        let dir: [f32; 3] = std::array::from_fn(|k| target[k] - start[k]);
        pairs.rays.push(Ray::new(start.into(), dir.into()));
        pairs.triangles.positions.extend(vertices.map(Vec3::from));
        pairs.triangles.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    pairs
}

/// How many answers of a method differ from those in doubles: a hit for a miss, a miss for a hit, and hits whose point
/// lies a hundredth of the longest edge from the right one.
pub fn count(method: &MethodInfo, case: Case, pairs: &Pairs) -> Vec<Figure> {
    let tester = (method.leaf_tester)(&pairs.triangles);
    let (mut false_hits, mut false_misses, mut far) = (0, 0, 0);
    for (i, ray) in pairs.rays.iter().enumerate() {
        let double = |v: Vec3| v.to_array().map(f64::from);
        let vertices = pairs.triangles.triangle(i).map(double);
        let dir = double(ray.dir);
        let ([t, alpha, beta], least) = oracle(double(ray.origin), dir, vertices);
        if !(t.is_finite() && least.is_finite()) {
            continue;
        }
        let mut hit = Hit::MISS;
        tester.closest_hit(ray, &[i as u32], &mut hit);
        match (least >= 0.0 && t >= 0.0, hit.is_hit()) {
            (false, true) => false_hits += 1,
            (true, false) => false_misses += 1,
            (true, true) => {
                let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
                let edge = |k: usize| std::array::from_fn(|axis| vertices[k][axis] - vertices[0][axis]);
                let longest = length(edge(1)).max(length(edge(2)));
                let along = (f64::from(hit.t) - t).abs() * length(dir) / longest;
                let weights = (f64::from(hit.alpha) - alpha).abs().max((f64::from(hit.beta) - beta).abs());
                far += u32::from(along > 0.01 || weights > 0.01);
            }
            (false, false) => {}
        }
    }
    [("false hits", false_hits), ("false misses", false_misses), ("hits far off", far)]
        .map(|(what, n)| (format!("{}: {what}", case.name), f64::from(n)))
        .into()
}
