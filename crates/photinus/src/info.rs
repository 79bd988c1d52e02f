//! What is in a scene, counted.

use photinus_geometry::Vec3;
use photinus_scene::{EnvironmentLight, Light, Projection, Scene};
use serde::Serialize;
use std::collections::BTreeMap;

/// A description of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneInfo {
    /// Name of the file or built-in scene.
    pub name: String,
    /// Triangles of all meshes.
    pub triangles: u64,
    /// Meshes.
    pub meshes: u64,
    /// Exact spheres.
    pub spheres: u64,
    /// Materials, nested ones included.
    pub materials: u64,
    /// Lights of every kind, area lights included.
    pub lights: u64,
    /// The same by kind.
    pub lights_by_kind: LightKinds,
    /// Textures.
    pub textures: u64,
    /// Bytes of the textures' and the environment's pixels.
    pub texture_bytes: u64,
    /// The view.
    pub camera: CameraInfo,
    /// Bounds of everything; none where there is nothing.
    pub bounds: Option<BoundsInfo>,
    /// What was read otherwise than written, one line each.
    pub warnings: Vec<String>,
}

/// Lights by their kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LightKinds {
    /// Shapes that emit.
    pub area: u64,
    /// Point lights.
    pub point: u64,
    /// Spots.
    pub spot: u64,
    /// Parallel light.
    pub directional: u64,
    /// Environments, of one colour or from a picture.
    pub environment: u64,
}

/// The view and its picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CameraInfo {
    /// `perspective`, `thin-lens` or `orthographic`.
    pub projection: &'static str,
    /// Position, scene units.
    pub origin: [f32; 3],
    /// A point in the middle of the picture.
    pub target: [f32; 3],
    /// Up in the picture.
    pub up: [f32; 3],
    /// Full opening angle in degrees; none for orthographic views.
    pub fov_degrees: Option<f32>,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

/// A box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BoundsInfo {
    /// Lowest coordinates, scene units.
    pub min: [f32; 3],
    /// Highest coordinates.
    pub max: [f32; 3],
}

impl SceneInfo {
    /// Describes `scene`.
    pub fn of(scene: &Scene) -> Self {
        let spheres = scene.sphere_count();
        let bounds = scene.bounds();
        let lights_by_kind = LightKinds::of(scene);
        Self {
            name: scene.name.clone(),
            triangles: scene.triangle_count() as u64,
            meshes: (scene.shapes.len() - spheres) as u64,
            spheres: spheres as u64,
            materials: scene.materials.len() as u64,
            lights: lights_by_kind.sum(),
            lights_by_kind,
            textures: scene.textures.len() as u64,
            texture_bytes: texture_bytes(scene),
            camera: CameraInfo::of(scene),
            bounds: (!bounds.is_empty()).then(|| BoundsInfo { min: bounds.min.to_array(), max: bounds.max.to_array() }),
            warnings: scene.warnings.iter().map(ToString::to_string).collect(),
        }
    }
}

impl LightKinds {
    fn of(scene: &Scene) -> Self {
        let area = scene.shapes.iter().filter(|shape| shape.emission.is_some()).count() as u64;
        let mut info = Self { area, ..Self::default() };
        for light in &scene.lights {
            match light {
                Light::Point { .. } => info.point += 1,
                Light::Spot { .. } => info.spot += 1,
                Light::Directional { .. } => info.directional += 1,
                Light::Environment(_) => info.environment += 1,
            }
        }
        info
    }

    fn sum(&self) -> u64 {
        self.area + self.point + self.spot + self.directional + self.environment
    }
}

impl CameraInfo {
    fn of(scene: &Scene) -> Self {
        let camera = &scene.camera;
        let (projection, fov_degrees) = match camera.projection {
            Projection::Perspective { fov_degrees, .. } => ("perspective", Some(fov_degrees)),
            Projection::ThinLens { fov_degrees, .. } => ("thin-lens", Some(fov_degrees)),
            Projection::Orthographic { .. } => ("orthographic", None),
        };
        let array = |v: Vec3| v.to_array();
        Self {
            projection,
            origin: array(camera.origin),
            target: array(camera.target),
            up: array(camera.up),
            fov_degrees,
            width: scene.film.width,
            height: scene.film.height,
        }
    }
}

/// Bytes of all pictures; one that is used several times counts once.
fn texture_bytes(scene: &Scene) -> u64 {
    use photinus_scene::TextureKind;
    let mut pictures = BTreeMap::new();
    for texture in &scene.textures {
        if let TextureKind::Bitmap { bitmap, .. } = &texture.kind {
            pictures.insert(std::sync::Arc::as_ptr(bitmap), bitmap.bytes() as u64);
        }
    }
    for light in &scene.lights {
        if let Light::Environment(EnvironmentLight::Image { bitmap, .. }) = light {
            pictures.insert(std::sync::Arc::as_ptr(bitmap), bitmap.bytes() as u64);
        }
    }
    pictures.values().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_scene::builtin;

    #[test]
    fn the_counts_of_a_known_scene_are_right() {
        let info = SceneInfo::of(&builtin::build("two-spheres").unwrap());
        assert_eq!((info.triangles, info.spheres, info.lights), (22, 2, 1));
        assert_eq!(info.lights_by_kind, LightKinds { area: 1, ..LightKinds::default() });
        assert!(info.bounds.is_some() && info.warnings.is_empty());
    }

    #[test]
    fn an_empty_scene_has_no_bounds() {
        let mut scene = builtin::build("furnace").unwrap();
        scene.shapes.clear();
        assert_eq!(SceneInfo::of(&scene).bounds, None);
    }
}
