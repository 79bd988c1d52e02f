//! What single methods do otherwise than the family, or were known to do wrong: branches, borders, conventions, tolerance.

mod common;

use common::*;
use photinus_intersect::methods::{
    angle_summation::{AngleSummation, tolerance},
    badouel::Badouel,
    badouel_hardware::BadouelHardware,
    badouel_pivot::BadouelPivot,
    badouel_thesis::BadouelThesis,
    edge_crossings::EdgeCrossings,
    half_plane::HalfPlane,
    pluecker::Line,
};

/// Changing branches where u1 is exactly zero leaves a tiny u1 in a quotient, which ruins alpha; a pivot does not.
#[test]
fn a_tiny_pivot_ruins_the_published_rule() {
    let vertices = [[0.0f32, 0.0, 0.0], [1e-7, 1.0, 0.0], [-1.0, 0.5, 0.0]];
    let (mut published, mut thesis) = (0, 0);
    for i in 0..1000 {
        let [x, y] = randoms::<2>(7, i);
        let (alpha, beta) = (0.25 + 0.2 * x, 0.3 + 0.2 * y);
        let origin = [(1e-7 * alpha - beta) as f32, (alpha + 0.5 * beta) as f32, -1.0];
        let right = |hit: Option<photinus_intersect::TriangleHit<f32>>| {
            hit.is_some_and(|h| (f64::from(h.alpha) - alpha).abs() + (f64::from(h.beta) - beta).abs() < 1e-5)
        };
        let dir = [0.0, 0.0, 1.0];
        assert!(right(call::<BadouelPivot, f32>(origin, dir, vertices, 0.0, INF)), "ray {i} of seed 7");
        published += usize::from(!right(call::<Badouel, f32>(origin, dir, vertices, 0.0, INF)));
        thesis += usize::from(!right(call::<BadouelThesis, f32>(origin, dir, vertices, 0.0, INF)));
    }
    assert!(published > 500 && thesis > 500, "{published} {thesis}");
}

/// A u1 of exactly zero takes the other branch, with the indices exchanged along with the vertex.
#[test]
fn a_pivot_of_zero_is_exchanged() {
    for turn in 0..3 {
        let place = |mut p: [f64; 3]| {
            p.rotate_right(turn);
            p
        };
        let vertices = [place([0.5, 0.25, 3.0]), place([0.5, 2.25, 3.0]), place([-1.5, 0.75, 3.0])];
        for i in 0..200 {
            let [x, y, z] = randoms::<3>(8, i);
            let (origin, dir) = (place([3.0 * x, 3.0 * y, 0.0]), place([0.1 * z, 0.0, 1.0]));
            let ([t, alpha, beta], least) = oracle(origin, dir, vertices);
            for (name, test) in all::<f64>().into_iter().filter(|(name, _)| name.starts_with("badouel")) {
                let hit = test(origin, dir, vertices, 0.0, f64::INFINITY);
                assert_eq!(hit.is_some(), least > 0.0, "{name} on ray {i} of seed 8, turn {turn}");
                let error = hit.map_or(0.0, |h| (h.t - t).abs() + (h.alpha - alpha).abs() + (h.beta - beta).abs());
                assert!(error < 1e-12, "{name}: {error}");
            }
        }
    }
}

/// The hardware's border: beyond it nothing differs from the pivoting method, bit for bit.
#[test]
fn the_hardware_differs_where_weights_sum_to_one_or_more() {
    let (mut hits, mut left_out) = (0, 0);
    for i in 0..50_000 {
        let r = randoms::<15>(10, i).map(|x| (x * 4.0).round() as f32);
        let v = |k: usize| [r[k], r[k + 1], r[k + 2]];
        let (origin, dir, vertices) = (v(0), v(3), [v(6), v(9), v(12)]);
        let closed = call::<BadouelPivot, f32>(origin, dir, vertices, 0.0, INF);
        let half_open = call::<BadouelHardware, f32>(origin, dir, vertices, 0.0, INF);
        assert_eq!(half_open, closed.filter(|h| h.alpha + h.beta < 1.0), "ray {i} of seed 10");
        hits += usize::from(closed.is_some());
        left_out += usize::from(closed.is_some() && half_open.is_none());
    }
    assert!(hits > 1000 && left_out > 100, "{hits} {left_out}");
}

/// Sums of a closed triangle's neighbours: two triangles that share their BC both leave it out.
#[test]
fn a_shared_edge_opposite_to_both_first_vertices_is_open_in_hardware() {
    let (b, c) = ([1.0f32, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let [near, far] = [[[0.0, 0.0, 0.0], b, c], [[1.0, 1.0, 0.0], c, b]];
    let (origin, dir) = ([0.5, 0.5, -1.0], [0.0, 0.0, 1.0]);
    for (name, test) in all::<f32>() {
        let hits = [near, far].map(|v| test(origin, dir, v, 0.0, INF).is_some());
        assert_eq!(hits, if name == "badouel-hardware" { [false; 2] } else { [true; 2] }, "{name}");
    }
}

/// Equations 20 to 23 of the thesis with the coordinates of its text are the permuted inner product of direction and
/// moment; those of equation 24 (its three misprints repaired) go with another product, of the opposite sign; the printed
/// pair, equation 21 on coordinates of equation 24, tells sides apart no better than it should.
#[test]
fn pluecker_coordinates_go_with_their_own_product() {
    let of_text = |p: [f64; 3], q: [f64; 3]| {
        [
            q[0] - p[0],
            q[1] - p[1],
            p[0] * q[1] - p[1] * q[0],
            q[2] - p[2],
            p[0] * q[2] - p[2] * q[0],
            p[1] * q[2] - p[2] * q[1],
        ]
    };
    let of_equation_24 = |p: [f64; 3], q: [f64; 3]| {
        [
            p[0] * q[1] - q[0] * p[1],
            p[0] * q[2] - q[0] * p[2],
            p[0] - q[0],
            p[1] * q[2] - q[1] * p[2],
            p[2] - q[2],
            q[1] - p[1],
        ]
    };
    let equation_21 =
        |l: [f64; 6], m: [f64; 6]| l[0] * m[5] - l[1] * m[4] + l[2] * m[3] + l[3] * m[2] - l[4] * m[1] + l[5] * m[0];
    let matching_24 =
        |l: [f64; 6], m: [f64; 6]| l[0] * m[4] + l[1] * m[5] + l[2] * m[3] + l[3] * m[2] + l[4] * m[0] + l[5] * m[1];
    let mut mixed_up = 0;
    for i in 0..10_000 {
        let r = randoms::<12>(11, i);
        let v = |k: usize| [r[k], r[k + 1], r[k + 2]];
        let (p, q, a, b) = (v(0), v(3), v(6), v(9));
        let line = |p: [f64; 3], q: [f64; 3]| Line::along(p, std::array::from_fn(|k| q[k] - p[k]));
        let side = line(p, q).side(&line(a, b));
        assert!((equation_21(of_text(p, q), of_text(a, b)) - side).abs() < 1e-14, "line {i} of seed 11");
        assert!((matching_24(of_equation_24(p, q), of_equation_24(a, b)) + side).abs() < 1e-14, "line {i} of seed 11");
        let mixed = equation_21(of_equation_24(p, q), of_equation_24(a, b));
        mixed_up += usize::from(mixed * side > 0.0);
        let through_p = equation_21(of_text(p, q), of_text(p, b));
        assert!(through_p.abs() < 1e-14, "lines through one point meet");
    }
    // Of either reading of the sign a share far from none is wrong; a coin would give half.
    assert!(mixed_up > 1000 && mixed_up < 9000, "{mixed_up}");
}

/// Points beyond the end of an edge, on its line: a cross product is zero there, and no others decide.
#[test]
fn lines_of_edges_end_with_the_edges() {
    let vertices = [[0.0f32, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    for (x, y) in [(-1.0, 0.0), (3.0, 0.0), (0.0, -1.0), (0.0, 3.0), (3.0, -1.0), (-1.0, 3.0)] {
        let (origin, dir) = ([x, y, 1.0], [0.0, 0.0, -1.0]);
        assert!(call::<HalfPlane, f32>(origin, dir, vertices, 0.0, INF).is_none(), "{x} {y}");
        assert!(call::<EdgeCrossings, f32>(origin, dir, vertices, 0.0, INF).is_none(), "{x} {y}");
    }
}

/// The tolerance of the sum of angles, as far as it reaches: from the middle of an edge of length one, an eighth.
#[test]
fn angles_hit_up_to_an_eighth_of_their_tolerance_outside() {
    let vertices = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0]];
    let hits = |outside: f64| {
        let origin = [0.5, (-outside * tolerance::<f32>() / 8.0) as f32, -1.0];
        call::<AngleSummation, f32>(origin, [0.0, 0.0, 1.0], vertices, 0.0, INF).is_some()
    };
    assert!(hits(0.0) && hits(0.3));
    assert!(!hits(2.5));
}
