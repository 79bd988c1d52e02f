//! Written scenes read back the same, to the last bit.

use crate::common::*;
use photinus_geometry::{Affine3A, Mat3, Sphere, Vec2, Vec3};
use photinus_scene::*;
use std::path::Path;
use std::sync::Arc;

/// The scene without what does not survive: names and warnings.
fn nameless(mut scene: Scene) -> Scene {
    scene.name.clear();
    scene.shapes.iter_mut().for_each(|s| s.name.clear());
    scene.materials.iter_mut().for_each(|m| m.name.clear());
    scene.textures.iter_mut().for_each(|t| t.name.clear());
    scene.warnings.clear();
    scene
}

#[track_caller]
fn comes_back(scene: &Scene, folder: &Path) -> Scene {
    let path = write_mitsuba(scene, folder).unwrap_or_else(|e| panic!("{e}"));
    let back = load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(back.warnings, [], "{}", scene.name);
    let (a, b) = (nameless(scene.clone()), nameless(back.clone()));
    // Piece by piece: a difference is found in a readable place.
    assert_eq!(a.camera, b.camera);
    assert_eq!(a.film, b.film);
    assert_eq!(a.integrator, b.integrator);
    assert_eq!(a.textures, b.textures);
    assert_eq!(a.materials, b.materials);
    assert_eq!(a.lights, b.lights);
    assert_eq!(a.shapes.len(), b.shapes.len());
    for (a, b) in a.shapes.iter().zip(&b.shapes) {
        assert_eq!(a, b);
    }
    assert_eq!(a, b);
    back
}

/// Numbers that no short decimal is: thirds, sevenths, irrational ones.
fn odd(i: u32) -> f32 {
    (libm::sinf(i as f32 * 1.234) * 0.5 + 0.5) * 0.9 + 0.01
}

fn odd3(i: u32) -> Vec3 {
    Vec3::new(odd(i), odd(i + 1), odd(i + 2))
}

fn turn() -> Mat3 {
    Mat3::from_axis_angle(Vec3::new(1.0, 2.0, -0.5).normalize(), 0.77)
}

/// A mesh with all attributes, or only some.
fn mesh(normals: bool, uvs: bool, colors: bool) -> Mesh {
    let positions: Vec<Vec3> = (0..6).map(|i| odd3(i * 7) * 10.0 - Vec3::new(3.3, 0.0, 1e-7)).collect();
    let triangles = vec![[0, 1, 2], [2, 1, 3], [4, 5, 0], [5, 3, 1]];
    // Vertex normals on the side that the faces look to.
    let mut sums = [Vec3::ZERO; 6];
    let mut triangles: Vec<[u32; 3]> = triangles;
    for t in &mut triangles {
        let p = t.map(|v| positions[v as usize]);
        let n = (p[1] - p[0]).cross(p[2] - p[0]);
        if n.z < 0.0 {
            t.swap(1, 2);
        }
        t.iter().for_each(|&v| sums[v as usize] += Vec3::new(n.x, n.y, n.z.abs() * 3.0));
    }
    Mesh {
        normals: if normals { sums.iter().map(|n| n.normalize()).collect() } else { Vec::new() },
        uvs: if uvs { (0..6).map(|i| Vec2::new(odd(i) * 3.0, odd(i + 50) - 0.5)).collect() } else { Vec::new() },
        colors: if colors { (0..6).map(odd3).collect() } else { Vec::new() },
        positions,
        triangles,
    }
}

fn color(i: u32) -> ColorInput {
    ColorInput::Constant(odd3(i))
}

fn number(i: u32) -> FloatInput {
    FloatInput::Constant(odd(i))
}

fn textures() -> Vec<Texture> {
    let float = Arc::new(Bitmap {
        width: 3,
        height: 2,
        pixels: BitmapPixels::RgbaF32((0..6).map(|i| [odd(i), odd(i + 9) * 100.0, 0.0, odd(i)]).collect()),
    });
    let bytes = |srgb| {
        let data = (0..4u8).map(|i| [i * 60, 255 - i, 7 * i, 100 + i]).collect();
        Arc::new(Bitmap { width: 2, height: 2, pixels: BitmapPixels::Rgba8 { data, srgb } })
    };
    let encoded = bytes(true);
    let map = Affine3A::from_mat3_translation(
        Mat3::from_cols(Vec3::new(2.0, 0.1, 0.0), Vec3::new(-0.3, 3.0, 0.0), Vec3::Z),
        Vec3::new(odd(3), 0.125, 0.0),
    );
    let bitmap =
        |bitmap: &Arc<Bitmap>, filter, wrap, alpha| TextureKind::Bitmap { bitmap: bitmap.clone(), filter, wrap, alpha };
    let kinds = [
        bitmap(&float, TextureFilter::Bilinear, WrapMode::Repeat, false),
        bitmap(&encoded, TextureFilter::Nearest, WrapMode::Mirror, false),
        bitmap(&bytes(false), TextureFilter::Bilinear, WrapMode::Clamp, false),
        bitmap(&encoded, TextureFilter::Bilinear, WrapMode::Repeat, true),
        TextureKind::Checkerboard { a: color(5), b: ColorInput::Texture(TextureId(1)) },
        TextureKind::Scale { input: ColorInput::Texture(TextureId(4)), factor: 0.3 },
        TextureKind::Scale { input: color(8), factor: 2.5 },
        TextureKind::VertexColor,
    ];
    let placed = |kind: &TextureKind| matches!(kind, TextureKind::Bitmap { .. } | TextureKind::Checkerboard { .. });
    let mut textures: Vec<Texture> = Vec::new();
    for (i, kind) in kinds.into_iter().enumerate() {
        let to_uv = if i % 2 == 1 || !placed(&kind) { Affine3A::IDENTITY } else { map };
        textures.push(Texture { name: format!("odd <name> & \"{i}\" $x"), kind, to_uv });
    }
    // Both kinds with and without a map.
    let plain = TextureKind::Checkerboard { a: color(6), b: color(7) };
    textures.push(Texture { name: String::new(), kind: plain, to_uv: Affine3A::IDENTITY });
    textures
}

fn materials() -> Vec<Material> {
    use MicrofacetModel::{Beckmann, Ggx};
    let texture = |i| ColorInput::Texture(TextureId(i));
    let zero = ColorInput::Constant(Vec3::ZERO);
    vec![
        Material::Diffuse { reflectance: texture(0) },
        Material::Dielectric {
            int_ior: 1.5168,
            ext_ior: 1.0,
            specular_reflectance: color(1),
            specular_transmittance: color(2),
        },
        Material::ThinDielectric {
            int_ior: 1.3,
            ext_ior: 1.1,
            specular_reflectance: color(3),
            specular_transmittance: texture(1),
        },
        Material::RoughDielectric {
            model: Ggx,
            alpha: [number(4), FloatInput::Texture(TextureId(3))],
            int_ior: 1.7,
            ext_ior: 1.0,
            specular_reflectance: color(5),
            specular_transmittance: color(6),
        },
        Material::Conductor { eta: zero, k: zero, specular_reflectance: color(7) },
        Material::Conductor {
            eta: ColorInput::Constant(odd3(8) * 3.0),
            k: ColorInput::Constant(odd3(9) * 7.0),
            specular_reflectance: color(10),
        },
        Material::RoughConductor {
            model: Beckmann,
            alpha: [number(11), number(11)],
            eta: zero,
            k: color(12),
            specular_reflectance: color(13),
        },
        Material::Plastic {
            int_ior: 1.49,
            ext_ior: 1.000277,
            diffuse_reflectance: texture(4),
            specular_reflectance: color(14),
            nonlinear: true,
        },
        Material::RoughPlastic {
            model: Ggx,
            alpha: number(15),
            int_ior: 1.49,
            ext_ior: 1.0,
            diffuse_reflectance: color(16),
            specular_reflectance: color(17),
            nonlinear: false,
        },
        Material::Principled {
            base_color: texture(5),
            roughness: number(18),
            anisotropic: number(19),
            metallic: number(20),
            spec_trans: number(21),
            eta: 1.45,
            spec_tint: number(22),
            sheen: number(23),
            sheen_tint: number(24),
            flatness: number(25),
            clearcoat: number(26),
            clearcoat_gloss: FloatInput::Texture(TextureId(2)),
        },
        Material::Thesis {
            int_ior: 1.33,
            ext_ior: 1.0,
            roughness: number(27),
            reflectance: color(28),
            transmittance: color(29),
        },
        Material::Null,
        Material::TwoSided { front: MaterialId(0), back: MaterialId(0) },
        Material::TwoSided { front: MaterialId(8), back: MaterialId(4) },
        Material::Mask { opacity: FloatInput::Texture(TextureId(3)), nested: MaterialId(12) },
        Material::Mask { opacity: FloatInput::Texture(TextureId(1)), nested: MaterialId(0) },
        Material::Blend { weight: number(30), a: MaterialId(0), b: MaterialId(5) },
        Material::BumpMap { height: TextureId(2), scale: 0.05, nested: MaterialId(8) },
        Material::NormalMap { normals: TextureId(2), nested: MaterialId(0) },
    ]
}

fn everything() -> Scene {
    let materials: Vec<NamedMaterial> =
        materials().into_iter().map(|material| NamedMaterial { name: "same".into(), material }).collect();
    let axes = [turn().x_axis, turn().y_axis, turn().z_axis];
    let mut shapes = Vec::new();
    for (i, attributes) in
        [(true, true, true), (false, false, false), (true, false, false), (false, true, true)].iter().enumerate()
    {
        shapes.push(Shape {
            name: format!("m\u{e9}sh/{i}"),
            geometry: Geometry::Mesh(mesh(attributes.0, attributes.1, attributes.2)),
            material: MaterialId(i as u32),
            emission: None,
        });
    }
    for (i, (axes, flip_normals)) in [
        ([Vec3::X, Vec3::Y, Vec3::Z], false),
        (axes, true),
        ([axes[1], axes[0], axes[2]], false),
        ([-axes[0], axes[1], axes[2]], true),
    ]
    .into_iter()
    .enumerate()
    {
        let sphere = Sphere { center: odd3(i as u32 * 3) * 7.0, radius: odd(i as u32) };
        shapes.push(Shape {
            name: String::new(),
            geometry: Geometry::Sphere { sphere, flip_normals, axes },
            material: MaterialId(materials.len() as u32 - 1 - i as u32),
            emission: match i {
                0 => Some(ColorInput::Constant(odd3(40) * 100.0)),
                1 => Some(ColorInput::Texture(TextureId(0))),
                _ => None,
            },
        });
    }
    let environment = Arc::new(Bitmap {
        width: 4,
        height: 2,
        pixels: BitmapPixels::RgbaF32((0..8).map(|i| [odd(i) * 50.0, odd(i + 1), 0.0, 1.0]).collect()),
    });
    let lights = vec![
        Light::Point { position: odd3(50) * 9.0, intensity: odd3(51) * 30.0 },
        Light::Spot {
            position: odd3(52),
            direction: Vec3::new(0.3, -0.7, 0.2).normalize(),
            intensity: odd3(53),
            cutoff_angle: 0.7123,
            beam_width: 0.333_333_34,
        },
        Light::Spot {
            position: Vec3::ZERO,
            direction: Vec3::X,
            intensity: Vec3::ONE,
            cutoff_angle: 0.3,
            beam_width: 0.3,
        },
        Light::Directional { direction: Vec3::new(-1.0, -2.0, 0.4).normalize(), irradiance: odd3(54) },
        Light::Environment(EnvironmentLight::Image {
            bitmap: environment,
            scale: 0.7,
            to_world: Affine3A::from_mat3(turn()),
        }),
    ];
    Scene {
        name: "everything".into(),
        shapes,
        materials,
        textures: textures(),
        lights,
        camera: Camera {
            origin: odd3(60) * 5.0,
            target: odd3(61),
            up: Vec3::new(0.1, 1.0, -0.2),
            mirrored: false,
            projection: Projection::Perspective { fov_degrees: 39.307_65, axis: FovAxis::Smaller },
            principal_point: [0.1, -0.037],
            near_clip: 0.013,
            far_clip: 1234.5,
        },
        film: FilmSettings { width: 321, height: 123, crop: Some([3, 5, 100, 50]), filter: Filter::Box },
        integrator: IntegratorHint { kind: IntegratorKind::Full, max_depth: Some(17), hide_emitters: true },
        warnings: Vec::new(),
    }
}

#[test]
fn a_scene_with_everything() {
    let folder = Folder::new();
    let scene = everything();
    let back = comes_back(&scene, &folder.path("out"));
    assert_eq!(back.name, "everything");
    // Names come back too where they are unique and not empty.
    assert_eq!(back.shapes[0].name, "m\u{e9}sh/0");
    assert_eq!(back.textures[3].name, "odd <name> & \"3\" $x");
    // Writing what was read gives the same files, byte by byte.
    let again = write_mitsuba(&back, &folder.path("again")).unwrap();
    let text = |p: &Path| std::fs::read_to_string(p).unwrap();
    assert_eq!(text(&folder.path("out/everything.xml")), text(&again));
}

#[test]
fn every_camera_film_and_integrator() {
    let folder = Folder::new();
    let mut scene = everything();
    scene.shapes.clear();
    scene.materials.clear();
    scene.textures.clear();
    scene.lights.truncate(1);
    let fov = 61.7;
    for axis in [FovAxis::X, FovAxis::Y, FovAxis::Diagonal, FovAxis::Smaller, FovAxis::Larger] {
        let lens = Projection::ThinLens { fov_degrees: fov, axis, aperture_radius: 0.31, focus_distance: 7.77 };
        for projection in
            [Projection::Perspective { fov_degrees: fov, axis }, lens, Projection::Orthographic { half_width: 3.3 }]
        {
            for mirrored in [false, true] {
                scene.camera.projection = projection;
                scene.camera.mirrored = mirrored;
                comes_back(&scene, folder.0.path());
            }
        }
    }
    for filter in [
        Filter::Box,
        Filter::Tent { radius: 1.3 },
        Filter::Gaussian { stddev: 0.61 },
        Filter::Mitchell { b: 0.2, c: 0.7 },
        Filter::CatmullRom,
        Filter::Lanczos { lobes: 4 },
    ] {
        scene.film = FilmSettings { width: 7, height: 9, crop: None, filter };
        comes_back(&scene, folder.0.path());
    }
    for (kind, max_depth) in [
        (IntegratorKind::Unspecified, None),
        (IntegratorKind::Direct, Some(2)),
        (IntegratorKind::Full, None),
        (IntegratorKind::Full, Some(1)),
    ] {
        scene.integrator = IntegratorHint { kind, max_depth, hide_emitters: false };
        comes_back(&scene, folder.0.path());
    }
    scene.lights = vec![Light::Environment(EnvironmentLight::Constant(odd3(70)))];
    comes_back(&scene, folder.0.path());
}

#[test]
fn built_in_scenes_come_back() {
    let folder = Folder::new();
    // The larger rooms come from the same generator as the smallest.
    for entry in builtin::list().iter().filter(|b| b.triangles < 60_000) {
        let back = comes_back(&entry.build(), &folder.path(entry.name));
        assert_eq!((back.name.as_str(), back.triangle_count()), (entry.name, entry.triangles));
    }
}

#[test]
fn broken_scenes_are_not_written() {
    let folder = Folder::new();
    let mut scene = everything();
    scene.shapes[0].material = MaterialId(1000);
    assert!(write_mitsuba(&scene, folder.0.path()).unwrap_err().to_string().contains("no material"));
    let file = folder.write("file", "");
    assert!(write_mitsuba(&everything(), &file).unwrap_err().to_string().contains("file"));
}
