//! Tables 3 and 4 of the thesis, the kd-tree under other costs of nodes and triangles, as printed and as measured here:
//! `cargo run --release -p photinus --example thesis_kd_costs -- [SCENE [WIDTHxHEIGHT]]`; the thesis's is room-1.
//!
//! Measured are the trees over a scene, rays of its camera, and all rays of a small render in the mode `direct`, of
//! which every one is counted.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::render::{Mode, RenderOptions, Session, Settings, Stop};
use photinus::{BuildOptions, LoadOptions, TreeOptions};
use photinus_render::Silent;
use std::error::Error;
use std::path::Path;

/// C. A. Hoggins, *Hardware Acceleration of Photon Mapping*, Newcastle University, 2010, tables 3 and 4: by row the
/// table, node cost, triangle cost, depth, seconds of tests, seconds of traversal, tests a ray.
const PRINTED: [(u32, f64, f64, u32, f64, f64, f64); 18] = [
    (3, 100.0, 1.0, 20, 114.007, 24.136, 255.787),
    (3, 50.0, 1.0, 21, 76.628, 19.601, 174.170),
    (3, 10.0, 1.0, 27, 37.547, 11.895, 83.914),
    (3, 5.0, 1.0, 29, 26.371, 10.610, 54.785),
    (3, 1.0, 1.0, 36, 13.372, 8.544, 27.379),
    (3, 0.5, 1.0, 37, 12.653, 9.515, 24.718),
    (3, 0.1, 1.0, 38, 12.466, 9.571, 23.116),
    (3, 0.05, 1.0, 39, 13.300, 9.030, 23.003),
    (3, 0.01, 1.0, 39, 13.473, 8.890, 22.837),
    (4, 0.5, 100.0, 39, 12.293, 9.098, 22.817),
    (4, 0.5, 50.0, 39, 12.363, 8.672, 22.837),
    (4, 0.5, 10.0, 39, 12.255, 9.194, 22.997),
    (4, 0.5, 5.0, 38, 12.617, 9.066, 23.115),
    (4, 0.5, 1.0, 37, 12.653, 9.515, 24.718),
    (4, 0.5, 0.5, 36, 14.063, 9.031, 27.387),
    (4, 0.5, 0.1, 29, 28.127, 9.390, 54.893),
    (4, 0.5, 0.05, 27, 39.794, 10.402, 83.950),
    (4, 0.5, 0.01, 21, 79.510, 16.951, 174.091),
];

fn main() -> Result<(), Box<dyn Error>> {
    // A folder to write into, which every example may be given, is no scene: nothing is written.
    let mut words = std::env::args().skip(1).filter(|word| !Path::new(word).is_dir());
    let scene_name = words.next().unwrap_or_else(|| "texture-1210".to_owned());
    let size = words.next().unwrap_or_else(|| "80x60".to_owned());
    let (width, height) = size.split_once('x').ok_or("write the size as WIDTHxHEIGHT")?;
    let size = [width.parse()?, height.parse()?];
    println!(
        "{scene_name}; seconds of one thread\n\n\
         | table | node cost | triangle cost | depth, printed | measured | tests/ray, printed | measured, render | camera \
         | leaves/ray, render | nodes/ray, render | prims/leaf | build s | test s, printed | measured | traversal s, printed | \
         measured |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    );
    for (table, node_cost, triangle_cost, depth, test_secs, traversal_secs, tests_per_ray) in PRINTED {
        let build = BuildOptions { node_cost, triangle_cost, ..BuildOptions::default() };
        let scene = photinus::open(&scene_name, &LoadOptions::default())?;
        let options = TreeOptions { accel: "kd-tree".to_owned(), build: build.clone() };
        let report = photinus::build_tree(scene.clone(), &options)?.report;
        let options = RenderOptions {
            settings: Settings {
                mode: Mode::Direct,
                photons: Some(50_000),
                radius: Some(20.0),
                profile_every: 1,
                ..Settings::default()
            },
            accel: "kd-tree".to_owned(),
            intersect: "badouel".to_owned(),
            build,
            size: Some(size),
            threads: Some(1),
            stop: Stop { passes: Some(1), ..Stop::default() },
            ..RenderOptions::default()
        };
        let profile = Session::new(scene, options)?.render(&Silent)?.stats.profile();
        println!(
            "| {} | {} | {} | {} | {} | {} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} | {:.2} | {} | {:.2} | {} | {:.2} |",
            table,
            node_cost,
            triangle_cost,
            depth,
            report.structure.depth,
            tests_per_ray,
            profile.intersect.tests_per_ray,
            report.rays.tests_per_ray,
            profile.accel.leaves_per_ray,
            profile.accel.nodes_per_ray,
            report.structure.prims_per_leaf,
            report.build_secs,
            test_secs,
            profile.intersect.seconds,
            traversal_secs,
            profile.accel.seconds,
        );
    }
    Ok(())
}
