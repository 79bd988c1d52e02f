//! Ray-sphere: Haines, Gunther and Akenine-Moller, "Precision Improvements for Ray/Sphere Intersection" (Ray Tracing
//! Gems, chapter 7, 2019).
//!
//! The discriminant is taken from the distance between the sphere's middle and the ray's line, so that small and far
//! spheres keep it, and the nearer root of two of very different size comes from the product of the roots.

use crate::method::{dot, is_traceable, sub};
use photinus_geometry::{Ray, Sphere};
use photinus_num::Scalar;

/// Both ray parameters at which the line of the ray meets the sphere, the smaller first; equal where it touches.
///
/// `None` where it does not, where the radius is not positive, or where the ray is not finite or has no direction.
pub fn roots<S: Scalar>(origin: [S; 3], dir: [S; 3], center: [S; 3], radius: S) -> Option<[S; 2]> {
    if !is_traceable(&origin, &dir) || !(radius > S::zero()) {
        return None;
    }
    let f = sub(origin, center);
    let a = dot(dir, dir);
    let b = -dot(f, dir);
    // The foot of the perpendicular from the middle, as a vector from the middle.
    let foot: [S; 3] = std::array::from_fn(|i| f[i] + dir[i] * (b / a));
    let discriminant = radius * radius - dot(foot, foot);
    if !(discriminant >= S::zero()) {
        return None;
    }
    let root = (a * discriminant).sqrt();
    let q = if b < S::zero() { b - root } else { b + root };
    let c = dot(f, f) - radius * radius;
    let (far, near) = (q / a, if q == S::zero() { S::zero() } else { c / q });
    let (t0, t1) = if far < near { (far, near) } else { (near, far) };
    (t0.is_finite() && t1.is_finite()).then_some([t0, t1])
}

/// The nearest parameter within the ray's interval at which it meets the sphere, computed in doubles and rounded
/// once: a large sphere is as smooth as a small one.
pub fn intersect(ray: &Ray, sphere: &Sphere, t_max: f32) -> Option<f32> {
    let [origin, dir, center] = [ray.origin, ray.dir, sphere.center].map(|v| v.to_array().map(f64::from));
    let ts = roots(origin, dir, center, f64::from(sphere.radius))?.map(|t| t as f32);
    ts.into_iter().find(|t| *t >= ray.t_min && *t <= t_max && t.is_finite())
}
