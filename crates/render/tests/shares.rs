//! The part of an estimate's disc that is there: surfaces that let a part of the light through, triangles far larger than
//! the radius, passes that were stopped.

mod common;

use common::*;
use photinus_geometry::Vec3;
use photinus_render::{Mode, Observer, Renderer, Settings, Silent};
use photinus_scene::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// The inside of a cube of edge 2 that shines.
fn room(size: u32) -> (Scene, MaterialId) {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::NEG_Z, 60.0), size);
    let id = scene.material(diffuse(0.5));
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|a| Vec3::AXES[a] * 2.0);
        scene.quad(Vec3::NEG_ONE, u, v, id, Some(0.25));
        scene.quad(Vec3::NEG_ONE + Vec3::AXES[axis] * 2.0, v, u, id, Some(0.25));
    }
    (scene, id)
}

/// Photons land on a sheet that is partly clear in proportion to how much of it is solid; so do the points that are looked
/// for. A solid part below one half was once taken for none: 39 % too bright.
#[test]
fn sheets_that_are_partly_clear() {
    for opacity in [0.7, 0.45] {
        let (mut scene, id) = room(48);
        let mask = scene.material(Material::Mask { opacity: FloatInput::Constant(opacity), nested: id });
        scene.quad(Vec3::new(-0.5, -0.5, -0.5), Vec3::X, Vec3::Y, mask, Some(0.25));
        scene.quad(Vec3::new(-0.5, -0.5, -0.501), Vec3::Y, Vec3::X, mask, Some(0.25));
        let world = world(scene);
        let [path, found] = [Mode::Path, Mode::Progressive].map(|mode| {
            let settings = Settings { photons: Some(60_000), spp: 4, radius: Some(0.05), ..settings(mode) };
            let pixels = render(&world, settings, 8).0;
            let middle: Vec<Vec3> =
                (16..32).flat_map(|y| (16..32).map(move |x| y * 48 + x)).map(|i| pixels[i]).collect();
            mean(&middle)
        });
        // Means over 256 pixels of 32 samples; the inverse of a share that is a matter of chance errs by a few hundredths.
        assert!((found / path - 1.0).abs() < 0.07, "opacity {opacity}: {found}, path {path}");
    }
}

/// On a triangle of 27,000 units a hit is off the plane by a tenth of the radius of 0.02: rays that start no higher above
/// it miss it.
#[test]
fn triangles_far_larger_than_the_radius() {
    let (a, normal) = (Vec3::new(0.36, 0.48, 0.8), Vec3::new(-0.8, 0.6, 0.0));
    let b = normal.cross(a);
    let mut scene = scene(camera(normal + Vec3::new(0.01, 0.02, 0.0), Vec3::ZERO, 60.0), 48);
    let id = scene.material(diffuse(0.5));
    let half = 13_700.0;
    scene.quad((a + b) * -half, a * (2.0 * half), b * (2.0 * half), id, None);
    scene.sphere(Vec3::ZERO, 3.0, true, id, Some(0.25));
    let world = world(scene);
    let [path, found] = [Mode::Path, Mode::Progressive].map(|mode| {
        let settings = Settings { photons: Some(60_000), spp: 4, radius: Some(0.02), ..settings(mode) };
        mean(&render(&world, settings, 8).0)
    });
    assert!((found / path - 1.0).abs() < 0.015, "{found}, path {path}");
}

/// Stops when it has been asked this often.
struct StopAfter(AtomicU32);

impl Observer for StopAfter {
    fn cancelled(&self) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| Some(left.saturating_sub(1))) == Ok(0)
    }
}

/// What a pass saw before it was stopped does not steer the one in its stead.
#[test]
fn a_stopped_pass_leaves_nothing_behind() {
    let world = world(room(96).0);
    let settings = Settings { photons: Some(60_000), spp: 4, radius: Some(0.1), ..settings(Mode::Progressive) };
    let whole = render(&world, settings.clone(), 2).0;
    let mut renderer = Renderer::new(&world, settings, &Silent).expect("nothing stops it");
    // The photon pass asks once for each of 30 batches, the eye pass for each of 9 tiles and 4 samples of it.
    assert!(renderer.render_pass(&StopAfter(50.into())).is_err());
    assert!(renderer.has_picture());
    for _ in 0..2 {
        renderer.render_pass(&Silent).expect("nothing stops it");
    }
    let channels = renderer.layout().channels();
    let pixels: Vec<Vec3> = renderer.pixels().chunks_exact(channels).map(|p| Vec3::new(p[0], p[1], p[2])).collect();
    assert!(pixels == whole, "what was seen before the stop shows");
}
