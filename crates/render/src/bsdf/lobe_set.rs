//! Sets of kinds of lobes.

use std::ops::{BitAnd, BitOr, BitOrAssign, Not};

/// A set of kinds of lobes: reflection or transmission, and how widely the lobe spreads. Every lobe (or half of a lobe
/// that reflects and transmits) is of exactly one of the eight kinds.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct LobeSet(u8);

impl LobeSet {
    /// Nothing.
    pub const NONE: Self = Self(0);
    /// Diffuse reflection.
    pub const DIFFUSE_REFLECTION: Self = Self(1);
    /// Reflection by microfacets of roughness [`GATHER_ALPHA`](super::GATHER_ALPHA) or more.
    pub const ROUGH_REFLECTION: Self = Self(2);
    /// Reflection by smoother microfacets.
    pub const GLOSSY_REFLECTION: Self = Self(4);
    /// Reflection into one direction.
    pub const DELTA_REFLECTION: Self = Self(8);
    /// Diffuse transmission.
    pub const DIFFUSE_TRANSMISSION: Self = Self(16);
    /// Transmission by microfacets of roughness [`GATHER_ALPHA`](super::GATHER_ALPHA) or more.
    pub const ROUGH_TRANSMISSION: Self = Self(32);
    /// Transmission by smoother microfacets.
    pub const GLOSSY_TRANSMISSION: Self = Self(64);
    /// Transmission into one direction, bent or straight.
    pub const DELTA_TRANSMISSION: Self = Self(128);

    /// All that leaves on the side it came from.
    pub const REFLECTION: Self = Self(1 | 2 | 4 | 8);
    /// All that crosses the surface.
    pub const TRANSMISSION: Self = Self(16 | 32 | 64 | 128);
    /// Diffuse, either way.
    pub const DIFFUSE: Self = Self(1 | 16);
    /// Microfacets of any roughness, either way.
    pub const GLOSSY: Self = Self(2 | 4 | 32 | 64);
    /// Single directions, either way.
    pub const DELTA: Self = Self(8 | 128);
    /// Lobes with a density over directions.
    pub const NON_DELTA: Self = Self(!(8 | 128));
    /// Everything.
    pub const ALL: Self = Self(0xFF);

    /// Lobes at which photons are stored and gathered: diffuse ones and rough reflection.
    pub const GATHER: Self = Self(1 | 2 | 16);
    /// Lobes through which eye paths go on: all others.
    pub const CONTINUE: Self = Self(!(1 | 2 | 16));

    /// The eight kinds.
    pub const KINDS: [Self; 8] = [
        Self::DIFFUSE_REFLECTION,
        Self::ROUGH_REFLECTION,
        Self::GLOSSY_REFLECTION,
        Self::DELTA_REFLECTION,
        Self::DIFFUSE_TRANSMISSION,
        Self::ROUGH_TRANSMISSION,
        Self::GLOSSY_TRANSMISSION,
        Self::DELTA_TRANSMISSION,
    ];

    /// Whether the sets share a kind.
    #[inline]
    pub fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether all kinds of `other` are in this set.
    #[inline]
    pub fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether nothing is in the set.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl BitOr for LobeSet {
    type Output = Self;
    #[inline]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for LobeSet {
    #[inline]
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl BitAnd for LobeSet {
    type Output = Self;
    #[inline]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl Not for LobeSet {
    type Output = Self;
    #[inline]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl std::fmt::Debug for LobeSet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        const NAMES: [&str; 8] = [
            "diffuse reflection",
            "rough reflection",
            "glossy reflection",
            "delta reflection",
            "diffuse transmission",
            "rough transmission",
            "glossy transmission",
            "delta transmission",
        ];
        let names = Self::KINDS.iter().zip(NAMES).filter(|(kind, _)| self.intersects(**kind)).map(|(_, name)| name);
        f.write_str("{")?;
        for (i, name) in names.enumerate() {
            write!(f, "{}{name}", if i > 0 { ", " } else { "" })?;
        }
        f.write_str("}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_in_exactly_one_of_each_pair() {
        let pairs = [
            (LobeSet::GATHER, LobeSet::CONTINUE),
            (LobeSet::REFLECTION, LobeSet::TRANSMISSION),
            (LobeSet::DELTA, LobeSet::NON_DELTA),
        ];
        for kind in LobeSet::KINDS {
            for (a, b) in pairs {
                assert!(a.intersects(kind) != b.intersects(kind), "{kind:?}");
            }
        }
        assert_eq!(LobeSet::KINDS.iter().fold(LobeSet::NONE, |a, &b| a | b), LobeSet::ALL);
        assert_eq!(LobeSet::DIFFUSE | LobeSet::GLOSSY | LobeSet::DELTA, LobeSet::ALL);
        assert_eq!(!LobeSet::GATHER, LobeSet::CONTINUE);
    }
}
