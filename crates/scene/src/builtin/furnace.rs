//! A furnace: a closed convex room in which the answer is known in every direction.
//!
//! Every wall emits Le and reflects the share rho of what arrives, so that by balance L = Le + rho L, hence
//! L = Le / (1 - rho) everywhere; after n bounces the sum is Le (1 - rho^(n + 1)) / (1 - rho).

use super::build::{Stage, camera, film, quads};
use crate::Scene;

/// Emitted radiance, W/m²/sr: with the albedo it gives 0.5, which a picture shows without clipping.
const EMISSION: f32 = 0.25;
const ALBEDO: f32 = 0.5;

/// A cube of side 2 around the origin, seen from inside.
pub fn furnace() -> Scene {
    let mut stage = Stage::default();
    let wall = stage.diffuse("wall", [ALBEDO; 3]);
    let p = |bits: usize| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 });
    // Corners are numbered by their signs, x in the lowest bit; every face looks inwards.
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]].map(|f| f.map(p));
    stage.lamp("walls", wall, quads(&faces), [EMISSION; 3]);
    stage.finish(camera([0.4, 0.3, 0.6], [-0.5, -0.4, -1.0], 70.0), film(256, 256), None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Geometry;

    #[test]
    fn every_wall_looks_at_the_middle() {
        let scene = furnace();
        let Geometry::Mesh(mesh) = &scene.shapes[0].geometry else { panic!("the walls are a mesh") };
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
            assert_eq!((b - a).cross(c - a).dot(-a), 4.0, "{a} {b} {c}");
        }
    }
}
