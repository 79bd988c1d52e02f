//! kiddo: an immutable kd-tree in Rust. Its visitor sums flux without a list; the nearest it lists.

use super::{Answer, Cloud, Engine, Load, Reach};
use crate::Arguments;
use crate::clock::timed;
use crate::sets::{K, Question, Set};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use photinus_geometry::Vec3;
use rayon::prelude::*;
use std::num::NonZero;

/// Queries that a thread takes at a time.
const SHARE: usize = 4096;

type Tree = ImmutableKdTree<f32, 3>;

#[derive(Default)]
struct Kiddo {
    tree: Option<Tree>,
    positions: Vec<[f32; 3]>,
    loads: Vec<Load>,
}

/// The engine.
pub fn open(_: &Arguments) -> Result<Box<dyn Engine>, String> {
    Ok(Box::new(Kiddo::default()))
}

impl Kiddo {
    fn grow(&mut self, threads: usize) -> Result<f64, String> {
        self.tree = None;
        let positions = &self.positions;
        let (seconds, tree) = timed(threads, || match threads {
            1 => Tree::new_from_slice(positions),
            _ => Tree::new_from_slice_parallel(positions),
        });
        self.tree = Some(tree.map_err(|error| format!("{error:?}"))?);
        Ok(seconds)
    }
}

impl Engine for Kiddo {
    fn build(&mut self, cloud: &Cloud, threads: usize) -> Result<f64, String> {
        self.positions.clone_from(&cloud.positions);
        self.loads.clone_from(&cloud.loads);
        self.grow(threads)
    }

    fn builds_in_parallel(&self) -> bool {
        true
    }

    /// Puts the photons into the order of the leaves and builds again, so that searches read memory in order.
    fn settle(&mut self) -> Result<(), String> {
        let tree = self.tree.as_ref().ok_or("nothing was built")?;
        let mut order = Vec::with_capacity(self.positions.len());
        tree.query(&[0.0; 3])
            .within::<SquaredEuclidean<f32>>(f32::INFINITY)
            .unsorted()
            .visit(|found| order.push(found.item as usize));
        if order.len() != self.positions.len() {
            return Err(format!("{} of {} photons lie in its tree", order.len(), self.positions.len()));
        }
        self.positions = order.iter().map(|i| self.positions[*i]).collect();
        self.loads = order.iter().map(|i| self.loads[*i]).collect();
        self.grow(rayon::current_num_threads()).map(|_| ())
    }

    fn ask(&mut self, set: &Set, threads: usize) -> Result<(f64, Vec<Answer>), String> {
        let tree = self.tree.as_ref().ok_or("nothing was built")?;
        let loads = self.loads.as_slice();
        let k = NonZero::new(K as usize).ok_or("none are the nearest")?;
        let mut out = vec![Answer::default(); set.queries.len()];
        let parts = set.queries.par_chunks(SHARE).zip(out.par_chunks_mut(SHARE));
        let (seconds, ()) = timed(threads, || {
            parts.for_each(|(queries, out)| {
                for (query, out) in queries.iter().zip(out) {
                    let (position, limit) = (query.position.to_array(), query.radius * query.radius);
                    *out = match set.question {
                        Question::Flux => {
                            let (mut count, mut flux) = (0, Vec3::ZERO);
                            tree.query(&position).within::<SquaredEuclidean<f32>>(limit).unsorted().visit(|found| {
                                let load = &loads[found.item as usize];
                                if load.faces(query) {
                                    count += 1;
                                    flux += Vec3::from(load.flux);
                                }
                            });
                            Answer { count, flux: Some(flux.to_array()), farthest_sq: 0.0 }
                        }
                        Question::Nearest => {
                            let found =
                                tree.query(&position).nearest_n::<SquaredEuclidean<f32>>(k).within(limit).execute();
                            let farthest_sq = found.last().map_or(0.0, |last| last.distance);
                            Answer { count: found.len() as u32, flux: None, farthest_sq }
                        }
                    };
                }
            });
        });
        Ok((seconds, out))
    }

    fn reach(&self, set: &Set) -> Reach {
        match set.question {
            Question::Flux => Reach::Facing,
            Question::Nearest => Reach::All,
        }
    }

    fn about(&self, set: &Set) -> &'static str {
        match set.question {
            Question::Flux => "flux, facing normals",
            Question::Nearest => "list, all normals",
        }
    }
}
