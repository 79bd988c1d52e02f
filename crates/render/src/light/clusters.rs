//! Parts of emitters in groups that are near each other and face alike, so that a choice among many lights stays small.

use super::alias::AliasTable;
use photinus_geometry::Vec3;

/// Most groups.
const LIMIT: usize = 256;

/// A part of an emitter as it is grouped.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member {
    /// Middle.
    pub position: Vec3,
    /// Unit direction that it faces; zero: all around.
    pub facing: Vec3,
    /// Share in the choice within its group, at least 0.
    pub power: f64,
    /// Natural logarithm of its radiance, or of its intensity where it has no area.
    pub brightness: f32,
}

/// The groups.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clusters {
    /// Members of each group with the choice among them by power.
    groups: Vec<(Vec<u32>, AliasTable)>,
    /// Group of each member and its place there.
    places: Vec<(u32, u32)>,
}

impl Clusters {
    /// Groups `members`; a difference in facing of 1 counts as much as a distance of `scale`, and as a brightness e^4
    /// times as high.
    pub fn new(members: &[Member], scale: f32) -> Self {
        let key = |i: u32| {
            let m = &members[i as usize];
            let (p, f) = (m.position, m.facing * scale);
            [p.x, p.y, p.z, f.x, f.y, f.z, 0.25 * scale * m.brightness]
        };
        let measured = |group: Vec<u32>| {
            let (axis, width) = widest(group.iter().map(|&i| key(i)));
            let power: f64 = group.iter().map(|&i| members[i as usize].power).sum();
            let harm = if group.len() > 1 { f64::from(width) * power.max(1e-30) } else { -1.0 };
            (group, axis, harm)
        };
        let mut open = Vec::new();
        if !members.is_empty() {
            open.push(measured((0..members.len() as u32).collect()));
        }
        // The group that misleads most, by power times width, is cut in the middle of its widest axis.
        while open.len() < LIMIT {
            let worst = (0..open.len()).max_by(|&a, &b| open[a].2.total_cmp(&open[b].2).then(b.cmp(&a)));
            let Some(slot) = worst.filter(|&slot| open[slot].2 >= 0.0) else { break };
            let (mut group, axis, _) = open.swap_remove(slot);
            let middle = group.len() / 2;
            group.select_nth_unstable_by(middle, |&a, &b| key(a)[axis].total_cmp(&key(b)[axis]).then(a.cmp(&b)));
            let rest = group.split_off(middle);
            open.push(measured(group));
            open.push(measured(rest));
        }
        let mut places = vec![(0, 0); members.len()];
        let groups = open
            .into_iter()
            .enumerate()
            .map(|(g, (group, ..))| {
                for (slot, &i) in group.iter().enumerate() {
                    places[i as usize] = (g as u32, slot as u32);
                }
                let powers: Vec<f64> = group.iter().map(|&i| members[i as usize].power).collect();
                (group, AliasTable::new(&powers))
            })
            .collect();
        Self { groups, places }
    }

    /// Number of groups.
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// A member of a group, its probability there, and what is left of `u`.
    pub fn sample(&self, group: usize, u: f32) -> (usize, f32, f32) {
        let (members, table) = &self.groups[group];
        let (slot, probability, rest) = table.sample(u);
        (members[slot] as usize, probability, rest)
    }

    /// Group of a member, and its probability there.
    pub fn find(&self, member: usize) -> (usize, f32) {
        let (group, slot) = self.places[member];
        (group as usize, self.groups[group as usize].1.probability(slot as usize))
    }

    /// Members of a group.
    pub fn members(&self, group: usize) -> &[u32] {
        &self.groups[group].0
    }
}

/// The axis along which `keys` reach farthest, and how far.
pub(crate) fn widest<const N: usize>(keys: impl Iterator<Item = [f32; N]>) -> (usize, f32) {
    let (mut low, mut high) = ([f32::INFINITY; N], [f32::NEG_INFINITY; N]);
    for key in keys {
        for axis in 0..N {
            low[axis] = low[axis].min(key[axis]);
            high[axis] = high[axis].max(key[axis]);
        }
    }
    let mut best = (0, high[0] - low[0]);
    for axis in 1..N {
        if high[axis] - low[axis] > best.1 {
            best = (axis, high[axis] - low[axis]);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_emitter_is_in_the_group_that_names_it() {
        let members: Vec<Member> = (0..1000)
            .map(|i| Member {
                position: Vec3::new((i % 10) as f32, (i / 10) as f32, 0.0),
                facing: if i % 2 == 0 { Vec3::Z } else { -Vec3::Z },
                power: f64::from(i % 7),
                brightness: 0.0,
            })
            .collect();
        let clusters = Clusters::new(&members, 100.0);
        assert_eq!(clusters.len(), LIMIT);
        let mut seen = 0;
        for group in 0..clusters.len() {
            for &i in clusters.members(group) {
                assert_eq!(clusters.find(i as usize).0, group);
                assert_eq!(members[i as usize].facing, members[clusters.members(group)[0] as usize].facing);
                seen += 1;
            }
            let (i, probability, _) = clusters.sample(group, 0.3);
            assert_eq!(clusters.find(i), (group, probability));
        }
        assert_eq!(seen, members.len());
    }

    #[test]
    fn few_emitters_stand_alone() {
        let member = Member { position: Vec3::ZERO, facing: Vec3::ZERO, power: 0.0, brightness: 0.0 };
        assert_eq!(Clusters::new(&[], 1.0).len(), 0);
        assert_eq!(Clusters::new(&[member; 3], 1.0).len(), 3);
        assert_eq!(Clusters::new(&[member; 3], 1.0).find(2).1, 1.0);
    }
}
