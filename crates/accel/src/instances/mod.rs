//! Scenes of instances: prototypes with structures of their own, placed any number of times by affine transforms, with
//! one hierarchy over the placements.
//!
//! Rays are taken into a prototype's coordinates in doubles and rounded once to floats, their parameter kept: hits
//! differ from those of transformed triangles by that rounding, some 2^-24 of the ray's coordinates there. With the
//! identity nothing is rounded, and hits are those of the prototype bit for bit. Rays whose directions leave the range
//! of floats on the way hit nothing.

mod placing;

use crate::hierarchy::object_build::{self, ByCost, MAX_DEPTH};
use crate::hierarchy::refs::BuildRef;
use crate::hierarchy::rule::Rule;
use crate::hierarchy::volume::Volume;
use crate::hierarchy::volume_tree::VolumeTree;

use crate::structure::{RayCounters, Structure, StructureSummary};
use crate::{BuildError, BuildOptions, build};
use glam::Affine3A;
use photinus_geometry::{Aabb, Hit, MAX_PRIMITIVES, NO_HIT, Primitives, Ray};
use placing::{Inverse, world_bounds};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;
use thiserror::Error;

/// Something that can be placed: primitives in coordinates of their own, with a structure.
pub struct Prototype {
    structure: Box<dyn Structure>,
    bounds: Aabb,
}

impl Prototype {
    /// Builds the structure called `name` over `primitives`.
    ///
    /// # Errors
    /// As [`build`].
    pub fn build(name: &str, primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Self, BuildError> {
        let structure = build(name, primitives.clone(), options)?;
        let bounds = (0..primitives.len()).filter_map(|id| crate::bounds::padded_bounds(&primitives, id));
        Ok(Self { structure, bounds: bounds.fold(Aabb::EMPTY, Aabb::union) })
    }

    /// The structure.
    pub fn structure(&self) -> &dyn Structure {
        &*self.structure
    }
}

/// A prototype somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Index into the prototypes.
    pub prototype: usize,
    /// From the prototype's coordinates to the scene's.
    pub to_world: Affine3A,
}

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceHit {
    /// The hit; the primitive's id is that in its prototype, the parameter that of the ray in the scene.
    pub hit: Hit,
    /// Index of the placement; [`NO_HIT`] where nothing was hit.
    pub instance: u32,
}

impl InstanceHit {
    /// Nothing was hit.
    pub const MISS: Self = Self { hit: Hit::MISS, instance: NO_HIT };

    /// Whether this hit replaces `other`: nearer, or as near in a lower instance, or there with a lower id.
    fn beats(&self, other: &Self) -> bool {
        let key = |h: &Self| (h.instance, h.hit.prim);
        self.hit.t < other.hit.t || (self.hit.t == other.hit.t && key(self) < key(other))
    }
}

/// Why instances could not be placed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum InstanceError {
    /// No prototype of that index.
    #[error("placement {placement} is of prototype {prototype}, but there are {count}")]
    UnknownPrototype {
        /// The placement.
        placement: usize,
        /// What it names.
        prototype: usize,
        /// How many there are.
        count: usize,
    },
    /// A transform that cannot be undone.
    #[error("the transform of placement {placement} cannot be inverted; scale along every axis by something but zero")]
    Singular {
        /// The placement.
        placement: usize,
    },
    /// More placements than ids.
    #[error("{count} placements, but there may be at most {MAX_PRIMITIVES}")]
    TooMany {
        /// Placements.
        count: usize,
    },
    /// Other placements than before, not the same ones elsewhere.
    #[error("the instances were built over other placements than these; build them anew")]
    OtherPlacements,
    /// Options of the hierarchy over the placements out of their ranges.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// One placement, ready for rays.
struct Instance {
    prototype: usize,
    to_local: Inverse,
}

/// Placed prototypes.
pub struct Instances {
    prototypes: Vec<Arc<Prototype>>,
    instances: Vec<Instance>,
    top: VolumeTree<Aabb, { MAX_DEPTH + 2 }>,
    cost_ratio: f64,
}

impl Instances {
    /// Places prototypes. Of `options`, the costs and bins shape the hierarchy over the placements.
    ///
    /// # Errors
    /// [`InstanceError`], all but `OtherPlacements`.
    pub fn new(
        prototypes: Vec<Arc<Prototype>>,
        placements: &[Placement],
        options: &BuildOptions,
    ) -> Result<Self, InstanceError> {
        let rule = Rule { leaf_size: 1, ..Rule::new(options)? };
        let (instances, bounds) = place(&prototypes, placements)?;
        let refs = bounds.iter().enumerate().map(|(i, bounds)| BuildRef { bounds: *bounds, id: i as u32 });
        let mut refs: Vec<BuildRef> = refs.filter(|r| !r.bounds.is_empty()).collect();
        let built = (!refs.is_empty()).then(|| object_build::build(&ByCost(rule), &mut refs, ()));
        Ok(Self { prototypes, instances, top: VolumeTree::new(built), cost_ratio: rule.cost_ratio })
    }

    /// Moves the placements: as many, of the same prototypes, by other transforms. The hierarchy over them keeps its
    /// shape and gets new bounds, so that it is slower the more they moved past each other;
    /// [`summary`](Self::summary) says what it costs.
    ///
    /// # Errors
    /// [`InstanceError::Singular`] and [`InstanceError::OtherPlacements`]; all stays as it was.
    pub fn move_to(&mut self, placements: &[Placement]) -> Result<(), InstanceError> {
        let same = placements.len() == self.instances.len()
            && placements.iter().zip(&self.instances).all(|(p, i)| p.prototype == i.prototype);
        if !same {
            return Err(InstanceError::OtherPlacements);
        }
        let (instances, bounds) = place(&self.prototypes, placements)?;
        self.instances = instances;
        self.top.refit_boxes(&bounds);
        Ok(())
    }

    /// The nearest hit of each ray within its interval, ties going to the lowest instance, then to the lowest id;
    /// `hits` is as long as `rays`.
    pub fn closest_hit(&self, rays: &[Ray], hits: &mut [InstanceHit]) {
        self.closest_batch(rays, hits, |structure, ray, hit| structure.closest_hit(ray, hit), || {});
    }

    /// As [`Instances::closest_hit`], with the work added to `counters`. Every instance that a ray meets counts as one
    /// more ray of its prototype's structure.
    pub fn closest_hit_counted(&self, rays: &[Ray], hits: &mut [InstanceHit], counters: &mut RayCounters) {
        let mut nodes = 0;
        let trace = |structure: &dyn Structure, ray: &[Ray], hit: &mut [Hit]| {
            structure.closest_hit_counted(ray, hit, counters);
        };
        self.closest_batch(rays, hits, trace, || nodes += 1);
        counters.traversal.nodes_visited += nodes;
    }

    fn closest_batch(
        &self,
        rays: &[Ray],
        hits: &mut [InstanceHit],
        mut trace: impl FnMut(&dyn Structure, &[Ray], &mut [Hit]),
        mut node: impl FnMut(),
    ) {
        assert_eq!(rays.len(), hits.len());
        for (ray, best) in rays.iter().zip(hits) {
            *best = InstanceHit::MISS;
            self.visit(ray, &mut node, |instance, local, structure| {
                let mut hit = [Hit::MISS];
                trace(structure, &[local], &mut hit);
                let found = InstanceHit { hit: hit[0], instance };
                if found.hit.is_hit() && found.beats(best) {
                    *best = found;
                }
                ControlFlow::Continue(ray.t_max.min(best.hit.t))
            });
        }
    }

    /// Whether each ray hits anything within its interval; `occluded` is as long as `rays`.
    pub fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len());
        for (ray, found) in rays.iter().zip(occluded) {
            *found = false;
            self.visit(
                ray,
                || {},
                |_, local, structure| {
                    let mut any = [false];
                    structure.any_hit(&[local], &mut any);
                    *found = any[0];
                    if any[0] { ControlFlow::Break(()) } else { ControlFlow::Continue(ray.t_max) }
                },
            );
        }
    }

    /// Hands out the instances that a ray may hit, nearest entries first, with the ray in their coordinates.
    fn visit(
        &self,
        ray: &Ray,
        node: impl FnMut(),
        mut instance: impl FnMut(u32, Ray, &dyn Structure) -> ControlFlow<(), f32>,
    ) {
        let Some(prepared) = Aabb::prepare(ray) else { return };
        let leaf = |refs: Range<usize>, mut end: f32| {
            for &id in &self.top.refs[refs] {
                let placed = &self.instances[id as usize];
                let local = placed.to_local.ray(&Ray { t_max: end, ..*ray });
                end = instance(id, local, &*self.prototypes[placed.prototype].structure)?;
            }
            ControlFlow::Continue(end)
        };
        let _ = self.top.walk_from(0, &prepared, ray.t_max, node, leaf);
    }

    /// The hierarchy over the placements: references are placements, and so is what the cost counts in place of tests.
    /// The bytes include those of every prototype, once.
    pub fn summary(&self) -> StructureSummary {
        let own = self.top.summary("instances", self.cost_ratio);
        let prototypes: u64 = self.prototypes.iter().map(|p| p.structure.summary().bytes).sum();
        StructureSummary { bytes: own.bytes + size_of_val(&self.instances[..]) as u64 + prototypes, ..own }
    }
}

/// The placements made ready, with their bounds; empty where nothing can be hit.
fn place(prototypes: &[Arc<Prototype>], placements: &[Placement]) -> Result<(Vec<Instance>, Vec<Aabb>), InstanceError> {
    let count = placements.len();
    if count > MAX_PRIMITIVES {
        return Err(InstanceError::TooMany { count });
    }
    let one = |(placement, p): (usize, &Placement)| {
        let count = prototypes.len();
        let unknown = InstanceError::UnknownPrototype { placement, prototype: p.prototype, count };
        let prototype = prototypes.get(p.prototype).ok_or(unknown)?;
        let to_local = Inverse::of(&p.to_world).ok_or(InstanceError::Singular { placement })?;
        let bounds = world_bounds(&prototype.bounds, &p.to_world);
        Ok((Instance { prototype: p.prototype, to_local }, bounds))
    };
    let placed: Result<Vec<_>, InstanceError> = placements.iter().enumerate().map(one).collect();
    Ok(placed?.into_iter().unzip())
}
