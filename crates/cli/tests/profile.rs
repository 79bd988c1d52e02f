//! The profile: what it counts, that it never shows in the picture, and the table at the end of a render.

mod common;

use common::{json, run_in, stderr, success};
use serde_json::Value;
use std::path::Path;

const MODES: [&str; 4] = ["progressive", "gather", "direct", "path"];
const SIZE: &[&str] = &["--size", "96x80", "--photons", "30000", "--passes", "2"];

fn render(folder: &Path, name: &str, more: &[&str]) -> Value {
    json(&run_in(folder, &[&["render", "-o", name, "--json", "--quiet"], SIZE, more].concat()))
}

#[test]
fn the_picture_is_the_same_whatever_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    for mode in MODES {
        let picture = |every: &str| {
            let members: &[&str] = if mode == "direct" { &["--search", "kd-balanced", "--knn", "40"] } else { &[] };
            render(folder.path(), "a.exr", &[&["--mode", mode, "--profile-every", every], members].concat());
            std::fs::read(folder.path().join("a.exr")).unwrap()
        };
        let unseen = picture("0");
        for every in ["1", "3", "64"] {
            assert!(picture(every) == unseen, "{mode}: one query in {every} is counted");
        }
    }
}

#[test]
fn counting_everything_counts_every_ray_and_search() {
    let folder = tempfile::tempdir().unwrap();
    for mode in MODES {
        for accel in ["wide-bvh", "kd-tree"] {
            let of = |every: &str| {
                render(folder.path(), "a.png", &["--mode", mode, "--accel", accel, "--profile-every", every])
            };
            let (exact, sampled, none) = (of("1"), of("64"), of("0"));
            assert_eq!(exact["accel"]["rays_counted"], exact["rays"]["total"], "{mode}, {accel}");
            assert_eq!(exact["search"]["searches_counted"], exact["search"]["searches"], "{mode}, {accel}");
            let share = sampled["accel"]["rays_counted"].as_f64().unwrap() / sampled["rays"]["total"].as_f64().unwrap();
            // Windows of 128 rays: of 150 000 rays some eighteen windows are one in 64.
            assert!((0.4 / 64.0..2.5 / 64.0).contains(&share), "{mode}, {accel}: {share}");
            for field in ["tests_per_ray", "hits_per_ray"] {
                let (exact, sampled) = (&exact["intersect"][field], &sampled["intersect"][field]);
                let ratio = sampled.as_f64().unwrap() / exact.as_f64().unwrap();
                assert!((ratio - 1.0).abs() < 0.2, "{mode}, {accel}, {field}: {sampled} for {exact}");
            }
            assert_eq!(none["accel"]["rays_counted"], 0);
            assert_eq!(none["intersect"]["seconds"], 0.0);
            assert_eq!(none["rays"], exact["rays"], "plain counts need no profile");
        }
    }
}

#[test]
fn all_time_is_in_the_four_rows_and_their_parts() {
    let folder = tempfile::tempdir().unwrap();
    for mode in MODES {
        let document = render(folder.path(), "a.png", &["--mode", mode]);
        let secs = |part: &str| document[part]["seconds"].as_f64().unwrap();
        let other: f64 = document["other"].as_object().unwrap().values().map(|v| v.as_f64().unwrap()).sum();
        let whole = document["seconds"]["cpu_secs"].as_f64().unwrap();
        let sum = secs("intersect") + secs("accel") + secs("search") + other;
        assert!((sum / whole - 1.0).abs() < 1e-6, "{mode}: {sum} of {whole}");
        assert!(secs("intersect") > 0.0 && secs("accel") > 0.0, "{mode}");
        assert_eq!(secs("search") > 0.0, mode != "path", "{mode}");
        let profile: photinus::profile::Profile = serde_json::from_value(document.clone()).unwrap();
        assert_eq!(profile.scene, "two-spheres");
        assert_eq!(profile.triangles, 22);
        assert!((profile.rows().iter().map(|row| row.share).sum::<f64>() - 1.0).abs() < 1e-6, "{mode}");
    }
}

#[test]
fn a_render_ends_with_the_table() {
    let folder = tempfile::tempdir().unwrap();
    for mode in MODES {
        let output = run_in(folder.path(), &[&["render", "-o", "a.png", "--mode", mode], SIZE].concat());
        success(&output);
        let said = stderr(&output);
        for row in ["intersection tests ", "structure traversal ", "photon search ", "everything else ", "a ray: "] {
            assert_eq!(said.lines().filter(|line| line.starts_with(row)).count(), 1, "{mode}: {row}in\n{said}");
        }
        assert_eq!(said.contains("a search: "), mode != "path", "{mode}: {said}");
    }
    let quiet = run_in(folder.path(), &[&["render", "-o", "a.png", "--quiet"], SIZE].concat());
    assert_eq!(stderr(&quiet), "");
}

#[test]
fn queries_are_recorded_and_the_picture_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let plain = render(folder.path(), "a.exr", &[]);
    let output = run_in(folder.path(), &[&["render", "-o", "b.exr", "--record-queries", "q.bin"], SIZE].concat());
    success(&output);
    let read = |name| std::fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.exr") == read("b.exr"));
    let mut file = photinus::profile::queries::QueryFile::open(folder.path().join("q.bin")).unwrap();
    let mut rays = 0;
    for i in 0..file.block_count() {
        rays += file.read(i).unwrap().rays.len();
    }
    assert_eq!(plain["rays"]["total"], rays);
    assert!(stderr(&output).lines().any(|line| line.starts_with("recorded: ")), "{}", stderr(&output));
    let refused = run_in(folder.path(), &["render", "--record-queries", "none/q.bin"]);
    assert!(common::refused(&refused, 1).contains("none/q.bin"));
}
