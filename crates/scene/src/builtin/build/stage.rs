//! A scene under construction: materials, textures and shapes are added and named by their ids.

use crate::{
    Camera, ColorInput, FilmSettings, Filter, FovAxis, Geometry, IntegratorHint, IntegratorKind, Light, Material,
    MaterialId, Mesh, NamedMaterial, Projection, Scene, Shape, Texture, TextureId,
};
use photinus_geometry::{Sphere, Vec3};

/// Collects the parts of a scene.
#[derive(Default)]
pub struct Stage {
    shapes: Vec<Shape>,
    materials: Vec<NamedMaterial>,
    /// In the order of their ids, as soon as their pictures are there.
    textures: Vec<Box<dyn FnOnce() -> Texture>>,
    lights: Vec<Light>,
    /// Satin surfaces are waxed.
    pub(super) waxed: bool,
}

impl Stage {
    /// A stage whose satin surfaces wear a coat of wax: thinner in index than varnish, and smooth enough to mirror.
    pub fn waxed() -> Self {
        Self { waxed: true, ..Self::default() }
    }

    /// Adds a material.
    pub fn material(&mut self, name: &str, material: Material) -> MaterialId {
        self.materials.push(NamedMaterial { name: name.to_owned(), material });
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// Adds a material that looks the same from both sides.
    pub fn two_sided(&mut self, name: &str, material: Material) -> MaterialId {
        let inner = self.material(&format!("{name}-side"), material);
        self.material(name, Material::TwoSided { front: inner, back: inner })
    }

    /// The material of this name.
    pub fn find_material(&self, name: &str) -> Option<MaterialId> {
        self.materials.iter().position(|m| m.name == name).map(|i| MaterialId(i as u32))
    }

    /// Adds a Lambertian material of this albedo, the same from both sides.
    pub fn diffuse(&mut self, name: &str, albedo: [f32; 3]) -> MaterialId {
        self.two_sided(name, Material::Diffuse { reflectance: rgb(albedo) })
    }

    /// Adds clear glass of index 1.5 in air, for closed surfaces with outward normals.
    pub fn glass(&mut self, name: &str) -> MaterialId {
        self.material(
            name,
            Material::Dielectric {
                int_ior: 1.5,
                ext_ior: 1.0,
                specular_reflectance: rgb([1.0; 3]),
                specular_transmittance: rgb([1.0; 3]),
            },
        )
    }

    /// Adds a perfect mirror that reflects this share.
    pub fn mirror(&mut self, name: &str, reflectance: [f32; 3]) -> MaterialId {
        self.two_sided(
            name,
            Material::Conductor { eta: rgb([0.0; 3]), k: rgb([0.0; 3]), specular_reflectance: rgb(reflectance) },
        )
    }

    /// Adds a mesh.
    pub fn mesh(&mut self, name: &str, material: MaterialId, mesh: impl Into<Mesh>) {
        let geometry = Geometry::Mesh(mesh.into());
        self.shapes.push(Shape { name: name.to_owned(), geometry, material, emission: None });
    }

    /// Adds a mesh that gives off this radiance (W/m²/sr, RGB) on the side of its normals.
    pub fn lamp(&mut self, name: &str, material: MaterialId, mesh: impl Into<Mesh>, radiance: [f32; 3]) {
        self.mesh(name, material, mesh);
        self.light_last(radiance);
    }

    /// Lets the last shape give off this radiance (W/m²/sr, RGB) on the side of its normals.
    pub fn light_last(&mut self, radiance: [f32; 3]) {
        if let Some(shape) = self.shapes.last_mut() {
            shape.emission = Some(rgb(radiance));
        }
    }

    /// Adds an exact sphere.
    pub fn sphere(&mut self, name: &str, material: MaterialId, center: [f32; 3], radius: f32) {
        self.add_sphere(name, material, center, radius, false);
    }

    /// Adds an exact sphere that is seen from inside.
    pub fn hollow_sphere(&mut self, name: &str, material: MaterialId, center: [f32; 3], radius: f32) {
        self.add_sphere(name, material, center, radius, true);
    }

    fn add_sphere(&mut self, name: &str, material: MaterialId, center: [f32; 3], radius: f32, flip_normals: bool) {
        self.shapes.push(Shape {
            name: name.to_owned(),
            geometry: Geometry::Sphere {
                sphere: Sphere { center: Vec3::from(center), radius },
                flip_normals,
                axes: [Vec3::X, Vec3::Y, Vec3::Z],
            },
            material,
            emission: None,
        });
    }

    /// Adds a light without geometry.
    pub fn light(&mut self, light: Light) {
        self.lights.push(light);
    }

    /// Adds a texture, which is asked for when the scene is finished.
    pub fn texture(&mut self, texture: impl FnOnce() -> Texture + 'static) -> TextureId {
        self.textures.push(Box::new(texture));
        TextureId(self.textures.len() as u32 - 1)
    }

    fn triangle_count(&self) -> usize {
        self.shapes.iter().map(Shape::triangle_count).sum()
    }

    /// Triangles that are missing to `target`, 0 when there are as many or more.
    pub fn missing_to(&self, target: usize) -> usize {
        target.saturating_sub(self.triangle_count())
    }

    /// The finished scene; paths have at most `max_depth` segments as Mitsuba counts them.
    pub fn finish(self, camera: Camera, film: FilmSettings, max_depth: Option<u32>) -> Scene {
        Scene {
            name: String::new(),
            shapes: self.shapes,
            materials: self.materials,
            textures: self.textures.into_iter().map(|texture| texture()).collect(),
            lights: self.lights,
            camera,
            film,
            integrator: IntegratorHint { kind: IntegratorKind::Full, max_depth, hide_emitters: false },
            warnings: Vec::new(),
        }
    }
}

/// A constant colour input.
pub fn rgb(color: [f32; 3]) -> ColorInput {
    ColorInput::Constant(Vec3::from(color))
}

/// A pinhole camera with its field of view measured along the shorter edge, +y up.
pub fn camera(origin: [f32; 3], target: [f32; 3], fov_degrees: f32) -> Camera {
    Camera {
        origin: Vec3::from(origin),
        target: Vec3::from(target),
        up: Vec3::Y,
        mirrored: false,
        projection: Projection::Perspective { fov_degrees, axis: FovAxis::Smaller },
        principal_point: [0.0; 2],
        near_clip: 0.01,
        far_clip: 1e5,
    }
}

/// A picture of this size with box-filtered pixels.
pub fn film(width: u32, height: u32) -> FilmSettings {
    FilmSettings { width, height, crop: None, filter: Filter::Box }
}

/// A flat-shaded mesh of quadrilaterals, each cut along its first diagonal; the normal side sees the corners
/// counter-clockwise.
pub fn quads(corners: &[[[f32; 3]; 4]]) -> Mesh {
    let mut mesh = Mesh::default();
    for quad in corners {
        let base = mesh.positions.len() as u32;
        mesh.positions.extend(quad.iter().map(|&p| Vec3::from(p)));
        mesh.triangles.push([base, base + 1, base + 2]);
        mesh.triangles.push([base, base + 2, base + 3]);
    }
    mesh
}
