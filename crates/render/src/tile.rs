//! Tiles of a picture: rendered side by side, each with buffers of its own, and put together in order.

use crate::control::{Cancelled, Observer};
use crate::counters::Counters;
use crate::film::{Aov, FilmLayout};
use crate::film_filter::SharedFilter;
use crate::maps::Estimated;
use photinus_geometry::Vec3;
use photinus_profile::queries::MapKind;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Which picture a contribution belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Emitted,
    Direct,
    Caustic,
    Indirect,
}

impl Part {
    fn aov(self) -> Aov {
        match self {
            Self::Emitted => Aov::Emitted,
            Self::Direct => Aov::Direct,
            Self::Caustic => Aov::Caustic,
            Self::Indirect => Aov::Indirect,
        }
    }
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
    shared: Option<Shared<'a>>,
}

/// Sums of the pixels that share a tile's samples: those of the tile and of a border around it.
struct Shared<'a> {
    filter: &'a SharedFilter,
    /// Where each pixel's present sample lies, from the pixel's middle.
    offsets: Vec<[f32; 2]>,
    sums: Vec<f32>,
}

impl Shared<'_> {
    /// Adds what a sample at `offset` from the middle of a pixel found to the sums of all pixels that share it.
    fn add(&mut self, [x, y]: [u32; 2], width: u32, offset: [f32; 2], values: &[f32], first: usize, stride: usize) {
        let (across, down) = (self.filter.weights(offset[0]), self.filter.weights(offset[1]));
        let reach = self.filter.reach as usize;
        let row = width as usize + 2 * reach;
        for (j, wy) in down.iter().enumerate().take(2 * reach + 1).filter(|(_, w)| **w > 0.0) {
            for (i, wx) in across.iter().enumerate().take(2 * reach + 1).filter(|(_, w)| **w > 0.0) {
                let at = ((y as usize + j) * row + x as usize + i) * stride + first;
                for (sum, value) in self.sums[at..at + values.len()].iter_mut().zip(values) {
                    *sum += value * (wx * wy);
                }
            }
        }
    }
}

impl Tile<'_> {
    /// Adds light to the picture and to its part.
    pub fn add(&mut self, pixel: u32, part: Part, radiance: Vec3) {
        if !radiance.is_finite() {
            return;
        }
        let value = radiance * self.weights[pixel as usize];
        self.add_at(pixel, 0, value);
        if let Some(offset) = self.layout.offset(part.aov()) {
            self.add_at(pixel, offset, value);
        }
    }

    /// Says where the present sample of a pixel lies, from the pixel's middle, and its weight.
    pub fn place_sample(&mut self, pixel: u32, offset: [f32; 2], weight: f32) {
        self.weights[pixel as usize] = weight;
        if let Some(shared) = &mut self.shared {
            shared.offsets[pixel as usize] = offset;
        }
    }

    /// Ends a sample: where pixels share samples, what it found goes to all that share it.
    pub fn end_sample(&mut self) {
        let Some(shared) = &mut self.shared else { return };
        let (channels, width) = (self.layout.channels(), self.place[2]);
        for (pixel, values) in self.out.chunks_exact_mut(channels).enumerate() {
            let ids = [Aov::ObjectId, Aov::MaterialId]
                .map(|aov| self.layout.offset(aov).map(|offset| (offset, std::mem::take(&mut values[offset]))));
            if let Some(weight) = self.layout.weight() {
                values[weight] = 1.0;
            }
            let at = [pixel as u32 % width, pixel as u32 / width];
            shared.add(at, width, shared.offsets[pixel], values, 0, channels);
            values.fill(0.0);
            for (offset, id) in ids.into_iter().flatten() {
                values[offset] = id;
            }
        }
    }

    /// Adds to what a pixel's sample found elsewhere: `shift` farther in the pixel, wrapped around.
    pub fn add_shifted(&mut self, pixel: u32, shift: [f32; 2], part: Part, found: &Estimated, share: f32) {
        let Some(shared) = &mut self.shared else {
            self.add(pixel, part, found.radiance * share);
            self.add_scalar(pixel, Aov::PhotonDensity, found.density * share);
            return;
        };
        if !found.radiance.is_finite() {
            return;
        }
        let wrap = |x: f32, by: f32| (x + 0.5 + by).fract() - 0.5;
        let [x, y] = shared.offsets[pixel as usize];
        let offset = [wrap(x, shift[0]), wrap(y, shift[1])];
        let (width, channels) = (self.place[2], self.layout.channels());
        let at = [pixel % width, pixel / width];
        let value = (found.radiance * share).to_array();
        shared.add(at, width, offset, &value, 0, channels);
        if let Some(first) = self.layout.offset(part.aov()) {
            shared.add(at, width, offset, &value, first, channels);
        }
        if let Some(first) = self.layout.offset(Aov::PhotonDensity) {
            shared.add(at, width, offset, &[found.density * share], first, channels);
        }
    }

    /// Where a pixel of the tile lies in the window.
    pub fn window_pixel(&self, pixel: u32) -> [u32; 2] {
        let [x0, y0, width, _] = self.place;
        [x0 + pixel % width, y0 + pixel / width]
    }

    /// The light of a pixel by its own samples, a mean sample's.
    pub fn light(&self, pixel: u32) -> Vec3 {
        let light = Vec3::from_slice(&self.out[pixel as usize * self.layout.channels()..]);
        // What is shared is handed on after each sample.
        if self.shared.is_some() { light } else { light / (self.sample + 1) as f32 }
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

    /// An estimate from a map of all light, or of its own part of it.
    pub fn estimated(&mut self, map: MapKind, pixel: u32, radiance: Vec3, density: f32) {
        let part = if map == MapKind::Global { Part::Indirect } else { Part::Caustic };
        self.add(pixel, part, radiance);
        self.add_scalar(pixel, Aov::PhotonDensity, density);
    }

    /// Adds to a picture of one channel, where it is wanted.
    pub fn add_scalar(&mut self, pixel: u32, aov: Aov, value: f32) {
        if let Some(offset) = self.layout.offset(aov) {
            self.out[pixel as usize * self.layout.channels() + offset] += value;
        }
    }

    /// What it made in so many samples; nothing without any.
    pub fn made(mut self, counters: Counters, samples: u32) -> Option<Made> {
        (samples > 0).then(|| {
            self.finish(samples);
            Made { pixels: self.shared.map_or(self.out, |shared| shared.sums), counters, samples }
        })
    }

    /// Means over the samples, and values of a pass that are no means; shared samples stay sums.
    fn finish(&mut self, samples: u32) {
        let channels = self.layout.channels();
        if let Some(shared) = &mut self.shared {
            // Labels belong to their own pixels.
            let (reach, width) = (shared.filter.reach as usize, self.place[2] as usize);
            for offset in [Aov::ObjectId, Aov::MaterialId].into_iter().filter_map(|aov| self.layout.offset(aov)) {
                for (pixel, values) in self.out.chunks_exact(channels).enumerate() {
                    let at = (pixel / width + reach) * (width + 2 * reach) + pixel % width + reach;
                    shared.sums[at * channels + offset] = values[offset];
                }
            }
            return;
        }
        let scale = 1.0 / samples as f32;
        for pixel in self.out.chunks_exact_mut(channels) {
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
    /// The filter where pixels share samples.
    pub shared: Option<&'a SharedFilter>,
}

/// What a tile made.
pub(crate) struct Made {
    /// Means of its pixels; where samples are shared, sums with their border.
    pixels: Vec<f32>,
    counters: Counters,
    samples: u32,
}

/// Tiles that have been put into a film.
#[derive(Default)]
pub(crate) struct Together {
    tiles: u32,
    /// Those that were not stopped.
    whole: u32,
    counters: Counters,
}

/// Buffers that tasks hand on to one another.
#[derive(Default)]
pub(crate) struct Spare<B>(Mutex<Vec<B>>);

impl<B: Default> Spare<B> {
    /// Does work with buffers that no other thread has. What is in them must not matter.
    pub fn with<T>(&self, work: impl FnOnce(&mut B) -> T) -> T {
        let mut buffers = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default();
        let out = work(&mut buffers);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(buffers);
        out
    }
}

impl<'a> Tiles<'a> {
    /// Tiles along each axis.
    fn across(&self) -> [u32; 2] {
        let [_, _, width, height] = self.window;
        [width, height].map(|size| size.div_ceil(self.edge))
    }

    /// How many there are.
    pub fn count(&self) -> u32 {
        let [across, down] = self.across();
        across * down
    }

    /// Place in the window: x, y, width, height.
    fn place(&self, index: u32) -> [u32; 4] {
        let ([_, _, width, height], [across, _]) = (self.window, self.across());
        let (x0, y0) = (index % across * self.edge, index / across * self.edge);
        [x0, y0, self.edge.min(width - x0), self.edge.min(height - y0)]
    }

    /// An empty tile.
    pub fn tile(&self, index: u32) -> Tile<'a> {
        let [x0, y0, w, h] = self.place(index);
        let pixels = (w * h) as usize;
        let channels = self.layout.channels();
        Tile {
            out: vec![0.0; pixels * channels],
            weights: vec![1.0; pixels],
            place: [x0, y0, w, h],
            sample: 0,
            layout: self.layout,
            shared: self.shared.map(|filter| Shared {
                filter,
                offsets: vec![[0.0; 2]; pixels],
                sums: vec![0.0; ((w + 2 * filter.reach) * (h + 2 * filter.reach)) as usize * channels],
            }),
        }
    }

    /// Renders all tiles by `render(buffers, index, tile, counters)`, which returns how many samples it has made,
    /// fewer than asked for only where it is stopped; puts them into `film`. What is in the buffers, which tiles hand
    /// on to one another, must not matter.
    pub fn run<B: Default + Send>(
        &self,
        film: &mut [f32],
        observer: &dyn Observer,
        render: impl Fn(&mut B, u32, &mut Tile, &mut Counters) -> u32 + Sync,
    ) -> Result<Counters, Cancelled> {
        let tiles = self.count();
        let done = AtomicU64::new(0);
        let spare = Spare::default();
        // One by one: of a run of tiles that a thread has begun no other can take any when it has none left.
        let made: Vec<Option<Made>> = (0..tiles)
            .into_par_iter()
            .with_max_len(1)
            .map(|index| {
                if observer.cancelled() {
                    return None;
                }
                let mut tile = self.tile(index);
                let mut counters = Counters::default();
                let samples = spare.with(|buffers| render(buffers, index, &mut tile, &mut counters));
                let made = tile.made(counters, samples)?;
                observer.progress(done.fetch_add(1, Ordering::Relaxed) + 1, u64::from(tiles));
                Some(made)
            })
            .collect();
        let mut together = Together::default();
        made.into_iter().for_each(|made| self.put(made, film, &mut together));
        self.finish(together, film)
    }

    /// Puts what the next tile made, as far as there is anything, into `film`.
    pub fn put(&self, made: Option<Made>, film: &mut [f32], together: &mut Together) {
        let [x0, y0, w, h] = self.place(together.tiles);
        together.tiles += 1;
        let Some(Made { pixels, counters, samples }) = made else { return };
        together.whole += u32::from(samples == self.samples);
        together.counters += counters;
        if let Some(filter) = self.shared {
            self.add_sums(film, [x0, y0, w, h], &pixels, filter.reach);
            return;
        }
        let ([_, _, width, _], channels) = (self.window, self.layout.channels());
        let row = w as usize * channels;
        for y in 0..h as usize {
            let to = ((y0 as usize + y) * width as usize + x0 as usize) * channels;
            film[to..to + row].copy_from_slice(&pixels[y * row..(y + 1) * row]);
        }
    }

    /// Ends a film that all tiles are in, as far as there are any; counters are those of all tiles.
    pub fn finish(&self, together: Together, film: &mut [f32]) -> Result<Counters, Cancelled> {
        let channels = self.layout.channels();
        if let (Some(offset), Some(weight)) = (self.layout.offset(Aov::Variance), self.layout.weight()) {
            for pixel in film.chunks_exact_mut(channels) {
                let luminance = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
                // The square of the pass's mean, times its weight: the spread of weighted means around the weighted mean is
                // never negative.
                pixel[offset] = luminance * (luminance / pixel[weight].max(f32::MIN_POSITIVE));
            }
        }
        if together.whole == self.count() { Ok(together.counters) } else { Err(Cancelled) }
    }

    /// Adds the sums of a tile and its border to the film, as far as they lie on it.
    fn add_sums(&self, film: &mut [f32], [x0, y0, w, h]: [u32; 4], sums: &[f32], reach: u32) {
        let ([_, _, width, height], channels) = (self.window, self.layout.channels());
        let row = ((w + 2 * reach) as usize) * channels;
        let left = reach.saturating_sub(x0);
        let right = (w + 2 * reach).min(width + reach - x0);
        for y in reach.saturating_sub(y0)..(h + 2 * reach).min(height + reach - y0) {
            let from = y as usize * row + left as usize * channels;
            let to = ((y0 + y - reach) * width + x0 + left - reach) as usize * channels;
            let count = (right - left) as usize * channels;
            film[to..to + count].iter_mut().zip(&sums[from..from + count]).for_each(|(sum, value)| *sum += value);
        }
    }
}
