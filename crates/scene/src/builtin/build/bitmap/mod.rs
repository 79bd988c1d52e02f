//! Pictures drawn by code: functions from the unit square to colour, sampled once.
//!
//! Colours in here are sRGB-encoded, 0 to 1, as one picks them from a chart; v runs upwards.

mod cloth;
mod noise;
mod paintings;
mod plants;
mod stone;
mod wood;
mod world;

pub use cloth::{rug, stripes, weave};
pub use paintings::{blocks, circles, hills};
pub use plants::{pad, petal, scales};
pub use stone::{brick, checker, marble, pebbles};
pub use wood::{grain, planks};
pub use world::world;

use crate::{Bitmap, BitmapPixels};
use photinus_geometry::Vec3;
use rayon::prelude::*;
use std::sync::Arc;

/// The u of the middle of each column.
fn middles(width: u32) -> impl Iterator<Item = f32> + Clone {
    (0..width).map(move |column| (column as f32 + 0.5) / width as f32)
}

/// Samples a picture at the middles of its pixels.
fn draw(width: u32, height: u32, color: impl Fn(f32, f32) -> Vec3 + Sync) -> Arc<Bitmap> {
    draw_rows(width, height, |v, row| paint(row, middles(width).map(|u| color(u, v))))
}

/// A picture, row by row: `row` gets the height of the middles of its pixels, and the pixels.
fn draw_rows(width: u32, height: u32, row: impl Fn(f32, &mut [[u8; 4]]) + Sync) -> Arc<Bitmap> {
    let mut data = vec![[0; 4]; (width * height) as usize];
    let rows = data.par_chunks_exact_mut(width as usize).enumerate();
    rows.for_each(|(line, pixels)| row(1.0 - (line as f32 + 0.5) / height as f32, pixels));
    Arc::new(Bitmap { width, height, pixels: BitmapPixels::Rgba8 { data, srgb: true } })
}

/// Gives pixels their colours. Rows whose colours are formulas without branches, of numbers that lie in order, are painted
/// several pixels at once.
#[inline(always)]
fn paint(pixels: &mut [[u8; 4]], colors: impl Iterator<Item = Vec3>) {
    for (pixel, c) in pixels.iter_mut().zip(colors) {
        let byte = |x: f32| (floor(x.clamp(0.0, 1.0) * 255.0 + 0.5) + WHOLE).to_bits() & 255;
        *pixel = (byte(c.x) | byte(c.y) << 8 | byte(c.z) << 16 | 255 << 24).to_le_bytes();
    }
}

/// A colour by its chart number, 0xRRGGBB.
pub fn hex(number: u32) -> Vec3 {
    let channel = |shift: u32| (number >> shift & 255) as f32 / 255.0;
    Vec3::new(channel(16), channel(8), channel(0))
}

/// From `a` to `b` as `t` goes from 0 to 1.
#[inline(always)]
fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a * (1.0 - t) + b * t
}

/// 0 below `low`, 1 above `high`, smooth between.
#[inline(always)]
fn step_between(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Added to a number below 2^22 in size it leaves the nearest whole number in the lowest bits.
const WHOLE: f32 = 12_582_912.0;

/// The whole number at or below `x`, which is below 2^22 in size. By rounding to the nearest: the library's function is a
/// slow call on machines without the instruction.
#[inline(always)]
fn floor(x: f32) -> f32 {
    let nearest = (x + WHOLE) - WHOLE;
    nearest - if nearest > x { 1.0 } else { 0.0 }
}

/// The part of `x` after its whole number.
#[inline(always)]
fn fraction(x: f32) -> f32 {
    x - floor(x)
}
