//! JSON documents: one on standard output, nothing else, with the fields that scripts depend on.

mod common;

use common::{SMALL, json, run, run_in, stderr, success};
use serde_json::Value;

#[track_caller]
fn has(document: &Value, fields: &[&str]) {
    for field in fields {
        let mut value = document;
        for part in field.split('.') {
            value = value.get(part).unwrap_or_else(|| panic!("no field {field} in {document:#}"));
        }
    }
}

#[test]
fn info() {
    let document = json(&run(&["info", "two-spheres", "--json"]));
    has(&document, &["triangles", "meshes", "materials", "lights", "textures", "camera", "bounds", "warnings"]);
    assert_eq!(document["triangles"], 22);
    assert_eq!(document["spheres"], 2);
    assert_eq!(document["warnings"].as_array().map(Vec::len), Some(0));
    let lines = success(&run(&["info", "two-spheres"]));
    assert!(lines.lines().any(|line| line.starts_with("triangles") && line.ends_with("22")), "{lines}");
}

#[test]
fn scenes() {
    let document = json(&run(&["scenes", "--json"]));
    let scenes = document["scenes"].as_array().unwrap();
    assert_eq!(document, json(&run(&["scenes", "list", "--json"])));
    assert_eq!(scenes[0]["name"], "two-spheres");
    for scene in scenes {
        let name = scene["name"].as_str().unwrap();
        let info = json(&run(&["info", name, "--json"]));
        assert_eq!(info["triangles"], scene["triangles"], "{name}");
    }
}

#[test]
fn tree() {
    let document = json(&run(&["tree", "cornell", "--json"]));
    has(&document, &["scene", "triangles", "build_secs", "name", "depth", "nodes", "leaves", "references", "bytes"]);
    has(&document, &["rays.rays", "rays.hits", "rays.nodes_per_ray", "rays.leaves_per_ray", "rays.tests_per_ray"]);
    success(&run(&["tree", "cornell", "--accel", "brute-force"]));
    let tests = |flags: &[&str]| {
        let words = [&["tree", "texture-1210", "--json"], flags].concat();
        json(&run(&words))["rays"]["tests_per_ray"].as_f64().unwrap()
    };
    for accel in ["kd-tree", "octree", "uniform-grid", "compact-grid"] {
        let whole = tests(&["--accel", accel]);
        assert!(tests(&["--accel", accel, "--clip", "exact"]) < whole, "{accel}");
    }
    assert!(tests(&["--accel", "octree", "--leaf-size", "60"]) > tests(&["--accel", "octree"]));
    assert!(tests(&["--accel", "uniform-grid", "--density", "0.1"]) > tests(&["--accel", "uniform-grid"]));
}

#[test]
fn trees_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |file| run_in(folder.path(), &["tree", "water-lily-1426", "--accel", "kd-tree", "--draw", file]);
    success(&draw("a.svg"));
    success(&draw("a.png"));
    let svg = std::fs::read_to_string(folder.path().join("a.svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.matches("<path ").count() > 3);
    let png = photinus::image::read_image(folder.path().join("a.png")).unwrap();
    assert!(png.pixels.iter().any(|pixel| pixel[0] > 0.1), "nothing is drawn");
    let above = ["tree", "water-lily-1426", "--accel", "kd-tree", "--draw", "above.svg", "--view", "0,-1,0"];
    success(&run_in(folder.path(), &above));
    success(&run_in(folder.path(), &[&above[..4], &["--draw", "part.svg", "--draw-box=-1,-1,-1,1,1,1"]].concat()));
    for other in ["above.svg", "part.svg"] {
        assert_ne!(svg, std::fs::read_to_string(folder.path().join(other)).unwrap(), "{other}");
    }
    let refused = common::refused(&run_in(folder.path(), &["tree", "cornell", "--draw", "b.png"]), 1);
    assert!(refused.contains("--draw: wide-bvh is not drawn; use --accel kd-tree"), "{refused}");
}

#[test]
fn render_and_compare() {
    let folder = tempfile::tempdir().unwrap();
    let render =
        |output: &str, more: &[&str]| run_in(folder.path(), &[&["render", "-o", output], SMALL, more].concat());
    let output = render("a.exr", &["--json", "--stats", "a.json", "--aov", "depth,normal"]);
    let document = json(&output);
    assert_eq!(stderr(&output), "", "--quiet");
    let file: Value = serde_json::from_slice(&std::fs::read(folder.path().join("a.json")).unwrap()).unwrap();
    assert_eq!(document, file, "--json prints what --stats writes");
    has(
        &document,
        &[
            "output",
            "passes",
            "stopped",
            "threads",
            "seed",
            "version",
            "machine.cpu",
            "phases.build.wall_secs",
            "phases.photon_pass.cpu_secs",
            "phases.map_build.wall_secs",
            "phases.eye_pass.cpu_secs",
            "rays.emitted",
            "rays.photon",
            "rays.camera",
            "rays.specular",
            "rays.shadow",
            "rays.gather",
            "intersect.tests",
            "intersect.tests_per_ray",
            "intersect.seconds",
            "accel.nodes_visited",
            "accel.leaves_per_ray",
            "accel.triangles_per_leaf",
            "accel.depth",
            "accel.seconds",
            "search.searches",
            "search.photons_found_mean",
            "search.photons_tested",
            "search.seconds",
            "photons.emitted",
            "photons.stored",
            "photons.absorbed",
            "photons.escaped",
            "photons.split",
            "photons.power.emitted",
            "caustic_photons.emitted",
            "caustic_photons.power.stored",
            "other",
            "memory.peak_bytes",
            "memory.by_owner",
        ],
    );
    assert_eq!(document["passes"], 3);
    assert_eq!(document["stopped"], "passes");
    assert_eq!(document["photons"]["emitted"], 9000, "three passes of 3000");
    assert_eq!(document["rays"]["camera"], 24 * 20 * 3);
    for (count, least) in [
        ("intersect", "tests_per_ray"),
        ("intersect", "seconds"),
        ("accel", "nodes_visited"),
        ("search", "photons_found_mean"),
        ("search", "photons_tested"),
        ("search", "seconds"),
    ] {
        assert!(document[count][least].as_f64().unwrap() > 0.0, "{count}.{least}");
    }

    success(&render("b.exr", &["--seed", "1"]));
    let compare = |b: &str| json(&run_in(folder.path(), &["compare", "a.exr", b, "--json"]));
    let same = compare("a.exr");
    has(&same, &["relmse", "relmse_trimmed", "psnr", "flip", "mean_a", "mean_b", "nonfinite"]);
    assert_eq!((same["relmse"].as_f64(), same["flip"].as_f64()), (Some(0.0), Some(0.0)));
    assert_eq!(same["mean_a"], same["mean_b"]);
    assert!(compare("b.exr")["relmse"].as_f64().unwrap() > 0.0, "another seed gives another picture");
}

/// Names of all fields of a document, down to its leaves.
fn names<'a>(value: &'a Value, found: &mut Vec<&'a str>) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                found.push(name);
                names(value, found);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| names(item, found)),
        _ => {}
    }
}

#[test]
fn every_field_is_documented() {
    let page = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/statistics.md");
    let page = std::fs::read_to_string(page).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| json(&run_in(folder.path(), arguments));
    let mut documents = vec![run(&[&["render", "-o", "a.exr", "--json"], SMALL].concat())];
    // Settings carry the options' own names.
    documents[0]["settings"] = Value::Null;
    for arguments in
        [&["tree", "cornell", "--json"][..], &["compare", "a.exr", "a.exr", "--json"], &["scenes", "--json"]]
    {
        documents.push(run(arguments));
    }
    let mut info = run(&["info", "cornell", "--json"]);
    for part in ["lights_by_kind", "camera", "bounds"] {
        info[part] = Value::Null;
    }
    documents.push(info);
    for document in &documents {
        let mut found = Vec::new();
        names(document, &mut found);
        assert!(found.len() > 3);
        for name in found {
            let mentioned = [format!("`{name}`"), format!(".{name}`")].iter().any(|word| page.contains(word));
            assert!(mentioned, "docs/statistics.md does not mention `{name}`");
        }
    }
}
