//! The floors of the house: a crate uses only crates of lower floors.

use crate::Failure;
use crate::metadata::Metadata;
use std::collections::BTreeMap;
use std::path::Path;

/// Every crate and its floor. A crate on no floor is an error.
const FLOORS: &[(&str, u32)] = &[
    ("photinus-memory", 0),
    ("photinus-num", 0),
    ("photinus-profile", 0),
    ("photinus-geometry", 1),
    ("photinus-image", 1),
    ("photinus-intersect", 2),
    ("photinus-scene", 2),
    ("photinus-accel", 3),
    ("photinus-photons", 3),
    ("photinus-render", 4),
    ("photinus", 7),
    ("photinus-cli", 8),
];

/// Crates that stand beside the house: nothing may use them, and they may use no crate of it.
const OUTSIDE: &[&str] = &["xtask"];

/// Edges that go down and are forbidden all the same, with the reason.
const FORBIDDEN: &[(&str, &str, &str)] = &[
    ("photinus-photons", "photinus-intersect", "photon storage and search know no rays"),
    ("photinus-photons", "photinus-scene", "photon storage and search know no scene"),
    ("photinus-accel", "photinus-scene", "structures are built over primitives, not over scenes"),
    ("photinus-intersect", "photinus-image", "a ray-triangle method is arithmetic alone"),
];

/// The floor from which on a crate is a thin face: it may use the facade only.
const FACES: u32 = 8;
const FACADE: &str = "photinus";

/// Checks the workspace and describes it in one line.
pub fn run(root: &Path) -> Result<String, Failure> {
    let metadata = Metadata::of_workspace(root)?;
    let edges: Vec<(String, Vec<String>)> = metadata
        .packages
        .iter()
        .map(|package| {
            let inside = package.dependencies.iter().filter(|d| d.path.is_some());
            (package.name.clone(), inside.map(|d| d.name.clone()).collect())
        })
        .collect();
    let faults = check(&edges);
    if faults.is_empty() {
        let count: usize = edges.iter().map(|(_, used)| used.len()).sum();
        Ok(format!("floors: {} crates, {count} edges, all downwards", edges.len()))
    } else {
        Err(format!("floors: {} faults\n  {}", faults.len(), faults.join("\n  ")))
    }
}

/// Faults of a workspace given as crates and the crates of the workspace that each uses.
fn check(edges: &[(String, Vec<String>)]) -> Vec<String> {
    let floors: BTreeMap<&str, u32> = FLOORS.iter().copied().collect();
    let mut faults = Vec::new();
    for (name, used) in edges {
        let outside = OUTSIDE.contains(&name.as_str());
        let Some(&floor) = floors.get(name.as_str()) else {
            if !outside {
                faults.push(format!("{name} stands on no floor: add it to FLOORS in xtask/src/floors.rs"));
            } else if let Some(other) = used.first() {
                faults.push(format!("{name} stands outside the house and uses {other}"));
            }
            continue;
        };
        for other in used {
            match floors.get(other.as_str()) {
                None => faults.push(format!("{name} uses {other}, which stands on no floor")),
                Some(&lower) if lower >= floor => {
                    faults.push(format!("{name} (floor {floor}) uses {other} (floor {lower}): only lower floors"));
                }
                Some(_) if floor >= FACES && other != FACADE => {
                    faults.push(format!("{name} is a thin face and uses {other}: only {FACADE}"));
                }
                Some(_) => {}
            }
            for (_, _, reason) in FORBIDDEN.iter().filter(|(from, to, _)| from == name && to == other) {
                faults.push(format!("{name} uses {other}: {reason}"));
            }
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::check;

    fn edge(from: &str, to: &[&str]) -> Vec<(String, Vec<String>)> {
        vec![(from.into(), to.iter().map(|&t| t.into()).collect())]
    }

    #[test]
    fn lower_floors_are_allowed() {
        assert!(check(&edge("photinus-render", &["photinus-accel", "photinus-photons", "photinus-num"])).is_empty());
        assert!(check(&edge("photinus-cli", &["photinus"])).is_empty());
    }

    #[test]
    fn every_kind_of_fault_is_named() {
        for (from, to, words) in [
            ("photinus-num", "photinus-render", "only lower floors"),
            ("photinus-accel", "photinus-photons", "only lower floors"),
            ("photinus-photons", "photinus-scene", "know no scene"),
            ("photinus-cli", "photinus-render", "thin face"),
            ("photinus-render", "photinus-cellar", "stands on no floor"),
            ("photinus-attic", "photinus-num", "stands on no floor"),
            ("xtask", "photinus-num", "outside the house"),
        ] {
            let faults = check(&edge(from, &[to]));
            assert_eq!(faults.len(), 1, "{from} -> {to}: {faults:?}");
            assert!(faults[0].contains(words), "{from} -> {to}: {}", faults[0]);
        }
    }
}
