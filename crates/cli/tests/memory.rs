//! The memory that is predicted before a render is what the render takes.

#![cfg(all(target_os = "linux", target_env = "gnu"))]

mod common;

use common::{run_in, success};

/// Predicted over measured peak, and the peak.
fn predicted_and_peak(arguments: &str) -> (f64, f64) {
    let folder = tempfile::tempdir().unwrap();
    let fixed = "--threads 2 --quiet --stats stats.json -o a.png";
    let all: Vec<&str> = ["render"].into_iter().chain(arguments.split(' ')).chain(fixed.split(' ')).collect();
    success(&run_in(folder.path(), &all));
    let stats = std::fs::read(folder.path().join("stats.json")).unwrap();
    let stats: serde_json::Value = serde_json::from_slice(&stats).unwrap();
    let bytes = |name: &str| stats["memory"][name].as_f64().unwrap();
    (bytes("predicted_bytes"), bytes("peak_bytes"))
}

#[test]
fn memory_is_predicted_within_a_fifth() {
    for arguments in [
        "cornell --passes 2 --photons 600000 --size 64x64",
        "two-spheres --passes 2 --size 500x500",
        "room-1 --passes 1 --size 200x150",
        "furnace --mode path --passes 2 --size 800x800",
        "furnace --mode path --time 1 --size 800x800",
        "cornell --mode gather --photons 500000 --passes 2 --size 200x200",
        "cornell --mode direct --photons 300000 --passes 1 --size 64x64",
        "room-1 --mode direct --photons 50000 --radius 20 --knn 100 --surface-model fixed --passes 1 --size 800x600",
    ] {
        let (predicted, peak) = predicted_and_peak(arguments);
        assert!((predicted / peak - 1.0).abs() < 0.2, "{arguments}: predicted {predicted}, peak {peak}");
    }
}

/// The allocator left to itself keeps what each pass drops: half as much again after eight passes.
#[test]
fn memory_stays_as_predicted_over_many_passes() {
    let (predicted, peak) = predicted_and_peak("cornell --passes 8 --photons 800000 --size 64x64");
    assert!((predicted / peak - 1.0).abs() < 0.2, "predicted {predicted}, peak {peak}");
}
