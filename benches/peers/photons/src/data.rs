//! Photons of a scene as a direct render stores them, and the places that its picture asks about.

use photinus_accel::{BuildOptions, DEFAULT_STRUCTURE};
use photinus_geometry::Vec3;
use photinus_photons::Photon;
use photinus_profile::queries::{Block, BlockKey, QuerySink, RayKind, Stage};
use photinus_render::bsdf::SurfaceModel;
use photinus_render::{Compiled, Mode, Observer, Phase, Renderer, Settings, Silent, World};
use photinus_scene::{LoadOptions, Scene, builtin};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Photons sent out to see how many of them are stored.
const TRIAL: u32 = 100_000;
/// More photons are sent out than the trial calls for, as a part of them.
const MARGIN: f64 = 1.03;

/// What is searched, and where.
pub struct Data {
    /// The scene.
    pub name: String,
    /// Photons in the order of their emission: any first part of them is a sample as good as any other.
    pub photons: Vec<Photon>,
    /// First hits of the camera's rays with their normals, in the order in which the renderer asks: tile by tile.
    pub places: Vec<(Vec3, Vec3)>,
}

/// `count` photons and about `pixels` places of a built-in scene by its name, or of `NAME=FILE`.
pub fn load(word: &str, count: usize, pixels: usize) -> Result<Data, String> {
    let (name, mut scene) = match word.split_once('=') {
        Some((name, file)) => {
            let scene = photinus_scene::load(Path::new(file), &LoadOptions::default());
            (name, scene.map_err(|error| error.to_string())?)
        }
        None => (word, builtin::build(word).ok_or_else(|| format!("there is no built-in scene {word}"))?),
    };
    resize(&mut scene, pixels);
    let compiled = Compiled::new(scene);
    let structure = photinus_accel::build(DEFAULT_STRUCTURE, compiled.primitives().clone(), &BuildOptions::default());
    let structure = structure.map_err(|error| error.to_string())?;
    let mut world = compiled.with_structure(structure, SurfaceModel::default());
    let trial = render(&mut world, TRIAL, true)?;
    if trial.photons.is_empty() || trial.places.is_empty() {
        return Err(format!(
            "{name}: a render stores {} photons and sees {} places",
            trial.photons.len(),
            trial.places.len()
        ));
    }
    let stored = trial.photons.len() as f64 / f64::from(TRIAL);
    let emitted = (count as f64 / stored * MARGIN) as u32 + TRIAL;
    let mut photons = render(&mut world, emitted, false)?.photons;
    if photons.len() < count {
        return Err(format!("{name}: of {emitted} photons {} are stored, {count} are wanted", photons.len()));
    }
    photons.truncate(count);
    photons.shrink_to_fit();
    Ok(Data { name: name.to_owned(), photons, places: trial.places })
}

/// Gives the picture about so many pixels.
fn resize(scene: &mut Scene, pixels: usize) {
    let film = &mut scene.film;
    let scale = (pixels as f64 / (f64::from(film.width) * f64::from(film.height))).sqrt();
    let scaled = |edge: u32| (f64::from(edge) * scale).round().max(1.0) as u32;
    (film.width, film.height, film.crop) = (scaled(film.width), scaled(film.height), None);
}

/// What a render stored and asked.
#[derive(Default)]
struct Rendered {
    photons: Vec<Photon>,
    places: Vec<(Vec3, Vec3)>,
}

/// Sends photons out, and looks at the picture where that is wanted.
fn render(world: &mut World, photons: u32, picture: bool) -> Result<Rendered, String> {
    let settings = Settings {
        mode: Mode::Direct,
        photons: Some(photons),
        // An edge to the camera and one to the light: what is seen directly. Photons go farther.
        max_depth: Some(2),
        // What is searched while the photons are recorded does not matter.
        search: if picture { "grid" } else { "brute-force" }.to_owned(),
        profile_every: 0,
        ..Settings::default()
    };
    let record = Arc::new(Record::default());
    world.record_queries(record.clone());
    let mut renderer = Renderer::new(world, settings, &Silent).map_err(|error| error.to_string())?;
    let result = renderer.render_pass(&Stop { picture, over: AtomicBool::new(false) });
    if picture {
        result.map_err(|error| error.to_string())?;
    }
    let mut rendered = Rendered { photons: take(&record.photons), places: Vec::new() };
    take(&record.places).into_values().for_each(|places| rendered.places.extend(places));
    Ok(rendered)
}

fn take<T: Default>(from: &Mutex<T>) -> T {
    std::mem::take(&mut from.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Ends a render before its picture where that is not wanted.
struct Stop {
    picture: bool,
    over: AtomicBool,
}

impl Observer for Stop {
    fn begin(&self, phase: Phase, _: u32) {
        self.over.store(phase == Phase::EyePass && !self.picture, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }
}

/// Keeps the photons of the map, and where camera rays ended.
#[derive(Default)]
struct Record {
    photons: Mutex<Vec<Photon>>,
    places: Mutex<BTreeMap<BlockKey, Vec<(Vec3, Vec3)>>>,
}

impl QuerySink for Record {
    fn record(&self, block: &Block) {
        match block.key.stage {
            Stage::PhotonPass => {}
            Stage::Map => {
                let photons = block.photons.iter().filter_map(|words| Photon::from_words(*words).ok());
                self.photons.lock().unwrap_or_else(PoisonError::into_inner).extend(photons);
            }
            Stage::EyePass => {
                let is_first =
                    |parent: u32| block.rays.get(parent as usize).is_some_and(|ray| ray.kind == RayKind::Camera);
                let searches = block.searches.iter().filter(|search| is_first(search.parent));
                let places = searches.map(|search| (search.position.into(), search.normal.into())).collect();
                self.places.lock().unwrap_or_else(PoisonError::into_inner).insert(block.key, places);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_gives_what_is_asked_for_and_a_first_part_stays_the_same() {
        let few = load("room-1", 5000, 3000).unwrap();
        let many = load("room-1", 200_000, 3000).unwrap();
        assert_eq!((few.photons.len(), many.photons.len()), (5000, 200_000));
        // The flux of a photon depends on how many were sent out, its place does not.
        for (a, b) in few.photons.iter().zip(&many.photons) {
            assert_eq!((a.position(), a.normal(), a.depth()), (b.position(), b.normal(), b.depth()));
        }
        assert!((2500..3600).contains(&few.places.len()), "{}", few.places.len());
        assert!(few.places.iter().all(|(_, normal)| (normal.length() - 1.0).abs() < 1e-4));
        assert!(load("no-such-room", 10, 10).is_err());
    }
}
