//! The repository's text files, read once for all rules.

use std::path::Path;

/// A text file.
pub struct File {
    /// Path from the root with forward slashes.
    pub path: String,
    /// Its text.
    pub text: String,
}

impl File {
    /// Whether its name ends in `.extension`.
    pub fn is(&self, extension: &str) -> bool {
        self.path.strip_suffix(extension).is_some_and(|stem| stem.ends_with('.'))
    }

    /// Lines with their numbers from 1.
    pub fn lines(&self) -> impl Iterator<Item = (usize, &str)> {
        self.text.lines().enumerate().map(|(i, line)| (i + 1, line))
    }
}

/// All text files in order of path, and the paths of all files.
#[derive(Default)]
pub struct Tree {
    /// Files that are valid UTF-8.
    pub files: Vec<File>,
    /// Files of every kind.
    pub paths: Vec<String>,
}

/// Folders that hold products, not sources.
const SKIPPED: &[&str] = &["target", ".git", "__pycache__", "node_modules"];

impl Tree {
    /// Reads everything below `root` but products.
    pub fn read(root: &Path) -> Result<Self, String> {
        let mut tree = Self::default();
        tree.enter(root, "")?;
        tree.paths.sort();
        tree.files.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(tree)
    }

    fn enter(&mut self, root: &Path, folder: &str) -> Result<(), String> {
        let place = root.join(folder);
        let entries = std::fs::read_dir(&place).map_err(|e| format!("{}: {e}", place.display()))?;
        for entry in entries {
            let entry = entry.map_err(|e| format!("{}: {e}", place.display()))?;
            let Ok(name) = entry.file_name().into_string() else { continue };
            let path = if folder.is_empty() { name.clone() } else { format!("{folder}/{name}") };
            let kind = entry.file_type().map_err(|e| format!("{path}: {e}"))?;
            if kind.is_dir() {
                if !SKIPPED.contains(&name.as_str()) {
                    self.enter(root, &path)?;
                }
            } else if kind.is_file() && path != ".git" {
                let bytes = std::fs::read(entry.path()).map_err(|e| format!("{path}: {e}"))?;
                if let Ok(text) = String::from_utf8(bytes) {
                    self.files.push(File { path: path.clone(), text });
                }
                self.paths.push(path);
            }
        }
        Ok(())
    }

    /// The file at `path`.
    pub fn file(&self, path: &str) -> Option<&File> {
        self.files.iter().find(|file| file.path == path)
    }

    /// Rust sources.
    pub fn rust(&self) -> impl Iterator<Item = &File> {
        self.files.iter().filter(|file| file.is("rs"))
    }

    /// A tree made up for a test.
    #[cfg(test)]
    pub fn of(files: &[(&str, &str)]) -> Self {
        Self {
            files: files.iter().map(|&(path, text)| File { path: path.into(), text: text.into() }).collect(),
            paths: files.iter().map(|&(path, _)| path.into()).collect(),
        }
    }
}
