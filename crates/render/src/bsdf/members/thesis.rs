//! The thesis's surface (3.1.3, Table 1): Fresnel's equations decide how much is reflected, transmitted and absorbed on
//! the fly, and one microscopic roughness spreads the directions of both, from a mirror to a Lambertian surface.
//!
//! The thesis names its sources but gives no formula. This is our choice, reciprocal and energy conserving: with
//! roughness r, the share s = r^4 of the surface is totally rough and scatters with constant radiance, the rest is GGX
//! microfacets with alpha = r^2. So r = 0 is exactly a mirror (or a pane), r = 1 exactly Lambertian, and neither share
//! depends on direction.
//!
//! * Reflected: Fresnel's F times the reflectance colour; the totally rough share reflects the mean F under diffuse light.
//! * Transmitted: the rest times the transmittance colour, spread alike.
//! * Where the transmittance is black, what enters is scattered by the body: the share r of it comes back diffusely with
//!   the reflectance colour, the rest is absorbed. A Lambertian surface then has the reflectance as its albedo, and a
//!   mirror reflects nothing but F. Such a surface has no inside: both its sides are alike.

use super::dielectric::{eta_from_side, relative_index};
use super::rough_dielectric;
use super::rough_plastic::push_coat;
use crate::bsdf::builder::{Builder, Place};
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::lobe::LobeKind;
use crate::bsdf::lobes::{CoatTransmittance, CoatedDiffuse, InterfaceTint, RoughInterface};
use crate::bsdf::microfacet::{Microfacets, is_mirror};
use crate::bsdf::{LobeSet, SurfaceModel};
use photinus_geometry::Vec3;
use photinus_scene::{Material, MicrofacetModel};

pub fn add(builder: &mut Builder, place: Place, material: &Material) {
    let Material::Thesis { int_ior, ext_ior, roughness, reflectance, transmittance } = *material else { return };
    let roughness = builder.share(roughness);
    let reflectance = builder.factor(place, reflectance).min(Vec3::ONE);
    let transmittance = builder.factor(place, transmittance).min(Vec3::ONE);
    let iors = [int_ior, ext_ior];
    let opaque = transmittance == Vec3::ZERO;
    // The body of an opaque surface is on the far side, wherever it is seen from.
    let eta = if opaque { relative_index(iors) } else { eta_from_side(place, iors) };
    if builder.model() == SurfaceModel::Fixed {
        return add_fixed(builder, place, eta, roughness, reflectance, transmittance);
    }
    let alpha = roughness * roughness;
    let lambertian = alpha * alpha;
    let mean = builder.materials.diffuse_reflectance(eta);
    let smooth_place = Place { share: place.share * (1.0 - lambertian), ..place };
    let specular_place = builder.specular(smooth_place);
    let cos = builder.wo(specular_place).z;
    let rough_place = Place { share: place.share * lambertian, ..place };
    // Light scattered back by the body, of what enters it.
    let body = reflectance * (roughness * (1.0 - transmittance.max_element()));

    if lambertian > 0.0 {
        builder.lambert(rough_place, reflectance * mean + body * (1.0 - mean));
        builder.lambert_transmission(rough_place, transmittance * (1.0 - mean), eta);
    }
    if lambertian >= 1.0 {
        return;
    }
    let mirror = is_mirror([alpha; 2]);
    let facets = Microfacets::new(MicrofacetModel::Ggx, [alpha; 2]);
    let table = builder.materials.interface_table(MicrofacetModel::Ggx, relative_index(iors));
    let coat = table.filter(|_| !mirror).map(|table| table.coat(alpha));
    if mirror || eta == 1.0 {
        let f = fresnel_dielectric(cos, eta).0;
        builder.delta_reflection(specular_place, reflectance * f);
        builder.delta_transmission(specular_place, transmittance * (1.0 - f), eta);
    } else if opaque {
        push_coat(builder, specular_place, facets, eta, reflectance);
    } else {
        let shape = RoughInterface { facets, eta, reflectance, transmittance, tint: InterfaceTint::PLAIN };
        rough_dielectric::push(builder, specular_place, shape, Vec3::ONE);
    }
    // Seen from inside there is no body in front of the interface.
    if body != Vec3::ZERO && (opaque || place.front) {
        let (transmittance, mean_transmittance) = match coat {
            Some(coat) => (CoatTransmittance::Rough(coat.transmittance), coat.mean_transmittance),
            None => (CoatTransmittance::Smooth { eta }, 1.0 - mean),
        };
        // f = body T(wo) T(wi) / (pi mean T): reciprocal, and T(wo) of the light that the coat lets in comes back.
        let shape = CoatedDiffuse { transmittance, inv_eta_sq: 1.0 };
        let weight = body / mean_transmittance.max(1e-3);
        let albedo = body * shape.transmittance(builder.wo(smooth_place).z);
        let kind = LobeKind::Coated(shape);
        builder.push(smooth_place, kind, LobeSet::DIFFUSE_REFLECTION, weight, [albedo, Vec3::ZERO], 1.0);
    }
}

/// The inputs reused as fixed coefficients of reflection and transmission, absorption being the rest; directions are
/// those of the nearer end of the roughness.
fn add_fixed(builder: &mut Builder, place: Place, eta: f32, roughness: f32, reflectance: Vec3, transmittance: Vec3) {
    let scale = 1.0 / (reflectance + transmittance).max_element().max(1.0);
    let (reflected, transmitted) = (reflectance * scale, transmittance * scale);
    if roughness >= 0.5 {
        builder.lambert(place, reflected);
        builder.lambert_transmission(place, transmitted, eta);
        return;
    }
    let place = builder.specular(place);
    let exists = fresnel_dielectric(builder.wo(place).z, eta).0 < 1.0;
    if exists {
        builder.delta_reflection(place, reflected);
        builder.delta_transmission(place, transmitted, eta);
    } else {
        builder.delta_reflection(place, reflected + transmitted);
    }
}
