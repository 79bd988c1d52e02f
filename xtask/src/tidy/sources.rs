//! Rules about the text of source files.

use super::Finding;
use super::rust_lines::split;
use super::tree::{File, Tree};

/// Longest file, in lines.
const MAX_LINES: usize = 600;

/// Kinds of files that people write by hand.
const WRITTEN: &[&str] = &["rs", "py", "pyi", "sv", "sh", "md", "toml", "yml", "yaml", "cpp", "h"];

/// Every Rust file begins with a module comment whose first sentence says what it is for.
pub fn purpose(tree: &Tree) -> Vec<Finding> {
    let has_purpose = |file: &File| {
        let sentence: Vec<&str> = file.text.lines().map_while(|line| line.strip_prefix("//!")).collect();
        sentence.iter().any(|line| line.contains(['.', ':']))
    };
    let bare = tree.rust().filter(|file| !has_purpose(file));
    bare.map(|file| Finding::new(&file.path, 1, "no `//!` comment with a sentence at its head")).collect()
}

/// Hand-written files stay short.
pub fn length(tree: &Tree) -> Vec<Finding> {
    let written = tree.files.iter().filter(|file| WRITTEN.iter().any(|kind| file.is(kind)));
    written
        .filter_map(|file| {
            let lines = file.text.lines().count();
            (lines > MAX_LINES).then(|| Finding::new(&file.path, 0, format!("{lines} lines: split it")))
        })
        .collect()
}

/// A source file that no module declares is never compiled.
pub fn orphans(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for file in tree.rust() {
        let Some((folder, module)) = module_of(&file.path) else { continue };
        // Modules are declared in the folder's own file, or inline in that of the folder above.
        let above = folder.rsplit_once('/').map_or("", |(above, _)| above);
        let declared = [folder, above].iter().any(|place| {
            let owners = ["/mod.rs", "/lib.rs", "/main.rs", ".rs"].map(|ending| format!("{place}{ending}"));
            owners.iter().filter_map(|owner| tree.file(owner)).any(|owner| {
                let lines = split(&owner.text);
                let declaration = format!("mod {module};");
                lines.iter().any(|line| line.code.trim_start_matches("pub(crate) ").trim().ends_with(&declaration))
            })
        });
        // Or by path, from a file beside it.
        let attribute = format!("#[path = \"{module}.rs\"]");
        let by_path = tree.rust().any(|other| {
            other.path.rsplit_once('/').is_some_and(|(place, _)| place == folder) && other.text.contains(&attribute)
        });
        if !declared && !by_path {
            findings.push(Finding::new(&file.path, 0, "no module declares this file"));
        }
    }
    findings
}

/// Folder and name of the module in a file below some `src`; none for roots and for files elsewhere.
fn module_of(path: &str) -> Option<(&str, &str)> {
    let inside = path.split_once("/src/")?.1;
    let (folder, name) = path.rsplit_once('/')?;
    let name = name.strip_suffix(".rs")?;
    match name {
        "lib" | "main" if !inside.contains('/') => None,
        "mod" => folder.rsplit_once('/'),
        _ => Some((folder, name)),
    }
}

/// Marks of work left undone, and tests that are switched off.
pub fn unfinished(tree: &Tree) -> Vec<Finding> {
    const CODE: &[&str] = &["todo!", "unimplemented!", "dbg!", "#[ignore"];
    const COMMENTS: &[&str] = &["TODO", "FIXME", "XXX", "HACK"];
    let mut findings = Vec::new();
    for file in tree.rust() {
        for (i, line) in split(&file.text).iter().enumerate() {
            let code = CODE.iter().filter(|word| line.code.contains(**word));
            let comments = COMMENTS.iter().filter(|word| has_word(&line.comment, word));
            findings.extend(code.chain(comments).map(|word| Finding::new(&file.path, i + 1, format!("`{word}`"))));
        }
    }
    findings
}

/// A fused multiply-add rounds once where other machines round twice.
pub fn fused(tree: &Tree) -> Vec<Finding> {
    const WORDS: &[&str] = &["mul_add", "fmadd", "fmsub", "fnmadd", "fnmsub"];
    let mut findings = Vec::new();
    for file in tree.rust() {
        for (i, line) in split(&file.text).iter().enumerate() {
            if let Some(word) = WORDS.iter().find(|word| line.code.contains(**word)) {
                findings.push(Finding::new(&file.path, i + 1, format!("`{word}`: multiply, then add")));
            }
        }
    }
    findings
}

/// Absolute paths that exist on one machine only.
pub fn machine_paths(tree: &Tree) -> Vec<Finding> {
    const FOLDERS: &[&str] = &["work", "tmp", "home", "root", "Users", "mnt"];
    let mut findings = Vec::new();
    for file in tree.files.iter().filter(|file| !file.is("lock")) {
        for (number, line) in file.lines() {
            for folder in FOLDERS {
                let path = format!("/{folder}/");
                let found = line
                    .match_indices(&path)
                    .any(|(at, _)| !line[..at].ends_with(|c: char| c.is_alphanumeric() || "._-/}*".contains(c)));
                if found {
                    findings.push(Finding::new(&file.path, number, format!("`{path}`")));
                }
            }
        }
    }
    findings
}

/// Numbers of issues mean nothing to a reader of the source.
pub fn issue_numbers(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for file in &tree.files {
        if file.is("rs") {
            for (i, line) in split(&file.text).iter().enumerate() {
                if names_an_issue(&line.comment) {
                    findings.push(Finding::new(&file.path, i + 1, "an issue number: say the thing itself"));
                }
            }
        } else if file.is("md") {
            for (number, line) in file.lines().filter(|(_, line)| names_an_issue(line)) {
                findings.push(Finding::new(&file.path, number, format!("an issue number: `{}`", line.trim())));
            }
        }
    }
    findings
}

fn names_an_issue(text: &str) -> bool {
    let lower = text.to_lowercase();
    let after = |word: &str| {
        lower.match_indices(word).any(|(at, _)| {
            let rest = lower[at + word.len()..].trim_start_matches(['#', ' ']);
            rest.starts_with(|c: char| c.is_ascii_digit())
        })
    };
    let hash = text.match_indices('#').any(|(at, _)| {
        let digits = text[at + 1..].chars().take_while(char::is_ascii_digit).count();
        let next = text[at + 1 + digits..].chars().next();
        (1..=5).contains(&digits)
            && (at == 0 || text[..at].ends_with([' ', '(']))
            && !next.is_some_and(|c| c.is_alphanumeric() || c == '-')
    });
    after("issue ") || after("issue#") || after("issues ") || after("pull request ") || hash
}

fn has_word(text: &str, word: &str) -> bool {
    text.match_indices(word).any(|(at, _)| {
        !text[..at].ends_with(char::is_alphanumeric) && !text[at + word.len()..].starts_with(char::is_alphanumeric)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines_found(check: fn(&Tree) -> Vec<Finding>, path: &str, text: &str) -> Vec<usize> {
        check(&Tree::of(&[(path, text)])).iter().map(|finding| finding.line).collect()
    }

    #[test]
    fn purpose_needs_a_sentence() {
        assert_eq!(lines_found(purpose, "a.rs", "fn f() {}\n"), [1]);
        assert_eq!(lines_found(purpose, "a.rs", "//! Nothing\nfn f() {}\n"), [1]);
        assert!(lines_found(purpose, "a.rs", "//! Adds\n//! numbers.\nfn f() {}\n").is_empty());
    }

    #[test]
    fn files_that_no_module_declares_are_found() {
        let lib = ("c/src/lib.rs", "pub mod a;\nmod b { pub mod inner; }\n// mod lost;\n");
        let files = [lib, ("c/src/a/mod.rs", "mod part;\n"), ("c/src/a/part.rs", ""), ("c/src/lost.rs", "")];
        let found = orphans(&Tree::of(&files));
        assert_eq!(found.iter().map(|f| f.path.as_str()).collect::<Vec<_>>(), ["c/src/lost.rs"]);
    }

    #[test]
    fn long_files_are_found_unless_they_are_data() {
        let long = "x\n".repeat(MAX_LINES + 1);
        assert_eq!(lines_found(length, "a.rs", &long), [0]);
        assert!(lines_found(length, "a.rs", &"x\n".repeat(MAX_LINES)).is_empty());
        assert!(lines_found(length, "Cargo.lock", &long).is_empty());
    }

    #[test]
    fn unfinished_code_is_found_and_words_about_it_are_not() {
        assert_eq!(lines_found(unfinished, "a.rs", "//! A.\nfn f() { todo!() }\n"), [2]);
        assert_eq!(lines_found(unfinished, "a.rs", "// FIXME: later\n#[ignore]\n#[ignore = \"slow\"]\n"), [1, 2, 3]);
        assert!(lines_found(unfinished, "a.rs", "// say todo!\nlet a = \"dbg!\";\n").is_empty());
    }

    #[test]
    fn fused_arithmetic_is_found() {
        assert_eq!(lines_found(fused, "a.rs", "let a = b.mul_add(c, d);\nlet e = _mm256_fmadd_ps(f, g, h);"), [1, 2]);
        assert!(lines_found(fused, "a.rs", "// never mul_add\nlet a = b * c + d;").is_empty());
    }

    #[test]
    fn paths_of_one_machine_are_found() {
        let path = |folder: &str| format!("open(\"/{folder}/scene.xml\")\n");
        assert_eq!(lines_found(machine_paths, "a.rs", &(path("work") + &path("tmp") + &path("home"))), [1, 2, 3]);
        assert!(lines_found(machine_paths, "a.rs", &(path("proc") + "crates/work/a docs.rs/tmp/x\n")).is_empty());
    }

    #[test]
    fn issue_numbers_are_found_in_comments_and_pages() {
        for text in ["// see issue 12", "// closes #7", "/// Issue #3.", "// (#41)"] {
            assert_eq!(lines_found(issue_numbers, "a.rs", text), [1], "{text}");
        }
        for text in ["// colour #123456", "#[derive(Debug)]", "// the second issue", "// see page.md#1-what"] {
            assert!(lines_found(issue_numbers, "a.rs", text).is_empty(), "{text}");
        }
        assert_eq!(lines_found(issue_numbers, "A.md", "# 1. Title\nsee #12\n"), [2]);
    }
}
