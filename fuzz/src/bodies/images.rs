//! Image files: as a picture, as a texture and, for EXR, as layers.

use super::sound::{check_decoded, check_image};
use exr::image::{Encoding, Image as ExrImage, Layer as ExrLayer, SpecificChannels};
use exr::meta::attribute::LineOrder;
use exr::meta::header::LayerAttributes;
use exr::prelude::{Blocks, Compression, Vec2, WritableImage, f16};
use image::codecs::{bmp::BmpEncoder, hdr::HdrEncoder, jpeg::JpegEncoder, tga::TgaEncoder};
use image::{DynamicImage, ExtendedColorType, ImageEncoder, ImageFormat, Rgb};
use photinus::image::{Image, Layers, decode_bytes, encode_exr, image_from_bytes, layers_from_bytes};
use std::io::Cursor;

/// Reads the bytes in every way; `name` gives the extension.
fn read(data: &[u8], name: &str) {
    let (picture, texture) = (image_from_bytes(data, name), decode_bytes(data, name));
    assert_eq!(picture.is_ok(), texture.is_ok(), "a picture and a texture are the same file");
    if let Ok(picture) = picture {
        check_image(&picture);
    }
    if let Ok(texture) = texture {
        check_decoded(&texture);
    }
    if let Ok(layers) = layers_from_bytes(data, name) {
        for channel in layers.layers.iter().flat_map(|layer| &layer.channels) {
            assert_eq!(channel.samples.len(), layers.width * layers.height);
        }
    }
}

pub fn exr(data: &[u8]) {
    read(data, "a.exr");
}

pub fn png(data: &[u8]) {
    read(data, "a.png");
}

pub fn jpeg(data: &[u8]) {
    read(data, "a.jpg");
}

pub fn hdr(data: &[u8]) {
    read(data, "a.hdr");
}

pub fn bmp(data: &[u8]) {
    read(data, "a.bmp");
}

pub fn tga(data: &[u8]) {
    read(data, "a.tga");
}

const WIDTH: u32 = 11;
const HEIGHT: u32 = 9;

fn samples() -> Vec<u8> {
    (0..WIDTH * HEIGHT * 3).map(|i| (i * 7 % 251) as u8).collect()
}

fn picture() -> DynamicImage {
    DynamicImage::ImageRgb8(image::RgbImage::from_raw(WIDTH, HEIGHT, samples()).expect("as many samples as pixels"))
}

fn written(encoder: impl FnOnce(&mut Cursor<Vec<u8>>) -> image::ImageResult<()>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    encoder(&mut bytes).expect("memory takes all");
    bytes.into_inner()
}

/// Every depth and colour type that the encoder knows.
pub fn png_seeds() -> Vec<Vec<u8>> {
    let p = picture();
    let kinds = [
        p.clone(),
        DynamicImage::ImageLuma8(p.to_luma8()),
        DynamicImage::ImageLumaA8(p.to_luma_alpha8()),
        DynamicImage::ImageRgba8(p.to_rgba8()),
        DynamicImage::ImageRgb16(p.to_rgb16()),
        DynamicImage::ImageRgba16(p.to_rgba16()),
        DynamicImage::ImageLuma16(p.to_luma16()),
    ];
    kinds.iter().map(|kind| written(|w| kind.write_to(w, ImageFormat::Png))).collect()
}

pub fn jpeg_seeds() -> Vec<Vec<u8>> {
    let grey = picture().to_luma8().into_raw();
    vec![
        written(|w| JpegEncoder::new(w).write_image(&samples(), WIDTH, HEIGHT, ExtendedColorType::Rgb8)),
        written(|w| JpegEncoder::new_with_quality(w, 20).write_image(&grey, WIDTH, HEIGHT, ExtendedColorType::L8)),
    ]
}

pub fn bmp_seeds() -> Vec<Vec<u8>> {
    let (grey, rgba) = (picture().to_luma8().into_raw(), picture().to_rgba8().into_raw());
    vec![
        written(|w| BmpEncoder::new(w).write_image(&samples(), WIDTH, HEIGHT, ExtendedColorType::Rgb8)),
        written(|w| BmpEncoder::new(w).write_image(&grey, WIDTH, HEIGHT, ExtendedColorType::L8)),
        written(|w| BmpEncoder::new(w).write_image(&rgba, WIDTH, HEIGHT, ExtendedColorType::Rgba8)),
    ]
}

/// With runs and without.
pub fn tga_seeds() -> Vec<Vec<u8>> {
    let grey = picture().to_luma8().into_raw();
    vec![
        written(|w| TgaEncoder::new(w).write_image(&samples(), WIDTH, HEIGHT, ExtendedColorType::Rgb8)),
        written(|w| TgaEncoder::new(w).disable_rle().write_image(&samples(), WIDTH, HEIGHT, ExtendedColorType::Rgb8)),
        written(|w| TgaEncoder::new(w).write_image(&grey, WIDTH, HEIGHT, ExtendedColorType::L8)),
    ]
}

pub fn hdr_seeds() -> Vec<Vec<u8>> {
    let pixels: Vec<Rgb<f32>> = samples().chunks(3).map(|p| Rgb([p[0], p[1], p[2]].map(f32::from))).collect();
    vec![
        written(|w| HdrEncoder::new(w).encode(&pixels, WIDTH as usize, HEIGHT as usize)),
        // Lines of fewer than eight pixels have no runs.
        written(|w| HdrEncoder::new(w).encode(&pixels[..6], 3, 2)),
    ]
}

/// Our own writer's file with layers, and one for each way of compressing: lines for some, tiles for the others.
pub fn exr_seeds() -> Vec<Vec<u8>> {
    let pixels: Vec<[f32; 3]> = samples().chunks(3).map(|p| [p[0], p[1], p[2]].map(f32::from)).collect();
    let linear = Image { width: WIDTH as usize, height: HEIGHT as usize, pixels };
    let mut layers = Layers::from_image(&linear);
    layers.metadata.insert("seed".to_string(), "7".to_string());
    let mut seeds = vec![encode_exr(&layers).expect("memory takes all")];
    let kinds = [
        Compression::RLE,
        Compression::ZIP1,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
        Compression::B44A,
        Compression::DWAA(None),
        Compression::DWAB(None),
        Compression::Uncompressed,
    ];
    for (i, compression) in kinds.into_iter().enumerate() {
        let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
            let [r, g, b] = linear.at(at.0, at.1).map(|c| f16::from_f32(c / 250.0));
            (r, g, b)
        });
        let blocks = if i % 2 == 0 { Blocks::ScanLines } else { Blocks::Tiles(Vec2(8, 8)) };
        let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
        let layer = ExrLayer::new((linear.width, linear.height), LayerAttributes::named("rgb"), encoding, channels);
        let mut bytes = Vec::new();
        let image = ExrImage::from_layer(layer);
        image.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).expect("memory takes all");
        seeds.push(bytes);
    }
    seeds
}
