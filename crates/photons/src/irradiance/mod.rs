//! Irradiance that is computed once and looked up: at photons, and in a cache of records between which it is interpolated.

mod at_photons;
mod cache;
mod hemisphere;
mod record;
mod tree;

pub use at_photons::{IrradianceAtPhotons, IrradianceOptions, KnownIrradiance, irradiance_at_photons};
pub use cache::IrradianceCache;
pub use hemisphere::{Hemisphere, HemisphereSample};
pub use record::IrradianceRecord;

#[cfg(test)]
mod tests;
