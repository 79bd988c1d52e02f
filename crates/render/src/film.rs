//! The film: sums over passes that do not depend on how the passes were split.

use rayon::prelude::*;
use serde::Serialize;

/// Values of which one task makes means.
const VALUES_A_TASK: usize = 1 << 16;

/// A picture that a render can put out beside the beauty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aov {
    /// Share of light that the first surface reflects or transmits, RGB.
    Albedo,
    /// Unit shading normal of the first surface, world space, towards the camera.
    Normal,
    /// Distance to the first surface, scene units.
    Depth,
    /// Light that comes straight from a light to the first surface that is not mirror-like.
    Direct,
    /// Light that arrives there after at least one diffuse bounce.
    Indirect,
    /// Light that arrives there through mirror-like bounces only.
    Caustic,
    /// Lights seen directly, in mirrors and through glass.
    Emitted,
    /// Photons per scene unit squared at the first surface that is not mirror-like.
    PhotonDensity,
    /// Variance of the pixel's mean luminance, estimated over passes.
    Variance,
    /// Index of the first shape plus one; 0 for none.
    ObjectId,
    /// Index of the first shape's material plus one; 0 for none.
    MaterialId,
}

impl Aov {
    /// Every one, in the order of the file's layers.
    pub const ALL: [Self; 11] = [
        Self::Albedo,
        Self::Normal,
        Self::Depth,
        Self::Direct,
        Self::Indirect,
        Self::Caustic,
        Self::Emitted,
        Self::PhotonDensity,
        Self::Variance,
        Self::ObjectId,
        Self::MaterialId,
    ];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Direct => "direct",
            Self::Indirect => "indirect",
            Self::Caustic => "caustic",
            Self::Emitted => "emitted",
            Self::PhotonDensity => "photon-density",
            Self::Variance => "variance",
            Self::ObjectId => "object-id",
            Self::MaterialId => "material-id",
        }
    }

    /// What it holds, in one line.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Albedo => "share of light that the first surface returns",
            Self::Normal => "shading normal of the first surface, world space",
            Self::Depth => "distance to the first surface, scene units",
            Self::Direct => "light straight from a light",
            Self::Indirect => "light after a diffuse bounce",
            Self::Caustic => "light through mirrors and glass onto a diffuse surface",
            Self::Emitted => "lights seen directly, in mirrors and through glass",
            Self::PhotonDensity => "photons per square unit",
            Self::Variance => "variance of the pixel's mean luminance",
            Self::ObjectId => "index of the first shape plus one",
            Self::MaterialId => "index of the first material plus one",
        }
    }

    /// Channels.
    pub fn channels(self) -> usize {
        match self {
            Self::Depth | Self::PhotonDensity | Self::Variance | Self::ObjectId | Self::MaterialId => 1,
            _ => 3,
        }
    }

    /// The one of this name; underscores count as hyphens.
    pub fn parse(name: &str) -> Option<Self> {
        let name = name.replace('_', "-");
        Self::ALL.into_iter().find(|aov| aov.name() == name)
    }
}

/// Where each output lies among a pixel's channels. The beauty is first.
#[derive(Clone, Debug)]
pub struct FilmLayout {
    offsets: [Option<usize>; Aov::ALL.len()],
    channels: usize,
    weight: Option<usize>,
}

impl FilmLayout {
    /// The beauty and `aovs`.
    pub fn new(aovs: &[Aov]) -> Self {
        let mut offsets = [None; Aov::ALL.len()];
        let mut channels = 3;
        for (i, aov) in Aov::ALL.into_iter().enumerate() {
            if aovs.contains(&aov) {
                offsets[i] = Some(channels);
                channels += aov.channels();
            }
        }
        Self { offsets, channels, weight: None }
    }

    /// With one more channel at the end for the weights of samples that several pixels share.
    pub(crate) fn with_weight(self) -> Self {
        Self { weight: Some(self.channels), channels: self.channels + 1, ..self }
    }

    /// Channel of the weights; none where pixels share no samples.
    #[inline]
    pub(crate) fn weight(&self) -> Option<usize> {
        self.weight
    }

    /// Whether a channel holds weighted sums, and not a label.
    pub(crate) fn is_sum(&self, channel: usize) -> bool {
        [Aov::ObjectId, Aov::MaterialId].into_iter().all(|aov| self.offset(aov) != Some(channel))
    }

    /// Channels of a pixel.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// First channel of `aov`, where it is there.
    #[inline]
    pub fn offset(&self, aov: Aov) -> Option<usize> {
        self.offsets[aov as usize]
    }
}

/// Sums over passes in a fixed pairwise tree over the pass index: level k holds the sum of 2^k neighbouring passes, so
/// that any split of the passes into aligned ranges merges to the same bits.
#[derive(Clone, Debug)]
pub struct Film {
    levels: Vec<Option<Vec<f32>>>,
    spare: Vec<Vec<f32>>,
    values: usize,
    passes: u32,
}

impl Film {
    /// A film of `values` numbers (pixels times channels).
    pub fn new(values: usize) -> Self {
        Self { levels: Vec::new(), spare: Vec::new(), values, passes: 0 }
    }

    /// A zeroed buffer for the next pass.
    pub fn buffer(&mut self) -> Vec<f32> {
        match self.spare.pop() {
            Some(mut buffer) => {
                buffer.fill(0.0);
                buffer
            }
            None => vec![0.0; self.values],
        }
    }

    /// Adds a finished pass.
    pub fn add(&mut self, pass: Vec<f32>) {
        let mut carry = pass;
        let mut level = 0;
        loop {
            if level == self.levels.len() {
                self.levels.push(None);
            }
            match self.levels[level].take() {
                None => {
                    self.levels[level] = Some(carry);
                    break;
                }
                Some(mut earlier) => {
                    for (a, b) in earlier.iter_mut().zip(&carry) {
                        *a += b;
                    }
                    self.spare.push(carry);
                    carry = earlier;
                    level += 1;
                }
            }
        }
        // One buffer is in flight between passes; more would only hold memory.
        self.spare.truncate(1);
        self.passes += 1;
    }

    /// Passes added.
    pub fn passes(&self) -> u32 {
        self.passes
    }

    /// Means over the passes; zeros where there are none.
    pub fn mean(&self) -> Vec<f32> {
        let scale = 1.0 / self.passes.max(1) as f32;
        let mut levels = self.levels.iter().flatten();
        let Some(latest) = levels.next() else { return vec![0.0; self.values] };
        let earlier: Vec<&[f32]> = levels.map(Vec::as_slice).collect();
        let mean = |(i, latest): (usize, &f32)| earlier.iter().fold(*latest, |later, level| level[i] + later) * scale;
        latest.par_iter().enumerate().with_min_len(VALUES_A_TASK).map(mean).collect()
    }

    /// Buffers that are held after `passes` passes: a sum for each one in their binary number, and the one that the last
    /// addition of two sums left over.
    pub fn held_after(passes: u32) -> u64 {
        u64::from(passes.count_ones()) + u64::from(passes > 0 && passes.is_multiple_of(2))
    }

    /// The most that is held before any of `passes` passes.
    pub fn held_before(passes: u32) -> u64 {
        if passes < 2 { 0 } else { u64::from(passes.saturating_add(1).ilog2()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_is_counted() {
        let mut film = Film::new(1);
        let held = |film: &Film| (film.levels.iter().flatten().count() + film.spare.len()) as u64;
        let mut most = 0;
        for passes in 1..140u32 {
            most = most.max(held(&film));
            let buffer = film.buffer();
            film.add(buffer);
            assert_eq!((Film::held_before(passes), Film::held_after(passes)), (most, held(&film)), "{passes} passes");
        }
    }

    #[test]
    fn sums_are_pairwise_and_complete() {
        let pass = |i: u32| (0..5).map(|k| (i * 7 + k) as f32 * 0.1).collect::<Vec<f32>>();
        let mut film = Film::new(5);
        for i in 0..11 {
            let mut buffer = film.buffer();
            buffer.copy_from_slice(&pass(i));
            film.add(buffer);
        }
        let pair = |a: Vec<f32>, b: Vec<f32>| a.iter().zip(&b).map(|(a, b)| a + b).collect::<Vec<f32>>();
        let range4 = |i| pair(pair(pass(i), pass(i + 1)), pair(pass(i + 2), pass(i + 3)));
        let expected = pair(pair(range4(0), range4(4)), pair(pair(pass(8), pass(9)), pass(10)));
        let mean = film.mean();
        for (a, b) in mean.iter().zip(expected) {
            assert_eq!(*a, b * (1.0 / 11.0));
        }
    }

    #[test]
    fn layouts_place_what_is_asked_for() {
        let layout = FilmLayout::new(&[Aov::Depth, Aov::Albedo]);
        assert_eq!(layout.channels(), 7);
        assert_eq!((layout.offset(Aov::Albedo), layout.offset(Aov::Depth)), (Some(3), Some(6)));
        assert_eq!(layout.offset(Aov::Caustic), None);
        for aov in Aov::ALL {
            assert_eq!(Aov::parse(&aov.name().replace('-', "_")), Some(aov));
        }
    }
}
