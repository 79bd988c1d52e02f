//! The help is a contract: every option of it is there, and its text changes only on purpose.

mod common;

use common::{run, success};
use std::path::Path;

/// Words after the program's name, and the file that holds what `--help` then says.
const PAGES: &[(&[&str], &str)] = &[
    (&[], "photinus.txt"),
    (&["render"], "render.txt"),
    (&["info"], "info.txt"),
    (&["scenes"], "scenes.txt"),
    (&["tree"], "tree.txt"),
    (&["compare"], "compare.txt"),
];

/// Set to write the files anew: look at the difference before you commit it.
const UPDATE: &str = "PHOTINUS_UPDATE_SNAPSHOTS";

/// The page without the members of families: those come from the lists, and a new one changes nothing else.
fn without_members(page: &str) -> String {
    let kept = page.lines().filter(|line| !line.trim_start().starts_with("- "));
    kept.map(|line| format!("{}\n", line.trim_end())).collect()
}

#[test]
fn help_is_as_recorded() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots");
    for (words, file) in PAGES {
        let said = without_members(&success(&run(&[words, &["--help"][..]].concat())));
        let path = folder.join(file);
        if std::env::var_os(UPDATE).is_some() {
            std::fs::write(&path, &said).unwrap();
        }
        let recorded = std::fs::read_to_string(&path).unwrap_or_default();
        let mut lines = said.lines().zip(recorded.lines());
        let difference = lines.find(|(said, recorded)| said != recorded);
        assert!(
            said == recorded,
            "{file} differs, first at {difference:?}: if that is meant, set {UPDATE}=1 and run this test again"
        );
    }
}

#[test]
fn every_member_of_every_family_is_there() {
    use photinus::names::{
        ACCEL, AOV, BACKEND, CANDIDATES, CLIP, Family, GRID_CELLS, INTERSECT, MODE, SEARCH, SURFACE_MODEL, TONEMAP,
    };
    let pages: [(&str, &[Family]); 2] = [
        ("render", &[ACCEL, AOV, BACKEND, INTERSECT, MODE, SEARCH, SURFACE_MODEL, TONEMAP]),
        ("tree", &[ACCEL, CANDIDATES, CLIP, GRID_CELLS]),
    ];
    for (command, families) in pages {
        let said = success(&run(&[command, "--help"]));
        for member in families.iter().flat_map(Family::members) {
            let entry = format!("- {}:", member.name);
            assert!(said.lines().any(|line| line.trim_start().starts_with(&entry)), "{command}: {}", member.name);
        }
    }
}

#[test]
fn every_option_of_the_contract_is_there() {
    let contract: &[(&str, &[&str])] = &[
        (
            "render",
            &[
                "--output",
                "--mode",
                "--time",
                "--cpu-time",
                "--passes",
                "--target-error",
                "--photons",
                "--radius",
                "--knn",
                "--spp",
                "--size",
                "--camera",
                "--crop",
                "--max-depth",
                "--seed",
                "--threads",
                "--tessellate",
                "--accel",
                "--intersect",
                "--search",
                "--backend",
                "--hardware",
                "--surface-model",
                "--aov",
                "--tonemap",
                "--exposure",
                "--denoise",
                "--stats",
                "--json",
                "--quiet",
                "--resume",
                "--record-queries",
            ],
        ),
        ("info", &["--json"]),
        ("scenes", &["--json"]),
        ("tree", &["--accel", "--node-cost", "--triangle-cost", "--candidates", "--json"]),
        ("compare", &["--mask", "--json"]),
    ];
    for (command, options) in contract {
        let said = success(&run(&[command, "--help"]));
        for option in *options {
            let begins = |line: &str| line.trim_start().trim_start_matches("-o, ").starts_with(option);
            assert!(said.lines().any(begins), "{command}: {option} is missing");
        }
    }
}
