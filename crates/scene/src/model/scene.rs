//! A whole scene.

use super::{Camera, FilmSettings, IntegratorHint, Light, NamedMaterial, Shape, Texture};
use photinus_geometry::Aabb;
use std::path::PathBuf;

/// Something a file says that was read otherwise than written, or not at all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The file.
    pub file: PathBuf,
    /// Line, from 1; 0 where a line means nothing.
    pub line: u32,
    /// What was wrong and what was done instead.
    pub message: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.file.display())?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        write!(f, ": {}", self.message)
    }
}

/// A scene in world space, complete: it has a camera, and light unless its maker wanted it dark.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// A short name: the file's stem or the built-in's name.
    pub name: String,
    /// All objects.
    pub shapes: Vec<Shape>,
    /// All materials; nested ones come before those around them.
    pub materials: Vec<NamedMaterial>,
    /// All textures.
    pub textures: Vec<Texture>,
    /// Lights without geometry; at most one is an environment.
    pub lights: Vec<Light>,
    /// The view.
    pub camera: Camera,
    /// The picture.
    pub film: FilmSettings,
    /// What the file says of the integrator.
    pub integrator: IntegratorHint,
    /// What was read otherwise than written.
    pub warnings: Vec<Warning>,
}

impl Scene {
    /// Triangles of all meshes.
    pub fn triangle_count(&self) -> usize {
        self.shapes.iter().map(Shape::triangle_count).sum()
    }

    /// Exact spheres.
    pub fn sphere_count(&self) -> usize {
        self.shapes.iter().filter(|shape| matches!(shape.geometry, super::Geometry::Sphere { .. })).count()
    }

    /// Bounds of all shapes; empty where there are none.
    pub fn bounds(&self) -> Aabb {
        self.shapes.iter().fold(Aabb::EMPTY, |b, s| {
            b.union(match &s.geometry {
                super::Geometry::Mesh(m) => {
                    Aabb::around(m.triangles.iter().flatten().map(|&v| m.positions[v as usize]))
                }
                super::Geometry::Sphere { sphere, .. } => {
                    Aabb { min: sphere.center - sphere.radius, max: sphere.center + sphere.radius }
                }
            })
        })
    }
}
