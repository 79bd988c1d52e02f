//! What a scene gets that its file does not say: camera, film, light.

use super::framing::default_camera;
use super::{Context, Draft, LoadError, Place};
use crate::{
    Camera, EnvironmentLight, FilmSettings, Filter, FovAxis, IntegratorHint, IntegratorKind, Light, Projection, Scene,
};
use photinus_geometry::{Aabb, Vec3};
use std::path::Path;

/// The picture where the file says nothing of it: 768 x 576 pixels and a Gaussian of half a pixel, as Mitsuba.
pub const DEFAULT_FILM: FilmSettings =
    FilmSettings { width: 768, height: 576, crop: None, filter: Filter::Gaussian { stddev: 0.5 } };

/// Turns a draft into a scene, adding what is missing.
pub(super) fn complete(path: &Path, draft: Draft, context: &mut Context<'_>) -> Result<Scene, LoadError> {
    let place = Place::file(path);
    let mut scene = Scene {
        name: path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default(),
        shapes: draft.shapes,
        materials: draft.materials,
        textures: draft.textures,
        lights: draft.lights,
        camera: framing_camera(Aabb::EMPTY),
        film: draft.film.unwrap_or(DEFAULT_FILM),
        integrator: draft.integrator.unwrap_or(IntegratorHint {
            kind: IntegratorKind::Unspecified,
            max_depth: None,
            hide_emitters: false,
        }),
        warnings: Vec::new(),
    };
    scene.camera = match draft.camera {
        Some(camera) => camera,
        None => {
            context.warn(&place, "no camera: one was made that frames the scene");
            default_camera(&scene)
        }
    };
    if scene.lights.is_empty() && scene.shapes.iter().all(|s| s.emission.is_none()) {
        context.warn(&place, "no light: a constant environment of radiance 1 was added");
        scene.lights.push(Light::Environment(EnvironmentLight::Constant(Vec3::ONE)));
    }
    scene.warnings = context.take_warnings();
    Ok(scene)
}

/// A camera that shows all of `bounds` from the front (+z) and slightly above, with an opening of 45 degrees and y up.
pub fn framing_camera(bounds: Aabb) -> Camera {
    let (center, radius) = if bounds.is_empty() || !bounds.diagonal().is_finite() {
        (Vec3::ZERO, 1.0)
    } else {
        (bounds.center(), (0.5 * bounds.diagonal()).max(1e-6))
    };
    // A sphere of radius r fills an opening of 45 degrees from r / sin(22.5 degrees) = 2.613 r.
    let distance = 2.7 * radius;
    let view = Vec3::new(0.0, 0.3, 1.0).normalize();
    Camera {
        origin: center + view * distance,
        target: center,
        up: Vec3::Y,
        mirrored: false,
        projection: Projection::Perspective { fov_degrees: 45.0, axis: FovAxis::Smaller },
        principal_point: [0.0, 0.0],
        near_clip: 1e-3 * distance,
        far_clip: 1e3 * distance,
    }
}
