//! `flip`: LDR-FLIP, Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020, "FLIP: A Difference
//! Evaluator for Alternating Images" (PACM CGIT 3(2)); section numbers below are that paper's.

mod colour;
mod feature;
mod filter;

use super::pixels::Pair;
use crate::error::Result;
use crate::image::Image;
use rayon::prelude::*;
use std::path::Path;

/// Pixels per degree of visual angle: 0.7 m from a 4K display 0.7 m wide (the paper's section 3, its default).
const PIXELS_PER_DEGREE: f64 = 67.0;

/// Mean LDR-FLIP of two images over the counted pixels: linear RGB, clipped to 0..1. 0 for equal images, at most 1;
/// symmetric in its arguments.
pub fn flip(a: &Image, b: &Image, mask: Option<&Image>) -> Result<f64> {
    Ok(mean_of_pair(&Pair::new(a, b, mask, Path::new("flip"))?))
}

/// LDR-FLIP of every pixel, row by row, each in 0..1.
pub fn flip_map(a: &Image, b: &Image) -> Result<Vec<f32>> {
    Ok(map_of_pair(&Pair::new(a, b, None, Path::new("flip"))?))
}

pub(super) fn mean_of_pair(pair: &Pair) -> f64 {
    let map = map_of_pair(pair);
    pair.counted.iter().map(|&i| f64::from(map[i])).sum::<f64>() / pair.counted.len() as f64
}

fn map_of_pair(pair: &Pair) -> Vec<f32> {
    let size = (pair.width, pair.height);
    let a = Opponent::new(&pair.a);
    let b = Opponent::new(&pair.b);
    let colour = colour::differences(&a, &b, size, PIXELS_PER_DEGREE);
    let feature = feature::differences(&a.planes[0], &b.planes[0], size, PIXELS_PER_DEGREE);
    // Section 4.3: the feature difference is an exponent that raises the colour difference.
    colour.par_iter().zip(feature).map(|(&colour, feature)| libm::powf(colour, 1.0 - feature)).collect()
}

/// An image in the linear opponent space YCxCz (section 4.1.1): planes Y (0..100 above -16), Cx, Cz.
struct Opponent {
    planes: [Vec<f32>; 3],
}

impl Opponent {
    fn new(pixels: &[[f32; 3]]) -> Self {
        let opponent: Vec<[f32; 3]> =
            pixels.par_iter().map(|p| colour::rgb_to_opponent(p.map(|c| c.clamp(0.0, 1.0)))).collect();
        Self { planes: [0, 1, 2].map(|c| opponent.iter().map(|p| p[c]).collect()) }
    }
}
