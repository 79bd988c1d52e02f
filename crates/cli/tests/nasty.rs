//! The program on every damaged or odd file of the real-scene suite: the verdicts of docs/robustness.md.

// Whoever runs the tests must see what did not run.
#![allow(clippy::print_stderr)]

mod common;

use common::{photinus, refused, stderr, success};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder of hostile files, or none and a line that says so.
fn nasty() -> Option<PathBuf> {
    let folder = std::env::var_os("PHOTINUS_SCENES").map(|scenes| Path::new(&scenes).join("nasty"));
    if folder.is_none() {
        eprintln!("PHOTINUS_SCENES is not set: the suite of hostile files did not run");
    }
    folder
}

/// Names and verdicts of one section of the document.
fn table(section: &str) -> BTreeMap<String, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/robustness.md");
    let document = std::fs::read_to_string(path).unwrap();
    let (_, after) = document.split_once(&format!("## {section}\n")).expect("the section exists");
    let section = after.split("\n## ").next().unwrap();
    let row = |line: &str| {
        let (name, rest) = line.strip_prefix("| `")?.split_once("` | ")?;
        Some((name.to_owned(), rest.split_once(" | ")?.1.trim_end_matches(" |").to_owned()))
    };
    section.lines().filter_map(row).collect()
}

fn names_below(folder: &Path, root: &Path, names: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            names_below(&path, root, names);
        } else {
            names.push(path.strip_prefix(root).unwrap().to_str().unwrap().to_owned());
        }
    }
}

#[test]
fn the_document_names_every_file() {
    let Some(root) = nasty() else { return };
    let mut files = Vec::new();
    names_below(&root, &root, &mut files);
    files.sort();
    let mut named: Vec<String> = table("Scenes and meshes").into_keys().chain(table("Images").into_keys()).collect();
    named.sort();
    assert_eq!(files, named);
    assert!(files.len() >= 84);
}

#[test]
fn scenes_and_meshes_get_their_verdict() {
    let Some(root) = nasty() else { return };
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str], path: &Path| photinus(folder.path()).args(arguments).arg(path).output().unwrap();
    let render = ["render", "--passes", "1", "--photons", "1000", "--size", "8x8", "-o", "a.png"];
    for (name, verdict) in table("Scenes and meshes") {
        let path = root.join(&name);
        let (info, rendered) = (run(&["info", "--json"], &path), run(&render, &path));
        if let Some(words) = verdict.strip_prefix("refused") {
            for output in [&info, &rendered] {
                let said = refused(output, 1);
                assert!(said.contains(path.to_str().unwrap()), "{said}");
                if let Some(format) = words.strip_prefix(": ").filter(|w| w.ends_with("glTF") || *w == "OFF") {
                    assert!(said.contains(&format!("{format} is not supported; supported are ")), "{said}");
                }
            }
        } else {
            let document = common::json(&info);
            let expected = verdict.split(' ').next().unwrap().parse::<u64>().expect("a count of triangles");
            assert_eq!(document["triangles"], expected, "{name}");
            success(&rendered);
            if verdict.contains("warning") {
                // Every mesh file by itself gets one warning for its camera and one for its light.
                assert!(document["warnings"].as_array().unwrap().len() > 2, "{name}: {document:#}");
            }
        }
    }
}

#[test]
fn images_get_their_verdict() {
    let Some(root) = nasty() else { return };
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| photinus(folder.path()).args(arguments).output().unwrap();
    for (name, verdict) in table("Images") {
        let path = root.join(&name);
        let path = path.to_str().unwrap();
        let compared = run(&["compare", path, path]);
        let is_refused = verdict == "refused";
        if is_refused {
            let said = refused(&compared, 1);
            assert!(said.contains(path), "{said}");
        } else {
            success(&compared);
            assert!(stderr(&compared).contains("warning: 12 pixels hold values that are not finite"));
        }
        for (kind, scene) in [("texture", TEXTURED), ("environment", LIT)] {
            std::fs::write(folder.path().join("scene.xml"), scene.replace("FILE", path)).unwrap();
            let rendered =
                run(&["render", "scene.xml", "--allow-outside", "--passes", "1", "--photons", "1000", "--size", "8x8"]);
            success(&rendered);
            let said = stderr(&rendered);
            assert!(said.contains(path), "{name} as {kind}: {said}");
            assert_eq!(said.contains("mid-grey is used"), is_refused, "{name} as {kind}: {said}");
        }
    }
}

const TEXTURED: &str = r#"<scene version="3.0.0">
<sensor type="perspective"><transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform></sensor>
<emitter type="constant"/>
<shape type="rectangle"><bsdf type="diffuse">
<texture type="bitmap" name="reflectance"><string name="filename" value="FILE"/></texture>
</bsdf></shape>
</scene>"#;

const LIT: &str = r#"<scene version="3.0.0">
<sensor type="perspective"><transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform></sensor>
<emitter type="envmap"><string name="filename" value="FILE"/></emitter>
<shape type="rectangle"/>
</scene>"#;
