//! Every generator: triangle counts as documented, closed bodies face outwards, normals agree with faces.

use super::*;
use crate::Mesh;
use crate::builtin::tests::{check_mesh, closed_volume};
use photinus_geometry::Vec3;

/// Checks the mesh and gives its volume; none where it is not closed.
fn volume(part: Part, triangles: usize) -> Option<f32> {
    let mesh = Mesh::from(part);
    assert_eq!(mesh.triangles.len(), triangles);
    assert_eq!(mesh.uvs.len(), mesh.positions.len());
    check_mesh("part", &mesh);
    closed_volume("part", &mesh).pop().flatten()
}

#[track_caller]
fn assert_near(value: Option<f32>, expected: f32, relative: f32) {
    let v = value.expect("the body is closed");
    assert!((v / expected - 1.0).abs() < relative, "{v}, expected {expected}");
}

#[test]
fn boxes_have_their_volumes() {
    assert_near(volume(cuboid([0.0; 3], [1.0, 2.0, 3.0], Faces::All), 12), 6.0, 1e-5);
    assert!(volume(cuboid([0.0; 3], [1.0, 2.0, 3.0], Faces::NoBottom), 10).is_none());
    // Twelve prisms are cut off, which overlap at the corners.
    assert_near(volume(bevelled([-1.0; 3], [1.0, 2.0, 3.0], 0.1), 44), 24.0 - 0.005 * 36.0, 2e-3);
    assert_near(volume(standing([2.0, 3.0, 4.0], 0.05), 44), 24.0, 5e-3);
    let outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    assert_near(volume(frame(4.0, 3.0, &outline), 32), 6.0 * 5.0 - 12.0, 1e-4);
}

#[test]
fn bodies_of_revolution_have_their_volumes() {
    let sphere = 4.0 / 3.0 * std::f32::consts::PI;
    assert_near(volume(revolve(&ball(1.0, 5.0, 20), 40), 2 * 40 * 19), sphere, 0.02);
    let outer = profile(&[[1.0, 0.0], [2.0, 1.5], [1.2, 3.0]], 6);
    let body = revolve(&hollow(&outer, 0.1, 0.1), 32);
    let triangles = body.triangle_count();
    let v = volume(body, triangles).expect("a vessel is closed");
    assert!(v > 0.5 && v < 6.0, "{v}");
}

#[test]
fn tubes_and_patches_have_their_volumes() {
    let straight = [Vec3::ZERO, Vec3::new(1.0, 2.0, 2.0), Vec3::new(2.0, 4.0, 4.0)];
    let pi = std::f32::consts::PI;
    assert_near(volume(tube(&straight, 48, Ends::Flat, |_| 0.5), 4 * 48 + 2 * 48), 0.25 * pi * 6.0, 0.01);
    assert_near(volume(tube(&straight, 48, Ends::Flat, |s| 0.5 * (1.0 - s)), 3 * 48 + 48), 0.25 * pi * 2.0, 0.01);
    let ring: Vec<Vec3> = (0..40)
        .map(|i| {
            let (s, c) = sin_cos_degrees(9.0 * i as f32);
            Vec3::new(3.0 * c, 0.0, 3.0 * s)
        })
        .collect();
    assert_near(volume(tube(&ring, 24, Ends::Ring, |_| 0.5), 40 * 24 * 2), 2.0 * pi * 3.0 * pi * 0.25, 0.03);
    let torus = patch(40, 24, Join::Both, |u, v| {
        let ((s, c), (t, d)) = (sin_cos_degrees(360.0 * u), sin_cos_degrees(360.0 * v));
        Vec3::new((3.0 + 0.5 * d) * c, 0.5 * t, -(3.0 + 0.5 * d) * s)
    });
    assert_near(volume(torus, 40 * 24 * 2), 2.0 * pi * 3.0 * pi * 0.25, 0.03);
    let globe = patch(24, 12, Join::U, |u, v| {
        let ((s, c), (t, d)) = (sin_cos_degrees(360.0 * u), sin_cos_degrees(180.0 * v));
        Vec3::new(t * c, -d, -t * s)
    });
    assert_near(volume(globe, 24 * 11 * 2), 4.0 / 3.0 * pi, 0.05);
}

#[test]
fn soft_bodies_are_closed() {
    let pi = std::f32::consts::PI;
    assert_near(volume(soft_box([1.0, 2.0, 3.0], 2.0, [8, 10, 12]), 4 * (80 + 120 + 96)), 8.0 * pi, 0.03);
    assert_near(volume(soft_box([1.0, 2.0, 3.0], 10.0, [8, 10, 12]), 4 * (80 + 120 + 96)), 48.0, 0.06);
    let v = volume(cushion(18.0, 18.0, 6.0, 10), 400).expect("a cushion is closed");
    assert!(v > 400.0 && v < 1500.0, "{v}");
}

#[test]
fn leaves_have_exactly_the_triangles_asked_for_and_face_up() {
    let shape = LeafShape { length: 10.0, width: 4.0, widest: 0.4, droop: 50.0, fold: 12.0 };
    for n in 4..40 {
        assert!(volume(leaf(shape, n), n).is_none());
    }
    for n in 1..20 {
        let part = blade(shape, n);
        let mesh = Mesh::from(part.clone());
        assert!(mesh.normals.iter().all(|m| m.y > 0.0), "{n}");
        assert!(volume(part, n).is_none());
    }
    let mesh = Mesh::from(leaf(LeafShape { droop: 0.0, ..shape }, 12));
    assert!(mesh.normals.iter().all(|m| m.y > 0.8));
    assert!(volume(petal(6.0, 3.0, 0.4, 0.2, 4, 5), 36).is_none());
}

#[test]
fn books_are_boards_and_pages() {
    let book = book(3.0, 10.0, 7.0);
    assert!(volume(book.binding, 36).is_none());
    let pages = Mesh::from(book.pages.clone());
    // Head up, tail down, fore edge away from the back.
    assert_eq!([0, 4, 8].map(|v| pages.normals[v]), [Vec3::Y, -Vec3::Y, -Vec3::Z]);
    assert!(volume(book.pages, 6).is_none());
}

#[test]
fn shares_add_up() {
    for (total, count) in [(100, 7), (3, 5), (64, 64), (0, 3)] {
        let parts: Vec<usize> = shares(total, count).collect();
        assert_eq!(parts.len(), count);
        assert_eq!(parts.iter().sum::<usize>(), total);
        assert!(parts.iter().max().unwrap() - parts.iter().min().unwrap() <= 1);
    }
}

/// Tiling pictures meet themselves: the step over the border is no larger than the largest inside.
#[test]
fn noise_tiles() {
    use crate::BitmapPixels;
    let bitmap = bitmap::marble(3, bitmap::hex(0xFFFFFF), bitmap::hex(0x000000));
    let BitmapPixels::Rgba8 { data, .. } = &bitmap.pixels else { panic!("eight bits") };
    let (w, h) = (bitmap.width as usize, bitmap.height as usize);
    let step = |a: usize, b: usize| (data[a][0] as i32 - data[b][0] as i32).abs();
    let inside = (0..h).flat_map(|y| (1..w).map(move |x| (y * w + x - 1, y * w + x))).map(|(a, b)| step(a, b)).max();
    let border = (0..h).map(|y| step(y * w, y * w + w - 1)).max();
    assert!(border <= inside, "{border:?} {inside:?}");
}
