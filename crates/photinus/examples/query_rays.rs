//! Asks a scene where rays hit it, a slice at a time: `cargo run --release -p photinus --example query_rays`.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::LoadOptions;
use photinus::geometry::{Hit, Ray, Vec3};
use photinus::render::{RenderOptions, Session};

fn main() -> photinus::Result<()> {
    let scene = photinus::open("cornell", &LoadOptions::default())?;
    let (eye, target) = (scene.camera.origin, scene.camera.target);
    let session = Session::new(scene, RenderOptions::default())?;

    // A fan of rays from the camera, in one batch.
    let forward = (target - eye).normalize();
    let rays: Vec<Ray> = (-20..=20).map(|i| Ray::new(eye, forward + Vec3::X * (i as f32 * 0.02))).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    session.closest_hit(&rays, &mut hits);
    for (ray, hit) in rays.iter().zip(&hits) {
        if hit.is_hit() {
            println!("primitive {:>3} at {}", hit.prim, ray.at(hit.t));
        }
    }

    // Is the way back free? A shadow ray stops short of both ends.
    let back: Vec<Ray> = rays
        .iter()
        .zip(&hits)
        .filter(|(_, hit)| hit.is_hit())
        .map(|(ray, hit)| Ray { origin: ray.at(hit.t), dir: eye - ray.at(hit.t), t_min: 1e-3, t_max: 1.0 - 1e-3 })
        .collect();
    let mut occluded = vec![true; back.len()];
    session.any_hit(&back, &mut occluded);
    println!("{} of {} points see the camera", occluded.iter().filter(|o| !**o).count(), back.len());
    Ok(())
}
