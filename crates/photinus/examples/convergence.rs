//! Error against the number of passes, as CSV:
//! `cargo run --release -p photinus --example convergence SCENE WIDTHxHEIGHT path|progressive PASSES SEEDS`; with other
//! arguments a small one.
//!
//! Two references of PASSES passes each are made with seeds of their own: in the mode `path`, or in the mode `progressive`
//! with a quarter of the smaller first radius and four times the photons, for light that a path tracer does not find.
//! Their errors are independent, so that the product of both differences has the squared error as its expectation.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example talks to its reader")]

use photinus::image::{Image, Layers};
use photinus::render::{
    Aov, Mode, Observer, PassState, Picture, Plan, RenderOptions, Session, Settings, Silent, Stop, Watcher,
};
use photinus::{LoadOptions, Scene};
use std::error::Error;
use std::sync::{Mutex, PoisonError};

/// Passes of a measured render; its picture is looked at after each power of two.
const PASSES: u32 = 64;

/// Shortens the first radius of a reference.
const REFERENCE_RADIUS: f32 = 0.25;

/// Photons of a reference's pass over those of a measured one.
const REFERENCE_PHOTONS: u32 = 4;

/// Keeps pictures after 1, 2, 4, ... passes, and what was planned.
#[derive(Default)]
struct Album {
    pages: Mutex<Vec<Page>>,
    plan: Mutex<Option<(u32, f32)>>,
}

/// A picture, and the part of its light that photons found.
struct Page {
    passes: u32,
    parts: [Image; 2],
    /// Whether each pixel is away from edges.
    away: Vec<bool>,
}

/// All light; the light that photons found; the same where no edge is near.
const PARTS: [(&str, usize, bool); 3] =
    [("all", 0, false), ("photons", 1, false), ("photons-away-from-edges", 1, true)];

/// A pixel is away from edges where so many pixels around it show the same object and turn by little.
const AWAY_PIXELS: usize = 4;

impl Page {
    fn new(passes: u32, picture: &Picture) -> Self {
        let layer = |aov: Aov| picture.layers.image(aov.name()).unwrap_or_default();
        let (mut photons, caustic) = (layer(Aov::Indirect), layer(Aov::Caustic));
        for (sum, more) in photons.pixels.iter_mut().zip(&caustic.pixels) {
            for c in 0..3 {
                sum[c] += more[c];
            }
        }
        let away = away_from_edges(&picture.layers);
        Self { passes, parts: [picture.image(), photons], away }
    }
}

/// Pixels around which only one object is seen, whose normal turns by less than 25 degrees.
fn away_from_edges(layers: &Layers) -> Vec<bool> {
    let (width, height) = (layers.width, layers.height);
    let channels = |aov: Aov| layers.layer(aov.name()).map_or(&[][..], |layer| &layer.channels);
    let (objects, normals) = (channels(Aov::ObjectId), channels(Aov::Normal));
    let similar = |i: usize, j: usize| {
        let cosine: f32 = normals.iter().map(|axis| axis.samples[i] * axis.samples[j]).sum();
        objects.iter().all(|id| (id.samples[i] - id.samples[j]).abs() < 1e-3) && cosine > 0.9
    };
    let around = |x: usize, end: usize| x.saturating_sub(AWAY_PIXELS)..(x + AWAY_PIXELS + 1).min(end);
    let away = |i: usize| {
        let (x, y) = (i % width, i / width);
        around(y, height).all(|row| around(x, width).all(|column| similar(i, row * width + column)))
    };
    (0..width * height).map(away).collect()
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Observer for Album {}

impl Watcher for Album {
    fn planned(&self, plan: &Plan) {
        *lock(&self.plan) = plan.first_radii.map(|[global, caustic]| (plan.photons, global.min(caustic)));
    }

    fn pass_done(&self, state: &PassState<'_>) {
        if state.passes.is_power_of_two() {
            lock(&self.pages).push(Page::new(state.passes, &state.picture()));
        }
    }
}

/// What is measured, and how.
struct Study {
    scene: Scene,
    size: [u32; 2],
    reference_mode: Mode,
    reference_passes: u32,
    seeds: u64,
}

impl Study {
    fn session(&self, mut settings: Settings, passes: u32) -> photinus::Result<Session> {
        settings.aovs = vec![Aov::Indirect, Aov::Caustic, Aov::ObjectId, Aov::Normal];
        let stop = Stop { passes: Some(passes), ..Stop::default() };
        let options = RenderOptions { settings, size: Some(self.size), stop, ..RenderOptions::default() };
        Session::new(self.scene.clone(), options)
    }

    fn reference(&self, seed: u64, plan: Option<(u32, f32)>) -> photinus::Result<Page> {
        let mut settings = Settings { mode: self.reference_mode, seed, ..Settings::default() };
        if let (Mode::Progressive, Some((photons, radius))) = (self.reference_mode, plan) {
            settings.photons = Some(photons.saturating_mul(REFERENCE_PHOTONS));
            settings.radius = Some(radius * REFERENCE_RADIUS);
        }
        let rendered = self.session(settings, self.reference_passes)?.render(&Silent)?;
        Ok(rendered.picture.map(|picture| Page::new(self.reference_passes, &picture)).expect("a finished pass"))
    }

    fn album(&self, mode: Mode, seed: u64) -> photinus::Result<Album> {
        let album = Album::default();
        self.session(Settings { mode, seed, ..Settings::default() }, PASSES)?.render(&album)?;
        Ok(album)
    }

    fn run(&self, name: &str) -> photinus::Result<()> {
        let first = self.album(Mode::Progressive, 1)?;
        let plan = *lock(&first.plan);
        let references = [self.reference(1001, plan)?, self.reference(1002, plan)?];
        let [width, height] = self.size;
        let (kind, passes) = (self.reference_mode.name(), self.reference_passes);
        let print = |mode: Mode, seed: u64, album: &Album| {
            for page in lock(&album.pages).iter() {
                for (what, part, away) in PARTS {
                    let error = relative_error(page, &references, part, away);
                    let (mode, n) = (mode.name(), page.passes);
                    println!("{name},{width},{height},{kind},{passes},{mode},{what},{seed},{n},{error:.6e}");
                }
            }
        };
        print(Mode::Progressive, 1, &first);
        for seed in 2..=self.seeds {
            print(Mode::Progressive, seed, &self.album(Mode::Progressive, seed)?);
        }
        if self.reference_mode == Mode::Path {
            for seed in 1..=self.seeds {
                print(Mode::Path, seed, &self.album(Mode::Path, seed)?);
            }
        }
        Ok(())
    }
}

/// The relative squared error of `compare` in one part of the light, without the references' own noise, over all pixels or
/// those away from edges. Both parts are relative to the whole picture.
fn relative_error(page: &Page, references: &[Page; 2], part: usize, away: bool) -> f64 {
    let [r, s] = references;
    let pixel = |i: usize| {
        let (mut product, mut square) = (0.0, 0.0);
        for c in 0..3 {
            let [a, b, d] = [page, r, s].map(|page| f64::from(page.parts[part].pixels[i][c]));
            product += (a - b) * (a - d);
            let [b, d] = [r, s].map(|page| f64::from(page.parts[0].pixels[i][c]));
            square += (0.5 * (b + d)) * (0.5 * (b + d));
        }
        (product / 3.0) / (square / 3.0 + 0.01)
    };
    let pixels: Vec<usize> = (0..r.away.len()).filter(|&i| r.away[i] || !away).collect();
    pixels.iter().map(|&i| pixel(i)).sum::<f64>() / pixels.len() as f64
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if words.len() != 5 {
        eprintln!("usage: convergence SCENE WIDTHxHEIGHT path|progressive PASSES SEEDS; here a small one:");
        words = vec!["spheres", "8x6", "path", "16", "1"];
    }
    let [name, size, reference, passes, seeds] = words[..] else { return Err("five words are five".into()) };
    let (width, height) = size.split_once('x').ok_or("the size is WIDTHxHEIGHT")?;
    let study = Study {
        scene: photinus::open(name, &LoadOptions::default())?,
        size: [width.parse()?, height.parse()?],
        reference_mode: if reference == "path" { Mode::Path } else { Mode::Progressive },
        reference_passes: passes.parse()?,
        seeds: seeds.parse()?,
    };
    Ok(study.run(&study.scene.name)?)
}
