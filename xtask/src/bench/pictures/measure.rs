//! Runs engines: the small picture that shows agreement, the timed picture, its denoised twin, and their errors.

use super::engines::{ENGINES, Engine, Package};
use super::environment::{DENOISER, Environment};
use super::references::{self, Reference};
use super::setting::{LAMPS, Lamp, Prepared, SIZE, Setting, TRIAL_SIZE, prepare};
use crate::Failure;
use crate::bench::timed;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// How far an engine's brightness may lie from the reference's: photon methods are biased by some percent, wrong units by
/// more.
const TOLERANCE: f64 = 0.08;

/// Errors of a picture, and the processor seconds that it took.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// Trimmed relMSE of all that counts, relMSE of the caustic.
    pub errors: [f64; 2],
    pub cpu_seconds: f64,
}

/// One engine's picture of one setting.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub plain: Judged,
    /// The same picture denoised, its seconds those of both steps.
    pub denoised: Option<Judged>,
    /// What was done in the time.
    pub work: String,
}

impl Outcome {
    /// One line for somebody who watches.
    pub fn line(&self) -> String {
        let words = |judged: &Judged| {
            let [counted, caustic] = judged.errors;
            format!("{:.1} s, trimmed {counted:.5}, caustic {caustic:.5}", judged.cpu_seconds)
        };
        let denoised = self.denoised.as_ref().map_or(String::new(), |judged| format!("; denoised {}", words(judged)));
        format!("{} ({}){denoised}", words(&self.plain), self.work)
    }
}

/// What a driver says at its end.
#[derive(Deserialize)]
struct Said {
    work: String,
    /// Its own count of seconds, where it goes on working after the picture is there.
    measured: Option<f64>,
}

/// What `agree.py` says.
#[derive(Deserialize)]
struct Agreement {
    brightness: f64,
    offset: [i32; 2],
}

/// What `photinus compare` says.
#[derive(Deserialize)]
struct Compared {
    relmse: f64,
    relmse_trimmed: f64,
}

/// Everything that engines run in.
pub struct Bench {
    photinus: PathBuf,
    environment: Option<Environment>,
    below: PathBuf,
    quick: bool,
    scenes: BTreeMap<(&'static str, u32), Prepared>,
    /// By lamp; in the place of one that could not be had, why.
    references: BTreeMap<&'static str, Result<Reference, Failure>>,
}

impl Bench {
    /// A bench whose files lie below a folder.
    pub fn new(photinus: PathBuf, environment: Option<Environment>, below: PathBuf, quick: bool) -> Self {
        Self { photinus, environment, below, quick, scenes: BTreeMap::new(), references: BTreeMap::new() }
    }

    /// Writes a lamp's scene for everyone and provides its reference; says in a line where that comes from, or why there is
    /// none.
    pub fn prepare(&mut self, lamp: &'static Lamp) -> Result<String, Failure> {
        for size in [SIZE, TRIAL_SIZE] {
            self.scenes.insert((lamp.name, size), prepare(&self.photinus, lamp, size, &self.below)?);
        }
        let scene = &self.scenes[&(lamp.name, SIZE)];
        let reference = references::provide(lamp, scene, &self.photinus, self.environment.as_ref(), self.quick);
        let words = reference.as_ref().map_or_else(|why| format!("none: {why}"), |made| made.source.clone());
        let note = format!("reference of {}: {words}", lamp.name);
        self.references.insert(lamp.name, reference);
        Ok(note)
    }

    /// The peers' packages with their versions.
    pub fn pins(&self) -> String {
        let Some(environment) = &self.environment else { return "none".into() };
        let packages = ENGINES.iter().map(|engine| engine.package).chain([DENOISER]);
        let mut names: Vec<&str> =
            packages.filter_map(|p| if let Package::Python(name) = p { Some(name) } else { None }).collect();
        names.dedup();
        let pinned = names.iter().map(|name| format!("{name} {}", environment.pinned(name).unwrap_or_default()));
        pinned.collect::<Vec<_>>().join(", ")
    }

    fn reference(&self, lamp: &Lamp) -> Result<&Reference, Failure> {
        self.references[lamp.name].as_ref().map_err(|why| format!("no reference: {why}"))
    }

    /// Whether a package is there, installed if need be.
    pub fn provide(&self, package: Package) -> Result<(), Failure> {
        match (&self.environment, package) {
            (_, Package::Ours) => Ok(()),
            (_, Package::Unfit(why)) => Err(why.to_owned()),
            (Some(environment), package) => environment.provide(package),
            (None, _) => Err("not installed: no environment for the peers".into()),
        }
    }

    /// Renders the lamps of an engine's settings small, and compares brightness and place with the reference. An error
    /// says how it disagrees.
    pub fn agrees(&self, engine: &Engine, settings: &[Setting]) -> Result<Option<String>, Failure> {
        let Some(environment) = &self.environment else { return Ok(None) };
        let wanted =
            |lamp: &&Lamp| settings.iter().any(|s| s.lamp.name == lamp.name && engine.left_out_of(s.seconds).is_none());
        let mut notes = Vec::new();
        for lamp in LAMPS.iter().filter(wanted).filter(|lamp| self.reference(lamp).is_ok()) {
            eprintln!("agreement of {} on {}", engine.name, lamp.name);
            let folder = self.folder("trials", lamp.name, engine.name)?;
            let picture = folder.join("small.exr");
            self.render(engine, lamp, TRIAL_SIZE, engine.trial_seconds, 0, &picture, &folder)?;
            let reference = self.reference(lamp)?;
            let mut words = environment.driver("agree.py");
            for (name, path) in
                [("picture", &picture), ("reference", &reference.picture), ("counted", &reference.counted)]
            {
                words.extend([format!("--{name}"), path.display().to_string()]);
            }
            let outcome = timed::run(&words, &environment.variables(), &folder, 120)?;
            let agreement: Agreement = last_line(&outcome.stdout)?;
            let off = 100.0 * (agreement.brightness - 1.0);
            let [right, down] = agreement.offset;
            let whole = (off.abs() <= 100.0 * TOLERANCE) && agreement.offset == [0, 0];
            let words = format!("{}: {off:+.1} % bright, {right:+} right, {down:+} down", lamp.name);
            if !whole {
                return Err(format!("not timed, for its small picture disagrees with the reference ({words})"));
            }
            notes.push(words);
        }
        Ok((!notes.is_empty()).then(|| format!("agreement of {}: {}", engine.name, notes.join("; "))))
    }

    /// Renders, denoises and judges.
    pub fn measure(
        &self,
        engine: &Engine,
        setting: &Setting,
        repeat: usize,
        denoise: bool,
    ) -> Result<Outcome, Failure> {
        self.reference(setting.lamp)?;
        let folder = self.folder("pictures", &setting.name(), engine.name)?;
        let picture = folder.join(format!("{repeat}.exr"));
        let (work, cpu_seconds) =
            self.render(engine, setting.lamp, SIZE, setting.seconds, repeat, &picture, &folder)?;
        let plain = Judged { errors: self.errors(setting.lamp, &picture, &folder)?, cpu_seconds };
        let mut denoised = None;
        if denoise && let Some(environment) = &self.environment {
            let clean = folder.join(format!("{repeat}-denoised.exr"));
            let mut words = environment.driver("denoise.py");
            for (name, path) in [("--picture", &picture), ("--out", &clean)] {
                words.extend([name.to_owned(), path.display().to_string()]);
            }
            let outcome = timed::run(&words, &environment.variables(), &folder, 300)?;
            let errors = self.errors(setting.lamp, &clean, &folder)?;
            denoised = Some(Judged { errors, cpu_seconds: cpu_seconds + outcome.cpu_seconds });
        }
        Ok(Outcome { plain, denoised, work })
    }

    /// Renders a picture; says what was done in the time, and the processor seconds that it took.
    fn render(
        &self,
        engine: &Engine,
        lamp: &Lamp,
        size: u32,
        seconds: u32,
        repeat: usize,
        picture: &Path,
        folder: &Path,
    ) -> Result<(String, f64), Failure> {
        std::fs::remove_file(picture).ok();
        // Generous, for machines that other work shares: what hangs is ended all the same.
        let limit = 300 + 20 * seconds;
        let (words, variables) = match &self.environment {
            _ if engine.package == Package::Ours => (self.our_words(lamp, size, seconds, repeat, picture), Vec::new()),
            None => return Err("no environment for the peers".into()),
            Some(environment) => {
                let scene = &self.scenes[&(lamp.name, size)].folder;
                let mut words = environment.driver(engine.driver);
                for (name, value) in [
                    ("--scene", scene.display().to_string()),
                    ("--variant", engine.variant.to_owned()),
                    ("--budget", seconds.to_string()),
                    ("--seed", repeat.to_string()),
                    ("--out", picture.display().to_string()),
                ] {
                    words.extend([name.to_owned(), value]);
                }
                if engine.calibrated {
                    let costs = scene.join(format!("{}-{seconds}s.costs.json", engine.name));
                    words.extend(["--costs".to_owned(), costs.display().to_string()]);
                    if repeat == 0 {
                        let calibrating = [words.clone(), vec!["--calibrate".to_owned()]].concat();
                        timed::run(&calibrating, &environment.variables(), folder, limit)?;
                    }
                }
                (words, environment.variables())
            }
        };
        let outcome = timed::run(&words, &variables, folder, limit)?;
        if !picture.is_file() {
            return Err("ended well and left no picture".into());
        }
        if engine.package == Package::Ours {
            return Ok((our_work(&outcome.stdout), outcome.cpu_seconds));
        }
        let said: Said = last_line(&outcome.stdout)?;
        Ok((said.work, said.measured.unwrap_or(outcome.cpu_seconds)))
    }

    /// Our program with a budget, one thread and no option that tunes it; repeats differ by their seed.
    fn our_words(&self, lamp: &Lamp, size: u32, seconds: u32, repeat: usize, picture: &Path) -> Vec<String> {
        let (size, seconds) = (format!("{size}x{size}"), seconds.to_string());
        let mut words = vec![self.photinus.display().to_string()];
        words.extend(
            ["render", lamp.scene, "--size", &size, "--threads", "1", "--cpu-time", &seconds].map(str::to_owned),
        );
        if repeat > 0 {
            words.extend(["--seed".to_owned(), repeat.to_string()]);
        }
        words.extend(["--json".to_owned(), "-o".to_owned(), picture.display().to_string()]);
        words
    }

    /// The two errors of a picture of full size.
    fn errors(&self, lamp: &Lamp, picture: &Path, folder: &Path) -> Result<[f64; 2], Failure> {
        let reference = self.reference(lamp)?;
        let compare = |mask: &Path| -> Result<Compared, Failure> {
            let mut words: Vec<String> = vec![self.photinus.display().to_string(), "compare".into(), "--json".into()];
            words.extend([picture, &reference.picture].map(|path| path.display().to_string()));
            words.extend(["--mask".to_owned(), mask.display().to_string()]);
            let outcome = timed::run(&words, &[], folder, 120)?;
            serde_json::from_str(&outcome.stdout)
                .map_err(|e| format!("`photinus compare` said what no one can read: {e}"))
        };
        Ok([compare(&reference.counted)?.relmse_trimmed, compare(&reference.caustic)?.relmse])
    }

    fn folder(&self, kind: &str, set: &str, engine: &str) -> Result<PathBuf, Failure> {
        let folder = self.below.join(kind).join(set).join(engine);
        std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        Ok(folder)
    }
}

/// The last line of a driver's output, which is JSON.
fn last_line<T: for<'a> Deserialize<'a>>(stdout: &str) -> Result<T, Failure> {
    let line = stdout.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
    serde_json::from_str(line).map_err(|e| format!("a driver said `{line}`: {e}"))
}

/// The number of passes in what our program says.
fn our_work(stdout: &str) -> String {
    let document: serde_json::Value = serde_json::from_str(stdout).unwrap_or_default();
    document["passes"].as_u64().map_or_else(String::new, |passes| format!("{passes} passes"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_driver_may_talk_before_its_last_line() {
        let said: Said = last_line("warming up\n{\"work\": \"4 samples\", \"version\": \"1\"}\n\n").unwrap();
        assert_eq!((said.work.as_str(), said.measured), ("4 samples", None));
        assert!(last_line::<Said>("").is_err() && last_line::<Said>("done\n").is_err());
    }

    #[test]
    fn our_program_says_how_many_passes_it_made() {
        assert_eq!(our_work("{\"passes\": 12}"), "12 passes");
        assert_eq!(our_work("nothing"), "");
    }

    #[test]
    fn without_an_environment_peers_are_missing_and_ours_is_not() {
        let bench = Bench::new("photinus".into(), None, "nowhere".into(), true);
        assert_eq!(bench.provide(Package::Ours), Ok(()));
        assert!(bench.provide(Package::Python("mitsuba")).unwrap_err().starts_with("not installed"));
        assert_eq!(bench.provide(Package::Unfit("no scale")), Err("no scale".to_owned()));
        assert_eq!(bench.pins(), "none");
    }
}
