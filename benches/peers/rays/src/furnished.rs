//! Rooms of any size: models of real furniture side by side on the floors of a house, walls between them.

use crate::meshes::Mesh;
use photinus_geometry::{Primitives, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_render::Compiled;
use photinus_scene::LoadOptions;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Seed of places and sizes.
const SEED: u64 = 11;
/// Models on a side of the floor.
const SIDE: usize = 12;
/// Metres that a model takes up.
const PLACE: f32 = 1.0;
/// Metres from floor to ceiling.
const HEIGHT: f32 = 2.8;
/// Models of more triangles would make a room of one thing.
const MOST_TRIANGLES: usize = 40_000;

/// A room of about `count` triangles, its models from the Wavefront files below `folder`, in the order of their names.
pub fn room(count: usize, folder: &Path) -> Result<Mesh, String> {
    let mut files = Vec::new();
    find(folder, &mut files);
    files.sort();
    let size = SIDE as f32 * PLACE;
    let mut out = Primitives::default();
    add_box(&mut out, Vec3::ZERO, Vec3::new(size, HEIGHT, size));
    let mut placed = 0;
    while out.triangles.len() < count {
        let before = placed;
        for file in &files {
            // What cannot be read is no furniture; which models are read does not depend on the run.
            let Ok(scene) = photinus_scene::load(file, &LoadOptions::default()) else { continue };
            let model = Compiled::new(scene);
            let model = model.primitives();
            let left = count - out.triangles.len().min(count);
            if model.triangle_count() == 0 || model.triangle_count() > MOST_TRIANGLES.min(2 * left) {
                continue;
            }
            add(&mut out, model, placed);
            placed += 1;
            if out.triangles.len() >= count {
                break;
            }
        }
        if placed == before {
            break;
        }
    }
    if out.triangles.len() < count / 2 {
        return Err(format!("the models of {} make {} triangles only", folder.display(), out.triangles.len()));
    }
    let camera = [Vec3::new(0.3, 1.7, 0.3), Vec3::new(0.6 * size, 0.6, 0.6 * size), Vec3::Y];
    let lamp = Vec3::new(0.5 * size, HEIGHT - 0.1, 0.5 * size);
    Ok(Mesh { name: "furnished".into(), primitives: Arc::new(out), camera, lamp, lamp_size: 1.0 })
}

fn find(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            find(&path, out);
        } else if path.extension().is_some_and(|extension| extension == "obj") {
            out.push(path);
        }
    }
}

/// Adds a model at a place of its own, a random one in later rounds, turned and scaled to its place.
fn add(out: &mut Primitives, model: &Primitives, number: usize) {
    let bounds = (0..model.triangle_count()).map(|i| model.bounds_of(i)).reduce(|a, b| a.union(b));
    let Some(bounds) = bounds else { return };
    let mut s = Sampler::new(SEED, StreamKind::Test, 0, number as u32);
    let (place, round) = (number % (SIDE * SIDE), number / (SIDE * SIDE));
    let jitter = if round == 0 { 0.1 } else { 1.0 };
    let mut offset = || (s.next_1d() - 0.5) * jitter * PLACE;
    let x = ((place % SIDE) as f32 + 0.5) * PLACE + offset();
    let z = ((place / SIDE) as f32 + 0.5) * PLACE + offset();
    let quarter = (s.next_1d() * 4.0) as u32;
    let size = bounds.max - bounds.min;
    let scale = (0.9 * PLACE / size.x.max(size.z)).min(0.8 * HEIGHT / size.y);
    let middle = (bounds.min + bounds.max) * 0.5;
    // Later rounds stand on what is there: on shelves and tables.
    let floor = if round == 0 { 0.0 } else { 0.5 * s.next_1d() * HEIGHT };
    let first = out.positions.len() as u32;
    for v in &model.positions {
        let p = (*v - Vec3::new(middle.x, bounds.min.y, middle.z)) * scale;
        let (px, pz) = match quarter {
            0 => (p.x, p.z),
            1 => (-p.z, p.x),
            2 => (-p.x, -p.z),
            _ => (p.z, -p.x),
        };
        out.positions.push(Vec3::new(x + px, floor + p.y, z + pz));
    }
    out.triangles.extend(model.triangles.iter().map(|t| t.map(|v| v + first)));
}

fn add_box(out: &mut Primitives, min: Vec3, max: Vec3) {
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 1 { max[axis] } else { min[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    let first = out.positions.len() as u32;
    out.positions.extend((0..8).map(corner));
    for quad in [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] {
        out.triangles.push([quad[0], quad[1], quad[2]].map(|i: u32| i + first));
        out.triangles.push([quad[0], quad[2], quad[3]].map(|i: u32| i + first));
    }
}
