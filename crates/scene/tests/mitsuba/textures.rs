//! Textures.

use crate::common::*;
use photinus_geometry::{Vec2, Vec3};
use photinus_scene::{BitmapPixels, ColorInput, Material, Scene, Texture, TextureFilter, TextureKind, WrapMode};

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write_tga("a.tga", 2, 1, &[[30, 20, 10], [60, 50, 40]]);
    folder
}

fn texture(xml: &str) -> (Scene, Texture) {
    let s = folder().load(xml).unwrap_or_else(|e| panic!("{e}"));
    clean(&s);
    let t = s.textures.last().expect("a texture").clone();
    (s, t)
}

/// Where the model looks for texture coordinates that Mitsuba has as (u, v), in Mitsuba's (v down) and only for
/// bitmaps.
fn looks(t: &Texture, u: f32, v: f32) -> Vec2 {
    let p = t.to_uv.transform_point3(Vec3::new(u, 1.0 - v, 0.0));
    Vec2::new(p.x, 1.0 - p.y)
}

#[test]
fn bitmaps() {
    let (_, t) = texture("<texture type='bitmap'><string name='filename' value='a.tga'/></texture>");
    let TextureKind::Bitmap { bitmap, filter, wrap, alpha } = &t.kind else { panic!() };
    assert_eq!(
        (bitmap.width, bitmap.height, *filter, *wrap, *alpha),
        (2, 1, TextureFilter::Bilinear, WrapMode::Repeat, false)
    );
    assert!(matches!(&bitmap.pixels, BitmapPixels::Rgba8 { data, srgb: true } if data[0] == [10, 20, 30, 255]));
    let (_, t) = texture(
        "<texture type='bitmap'><string name='filename' value='a.tga'/><boolean name='raw' value='true'/>\
         <string name='filter_type' value='nearest'/><string name='wrap_mode' value='mirror'/></texture>",
    );
    let TextureKind::Bitmap { bitmap, filter, wrap, .. } = &t.kind else { panic!() };
    assert_eq!((*filter, *wrap), (TextureFilter::Nearest, WrapMode::Mirror));
    assert!(matches!(&bitmap.pixels, BitmapPixels::Rgba8 { srgb: false, .. }));
    for (channel, value) in [("r", 10), ("g", 20), ("b", 30)] {
        let (_, t) = texture(&format!(
            "<texture type='bitmap'><string name='filename' value='a.tga'/><string name='channel' value='{channel}'/></texture>"
        ));
        let TextureKind::Bitmap { bitmap, .. } = &t.kind else { panic!() };
        assert!(matches!(&bitmap.pixels, BitmapPixels::Rgba8 { data, .. } if data[0] == [value, value, value, 255]));
    }
    let (_, t) = texture(
        "<texture type='bitmap'><string name='filename' value='a.tga'/><string name='channel' value='a'/></texture>",
    );
    assert!(matches!(t.kind, TextureKind::Bitmap { alpha: true, .. }));
}

#[test]
fn coordinates_are_mapped_as_in_mitsuba() {
    let bitmap = |inner: &str| {
        texture(&format!("<texture type='bitmap'><string name='filename' value='a.tga'/>{inner}</texture>")).1
    };
    let plain = bitmap("");
    assert_eq!(looks(&plain, 0.25, 0.125), Vec2::new(0.25, 0.125));
    // The texture test of Mitsuba: scale by 2, then move by a half.
    let scaled = bitmap("<transform name='to_uv'><scale value='2'/><translate value='-.5,-.5, 0'/></transform>");
    assert_eq!(looks(&scaled, 0.25, 0.125), Vec2::new(0.0, -0.25));
    let turned = bitmap("<transform name='to_uv'><matrix value='0 1 0  1 0 0.25  0 0 1'/></transform>");
    assert_eq!(looks(&turned, 0.25, 0.125).x, 0.125);
    let old = bitmap("<float name='uscale' value='4'/><float name='voffset' value='0.5'/>");
    assert_eq!(looks(&old, 0.25, 0.125), Vec2::new(1.0, 0.625));
}

#[test]
fn checkerboards() {
    let (_, t) = texture(
        "<texture type='checkerboard'><rgb name='color0' value='.1 .2 .3'/><transform name='to_uv'><scale x='5' y='3'/></transform></texture>",
    );
    let TextureKind::Checkerboard { a, b } = t.kind else { panic!() };
    assert_eq!(a, ColorInput::Constant(Vec3::new(0.1, 0.2, 0.3)));
    assert_eq!(b, ColorInput::Constant(Vec3::splat(0.2)));
    // The model's (u, 1 - v) has to land where Mitsuba's (u, v) lands.
    let p = t.to_uv.transform_point3(Vec3::new(0.3, 1.0 - 0.1, 0.0));
    assert!((p - Vec3::new(1.5, 0.3, 0.0)).length() < 1e-6, "{p}");
}

#[test]
fn nested_textures() {
    let (s, t) = texture(
        "<texture type='scale' id='s'><float name='scale' value='2'/><texture type='checkerboard'>\
         <texture name='color1' type='bitmap'><string name='filename' value='a.tga'/></texture></texture></texture>",
    );
    assert_eq!(s.textures.len(), 3);
    let TextureKind::Scale { input: ColorInput::Texture(inner), factor: 2.0 } = t.kind else { panic!("{t:?}") };
    let TextureKind::Checkerboard { b: ColorInput::Texture(inner), .. } = s.textures[inner.0 as usize].kind else {
        panic!()
    };
    assert!(matches!(s.textures[inner.0 as usize].kind, TextureKind::Bitmap { .. }));
    assert!(matches!(texture("<texture type='vertexcolors'/>").1.kind, TextureKind::VertexColor));
    let attribute = "<texture type='mesh_attribute'><string name='name' value='vertex_color'/></texture>";
    assert!(matches!(texture(attribute).1.kind, TextureKind::VertexColor));
}

#[test]
fn shared_textures_and_pictures_are_held_once() {
    let s = folder()
        .load(
            "<texture type='bitmap' id='t'><string name='filename' value='a.tga'/></texture>\
             <bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf><bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf>\
             <bsdf type='diffuse'><texture type='bitmap' name='reflectance'><string name='filename' value='a.tga'/></texture></bsdf>",
        )
        .unwrap();
    clean(&s);
    assert_eq!(s.textures.len(), 2);
    let bitmap = |i: usize| match &s.textures[i].kind {
        TextureKind::Bitmap { bitmap, .. } => bitmap.clone(),
        other => panic!("{other:?}"),
    };
    assert!(std::sync::Arc::ptr_eq(&bitmap(0), &bitmap(1)));
}

#[test]
fn missing_and_broken_pictures_are_grey() {
    let grey = Material::Diffuse { reflectance: ColorInput::Constant(Vec3::splat(0.5)) };
    let folder = Folder::new();
    folder.write("broken.png", b"\x89PNG\r\n\x1a\nnothing");
    folder.write("empty.jpg", b"");
    for name in ["absent.png", "broken.png", "empty.jpg", "textures\\absent.bmp"] {
        let s = folder
            .load(&format!(
                "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'>\n<string name='filename' value='{name}'/></texture></bsdf>"
            ))
            .unwrap_or_else(|e| panic!("{e}"));
        let w = warnings(&s);
        assert!(w.len() == 1 && w[0].starts_with("3: ") && w[0].contains("mid-grey"), "{w:?}");
        assert_eq!(*last_material(&s), grey);
    }
    assert!(error("<texture type='bitmap'/>").contains("filename"));
    let s = scene("<bsdf type='diffuse'><texture name='reflectance' type='marble'/></bsdf>");
    assert!(warnings(&s)[0].contains("marble"));
    assert_eq!(*last_material(&s), grey);
}

#[test]
fn circles_are_refused() {
    let e = error("<texture type='scale' id='t'><ref id='t'/></texture>");
    assert!(e.contains("circle"), "{e}");
    let e = error(
        "<texture type='checkerboard' id='t'><ref name='color0' id='u'/></texture><texture type='scale' id='u'><ref id='t'/></texture>",
    );
    assert!(e.contains("circle"), "{e}");
}

#[test]
fn a_mask_takes_the_holes_of_its_picture() {
    let folder = Folder::new();
    // 32 bits a pixel, 8 of them alpha.
    let mut tga = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28];
    tga.extend([255, 255, 255, 0, 10, 20, 30, 255]);
    folder.write("leaf.tga", tga);
    let body = |channel: &str| {
        format!(
            "<texture type='bitmap' id='leaf'><string name='filename' value='leaf.tga'/>{channel}</texture>\
             <bsdf type='mask' id='m'><ref name='opacity' id='leaf'/><bsdf type='diffuse'><ref name='reflectance' id='leaf'/>\
             </bsdf></bsdf><bsdf type='mask'><ref name='opacity' id='leaf'/><ref id='d'/></bsdf><bsdf type='diffuse' id='d'/>"
        )
    };
    let alphas = |s: &Scene| -> Vec<bool> {
        s.textures.iter().map(|t| matches!(t.kind, TextureKind::Bitmap { alpha: true, .. })).collect()
    };
    let s = folder.load(&body("")).unwrap();
    clean(&s);
    assert_eq!(alphas(&s), [false, true]);
    let opacities: Vec<_> = s
        .materials
        .iter()
        .filter_map(|m| match &m.material {
            Material::Mask { opacity, .. } => Some(*opacity),
            _ => None,
        })
        .collect();
    assert_eq!(opacities, [photinus_scene::FloatInput::Texture(photinus_scene::TextureId(1)); 2]);
    let s = folder.load(&body("<string name='channel' value='all'/>")).unwrap();
    assert_eq!(alphas(&s), [false]);
}
