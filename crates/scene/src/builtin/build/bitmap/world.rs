//! A map of an invented world, for globes.

use super::{draw, fraction, hex, mix, noise::Noise, step_between};
use crate::Bitmap;
use std::sync::Arc;

/// Seas, lands with highlands, ice at the poles and a net of meridians and parallels; u runs around the globe.
pub fn world(number: u32) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(768, 384, |u, v| {
        let height = noise.clouds(u, v, [5, 3], 6);
        let cold = step_between(0.40, 0.47, (v - 0.5).abs() + 0.06 * (height - 0.5));
        let land = mix(hex(0xC9B77A), hex(0x7E9A58), step_between(0.5, 0.6, noise.clouds(u + 0.3, v, [7, 5], 4)));
        let land = mix(land, hex(0x9A7A52), step_between(0.6, 0.72, height));
        let sea = mix(hex(0x2F5E84), hex(0x5E93AD), step_between(0.35, 0.53, height));
        let mut c = mix(sea, land, step_between(0.53, 0.535, height));
        c = mix(c, hex(0xF0F0EA), cold);
        let net = |t: f32, n: f32| {
            let d = fraction(t * n + 0.5) - 0.5;
            step_between(0.006, 0.016, d.abs() * 12.0 / n)
        };
        c * (0.78 + 0.22 * net(u, 24.0).min(net(v, 12.0)))
    })
}
