//! Shadow photons: which lights are surely seen from a point, and which surely are not, without a shadow ray (Jensen and
//! Christensen, "Efficiently Rendering Shadows Using the Photon Map", Compugraphics 1995).
//!
//! A photon on its way from a light lands as an illumination photon, and its ray goes on through everything behind, where it
//! leaves shadow photons on each surface that keeps photons. Around a point that only illumination photons of a light lie near, the
//! light is seen; where only its shadow photons are, it is hidden; where both are, or few of either, shadow rays decide. Photons
//! know which light they come from. Light from infinity has none: its shadow rays are always sent.
//!
//! They lie in a search of their own, and are no part of any estimate.

use crate::bsdf::{Bsdf, LobeSet};
use crate::control::{Cancelled, Observer};
use crate::counters::Counters;
use crate::light::Lights;
use crate::photon_pass::PhotonPass;
use crate::recording::NOT_YET;
use crate::trace::{Tracer, beyond};
use crate::twin::Twin;
use crate::world::World;
use arrayvec::ArrayVec;
use photinus_geometry::{Ray, Vec3};
use photinus_num::Sampler;
use photinus_photons::{BuildOptions, GatherQuery, Photon, PhotonError, Search};
use photinus_profile::queries::RayKind;
use rayon::prelude::*;

/// Photons of one batch; fixed, so that batches do not depend on the machine.
const CHUNK: u32 = 2048;
/// Most surfaces that a ray goes on through.
const MOST_LAYERS: u32 = 32;
/// Photons of a light, all of one kind, that are enough: with n of them a shadow that covers a quarter of the disc is missed one
/// time in (4/3)^n, 30 for 12.
const ENOUGH: u16 = 12;
/// Lights that are told apart around a point; those of further ones are asked by rays.
const LIGHTS: usize = 16;

/// Number of a light that photons do not know of.
pub(crate) const NO_SOURCE: u32 = u32::MAX;
/// Lights that photons can tell apart: their number has the place of a photon's depth.
const MOST_SOURCES: u32 = 126;

/// Photons straight from lights, and what lies behind.
pub(crate) struct ShadowPhotons {
    search: Box<dyn Search>,
    radius: f32,
}

/// What photons around a point say of lights.
#[derive(Clone, Default)]
pub(crate) struct Verdicts {
    /// Light, illumination photons, shadow photons.
    found: ArrayVec<(u32, u16, u16), LIGHTS>,
}

/// A ray on its way through the scene.
struct Walk {
    ray: Ray,
    source: u32,
    sampler: Sampler,
}

impl ShadowPhotons {
    /// Sends out the photons of `pass` along straight lines; a point asks those within `radius`.
    pub fn new(
        world: &World,
        lights: &Lights,
        pass: &PhotonPass,
        radius: f32,
        search: &str,
        observer: &dyn Observer,
        counters: &mut Counters,
    ) -> Result<Result<Self, PhotonError>, Cancelled> {
        let chunks: Vec<Option<(Vec<Photon>, Counters)>> = (0..pass.count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| (!observer.cancelled()).then(|| photons(world, lights, pass, chunk)))
            .collect();
        let mut all = Vec::new();
        for chunk in chunks {
            let (photons, counted) = chunk.ok_or(Cancelled)?;
            all.extend(photons);
            *counters += counted;
        }
        let search = photinus_photons::build(search, all, &BuildOptions { radius_hint: radius });
        Ok(search.map(|search| Self { search, radius }))
    }

    /// What the photons around a point say, whose unit normal is on the side that is lit.
    pub fn ask(&self, position: Vec3, normal: Vec3) -> Verdicts {
        let mut verdicts = Verdicts::default();
        let query = GatherQuery { position, radius: self.radius, normal, max_depth: 127 };
        self.search.visit(&query, &mut |photon, _| verdicts.add(photon.depth() - 1, photon.is_caustic()));
        verdicts
    }
}

impl Verdicts {
    fn add(&mut self, source: u32, is_shadow: bool) {
        let at = match self.found.iter().position(|found| found.0 == source) {
            Some(at) => at,
            None if self.found.is_full() => return,
            None => {
                self.found.push((source, 0, 0));
                self.found.len() - 1
            }
        };
        let (_, lit, dark) = &mut self.found[at];
        let count = if is_shadow { dark } else { lit };
        *count = count.saturating_add(1);
    }

    /// The share of a light that is seen, 0 or 1, where that is known.
    pub fn visible(&self, source: u32) -> Option<f32> {
        let (_, lit, dark) = self.found.iter().find(|found| found.0 == source)?;
        match (lit, dark) {
            (&lit, 0) if lit >= ENOUGH => Some(1.0),
            (0, &dark) if dark >= ENOUGH => Some(0.0),
            _ => None,
        }
    }
}

/// The photons of a batch.
fn photons(world: &World, lights: &Lights, pass: &PhotonPass, chunk: u32) -> (Vec<Photon>, Counters) {
    let first = chunk * CHUNK;
    let (mut walks, mut made, mut counters) = (Vec::new(), Vec::new(), Counters::default());
    for index in first..(first + CHUNK).min(pass.count) {
        let (point, _, sampler) = pass.start(index);
        let source = lights.source_of_start(&point);
        if source >= MOST_SOURCES {
            continue;
        }
        if let Some(start) = lights.emit(world, &point) {
            walks.push(Walk { ray: start.ray, source, sampler });
        }
    }
    let mut tracer = Tracer::new(world, Twin::OFF);
    let (mut rays, mut hits, mut bsdf) = (Vec::new(), Vec::new(), Bsdf::default());
    for layer in 0..MOST_LAYERS {
        if walks.is_empty() {
            break;
        }
        rays.clear();
        rays.extend(walks.iter().map(|walk| walk.ray));
        counters.rays.photon += rays.len() as u64;
        tracer.ask(walks.iter().map(|_| (RayKind::Photon, NOT_YET)));
        tracer.closest(&rays, &mut hits, &mut counters, |i| walks[i].sampler.next_1d());
        let mut hits = hits.iter();
        walks.retain_mut(|walk| {
            let Some(hit) = hits.next().filter(|hit| hit.is_hit()) else { return false };
            let point = world.surface(&walk.ray, hit, 0.0);
            let wo = -walk.ray.dir;
            world.materials.resolve_into(world.shapes[point.shape as usize].material, &point, wo, &mut bsdf);
            if bsdf.has(LobeSet::GATHER) {
                let (normal, is_shadow) = (bsdf.geometric_normal(), layer > 0);
                let photon = Photon::new(point.position, Vec3::ZERO, wo, normal, walk.source + 1, is_shadow);
                if let Ok(photon) = photon {
                    made.push(photon);
                    let count = &mut counters.shadow_photons;
                    *(if is_shadow { &mut count.shadow } else { &mut count.lit }) += 1;
                }
            }
            walk.ray = beyond(&walk.ray, hit, &point);
            true
        });
    }
    (made, counters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_need_enough_photons_of_one_kind() {
        let mut verdicts = Verdicts::default();
        for _ in 0..ENOUGH {
            assert_eq!(verdicts.visible(3), None);
            verdicts.add(3, false);
            verdicts.add(4, true);
        }
        assert_eq!([verdicts.visible(3), verdicts.visible(4), verdicts.visible(5)], [Some(1.0), Some(0.0), None]);
        verdicts.add(3, true);
        verdicts.add(4, false);
        assert_eq!([verdicts.visible(3), verdicts.visible(4)], [None, None]);
        (10..10 + 2 * LIGHTS as u32).for_each(|source| (0..ENOUGH).for_each(|_| verdicts.add(source, true)));
        assert_eq!(verdicts.visible(10), Some(0.0));
        assert_eq!(verdicts.visible(9 + 2 * LIGHTS as u32), None, "no room for further lights");
    }
}
