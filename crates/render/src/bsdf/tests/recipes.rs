//! Lobes that are made once.

use super::subjects::subjects;
use super::{direction, flat_point, prepare, sampler, tilted_point};
use crate::bsdf::SurfaceModel;
use photinus_geometry::Vec3;

/// Over all materials of the tests: as the members would have it, seen from anywhere, on surfaces however bent.
#[test]
fn recipes_are_what_members_make() {
    let mut found = 0;
    for model in [SurfaceModel::Physical, SurfaceModel::Fixed] {
        for (t, subject) in subjects().iter().enumerate() {
            let (with, id) = prepare(subject.materials.clone(), subject.textures.clone(), model);
            let without = with.clone().without_recipes();
            found += u32::from(with.recipe(id, true).is_some());
            for k in 0..40 {
                let mut s = sampler(90 + t as u32, k);
                let wo = direction(2.0 * s.next_1d() - 1.0, 6.0 * s.next_1d());
                let bent = Vec3::new(s.next_1d() - 0.5, s.next_1d() - 0.5, 0.6).normalize();
                for point in [flat_point(), tilted_point(bent)] {
                    let [a, b] = [&with, &without].map(|materials| materials.resolve(id, &point, wo));
                    assert_eq!(format!("{a:?}"), format!("{b:?}"), "{} {model:?} {k}", subject.name);
                }
            }
        }
    }
    assert!(found >= 6, "only {found} materials with recipes");
}
