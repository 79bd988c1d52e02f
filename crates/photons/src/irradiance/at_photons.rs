//! Irradiance at photons: Christensen, "Faster Photon Map Global Illumination", Journal of Graphics Tools 4(3), 1999.
//!
//! Before a picture is made, the density estimate is made at every n-th photon; a look-up then takes the irradiance of the
//! nearest of those whose normal is similar. Photons are dense where light changes, and so are the places where it is known.
//!
//! Each photon counts in the estimate at itself. That is right here, though it looks like counting one too many: around the
//! nearest kept photon of a point no other kept photon lies nearer to the point, and the disc in which none lies would have held
//! one on average. Both cancel where photons are even and that disc is small against the estimate's.

use super::tree::NormalTree;
use crate::inclusion::radius_sq;
use crate::{GatherQuery, Gathered, GatheredNearest, Kernel, Search};
use photinus_geometry::Vec3;
use std::f32::consts::PI;

/// Least photons for which densities say anything where they coincide: scene units.
const LEAST_RADIUS: f32 = 1e-18;
/// Queries answered at once: what is held beside the answers stays small.
const BATCH: usize = 1 << 16;

/// How irradiance is computed at photons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrradianceOptions {
    /// At one photon in so many, at least 1; Christensen takes 4.
    pub every: u32,
    /// Radius of the density estimates, scene units.
    pub radius: f32,
    /// Only this many nearest photons count, see [`Search::gather_nearest`], which makes irradiance up to 2 / k too much at a
    /// photon; none: all within the radius.
    pub knn: Option<u32>,
    /// Kernel of the density estimates.
    pub kernel: Kernel,
    /// Only photons of at most this depth count; from 127 on, all.
    pub max_depth: u32,
}

/// What is known at a photon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownIrradiance {
    /// Where, scene units.
    pub position: Vec3,
    /// Unit normal of the side that is lit.
    pub normal: Vec3,
    /// W per scene unit squared.
    pub irradiance: Vec3,
    /// Photons that were found.
    pub count: u32,
    /// Radius that they were within, scene units.
    pub radius: f32,
}

/// The irradiance at one photon in so many of a search, by ascending id: the same bits on any number of threads.
pub fn irradiance_at_photons(search: &dyn Search, options: &IrradianceOptions) -> Vec<KnownIrradiance> {
    let photons = (0..search.summary().photons as u32).step_by(options.every.max(1) as usize);
    let queries: Vec<GatherQuery> = photons
        .map(|id| {
            let photon = search.photon(id);
            GatherQuery {
                position: photon.position(),
                radius: options.radius,
                normal: photon.normal(),
                max_depth: options.max_depth,
            }
        })
        .collect();
    let mut known = Vec::with_capacity(queries.len());
    for queries in queries.chunks(BATCH) {
        let found: Vec<(Vec3, u32, f32)> = match options.knn {
            Some(k) => {
                let mut out = vec![GatheredNearest::default(); queries.len()];
                search.gather_nearest(queries, k, options.kernel, &mut out);
                out.iter()
                    .zip(queries)
                    .map(|(found, query)| (found.flux, found.count, found.radius(query, k)))
                    .collect()
            }
            None => {
                let mut out = vec![Gathered::default(); queries.len()];
                search.gather(queries, options.kernel, &mut out);
                out.iter().map(|found| (found.flux, found.count, options.radius)).collect()
            }
        };
        known.extend(queries.iter().zip(found).map(|(query, (flux, count, radius))| KnownIrradiance {
            position: query.position,
            normal: query.normal,
            irradiance: flux / options.kernel.area(radius.max(LEAST_RADIUS)),
            count,
            radius,
        }));
    }
    known
}

impl KnownIrradiance {
    /// Photons per area.
    pub fn density(&self) -> f32 {
        self.count as f32 / (PI * self.radius * self.radius).max(1e-20)
    }
}

/// Irradiance known at some points, found by the nearest.
#[derive(Clone, Debug)]
pub struct IrradianceAtPhotons {
    tree: NormalTree,
    irradiance: Vec<Vec3>,
    /// Least cosine of the angle between a point's normal and the query's.
    least_cosine: f32,
    /// Square of the largest distance.
    max_sq: f32,
}

impl IrradianceAtPhotons {
    /// Least cosine between normals that count as similar: 37 degrees.
    pub const LEAST_COSINE: f32 = 0.8;

    /// Of points whose normals are not zero. Look-ups take points within `max_distance` (scene units, closed) whose normal's
    /// angle to theirs has a cosine of `least_cosine`, 0 to 1, or more.
    pub fn new(known: &[KnownIrradiance], least_cosine: f32, max_distance: f32) -> Self {
        Self {
            tree: NormalTree::build(known.iter().map(|point| (point.position, point.normal))),
            irradiance: known.iter().map(|point| point.irradiance).collect(),
            least_cosine: least_cosine.clamp(0.0, 1.0),
            max_sq: radius_sq(Vec3::ZERO, max_distance),
        }
    }

    /// The irradiance at each place with its unit normal on the side that is lit, W per scene unit squared; none where no
    /// point fits. `out` is as long as `places`.
    pub fn look_up(&self, places: &[(Vec3, Vec3)], out: &mut [Option<Vec3>]) {
        assert_eq!(places.len(), out.len(), "one result a place");
        for ((position, normal), out) in places.iter().zip(out) {
            *out = self.at(*position, *normal);
        }
    }

    /// [`Self::look_up`] of one place.
    pub fn at(&self, position: Vec3, normal: Vec3) -> Option<Vec3> {
        self.nearest(position, normal).map(|id| self.irradiance[id as usize])
    }

    /// The number of the point that is looked up: ties go to the first.
    pub fn nearest(&self, position: Vec3, normal: Vec3) -> Option<u32> {
        if !(radius_sq(position, 0.0) >= 0.0) {
            return None;
        }
        self.tree.nearest(position, normal, self.least_cosine, self.max_sq)
    }

    /// Points that are known.
    pub fn len(&self) -> usize {
        self.irradiance.len()
    }

    /// Whether none is.
    pub fn is_empty(&self) -> bool {
        self.irradiance.is_empty()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + self.irradiance.capacity() * size_of::<Vec3>()
    }
}
