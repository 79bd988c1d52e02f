//! The k nearest so far, in a max-heap by distance and then id (Jensen 2001, section 6.2).

use crate::Neighbor;

/// Keeps the k least of the neighbours offered, by distance, ties by id.
pub(crate) struct NearestHeap<'a> {
    heap: &'a mut Vec<Neighbor>,
    k: usize,
    r2: f32,
}

/// Neighbours exactly as near as the farthest in a full heap.
#[derive(Default)]
pub(crate) struct Ties(Vec<Neighbor>);

impl Ties {
    /// All of them.
    pub(crate) fn all(&self) -> &[Neighbor] {
        &self.0
    }
}

/// Order of answers.
#[inline]
pub(crate) fn closer(a: &Neighbor, b: &Neighbor) -> bool {
    a.distance_sq < b.distance_sq || (a.distance_sq == b.distance_sq && a.photon < b.photon)
}

impl<'a> NearestHeap<'a> {
    /// An empty heap in `found` for at most `k` neighbours with `distance_sq <= r2`.
    #[inline]
    pub(crate) fn new(found: &'a mut Vec<Neighbor>, k: usize, r2: f32) -> Self {
        found.clear();
        Self { heap: found, k, r2: if k == 0 { -1.0 } else { r2 } }
    }

    /// What lies farther than this is of no use.
    #[inline]
    pub(crate) fn limit(&self) -> f32 {
        limit(self.heap, self.k, self.r2)
    }

    /// Offers a neighbour.
    #[inline]
    pub(crate) fn offer(&mut self, neighbor: Neighbor) {
        offer(self.heap, self.k, self.r2, neighbor);
    }

    /// Offers a neighbour; those that are not kept but as near as the farthest kept go to `ties`.
    #[inline]
    pub(crate) fn offer_with_ties(&mut self, neighbor: Neighbor, ties: &mut Ties) {
        if self.heap.len() < self.k || !(neighbor.distance_sq <= self.r2) {
            self.offer(neighbor);
        } else if neighbor.distance_sq < self.limit() {
            let dropped = self.heap[0];
            sift_down(self.heap, neighbor);
            if dropped.distance_sq > self.limit() {
                ties.0.clear();
            } else {
                ties.0.push(dropped);
            }
        } else if neighbor.distance_sq == self.limit() {
            ties.0.push(neighbor);
        }
    }

    /// Puts the neighbours into order of distance.
    #[inline]
    pub(crate) fn finish(self) {
        sort_by_distance(self.heap);
    }
}

/// What lies farther is of no use to a heap of at most `k` neighbours within `r2`.
#[inline]
pub(crate) fn limit(heap: &[Neighbor], k: usize, r2: f32) -> f32 {
    if k == 0 {
        -1.0
    } else if heap.len() < k {
        r2
    } else {
        heap[0].distance_sq
    }
}

/// Offers a neighbour to such a heap.
#[inline]
pub(crate) fn offer(heap: &mut Vec<Neighbor>, k: usize, r2: f32, neighbor: Neighbor) {
    if k == 0 || !(neighbor.distance_sq <= r2) {
        return;
    }
    if heap.len() < k {
        heap.push(neighbor);
        sift_up(heap);
    } else if closer(&neighbor, &heap[0]) {
        sift_down(heap, neighbor);
    }
}

/// Puts the last item of a heap where it belongs.
fn sift_up(heap: &mut [Neighbor]) {
    let mut i = heap.len() - 1;
    let item = heap[i];
    while i > 0 {
        let parent = (i - 1) / 2;
        if !closer(&heap[parent], &item) {
            break;
        }
        heap[i] = heap[parent];
        i = parent;
    }
    heap[i] = item;
}

/// Replaces the root of a max-heap by `item`.
#[inline]
fn sift_down(heap: &mut [Neighbor], item: Neighbor) {
    let mut i = 0;
    loop {
        let mut child = 2 * i + 1;
        if child >= heap.len() {
            break;
        }
        if child + 1 < heap.len() && closer(&heap[child], &heap[child + 1]) {
            child += 1;
        }
        if !closer(&item, &heap[child]) {
            break;
        }
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = item;
}

/// Sorts by distance, ties by id. Distances are not negative, so that their bits sort as they do.
#[inline]
pub(crate) fn sort_by_distance(found: &mut [Neighbor]) {
    found.sort_unstable_by_key(|n| (u64::from(n.distance_sq.to_bits()) << 32) | u64::from(n.photon));
}
