//! Scenes made in code, and renders of them in one line.
#![allow(dead_code)]

use photinus_accel as accel;
use photinus_geometry::{Sphere, Vec2, Vec3};
use photinus_render::bsdf::SurfaceModel;
use photinus_render::{Compiled, Counters, Mode, Renderer, Settings, Silent, World};
use photinus_scene::*;

pub const SEED: u64 = 2_010;

pub fn camera(origin: Vec3, target: Vec3, fov_degrees: f32) -> Camera {
    let up = if (target - origin).normalize().y.abs() > 0.99 { Vec3::Z } else { Vec3::Y };
    Camera {
        origin,
        target,
        up,
        mirrored: false,
        projection: Projection::Perspective { fov_degrees, axis: FovAxis::X },
        principal_point: [0.0; 2],
        near_clip: 0.0,
        far_clip: f32::INFINITY,
    }
}

pub fn scene(camera: Camera, size: u32) -> Scene {
    Scene {
        name: "test".to_owned(),
        shapes: Vec::new(),
        materials: Vec::new(),
        textures: Vec::new(),
        lights: Vec::new(),
        camera,
        film: FilmSettings { width: size, height: size, crop: None, filter: Filter::Box },
        integrator: IntegratorHint { kind: IntegratorKind::Unspecified, max_depth: None, hide_emitters: false },
        warnings: Vec::new(),
    }
}

pub trait Add {
    fn material(&mut self, material: Material) -> MaterialId;
    fn sphere(&mut self, center: Vec3, radius: f32, inwards: bool, material: MaterialId, emission: Option<f32>);
    fn quad(&mut self, corner: Vec3, u: Vec3, v: Vec3, material: MaterialId, emission: Option<f32>);
}

impl Add for Scene {
    fn material(&mut self, material: Material) -> MaterialId {
        self.materials.push(NamedMaterial { name: format!("m{}", self.materials.len()), material });
        MaterialId(self.materials.len() as u32 - 1)
    }

    fn sphere(&mut self, center: Vec3, radius: f32, inwards: bool, material: MaterialId, emission: Option<f32>) {
        self.shapes.push(Shape {
            name: format!("s{}", self.shapes.len()),
            geometry: Geometry::Sphere {
                sphere: Sphere { center, radius },
                flip_normals: inwards,
                axes: [Vec3::X, Vec3::Y, Vec3::Z],
            },
            material,
            emission: emission.map(|e| ColorInput::Constant(Vec3::splat(e))),
        });
    }

    /// Two triangles; the normal is u x v.
    fn quad(&mut self, corner: Vec3, u: Vec3, v: Vec3, material: MaterialId, emission: Option<f32>) {
        self.shapes.push(Shape {
            name: format!("q{}", self.shapes.len()),
            geometry: Geometry::Mesh(Mesh {
                positions: vec![corner, corner + u, corner + u + v, corner + v],
                normals: Vec::new(),
                uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
                colors: Vec::new(),
                triangles: vec![[0, 1, 2], [0, 2, 3]],
            }),
            material,
            emission: emission.map(|e| ColorInput::Constant(Vec3::splat(e))),
        });
    }
}

pub fn diffuse(albedo: f32) -> Material {
    Material::Diffuse { reflectance: ColorInput::Constant(Vec3::splat(albedo)) }
}

pub fn black() -> Material {
    diffuse(0.0)
}

pub fn mirror(reflectance: f32) -> Material {
    Material::Conductor {
        eta: ColorInput::Constant(Vec3::ZERO),
        k: ColorInput::Constant(Vec3::ZERO),
        specular_reflectance: ColorInput::Constant(Vec3::splat(reflectance)),
    }
}

pub fn glass(ior: f32) -> Material {
    Material::Dielectric {
        int_ior: ior,
        ext_ior: 1.0,
        specular_reflectance: ColorInput::Constant(Vec3::ONE),
        specular_transmittance: ColorInput::Constant(Vec3::ONE),
    }
}

pub fn world(scene: Scene) -> World {
    world_with(scene, SurfaceModel::Physical)
}

pub fn world_with(scene: Scene, model: SurfaceModel) -> World {
    let compiled = Compiled::new(scene);
    let structure = accel::build("wide-bvh", compiled.primitives().clone(), &accel::BuildOptions::default())
        .expect("the scene is small");
    compiled.with_structure(structure, model)
}

/// Pixels (RGB) and counters of a render.
pub fn render(world: &World, settings: Settings, passes: u32) -> (Vec<Vec3>, Counters) {
    let mut renderer = Renderer::new(world, settings, &Silent).expect("nothing stops it");
    for _ in 0..passes {
        renderer.render_pass(&Silent).expect("nothing stops it");
    }
    let channels = renderer.layout().channels();
    let pixels = renderer.pixels().chunks_exact(channels).map(|p| Vec3::new(p[0], p[1], p[2])).collect();
    (pixels, *renderer.counters())
}

pub fn settings(mode: Mode) -> Settings {
    Settings { mode, seed: SEED, ..Settings::default() }
}

pub fn mean(pixels: &[Vec3]) -> f64 {
    pixels.iter().map(|p| f64::from(p.x + p.y + p.z) / 3.0).sum::<f64>() / pixels.len() as f64
}
