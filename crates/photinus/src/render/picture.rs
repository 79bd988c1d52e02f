//! The picture of a render: linear layers, written as EXR or tone mapped into PNG.

use crate::Result;
use photinus_image::tonemap::Tonemap;
use photinus_image::{Image, Layers, write_exr, write_layers_png};
use photinus_render::{Aov, FilmLayout};
use rayon::prelude::*;
use std::path::Path;

/// Pixels that one task copies.
const PIXELS_A_TASK: usize = 1 << 15;

/// A picture with its layers. The layer without a name is the picture itself, linear RGB radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Layers and what is said about them.
    pub layers: Layers,
}

impl Picture {
    /// Sorts a film's pixels into layers.
    pub(super) fn new(pixels: &[f32], layout: &FilmLayout, width: u32, height: u32, about: &[(&str, String)]) -> Self {
        let mut layers = Layers::new(width as usize, height as usize);
        let stride = layout.channels();
        let one = |offset: usize| -> Vec<f32> {
            pixels.par_chunks_exact(stride).with_min_len(PIXELS_A_TASK).map(|p| p[offset]).collect()
        };
        let three = |offset: usize| [one(offset), one(offset + 1), one(offset + 2)];
        const RGB: [&str; 3] = ["R", "G", "B"];
        layers.push_planes("", RGB, three(0));
        for aov in Aov::ALL {
            let Some(offset) = layout.offset(aov) else { continue };
            match aov {
                Aov::Normal => layers.push_planes(aov.name(), ["X", "Y", "Z"], three(offset)),
                Aov::Depth => layers.push_channel(aov.name(), "Z", one(offset)),
                Aov::ObjectId | Aov::MaterialId => layers.push_channel(aov.name(), "id", one(offset)),
                Aov::PhotonDensity | Aov::Variance => layers.push_channel(aov.name(), "Y", one(offset)),
                Aov::Albedo | Aov::Direct | Aov::Indirect | Aov::Caustic | Aov::Emitted => {
                    layers.push_planes(aov.name(), RGB, three(offset));
                }
            }
        }
        layers.metadata = about.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
        Self { layers }
    }

    /// The picture itself, linear RGB.
    pub fn image(&self) -> Image {
        self.layers.image("").unwrap_or_default()
    }

    /// Writes all layers as linear EXR: whoever looks finds the old file or the new one, whole.
    ///
    /// # Errors
    /// [`crate::Error::Image`] where the file cannot be written.
    pub fn write_exr(&self, path: impl AsRef<Path>) -> Result<()> {
        Ok(write_exr(path, &self.layers)?)
    }

    /// Writes the picture itself as PNG: exposure in stops, then the tone curve, then sRGB; whole or not at all.
    ///
    /// # Errors
    /// [`crate::Error::Image`] where the file cannot be written.
    pub fn write_png(&self, path: impl AsRef<Path>, tonemap: Tonemap, exposure_ev: f32) -> Result<()> {
        Ok(write_layers_png(path, &self.layers, tonemap, exposure_ev)?)
    }
}
