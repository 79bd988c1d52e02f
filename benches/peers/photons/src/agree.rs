//! Whether an engine gives the answers of ours, before it is timed.

use crate::engines::{Answer, Reach};
use crate::sets::{Question, Set};
use photinus_photons::results::Count;
use photinus_photons::{GatherQuery, Region, Search};
use rayon::prelude::*;
use std::cell::OnceCell;

/// Photons, and flux, that may differ, as a part of all: distances at the rim of a search are rounded one way or another.
const ALLOWED: f64 = 1e-4;
/// How much the distance of the farthest of the nearest may be off, as a part of it.
const DISTANCE: f32 = 1e-5;

/// What an engine ought to answer, by our search.
pub struct Truth<'s> {
    search: &'s dyn Search,
    /// Sums over the photons that face the queries.
    facing: Vec<Answer>,
    /// Counts and distances over all photons; made when first asked for.
    all: OnceCell<Vec<Answer>>,
}

impl<'s> Truth<'s> {
    /// With the answers that our engine gave.
    pub fn new(search: &'s dyn Search, facing: Vec<Answer>) -> Self {
        Self { search, facing, all: OnceCell::new() }
    }

    /// What is said about answers that should be alike; an error where too much differs.
    pub fn check(&self, set: &Set, reach: Reach, theirs: &[Answer]) -> Result<String, String> {
        match reach {
            Reach::Facing => compare(set.question, &self.facing, theirs),
            Reach::All => compare(set.question, self.all.get_or_init(|| self.of_all(set)), theirs),
        }
    }

    /// Answers over all photons, whatever their normals, without their flux.
    fn of_all(&self, set: &Set) -> Vec<Answer> {
        let one = |query: &GatherQuery| match set.question {
            Question::Flux => {
                let mut count = Count::default();
                self.search.search(&Region::Sphere { center: query.position, radius: query.radius }, &mut count);
                Answer { count: count.0 as u32, ..Answer::default() }
            }
            Question::Nearest => {
                let mut found = Vec::new();
                self.search.nearest(query.position, crate::sets::K as usize, query.radius, &mut found);
                let farthest_sq = found.last().map_or(0.0, |last| last.distance_sq);
                Answer { count: found.len() as u32, farthest_sq, ..Answer::default() }
            }
        };
        set.queries.par_iter().map(one).collect()
    }
}

fn compare(question: Question, ours: &[Answer], theirs: &[Answer]) -> Result<String, String> {
    if ours.len() != theirs.len() {
        return Err(format!("gave {} answers to {} queries", theirs.len(), ours.len()));
    }
    let pairs = || ours.iter().zip(theirs);
    let share = |differing: f64, all: f64| if all > 0.0 { differing / all } else { differing };
    let counted = |answers: &[Answer]| answers.iter().map(|answer| f64::from(answer.count)).sum::<f64>();
    let count = share(pairs().map(|(a, b)| f64::from(a.count.abs_diff(b.count))).sum(), counted(ours));
    let channels = |answer: &Answer| answer.flux.unwrap_or_default();
    let has_flux = theirs.iter().all(|answer| answer.flux.is_some()) && ours.iter().all(|answer| answer.flux.is_some());
    let apart = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>();
    let flux = match has_flux {
        true => share(
            pairs().map(|(a, b)| apart(channels(a), channels(b))).sum(),
            ours.iter().map(|a| apart(channels(a), [0.0; 3])).sum(),
        ),
        false => 0.0,
    };
    let is_off = |(a, b): &(&Answer, &Answer)| {
        let (a, b) = (a.farthest_sq.sqrt(), b.farthest_sq.sqrt());
        let is_near = (a - b).abs() <= DISTANCE * a;
        !is_near
    };
    let distances = match question {
        Question::Nearest => share(pairs().filter(is_off).count() as f64, ours.len() as f64),
        Question::Flux => 0.0,
    };
    let mut said = format!("{count:.0e} of the photons differ");
    if has_flux {
        said += &format!(", {flux:.0e} of the flux");
    }
    if question == Question::Nearest {
        said += &format!(", {distances:.0e} of the farthest distances");
    }
    if [count, flux, distances].iter().all(|share| *share <= ALLOWED) {
        Ok(said)
    } else {
        Err(format!("does not agree: {said}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_seen() {
        let answer = |count, flux, farthest_sq| Answer { count, flux: Some([flux, 0.0, 1.0]), farthest_sq };
        let ours = [answer(86, 1.0, 4.0), answer(50, 2.0, 9.0)];
        assert!(compare(Question::Nearest, &ours, &ours).is_ok());
        assert!(compare(Question::Flux, &ours, &[answer(86, 1.0, 4.0), answer(51, 2.0, 9.0)]).is_err());
        assert!(compare(Question::Flux, &ours, &[answer(86, 1.0, 4.0), answer(50, 2.001, 9.0)]).is_err());
        let far = [answer(86, 1.0, 4.0), answer(50, 2.0, 9.001)];
        assert!(compare(Question::Nearest, &ours, &far).is_err());
        assert!(compare(Question::Flux, &ours, &far).is_ok());
        assert!(compare(Question::Flux, &ours, &ours[..1]).is_err());
        let unknown = [Answer { flux: None, ..ours[0] }, Answer { flux: None, ..ours[1] }];
        assert!(compare(Question::Flux, &ours, &unknown).is_ok());
        let lost = [answer(86, f32::NAN, 4.0), ours[1]];
        assert!(compare(Question::Flux, &ours, &lost).is_err());
    }
}
