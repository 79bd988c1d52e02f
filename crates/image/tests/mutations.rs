//! Damaged files of every format: a byte changed, a piece cut, a word made huge. Each is an error or an image, in
//! bounded time, and no decoder panics.
// Whoever runs the tests must see what did not run, and the seed.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use exr::image::{Encoding, Image as ExrImage, Layer as ExrLayer, SpecificChannels};
use exr::meta::attribute::LineOrder;
use exr::meta::header::LayerAttributes;
use exr::prelude::{Blocks, Compression, Vec2, WritableImage, f16};
use image::codecs::{bmp::BmpEncoder, hdr::HdrEncoder, jpeg::JpegEncoder, tga::TgaEncoder};
use image::{DynamicImage, ExtendedColorType, ImageEncoder, ImageFormat, Rgb};
use photinus_image::{Image, Layers, decode_bytes, encode_exr, image_from_bytes, layers_from_bytes};
use std::io::Cursor;
use std::sync::atomic::{AtomicUsize, Ordering};

const SEED: u64 = 0x7068_6f74;
/// Damaged copies of each file.
const ROUNDS: usize = 400;

/// A small generator of its own: the tests need arbitrary, not good, numbers.
struct Arbitrary(u64);

impl Arbitrary {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % bound
    }
}

fn sound_files() -> Vec<(&'static str, Vec<u8>)> {
    let (width, height) = (40u32, 30u32);
    let samples: Vec<u8> = (0..width * height * 3).map(|i| (i * 7 % 251) as u8).collect();
    let rgb = |encoder: &dyn Fn(&mut Cursor<Vec<u8>>)| {
        let mut bytes = Cursor::new(Vec::new());
        encoder(&mut bytes);
        bytes.into_inner()
    };
    let kind = ExtendedColorType::Rgb8;
    let picture = DynamicImage::ImageRgb8(image::RgbImage::from_raw(width, height, samples.clone()).unwrap());
    let hdr: Vec<Rgb<f32>> = samples.chunks(3).map(|p| Rgb([p[0], p[1], p[2]].map(f32::from))).collect();
    let linear = Image { width: width as usize, height: height as usize, pixels: hdr.iter().map(|p| p.0).collect() };
    let mut layers = Layers::from_image(&linear);
    layers.metadata.insert("seed".to_string(), "7".to_string());
    let mut files = exr_files(&linear);
    files.extend([
        ("a.exr", encode_exr(&layers).unwrap()),
        ("a.png", rgb(&|w| picture.write_to(w, ImageFormat::Png).unwrap())),
        ("b.png", rgb(&|w| DynamicImage::ImageRgba16(picture.to_rgba16()).write_to(w, ImageFormat::Png).unwrap())),
        ("a.jpg", rgb(&|w| JpegEncoder::new(w).write_image(&samples, width, height, kind).unwrap())),
        ("a.bmp", rgb(&|w| BmpEncoder::new(w).write_image(&samples, width, height, kind).unwrap())),
        ("a.tga", rgb(&|w| TgaEncoder::new(w).write_image(&samples, width, height, kind).unwrap())),
        ("a.hdr", rgb(&|w| HdrEncoder::new(w).encode(&hdr, width as usize, height as usize).unwrap())),
    ]);
    files
}

/// One file for each way of compressing, in half precision: lines for some, tiles for the others.
fn exr_files(image: &Image) -> Vec<(&'static str, Vec<u8>)> {
    let kinds = [
        ("rle.exr", Compression::RLE),
        ("zips.exr", Compression::ZIP1),
        ("piz.exr", Compression::PIZ),
        ("pxr24.exr", Compression::PXR24),
        ("b44.exr", Compression::B44),
        ("b44a.exr", Compression::B44A),
        ("dwaa.exr", Compression::DWAA(None)),
        ("none.exr", Compression::Uncompressed),
    ];
    let write = |(i, (name, compression)): (usize, (&'static str, Compression))| {
        let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
            let [r, g, b] = image.at(at.0, at.1).map(|c| f16::from_f32(c / 250.0));
            (r, g, b)
        });
        let blocks = if i % 2 == 0 { Blocks::ScanLines } else { Blocks::Tiles(Vec2(16, 16)) };
        let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
        let layer = ExrLayer::new((image.width, image.height), LayerAttributes::named("rgb"), encoding, channels);
        let mut bytes = Vec::new();
        ExrImage::from_layer(layer).write().non_parallel().to_buffered(Cursor::new(&mut bytes)).unwrap();
        (name, bytes)
    };
    kinds.into_iter().enumerate().map(write).collect()
}

fn damage(bytes: &[u8], arbitrary: &mut Arbitrary) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    // Half of all damage goes into the header, where it hurts most.
    let reach = if arbitrary.below(2) == 0 { bytes.len().min(400) } else { bytes.len() };
    for _ in 0..1 + arbitrary.below(4) {
        let at = arbitrary.below(reach.min(bytes.len()));
        match arbitrary.below(6) {
            0 => bytes[at] = arbitrary.below(256) as u8,
            1 => bytes[at] ^= 1 << arbitrary.below(8),
            2 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][arbitrary.below(5)],
            3 => {
                let end = (at + 4).min(bytes.len());
                let word = [[0xff; 4], [0xff, 0xff, 0xff, 0x7f], [0, 0, 0, 0x80], [0; 4]][arbitrary.below(4)];
                bytes[at..end].copy_from_slice(&word[..end - at]);
            }
            4 => {
                let end = (at + 1 + arbitrary.below(9)).min(bytes.len());
                bytes.drain(at..end);
            }
            _ => bytes.truncate(at.max(1)),
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

#[test]
fn damaged_files_are_errors_or_images() {
    let rounds = std::env::var("PHOTINUS_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(ROUNDS);
    let panics = std::sync::Arc::new(AtomicUsize::new(0));
    let counter = panics.clone();
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        counter.fetch_add(1, Ordering::Relaxed);
        eprintln!("{info}");
    }));
    let (mut images, mut errors, mut gave_up) = (0, 0, Vec::new());
    for (name, sound) in sound_files() {
        assert!(image_from_bytes(&sound, name).is_ok(), "{name}");
        let mut arbitrary = Arbitrary(SEED);
        for round in 0..rounds {
            let bytes = damage(&sound, &mut arbitrary);
            match image_from_bytes(&bytes, name) {
                Ok(image) => {
                    assert_eq!(image.pixels.len(), image.width * image.height);
                    images += 1;
                }
                Err(error) => {
                    assert_eq!(error.to_string().lines().count(), 1, "{error}");
                    if error.what.contains("gave up") {
                        gave_up.push(format!("{name} round {round}"));
                    }
                    errors += 1;
                }
            }
            assert_eq!(decode_bytes(&bytes, name).is_ok(), image_from_bytes(&bytes, name).is_ok());
            let _ = layers_from_bytes(&bytes, name);
        }
    }
    std::panic::set_hook(before);
    eprintln!("seed {SEED:#x}: {images} images, {errors} errors, {} panics caught", gave_up.len());
    assert!(images > 0 && errors > 0);
    assert!(gave_up.is_empty(), "decoders panicked: {gave_up:?}");
}

/// The decoder's own message wraps this one and dumps its structures into it.
#[test]
fn a_wrong_checksum_is_named_plainly() {
    let picture = DynamicImage::ImageRgb8(image::RgbImage::new(4, 4));
    let mut png = Cursor::new(Vec::new());
    picture.write_to(&mut png, ImageFormat::Png).unwrap();
    let mut png = png.into_inner();
    // Signature 8, length and name of the first chunk 8, its content 13, then its checksum.
    png[8 + 8 + 13] ^= 1;
    let line = image_from_bytes(&png, "a.png").unwrap_err().to_string();
    assert!(line.starts_with("a.png: the PNG data are damaged (CRC error: expected "), "{line}");
    assert!(!line.contains(['{', '\n']) && line.ends_with("; export the image again or use another file"), "{line}");
}
