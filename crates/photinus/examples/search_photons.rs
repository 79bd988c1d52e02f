//! Finds photons around a point with every search of the family: `cargo run --release -p photinus --example search_photons`.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::geometry::Vec3;
use photinus::names;
use photinus::photons::{BuildOptions, Photon, build};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A lamp of 100 W straight above a square of one unit: a regular grid of photons.
    const SIDE: usize = 100;
    let mut photons = Vec::new();
    for i in 0..SIDE * SIDE {
        let position = Vec3::new((i % SIDE) as f32, 0.0, (i / SIDE) as f32) / SIDE as f32;
        let flux = Vec3::splat(100.0 / (SIDE * SIDE) as f32);
        photons.push(Photon::new(position, flux, Vec3::Y, Vec3::Y, 1, false)?);
    }
    for member in names::SEARCH.members() {
        let search = build(member.name, photons.clone(), &BuildOptions::default())?;
        let (mut found, radius) = (Vec::new(), 0.1f32);
        search.within_radius(Vec3::new(0.5, 0.0, 0.5), radius, &mut found);
        let flux: f32 = found.iter().map(|neighbor| photons[neighbor.photon as usize].flux().x).sum();
        let irradiance = flux / (std::f32::consts::PI * radius * radius);
        println!("{:12} {} photons, {irradiance:.1} W/m²", member.name, found.len());
    }
    Ok(())
}
