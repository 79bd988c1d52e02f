//! Recorded queries: complete, in an order that threads do not change, and with answers that every structure and every
//! search gives again.

use photinus::photons::{BuildOptions as SearchOptions, GatherQuery, Gathered, Kernel, Photon, SEARCHES, Search};
use photinus::profile::queries::{
    Block, BlockKey, MapKind, NO_PARENT, QueryFile, RayAnswer, RayKind, RayRecord, SearchAnswer, SearchKernel, Stage,
};
use photinus::render::{Mode, RenderOptions, Session, Settings, Silent, Stats, Stop};
use photinus_accel::{BuildOptions, RayCounters, STRUCTURES};
use photinus_geometry::{Hit, Ray, Vec3};
use photinus_render::Compiled;
use photinus_scene::{ColorInput, FloatInput, Geometry, Material, MaterialId, MicrofacetModel, NamedMaterial, Scene};
use std::collections::BTreeMap;
use std::path::Path;

/// Scenes and modes whose queries are of every kind: shadow rays, mirrors and glass, caustic maps, leaves with holes,
/// searches that sum, that visit and that look for the nearest.
const RENDERS: &[(&str, Mode, Option<u32>)] = &[
    ("two-spheres", Mode::Progressive, None),
    ("two-spheres", Mode::Direct, Some(20)),
    ("two-spheres", Mode::Path, None),
    ("holes", Mode::Progressive, None),
    ("holes", Mode::Gather, None),
    ("room-1", Mode::Direct, None),
    ("room-1", Mode::Gather, None),
];

fn options(mode: Mode, knn: Option<u32>, threads: usize, path: &Path) -> RenderOptions {
    RenderOptions {
        settings: Settings { mode, knn, photons: Some(6000), ..Settings::default() },
        size: Some([48, 40]),
        threads: Some(threads),
        record_queries: Some(path.to_path_buf()),
        stop: Stop { passes: Some(2), ..Stop::default() },
        ..RenderOptions::default()
    }
}

/// A built-in scene; `holes`: the two spheres of stuff that half of all light passes, in a box with a plastic sheen.
fn open(name: &str) -> Scene {
    let built_in = if name == "holes" { "two-spheres" } else { name };
    let mut scene = photinus::open(built_in, &photinus::LoadOptions::default()).unwrap();
    if name == "holes" {
        let spheres = scene.shapes.iter_mut().filter(|shape| matches!(shape.geometry, Geometry::Sphere { .. }));
        for sphere in spheres {
            let mask = Material::Mask { opacity: FloatInput::Constant(0.5), nested: sphere.material };
            sphere.material = MaterialId(scene.materials.len() as u32);
            scene.materials.push(NamedMaterial { name: "holes".to_owned(), material: mask });
        }
        for named in &mut scene.materials {
            if let Material::Diffuse { reflectance } = named.material {
                named.material = Material::RoughPlastic {
                    model: MicrofacetModel::Ggx,
                    alpha: FloatInput::Constant(0.2),
                    int_ior: 1.5,
                    ext_ior: 1.0,
                    diffuse_reflectance: reflectance,
                    specular_reflectance: ColorInput::Constant(Vec3::ONE),
                    nonlinear: false,
                };
            }
        }
    }
    scene
}

/// Renders and reads back everything that was recorded.
fn record(scene: &str, mode: Mode, knn: Option<u32>, threads: usize) -> (Stats, QueryFile, Vec<Block>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("queries.bin");
    let session = Session::new(open(scene), options(mode, knn, threads, &path)).unwrap();
    let stats = session.render(&Silent).unwrap().stats;
    let totals = session.finish_recording().unwrap().unwrap();
    assert_eq!(session.finish_recording().unwrap(), None, "ended once");
    assert_eq!(std::fs::metadata(&path).unwrap().len(), totals.bytes);
    let mut file = QueryFile::open(&path).unwrap();
    let blocks = (0..file.block_count()).map(|i| file.read(i).unwrap()).collect();
    (stats, file, blocks)
}

fn ray(record: &RayRecord) -> Ray {
    let [t_min, t_max] = record.interval;
    Ray { origin: record.origin.into(), dir: record.dir.into(), t_min, t_max }
}

#[test]
fn every_structure_gives_the_recorded_hits() {
    for &(scene, mode, knn) in RENDERS {
        let (stats, file, blocks) = record(scene, mode, knn, 2);
        let compiled = Compiled::new(open(scene));
        let primitives = compiled.primitives();
        assert_eq!(file.primitives(), (primitives.triangle_count() as u64, primitives.spheres.len() as u64));
        let rays: Vec<&RayRecord> = blocks.iter().flat_map(|block| &block.rays).collect();
        assert_eq!(rays.len() as u64, stats.rays.total, "{scene}, {mode:?}: every ray is there");
        for info in STRUCTURES {
            let structure = photinus_accel::build(info.name, primitives.clone(), &BuildOptions::default()).unwrap();
            // Where a ray takes many tests, as by brute force over 55 thousand triangles, every so manieth ray will do.
            let first: Vec<Ray> = rays.iter().take(500).map(|record| ray(record)).collect();
            let mut counters = RayCounters::default();
            structure.closest_hit_counted(&first, &mut vec![Hit::MISS; first.len()], &mut counters);
            let tests = counters.intersect.tests as usize / first.len().max(1);
            let step = 1 + rays.len() * tests / 20_000_000;
            let mut replayed = 0;
            for record in rays.iter().step_by(step) {
                replayed += 1;
                match record.answer {
                    RayAnswer::Closest(expected) => {
                        let mut found = [Hit::MISS];
                        structure.closest_hit(&[ray(record)], &mut found);
                        let found = found[0].is_hit().then_some(found[0]);
                        let found = found.map(|h| (h.t.to_bits(), h.alpha.to_bits(), h.beta.to_bits(), h.prim));
                        let expected = expected.map(|h| (h.t.to_bits(), h.alpha.to_bits(), h.beta.to_bits(), h.prim));
                        assert_eq!(found, expected, "{scene}, {mode:?}, {}: {record:?}", info.name);
                    }
                    RayAnswer::Any(expected) => {
                        let mut found = [!expected];
                        structure.any_hit(&[ray(record)], &mut found);
                        assert_eq!(found[0], expected, "{scene}, {mode:?}, {}: {record:?}", info.name);
                    }
                }
            }
            assert!(replayed > 200, "{scene}, {}: {replayed} rays", info.name);
        }
    }
}

#[test]
fn every_search_gives_the_recorded_answers() {
    let mut kinds = [0u64; 3];
    for &(scene, mode, knn) in RENDERS {
        let (stats, _, blocks) = record(scene, mode, knn, 2);
        let mut maps: BTreeMap<(u32, MapKind), &[[u32; 6]]> = BTreeMap::new();
        let mut asked = 0;
        for block in &blocks {
            let kind = if block.key.index == 0 { MapKind::Global } else { MapKind::Caustic };
            if block.key.stage == Stage::Map {
                maps.insert((block.key.pass, kind), &block.photons);
            }
            asked += block.searches.len() as u64;
            for search in &block.searches {
                kinds[match search.answer {
                    SearchAnswer::Sum(_) => 0,
                    SearchAnswer::Visited => 1,
                    SearchAnswer::Nearest { .. } => 2,
                }] += 1;
            }
        }
        assert_eq!(asked, stats.search.searches, "{scene}, {mode:?}: every search is there");
        assert_eq!(
            maps.values().map(|photons| photons.len() as u64).sum::<u64>(),
            stats.photons.stored + stats.caustic_photons.stored
        );
        for (&(pass, kind), words) in &maps {
            let photons: Vec<Photon> = words.iter().map(|words| Photon::from_words(*words).unwrap()).collect();
            for member in SEARCHES.iter().filter(|member| member.is_exact) {
                // The renderer's own in full, the slower ones in part.
                let step = match member.name {
                    "grid" => 1,
                    "brute-force" => 16,
                    _ => 8,
                };
                let search = member.build(photons.clone(), &SearchOptions::default()).unwrap();
                // In the modes with one map the searches of all passes ask that of the first.
                let of_pass = |key: BlockKey| key.pass == pass || mode != Mode::Progressive;
                for block in blocks.iter().filter(|block| of_pass(block.key)) {
                    let searches = block.searches.iter().filter(|search| search.map == kind);
                    for record in searches.step_by(step) {
                        replay(&*search, record, &format!("{scene}, {mode:?}, {}", member.name));
                    }
                }
            }
        }
    }
    assert!(kinds.iter().all(|count| *count > 500), "searches that sum, visit and look for the nearest: {kinds:?}");
}

/// One search of `record` again.
#[track_caller]
fn replay(search: &dyn Search, record: &photinus::profile::queries::SearchRecord, context: &str) {
    let query = GatherQuery {
        position: record.position.into(),
        radius: record.radius,
        normal: record.normal.into(),
        max_depth: record.max_depth,
    };
    let mut nearest = Vec::new();
    match record.answer {
        SearchAnswer::Sum(flux) => {
            let kernel = match record.kernel {
                SearchKernel::Constant => Kernel::Constant,
                SearchKernel::Epanechnikov => Kernel::Epanechnikov,
            };
            let mut found = [Gathered::default()];
            search.gather(&[query], kernel, &mut found);
            assert_eq!(found[0].count, record.found, "{context}: {record:?}");
            let flux = Vec3::from(flux);
            let close = (found[0].flux - flux).abs().cmple(flux.abs() * 1e-5 + 1e-30).all();
            assert!(close, "{context}: {} for {record:?}", found[0].flux);
        }
        SearchAnswer::Visited => {
            let mut found = 0;
            search.visit(&query, &mut |_, _| found += 1);
            assert_eq!(found, record.found, "{context}: {record:?}");
        }
        SearchAnswer::Nearest { k, farthest_sq } => {
            search.collect_nearest(&query, k, &mut nearest);
            let farthest = nearest.iter().fold(0f32, |farthest, (_, d2)| farthest.max(*d2));
            assert_eq!((nearest.len() as u32, farthest), (record.found, farthest_sq), "{context}: {record:?}");
        }
    }
}

#[test]
fn threads_do_not_change_what_is_read() {
    let (_, one, blocks) = record("two-spheres", Mode::Progressive, None, 1);
    let (_, three, same) = record("two-spheres", Mode::Progressive, None, 3);
    assert_eq!(one.scene_hash(), three.scene_hash());
    assert!(blocks == same);
    let (_, other, _) = record("room-1", Mode::Direct, None, 1);
    assert_ne!(one.scene_hash(), other.scene_hash());
}

#[test]
fn rays_start_where_those_that_led_to_them_ended() {
    for &(scene, mode, knn) in RENDERS {
        let (stats, _, blocks) = record(scene, mode, knn, 2);
        // Rays start off surfaces by a millionth of their largest coordinates.
        let scale =
            Compiled::new(open(scene)).primitives().positions.iter().fold(0f32, |m, p| m.max(p.abs().max_element()));
        let near = |a: Vec3, b: Vec3| (a - b).length() <= 1e-4 * (1.0 + a.length()) + 4e-6 * scale;
        let mut kinds = BTreeMap::new();
        for block in &blocks {
            for record in &block.rays {
                let first = record.parent == NO_PARENT;
                *kinds.entry(format!("{:?}", record.kind)).or_insert(0u64) += 1;
                assert!(
                    !first || matches!(record.kind, RayKind::Photon | RayKind::Camera),
                    "{scene}, {mode:?}: {record:?}"
                );
                assert!(record.kind != RayKind::Camera || block.key.stage == Stage::EyePass);
                let Some(parent) = block.rays.get(record.parent as usize) else { continue };
                if record.kind == RayKind::Support {
                    // Somewhere on the disc of an estimate, whose radius is a small part of the scene.
                    let end = end_of(parent).expect("nothing comes of a ray that met nothing");
                    assert!((Vec3::from(record.origin) - end).length() < 0.2 * scale, "{scene}, {mode:?}: {record:?}");
                } else {
                    starts_at_the_end_of(record, parent, near);
                }
            }
            for search in &block.searches {
                let ray = &block.rays[search.parent as usize];
                let end = end_of(ray).expect("the ray met a surface");
                let position = Vec3::from(search.position);
                // The caustic map is asked at more places of a pixel, which here is a fortieth of the view.
                let from_camera = search.map == MapKind::Caustic && ray.kind == RayKind::Camera;
                let within_pixel = (position - end).length() <= 0.12 * (end - Vec3::from(ray.origin)).length();
                assert!(near(position, end) || (from_camera && within_pixel), "{scene}, {mode:?}: {search:?}");
            }
        }
        if scene == "holes" {
            assert!(stats.rays.counts.beyond > 100, "{:?}", stats.rays);
        }
        let count = |kind: &str| kinds.get(kind).copied().unwrap_or(0);
        let counted = stats.rays.counts;
        // Rays behind holes are recorded as what they are for.
        assert!(count("Camera") >= counted.camera && count("Photon") >= counted.photon, "{scene}, {mode:?}");
        assert!(count("Shadow") >= counted.shadow && count("Specular") >= counted.specular, "{scene}, {mode:?}");
        assert_eq!(kinds.values().sum::<u64>(), stats.rays.total, "{scene}, {mode:?}");
    }
}

fn end_of(record: &RayRecord) -> Option<Vec3> {
    match record.answer {
        RayAnswer::Closest(Some(hit)) => Some(Vec3::from(record.origin) + Vec3::from(record.dir) * hit.t),
        _ => None,
    }
}

#[track_caller]
fn starts_at_the_end_of(child: &RayRecord, parent: &RayRecord, near: impl Fn(Vec3, Vec3) -> bool) {
    let end = end_of(parent).expect("nothing comes of a ray that met nothing");
    // A ray that goes on behind a hole keeps its origin and begins later.
    let beyond = child.origin == parent.origin && child.interval[0] > parent.interval[0];
    assert!(beyond || near(child.origin.into(), end), "{child:?}\nfrom {parent:?}");
}

#[test]
fn a_place_that_cannot_be_written_is_known_before_the_render() {
    let options = options(Mode::Path, None, 1, Path::new("/no/such/folder/queries.bin"));
    let refused = Session::new(open("two-spheres"), options).err().unwrap().to_string();
    assert!(refused.contains("/no/such/folder/queries.bin"), "{refused}");
}
