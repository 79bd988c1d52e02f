//! Ids that are unique in a file, and file names that every system takes.

use std::collections::HashSet;

/// One id for each object of a list.
pub struct Names(Vec<String>);

impl Names {
    /// The names as they are, apart from empty ones.
    pub fn new<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        Self(names.map(|n| if n.is_empty() { "unnamed".to_string() } else { n.to_string() }).collect())
    }

    /// Makes all ids of all lists different by adding numbers.
    pub fn separate(lists: &mut [&mut Self]) {
        let mut taken = HashSet::new();
        for name in lists.iter_mut().flat_map(|l| l.0.iter_mut()) {
            if taken.insert(name.clone()) {
                continue;
            }
            // Numbers start where the set is: long lists of equal names stay fast.
            let mut number = taken.len();
            loop {
                let candidate = format!("{name}-{number}");
                if taken.insert(candidate.clone()) {
                    *name = candidate;
                    break;
                }
                number += 1;
            }
        }
    }

    /// The id of object `i`.
    pub fn get(&self, i: usize) -> &str {
        &self.0[i]
    }
}

/// A name as part of a file name: letters, digits, `.`, `-` and `_`, at most 60 of them.
pub fn file_name(name: &str) -> String {
    let safe = |c: char| if c.is_alphanumeric() || matches!(c, '.' | '-' | '_') { c } else { '_' };
    name.chars().take(60).map(safe).collect::<String>().trim_start_matches('.').to_string()
}
