//! Rules about pages: links resolve, no page is an orphan, the README keeps its two commands.

use super::Finding;
use super::tree::{File, Tree};

/// A link that leads into the repository: where it stands, what file it names, what heading.
struct Link<'a> {
    line: usize,
    target: &'a str,
    anchor: Option<&'a str>,
}

/// Relative links name files that exist and headings in them.
pub fn links(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for page in tree.files.iter().filter(|file| file.is("md")) {
        for link in local_links(page) {
            let path = if link.target.is_empty() { page.path.clone() } else { resolve(&page.path, link.target) };
            let folder = format!("{}/", path.trim_end_matches('/'));
            if !tree.paths.contains(&path) && !tree.paths.iter().any(|p| p.starts_with(&folder)) {
                findings.push(Finding::new(&page.path, link.line, format!("`{}` does not exist", link.target)));
            } else if let (Some(anchor), Some(other)) = (link.anchor, tree.file(&path))
                && other.is("md")
                && !headings(other).any(|heading| heading == anchor)
            {
                findings.push(Finding::new(&page.path, link.line, format!("{path} has no heading `#{anchor}`")));
            }
        }
    }
    findings
}

/// Pages under docs/ are reachable from the two front pages.
pub fn orphans(tree: &Tree) -> Vec<Finding> {
    let fronts = tree.files.iter().filter(|file| ["README.md", "ARCHITECTURE.md"].contains(&file.path.as_str()));
    let linked: Vec<String> =
        fronts.flat_map(|page| local_links(page).into_iter().map(|link| resolve(&page.path, link.target))).collect();
    let pages = tree.files.iter().filter(|file| file.path.starts_with("docs/") && file.is("md"));
    pages
        .filter(|page| !linked.contains(&page.path))
        .map(|page| Finding::new(&page.path, 0, "linked from neither README.md nor ARCHITECTURE.md"))
        .collect()
}

/// The two commands that a newcomer types stand in the README, each on a line of its own.
pub fn commands(tree: &Tree) -> Vec<Finding> {
    const COMMANDS: &[&str] = &["cargo run --release -- render", "cargo xtask ci --install"];
    let Some(readme) = tree.file("README.md") else {
        return vec![Finding::new("README.md", 0, "is missing")];
    };
    let missing = COMMANDS.iter().filter(|command| !readme.text.lines().any(|line| line.trim() == **command));
    missing.map(|command| Finding::new("README.md", 0, format!("lacks the line `{command}`"))).collect()
}

fn local_links(page: &File) -> Vec<Link<'_>> {
    let mut links = Vec::new();
    let mut fenced = false;
    for (line, text) in page.lines() {
        if text.trim_start().starts_with("```") {
            fenced = !fenced;
        }
        if fenced {
            continue;
        }
        for (at, _) in text.match_indices("](") {
            let rest = &text[at + 2..];
            let Some(end) = rest.find(')') else { continue };
            let target = rest[..end].split_whitespace().next().unwrap_or_default();
            if target.contains("://") || target.starts_with("mailto:") {
                continue;
            }
            let (target, anchor) = match target.split_once('#') {
                Some((target, anchor)) => (target, Some(anchor)),
                None => (target, None),
            };
            links.push(Link { line, target, anchor });
        }
    }
    links
}

/// The path from the root of `target` as written on the page at `page`.
fn resolve(page: &str, target: &str) -> String {
    let mut parts: Vec<&str> = page.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Anchors of a page's headings: lower case, punctuation dropped, spaces as hyphens.
fn headings(page: &File) -> impl Iterator<Item = String> + '_ {
    page.text.lines().filter(|line| line.starts_with('#')).map(|line| {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(check: fn(&Tree) -> Vec<Finding>, files: &[(&str, &str)]) -> usize {
        check(&Tree::of(files)).len()
    }

    #[test]
    fn links_must_lead_somewhere() {
        let page = ("docs/a.md", "# What it is: a test\n");
        let good = "[a](docs/a.md) [b](docs/a.md#what-it-is-a-test) [c](https://x.org/y) [d](docs/) [e](#top)\n# Top\n";
        assert_eq!(count(links, &[("README.md", good), page]), 0);
        assert_eq!(count(links, &[("README.md", "[a](docs/b.md) [b](docs/a.md#nothing)"), page]), 2);
        assert_eq!(count(links, &[("docs/b.md", "[up](../README.md) [on](a.md)"), page, ("README.md", "")]), 0);
        assert_eq!(count(links, &[("README.md", "```\nv[0](x)\n```\n")]), 0, "code is no link");
    }

    #[test]
    fn pages_must_be_linked() {
        let page = ("docs/a.md", "");
        assert_eq!(count(orphans, &[("README.md", "[a](docs/a.md)"), page]), 0);
        assert_eq!(count(orphans, &[("README.md", ""), page]), 1);
    }

    #[test]
    fn the_two_commands_must_stand_there() {
        let good = "    cargo run --release -- render\n    cargo xtask ci --install\n";
        assert_eq!(count(commands, &[("README.md", good)]), 0);
        assert_eq!(count(commands, &[("README.md", "cargo run --release -- render --fast\n")]), 2);
    }
}
