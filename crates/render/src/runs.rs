//! Which shape a primitive belongs to: primitives of a shape follow one another.

/// Table entries a run.
const ENTRIES: usize = 4;

/// Runs of primitives, one a shape, with a table that leads to the right one, or to a few among which it is.
pub(crate) struct Runs {
    /// First primitive of each run, and the shape; sorted, at least one, the first from primitive 0.
    runs: Vec<(u32, u32)>,
    /// The run of every primitive whose number is a multiple of 2^shift, and the last run.
    table: Vec<u32>,
    shift: u32,
}

impl Runs {
    /// Runs by their first primitives with their shapes, in any order, among `count` primitives.
    pub fn new(mut runs: Vec<(u32, u32)>, count: usize) -> Self {
        runs.sort_unstable();
        let mut shift = 0;
        while count >> shift > ENTRIES * runs.len() {
            shift += 1;
        }
        let last = runs.len().saturating_sub(1) as u32;
        let run_of = |prim: u32| runs.partition_point(|&(first, _)| first <= prim).saturating_sub(1) as u32;
        let mut table: Vec<u32> = (0..=(count >> shift) as u32).map(|entry| run_of(entry << shift)).collect();
        table.push(last);
        Self { runs, table, shift }
    }

    /// The shape of primitive `prim`.
    #[inline]
    pub fn shape_of(&self, prim: u32) -> usize {
        let entry = (prim >> self.shift) as usize;
        let (first, last) = (self.table[entry] as usize, self.table[entry + 1] as usize);
        let run = if first == last {
            first
        } else {
            first + self.runs[first + 1..=last].partition_point(|&(start, _)| start <= prim)
        };
        self.runs[run].1 as usize
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.runs.len() * 8 + self.table.len() * 4
    }
}

#[cfg(test)]
mod tests {
    use super::Runs;
    use photinus_num::{Sampler, StreamKind};

    /// Against a plain list, for shapes of very different sizes.
    #[test]
    fn every_primitive_is_in_its_run() {
        for case in 0..200 {
            let mut s = Sampler::new(1, StreamKind::Test, 17, case);
            let shapes = 1 + (s.next_1d() * 40.0) as u32;
            let (mut runs, mut owners) = (Vec::new(), Vec::new());
            for k in 0..shapes {
                let size = 1 + (s.next_1d().powi(8) * 5000.0) as usize;
                let shape = (k * 7 + 3) % 41;
                runs.push((owners.len() as u32, shape));
                owners.extend(std::iter::repeat_n(shape as usize, size));
            }
            runs.reverse();
            let runs = Runs::new(runs, owners.len());
            for (prim, &shape) in owners.iter().enumerate() {
                assert_eq!(runs.shape_of(prim as u32), shape, "case {case}, primitive {prim} of {}", owners.len());
            }
        }
    }

    #[test]
    fn nothing_is_no_run() {
        assert_eq!(Runs::new(Vec::new(), 0).bytes(), 8);
    }
}
