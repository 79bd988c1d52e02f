//! `photons`: the density of the global map's photons around each visible point (Jensen 2001, chapter 7).

use super::{Batch, IndirectEstimate};
use crate::eye_pass::EyePass;
use crate::film::Aov;
use crate::maps::Estimate;
use crate::tile::Part;

pub(super) const ABOUT: &str = "the density of photons around each visible point";

/// The member.
pub(crate) struct Photons;

impl IndirectEstimate for Photons {
    fn answer(&self, eye: &EyePass, mut batch: Batch) {
        let list = &batch.estimates.list;
        estimate(eye, &mut batch, list);
    }
}

/// Makes those estimates of a batch that are on the list.
pub(super) fn estimate(eye: &EyePass, batch: &mut Batch, list: &[Estimate]) {
    let Batch { maps, estimates, twin, scratch, out, tile, tracer, counters } = batch;
    maps.global.estimate(list, estimates, maps.knn, twin, scratch, out, counters);
    let shares = eye.shares(maps.global.kernel, list, out, tile, tracer, counters);
    for ((e, found), share) in list.iter().zip(&**out).zip(shares) {
        tile.add(e.path, Part::Indirect, found.radiance / share);
        tile.add_scalar(e.path, Aov::PhotonDensity, found.density / share);
    }
}
