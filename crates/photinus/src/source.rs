//! Where a scene comes from: a file, or a name of a built-in scene.

use crate::names::{self, SCENES};
use crate::{Error, Result};
use photinus_scene::{LoadOptions, Scene, builtin};
use std::path::Path;

/// Opens the scene that somebody named: a built-in scene, or else a file.
///
/// A plain name that is both is the built-in scene; `./name` is always the file.
///
/// # Errors
/// [`Error::UnknownScene`] where it is neither, [`Error::Load`] where the file cannot be used.
pub fn open(name: &str, options: &LoadOptions) -> Result<Scene> {
    if let Some(scene) = builtin::build(name) {
        return Ok(scene);
    }
    let path = Path::new(name);
    let looks_like_a_file = name.contains(['/', '\\', '.']);
    if path.exists() || looks_like_a_file {
        return Ok(photinus_scene::load(path, options)?);
    }
    let members = SCENES.members();
    let names: Vec<&str> = members.iter().map(|member| member.name).collect();
    Err(Error::UnknownScene { name: name.to_owned(), hint: names::hint(&name.replace('_', "-"), &names) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_scenes_open_by_name() {
        let scene = open("two_spheres", &LoadOptions::default()).unwrap();
        assert_eq!(scene.name, "two-spheres");
    }

    #[test]
    fn what_is_neither_says_so() {
        let message = |name: &str| open(name, &LoadOptions::default()).unwrap_err().to_string();
        assert_eq!(
            message("two-spehres"),
            "two-spehres: no such file and no built-in scene of that name; did you mean two-spheres?"
        );
        let missing = message("nowhere/scene.xml");
        assert!(missing.starts_with("nowhere/scene.xml: there is no such file"), "{missing}");
    }
}
