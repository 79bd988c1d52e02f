//! What is written is read back: EXR bit by bit, PNG to the nearest of 256 codes.

use photinus_image::colour::{linear_to_srgb, srgb_to_linear};
use photinus_image::tonemap::{TONEMAPS, Tonemap};
use photinus_image::{Image, ImageErrorKind, Layers, Texels, decode_bytes, encode_exr, encode_png};
use photinus_image::{image_from_bytes, layers_from_bytes};

/// Samples of every kind: both zeros, denormals, huge, infinite, NaN.
fn awkward_samples(count: usize) -> Vec<f32> {
    let special = [0.0, -0.0, 1.0, -1.5, f32::MIN_POSITIVE / 3.0, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    (0..count).map(|i| if i % 3 == 0 { special[i / 3 % special.len()] } else { i as f32 * 0.37 - 5.0 }).collect()
}

fn sample_layers(width: usize, height: usize) -> Layers {
    let n = width * height;
    let rgb: Vec<[f32; 3]> = awkward_samples(3 * n).as_chunks::<3>().0.to_vec();
    let mut layers = Layers::new(width, height);
    layers.push_rgb("", &rgb);
    layers.push_rgb("albedo", &rgb);
    layers.push_vectors("normal", ["X", "Y", "Z"], &rgb);
    layers.push_channel("depth", "Z", awkward_samples(n));
    layers.push_channel("objectId", "id", (0..n).map(|i| i as f32).collect());
    layers.push_channel("a layer with a name of more than thirty-one bytes", "value", awkward_samples(n));
    for (key, value) in
        [("photinus:passes", "32"), ("photinus:seed", "7"), ("software", "Photinus"), ("z", ""), ("ä", "ö")]
    {
        layers.metadata.insert(key.to_string(), value.to_string());
    }
    layers
}

fn bits(samples: &[f32]) -> Vec<u32> {
    samples.iter().map(|s| s.to_bits()).collect()
}

#[test]
fn exr_layers_come_back_bit_by_bit() {
    for (width, height) in [(1, 1), (3, 16), (16, 17), (97, 61), (1, 100), (300, 2)] {
        let layers = sample_layers(width, height);
        let bytes = encode_exr(&layers).unwrap();
        assert_eq!(bytes, encode_exr(&layers).unwrap(), "same bytes on a second run");
        let back = layers_from_bytes(&bytes, "memory").unwrap();
        assert_eq!((back.width, back.height), (width, height));
        assert_eq!(back.metadata, layers.metadata);
        assert_eq!(back.layers.len(), layers.layers.len());
        for layer in &layers.layers {
            for channel in &layer.channels {
                let dot = if layer.name.is_empty() { "" } else { "." };
                let name = format!("{}{dot}{}", layer.name, channel.name);
                let read = back.channel(&name).unwrap_or_else(|| panic!("{name} is missing"));
                assert_eq!(bits(read), bits(&channel.samples), "{name} at {width} x {height}");
            }
        }
        let image = image_from_bytes(&bytes, "memory").unwrap();
        assert_eq!(bits(image.pixels.as_flattened()), bits(layers.image("").unwrap().pixels.as_flattened()));
    }
}

#[test]
fn exr_bytes_do_not_depend_on_threads() {
    let layers = sample_layers(97, 61);
    let encode = |threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| encode_exr(&layers).unwrap())
    };
    let one = encode(1);
    assert_eq!(one, encode(2));
    assert_eq!(one, encode(7));
}

#[test]
fn wrong_layers_are_refused() {
    let mut layers = sample_layers(4, 4);
    layers.push_channel("depth", "Z", vec![0.0; 16]);
    assert_eq!(encode_exr(&layers).unwrap_err().kind, ImageErrorKind::Mismatch);
    let mut layers = sample_layers(4, 4);
    layers.push_channel("short", "Z", vec![0.0; 15]);
    assert!(encode_exr(&layers).unwrap_err().to_string().contains("15 samples"));
    for key in ["channels", "", "dataWindow"] {
        let mut layers = sample_layers(4, 4);
        layers.metadata.insert(key.to_string(), "x".to_string());
        assert_eq!(encode_exr(&layers).unwrap_err().kind, ImageErrorKind::Mismatch, "{key:?}");
    }
    assert!(encode_exr(&Layers::new(0, 4)).is_err());
}

#[test]
fn png_comes_back_to_the_nearest_code() {
    let codes: Vec<[u8; 3]> = (0..=255u8).map(|i| [i, 255 - i, i / 2]).collect();
    let pixels = codes.iter().map(|c| c.map(|c| srgb_to_linear(f32::from(c) / 255.0))).collect();
    let image = Image { width: 16, height: 16, pixels };
    let bytes = encode_png(&image, Tonemap::default(), 0.0).unwrap();
    let decoded = decode_bytes(&bytes, "memory").unwrap();
    assert_eq!((decoded.width, decoded.height, decoded.has_alpha, decoded.is_grey), (16, 16, false, false));
    let expected: Vec<[u8; 4]> = codes.iter().map(|c| [c[0], c[1], c[2], 255]).collect();
    assert_eq!(decoded.texels, Texels::Rgba8(expected));
    assert_eq!(image_from_bytes(&bytes, "memory").unwrap(), image);
}

#[test]
fn exposure_is_in_stops() {
    let image = Image::filled(2, 2, [0.1, 0.2, 0.05]);
    let brighter = Image::filled(2, 2, [0.4, 0.8, 0.2]);
    for tonemap in TONEMAPS {
        assert_eq!(encode_png(&image, *tonemap, 2.0).unwrap(), encode_png(&brighter, *tonemap, 0.0).unwrap());
    }
}

#[test]
fn srgb_curve_matches_the_standard() {
    // IEC 61966-2-1: the published pairs of the curve's ends and of mid-grey.
    for (encoded, linear) in [(0.0, 0.0), (0.04045, 0.003_130_8), (0.5, 0.214_041_14), (1.0, 1.0)] {
        assert!((srgb_to_linear(encoded) - linear).abs() < 1e-6, "{encoded}");
        assert!((linear_to_srgb(linear) - encoded).abs() < 1e-5, "{linear}");
    }
}
