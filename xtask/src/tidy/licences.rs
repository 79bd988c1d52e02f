//! Every crate that the workspace is built from carries a licence that `deny.toml` allows.

use crate::Failure;
use crate::metadata::Metadata;
use std::path::Path;

/// One line for each crate whose licence is not allowed.
pub fn check(root: &Path) -> Result<Vec<String>, Failure> {
    let text = std::fs::read_to_string(root.join("deny.toml")).map_err(|e| format!("deny.toml: {e}"))?;
    let allowed = allowed(&text);
    if allowed.is_empty() {
        return Err("deny.toml: no `allow = [...]` under [licenses]".into());
    }
    let packages = Metadata::of_everything(root)?.packages;
    let refused = packages.iter().filter(|package| {
        let expression = package.license.as_deref().unwrap_or("none");
        !Expression::new(expression).holds(&allowed)
    });
    Ok(refused
        .map(|package| {
            let licence = package.license.as_deref().unwrap_or("none");
            format!("{} {}: licence {licence} is not allowed by deny.toml", package.name, package.version)
        })
        .collect())
}

/// The strings of the list `allow` in the section `[licenses]`.
fn allowed(toml: &str) -> Vec<&str> {
    let section = toml.split("[licenses]").nth(1).unwrap_or_default();
    let list = section.split("allow = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap_or_default();
    list.split('"').skip(1).step_by(2).collect()
}

/// An SPDX expression: names joined by AND, OR and WITH, with parentheses; a slash is the older way to write OR.
struct Expression {
    tokens: Vec<String>,
    at: usize,
}

impl Expression {
    fn new(text: &str) -> Self {
        let spaced = text.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ").replace(" WITH ", "-WITH-");
        Self { tokens: spaced.split_whitespace().map(String::from).collect(), at: 0 }
    }

    /// Whether the licence can be met with the names allowed; a malformed expression cannot.
    fn holds(mut self, allowed: &[&str]) -> bool {
        self.any_of(allowed) && self.at == self.tokens.len()
    }

    fn any_of(&mut self, allowed: &[&str]) -> bool {
        let mut met = self.all_of(allowed);
        while self.accept("OR") {
            met |= self.all_of(allowed);
        }
        met
    }

    fn all_of(&mut self, allowed: &[&str]) -> bool {
        let mut met = self.one(allowed);
        while self.accept("AND") {
            met &= self.one(allowed);
        }
        met
    }

    fn one(&mut self, allowed: &[&str]) -> bool {
        if self.accept("(") {
            let met = self.any_of(allowed);
            return self.accept(")") && met;
        }
        let name = self.tokens.get(self.at).cloned().unwrap_or_default();
        self.at += 1;
        allowed.contains(&name.replace("-WITH-", " WITH ").as_str())
    }

    fn accept(&mut self, token: &str) -> bool {
        let found = self.tokens.get(self.at).is_some_and(|t| t == token);
        self.at += usize::from(found);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_are_read_as_spdx_means_them() {
        let allowed = ["MIT", "Zlib", "Apache-2.0 WITH LLVM-exception"];
        for good in ["MIT", "GPL-3.0 OR MIT", "MIT/Apache-2.0", "(GPL-3.0 OR MIT) AND Zlib"] {
            assert!(Expression::new(good).holds(&allowed), "{good}");
        }
        assert!(Expression::new("Apache-2.0 WITH LLVM-exception").holds(&allowed));
        for bad in ["GPL-3.0", "MIT AND GPL-3.0", "", "none", "(MIT", "MIT Zlib"] {
            assert!(!Expression::new(bad).holds(&allowed), "{bad}");
        }
    }

    #[test]
    fn the_list_is_read_from_its_section() {
        let toml = "[bans]\nallow = [\"x\"]\n[licenses]\nallow = [\n  \"MIT\",\n  \"Zlib\",\n]\n";
        assert_eq!(allowed(toml), ["MIT", "Zlib"]);
    }
}
