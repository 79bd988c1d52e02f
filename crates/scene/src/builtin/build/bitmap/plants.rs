//! Petals, lily pads and the skin of fish.

use super::{draw, fraction, mix, noise::Noise, step_between};
use crate::Bitmap;
use photinus_geometry::Vec3;
use std::sync::Arc;

/// A petal with v along it: from the colour of its base to that of its tip, with fine veins.
pub fn petal(number: u32, base: Vec3, tip: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(64, 128, |u, v| {
        let vein = noise.clouds(u, v, [16, 2], 2);
        mix(base, tip, step_between(0.25, 1.0, v + 0.2 * (vein - 0.5))) * (0.93 + 0.12 * vein)
    })
}

/// A lily pad, u around and v from its middle: forked veins, a paler heart and a reddish rim.
pub fn pad(number: u32, green: Vec3, pale: Vec3, rim: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(512, 128, |u, v| {
        let forks = if v < 0.55 { 11.0 } else { 22.0 };
        let d = (fraction(u * forks) - 0.5).abs() - 0.5;
        let vein = 1.0 - step_between(0.0, 0.12 / (0.3 + v), -d);
        let c = mix(green, pale, 0.55 * vein + 0.4 * (1.0 - step_between(0.0, 0.35, v)));
        let c = mix(c, rim, 0.8 * step_between(0.9, 1.0, v));
        c * (0.8 + 0.4 * noise.clouds(u, v, [12, 6], 4))
    })
}

/// A koi, u around and v along: patches of a strong colour on a pale body.
pub fn scales(number: u32, pale: Vec3, patch: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(128, 256, |u, v| {
        let (x, y) = (u * 24.0, v * 40.0);
        let scale = fraction(x + 0.5 * y.floor().rem_euclid(2.0)) - 0.5;
        let edge = scale * scale * 4.0 + (fraction(y) - 0.5);
        let c = mix(pale, patch, step_between(0.45, 0.52, noise.clouds(u, v, [3, 5], 3)));
        c * (0.88 + 0.12 * step_between(0.0, 0.5, edge))
    })
}
