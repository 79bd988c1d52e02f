//! What library materials become: each illum model, opacity, light, pictures.

use super::*;
use crate::load::{Context, Draft, LoadOptions};
use crate::{BitmapPixels, ColorInput, FloatInput, Material, TextureKind, WrapMode};
use photinus_geometry::Vec3;
use std::path::Path;

struct Made {
    draft: Draft,
    converted: Converted,
    warnings: Vec<String>,
}

impl Made {
    /// The material of the part, and those inside it down to the innermost.
    fn chain(&self) -> Vec<&Material> {
        let mut chain = vec![&self.draft.materials[self.converted.material.0 as usize].material];
        while let Some(inner) = chain.last().unwrap().nested().next() {
            chain.push(&self.draft.materials[inner.0 as usize].material);
        }
        chain
    }

    fn innermost(&self) -> &Material {
        self.chain().last().unwrap()
    }
}

/// The first material of the library `text`, whose pictures are in `folder`.
fn make_in(folder: &Path, text: &str) -> Made {
    let options = LoadOptions::default();
    let path = folder.join("library.mtl");
    let mut context = Context::new(&path, &options);
    let raw = parse(text.as_bytes());
    assert!(raw.notes.is_empty(), "{:?}", raw.notes);
    let library = Library { path, folders: vec![folder.to_path_buf()], raw };
    let mut draft = Draft::default();
    let converted = convert(&library.raw.materials[0], &library, &mut draft, &mut context);
    for (i, m) in draft.materials.iter().enumerate() {
        assert!(m.material.nested().all(|n| (n.0 as usize) < i), "{text}");
    }
    let warnings = context.take_warnings().into_iter().map(|w| w.message).collect();
    Made { draft, converted, warnings }
}

fn make(statements: &str) -> Made {
    make_in(Path::new("."), &format!("newmtl m\n{statements}\n"))
}

fn constant(x: f32) -> ColorInput {
    ColorInput::Constant(Vec3::splat(x))
}

/// Sum of what the diffuse and the shiny part of a blend reflect.
fn blend_sum(made: &Made) -> (Vec3, Material) {
    let Material::Blend { weight: FloatInput::Constant(weight), a, b } = *made.chain()[1] else {
        panic!("{:?}", made.chain())
    };
    let material = |id: crate::MaterialId| made.draft.materials[id.0 as usize].material.clone();
    let Material::Diffuse { reflectance: ColorInput::Constant(diffuse) } = material(a) else { panic!() };
    let shiny = material(b);
    let (Material::RoughConductor { specular_reflectance, .. } | Material::Conductor { specular_reflectance, .. }) =
        &shiny
    else {
        panic!("{shiny:?}")
    };
    let ColorInput::Constant(specular) = *specular_reflectance else { panic!() };
    assert!(diffuse.max_element() <= 1.0 && specular.max_element() <= 1.0, "{diffuse} {specular}");
    (diffuse * (1.0 - weight) + specular * weight, shiny)
}

#[test]
fn diffuse_models_are_seen_from_both_sides() {
    for statements in ["Kd 0.3 0.3 0.3", "Kd 0.3 0.3 0.3\nKs 0.9 0.9 0.9\nillum 1", "illum 0\nKd 0.3 0.3 0.3"] {
        let made = make(statements);
        assert!(matches!(made.chain()[0], Material::TwoSided { front, back } if front == back));
        assert_eq!(*made.innermost(), Material::Diffuse { reflectance: constant(0.3) });
        assert!(made.converted.emission.is_none() && made.warnings.is_empty());
    }
    assert_eq!(*make("illum 2").innermost(), Material::Diffuse { reflectance: constant(0.5) }, "nothing said");
    assert_eq!(*make("Kd 2 2 2").innermost(), Material::Diffuse { reflectance: constant(1.0) });
}

#[test]
fn phong_is_a_diffuse_part_and_a_lobe_that_add_up() {
    let (sum, shiny) = blend_sum(&make("Kd 0.4 0.3 0.2\nKs 0.3 0.3 0.3\nNs 98\nillum 2"));
    assert!((sum - Vec3::new(0.7, 0.6, 0.5)).abs().max_element() < 1e-6, "{sum}");
    // Walter et al.: exponent 98 is alpha sqrt(2 / 100).
    let Material::RoughConductor { alpha: [FloatInput::Constant(alpha), _], .. } = shiny else { panic!() };
    assert!((alpha - 0.02f32.sqrt()).abs() < 1e-6);
    let (sum, _) = blend_sum(&make("Kd 0.8 0.4 0.4\nKs 0.8 0.4 0.4\nNs 10"));
    assert!((sum - Vec3::new(1.0, 0.5, 0.5)).abs().max_element() < 1e-6, "no more than arrives: {sum}");
}

#[test]
fn blender_means_a_weak_coat() {
    let text = "# Blender 4.1 MTL File: 'a'\nnewmtl m\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nNs 250\nillum 2\n";
    let Material::RoughPlastic { int_ior, .. } = *make_in(Path::new("."), text).innermost() else { panic!() };
    assert!((int_ior - 1.5).abs() < 1e-3, "0.5 is a reflectance of 0.04: index {int_ior}");
}

#[test]
fn mirrors_are_sharp() {
    let made = make("Kd 0.01 0.01 0.01\nKs 0.95 0.95 0.95\nNs 1000\nillum 5");
    let Material::Conductor { eta, specular_reflectance, .. } = made.innermost() else { panic!() };
    assert_eq!((*eta, *specular_reflectance), (constant(0.0), constant(0.95)));
    let (sum, shiny) = blend_sum(&make("Kd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nillum 3"));
    assert!((sum.x - 0.75).abs() < 1e-6 && matches!(shiny, Material::Conductor { .. }));
    assert!(matches!(make("Kd 0.5 0.5 0.5\nillum 3").innermost(), Material::Diffuse { .. }), "nothing to reflect");
}

#[test]
fn glass_is_bare_and_filtered_once_for_both_surfaces() {
    for illum in [4, 6, 7, 9] {
        let made = make(&format!("Ni 1.7\nTf 0.25 0.64 1\nKd 0 0 0\nd 0.1\nillum {illum}"));
        assert!(made.converted.is_glass && made.chain().len() == 1);
        let Material::Dielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance } = made.innermost()
        else {
            panic!()
        };
        assert_eq!((*int_ior, *ext_ior, *specular_reflectance), (1.7, 1.0, constant(1.0)));
        assert_eq!(*specular_transmittance, ColorInput::Constant(Vec3::new(0.5, 0.8, 1.0)));
    }
    // McGuire's glass: Tf as Maya writes it.
    let made = make("Ni 2.5\nTf 0.1 0.1 0.1\nKs 0.3 0.3 0.3\nillum 7");
    let Material::Dielectric { specular_transmittance: ColorInput::Constant(t), .. } = *made.innermost() else {
        panic!()
    };
    assert!((t.x * t.x - 0.9).abs() < 1e-6 && made.warnings.len() == 1, "{t} {:?}", made.warnings);
    // Without refraction it is a see-through surface.
    let made = make("Ni 1\nKd 0.2 0.2 0.2\nd 0.25\nillum 4");
    assert!(!made.converted.is_glass);
    assert!(matches!(made.chain()[0], Material::Mask { opacity: FloatInput::Constant(d), .. } if *d == 0.25));
}

#[test]
fn opacity_from_d_and_tr() {
    for (statements, opacity, warnings) in [
        ("d 0.25", Some(0.25), 0),
        ("Tr 0.25", Some(0.75), 0),
        ("d 0.75\nTr 0.25", Some(0.75), 0),
        ("Tr 0.5\nd 0.75", Some(0.75), 1),
        ("d 1\nTr 0", None, 0),
        ("Tr 1", None, 1),
        ("d 0", Some(0.0), 1),
        ("d 7", None, 0),
    ] {
        let made = make(statements);
        let got = match made.chain()[0] {
            Material::Mask { opacity: FloatInput::Constant(d), .. } => Some(*d),
            _ => None,
        };
        assert_eq!((got, made.warnings.len()), (opacity, warnings), "{statements}: {:?}", made.warnings);
    }
}

#[test]
fn light_from_ke_and_from_old_libraries() {
    assert_eq!(make("Ke 17 12 4").converted.emission, Some(ColorInput::Constant(Vec3::new(17.0, 12.0, 4.0))));
    assert_eq!(make("Ke 0 0 0\nKa 20 20 20").converted.emission, None);
    assert_eq!(make("Ka 1 1 1").converted.emission, None);
    let made = make("Ka 20 20 20\nKd 1 1 1");
    assert_eq!((made.converted.emission, made.warnings.len()), (Some(constant(20.0)), 1));
}

#[test]
fn the_extension_becomes_principled() {
    let made = make("Kd 0.6 0.6 0.6\nPr 0.2\nPm 0.3\nPs 0.4\nPc 0.5\nPcr 0.6\naniso 0.7\nanisor 0.8\nNi 1.3");
    let Material::Principled { base_color, roughness, metallic, sheen, clearcoat, eta, spec_trans, .. } =
        made.innermost()
    else {
        panic!("{:?}", made.chain())
    };
    let c = FloatInput::Constant;
    assert_eq!((*base_color, *roughness, *metallic, *sheen), (constant(0.6), c(0.2), c(0.3), c(0.4)));
    assert_eq!((*clearcoat, *eta, *spec_trans), (c(0.5), 1.3, c(0.0)));
    let Material::Principled { clearcoat_gloss: FloatInput::Constant(gloss), anisotropic, .. } = made.innermost()
    else {
        panic!()
    };
    assert!((gloss - 0.4).abs() < 1e-6 && *anisotropic == c(0.7));
    assert_eq!(made.warnings.len(), 1, "anisor: {:?}", made.warnings);
    let glass = make("Pr 0.1\nillum 7\nNi 1.5");
    assert!(glass.chain().len() == 1, "glass has two sides of its own");
    assert!(matches!(glass.innermost(), Material::Principled { spec_trans: FloatInput::Constant(t), .. } if *t == 1.0));
}

#[test]
fn pictures_lie_where_options_put_them() {
    let folder = tempfile::tempdir().unwrap();
    photinus_image::write_png8(folder.path().join("White.PNG"), 2, 2, &[[255; 3]; 4]).unwrap();
    let text = "newmtl m\nKd 0.5 0.25 1\nmap_Kd -s 2 3 -o 0.5 -clamp on C:\\art\\white.png\nmap_bump white.png -bm 0.1\n\
                map_d white.png\n";
    let made = make_in(folder.path(), text);
    let chain = made.chain();
    let [
        Material::Mask { .. },
        Material::BumpMap { scale, .. },
        Material::TwoSided { .. },
        Material::Diffuse { reflectance },
    ] = chain.as_slice()
    else {
        panic!("{chain:?}")
    };
    assert_eq!(*scale, 0.1);
    let ColorInput::Texture(id) = reflectance else { panic!() };
    let texture = &made.draft.textures[id.0 as usize];
    assert_eq!(texture.to_uv.transform_point3(Vec3::new(1.0, 1.0, 0.0)), Vec3::new(2.5, 3.0, 0.0));
    let TextureKind::Bitmap { bitmap, wrap: WrapMode::Clamp, .. } = &texture.kind else { panic!() };
    let BitmapPixels::Rgba8 { data, srgb: true } = &bitmap.pixels else { panic!() };
    // 0.5 and 0.25 as sRGB codes.
    assert_eq!(data[0], [188, 137, 255, 255]);
    assert!(made.warnings.is_empty(), "{:?}", made.warnings);

    let made = make_in(folder.path(), "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd white.png\n");
    let Material::Diffuse { reflectance: ColorInput::Texture(id) } = made.innermost() else { panic!() };
    let TextureKind::Scale { factor, .. } = made.draft.textures[id.0 as usize].kind else { panic!() };
    assert_eq!(factor, 0.5, "a grey tint needs no copy of the picture");

    let missing = make_in(
        folder.path(),
        "newmtl m\nKd 0.9 0 0\nmap_Kd gone.png\nmap_Ks gone.png\nKs 0.1 0.1 0.1\nbump gone.png\n",
    );
    assert!(missing.warnings.iter().all(|w| w.contains("gone.png: no such file")), "{:?}", missing.warnings);
    assert_eq!(missing.draft.textures.len(), 1, "mid-grey for the diffuse picture");
}
