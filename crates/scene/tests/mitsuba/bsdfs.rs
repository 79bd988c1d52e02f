//! BSDFs: every kind, its defaults and its parameters.

use crate::common::*;
use photinus_geometry::Vec3;
use photinus_scene::{ColorInput, FloatInput, Material, MicrofacetModel, Scene};

fn grey(v: f32) -> ColorInput {
    ColorInput::Constant(Vec3::splat(v))
}

fn num(v: f32) -> FloatInput {
    FloatInput::Constant(v)
}

fn bsdf(xml: &str) -> Material {
    let s = scene(xml);
    clean(&s);
    last_material(&s).clone()
}

#[test]
fn defaults_are_mitsubas() {
    let white = grey(1.0);
    let (bk7, air, coat) = (1.5046, 1.000277, 1.49);
    assert_eq!(bsdf("<bsdf type='diffuse'/>"), Material::Diffuse { reflectance: grey(0.5) });
    assert_eq!(
        bsdf("<bsdf type='dielectric'/>"),
        Material::Dielectric { int_ior: bk7, ext_ior: air, specular_reflectance: white, specular_transmittance: white }
    );
    assert_eq!(
        bsdf("<bsdf type='thindielectric'/>"),
        Material::ThinDielectric {
            int_ior: bk7,
            ext_ior: air,
            specular_reflectance: white,
            specular_transmittance: white
        }
    );
    assert_eq!(
        bsdf("<bsdf type='roughdielectric'/>"),
        Material::RoughDielectric {
            model: MicrofacetModel::Beckmann,
            alpha: [num(0.1); 2],
            int_ior: bk7,
            ext_ior: air,
            specular_reflectance: white,
            specular_transmittance: white
        }
    );
    assert_eq!(
        bsdf("<bsdf type='conductor'/>"),
        Material::Conductor { eta: grey(0.0), k: grey(0.0), specular_reflectance: white }
    );
    assert_eq!(
        bsdf("<bsdf type='roughconductor'><string name='material' value='none'/></bsdf>"),
        Material::RoughConductor {
            model: MicrofacetModel::Beckmann,
            alpha: [num(0.1); 2],
            eta: grey(0.0),
            k: grey(0.0),
            specular_reflectance: white
        }
    );
    assert_eq!(
        bsdf("<bsdf type='plastic'/>"),
        Material::Plastic {
            int_ior: coat,
            ext_ior: air,
            diffuse_reflectance: grey(0.5),
            specular_reflectance: white,
            nonlinear: false
        }
    );
    assert_eq!(
        bsdf("<bsdf type='roughplastic'/>"),
        Material::RoughPlastic {
            model: MicrofacetModel::Beckmann,
            alpha: num(0.1),
            int_ior: coat,
            ext_ior: air,
            diffuse_reflectance: grey(0.5),
            specular_reflectance: white,
            nonlinear: false
        }
    );
    assert_eq!(bsdf("<bsdf type='null'/>"), Material::Null);
    let Material::Principled { base_color, roughness, eta, clearcoat, .. } = bsdf("<bsdf type='principled'/>") else {
        panic!()
    };
    assert_eq!((base_color, roughness, clearcoat), (grey(0.5), num(0.5), num(0.0)));
    // "specular" 0.5 is 4 % at normal incidence: index 1.5.
    assert!((eta - 1.5).abs() < 1e-5);
}

#[test]
fn old_names_mean_the_same() {
    let new = "<bsdf type='roughplastic'><float name='int_ior' value='1.5'/><string name='ext_ior' value='vacuum'/>\
        <float name='alpha' value='0.2'/><string name='distribution' value='ggx'/><boolean name='nonlinear' value='true'/>\
        <rgb name='diffuse_reflectance' value='.1 .2 .3'/><rgb name='specular_reflectance' value='.9'/></bsdf>";
    let old = new
        .replace("int_ior", "intIOR")
        .replace("ext_ior", "extIOR")
        .replace("diffuse_r", "diffuseR")
        .replace("specular_r", "specularR");
    assert_eq!(last_material(&scene_of("0.5.0", &old)), last_material(&scene(new)));
    let Material::RoughPlastic { int_ior, ext_ior, nonlinear, model, .. } = bsdf(new) else { panic!() };
    assert_eq!((int_ior, ext_ior, nonlinear, model), (1.5, 1.0, true, MicrofacetModel::Ggx));
}

#[test]
fn metals_by_name_and_by_number() {
    let metal = |xml: &str| match bsdf(&format!("<bsdf type='conductor'>{xml}</bsdf>")) {
        Material::Conductor { eta: ColorInput::Constant(eta), k: ColorInput::Constant(k), .. } => (eta, k),
        other => panic!("{other:?}"),
    };
    for name in ["Au", "Ag", "Cu", "Al", "Cr", "W", "a-C", "Hg", "cu"] {
        let (eta, k) = metal(&format!("<string name='material' value='{name}'/>"));
        assert!(eta.min_element() > 0.0 && k.min_element() > 0.0, "{name}");
    }
    let (eta, k) = metal("<spectrum name='eta' value='0.789'/><rgb name='k' value='6 5 4'/>");
    assert_eq!((eta, k), (Vec3::splat(0.789), Vec3::new(6.0, 5.0, 4.0)));
    assert!(error("<bsdf type='conductor'><string name='material' value='Xx'/></bsdf>").contains("Au"));
    // Mitsuba 0.x took copper where nothing was said.
    let old = scene_of("0.6.0", "<bsdf type='conductor'/>");
    assert!(matches!(last_material(&old), Material::Conductor { eta, .. } if *eta != grey(0.0)));
}

#[test]
fn anisotropy_and_textured_roughness() {
    let m = bsdf(
        "<bsdf type='roughconductor'><string name='material' value='Al'/><float name='alpha_u' value='0.1'/>\
         <texture name='alpha_v' type='checkerboard'/></bsdf>",
    );
    let Material::RoughConductor { alpha: [u, v], .. } = m else { panic!() };
    assert_eq!(u, num(0.1));
    assert!(matches!(v, FloatInput::Texture(_)));
    assert!(error("<bsdf type='roughplastic'><float name='alpha' value='-1'/></bsdf>").contains("alpha"));
    assert!(error("<bsdf type='roughplastic'><string name='distribution' value='foo'/></bsdf>").contains("foo"));
    assert!(error("<bsdf type='dielectric'><float name='int_ior' value='0'/></bsdf>").contains("int_ior"));
    assert!(error("<bsdf type='dielectric'><string name='int_ior' value='unobtainium'/></bsdf>").contains("diamond"));
}

fn names(s: &Scene) -> Vec<&str> {
    s.materials.iter().map(|m| m.name.as_str()).collect()
}

#[test]
fn wrappers_come_after_what_they_wrap() {
    let s = scene(
        "<bsdf type='twosided' id='t'><bsdf type='plastic' id='p'/></bsdf>\
         <bsdf type='twosided' id='tt'><bsdf type='diffuse' id='f'/><ref id='p'/></bsdf>\
         <bsdf type='mask' id='m'><float name='opacity' value='0.3'/><ref id='t'/></bsdf>\
         <bsdf type='blendbsdf' id='b'><float name='weight' value='0.25'/><ref id='f'/><ref id='p'/></bsdf>\
         <bsdf type='bumpmap' id='u'><texture type='checkerboard' name='arbitrary'/><float name='scale' value='2'/><ref id='f'/></bsdf>\
         <bsdf type='normalmap' id='n'><texture type='checkerboard' name='normalmap'/><ref id='f'/></bsdf>",
    );
    clean(&s);
    assert_eq!(names(&s), ["p", "t", "f", "tt", "m", "b", "u", "n"]);
    for (i, m) in s.materials.iter().enumerate() {
        assert!(m.material.nested().all(|n| (n.0 as usize) < i), "{}", m.name);
    }
    let by_name = |n: &str| &s.materials.iter().find(|m| m.name == n).unwrap().material;
    let id = |n: &str| photinus_scene::MaterialId(names(&s).iter().position(|m| *m == n).unwrap() as u32);
    assert_eq!(*by_name("t"), Material::TwoSided { front: id("p"), back: id("p") });
    assert_eq!(*by_name("tt"), Material::TwoSided { front: id("f"), back: id("p") });
    assert_eq!(*by_name("m"), Material::Mask { opacity: num(0.3), nested: id("t") });
    assert_eq!(*by_name("b"), Material::Blend { weight: num(0.25), a: id("f"), b: id("p") });
    assert!(matches!(by_name("u"), Material::BumpMap { scale: 2.0, .. }));
    assert!(matches!(by_name("n"), Material::NormalMap { .. }));
}

#[test]
fn two_sided_glass_is_glass() {
    let s = scene("<bsdf type='twosided'><bsdf type='dielectric'/></bsdf>");
    assert!(warnings(&s)[0].contains("transparent"));
    assert!(matches!(last_material(&s), Material::Dielectric { .. }));
    let s = scene("<bsdf type='twosided'><bsdf type='mask'><bsdf type='diffuse'/></bsdf></bsdf>");
    clean(&s);
    let Material::Mask { nested, .. } = last_material(&s) else { panic!() };
    assert!(matches!(s.materials[nested.0 as usize].material, Material::TwoSided { .. }));
}

#[test]
fn mixtures_become_blends() {
    let s = scene(
        "<bsdf type='mixturebsdf'><string name='weights' value='0.2, 0.3, 0.5'/>\
         <bsdf type='diffuse'/><bsdf type='plastic'/><bsdf type='conductor'/></bsdf>",
    );
    clean(&s);
    let Material::Blend { weight, a, .. } = *last_material(&s) else { panic!() };
    assert_eq!(weight, num(0.5));
    let Material::Blend { weight, .. } = s.materials[a.0 as usize].material else { panic!() };
    assert_eq!(weight, num(0.3 / 0.5));
    assert!(error("<bsdf type='mixturebsdf'><string name='weights' value='1'/></bsdf>").contains("weights"));
}

#[test]
fn unknown_ones_become_grey_with_a_warning() {
    for kind in ["phong", "ward", "hair", "measured", "sparkle"] {
        let s = scene(&format!("<bsdf type='{kind}'><float name='x' value='1'/></bsdf>"));
        assert_eq!(warnings(&s).len(), 1, "{:?}", warnings(&s));
        assert!(warnings(&s)[0].contains(kind));
        assert_eq!(*last_material(&s), Material::default_diffuse());
    }
    let s = scene("<bsdf type='coating' id='c'><bsdf type='plastic'/></bsdf><shape type='cube'><ref id='c'/></shape>");
    assert_eq!(warnings(&s).len(), 1);
    assert!(matches!(s.materials[s.shapes[0].material.0 as usize].material, Material::Plastic { .. }));
    let s = scene("<bsdf type='polarizer'/>");
    assert_eq!(*last_material(&s), Material::Null);
}

#[test]
fn circles_are_one_clear_error() {
    let e = error("<bsdf type='twosided' id='a'>\n<ref id='a'/></bsdf>");
    assert!(e.contains("scene.xml:2") && e.contains("\"a\"") && e.contains("circle"), "{e}");
    let e = error(
        "<bsdf type='mask' id='a'><ref id='b'/></bsdf><bsdf type='mask' id='b'><ref id='c'/></bsdf>\
         <bsdf type='mask' id='c'><ref id='a'/></bsdf>",
    );
    assert!(e.contains("circle"), "{e}");
    for (xml, word) in [
        ("<bsdf type='mask'/>", "one nested bsdf"),
        ("<bsdf type='twosided'/>", "one or two"),
        ("<bsdf type='blendbsdf'><bsdf type='diffuse'/><bsdf type='diffuse'/></bsdf>", "weight"),
        ("<bsdf type='blendbsdf'><float name='weight' value='.5'/><bsdf type='diffuse'/></bsdf>", "two nested"),
        ("<bsdf type='bumpmap'><bsdf type='diffuse'/></bsdf>", "texture"),
    ] {
        assert!(error(xml).contains(word), "{xml}: {}", error(xml));
    }
}

#[test]
fn the_thesis_surface_is_read() {
    let m = bsdf(
        "<bsdf type='photinus_thesis'><float name='int_ior' value='1.3'/><float name='ext_ior' value='1'/>\
         <float name='roughness' value='0.25'/><rgb name='reflectance' value='.1 .2 .3'/>\
         <rgb name='transmittance' value='.4 .5 .6'/></bsdf>",
    );
    let expected = Material::Thesis {
        int_ior: 1.3,
        ext_ior: 1.0,
        roughness: num(0.25),
        reflectance: ColorInput::Constant(Vec3::new(0.1, 0.2, 0.3)),
        transmittance: ColorInput::Constant(Vec3::new(0.4, 0.5, 0.6)),
    };
    assert_eq!(m, expected);
}
