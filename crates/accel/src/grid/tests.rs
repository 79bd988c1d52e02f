//! Grids: what is in which cell, the cells that a ray visits, and bounds on memory.

use super::{Lists, Raster};
use crate::bounds::padded_bounds;
use crate::options::{BuildOptions, Clip};
use photinus_geometry::{Primitives, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use std::ops::ControlFlow;

fn soup(seed: u64, count: u32, size: f32) -> Primitives {
    let mut out = Primitives::default();
    for i in 0..count {
        let mut s = Sampler::new(seed, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
        let (a, b, c) = (vec3(), vec3(), vec3());
        out.positions.extend([a, a + size * b, a + size * c]);
        out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    out
}

fn grid(primitives: &Primitives, density: f64, clip: Clip) -> (Raster, Lists) {
    Raster::new(primitives, &BuildOptions { density, clip, ..BuildOptions::default() }).unwrap()
}

fn place(raster: &Raster, cell: usize) -> [usize; 3] {
    let [x, y, _] = raster.cells;
    [cell % x, cell / x % y, cell / x / y]
}

#[test]
fn every_cell_lists_the_primitives_whose_bounds_reach_it() {
    let primitives = soup(1, 400, 0.1);
    let (raster, lists) = grid(&primitives, 4.0, Clip::Box);
    assert!(raster.cell_count() > 1000);
    for cell in 0..raster.cell_count() {
        let place = place(&raster, cell);
        let reaching: Vec<u32> = (0..400)
            .filter(|id| {
                let b = padded_bounds(&primitives, *id as usize).unwrap();
                (0..3).all(|k| b.min[k] <= raster.borders[k][place[k] + 1] && b.max[k] >= raster.borders[k][place[k]])
            })
            .collect();
        let list = lists.starts[cell] as usize..lists.starts[cell + 1] as usize;
        assert_eq!(lists.refs[list], reaching);
    }
}

#[test]
fn cells_of_cut_triangles_are_some_of_those_of_their_bounds_and_hold_every_point() {
    let primitives = soup(2, 200, 0.4);
    let (raster, whole) = grid(&primitives, 8.0, Clip::Box);
    let (same, cut) = grid(&primitives, 8.0, Clip::Exact);
    assert_eq!(raster, same);
    assert!(2 * cut.refs.len() < whole.refs.len(), "{} of {}", cut.refs.len(), whole.refs.len());
    let holds = |lists: &Lists, cell: usize, id: u32| {
        lists.refs[lists.starts[cell] as usize..lists.starts[cell + 1] as usize].contains(&id)
    };
    for cell in 0..raster.cell_count() {
        for id in &cut.refs[cut.starts[cell] as usize..cut.starts[cell + 1] as usize] {
            assert!(holds(&whole, cell, *id));
        }
    }
    for id in 0..200 {
        let [a, b, c] = primitives.triangle(id as usize);
        for i in 0..=10 {
            for j in 0..=10 - i {
                let p = a + (b - a) * (i as f32 * 0.1) + (c - a) * (j as f32 * 0.1);
                let at = |k: usize| raster.borders[k][1..].partition_point(|x| *x < p[k]).min(raster.cells[k] - 1);
                assert!(holds(&cut, raster.index([at(0), at(1), at(2)]), id), "triangle {id} at {p}");
            }
        }
    }
}

/// Rays through corners and along borders of cells visit all cells around, each once, and no cell far from the ray.
#[test]
fn walks_visit_each_cell_at_the_ray_once() {
    let primitives = soup(3, 300, 0.1);
    let (raster, _) = grid(&primitives, 2.0, Clip::Box);
    let border = |k: usize, i: usize| raster.borders[k][i % (raster.cells[k] + 1)];
    let mut corners = 0;
    for i in 0..600u32 {
        let mut s = Sampler::new(4, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
        let j = i as usize;
        let corner = Vec3::new(border(0, j), border(1, j / 3), border(2, j / 7));
        let (mut origin, mut dir) = (corner - (vec3() - Vec3::splat(0.5)) * 1.5, Vec3::ZERO);
        match i % 4 {
            0 => origin = vec3() * 2.0 - Vec3::splat(0.5),
            1 => origin = corner - Vec3::new(0.25, -0.25, 0.25) * (1.0 + (i / 4 % 3) as f32),
            2 => (origin, dir) = (corner - Vec3::AXES[j % 3] * 0.3, Vec3::AXES[j % 3]),
            _ => {}
        }
        if dir == Vec3::ZERO {
            dir = corner - origin;
        }
        let ray = Ray::new(origin, dir);
        let mut visits = vec![0; raster.cell_count()];
        let cells = std::cell::RefCell::new(Vec::new());
        let list = |place: [usize; 3]| {
            cells.borrow_mut().push(place);
            0..1
        };
        raster.walk(&ray, list, || {}, |_| ControlFlow::Continue(f32::INFINITY));
        for place in cells.borrow().iter() {
            visits[raster.index(*place)] += 1;
        }
        for (cell, visits) in visits.iter().enumerate() {
            let place = place(&raster, cell);
            // The part of the ray within the cell, in doubles: with a little more around it, and with a little less.
            let within = |more: f64| {
                let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
                for k in 0..3 {
                    let at = |i: usize| f64::from(raster.borders[k][i]) - f64::from(origin[k]);
                    let (low, high, d) = (at(place[k]) - more, at(place[k] + 1) + more, f64::from(dir[k]));
                    if d == 0.0 {
                        if low > 0.0 || high < 0.0 {
                            return false;
                        }
                        continue;
                    }
                    enter = enter.max((low / d).min(high / d));
                    leave = leave.min((low / d).max(high / d));
                }
                enter <= leave
            };
            assert!(*visits <= 1, "cell {place:?} is visited {visits} times by {ray:?}");
            assert!(*visits == 1 || !within(1e-8), "cell {place:?} is not visited by {ray:?}");
            assert!(*visits == 0 || within(1e-4), "cell {place:?} is visited by {ray:?}");
        }
        if i % 4 == 1 {
            corners += usize::from(visits.iter().sum::<i32>() > 3);
        }
    }
    assert!(corners > 100);
}

#[test]
fn resolutions_follow_the_density_and_the_shape() {
    let primitives = soup(5, 1000, 0.01);
    for density in [0.01, 1.0, 8.0, 100.0] {
        let cells = grid(&primitives, density, Clip::Box).0.cell_count() as f64;
        assert!(
            cells >= 0.4 * density * 1000.0 && cells <= 2.5 * density * 1000.0,
            "{cells} cells at density {density}"
        );
    }
    // Flat in z: all cells lie in one layer.
    let mut flat = soup(6, 1000, 0.01);
    flat.positions.iter_mut().for_each(|p| p.z = 1.0);
    let (raster, _) = grid(&flat, 4.0, Clip::Box);
    assert_eq!(raster.cells[2], 1);
    assert!(raster.cell_count() > 3000 && raster.cells[0].abs_diff(raster.cells[1]) <= 2, "{:?}", raster.cells);
    assert!(Raster::new(&flat, &BuildOptions { density: f64::NAN, ..BuildOptions::default() }).is_err());
    assert!(Raster::new(&flat, &BuildOptions { density: 0.0, ..BuildOptions::default() }).is_err());
}

#[test]
fn large_primitives_do_not_fill_memory() {
    let primitives = soup(7, 2000, 3.0);
    for clip in [Clip::Box, Clip::Exact] {
        let (raster, lists) = grid(&primitives, 1000.0, clip);
        assert!(lists.refs.len() <= 32 * 2000 && lists.refs.len() >= 2000, "{} references", lists.refs.len());
        assert!(raster.cell_count() < 1 << 20);
    }
}
