//! The house rules as code. Each rule looks at the whole tree and returns what it found.

mod families;
mod licences;
mod manifests;
mod markdown;
mod rust_lines;
mod sources;
mod tree;
mod unsafe_files;

use crate::Failure;
use std::path::Path;
use tree::Tree;

/// Something that breaks a rule.
struct Finding {
    path: String,
    /// Line from 1; 0 for the whole file.
    line: usize,
    what: String,
}

impl Finding {
    fn new(path: &str, line: usize, what: impl Into<String>) -> Self {
        Self { path: path.into(), line, what: what.into() }
    }
}

/// A rule and its name.
struct Rule {
    name: &'static str,
    check: fn(&Tree) -> Vec<Finding>,
}

const RULES: &[Rule] = &[
    Rule { name: "every source file begins with a sentence of purpose", check: sources::purpose },
    Rule { name: "no file is longer than 600 lines", check: sources::length },
    Rule { name: "every source file belongs to a module", check: sources::orphans },
    Rule { name: "no unfinished or switched-off code", check: sources::unfinished },
    Rule { name: "no fused multiply-add", check: sources::fused },
    Rule { name: "no paths of one machine", check: sources::machine_paths },
    Rule { name: "no issue numbers", check: sources::issue_numbers },
    Rule { name: "unsafe code only in listed files, each with a scalar twin", check: unsafe_files::check },
    Rule { name: "every member of a family is on its list", check: families::check },
    Rule { name: "manifests are complete and pins have a reason", check: manifests::check },
    Rule { name: "links between documents resolve", check: markdown::links },
    Rule { name: "every page is linked from README or ARCHITECTURE", check: markdown::orphans },
    Rule { name: "the README has its two commands", check: markdown::commands },
];

/// Checks all rules and describes the outcome in one line.
pub fn run(root: &Path) -> Result<String, Failure> {
    let tree = Tree::read(root).map_err(|e| format!("tidy: {e}"))?;
    let mut lines = Vec::new();
    for rule in RULES {
        for finding in (rule.check)(&tree) {
            let place = if finding.line > 0 { format!("{}:{}", finding.path, finding.line) } else { finding.path };
            lines.push(format!("{place}: {} ({})", finding.what, rule.name));
        }
    }
    lines.extend(licences::check(root)?);
    if lines.is_empty() {
        Ok(format!("tidy: {} files, {} rules, nothing found", tree.files.len(), RULES.len() + 1))
    } else {
        Err(format!("tidy: {} findings\n  {}", lines.len(), lines.join("\n  ")))
    }
}
