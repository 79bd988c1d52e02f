//! Photons in the order of a structure, each part of which is a run of places.

use crate::Photon;
use photinus_geometry::Vec3;
use std::sync::OnceLock;

/// Photons by place, and which ids they have.
pub(crate) struct Store {
    photons: Vec<Photon>,
    ids: Vec<u32>,
    /// The place of each id; made when first asked for.
    places: OnceLock<Vec<u32>>,
}

impl Store {
    /// Photons in the order of `ids`, a permutation of their indices.
    pub(crate) fn new(photons: &[Photon], ids: Vec<u32>) -> Self {
        let photons = ids.iter().map(|id| photons[*id as usize]).collect();
        Self { photons, ids, places: OnceLock::new() }
    }

    /// The photon at a place.
    #[inline]
    pub(crate) fn at(&self, place: usize) -> &Photon {
        &self.photons[place]
    }

    /// The id of the photon at a place.
    #[inline]
    pub(crate) fn id(&self, place: usize) -> u32 {
        self.ids[place]
    }

    /// The photon of an id.
    pub(crate) fn photon(&self, id: u32) -> Photon {
        let places = self.places.get_or_init(|| {
            let mut places = vec![0; self.ids.len()];
            for (place, id) in (0u32..).zip(&self.ids) {
                places[*id as usize] = place;
            }
            places
        });
        self.photons[places[id as usize] as usize]
    }

    /// How many photons there are.
    pub(crate) fn len(&self) -> usize {
        self.photons.len()
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.photons.capacity() * size_of::<Photon>()
            + self.ids.capacity() * size_of::<u32>()
            + self.places.get().map_or(0, |places| places.capacity() * size_of::<u32>())
    }
}

/// The photons' positions, for the making of a structure.
pub(crate) fn positions(photons: &[Photon]) -> Vec<Vec3> {
    photons.iter().map(Photon::position).collect()
}
