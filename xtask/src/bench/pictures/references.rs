//! Reference pictures and masks: those beside the real scenes where `PHOTINUS_SCENES` leads to them, else made here once.

use super::engines::Package;
use super::environment::Environment;
use super::setting::{Lamp, Prepared, SIZE};
use crate::Failure;
use crate::bench::timed;
use std::path::{Path, PathBuf};

/// Processor seconds of a reference that is made here: in a quick run, else.
const SECONDS: [u32; 2] = [120, 1800];

/// A reference and where it comes from.
pub struct Reference {
    /// Linear EXR.
    pub picture: PathBuf,
    /// Mask of what counts.
    pub counted: PathBuf,
    /// Mask of the caustic.
    pub caustic: PathBuf,
    /// One line for the reader.
    pub source: String,
}

impl Reference {
    fn in_folder(folder: &Path, name: &str, source: String) -> Self {
        let file = |ending: &str| folder.join(format!("{name}.{ending}"));
        Self { picture: file("exr"), counted: file("counted.png"), caustic: file("caustic.png"), source }
    }

    fn is_whole(&self) -> bool {
        [&self.picture, &self.counted, &self.caustic].iter().all(|path| path.is_file())
    }
}

/// The reference of a lamp.
pub fn provide(
    lamp: &Lamp,
    scene: &Prepared,
    photinus: &Path,
    environment: Option<&Environment>,
    quick: bool,
) -> Result<Reference, Failure> {
    let scenes = std::env::var_os("PHOTINUS_SCENES");
    if let Some(given) = scenes.and_then(|scenes| given(Path::new(&scenes), lamp)) {
        return Ok(given);
    }
    let environment = environment.ok_or("none is given, and to make one takes the peers' Python")?;
    make(lamp, scene, photinus, environment, SECONDS[usize::from(!quick)])
}

/// The reference beside the real scenes, if it is there with both its masks.
fn given(scenes: &Path, lamp: &Lamp) -> Option<Reference> {
    let source = "caustics/two-spheres below PHOTINUS_SCENES".to_owned();
    let given = Reference::in_folder(&scenes.join("caustics/two-spheres"), lamp.name, source);
    given.is_whole().then_some(given)
}

/// Makes a reference, or finds the one that was made with as much time.
fn make(
    lamp: &Lamp,
    scene: &Prepared,
    photinus: &Path,
    environment: &Environment,
    seconds: u32,
) -> Result<Reference, Failure> {
    let mitsuba = environment.provide(Package::Python("mitsuba"));
    let by = if mitsuba.is_ok() { "mitsuba" } else { "photinus" };
    let folder = environment.folder().join(format!("references/{by}-{seconds}s"));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let source = match &mitsuba {
        Ok(()) if lamp.by_light_alone => format!("made here by Mitsuba's light tracing, {seconds} s"),
        Ok(()) => format!("made here by Mitsuba's path and light tracing, {seconds} s"),
        Err(why) => format!("made here by Photinus itself, {seconds} s with another seed, which favours it ({why})"),
    };
    let made = Reference::in_folder(&folder, lamp.name, source);
    if made.is_whole() {
        return Ok(made);
    }
    eprintln!("reference of {}: {}", lamp.name, made.source);
    let objects = folder.join(format!("{}.objects.exr", lamp.name));
    let ours = |extra: &[&str], picture: &Path| -> Result<(), Failure> {
        let size = format!("{SIZE}x{SIZE}");
        let mut words = vec![photinus.display().to_string()];
        words.extend(["render", lamp.scene, "--quiet", "--size", &size, "-o"].map(str::to_owned));
        words.push(picture.display().to_string());
        words.extend(extra.iter().map(|&word| word.to_owned()));
        timed::run(&words, &[], &folder, 300 + 20 * seconds).map(drop)
    };
    ours(&["--passes", "1", "--aov", "object-id"], &objects)?;
    let partial = folder.join(format!("{}.partial.exr", lamp.name));
    let mut words = environment.driver("reference.py");
    if mitsuba.is_ok() {
        words.extend(["--xml".to_owned(), scene.folder.join("scene.xml").display().to_string()]);
        words.extend(["--seconds".to_owned(), seconds.to_string()]);
    } else {
        ours(&["--seed", "1000003", "--cpu-time", &seconds.to_string()], &partial)?;
    }
    // Objects count from 1 in the scene's order: meshes, then spheres. 0 is where nothing is.
    let place = |name: &str| -> Result<String, Failure> {
        let found = scene.scene.meshes.iter().position(|mesh| mesh.name == name);
        found.map(|i| (i + 1).to_string()).ok_or_else(|| format!("the scene has no {name}"))
    };
    let lamp_name = scene.scene.lamp()?.name.clone();
    words.extend(["--floor".to_owned(), place("floor")?, "--lamp".to_owned(), place(&lamp_name)?]);
    words.push("--spheres".to_owned());
    words.extend((0..scene.scene.spheres.len()).map(|i| (scene.scene.meshes.len() + 1 + i).to_string()));
    if lamp.by_light_alone {
        words.push("--lights-only".to_owned());
    }
    for (name, path) in
        [("objects", &objects), ("picture", &partial), ("counted", &made.counted), ("caustic", &made.caustic)]
    {
        words.extend([format!("--{name}"), path.display().to_string()]);
    }
    timed::run(&words, &environment.variables(), &folder, 300 + 20 * seconds)?;
    // Renamed at the end, so that an interrupted bench leaves no half of a reference.
    std::fs::rename(&partial, &made.picture).map_err(|e| format!("{}: {e}", made.picture.display()))?;
    if made.is_whole() { Ok(made) } else { Err(format!("no whole reference in {}", folder.display())) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::pictures::setting::LAMPS;

    #[test]
    fn a_given_reference_counts_only_with_both_masks() {
        let scenes = tempfile::tempdir().unwrap();
        let folder = scenes.path().join("caustics/two-spheres");
        std::fs::create_dir_all(&folder).unwrap();
        for name in ["large-lamp.exr", "large-lamp.counted.png", "large-lamp.caustic.png"] {
            assert!(given(scenes.path(), &LAMPS[0]).is_none(), "before {name}");
            std::fs::write(folder.join(name), "").unwrap();
        }
        assert_eq!(given(scenes.path(), &LAMPS[0]).unwrap().picture, folder.join("large-lamp.exr"));
        assert!(given(scenes.path(), &LAMPS[1]).is_none());
    }
}
