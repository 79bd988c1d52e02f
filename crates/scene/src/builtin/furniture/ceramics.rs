//! Vessels: vases, bowls, plates, cups and a teapot.

use crate::MaterialId;
use crate::builtin::build::{Ends, Part, Place, Stage, curve, hollow, profile, revolve, tube};

/// Outlines of vases, (radius, height) for a height of 1, from the foot to the lip.
#[derive(Clone, Copy, Debug)]
pub enum VaseShape {
    /// A round belly and a narrow neck with a wide lip.
    Bottle,
    /// Two handles' worth of shoulders: a Greek storage jar.
    Amphora,
    /// A tall cone that opens upwards.
    Trumpet,
    /// A sphere cut open.
    Moon,
}

impl VaseShape {
    fn points(self) -> &'static [[f32; 2]] {
        match self {
            Self::Bottle => {
                &[[0.15, 0.0], [0.27, 0.16], [0.3, 0.34], [0.2, 0.55], [0.09, 0.72], [0.085, 0.88], [0.15, 1.0]]
            }
            Self::Amphora => {
                &[[0.11, 0.0], [0.17, 0.18], [0.3, 0.5], [0.31, 0.66], [0.2, 0.8], [0.13, 0.88], [0.17, 1.0]]
            }
            Self::Trumpet => &[[0.16, 0.0], [0.12, 0.1], [0.11, 0.35], [0.15, 0.65], [0.22, 0.88], [0.3, 1.0]],
            Self::Moon => &[[0.22, 0.0], [0.42, 0.2], [0.5, 0.48], [0.42, 0.78], [0.26, 0.94], [0.25, 1.0]],
        }
    }
}

/// A vase of this height: its outline in `per_span` pieces a span, turned in `segments` steps.
pub fn vase_part(shape: VaseShape, height: f32, per_span: usize, segments: usize) -> Part {
    let points: Vec<[f32; 2]> = shape.points().iter().map(|p| [p[0] * height, p[1] * height]).collect();
    revolve(&hollow(&profile(&points, per_span), 0.03 * height, 0.5 * height), segments)
}

/// A vase on the place's origin.
pub fn vase(stage: &mut Stage, place: Place, material: MaterialId, shape: VaseShape, height: f32) {
    stage.mesh("vase", material, vase_part(shape, height, 2, 20).placed(place));
}

/// A shallow bowl of this radius.
pub fn bowl(stage: &mut Stage, place: Place, material: MaterialId, radius: f32) {
    let outer =
        profile(&[[0.4, 0.0], [0.44, 0.06], [0.75, 0.2], [0.93, 0.4], [1.0, 0.58]].map(|p| p.map(|x| x * radius)), 3);
    stage.mesh("bowl", material, revolve(&hollow(&outer, 0.045 * radius, 0.05 * radius), 28).placed(place));
}

/// A plate of this radius.
pub fn plate(stage: &mut Stage, place: Place, material: MaterialId, radius: f32) {
    let outer = profile(&[[0.55, 0.0], [0.62, 0.05], [0.8, 0.09], [1.0, 0.16]].map(|p| p.map(|x| x * radius)), 1);
    stage.mesh("plate", material, revolve(&hollow(&outer, 0.05 * radius, 0.06 * radius), 24).placed(place));
}

/// A cup with its handle towards +x, on a saucer; `size` is the cup's radius.
pub fn cup(stage: &mut Stage, place: Place, material: MaterialId, size: f32) {
    let outer = profile(&[[0.5, 0.0], [0.72, 0.14], [0.9, 0.6], [1.0, 1.35]].map(|p| p.map(|x| x * size)), 2);
    let saucer = profile(&[[0.8, 0.0], [1.0, 0.06], [1.5, 0.16], [1.8, 0.3]].map(|p| p.map(|x| x * size)), 1);
    let handle = curve(
        &[[0.84, 1.05, 0.0], [1.35, 1.15, 0.0], [1.5, 0.75, 0.0], [1.2, 0.42, 0.0], [0.82, 0.42, 0.0]]
            .map(|p| p.map(|x| x * size)),
        3,
    );
    let cup = revolve(&hollow(&outer, 0.07 * size, 0.08 * size), 18).and(tube(&handle, 6, Ends::Open, |_| 0.1 * size));
    stage.mesh("cup", material, cup.placed(place.shift(0.0, 0.13 * size, 0.0)));
    stage.mesh("saucer", material, revolve(&hollow(&saucer, 0.08 * size, 0.09 * size), 18).placed(place));
}

/// A teapot with its spout towards +x; `size` is the radius of its body.
pub fn teapot(stage: &mut Stage, place: Place, material: MaterialId, size: f32) {
    stage.mesh("teapot", material, teapot_part(size, 3, 24, 8).placed(place));
}

/// The teapot at this fineness: pieces a span of its outlines, segments around, and sides of spout and handle.
pub fn teapot_part(size: f32, per_span: usize, segments: usize, sides: usize) -> Part {
    let scaled = |points: &[[f32; 2]]| points.iter().map(|p| p.map(|x| x * size)).collect::<Vec<_>>();
    let body =
        [[0.0, 0.0], [0.62, 0.0], [0.66, 0.05], [0.95, 0.4], [1.0, 0.72], [0.86, 1.05], [0.6, 1.24], [0.0, 1.28]];
    let smooth = profile(&scaled(&body[2..7]), per_span);
    let mut outline = scaled(&body[..2]);
    outline.extend(smooth);
    outline.extend(scaled(&body[7..]));
    let lid = [
        [0.0, 1.24],
        [0.58, 1.24],
        [0.55, 1.3],
        [0.34, 1.4],
        [0.12, 1.46],
        [0.1, 1.52],
        [0.18, 1.6],
        [0.14, 1.7],
        [0.0, 1.73],
    ];
    let mut lid_outline = scaled(&lid[..2]);
    lid_outline.extend(profile(&scaled(&lid[2..]), per_span.div_ceil(2)));
    let points = |list: &[[f32; 3]]| curve(&list.iter().map(|p| p.map(|x| x * size)).collect::<Vec<_>>(), per_span);
    let spout = points(&[[0.8, 0.45, 0.0], [1.25, 0.62, 0.0], [1.45, 1.0, 0.0], [1.75, 1.22, 0.0]]);
    let handle = points(&[[-0.8, 1.05, 0.0], [-1.2, 1.2, 0.0], [-1.55, 1.0, 0.0], [-1.5, 0.6, 0.0], [-0.9, 0.35, 0.0]]);
    revolve(&outline, segments)
        .and(revolve(&lid_outline, segments))
        .and(tube(&spout, sides, Ends::Flat, |s| size * (0.24 - 0.14 * s)))
        .and(tube(&handle, sides, Ends::Open, |_| 0.09 * size))
}
