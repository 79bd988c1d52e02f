//! The ray-sphere test: both roots, tangents, and spheres far away, tiny and huge.

use photinus_geometry::{Ray, Sphere, Vec3};
use photinus_intersect::sphere::{intersect, roots};
use photinus_num::{Sampler, StreamKind};

const INF: f32 = f32::INFINITY;

#[test]
fn the_nearest_root_within_the_interval_counts() {
    let sphere = Sphere { center: Vec3::new(0.0, 0.0, 5.0), radius: 1.0 };
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    assert_eq!(intersect(&ray, &sphere, INF), Some(4.0));
    assert_eq!(intersect(&Ray { t_min: 4.0, ..ray }, &sphere, INF), Some(4.0));
    assert_eq!(intersect(&Ray { t_min: 4.1, ..ray }, &sphere, INF), Some(6.0));
    assert_eq!(intersect(&Ray { t_min: 6.1, ..ray }, &sphere, INF), None);
    assert_eq!(intersect(&ray, &sphere, 3.9), None);
    assert_eq!(intersect(&Ray { t_min: 4.1, ..ray }, &sphere, 5.9), None);
    // From inside, from the surface, from behind, and with a direction that is not of unit length.
    assert_eq!(intersect(&Ray::new(sphere.center, Vec3::X), &sphere, INF), Some(1.0));
    assert_eq!(intersect(&Ray::new(Vec3::new(0.0, 0.0, 4.0), Vec3::Z), &sphere, INF), Some(0.0));
    assert_eq!(intersect(&Ray::new(Vec3::new(0.0, 0.0, 9.0), Vec3::Z), &sphere, INF), None);
    assert_eq!(intersect(&Ray::new(Vec3::ZERO, Vec3::Z * 0.5), &sphere, INF), Some(8.0));
    // The tangent touches.
    assert_eq!(intersect(&Ray::new(Vec3::new(1.0, 0.0, 0.0), Vec3::Z), &sphere, INF), Some(5.0));
}

#[test]
fn spheres_and_rays_that_are_none_never_hit() {
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    for radius in [0.0, -1.0, f32::NAN] {
        assert_eq!(intersect(&ray, &Sphere { center: Vec3::new(0.0, 0.0, 5.0), radius }, INF), None);
    }
    let sphere = Sphere { center: Vec3::new(0.0, 0.0, 5.0), radius: 1.0 };
    for bad in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        assert_eq!(intersect(&Ray::new(Vec3::ZERO, bad), &sphere, INF), None);
    }
    assert_eq!(intersect(&Ray::new(Vec3::NAN, Vec3::Z), &sphere, INF), None);
    assert_eq!(intersect(&Ray { t_min: f32::NAN, ..ray }, &sphere, INF), None);
}

/// Hits lie on the sphere, whatever its size and distance, to a few roundings of the distance.
#[test]
fn hits_lie_on_the_sphere() {
    let mut hits = 0;
    for i in 0..3000 {
        let mut s = Sampler::new(5, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0;
        let size = [1e-6, 1e-3, 1.0, 1e4][i as usize % 4];
        let distance = [1.0, 1e3, 1e5][i as usize % 3];
        let sphere = Sphere { center: vec3() * distance, radius: size };
        let ray = Ray::new(vec3(), sphere.center + vec3() * size * 0.5);
        let Some(t) = intersect(&Ray { dir: ray.dir - ray.origin, ..ray }, &sphere, INF) else { continue };
        hits += 1;
        let d = (ray.dir - ray.origin).to_array().map(f64::from);
        let (o, c) = (ray.origin.to_array().map(f64::from), sphere.center.to_array().map(f64::from));
        let off: f64 = (0..3).map(|k| (o[k] + d[k] * f64::from(t) - c[k]).powi(2)).sum::<f64>().sqrt();
        let length = d.iter().map(|x| x * x).sum::<f64>().sqrt() * f64::from(t);
        assert!((off - f64::from(size)).abs() < 1e-6 * length + 1e-9, "{sphere:?} {ray:?}: {off}");
    }
    assert!(hits > 2000, "{hits}");
}

/// The textbook discriminant b^2 - ac loses a small far sphere in floats; the one from the distance keeps it.
#[test]
fn small_far_spheres_keep_their_discriminant_in_floats() {
    let center = [0.0f32, 0.0, 4000.0];
    let [t0, t1] = roots([0.0; 3], [0.0, 0.0, 1.0], center, 0.25f32).expect("a hit");
    assert!((t0 - 3999.75).abs() < 1e-2 && (t1 - 4000.25).abs() < 1e-2, "{t0} {t1}");
    assert!(roots([0.0; 3], [0.0, 0.0, 1.0], [0.3f32, 0.0, 4000.0], 0.25f32).is_none());
}
