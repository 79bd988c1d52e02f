//! What a structure calls once a leaf: any method of the list, behind one object.

use crate::methods::woop::Woop;
use crate::{RtiMethod, sphere};
use photinus_geometry::{Hit, Primitives, Ray, Sphere};

/// Work done in one leaf.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeafWork {
    /// Primitives tested.
    pub tests: u32,
    /// Tests that hit within the interval left to the ray.
    pub hits: u32,
}

/// Tests a ray against the primitives of a leaf.
pub trait LeafTester: Send + Sync {
    /// Tests all of `prims` (primitive ids) and leaves the nearest hit in `best`, ties going to the lowest id. Only
    /// hits within the ray's interval that beat `best` are taken.
    fn closest_hit(&self, ray: &Ray, prims: &[u32], best: &mut Hit) -> LeafWork;

    /// Whether the ray hits any of `prims`; tests end with the first hit.
    fn any_hit(&self, ray: &Ray, prims: &[u32]) -> (bool, LeafWork);

    /// Memory of the prepared primitives.
    fn bytes(&self) -> u64;
}

/// A method with its prepared triangles, and the spheres.
struct Tester<M: RtiMethod<f32>> {
    triangles: Vec<M::Prepared>,
    /// Id of the first sphere.
    first_sphere: usize,
    spheres: Vec<Sphere>,
}

impl<M: RtiMethod<f32>> Tester<M> {
    /// The hit of one primitive; `started` is empty where the ray can hit no triangle.
    fn test(&self, ray: &Ray, started: Option<&M::Started>, id: u32, t_max: f32) -> Option<Hit> {
        match (id as usize).checked_sub(self.first_sphere) {
            None => M::intersect(started?, &self.triangles[id as usize], ray.t_min, t_max).map(|hit| Hit {
                t: hit.t,
                alpha: hit.alpha,
                beta: hit.beta,
                prim: id,
            }),
            Some(j) => {
                sphere::intersect(ray, &self.spheres[j], t_max).map(|t| Hit { t, alpha: 0.0, beta: 0.0, prim: id })
            }
        }
    }
}

impl<M> LeafTester for Tester<M>
where
    M: RtiMethod<f32>,
    M::Prepared: Send + Sync,
{
    fn closest_hit(&self, ray: &Ray, prims: &[u32], best: &mut Hit) -> LeafWork {
        let started = M::start(ray.origin.to_array(), ray.dir.to_array());
        let mut work = LeafWork { tests: prims.len() as u32, hits: 0 };
        for &id in prims {
            // Written so that an end which is not a number stays one: nothing is within it.
            let t_max = if best.t < ray.t_max { best.t } else { ray.t_max };
            if let Some(hit) = self.test(ray, started.as_ref(), id, t_max) {
                work.hits += 1;
                if hit.beats(best) {
                    *best = hit;
                }
            }
        }
        work
    }

    fn any_hit(&self, ray: &Ray, prims: &[u32]) -> (bool, LeafWork) {
        let started = M::start(ray.origin.to_array(), ray.dir.to_array());
        let mut work = LeafWork::default();
        for &id in prims {
            work.tests += 1;
            if self.test(ray, started.as_ref(), id, ray.t_max).is_some() {
                work.hits += 1;
                return (true, work);
            }
        }
        (false, work)
    }

    fn bytes(&self) -> u64 {
        (size_of_val(&self.triangles[..]) + size_of_val(&self.spheres[..])) as u64
    }
}

/// The leaf tester of method `M` over `primitives`.
pub(crate) fn make<M>(primitives: &Primitives) -> Box<dyn LeafTester>
where
    M: RtiMethod<f32> + 'static,
    M::Prepared: Send + Sync + 'static,
{
    let triangles =
        (0..primitives.triangle_count()).map(|i| M::prepare(primitives.triangle(i).map(|v| v.to_array()))).collect();
    Box::new(Tester::<M> { triangles, first_sphere: primitives.triangle_count(), spheres: primitives.spheres.clone() })
}

/// A leaf tester for the spheres alone, under their ids in `primitives`.
pub fn sphere_tester(primitives: &Primitives) -> Box<dyn LeafTester> {
    let (first_sphere, spheres) = (primitives.triangle_count(), primitives.spheres.clone());
    Box::new(Tester::<Woop> { triangles: Vec::new(), first_sphere, spheres })
}
