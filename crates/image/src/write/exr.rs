//! OpenEXR out: one part, 32-bit floats, ZIP blocks of 16 lines, attributes and channels sorted by name.

use super::atomic::write_atomic;
use crate::error::{ImageError, ImageErrorKind, Result};
use crate::image::Layers;
use exr::block::lines::LineRefMut;
use exr::block::{BlockIndex, UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::error::Error as CodecError;
use exr::meta::attribute::{AttributeValue, ChannelDescription, LineOrder, SampleType, Text};
use exr::meta::header::{Header, LayerAttributes, standard_names};
use exr::meta::{BlockDescription, MetaData, attribute, magic_number, sequence_end};
use exr::prelude::{Compression, SmallVec, Vec2};
use rayon::prelude::*;
use std::path::Path;

/// Writes all layers into one EXR file, atomically (see [`write_atomic`]).
pub fn write_exr(path: impl AsRef<Path>, layers: &Layers) -> Result<()> {
    let path = path.as_ref();
    write_atomic(path, &encode(layers, path)?)
}

/// The bytes of the EXR file of `layers`. The same layers give the same bytes on every run and with any number of threads.
pub fn encode_exr(layers: &Layers) -> Result<Vec<u8>> {
    encode(layers, Path::new("EXR"))
}

fn encode(layers: &Layers, path: &Path) -> Result<Vec<u8>> {
    let mismatch = |what: String| {
        ImageError::new(ImageErrorKind::Mismatch, path, what, "this is an error of the program that writes the image")
    };
    let mut channels: Vec<(String, &[f32])> = Vec::new();
    for layer in &layers.layers {
        for channel in &layer.channels {
            let dot = if layer.name.is_empty() { "" } else { "." };
            channels.push((format!("{}{dot}{}", layer.name, channel.name), &channel.samples));
        }
    }
    // The format wants them in the order of their bytes.
    channels.sort_by(|a, b| a.0.as_bytes().cmp(b.0.as_bytes()));
    if channels.is_empty() || layers.width == 0 || layers.height == 0 {
        return Err(mismatch(format!("the image is empty ({} x {} pixels)", layers.width, layers.height)));
    }
    if let Some(pair) = channels.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        return Err(mismatch(format!("two channels are called {:?}", pair[0].0)));
    }
    let pixels = layers.width * layers.height;
    if let Some((name, samples)) = channels.iter().find(|(_, samples)| samples.len() != pixels) {
        return Err(mismatch(format!("channel {name:?} has {} samples for {pixels} pixels", samples.len())));
    }
    let header = header(layers, &channels, path)?;
    write_file(header, &channels).map_err(|error| mismatch(error.to_string()))
}

fn header(layers: &Layers, channels: &[(String, &[f32])], path: &Path) -> Result<Header> {
    let described: SmallVec<[ChannelDescription; 5]> =
        channels.iter().map(|(name, _)| ChannelDescription::new(text(name), SampleType::F32, false)).collect();
    let mut attributes = LayerAttributes::default();
    for (key, value) in &layers.metadata {
        let value = text(value);
        match key.as_str() {
            "software" => attributes.software_name = Some(value),
            "comments" => attributes.comments = Some(value),
            "owner" => attributes.owner = Some(value),
            key if key.is_empty() || key.len() > 255 || standard_names::ALL.contains(&key.as_bytes()) => {
                return Err(ImageError::new(
                    ImageErrorKind::Mismatch,
                    path,
                    format!("{key:?} cannot be the name of a text attribute in EXR"),
                    "choose another name",
                ));
            }
            key => {
                attributes.other.insert(text(key), AttributeValue::Text(value));
            }
        }
    }
    Ok(Header::new(Text::from(""), (layers.width, layers.height), described)
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(attributes))
}

fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

/// Lays the file out: magic number, flags, attributes by name, table of offsets, blocks.
fn write_file(header: Header, channels: &[(String, &[f32])]) -> exr::error::Result<Vec<u8>> {
    let headers = [header];
    let mut requirements = MetaData::validate(&headers, true)?;
    requirements.has_long_names |= channels.iter().any(|(name, _)| name.len() > 31);
    let width = headers[0].layer_size.width();
    let blocks: Vec<BlockIndex> = enumerate_ordered_header_block_indices(&headers).map(|(_, block)| block).collect();
    let chunks: Vec<Vec<u8>> = blocks
        .into_par_iter()
        .map(|block| {
            let copy_line = |line: LineRefMut<'_>| {
                let Vec2(x, y) = line.location.position;
                let start = y * width + x;
                let samples = &channels[line.location.channel].1[start..start + line.location.sample_count];
                for (bytes, sample) in line.value.as_chunks_mut::<4>().0.iter_mut().zip(samples) {
                    *bytes = sample.to_ne_bytes();
                }
            };
            let block = UncompressedBlock::from_lines(&headers[0].channels, block, copy_line);
            let mut bytes = Vec::new();
            block.compress_to_chunk(&headers)?.write(&mut bytes, headers.len())?;
            Ok(bytes)
        })
        .collect::<exr::error::Result<_>>()?;

    let mut file = Vec::new();
    magic_number::write(&mut file)?;
    requirements.write(&mut file)?;
    // The crate keeps free attributes in a hash map, whose order changes from run to run: sorted, the bytes are the same.
    let mut named: Vec<_> = headers[0].all_named_attributes().collect();
    named.sort_by(|a, b| a.0.cmp(b.0));
    for (name, value) in &named {
        attribute::write(name, value, &mut file)?;
    }
    sequence_end::write(&mut file)?;
    let mut offset = file.len() + 8 * chunks.len();
    for chunk in &chunks {
        file.extend_from_slice(&(offset as u64).to_le_bytes());
        offset += chunk.len();
    }
    file.reserve_exact(offset - file.len());
    chunks.iter().for_each(|chunk| file.extend_from_slice(chunk));
    if file.len() != offset {
        return Err(CodecError::Invalid("the table of offsets does not fit the blocks".into()));
    }
    Ok(file)
}
