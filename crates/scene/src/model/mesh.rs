//! Geometry: meshes and shapes.

use super::material::MaterialId;
use photinus_geometry::{Sphere, Vec2, Vec3};

/// A triangle mesh in world space. Attribute arrays are empty or as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions, finite.
    pub positions: Vec<Vec3>,
    /// Unit shading normals; empty: the face normal is used.
    pub normals: Vec<Vec3>,
    /// Texture coordinates; empty: barycentrics (alpha, beta) are used.
    pub uvs: Vec<Vec2>,
    /// Vertex colours, linear RGB; empty: none.
    pub colors: Vec<Vec3>,
    /// Vertex indices, in range; the face normal is (B - A) x (C - A).
    pub triangles: Vec<[u32; 3]>,
}

/// What a shape is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Triangles.
    Mesh(Mesh),
    /// An exact sphere.
    Sphere {
        /// Middle and radius in world space.
        sphere: Sphere,
        /// Normals point inwards.
        flip_normals: bool,
        /// World-space unit directions of the local x, y and z axes, which place the texture coordinates: a point in
        /// local direction d has u = atan2(d.y, d.x) / 2 pi (wrapped to 0..1) and v = 1 - acos(d.z) / pi, so v = 1 is
        /// the +z pole. Left-handed where the sphere was mirrored.
        axes: [Vec3; 3],
    },
}

/// One object of the scene: geometry, its material, and the light it gives off.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Name in the file, or one made up from its kind and number.
    pub name: String,
    /// Triangles or a sphere.
    pub geometry: Geometry,
    /// Index into [`Scene::materials`](super::Scene::materials).
    pub material: MaterialId,
    /// Emitted radiance in W/m²/sr (RGB, linear) on the side of the normal; none: not an emitter.
    pub emission: Option<super::ColorInput>,
}

impl Shape {
    /// How many triangles, 0 for a sphere.
    pub fn triangle_count(&self) -> usize {
        match &self.geometry {
            Geometry::Mesh(mesh) => mesh.triangles.len(),
            Geometry::Sphere { .. } => 0,
        }
    }
}
