//! A diffuse base under a rough dielectric coat.

use super::dielectric::{normal_reflectance, relative_index};
use super::plastic::{CoatMeans, push_base};
use crate::bsdf::builder::{Builder, Place, reflection_kind};
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::lobe::LobeKind;
use crate::bsdf::lobes::{CoatTransmittance, CoatedDiffuse, FacetFresnel, MicrofacetReflection};
use crate::bsdf::microfacet::{Microfacets, is_mirror};
use crate::bsdf::{GATHER_ALPHA, SurfaceModel};
use photinus_geometry::Vec3;
use photinus_scene::Material;

pub fn add(builder: &mut Builder, place: Place, material: &Material) {
    let Material::RoughPlastic { model, alpha, int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear } =
        *material
    else {
        return;
    };
    if !place.front {
        return;
    }
    let alpha = builder.number(alpha);
    let eta = relative_index([int_ior, ext_ior]);
    if is_mirror([alpha; 2]) {
        let smooth = Material::Plastic { int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear };
        return super::plastic::add(builder, place, &smooth);
    }
    let base = builder.factor(place, diffuse_reflectance);
    let specular = builder.factor(place, specular_reflectance);
    let facets = Microfacets::new(model, [alpha; 2]);
    let table = match (builder.model(), builder.materials.interface_table(model, eta)) {
        (SurfaceModel::Physical, Some(table)) => table,
        _ => {
            let f = normal_reflectance(eta);
            if facets.mean_alpha() < GATHER_ALPHA {
                let mirror = builder.specular(place);
                builder.delta_reflection(mirror, specular * f);
                return builder.lambert(place, base * (1.0 - f));
            }
            return builder.lambert(place, specular * f + base * (1.0 - f));
        }
    };
    let alpha = facets.mean_alpha();
    let coat = table.coat(alpha);
    push_coat(builder, place, facets, eta, specular);
    let means = CoatMeans { transmittance: coat.mean_transmittance, internal_reflectance: coat.internal_reflectance };
    let transmittance = CoatTransmittance::Rough(coat.transmittance);
    let shape = CoatedDiffuse { transmittance, inv_eta_sq: 1.0 / (eta * eta) };
    push_base(builder, place, shape, means, base, nonlinear);
}

/// Adds the coat's own reflection.
pub fn push_coat(builder: &mut Builder, place: Place, facets: Microfacets, eta: f32, weight: Vec3) {
    let shape = MicrofacetReflection { facets, fresnel: FacetFresnel::Dielectric { eta } };
    let place = builder.specular(place);
    let cos = builder.wo(place).z;
    let alpha = facets.mean_alpha();
    let table = builder.materials.interface_table(facets.model, eta);
    let reflectance = table.map_or_else(|| fresnel_dielectric(cos, eta).0, |table| table.at(alpha, cos, false)[0]);
    let albedo = [weight * reflectance, Vec3::ZERO];
    builder.push(place, LobeKind::Reflection(shape), reflection_kind(alpha), weight, albedo, 1.0);
}
