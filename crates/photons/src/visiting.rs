//! Gathering by visiting: for members without a kernel of their own.

use crate::{GatherQuery, Gathered, Kernel, Search};
use photinus_geometry::Vec3;
use rayon::prelude::*;

/// Queries that are worth a task of their own.
const QUERIES_A_TASK: usize = 256;

/// Sums what `search` visits, in f64 in the order of the visits, rounded once.
pub(crate) fn gather_by_visiting(search: &dyn Search, query: &GatherQuery, kernel: Kernel) -> Gathered {
    let mut flux = [0f64; 3];
    let mut count = 0;
    search.visit(query, &mut |photon, d2| {
        let weight = f64::from(kernel.weight(d2, query.radius));
        for (sum, channel) in flux.iter_mut().zip(photon.flux().to_array()) {
            *sum += f64::from(channel) * weight;
        }
        count += 1;
    });
    Gathered { flux: Vec3::from_array(flux.map(|c| c as f32)), count }
}

/// As [`gather_by_visiting`] for a batch, on the threads of the current pool where the batch is large.
pub(crate) fn gather_batch_by_visiting(
    search: &dyn Search,
    queries: &[GatherQuery],
    kernel: Kernel,
    out: &mut [Gathered],
) {
    assert_eq!(queries.len(), out.len(), "one result a query");
    let one = |(query, out): (&GatherQuery, &mut Gathered)| *out = gather_by_visiting(search, query, kernel);
    queries.par_iter().zip(out).with_min_len(QUERIES_A_TASK).for_each(one);
}
