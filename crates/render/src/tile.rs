//! Tiles of a picture: rendered side by side, each with buffers of its own, and put together in order.

use crate::control::{Cancelled, Observer};
use crate::counters::Counters;
use crate::film::{Aov, FilmLayout};
use crate::maps::Estimated;
use photinus_geometry::Vec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Which picture a contribution belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Emitted,
    Direct,
    Caustic,
    Indirect,
}

/// One tile's pixels and buffers.
pub(crate) struct Tile<'a> {
    /// Channels of each pixel, row by row.
    pub out: Vec<f32>,
    /// Weight of each pixel's present sample.
    pub weights: Vec<f32>,
    /// Place in the window of the film: x, y, width, height.
    pub place: [u32; 4],
    /// Number of the present sample in the pass.
    pub sample: u32,
    layout: &'a FilmLayout,
}

impl Tile<'_> {
    /// Adds light to the picture and to its part.
    pub fn add(&mut self, pixel: u32, part: Part, radiance: Vec3) {
        if !radiance.is_finite() {
            return;
        }
        let aov = match part {
            Part::Emitted => Aov::Emitted,
            Part::Direct => Aov::Direct,
            Part::Caustic => Aov::Caustic,
            Part::Indirect => Aov::Indirect,
        };
        let value = radiance * self.weights[pixel as usize];
        self.add_at(pixel, 0, value);
        if let Some(offset) = self.layout.offset(aov) {
            self.add_at(pixel, offset, value);
        }
    }

    /// Adds to three channels from `offset`.
    pub fn add_at(&mut self, pixel: u32, offset: usize, value: Vec3) {
        let start = pixel as usize * self.layout.channels() + offset;
        for (o, v) in self.out[start..start + 3].iter_mut().zip(value.to_array()) {
            *o += v;
        }
    }

    /// Light that a surface or the sky sends out by itself.
    pub fn emitted(&mut self, pixel: u32, radiance: Vec3) {
        self.add(pixel, Part::Emitted, radiance);
    }

    /// An estimate from a map that holds all light.
    pub fn estimated(&mut self, pixel: u32, found: &Estimated) {
        self.add(pixel, Part::Indirect, found.radiance);
        self.add_scalar(pixel, Aov::PhotonDensity, found.density);
    }

    /// Adds to a picture of one channel, where it is wanted.
    pub fn add_scalar(&mut self, pixel: u32, aov: Aov, value: f32) {
        if let Some(offset) = self.layout.offset(aov) {
            self.out[pixel as usize * self.layout.channels() + offset] += value;
        }
    }

    /// Means over the samples, and values of a pass that are no means.
    fn finish(&mut self, samples: u32) {
        let scale = 1.0 / samples as f32;
        for pixel in self.out.chunks_exact_mut(self.layout.channels()) {
            let ids = [Aov::ObjectId, Aov::MaterialId]
                .map(|aov| self.layout.offset(aov).map(|offset| (offset, pixel[offset])));
            pixel.iter_mut().for_each(|v| *v *= scale);
            for (offset, id) in ids.into_iter().flatten() {
                pixel[offset] = id;
            }
            if let Some(offset) = self.layout.offset(Aov::Variance) {
                let luminance = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
                pixel[offset] = luminance * luminance;
            }
        }
    }
}

/// How a picture is cut into tiles.
pub(crate) struct Tiles<'a> {
    pub layout: &'a FilmLayout,
    /// Window of the film: x, y, width, height.
    pub window: [u32; 4],
    /// Samples of a pixel that a tile is to make.
    pub samples: u32,
    /// Edge of a tile in pixels; fixed, so that batches do not depend on the machine.
    pub edge: u32,
}

impl Tiles<'_> {
    /// Renders all tiles by `render(index, tile, counters)`, which returns how many samples it has made, fewer than asked for only where it is stopped; puts them into `film`.
    pub fn run(
        &self,
        film: &mut [f32],
        observer: &dyn Observer,
        render: impl Fn(u32, &mut Tile, &mut Counters) -> u32 + Sync,
    ) -> Result<Counters, Cancelled> {
        let [_, _, width, height] = self.window;
        let (across, down) = (width.div_ceil(self.edge), height.div_ceil(self.edge));
        let tiles = across * down;
        let done = AtomicU64::new(0);
        let place = |tile: u32| {
            let (x0, y0) = (tile % across * self.edge, tile / across * self.edge);
            (x0, y0, self.edge.min(width - x0), self.edge.min(height - y0))
        };
        let results: Vec<Option<(Vec<f32>, Counters, u32)>> = (0..tiles)
            .into_par_iter()
            .map(|index| {
                if observer.cancelled() {
                    return None;
                }
                let (x0, y0, w, h) = place(index);
                let pixels = (w * h) as usize;
                let mut tile = Tile {
                    out: vec![0.0; pixels * self.layout.channels()],
                    weights: vec![1.0; pixels],
                    place: [x0, y0, w, h],
                    sample: 0,
                    layout: self.layout,
                };
                let mut counters = Counters::default();
                let samples = render(index, &mut tile, &mut counters);
                if samples == 0 {
                    return None;
                }
                tile.finish(samples);
                observer.progress(done.fetch_add(1, Ordering::Relaxed) + 1, u64::from(tiles));
                Some((tile.out, counters, samples))
            })
            .collect();
        let mut counters = Counters::default();
        let channels = self.layout.channels();
        let mut complete = true;
        for (index, result) in results.into_iter().enumerate() {
            let Some((pixels, c, samples)) = result else {
                complete = false;
                continue;
            };
            complete &= samples == self.samples;
            counters += c;
            let (x0, y0, w, h) = place(index as u32);
            let row = w as usize * channels;
            for y in 0..h as usize {
                let to = ((y0 as usize + y) * width as usize + x0 as usize) * channels;
                film[to..to + row].copy_from_slice(&pixels[y * row..(y + 1) * row]);
            }
        }
        if complete { Ok(counters) } else { Err(Cancelled) }
    }
}
