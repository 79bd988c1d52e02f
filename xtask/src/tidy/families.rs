//! Families: a member is one file, and one list names the members.

use super::Finding;
use super::rust_lines::split;
use super::tree::Tree;

/// A folder of members and the file that lists them.
struct Family {
    /// Folder with one file (or folder) a member.
    folder: &'static str,
    /// The list: every member's file name occurs in its code.
    list: &'static str,
    /// What every member's code holds, where other files live in the folder too; empty: every file is a member.
    marker: &'static str,
}

const FAMILIES: &[Family] = &[
    Family { folder: "crates/intersect/src/methods", list: "crates/intersect/src/list.rs", marker: "" },
    Family { folder: "crates/accel/src/structures", list: "crates/accel/src/list.rs", marker: "" },
    Family { folder: "crates/photons/src/searches", list: "crates/photons/src/list.rs", marker: "" },
    Family { folder: "crates/photons/src/supports", list: "crates/photons/src/supports/list.rs", marker: "" },
    Family { folder: "crates/render/src/indirect", list: "crates/render/src/indirect/mod.rs", marker: "const ABOUT" },
    Family { folder: "crates/image/src/tonemap", list: "crates/image/src/tonemap/list.rs", marker: "" },
    Family { folder: "crates/render/src/bsdf/members", list: "crates/render/src/bsdf/members/mod.rs", marker: "" },
    Family { folder: "crates/scene/src/load", list: "crates/scene/src/load/list.rs", marker: "fn looks_like(" },
    Family { folder: "crates/scene/src/builtin", list: "crates/scene/src/builtin/list.rs", marker: "() -> Scene" },
];

/// Checks every family both ways.
pub fn check(tree: &Tree) -> Vec<Finding> {
    check_against(tree, FAMILIES)
}

fn check_against(tree: &Tree, families: &[Family]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for family in families {
        let Some(list) = tree.file(family.list) else {
            findings.push(Finding::new(family.list, 0, format!("the list of {} is missing", family.folder)));
            continue;
        };
        let code: Vec<String> = split(&list.text).into_iter().map(|line| line.code).collect();
        let listed = |name: &str| code.iter().any(|line| has_name(line, name));
        let members = members(tree, family);
        if members.is_empty() {
            findings.push(Finding::new(family.folder, 0, "a family without members"));
        }
        for member in members.iter().filter(|member| !listed(member)) {
            findings.push(Finding::new(family.folder, 0, format!("`{member}` is not on the list {}", family.list)));
        }
    }
    findings
}

/// Names of a family's members: its files without extension, and its folders.
fn members<'a>(tree: &'a Tree, family: &Family) -> Vec<&'a str> {
    let mut names: Vec<&str> = tree
        .paths
        .iter()
        .filter(|path| *path != family.list)
        .filter_map(|path| path.strip_prefix(family.folder)?.strip_prefix('/'))
        .map(|rest| rest.split_once('/').map_or_else(|| rest.trim_end_matches(".rs"), |(folder, _)| folder))
        .filter(|name| *name != "mod")
        .collect();
    names.dedup();
    names.retain(|name| {
        let places = [format!("{}/{name}.rs", family.folder), format!("{}/{name}/mod.rs", family.folder)];
        let mut files = places.iter().filter_map(|place| tree.file(place));
        family.marker.is_empty() || files.any(|file| file.text.contains(family.marker))
    });
    names
}

/// Whether `name` stands in `code` as a whole word.
fn has_name(code: &str, name: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(name)
        .any(|(at, word)| !code[..at].ends_with(part_of_name) && !code[at + word.len()..].starts_with(part_of_name))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAMILY: &[Family] = &[Family { folder: "a/methods", list: "a/list.rs", marker: "" }];

    fn found(list: &str) -> Vec<String> {
        let files =
            [("a/list.rs", list), ("a/methods/mod.rs", ""), ("a/methods/badouel.rs", ""), ("a/methods/wide/x.rs", "")];
        check_against(&Tree::of(&files), FAMILY).into_iter().map(|finding| finding.what).collect()
    }

    #[test]
    fn files_without_the_marker_are_no_members() {
        const MARKED: &[Family] = &[Family { folder: "a", list: "a/list.rs", marker: "fn load(" }];
        let helper = ("a/helper.rs", "fn help() {}");
        let member = ("a/obj/mod.rs", "fn load() {}");
        assert!(check_against(&Tree::of(&[("a/list.rs", "obj"), helper, member]), MARKED).is_empty());
        assert_eq!(check_against(&Tree::of(&[("a/list.rs", ""), helper, member]), MARKED).len(), 1);
    }

    #[test]
    fn a_member_off_the_list_is_found() {
        assert!(found("use m::{badouel, wide};\n").is_empty());
        assert_eq!(found("use m::badouel;\n").len(), 1);
        assert_eq!(found("// badouel\nuse m::{badouel_2, wide};\n").len(), 1, "a comment or a longer name is no entry");
        assert_eq!(check_against(&Tree::of(&[]), FAMILY).len(), 1, "a missing list is found");
        assert_eq!(check_against(&Tree::of(&[("a/list.rs", "")]), FAMILY).len(), 1, "an empty family is found");
    }
}
