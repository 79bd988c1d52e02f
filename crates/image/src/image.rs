//! The two image types: a linear RGB picture, and named layers of named channels.

use rayon::prelude::*;
use std::collections::BTreeMap;

/// Pixels that one task copies.
const PIXELS_A_TASK: usize = 1 << 15;

/// A picture in linear RGB (Rec. 709 primaries, D65 white), rows from top to bottom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` pixels, row by row, the top row first; radiance or any other linear quantity.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// A picture of one colour.
    pub fn filled(width: usize, height: usize, rgb: [f32; 3]) -> Self {
        Self { width, height, pixels: vec![rgb; width * height] }
    }

    /// The pixel in column `x` (from the left) and row `y` (from the top); both must lie inside.
    pub fn at(&self, x: usize, y: usize) -> [f32; 3] {
        self.pixels[y * self.width + x]
    }
}

/// One plane of samples with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name inside its layer: `R`, `Z`, `id`.
    pub name: String,
    /// `width * height` samples, the top row first.
    pub samples: Vec<f32>,
}

/// A group of channels; in the file a channel is called `layer.channel`, or just `channel` in the layer without a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name: empty for the picture itself (beauty), else that of the AOV, e.g. `albedo`.
    pub name: String,
    /// The channels, in the order in which they were added or stored.
    pub channels: Vec<Channel>,
}

/// Layers of one size with text metadata: what an EXR file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The layers, names distinct.
    pub layers: Vec<Layer>,
    /// Text attributes by name (passes, seed, version, ...).
    pub metadata: BTreeMap<String, String>,
}

impl Layers {
    /// No layers yet.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, ..Self::default() }
    }

    /// The picture as the only layer.
    pub fn from_image(image: &Image) -> Self {
        let mut layers = Self::new(image.width, image.height);
        layers.push_rgb("", &image.pixels);
        layers
    }

    /// Adds a layer of three channels `R`, `G`, `B`; the empty name is the picture itself.
    pub fn push_rgb(&mut self, name: &str, pixels: &[[f32; 3]]) {
        self.push_vectors(name, ["R", "G", "B"], pixels);
    }

    /// Adds a layer of three channels with the given names, e.g. `X`, `Y`, `Z` for normals.
    pub fn push_vectors(&mut self, name: &str, channel_names: [&str; 3], vectors: &[[f32; 3]]) {
        let plane = |c: usize| vectors.par_iter().with_min_len(PIXELS_A_TASK).map(|vector| vector[c]).collect();
        self.push_planes(name, channel_names, [plane(0), plane(1), plane(2)]);
    }

    /// Adds a layer of three channels with the given names by their samples.
    pub fn push_planes(&mut self, name: &str, channel_names: [&str; 3], planes: [Vec<f32>; 3]) {
        let channels = channel_names.into_iter().zip(planes);
        let channels = channels.map(|(name, samples)| Channel { name: name.to_string(), samples }).collect();
        self.layers.push(Layer { name: name.to_string(), channels });
    }

    /// Adds a layer of one channel, e.g. `depth` with `Z`.
    pub fn push_channel(&mut self, name: &str, channel_name: &str, samples: Vec<f32>) {
        self.layers.push(Layer {
            name: name.to_string(),
            channels: vec![Channel { name: channel_name.to_string(), samples }],
        });
    }

    /// The layer of that name.
    pub fn layer(&self, name: &str) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.name == name)
    }

    /// The samples of a channel by its full name, e.g. `R` or `albedo.R`.
    pub fn channel(&self, full_name: &str) -> Option<&[f32]> {
        let (layer, channel) = split_channel_name(full_name);
        let channel = self.layer(layer)?.channels.iter().find(|c| c.name == channel)?;
        Some(&channel.samples)
    }

    /// A layer as a picture: its `R`, `G`, `B`, or its `Y` or single channel as grey; `None` where it has neither.
    pub fn image(&self, layer_name: &str) -> Option<Image> {
        let planes = self.rgb_planes(layer_name)?;
        let places = (0..self.width * self.height).into_par_iter().with_min_len(PIXELS_A_TASK);
        let pixels = places.map(|i| [planes[0][i], planes[1][i], planes[2][i]]).collect();
        Some(Image { width: self.width, height: self.height, pixels })
    }

    /// The samples of what [`Layers::image`] shows.
    pub(crate) fn rgb_planes(&self, layer_name: &str) -> Option<[&[f32]; 3]> {
        let layer = self.layer(layer_name)?;
        let find = |name: &str| layer.channels.iter().find(|c| c.name.eq_ignore_ascii_case(name));
        let channels = match (find("R"), find("G"), find("B"), find("Y"), layer.channels.as_slice()) {
            (Some(r), Some(g), Some(b), ..) => [r, g, b],
            (.., Some(y), _) => [y; 3],
            (.., [only]) => [only; 3],
            _ => return None,
        };
        Some(channels.map(|channel| &channel.samples[..]))
    }
}

/// Splits `albedo.R` into layer and channel; the channel is what follows the last dot.
pub(crate) fn split_channel_name(full_name: &str) -> (&str, &str) {
    full_name.rsplit_once('.').unwrap_or(("", full_name))
}
