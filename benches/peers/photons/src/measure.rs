//! Times all engines over the photons of one scene in turn, set by set.

use crate::agree::Truth;
use crate::data::Data;
use crate::engines::{self, Answer, Cloud, ENGINES, Engine};
use crate::sets::{self, Question, Set};
use crate::{Arguments, Row, clock};
use photinus_photons::{BuildOptions, DEFAULT_SEARCH, Gathered, Kernel, Search};
use rayon::ThreadPool;

/// Most seconds that an engine takes for a set once it has been measured twice.
const PATIENCE: f64 = 2.5;
/// From so many photons on structures are built once.
const MANY: usize = 4_000_000;
/// Photons and queries of the search that tests all.
const BLOCKED: (usize, usize) = (65_536, 8192);

/// An engine with what is known of it.
struct Runner {
    name: &'static str,
    engine: Box<dyn Engine>,
}

/// All rows of a scene at one number of photons.
pub fn photons(data: &Data, count: usize, arguments: &Arguments, pools: &[(usize, ThreadPool)], rows: &mut Vec<Row>) {
    let Some((_, all_threads)) = pools.last() else { return };
    let row = |set: &str, engine: &str, unit, threads: usize, values: Vec<f64>, note: String| Row {
        scene: data.name.clone(),
        photons: count,
        set: set.to_owned(),
        engine: engine.to_owned(),
        threads,
        unit,
        values,
        note,
    };
    let photons = &data.photons[..count];
    let truth = all_threads.install(|| -> Result<_, String> {
        let build = |radius_hint| {
            photinus_photons::build(DEFAULT_SEARCH, photons.to_vec(), &BuildOptions { radius_hint })
                .map_err(|error| error.to_string())
        };
        let radius = sets::radius(&*build(0.0)?, data)?;
        Ok((radius, build(radius)?))
    });
    let (radius, search) = match truth {
        Ok(truth) => truth,
        Err(why) => return rows.push(row("all", "all", "ns_per_search", 1, Vec::new(), why)),
    };
    eprintln!("{}, {count} photons: radius {radius:.4}", data.name);
    let cloud = Cloud::new(photons, radius);
    let sets = sets::all(data, radius);

    let mut runners = Vec::new();
    for (name, open) in ENGINES {
        if !arguments.only.is_empty() && !arguments.only.iter().any(|only| only == name) {
            continue;
        }
        match open(arguments) {
            Ok(engine) => runners.push(Runner { name, engine }),
            Err(why) => rows.push(row("all", name, "ns_per_search", 1, Vec::new(), why)),
        }
    }
    for (threads, unit, name, values, note) in builds(&mut runners, &cloud, arguments.repeats, pools) {
        rows.push(row("build", name, unit, threads, values, note));
    }
    for set in &sets {
        if !arguments.sets.is_empty() && !arguments.sets.iter().any(|name| name == set.name) {
            continue;
        }
        let agreed = all_threads.install(|| agreements(&mut runners, &*search, set));
        for (threads, pool) in pools {
            let values = pool.install(|| times(&mut runners, &agreed, set, *threads, arguments.repeats));
            for ((runner, agreed), values) in runners.iter().zip(&agreed).zip(values) {
                if !runner.engine.is_for(set.question) {
                    continue;
                }
                let note = match agreed {
                    Ok(said) => {
                        let work = runner.engine.work(set).map_or_else(String::new, |work| format!("; {work}"));
                        format!("{}; {said}{work}", runner.engine.about(set))
                    }
                    Err(why) => why.clone(),
                };
                rows.push(row(set.name, runner.name, "ns_per_search", *threads, values, note));
            }
        }
    }
    if count == BLOCKED.0 && (arguments.sets.is_empty() || arguments.sets.iter().any(|name| name == "brute")) {
        for (threads, pool) in pools {
            let tested = pool.install(|| blocked(&cloud, &sets, &*search, *threads, arguments.repeats));
            let (values, note) = tested.unwrap_or_else(|why| (Vec::new(), why));
            rows.push(row("brute", "photinus", "g_tests_per_s", *threads, values, note));
        }
    }
}

/// Nanoseconds a photon of every engine's builds, one after the other, on each number of threads.
fn builds(
    runners: &mut Vec<Runner>,
    cloud: &Cloud,
    repeats: usize,
    pools: &[(usize, ThreadPool)],
) -> Vec<(usize, &'static str, &'static str, Vec<f64>, String)> {
    const UNIT: &str = "ns_per_photon";
    let repeats = if cloud.photons.len() >= MANY { 1 } else { repeats.min(3) };
    let scale = 1e9 / cloud.photons.len() as f64;
    let mut out = Vec::new();
    let mut alone: Vec<Vec<f64>> = vec![Vec::new(); runners.len()];
    let mut failed: Vec<Option<String>> = vec![None; runners.len()];
    for (i, (threads, pool)) in pools.iter().enumerate() {
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); runners.len()];
        for _ in 0..repeats {
            for (which, runner) in runners.iter_mut().enumerate() {
                if failed[which].is_some() || (i > 0 && !runner.engine.builds_in_parallel()) {
                    continue;
                }
                match pool.install(|| runner.engine.build(cloud, *threads)) {
                    Ok(seconds) => values[which].push(seconds * scale),
                    Err(why) => failed[which] = Some(why),
                }
            }
        }
        if i == 0 {
            alone.clone_from(&values);
        }
        for (which, runner) in runners.iter().enumerate() {
            // Lists are made by the same search.
            if runner.name == "photinus-list" {
                continue;
            }
            let (values, note) = match &failed[which] {
                Some(why) => (Vec::new(), why.clone()),
                None if values[which].is_empty() => (alone[which].clone(), "builds on one thread".to_owned()),
                None => (values[which].clone(), String::new()),
            };
            out.push((*threads, UNIT, runner.name, values, note));
        }
    }
    if let Some((_, pool)) = pools.last() {
        for (runner, failed) in runners.iter_mut().zip(&mut failed) {
            if failed.is_none() {
                *failed = pool.install(|| runner.engine.settle()).err();
            }
        }
    }
    let mut failed = failed.into_iter();
    runners.retain(|_| failed.next().flatten().is_none());
    out
}

/// Whether each engine answers as ours does, and what there is to say.
fn agreements(runners: &mut [Runner], search: &dyn Search, set: &Set) -> Vec<Result<String, String>> {
    let threads = rayon::current_num_threads();
    let truth = Truth::new(search, ours(search, set));
    let check = |runner: &mut Runner| {
        let (_, answers) = runner.engine.ask(set, threads)?;
        truth.check(set, runner.engine.reach(set), &answers)
    };
    runners.iter_mut().map(check).collect()
}

/// Our answers over photons that face the queries.
fn ours(search: &dyn Search, set: &Set) -> Vec<Answer> {
    match set.question {
        Question::Flux => {
            let mut out = vec![Gathered::default(); set.queries.len()];
            search.gather(&set.queries, Kernel::Constant, &mut out);
            let answer =
                |sums: &Gathered| Answer { count: sums.count, flux: Some(sums.flux.to_array()), farthest_sq: 0.0 };
            out.iter().map(answer).collect()
        }
        Question::Nearest => {
            let mut found = Vec::new();
            let answer = |query| {
                search.collect_nearest(query, sets::K, &mut found);
                let mut flux = photinus_geometry::Vec3::ZERO;
                found.iter().for_each(|(photon, _)| flux += photon.flux());
                Answer {
                    count: found.len() as u32,
                    flux: Some(flux.to_array()),
                    farthest_sq: found.iter().fold(0f32, |most, (_, d2)| most.max(*d2)),
                }
            };
            set.queries.iter().map(answer).collect()
        }
    }
}

/// Nanoseconds a search of every engine that agrees, in turn.
fn times(
    runners: &mut [Runner],
    agreed: &[Result<String, String>],
    set: &Set,
    threads: usize,
    repeats: usize,
) -> Vec<Vec<f64>> {
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); runners.len()];
    let mut spent = vec![0.0; runners.len()];
    for _ in 0..repeats {
        for (which, runner) in runners.iter_mut().enumerate() {
            if agreed[which].is_err() || (values[which].len() >= 2 && spent[which] > PATIENCE) {
                continue;
            }
            if let Ok((seconds, _)) = runner.engine.ask(set, threads) {
                spent[which] += seconds;
                values[which].push(seconds * 1e9 / set.queries.len() as f64);
            }
        }
    }
    values
}

/// Thousand millions of inclusion tests a second where every photon is tested for every query.
fn blocked(
    cloud: &Cloud,
    sets: &[Set],
    search: &dyn Search,
    threads: usize,
    repeats: usize,
) -> Result<(Vec<f64>, String), String> {
    let all = engines::build_blocked(cloud)?;
    let flux = sets.iter().find(|set| set.question == Question::Flux).ok_or("there is no set of sums")?;
    let queries = &flux.queries[..flux.queries.len().min(BLOCKED.1)];
    let set = Set { name: "brute", question: Question::Flux, queries: queries.to_vec() };
    let said = Truth::new(search, ours(search, &set)).check(&set, engines::Reach::Facing, &ours(&*all, &set))?;
    let tests = cloud.photons.len() as f64 * queries.len() as f64;
    let mut out = vec![Gathered::default(); queries.len()];
    let time = |_| tests / clock::timed(threads, || all.gather(queries, Kernel::Constant, &mut out)).0 / 1e9;
    Ok(((0..repeats).map(time).collect(), format!("brute-force-blocked; {said}")))
}
