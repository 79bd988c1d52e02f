//! What is carried along a path, and how faithfully surfaces are modelled.

/// What a path carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// Paths from the eye: radiance is scaled by 1 / eta^2 where the path enters a medium of relative index eta.
    Radiance,
    /// Paths from the lights (photons): power is not scaled by refraction.
    Importance,
}

/// How surfaces scatter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SurfaceModel {
    /// As the materials say.
    #[default]
    Physical,
    /// Fresnel and microfacets bypassed, as the thesis factors them out of its timings (3.4.1): reflection,
    /// transmission and absorption are fixed coefficients, those at normal incidence, and directions are mirrored,
    /// refracted or Lambertian.
    Fixed,
}
