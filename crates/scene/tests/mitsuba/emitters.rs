//! Emitters.

use crate::common::*;
use photinus_geometry::Vec3;
use photinus_scene::{BitmapPixels, EnvironmentLight, Light};

fn light(xml: &str) -> Light {
    let s = scene(xml);
    clean(&s);
    s.lights[0].clone()
}

#[test]
fn points() {
    let expected = Light::Point { position: Vec3::new(1.0, 2.0, 3.0), intensity: Vec3::new(4.0, 5.0, 6.0) };
    let value = "<rgb name='intensity' value='4 5 6'/>";
    assert_eq!(
        light(&format!("<emitter type='point'><point name='position' x='1' y='2' z='3'/>{value}</emitter>")),
        expected
    );
    let moved = format!(
        "<emitter type='point'><transform name='to_world'><translate value='1 2 3'/></transform>{value}</emitter>"
    );
    assert_eq!(light(&moved), expected);
    assert_eq!(light("<emitter type='point'/>"), Light::Point { position: Vec3::ZERO, intensity: Vec3::ONE });
}

#[test]
fn spots() {
    let xml = "<emitter type='spot'><transform name='to_world'><lookat origin='0 5 0' target='0 0 0' up='1 0 0'/></transform>\
        <float name='cutoff_angle' value='40'/></emitter>";
    let Light::Spot { position, direction, cutoff_angle, beam_width, intensity } = light(xml) else { panic!() };
    assert_eq!((position, direction, intensity), (Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Y, Vec3::ONE));
    assert!((cutoff_angle - 40f32.to_radians()).abs() < 1e-6 && (beam_width - 30f32.to_radians()).abs() < 1e-6);
    let Light::Spot { cutoff_angle, direction, .. } = light("<emitter type='spot'/>") else { panic!() };
    assert!((cutoff_angle - 20f32.to_radians()).abs() < 1e-6 && direction == Vec3::Z);
    assert!(error("<emitter type='spot'><float name='cutoff_angle' value='200'/></emitter>").contains("cutoff_angle"));
}

#[test]
fn directional() {
    let xml = "<emitter type='directional'><vector name='direction' value='0 0 -2'/></emitter>";
    assert_eq!(light(xml), Light::Directional { direction: Vec3::NEG_Z, irradiance: Vec3::ONE });
    let turned =
        "<emitter type='directional'><transform name='to_world'><rotate x='1' angle='180'/></transform></emitter>";
    let Light::Directional { direction, .. } = light(turned) else { panic!() };
    assert!((direction - Vec3::NEG_Z).length() < 1e-6);
    assert!(error("<emitter type='directional'><vector name='direction' value='0'/></emitter>").contains("zero"));
}

#[test]
fn environments() {
    let xml = "<emitter type='constant'><rgb name='radiance' value='1 2 3'/></emitter>";
    assert_eq!(light(xml), Light::Environment(EnvironmentLight::Constant(Vec3::new(1.0, 2.0, 3.0))));
    let folder = Folder::new();
    folder.write_tga("sky.tga", 2, 2, &[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]);
    let map = "<emitter type='envmap'><string name='filename' value='sky.tga'/><float name='scale' value='2'/>\
        <transform name='to_world'><rotate y='1' angle='90'/></transform></emitter>";
    let s = folder.load(map).unwrap();
    clean(&s);
    let Light::Environment(EnvironmentLight::Image { bitmap, scale, to_world }) = &s.lights[0] else { panic!() };
    assert_eq!((bitmap.width, bitmap.height, *scale), (2, 2, 2.0));
    assert!((to_world.transform_vector3(Vec3::Z) - Vec3::X).length() < 1e-6);
    // A second environment is left out, a missing picture is grey.
    let two = scene(&format!("{xml}{xml}"));
    assert_eq!((two.lights.len(), warnings(&two).len()), (1, 1));
    let missing = scene("<emitter type='envmap'><string name='filename' value='absent.exr'/></emitter>");
    assert!(warnings(&missing)[0].contains("absent.exr"));
    let Light::Environment(EnvironmentLight::Image { bitmap, .. }) = &missing.lights[0] else { panic!() };
    assert!(matches!(&bitmap.pixels, BitmapPixels::RgbaF32(p) if p[0][..3] == [0.5; 3]));
}

#[test]
fn others_are_refused_by_name() {
    for kind in ["sky", "sun", "sunsky", "projector", "directionalarea", "candle"] {
        let s = scene(&format!("<emitter type='{kind}'/>"));
        assert!(warnings(&s)[0].contains(kind), "{:?}", warnings(&s));
    }
    // An area light on its own is there for shapes to refer to.
    let s = scene(
        "<shape type='cube'><ref id='lamp'/></shape><emitter type='area' id='lamp'><rgb name='radiance' value='7'/></emitter>",
    );
    clean(&s);
    assert!(s.shapes[0].emission.is_some() && s.lights.is_empty());
    let s = scene("<shape type='cube'><emitter type='point'/></shape>");
    assert!(warnings(&s)[0].contains("point"));
}

#[test]
fn dark_scenes_get_light() {
    let s = scene("<shape type='cube'/>");
    assert_eq!(s.lights, [Light::Environment(EnvironmentLight::Constant(Vec3::ONE))]);
    assert!(s.warnings.iter().any(|w| w.message.starts_with("no light")));
}
