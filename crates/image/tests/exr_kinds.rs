//! Every kind of EXR that other programs write: compressions, sample types, tiles, windows, parts, odd channels.

use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, Layer as ExrLayer};
use exr::math::RoundingMode;
use exr::meta::attribute::{Chromaticities, IntegerBounds, LineOrder};
use exr::meta::header::{ImageAttributes, LayerAttributes};
use exr::prelude::{Blocks, Compression, Levels, SmallVec, Vec2, WritableImage, f16};
use photinus_image::{ImageErrorKind, Texels, decode_bytes, image_from_bytes, layers_from_bytes};
use std::io::Cursor;

const WIDTH: usize = 70;
const HEIGHT: usize = 45;

#[derive(Clone, Copy, Debug)]
enum Samples {
    Half,
    Float,
    Uint,
}

/// A value that each of the three types holds exactly.
fn value(channel: usize, i: usize) -> f32 {
    ((channel * 31 + i * 7) % 2048) as f32
}

fn channel(name: &str, index: usize, kind: Samples) -> AnyChannel<FlatSamples> {
    let values = (0..WIDTH * HEIGHT).map(|i| value(index, i));
    let samples = match kind {
        Samples::Half => FlatSamples::F16(values.map(f16::from_f32).collect()),
        Samples::Float => FlatSamples::F32(values.collect()),
        Samples::Uint => FlatSamples::U32(values.map(|v| v as u32).collect()),
    };
    AnyChannel::new(name, samples)
}

fn layer(
    name: Option<&str>,
    channels: &[(&str, Samples)],
    compression: Compression,
    blocks: Blocks,
    line_order: LineOrder,
    position: Vec2<i32>,
) -> ExrLayer<AnyChannels<FlatSamples>> {
    let list: SmallVec<[_; 4]> = channels.iter().enumerate().map(|(i, (name, kind))| channel(name, i, *kind)).collect();
    let mut attributes = LayerAttributes { layer_position: position, ..LayerAttributes::default() };
    attributes.layer_name = name.map(Into::into);
    ExrLayer::new((WIDTH, HEIGHT), attributes, Encoding { compression, blocks, line_order }, AnyChannels::sort(list))
}

fn file(layers: Vec<ExrLayer<AnyChannels<FlatSamples>>>, display: IntegerBounds) -> Vec<u8> {
    let mut attributes = ImageAttributes::new(display);
    // Other primaries are accepted and taken for Rec. 709.
    attributes.chromaticities = Some(Chromaticities {
        red: Vec2(0.7, 0.3),
        green: Vec2(0.2, 0.7),
        blue: Vec2(0.1, 0.1),
        white: Vec2(0.31, 0.33),
    });
    let layer_data = SmallVec::<[_; 2]>::from_vec(layers);
    let mut bytes = Vec::new();
    ExrImage { attributes, layer_data }.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).unwrap();
    bytes
}

fn whole() -> IntegerBounds {
    IntegerBounds::from_dimensions((WIDTH, HEIGHT))
}

#[test]
fn every_kind_gives_its_pixels() {
    let lossless =
        [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ];
    let mut kinds = 0;
    for compression in lossless {
        for kind in [Samples::Half, Samples::Float, Samples::Uint] {
            for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 16)), Blocks::Tiles(Vec2(64, 32))] {
                for line_order in [LineOrder::Increasing, LineOrder::Decreasing] {
                    for position in [Vec2(0, 0), Vec2(-13, 1000)] {
                        let channels = [("B", kind), ("G", kind), ("R", kind)];
                        let bytes =
                            file(vec![layer(None, &channels, compression, blocks, line_order, position)], whole());
                        let image = image_from_bytes(&bytes, "memory").unwrap();
                        assert_eq!((image.width, image.height), (WIDTH, HEIGHT));
                        for (i, pixel) in image.pixels.iter().enumerate() {
                            let expected = [value(2, i), value(1, i), value(0, i)];
                            assert_eq!(*pixel, expected, "{compression} {kind:?} {blocks:?} {line_order:?} pixel {i}");
                        }
                        kinds += 1;
                    }
                }
            }
        }
    }
    assert_eq!(kinds, 180);
}

fn simple(channels: &[(&str, Samples)]) -> Vec<u8> {
    let layer = layer(None, channels, Compression::ZIP16, Blocks::ScanLines, LineOrder::Increasing, Vec2(0, 0));
    file(vec![layer], whole())
}

#[test]
fn grey_alpha_and_unusual_channels() {
    let grey = image_from_bytes(&simple(&[("Y", Samples::Half)]), "memory").unwrap();
    assert_eq!(grey.at(3, 0), [value(0, 3); 3]);
    let only = image_from_bytes(&simple(&[("density", Samples::Float)]), "memory").unwrap();
    assert_eq!(only.at(3, 0), [value(0, 3); 3]);
    let decoded = decode_bytes(&simple(&[("A", Samples::Half), ("Y", Samples::Float)]), "memory").unwrap();
    assert!(decoded.has_alpha && decoded.is_grey);
    let Texels::RgbaF32(texels) = decoded.texels else { panic!("EXR is floating point") };
    assert_eq!(texels[5], [value(1, 5), value(1, 5), value(1, 5), value(0, 5)]);
    let error = image_from_bytes(&simple(&[("U", Samples::Half), ("V", Samples::Half)]), "memory").unwrap_err();
    assert_eq!(error.kind, ImageErrorKind::Unsupported, "{error}");
}

#[test]
fn parts_and_prefixes_become_layers() {
    let parts = vec![
        layer(
            Some("beauty"),
            &[("B", Samples::Half), ("G", Samples::Half), ("R", Samples::Half)],
            Compression::ZIP16,
            Blocks::ScanLines,
            LineOrder::Increasing,
            Vec2(0, 0),
        ),
        layer(
            Some("extra"),
            &[("Z", Samples::Float), ("albedo.diffuse.R", Samples::Half)],
            Compression::RLE,
            Blocks::Tiles(Vec2(32, 32)),
            LineOrder::Increasing,
            Vec2(0, 0),
        ),
    ];
    let bytes = file(parts, whole());
    let layers = layers_from_bytes(&bytes, "memory").unwrap();
    let names: Vec<_> = layers.layers.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["beauty", "extra", "albedo.diffuse"]);
    assert_eq!(layers.channel("beauty.R").unwrap()[9], value(2, 9));
    assert_eq!(layers.channel("extra.Z").unwrap()[9], value(0, 9));
    assert_eq!(layers.channel("albedo.diffuse.R").unwrap()[9], value(1, 9));
    // No layer without a name: the picture is the first with colours.
    assert_eq!(image_from_bytes(&bytes, "memory").unwrap().pixels[9], [value(2, 9), value(1, 9), value(0, 9)]);
}

/// The chunk-by-chunk checks: a file cut anywhere is an error; so is one with a block twice.
#[test]
fn truncated_and_repeated_blocks_are_errors() {
    let bytes = simple(&[("B", Samples::Float), ("G", Samples::Float), ("R", Samples::Float)]);
    for length in (0..bytes.len()).step_by(97).chain([bytes.len() - 1]) {
        let error = layers_from_bytes(&bytes[..length], "memory").unwrap_err();
        assert!(matches!(error.kind, ImageErrorKind::Malformed | ImageErrorKind::Unsupported), "{length}: {error}");
        assert!(!error.what.contains("gave up"), "{length}: {error}");
    }
    // 45 lines in blocks of 16: the y coordinates 0, 16, 32 stand at the offsets of the table, three entries before
    // the first block.
    let position = bytes.len();
    let entry = |i: usize, first: usize| {
        let at = first + 8 * i;
        u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize
    };
    // The table is found by its first entry pointing at its own end.
    let table = (0..position - 24).find(|&at| entry(0, at) == at + 24).unwrap();
    let mut repeated = bytes.clone();
    let second = entry(1, table);
    repeated[second..second + 4].copy_from_slice(&0i32.to_le_bytes());
    assert!(layers_from_bytes(&repeated, "memory").unwrap_err().what.contains("twice"));
}

#[test]
fn mip_maps_give_the_largest_level() {
    // Levels of 70 x 45, 35 x 22, ... 1 x 1, rounded down; the smaller ones hold another value.
    let sizes = (0..7).map(|level| (WIDTH >> level, HEIGHT >> level)).map(|(w, h)| w.max(1) * h.max(1));
    let levels = |index: usize| -> Vec<FlatSamples> {
        let full: Vec<f32> = (0..WIDTH * HEIGHT).map(|i| value(index, i)).collect();
        let smaller = sizes.clone().skip(1).map(|n| FlatSamples::F32(vec![-1.0; n]));
        std::iter::once(FlatSamples::F32(full)).chain(smaller).collect()
    };
    let channels: SmallVec<[_; 4]> = ["B", "G", "R"]
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let samples = Levels::Mip { rounding_mode: RoundingMode::Down, level_data: levels(i) };
            AnyChannel::new(*name, samples)
        })
        .collect();
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::Tiles(Vec2(16, 16)),
        line_order: LineOrder::Increasing,
    };
    let layer = ExrLayer::new((WIDTH, HEIGHT), LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    let mut bytes = Vec::new();
    ExrImage::from_layer(layer).write().non_parallel().to_buffered(Cursor::new(&mut bytes)).unwrap();
    let image = image_from_bytes(&bytes, "memory").unwrap();
    assert_eq!((image.width, image.height), (WIDTH, HEIGHT));
    for (i, pixel) in image.pixels.iter().enumerate() {
        assert_eq!(*pixel, [value(2, i), value(1, i), value(0, i)], "pixel {i}");
    }
}

/// Headers that declare what is not read, or more than there may be, are refused before anything is allocated.
#[test]
fn declared_subsampling_and_absurd_sizes_are_refused() {
    let bytes = simple(&[("B", Samples::Float), ("G", Samples::Float), ("R", Samples::Float)]);
    let find = |pattern: &[u8]| bytes.windows(pattern.len()).position(|w| w == pattern).unwrap();
    // After a channel's name: type, four bytes of flags, then the two sampling rates.
    let mut subsampled = bytes.clone();
    let rates = find(b"B\0\x02\0\0\0") + 2 + 8;
    subsampled[rates..rates + 8].copy_from_slice(&[2, 0, 0, 0, 2, 0, 0, 0]);
    let error = layers_from_bytes(&subsampled, "memory").unwrap_err();
    assert!(error.kind == ImageErrorKind::Unsupported && error.what.contains("subsampled"), "{error}");
    // The data window: type name, size, then x and y of its corners.
    let window = find(b"dataWindow\0box2i\0") + 17 + 4;
    for (max_x, max_y) in [(1 << 20, 1 << 20), (1 << 29, 0), (0, 1 << 29), (16383, 16383), (i32::MAX - 1, i32::MAX - 1)]
    {
        let mut huge = bytes.clone();
        huge[window + 8..window + 12].copy_from_slice(&i32::to_le_bytes(max_x));
        huge[window + 12..window + 16].copy_from_slice(&i32::to_le_bytes(max_y));
        let error = layers_from_bytes(&huge, "memory").unwrap_err();
        assert!(matches!(error.kind, ImageErrorKind::TooLarge | ImageErrorKind::Malformed), "{max_x} {max_y}: {error}");
        assert!(!error.what.contains("gave up"), "{error}");
    }
}
