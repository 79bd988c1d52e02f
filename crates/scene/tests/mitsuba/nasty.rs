//! Files that are wrong in every way: one clear line, soon, whatever they say.

use crate::common::*;
use photinus_scene::{LoadOptions, load};
use std::time::{Duration, Instant};

#[test]
fn malformed_xml_names_its_line() {
    let folder = Folder::new();
    for (text, line) in [
        ("", ""),
        ("<scene version='3.0.0'>\n<shape type='cube'>\n</scene>", ":3"),
        ("<scene version='3.0.0'>\n<shape type='cube'", ":1"),
        ("<scene version='3.0.0'>\n<shape type=cube/></scene>", ":2"),
        ("<scene version='3.0.0'>&nothing;</scene>", ":1"),
        ("<bsdf version='3.0.0' type='diffuse'/>", ":1"),
        ("<scene version='three'/>", ":1"),
        ("no xml at all", ":1"),
    ] {
        let path = folder.write("scene.xml", text);
        let e = one_line(&load(&path, &LoadOptions::default()).unwrap_err());
        assert!(e.contains(&format!("scene.xml{line}")), "{text}: {e}");
    }
    let path = folder.write("scene.xml", b"<scene version='3.0.0'>\xff\xfe\x00</scene>");
    assert!(one_line(&load(&path, &LoadOptions::default()).unwrap_err()).contains("UTF-8"));
}

#[test]
fn truncation_anywhere_is_survived() {
    let whole = "<scene version='3.0.0'><default name='a' value='0.5'/><bsdf type='twosided' id='m'><bsdf type='diffuse'>\
        <rgb name='reflectance' value='$a 0.2 0.3'/></bsdf></bsdf><shape type='sphere'><ref id='m'/>\
        <transform name='to_world'><scale value='2'/><lookat origin='0 0 0' target='0 0 1' up='0 1 0'/></transform></shape></scene>";
    let folder = Folder::new();
    for end in 0..whole.len() {
        let path = folder.write("scene.xml", &whole[..end]);
        one_line(&load(&path, &LoadOptions::default()).unwrap_err());
    }
}

/// A scene with a bit of everything, for mutations.
const RICH: &str = r#"<scene version="3.0.0"><default name="a" value="0.5"/><path value="."/>
<integrator type="moment"><integrator type="path"><integer name="max_depth" value="8"/></integrator></integrator>
<sensor type="thinlens"><float name="fov" value="40"/><float name="aperture_radius" value="0.1"/>
<transform name="to_world"><scale x="-1"/><lookat origin="0 1 5" target="0, 0, 0" up="0 1 0"/></transform>
<film type="hdrfilm"><integer name="width" value="32"/><integer name="crop_width" value="8"/><rfilter type="lanczos"/></film></sensor>
<texture type="checkerboard" id="t"><rgb name="color0" value="$a 0.2 #"/></texture>
<bsdf type="twosided" id="m"><bsdf type="roughplastic"><ref name="diffuse_reflectance" id="t"/></bsdf></bsdf>
<bsdf type="blendbsdf" id="b"><float name="weight" value="0.5"/><ref id="m"/><bsdf type="conductor"><string name="material" value="Au"/></bsdf></bsdf>
<shape type="shapegroup" id="g"><shape type="cube"><ref id="b"/></shape><shape type="sphere"><float name="radius" value="2"/></shape></shape>
<shape type="instance"><ref id="g"/><transform name="to_world"><rotate x="1" angle="30"/><matrix value="1 0 0 0 1 0 0 0 1"/></transform></shape>
<shape type="cylinder"><point name="p1" value="0 0 2"/><emitter type="area"><spectrum name="radiance" value="400:1, 700:2"/></emitter></shape>
<emitter type="spot"><float name="cutoff_angle" value="30"/></emitter><emitter type="constant"/></scene>"#;

#[test]
fn random_changes_are_survived() {
    let whole = RICH.replace("0.2 #", "0.2 0.3");
    let folder = Folder::new();
    let path = folder.write("scene.xml", &whole);
    assert!(warnings(&load(&path, &LoadOptions::default()).unwrap()).is_empty());
    // A linear congruential generator (Knuth, MMIX): the same changes in every run. Seed 1.
    let mut state = 1_u64;
    let mut next = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let pieces: Vec<&str> = whole.split(['"', '<', '>', ' ']).filter(|p| !p.is_empty()).collect();
    let (mut loaded, mut refused) = (0, 0);
    for round in 0..1500 {
        let mut text = whole.clone();
        for _ in 0..=next(3) {
            let at = next(text.len());
            if round % 2 == 0 {
                // One word by another: stays XML, changes its meaning.
                let word = pieces[next(pieces.len())];
                text = text.replacen(word, pieces[next(pieces.len())], 1 + next(2));
            } else if text.is_char_boundary(at) {
                text.insert(at, char::from(next(128) as u8));
            }
        }
        let path = folder.write("scene.xml", &text);
        match load(&path, &LoadOptions::default()) {
            Ok(_) => loaded += 1,
            Err(e) => {
                one_line(&e);
                refused += 1;
            }
        }
    }
    assert!(loaded > 50 && refused > 200, "{loaded} {refused}");
}

#[test]
fn wrong_values_are_errors_with_their_line() {
    for xml in [
        "<shape type='sphere'>\n<float name='radius' value='big'/></shape>",
        "<shape type='sphere'>\n<float name='radius' value='nan'/></shape>",
        "<shape type='sphere'>\n<float name='radius' value='1e99'/></shape>",
        "<shape type='sphere'>\n<float name='radius'/></shape>",
        "<shape type='sphere'>\n<float value='1'/></shape>",
        "<shape type='sphere'>\n<string name='radius' value='1'/></shape>",
        "<shape type='sphere'>\n<point name='center' value='1 2'/></shape>",
        "<shape type='sphere'>\n<point name='center' x='1' y='a'/></shape>",
        "<shape type='sphere'>\n<float name='center' value='1'/></shape>",
        "<shape type='sphere'>\n<boolean name='flip_normals' value='maybe'/></shape>",
        "<shape type='sphere'>\n<float name='to_world' value='1'/></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<scale value='1 2'/></transform></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<scale value='nan'/></transform></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<rotate angle='20'/></transform></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<rotate x='1'/></transform></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<matrix value='1 2 3'/></transform></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<lookat origin='0 0 0' target='0 0 0' up='0 1 0'/></transform></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<lookat origin='0 0 0' target='0 1 0' up='0 1 0'/></transform></shape>",
        "<shape type='sphere'><transform name='to_world'>\n<lookat target='0 1 0'/></transform></shape>",
        "<bsdf type='diffuse'>\n<rgb name='reflectance' value='red'/></bsdf>",
        "<bsdf type='diffuse'>\n<rgb name='reflectance' value='1 2'/></bsdf>",
        "<bsdf type='diffuse'>\n<rgb name='reflectance' value='#12345'/></bsdf>",
        "<bsdf type='diffuse'>\n<rgb name='reflectance' value='#gggggg'/></bsdf>",
        "<bsdf type='diffuse'>\n<spectrum name='reflectance' value='500:1, 400:1'/></bsdf>",
        "<bsdf type='diffuse'>\n<spectrum name='reflectance' value='500:1'/></bsdf>",
        "<bsdf type='diffuse'>\n<spectrum name='reflectance' value='400:x 500:1'/></bsdf>",
        "<bsdf type='diffuse'>\n<spectrum name='reflectance'/></bsdf>",
        "<bsdf type='diffuse'>\n<string name='reflectance' value='red'/></bsdf>",
    ] {
        let e = error(xml);
        assert!(e.contains("scene.xml:3: "), "{xml}\n{e}");
    }
    // The object's own line where no parameter is to blame.
    let singular = "<sensor type='perspective'><transform name='to_world'><scale z='0'/></transform></sensor>";
    assert!(error(singular).contains("scene.xml:2: "));
    let far = "<shape type='sphere'><transform name='to_world'><scale value='1e300'/></transform></shape>";
    assert!(error(far).contains("scene.xml:2: "));
}

#[test]
fn includes_that_go_round_end() {
    let folder = Folder::new();
    folder.write("a.xml", "<scene version='3.0.0'><include filename='b.xml'/></scene>");
    folder.write("b.xml", "<scene version='3.0.0'>\n<include filename='a.xml'/></scene>");
    let e = folder.load("<include filename='a.xml'/>").unwrap_err();
    assert!(one_line(&e).contains("includes itself"), "{e}");
    let e = folder.load("<include filename='scene.xml'/>").unwrap_err();
    assert!(one_line(&e).contains("includes itself"), "{e}");
    // Each file includes the next one twice: the number of files is bounded, not only the depth.
    for i in 0..20 {
        let twice = format!("<include filename='f{}.xml'/>", i + 1).repeat(2);
        folder.write(&format!("f{i}.xml"), format!("<scene version='3.0.0'>{twice}</scene>"));
    }
    folder.write("f20.xml", "<scene version='3.0.0'/>");
    let e = folder.load("<include filename='f0.xml'/>").unwrap_err();
    assert!(one_line(&e).contains("includes"), "{e}");
}

#[test]
fn bombs_do_not_go_off() {
    let start = Instant::now();
    // Entities that multiply, parameters that multiply, elements in elements.
    let mut laughs = String::from("<!DOCTYPE scene [<!ENTITY a0 \"ha\">");
    for i in 1..12 {
        laughs += &format!("<!ENTITY a{i} \"{}\">", format!("&a{};", i - 1).repeat(10));
    }
    laughs += "]><scene version='3.0.0'><bsdf type='diffuse' id='&a11;'/></scene>";
    let folder = Folder::new();
    let path = folder.write("laughs.xml", laughs);
    one_line(&load(&path, &LoadOptions::default()).unwrap_err());

    let mut body = String::from("<default name='p0' value='0123456789'/>");
    for i in 1..12 {
        body += &format!("<default name='p{i}' value='{}'/>", format!("$p{} ", i - 1).repeat(10));
    }
    let e = error(&body);
    assert!(e.contains("16 MiB"), "{e}");

    for depth in [200, 100_000] {
        let e = error(&format!("{}{}", "<bsdf type='mask'>".repeat(depth), "</bsdf>".repeat(depth)));
        assert!(e.contains("deep") || e.contains("XML"), "{e}");
    }
    // A long chain of references.
    let chain: String =
        (0..2000).map(|i| format!("<bsdf type='twosided' id='c{i}'><ref id='c{}'/></bsdf>", i + 1)).collect();
    let e = error(&format!("{chain}<bsdf type='diffuse' id='c2000'/>"));
    assert!(e.contains("deep"), "{e}");
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

#[test]
fn counts_are_bounded() {
    let group = "<shape type='shapegroup' id='g'><shape type='cube'/></shape>";
    let instances = "<shape type='instance'><ref id='g'/></shape>".repeat(100);
    let folder = Folder::new();
    let path = folder.write("scene.xml", format!("<scene version='3.0.0'>{group}{instances}</scene>"));
    let e = load(&path, &LoadOptions { max_triangles: 500, ..LoadOptions::default() }).unwrap_err();
    assert!(one_line(&e).contains("triangle count") && e.to_string().contains("500"), "{e}");
    assert_eq!(load(&path, &LoadOptions::default()).unwrap().triangle_count(), 1200);
    let e = load(&path, &LoadOptions { max_xml_bytes: 100, ..LoadOptions::default() }).unwrap_err();
    assert!(one_line(&e).contains("100"), "{e}");
}

#[test]
fn many_warnings_are_cut() {
    let s = scene(&"<fog/>\n".repeat(5000));
    assert!(s.warnings.len() <= 1003, "{}", s.warnings.len());
}

#[test]
fn the_folder_itself_and_odd_files() {
    let folder = Folder::new();
    one_line(&load(folder.0.path(), &LoadOptions::default()).unwrap_err());
    one_line(&load(&folder.path("absent.xml"), &LoadOptions::default()).unwrap_err());
    for name in ["scene.pbrt", "scene.gltf", "scene.glb", "mesh.off", "scene.blend", "picture.tiff", "noextension"] {
        let path = folder.write(name, "# nothing\n");
        let e = one_line(&load(&path, &LoadOptions::default()).unwrap_err());
        assert!(e.contains(name) && e.contains("Mitsuba XML"), "{e}");
    }
    // Content decides where the name says nothing.
    let path = folder.write("scene", "<?xml version='1.0'?><scene version='3.0.0'><shape type='cube'/></scene>");
    assert_eq!(load(&path, &LoadOptions::default()).unwrap().triangle_count(), 12);
}
