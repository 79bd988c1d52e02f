//! Records as bytes, little-endian, each of a fixed length; both ways.

use super::record::{
    Block, BlockKey, MapKind, RayAnswer, RayHit, RayKind, RayRecord, SearchAnswer, SearchKernel, SearchRecord, Stage,
};

pub const MAGIC: [u8; 8] = *b"PHQUERY1";
/// Magic, hash of the scene, triangles, spheres.
pub const HEADER_BYTES: usize = 32;
/// Pass, stage, index, rays, searches, photons.
pub const BLOCK_BYTES: usize = 24;
pub const RAY_BYTES: usize = 56;
pub const SEARCH_BYTES: usize = 60;
pub const PHOTON_BYTES: usize = 24;

/// Counts of a block: rays, searches, photons.
pub type Counts = [u32; 3];

/// Bytes that a block's records take.
pub fn record_bytes(counts: Counts) -> u64 {
    let [rays, searches, photons] = counts.map(u64::from);
    rays * RAY_BYTES as u64 + searches * SEARCH_BYTES as u64 + photons * PHOTON_BYTES as u64
}

/// Appends a block, its header included.
pub fn put_block(out: &mut Vec<u8>, block: &Block) {
    let counts = [block.rays.len(), block.searches.len(), block.photons.len()].map(|n| n as u32);
    let BlockKey { pass, stage, index } = block.key;
    words(out, &[pass, stage as u32, index]);
    words(out, &counts);
    block.rays.iter().for_each(|ray| put_ray(out, ray));
    block.searches.iter().for_each(|search| put_search(out, search));
    block.photons.iter().for_each(|photon| words(out, photon));
}

fn words(out: &mut Vec<u8>, words: &[u32]) {
    words.iter().for_each(|word| out.extend(word.to_le_bytes()));
}

fn floats(out: &mut Vec<u8>, floats: &[f32]) {
    floats.iter().for_each(|x| out.extend(x.to_le_bytes()));
}

fn put_ray(out: &mut Vec<u8>, ray: &RayRecord) {
    let (told, hit) = match ray.answer {
        RayAnswer::Closest(None) => (0, None),
        RayAnswer::Closest(hit) => (1, hit),
        RayAnswer::Any(false) => (2, None),
        RayAnswer::Any(true) => (3, None),
    };
    out.extend([ray.kind as u8, told, 0, 0]);
    words(out, &[ray.parent]);
    floats(out, &ray.origin);
    floats(out, &ray.dir);
    floats(out, &ray.interval);
    let hit = hit.unwrap_or(RayHit { t: 0.0, alpha: 0.0, beta: 0.0, prim: 0 });
    floats(out, &[hit.t, hit.alpha, hit.beta]);
    words(out, &[hit.prim]);
}

fn put_search(out: &mut Vec<u8>, search: &SearchRecord) {
    let (told, answer) = match search.answer {
        SearchAnswer::Sum(flux) => (0, flux.map(f32::to_bits)),
        SearchAnswer::Visited => (1, [0; 3]),
        SearchAnswer::Nearest { k, farthest_sq } => (2, [k, farthest_sq.to_bits(), 0]),
    };
    out.extend([search.map as u8, search.kernel as u8, told, 0]);
    words(out, &[search.parent]);
    floats(out, &search.position);
    floats(out, &[search.radius]);
    floats(out, &search.normal);
    words(out, &[search.max_depth, search.found]);
    words(out, &answer);
    words(out, &[0]);
}

/// Reads records off the front of bytes that are long enough.
pub struct Cursor<'b>(pub &'b [u8]);

impl Cursor<'_> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*first)
    }

    pub fn word(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    pub fn long(&mut self) -> Option<u64> {
        self.bytes().map(u64::from_le_bytes)
    }

    fn words<const N: usize>(&mut self) -> Option<[u32; N]> {
        let mut out = [0; N];
        for word in &mut out {
            *word = self.word()?;
        }
        Some(out)
    }

    fn floats<const N: usize>(&mut self) -> Option<[f32; N]> {
        Some(self.words::<N>()?.map(f32::from_bits))
    }

    /// A block's header; none where the bytes are no such thing.
    pub fn block_header(&mut self) -> Option<(BlockKey, Counts)> {
        let [pass, stage, index] = self.words()?;
        let stage = *Stage::ALL.get(stage as usize)?;
        Some((BlockKey { pass, stage, index }, self.words()?))
    }

    /// A ray.
    pub fn ray(&mut self) -> Option<RayRecord> {
        let [kind, told, ..] = self.bytes::<4>()?;
        let kind = *RayKind::ALL.get(usize::from(kind))?;
        let parent = self.word()?;
        let (origin, dir, interval) = (self.floats()?, self.floats()?, self.floats()?);
        let [t, alpha, beta] = self.floats()?;
        let hit = RayHit { t, alpha, beta, prim: self.word()? };
        let answer = match told {
            0 => RayAnswer::Closest(None),
            1 => RayAnswer::Closest(Some(hit)),
            2 => RayAnswer::Any(false),
            3 => RayAnswer::Any(true),
            _ => return None,
        };
        Some(RayRecord { kind, parent, origin, dir, interval, answer })
    }

    /// A search.
    pub fn search(&mut self) -> Option<SearchRecord> {
        let [map, kernel, told, _] = self.bytes::<4>()?;
        let map = *[MapKind::Global, MapKind::Caustic].get(usize::from(map))?;
        let kernel = *[SearchKernel::Constant, SearchKernel::Epanechnikov].get(usize::from(kernel))?;
        let parent = self.word()?;
        let position = self.floats()?;
        let [radius] = self.floats()?;
        let normal = self.floats()?;
        let [max_depth, found] = self.words()?;
        let answer = self.words::<3>()?;
        self.word()?;
        let answer = match told {
            0 => SearchAnswer::Sum(answer.map(f32::from_bits)),
            1 => SearchAnswer::Visited,
            2 => SearchAnswer::Nearest { k: answer[0], farthest_sq: f32::from_bits(answer[1]) },
            _ => return None,
        };
        Some(SearchRecord { map, kernel, parent, position, radius, normal, max_depth, found, answer })
    }

    /// A photon's words.
    pub fn photon(&mut self) -> Option<[u32; 6]> {
        self.words()
    }
}
