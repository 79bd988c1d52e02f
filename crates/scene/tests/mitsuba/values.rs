//! Numbers, colours, transforms, parameters, includes, references.

use crate::common::*;
use photinus_geometry::Vec3;
use photinus_scene::{ColorInput, Geometry, LoadOptions, Material, Scene, load};

fn reflectance(scene: &Scene) -> Vec3 {
    match last_material(scene) {
        Material::Diffuse { reflectance: ColorInput::Constant(c) } => *c,
        other => panic!("{other:?}"),
    }
}

fn diffuse(value: &str) -> Vec3 {
    reflectance(&scene(&format!("<bsdf type=\"diffuse\" id=\"a\">{value}</bsdf>")))
}

#[track_caller]
fn near(a: Vec3, b: Vec3, tolerance: f32) {
    assert!((a - b).abs().max_element() <= tolerance, "{a} is not {b}");
}

#[test]
fn colours_in_all_spellings() {
    let v = Vec3::new(0.2, 0.5, 0.3);
    for text in ["0.2 0.5 0.3", "0.2, 0.5, 0.3", "0.2,0.5,0.3", " 0.2\t0.5\n0.3 "] {
        assert_eq!(diffuse(&format!("<rgb name=\"reflectance\" value=\"{text}\"/>")), v);
    }
    assert_eq!(diffuse("<rgb name='reflectance' value='0.25'/>"), Vec3::splat(0.25));
    assert_eq!(diffuse("<float name='reflectance' value='0.25'/>"), Vec3::splat(0.25));
    assert_eq!(diffuse("<spectrum name='reflectance' value='0.25'/>"), Vec3::splat(0.25));
    assert_eq!(diffuse("<spectrum name='reflectance' value='0.2, 0.5, 0.3'/>"), v);
    assert_eq!(diffuse("<rgb name='reflectance' value='#ff0000'/>"), Vec3::X);
    // sRGB 0x80 is 0.21586 linear (IEC 61966-2-1).
    near(diffuse("<rgb name='reflectance' value='#808080'/>"), Vec3::splat(0.215_861), 1e-5);
    near(diffuse("<srgb name='reflectance' value='0.5, 0.5, 0.5'/>"), Vec3::splat(0.214_041), 1e-5);
    assert_eq!(
        diffuse("<spectrum type='uniform' name='reflectance'><float name='value' value='0.3'/></spectrum>"),
        Vec3::splat(0.3)
    );
    assert_eq!(diffuse("<spectrum type='srgb' name='reflectance'><rgb name='color' value='.2 .5 .3'/></spectrum>"), v);
}

#[test]
fn spectra_become_rgb() {
    let flat = diffuse("<spectrum name='reflectance' value='400:0.78, 500:0.78, 600:0.78, 700:0.78'/>");
    near(flat, Vec3::splat(0.78), 0.02);
    let regular = "<spectrum type='regular' name='reflectance'><float name='wavelength_min' value='360'/>\
        <float name='wavelength_max' value='830'/><string name='values' value='0.4, 0.4, 0.4'/></spectrum>";
    near(diffuse(regular), Vec3::splat(0.4), 1e-4);
    let irregular = "<spectrum type='irregular' name='reflectance'><string name='wavelengths' value='360, 500, 830'/>\
        <string name='values' value='0.4, 0.4, 0.4'/></spectrum>";
    near(diffuse(irregular), Vec3::splat(0.4), 1e-4);
    let red = diffuse("<spectrum name='reflectance' value='400:0.04, 560:0.06, 600:0.3, 640:0.6, 700:0.64'/>");
    assert!(red.x > 3.0 * red.y && red.y >= red.z * 0.5, "{red}");

    let folder = Folder::new();
    folder.write("grey.spd", "# nm value\n360 0.25\r\n500\t0.25\n830 0.25\n");
    let loaded = folder.load("<bsdf type='diffuse'><spectrum name='reflectance' filename='grey.spd'/></bsdf>").unwrap();
    near(reflectance(&loaded), Vec3::splat(0.25), 1e-4);
    folder.write("bad.spd", "400 0.1\n500 x\n");
    let e = folder.load("<bsdf type='diffuse'><spectrum name='reflectance' filename='bad.spd'/></bsdf>").unwrap_err();
    assert!(one_line(&e).contains("bad.spd:2"), "{e}");
}

#[test]
fn light_spectra_keep_their_white() {
    let radiance = |value: &str| match scene(&format!("<emitter type='constant'>{value}</emitter>")).lights[0] {
        photinus_scene::Light::Environment(photinus_scene::EnvironmentLight::Constant(c)) => c,
        ref other => panic!("{other:?}"),
    };
    assert_eq!(radiance("<rgb name='radiance' value='2'/>"), Vec3::splat(2.0));
    assert_eq!(radiance("<float name='radiance' value='2'/>"), Vec3::splat(2.0));
    // A constant spectrum as light is the equal-energy white, luminance 1.
    let e = radiance("<spectrum name='radiance' value='1'/>");
    near(e, Vec3::new(1.2048, 0.9483, 0.9089), 1e-3);
    let samples = radiance("<spectrum name='radiance' value='360:1, 830:1'/>");
    near(samples, e, 1e-2);
    // The lamp of the measured Cornell box: what the sum over the tabulated observer gives, to half a percent (ours is
    // the analytic observer).
    let lamp = radiance("<spectrum name='radiance' value='400:0, 500:8, 600:15.6, 700:18.4'/>");
    near(lamp, Vec3::new(20.711, 10.855, 2.771), 0.11);
    let warm =
        radiance("<spectrum type='blackbody' name='radiance'><float name='temperature' value='2700'/></spectrum>");
    assert!(warm.x > warm.y && warm.y > warm.z && warm.z > 0.0, "{warm}");
    assert_eq!(warm, radiance("<blackbody name='radiance' temperature='2700K'/>"));
}

#[test]
fn colours_out_of_range_are_clamped_with_a_warning() {
    let s = scene("<bsdf type='diffuse'><rgb name='reflectance' value='1.5 0.5 -1'/></bsdf>");
    assert_eq!(reflectance(&s), Vec3::new(1.0, 0.5, 0.0));
    assert!(warnings(&s)[0].contains("clamped"), "{:?}", warnings(&s));
}

/// The first vertex of a rectangle moved by `transform` (it is at -1, -1, 0 before).
fn corner(transform: &str) -> Vec3 {
    let s = scene(&format!("<shape type='rectangle'><transform name='to_world'>{transform}</transform></shape>"));
    match &s.shapes[0].geometry {
        Geometry::Mesh(m) => m.positions[0],
        other => panic!("{other:?}"),
    }
}

#[test]
fn transforms_apply_from_first_to_last() {
    near(corner("<translate x='1' y='2' z='3'/>"), Vec3::new(0.0, 1.0, 3.0), 0.0);
    near(corner("<translate value='1 2 3'/>"), Vec3::new(0.0, 1.0, 3.0), 0.0);
    near(corner("<scale value='2'/><translate x='1'/>"), Vec3::new(-1.0, -2.0, 0.0), 0.0);
    near(corner("<translate x='1'/><scale value='2'/>"), Vec3::new(0.0, -2.0, 0.0), 0.0);
    near(corner("<scale x='3'/>"), Vec3::new(-3.0, -1.0, 0.0), 0.0);
    near(corner("<scale value='2 3 4'/>"), Vec3::new(-2.0, -3.0, 0.0), 0.0);
    // A quarter turn around z takes x to y.
    near(corner("<rotate z='1' angle='90'/>"), Vec3::new(1.0, -1.0, 0.0), 1e-6);
    near(corner("<rotate value='0 1 0' angle='90'/>"), Vec3::new(0.0, -1.0, 1.0), 1e-6);
    near(corner("<matrix value='1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1'/>"), Vec3::new(4.0, 5.0, 7.0), 0.0);
    near(corner("<matrix value='0 1 0 -1 0 0 0 0 1'/>"), Vec3::new(-1.0, 1.0, 0.0), 0.0);
    // Local z goes from origin to target, local x to the left.
    near(corner("<lookat origin='1 2 3' target='1 2 9' up='0 1 0'/>"), Vec3::new(0.0, 1.0, 3.0), 1e-6);
    near(corner("<lookat origin='0 0 0' target='1 0 0' up='0 0 1'/>"), Vec3::new(0.0, -1.0, -1.0), 1e-6);
}

#[test]
fn parameters_are_replaced_everywhere() {
    let body = "<default name='r' value='0.2'/><default name='rest' value='0.5 0.3'/><default name='kind' value='diffuse'/>\
        <default name='r' value='0.9'/>\
        <bsdf type='$kind' id='m-$r'><rgb name='reflectance' value='$r $rest'/></bsdf>\
        <shape type='rectangle'><ref id='m-0.2'/></shape>";
    let s = scene(body);
    clean(&s);
    assert_eq!(reflectance(&s), Vec3::new(0.2, 0.5, 0.3));
    assert_eq!(s.materials[0].name, "m-0.2");
    // The caller's values win.
    let folder = Folder::new();
    let path = folder.write("scene.xml", format!("<scene version='3.0.0'>{body}</scene>").replace("m-0.2", "m-0.4"));
    let options = LoadOptions { defines: vec![("r".into(), "0.4".into())], ..LoadOptions::default() };
    assert_eq!(reflectance(&load(&path, &options).unwrap()), Vec3::new(0.4, 0.5, 0.3));
    let escaped = scene("<bsdf type='diffuse' id='cost: \\$5'/>");
    assert_eq!(escaped.materials[0].name, "cost: $5");
    let e = error("<bsdf type='diffuse'><float name='reflectance' value='$nothing'/></bsdf>");
    assert!(e.contains("scene.xml:2") && e.contains("$nothing"), "{e}");
}

#[test]
fn references_work_before_and_after_and_by_alias() {
    let body = "<shape type='rectangle'><ref id='late'/></shape>\
        <shape type='rectangle'><ref name='bsdf' id='other'/></shape>\
        <bsdf type='diffuse' id='late'><float name='reflectance' value='0.1'/></bsdf>\
        <alias id='late' as='other'/>";
    let s = scene(body);
    clean(&s);
    assert_eq!(s.materials.len(), 1);
    assert_eq!(s.shapes[0].material, s.shapes[1].material);
    let e = error("<shape type='rectangle'>\n<ref id='nobody'/></shape>");
    assert!(e.contains("scene.xml:3") && e.contains("nobody"), "{e}");
    let e = error("<alias id='nobody' as='x'/>");
    assert!(e.contains("nobody"), "{e}");
    let e = error("<bsdf type='diffuse' id='x'/>\n<bsdf type='diffuse' id='x'/>");
    assert!(e.contains("scene.xml:3") && e.contains("\"x\""), "{e}");
}

#[test]
fn includes_and_paths() {
    let folder = Folder::new();
    folder.write("parts/materials.xml", "<scene version='3.0.0'><bsdf type='diffuse' id='m'/></scene>");
    folder.write("parts/one.xml", "<bsdf version='3.0.0' type='conductor' id='n'/>");
    folder.write("data/grey.spd", "360 0.25\n830 0.25\n");
    let body = "<path value='data'/><include filename='parts/materials.xml'/><include filename='parts/one.xml'/>\
        <bsdf type='diffuse'><spectrum name='reflectance' filename='grey.spd'/></bsdf>\
        <shape type='rectangle'><ref id='m'/></shape><shape type='rectangle'><ref id='n'/></shape>";
    let s = folder.load(body).unwrap();
    clean(&s);
    assert_eq!(s.materials.len(), 3);
    assert_eq!(s.shapes[0].material.0, 0);
    let e = folder.load("\n<include filename='absent.xml'/>").unwrap_err();
    assert!(one_line(&e).contains("scene.xml:3") && one_line(&e).contains("absent.xml"), "{e}");
    let s = folder.load("<path value='nowhere'/>").unwrap();
    assert!(warnings(&s)[0].contains("nowhere"));
}

#[test]
fn files_outside_the_folder_need_permission() {
    let folder = Folder::new();
    folder.write("common/grey.spd", "360 0.25\n830 0.25\n");
    let body = "<scene version='3.0.0'><path value='../common'/>\
        <bsdf type='diffuse'><spectrum name='reflectance' filename='grey.spd'/></bsdf></scene>";
    let path = folder.write("inner/scene.xml", body);
    let e = one_line(&load(&path, &LoadOptions::default()).unwrap_err());
    assert!(e.contains("--allow-outside") && e.contains("grey.spd"), "{e}");
    let s = load(&path, &LoadOptions { allow_outside: true, ..LoadOptions::default() }).unwrap();
    near(reflectance(&s), Vec3::splat(0.25), 1e-4);
}

#[test]
fn what_is_unknown_is_named_with_its_line() {
    let body = "<bsdf type='diffuse'>\n<float name='shininess' value='3'/></bsdf>\n<fog/>\n\
        <shape type='rectangle' colour='red'/>\n<integrator type='path'><float name='speed' value='1'/></integrator>";
    let s = scene(body);
    let w = warnings(&s);
    for (line, word) in [(3, "shininess"), (4, "<fog>"), (5, "colour"), (6, "speed")] {
        assert!(w.iter().any(|w| w.starts_with(&format!("{line}: ")) && w.contains(word)), "{line} {word}: {w:?}");
    }
    assert_eq!(w.len(), 4, "{w:?}");
    assert!(s.warnings.iter().all(|w| w.file.ends_with("scene.xml")));
}

#[test]
fn text_encodings() {
    let folder = Folder::new();
    let body = "<scene version='3.0.0'><bsdf type='diffuse' id='h\u{fc}tte'/></scene>";
    let utf16: Vec<u8> =
        [0xfffe_u16.swap_bytes()].into_iter().chain(body.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let latin: Vec<u8> =
        format!("<?xml version='1.0' encoding='ISO-8859-1'?>{body}").chars().map(|c| c as u8).collect();
    let bom = format!("\u{feff}{body}").into_bytes();
    let crlf = body.replace("><", ">\r\n<").into_bytes();
    for bytes in [utf16, latin, bom, crlf, body.as_bytes().to_vec()] {
        let path = folder.write("scene.xml", bytes);
        let s = load(&path, &LoadOptions::default()).unwrap();
        assert_eq!(s.materials[0].name, "h\u{fc}tte");
    }
}
