//! Direct light: shadow rays from visible points to points on lights.

use crate::SurfacePoint;
use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::eye_pass::{EyePass, Path, R2, survival};
use crate::shadow_photons::Verdicts;
use crate::tile::Part;
use crate::trace::shadow_ray;
use photinus_geometry::{Ray, Vec3};

/// A shadow ray, and what it brings where nothing is in its way.
pub(crate) struct Shadow {
    pub ray: Ray,
    /// Record of the ray that led here.
    pub record: u32,
    pub pixel: u32,
    /// The share of the light that is seen, where photons say: no ray is sent.
    pub known: Option<f32>,
    /// Where it counts for the choice of lights.
    pub slot: Option<u32>,
    pub diffuse: (Vec3, Part),
    pub glossy: (Vec3, Part),
}

impl EyePass<'_> {
    /// Direct light by shadow rays, the choice of lights stratified over them.
    pub(crate) fn light(&self, path: &mut Path, point: &SurfacePoint, bsdf: &Bsdf, shadows: &mut Vec<Shadow>) {
        let (u, choice) = (path.sampler.next_2d(), path.sampler.next_1d());
        // What is seen weakly, as in a coat, is worth fewer.
        let worth = self.shadow_rays as f32 * path.throughput.max_element().min(1.0);
        let count = if path.diffuse == 0 { (worth.ceil() as u32).max(1) } else { 1 };
        path.last_shadows = count as f32;
        let verdicts = self.shadow_photons.map(|photons| photons.ask(point.position, bsdf.geometric_normal()));
        for i in 0..count {
            let step = |u: f32, by: f32| (u + i as f32 * by).fract();
            let u = [step(u[0], R2[0]), step(u[1], R2[1])];
            let choice = ((i as f32 + choice) / count as f32).min(0.999_999_94);
            self.light_once(path, point, bsdf, choice, u, verdicts.as_ref(), shadows);
        }
    }

    fn light_once(
        &self,
        path: &Path,
        point: &SurfacePoint,
        bsdf: &Bsdf,
        choice: f32,
        u: [f32; 2],
        verdicts: Option<&Verdicts>,
        shadows: &mut Vec<Shadow>,
    ) {
        let Some(light) = self.lights.sample(self.world, point.position, path.last_place, choice, u) else { return };
        let density = light.pdf * path.last_shadows;
        let traced = self.maps.is_none();
        let part = |set: LobeSet, diffuse: bool| {
            if !bsdf.has(set & LobeSet::NON_DELTA) {
                return (Vec3::ZERO, Part::Direct);
            }
            let value = bsdf.eval(set, light.dir, TransportMode::Radiance);
            let rival = if light.delta || (diffuse && !traced && !self.probe) {
                0.0
            } else if diffuse && !traced {
                bsdf.pdf(set, light.dir)
            } else {
                // What a bounce finds also has to survive.
                let (set, value) = if traced {
                    (LobeSet::ALL, bsdf.eval(LobeSet::ALL, light.dir, TransportMode::Radiance))
                } else {
                    (set, value)
                };
                let pdf = bsdf.pdf(set, light.dir);
                let looks = self.looks(path, bsdf) as f32;
                pdf * looks * survival(path.depth, path.throughput * value / pdf.max(1e-20))
            };
            let weight = power_heuristic(density, rival);
            let part = match (path.diffuse, diffuse) {
                (0, _) => Part::Direct,
                (1, false) => Part::Caustic,
                _ => Part::Indirect,
            };
            (path.throughput * value * light.radiance * (weight / density), part)
        };
        let (diffuse, glossy) = (part(LobeSet::GATHER, true), part(LobeSet::CONTINUE, false));
        if diffuse.0.max_element() > 0.0 || glossy.0.max_element() > 0.0 {
            shadows.push(Shadow {
                ray: shadow_ray(point, light.dir, light.target),
                record: path.record,
                pixel: path.pixel,
                known: verdicts.and_then(|verdicts| verdicts.visible(light.source)),
                slot: self.lights.slot(path.last_place, light.item),
                diffuse,
                glossy,
            });
        }
    }
}

/// Veach's power heuristic with exponent 2 for one sample of each of two strategies.
pub(crate) fn power_heuristic(mine: f32, other: f32) -> f32 {
    if other == 0.0 {
        return 1.0;
    }
    let ratio = other / mine;
    1.0 / (1.0 + ratio * ratio)
}
