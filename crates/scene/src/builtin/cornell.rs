//! The measured Cornell box (Cornell University Program of Computer Graphics, "Cornell Box Data"): geometry in
//! millimetres, camera as published (lens 35 mm, film 25 mm), colours from the measured spectra.

use super::build::{Stage, camera, film, quads, rgb};
use super::spectra::{GREEN, RED, WHITE, lamp_rgb, reflectance_rgb};
use crate::{Material, Scene};

const HEIGHT: f32 = 548.8;
const DEPTH: f32 = 559.2;

/// The box with its two blocks; the lamp fills the hole in the ceiling.
pub fn cornell() -> Scene {
    let mut stage = Stage::default();
    let paint = |spectrum| Material::Diffuse { reflectance: rgb(reflectance_rgb(spectrum)) };
    let white = stage.two_sided("white", paint(&WHITE));
    let red = stage.two_sided("red", paint(&RED));
    let green = stage.two_sided("green", paint(&GREEN));
    let lamp = stage.diffuse("lamp", [0.78; 3]);

    stage.mesh("floor", white, quads(&[[[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, DEPTH], [549.6, 0.0, DEPTH]]]));
    // The ceiling runs around the lamp: four trapezoids between its corners and the lamp's.
    let ceiling = [[556.0, 0.0], [556.0, DEPTH], [0.0, DEPTH], [0.0, 0.0]].map(|[x, z]| [x, HEIGHT, z]);
    let hole = [[343.0, 227.0], [343.0, 332.0], [213.0, 332.0], [213.0, 227.0]].map(|[x, z]| [x, HEIGHT, z]);
    stage.mesh(
        "ceiling",
        white,
        quads(&[0, 1, 2, 3].map(|i| [ceiling[i], ceiling[(i + 1) % 4], hole[(i + 1) % 4], hole[i]])),
    );
    stage.lamp("lamp", lamp, quads(&[hole]), lamp_rgb());
    stage.mesh(
        "back",
        white,
        quads(&[[[549.6, 0.0, DEPTH], [0.0, 0.0, DEPTH], [0.0, HEIGHT, DEPTH], [556.0, HEIGHT, DEPTH]]]),
    );
    stage.mesh(
        "right",
        green,
        quads(&[[[0.0, 0.0, DEPTH], [0.0, 0.0, 0.0], [0.0, HEIGHT, 0.0], [0.0, HEIGHT, DEPTH]]]),
    );
    stage.mesh(
        "left",
        red,
        quads(&[[[552.8, 0.0, 0.0], [549.6, 0.0, DEPTH], [556.0, HEIGHT, DEPTH], [556.0, HEIGHT, 0.0]]]),
    );
    stage.mesh("short-block", white, block([[130.0, 65.0], [82.0, 225.0], [240.0, 272.0], [290.0, 114.0]], 165.0));
    stage.mesh("tall-block", white, block([[423.0, 247.0], [265.0, 296.0], [314.0, 456.0], [472.0, 406.0]], 330.0));

    stage.finish(camera([278.0, 273.0, -800.0], [278.0, 273.0, -799.0], 39.307_648), film(512, 512), None)
}

/// Top and sides of an upright block over a (x, z) footprint.
fn block(footprint: [[f32; 2]; 4], height: f32) -> crate::Mesh {
    let at = |i: usize, y: f32| [footprint[i % 4][0], y, footprint[i % 4][1]];
    let mut faces = vec![[0, 1, 2, 3].map(|i| at(i, height))];
    faces.extend((0..4).map(|i| [at(i + 1, 0.0), at(i + 1, height), at(i, height), at(i, 0.0)]));
    quads(&faces)
}
