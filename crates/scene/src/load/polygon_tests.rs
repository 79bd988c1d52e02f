//! Triangulations checked by area, orientation and topology.

use super::*;
use photinus_geometry::{Quat, Vec2};
use photinus_num::{Sampler, StreamKind};
use std::collections::HashMap;

fn flat(points: &[[f32; 2]]) -> Vec<Vec3> {
    points.iter().map(|p| Vec3::new(p[0], p[1], 0.0)).collect()
}

fn cut(corners: &[Vec3]) -> (Verdict, Vec<[u32; 3]>) {
    let mut out = Vec::new();
    let verdict = Triangulator::new().cut(corners, &mut out);
    (verdict, out)
}

fn polygon_area(corners: &[Vec3]) -> f64 {
    let n = plane_normal(corners).unwrap();
    0.5 * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt()
}

/// Right if all triangles face as the polygon does, their areas add up to its area, its border edges appear once and
/// inner edges once in each direction.
fn assert_covers(corners: &[Vec3], what: &str) {
    let (verdict, triangles) = cut(corners);
    assert_eq!(verdict, Verdict::Covered, "{what}");
    let n = corners.len();
    assert_eq!(triangles.len(), n - 2, "{what}");
    let normal = plane_normal(corners).unwrap();
    let mut area = 0.0;
    let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
    for t in &triangles {
        let p = t.map(|i| corners[i as usize]);
        let own = plane_normal(&p).unwrap_or_else(|| panic!("{what}: flat triangle {t:?}"));
        assert!(own[0] * normal[0] + own[1] * normal[1] + own[2] * normal[2] > 0.0, "{what}: {t:?} is turned over");
        area += polygon_area(&p);
        for i in 0..3 {
            *edges.entry((t[i], t[(i + 1) % 3])).or_default() += 1;
        }
    }
    let whole = polygon_area(corners);
    assert!((area - whole).abs() < 1e-4 * whole, "{what}: {area} instead of {whole}");
    for (&(a, b), &count) in &edges {
        let border = b == (a + 1) % n as u32;
        assert!(count == 1 && edges.contains_key(&(b, a)) != border, "{what}: edge {a}-{b}");
    }
    assert!((0..n as u32).all(|a| edges.contains_key(&(a, (a + 1) % n as u32))), "{what}: border edge missing");
}

#[test]
fn convex_polygons_become_fans() {
    assert_eq!(cut(&flat(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]])).1, [[0, 1, 2], [0, 2, 3]]);
    for n in 3..40 {
        let ring: Vec<_> = (0..n)
            .map(|i| Vec2::from_angle(i as f32 / n as f32 * std::f32::consts::TAU))
            .map(|v| Vec3::new(3.0, v.y, v.x))
            .collect();
        assert_covers(&ring, "regular");
        assert_eq!(cut(&ring).1[0], [0, 1, 2]);
    }
}

#[test]
fn a_concave_quad_is_cut_at_its_notch() {
    let dart = flat(&[[0., 0.], [2., 1.], [0., 2.], [1., 1.]]);
    for shift in 0..4 {
        let turned: Vec<_> = (0..4).map(|i| dart[(i + shift) % 4]).collect();
        assert_covers(&turned, "dart");
    }
}

#[test]
fn random_simple_polygons_are_covered_once() {
    for case in 0..300u32 {
        let mut s = Sampler::new(11, StreamKind::Test, u64::from(case), 0);
        let n = 4 + (s.next_1d() * 60.0) as usize;
        let turn = Quat::from_euler(glam::EulerRot::XYZ, s.next_1d() * 6.0, s.next_1d() * 6.0, s.next_1d() * 6.0);
        let star: Vec<Vec3> = (0..n)
            .map(|i| {
                let r = 0.2 + s.next_1d();
                let v = Vec2::from_angle(i as f32 / n as f32 * std::f32::consts::TAU) * r;
                turn * Vec3::new(v.x, v.y, 0.0) * 7.0 + 40.0
            })
            .collect();
        assert_covers(&star, &format!("star {case}"));
    }
}

#[test]
fn combs_spirals_and_straight_runs_are_covered() {
    let mut comb = Vec::new();
    for i in 0..50 {
        let x = i as f32;
        comb.extend([[x, 0.0], [x + 0.5, 0.0], [x + 0.5, 9.0], [x + 0.9, 9.0]]);
    }
    comb.extend([[50.0, 10.0], [0.0, 10.0]]);
    assert_covers(&flat(&comb), "comb");

    let arm = |scale: f32| {
        (0..200).map(move |i| {
            let v = Vec2::from_angle(i as f32 * 0.1) * (1.0 + i as f32 * 0.02) * scale;
            [v.x, v.y]
        })
    };
    let spiral: Vec<_> = arm(1.05).chain(arm(1.0).rev()).collect();
    assert_covers(&flat(&spiral), "spiral");

    // Corners on straight edges are used too, so that neighbours with the same corners leave no gap.
    let rail = [[0., 0.], [1., 0.], [2., 0.], [3., 0.], [3., 1.], [2., 1.], [1., 1.], [0., 1.]];
    for shift in 0..8 {
        let turned: Vec<_> = (0..8).map(|i| rail[(i + shift) % 8]).collect();
        assert_covers(&flat(&turned), "rail");
    }
}

#[test]
fn a_hole_joined_by_a_bridge_stays_a_hole() {
    let keyhole = [[0., 0.], [4., 0.], [4., 4.], [0., 4.], [0., 0.], [1., 1.], [1., 3.], [3., 3.], [3., 1.], [1., 1.]];
    for shift in 0..10 {
        let corners = flat(&(0..10).map(|i| keyhole[(i + shift) % 10]).collect::<Vec<_>>());
        let (verdict, triangles) = cut(&corners);
        assert_eq!((verdict, triangles.len()), (Verdict::Covered, 8), "shift {shift}");
        for t in triangles {
            let p = t.map(|i| corners[i as usize]);
            let middle = (p[0] + p[1] + p[2]) / 3.0;
            let in_hole = middle.x > 1.0 && middle.x < 3.0 && middle.y > 1.0 && middle.y < 3.0;
            assert!(!in_hole, "shift {shift}: {p:?} covers the hole");
        }
    }
}

#[test]
fn hopeless_polygons_are_told_apart() {
    assert_eq!(cut(&flat(&[[0., 0.], [1., 1.], [2., 2.], [5., 5.]])), (Verdict::Degenerate, vec![]));
    assert_eq!(cut(&[Vec3::ONE; 5]), (Verdict::Degenerate, vec![]));
    let (verdict, triangles) = cut(&flat(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]]));
    assert!(verdict == Verdict::Crossing && !triangles.is_empty(), "bow tie");
    let pentagram: Vec<_> = (0..5).map(|i| Vec2::from_angle(i as f32 * 2.0 * 1.256_637).to_array()).collect();
    assert_eq!(cut(&flat(&pentagram)).0, Verdict::Crossing);
    let twice: Vec<_> = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].repeat(300);
    assert_eq!(cut(&flat(&twice)), (Verdict::Covered, vec![[0, 1, 2], [0, 2, 3]]), "a loop listed 300 times");
    for scale in [1e-30, 1e-18, 1e18, 3e38] {
        let quad = flat(&[[0., 0.], [scale, 0.], [scale, scale], [0., scale]]);
        assert_eq!(cut(&quad).1.len(), 2, "{scale}");
    }
}

#[test]
fn a_hostile_polygon_ends_in_time() {
    let mut s = Sampler::new(5, StreamKind::Test, 0, 0);
    let noise: Vec<_> = (0..50_000).map(|_| Vec3::new(s.next_1d(), s.next_1d(), s.next_1d())).collect();
    let start = std::time::Instant::now();
    let (verdict, triangles) = cut(&noise);
    assert_eq!(verdict, Verdict::Crossing);
    assert!(triangles.len() <= noise.len() - 2);
    assert!(start.elapsed().as_secs_f64() < 20.0, "{:?}", start.elapsed());
}
