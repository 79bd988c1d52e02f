//! OpenEXR through the `exr` crate's block level: headers first, then sizes, then one block after another.

use super::dwa;
use super::guarded;
use super::texels::{DecodedImage, Texels};
use crate::error::{ImageError, Result};
use crate::image::{Channel, Image, Layer, Layers, split_channel_name};
use crate::limits::Limits;
use exr::block::UncompressedBlock;
use exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock};
use exr::error::Error as CodecError;
use exr::meta::attribute::{AttributeValue, SampleType, Text};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::{Compression, Vec2, f16};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::path::Path;

/// Chunks decompressed at a time: bounds the memory of decompressed blocks in flight.
const BATCH: usize = 64;

/// Reads all parts and channels at full resolution; smaller levels of mip maps are left out.
pub(super) fn read(bytes: &[u8], path: &Path, limits: Limits) -> Result<Layers> {
    let mut cursor = Cursor::new(bytes);
    let meta = MetaData::read_from_buffered(&mut cursor, false).map_err(|error| codec_error(path, error))?;
    check_headers(&meta, path, limits, bytes.len())?;
    MetaData::validate(&meta.headers, false).map_err(|error| codec_error(path, error))?;

    let mut planes: Vec<Vec<Vec<f32>>> = meta
        .headers
        .iter()
        .map(|header| vec![vec![0.0; header.layer_size.area()]; header.channels.list.len()])
        .collect();
    let chunk_count: u64 = meta.headers.iter().map(|header| header.chunk_count as u64).sum();
    // The table of offsets is skipped: chunks lie one after another, and tables of interrupted files are empty.
    let first_chunk = cursor.position().saturating_add(chunk_count.saturating_mul(8));
    let chunks = full_resolution_chunks(bytes, first_chunk, chunk_count, &meta, path)?;
    let mut missing: Vec<usize> = meta.headers.iter().map(|header| header.layer_size.area()).collect();
    for batch in chunks.chunks(BATCH) {
        // Each guarded on the thread that it is on.
        let unpack =
            |chunk: &&[u8]| guarded(path, || decompress(chunk, &meta).map_err(|error| codec_error(path, error)));
        let blocks: Vec<_> = batch.par_iter().map(unpack).collect();
        for block in blocks {
            let block = block?;
            let part = block.index.layer;
            missing[part] = missing[part].saturating_sub(block.index.pixel_size.area());
            copy_block(&block, &meta.headers[part], &mut planes[part])
                .ok_or_else(|| ImageError::malformed(path, "a block of pixels has the wrong size"))?;
        }
    }
    if let Some(missing) = missing.iter().find(|missing| **missing > 0) {
        return Err(ImageError::malformed(path, format!("{missing} pixels of the image are missing")));
    }
    Ok(layers(&meta, planes))
}

/// Refuses what is not read here, and sizes beyond the limits, before anything is allocated.
fn check_headers(meta: &MetaData, path: &Path, limits: Limits, file_bytes: usize) -> Result<()> {
    let Some(first) = meta.headers.first() else {
        return Err(ImageError::malformed(path, "the EXR file has no parts"));
    };
    let mut bytes_per_pixel = 0;
    for header in &meta.headers {
        if header.deep || meta.requirements.has_deep_data {
            return Err(ImageError::unsupported(path, "deep EXR images are not read", "flatten the image"));
        }
        if header.channels.list.is_empty() {
            return Err(ImageError::malformed(path, "the EXR file has no channels"));
        }
        if let Some(channel) = header.channels.list.iter().find(|channel| channel.sampling != Vec2(1, 1)) {
            return Err(ImageError::unsupported(
                path,
                format!(
                    "channel {:?} is subsampled ({} x {})",
                    utf8(&channel.name),
                    channel.sampling.0,
                    channel.sampling.1
                ),
                "save the image as RGB without subsampling",
            ));
        }
        if header.layer_size != first.layer_size {
            return Err(ImageError::unsupported(
                path,
                "the parts of the EXR file differ in size",
                "save the parts as separate files",
            ));
        }
        bytes_per_pixel += 4 * header.channels.list.len() as u64;
    }
    let Vec2(width, height) = first.layer_size;
    limits.check(path, width as u64, height as u64, bytes_per_pixel, file_bytes)
}

/// The byte ranges of the chunks of the full resolution, each place at most once.
fn full_resolution_chunks<'a>(
    bytes: &'a [u8],
    first_chunk: u64,
    chunk_count: u64,
    meta: &MetaData,
    path: &Path,
) -> Result<Vec<&'a [u8]>> {
    let truncated = || ImageError::malformed(path, "the EXR file ends too early");
    let mut rest = usize::try_from(first_chunk).ok().and_then(|at| bytes.get(at..)).ok_or_else(truncated)?;
    let mut seen = BTreeSet::new();
    let mut chunks = Vec::new();
    for _ in 0..chunk_count {
        let word = |index: usize| -> Result<i32> {
            let bytes = rest.get(4 * index..4 * index + 4).ok_or_else(truncated)?;
            Ok(i32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
        };
        let part_words = usize::from(meta.requirements.has_multiple_layers);
        let part = if part_words == 1 { word(0)? } else { 0 };
        let header = usize::try_from(part).ok().and_then(|part| meta.headers.get(part)).ok_or_else(|| {
            ImageError::malformed(path, format!("a block belongs to part {part}, which is not there"))
        })?;
        let place_words = if matches!(header.blocks, BlockDescription::Tiles(_)) { 4 } else { 1 };
        let mut place = [part, 0, 0, 0, 0];
        for index in 0..place_words {
            place[1 + index] = word(part_words + index)?;
        }
        let data_bytes = usize::try_from(word(part_words + place_words)?)
            .map_err(|_| ImageError::malformed(path, "a block has a negative length"))?;
        let length = (4 * (part_words + place_words + 1)).saturating_add(data_bytes);
        let chunk = rest.get(..length).ok_or_else(truncated)?;
        rest = &rest[length..];
        // The last two words of a tile's place are its level; scan lines have level 0.
        if place[3] == 0 && place[4] == 0 {
            if !seen.insert(place) {
                return Err(ImageError::malformed(path, "a block of pixels is there twice"));
            }
            chunks.push(chunk);
        }
    }
    Ok(chunks)
}

fn decompress(mut chunk: &[u8], meta: &MetaData) -> exr::error::Result<UncompressedBlock> {
    let chunk = Chunk::read(&mut chunk, meta)?;
    let header = &meta.headers[chunk.layer_index];
    if matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        let place = header.get_block_data_indices(&chunk.compressed_block)?;
        let size = header.get_absolute_block_pixel_coordinates(place)?.size;
        if let CompressedBlock::ScanLine(CompressedScanLineBlock { compressed_pixels_le: data, .. })
        | CompressedBlock::Tile(CompressedTileBlock { compressed_pixels_le: data, .. }) = &chunk.compressed_block
        {
            dwa::check(data, size, header)?;
        }
    }
    UncompressedBlock::decompress_chunk(chunk, meta, false)
}

/// Copies a block into the planes of its part; `None` where its bytes do not fit its place.
fn copy_block(block: &UncompressedBlock, header: &Header, planes: &mut [Vec<f32>]) -> Option<()> {
    let Vec2(width, height) = header.layer_size;
    let Vec2(x, y) = block.index.pixel_position;
    let Vec2(block_width, block_height) = block.index.pixel_size;
    if x.checked_add(block_width)? > width || y.checked_add(block_height)? > height {
        return None;
    }
    let mut rest = block.data.as_slice();
    for row in y..y + block_height {
        for (channel, plane) in header.channels.list.iter().zip(planes.iter_mut()) {
            let target = &mut plane[row * width + x..row * width + x + block_width];
            let (line, after) = rest.split_at_checked(block_width * channel.sample_type.bytes_per_sample())?;
            rest = after;
            match channel.sample_type {
                SampleType::F16 => convert(line, target, |b: [u8; 2]| f16::from_ne_bytes(b).to_f32()),
                SampleType::F32 => convert(line, target, f32::from_ne_bytes),
                SampleType::U32 => convert(line, target, |b: [u8; 4]| u32::from_ne_bytes(b) as f32),
            }
        }
    }
    Some(())
}

fn convert<const N: usize>(line: &[u8], target: &mut [f32], sample: impl Fn([u8; N]) -> f32) {
    for (bytes, target) in line.as_chunks::<N>().0.iter().zip(target) {
        *target = sample(*bytes);
    }
}

/// Sorts the channels of all parts into layers: by the prefix of the channel's name, else by the name of its part.
fn layers(meta: &MetaData, planes: Vec<Vec<Vec<f32>>>) -> Layers {
    let size = meta.headers[0].layer_size;
    let mut result = Layers::new(size.0, size.1);
    for (header, planes) in meta.headers.iter().zip(planes) {
        let part_name = match (&header.own_attributes.layer_name, meta.headers.len()) {
            (Some(name), 2..) => utf8(name),
            _ => String::new(),
        };
        for (channel, samples) in header.channels.list.iter().zip(planes) {
            let full_name = utf8(&channel.name);
            let (prefix, name) = split_channel_name(&full_name);
            let layer_name = if prefix.is_empty() { part_name.as_str() } else { prefix };
            let channel = Channel { name: name.to_string(), samples };
            match result.layers.iter_mut().find(|layer| layer.name == layer_name) {
                Some(layer) => layer.channels.push(channel),
                None => result.layers.push(Layer { name: layer_name.to_string(), channels: vec![channel] }),
            }
        }
        result.metadata.extend(text_attributes(header));
    }
    result
}

fn text_attributes(header: &Header) -> BTreeMap<String, String> {
    let own = &header.own_attributes;
    let standard = [("software", &own.software_name), ("comments", &own.comments), ("owner", &own.owner)];
    let standard = standard.into_iter().filter_map(|(key, text)| Some((key.to_string(), text.as_ref()?)));
    let custom = own.other.iter().chain(&header.shared_attributes.other).filter_map(|(key, value)| match value {
        AttributeValue::Text(text) => Some((utf8(key), text)),
        _ => None,
    });
    standard.chain(custom).map(|(key, text)| (key, utf8(text))).collect()
}

fn utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

/// The layer that shows the picture: the one without a name, else the first that has colours.
fn picture_layer(layers: &Layers, path: &Path) -> Result<String> {
    let names = layers.layers.iter().map(|layer| layer.name.as_str());
    std::iter::once("")
        .chain(names)
        .find(|name| layers.image(name).is_some())
        .map(str::to_string)
        .ok_or_else(|| ImageError::unsupported(path, "no layer has channels R, G, B or Y", "save the image as RGB"))
}

/// The picture among the layers.
pub(super) fn picture(layers: Layers, path: &Path) -> Result<Image> {
    let name = picture_layer(&layers, path)?;
    layers.image(&name).ok_or_else(|| ImageError::malformed(path, "the picture's channels are incomplete"))
}

/// The picture as a texture with alpha.
pub(super) fn texels(layers: Layers, path: &Path) -> Result<DecodedImage> {
    let name = picture_layer(&layers, path)?;
    let layer = layers.layer(&name);
    let find = |wanted: &str| {
        layer?.channels.iter().find(|channel| channel.name.eq_ignore_ascii_case(wanted)).map(|c| c.samples.as_slice())
    };
    let alpha = find("A");
    let is_grey = find("R").is_none();
    let image = layers.image(&name).unwrap_or_default();
    let texels =
        image.pixels.iter().enumerate().map(|(i, p)| [p[0], p[1], p[2], alpha.map_or(1.0, |a| a[i])]).collect();
    Ok(DecodedImage {
        width: image.width,
        height: image.height,
        has_alpha: alpha.is_some(),
        is_grey,
        texels: Texels::RgbaF32(texels),
    })
}

fn codec_error(path: &Path, error: CodecError) -> ImageError {
    match error {
        CodecError::NotSupported(what) => ImageError::unsupported(
            path,
            format!("this kind of EXR is not read ({what})"),
            "save the image as a flat EXR with ZIP compression",
        ),
        CodecError::Invalid(what) => ImageError::malformed(path, format!("the EXR data are damaged ({what})")),
        other => ImageError::malformed(path, format!("the EXR data are damaged ({other})")),
    }
}
