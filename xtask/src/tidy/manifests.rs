//! Rules about Cargo manifests, read as text so that comments count.

use super::Finding;
use super::tree::{File, Tree};

/// Every crate describes itself in one sentence and takes the workspace's lints; every shared dependency says why it
/// is there.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for file in tree.files.iter().filter(|file| file.path.ends_with("Cargo.toml")) {
        if file.path == "Cargo.toml" {
            findings.extend(reasons(file));
        } else if file.path.starts_with("crates/") {
            findings.extend(crate_manifest(file));
        }
    }
    findings
}

fn crate_manifest(file: &File) -> Vec<Finding> {
    let mut findings = Vec::new();
    let description = file.lines().find_map(|(number, line)| Some((number, line.strip_prefix("description = ")?)));
    match description {
        None => findings.push(Finding::new(&file.path, 0, "no description")),
        Some((number, text)) => {
            let text = text.trim_matches('"');
            if text.len() < 10 || text.trim_end_matches('.').contains(". ") {
                findings.push(Finding::new(&file.path, number, "the description is not one sentence"));
            }
        }
    }
    let mut lines = file.text.lines();
    let takes_lints = lines.any(|line| line == "[lints]") && lines.next() == Some("workspace = true");
    if !takes_lints {
        findings.push(Finding::new(&file.path, 0, "no `[lints] workspace = true`"));
    }
    findings
}

/// Outside crates in `[workspace.dependencies]` each follow a comment.
fn reasons(file: &File) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut inside = false;
    let mut previous = "";
    for (number, line) in file.lines() {
        if line.starts_with('[') {
            inside = line == "[workspace.dependencies]";
        } else if inside && line.contains('=') && !line.starts_with(['#', ' ']) {
            let ours = line.contains("path = ");
            if !ours && !previous.starts_with('#') {
                findings.push(Finding::new(&file.path, number, format!("no reason above `{line}`")));
            }
        }
        previous = line;
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(path: &str, text: &str) -> usize {
        check(&Tree::of(&[(path, text)])).len()
    }

    #[test]
    fn manifests_are_complete() {
        let good = "[package]\ndescription = \"Vectors, rays and boxes\"\n[lints]\nworkspace = true\n";
        assert_eq!(count("crates/a/Cargo.toml", good), 0);
        assert_eq!(count("crates/a/Cargo.toml", "[package]\n"), 2);
        assert_eq!(count("crates/a/Cargo.toml", &good.replace("rays", "rays. More")), 1);
    }

    #[test]
    fn outside_crates_need_a_reason() {
        let pins =
            "[workspace.dependencies]\nours = { path = \"a\" }\n\n# Why.\nglam = \"1\"\nrayon = \"1\"\n[x]\ny = 1\n";
        assert_eq!(count("Cargo.toml", pins), 1);
    }
}
