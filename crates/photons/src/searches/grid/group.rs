//! Searches for the nearest, neighbours together: queries that lie close to one another look the photons around them
//! up once.

use super::Grid;
use super::kernels::SharedKernels;
use super::narrow::{ATTEMPTS, NearestFinder, WIDER, wider_for};
use super::shared::Share;
use crate::inclusion::PreparedQuery;
use crate::kernel::PreparedKernel;
use crate::{GatherQuery, GatheredNearest, Kernel};
use photinus_geometry::{Aabb, Vec3};
use rayon::prelude::*;

/// Queries that are worth a task of their own, in their order.
const QUERIES_A_TASK: usize = 1 << 15;
/// Longest way between queries of a group, in radii that the last search needed.
const LONGEST: f32 = 0.7;
/// Balls narrower than this are left to searches one by one: squares of distances in them may underflow.
const LEAST_RADIUS: f32 = 1e-15;
/// Balls wider than this are, too: squares may overflow.
const GREATEST_RADIUS: f32 = 1e18;
/// What rounding may add to a distance, as a part of it, with a margin.
const SLACK: f32 = 1e-5;
/// How much the square of a normal's length may be off 1, and a cosine by rounding, with a margin.
const NORMAL_SLACK: f32 = 1e-3;
/// The sine of 60 degrees.
const HALF_SQRT_3: f32 = 0.866_025_4;
/// More photons than this are not shared, as they would outgrow the caches and the memory that threads are to have.
const MOST_SHARED: u64 = 1 << 16;

impl Grid {
    /// Sums the nearest of each query of a batch in any order; returns the photons tested.
    pub(super) fn gather_nearest_batch(
        &self,
        queries: &[GatherQuery],
        k: u32,
        kernel: Kernel,
        parallel: bool,
        out: &mut [GatheredNearest],
    ) -> u64 {
        let mut order: Vec<(u64, u32)> = (0u32..)
            .zip(queries)
            .map(|(i, query)| (self.cells.neighbourhood(query.position, query.normal), i))
            .collect();
        order.sort_unstable();
        let ordered: Vec<GatherQuery> = order.iter().map(|(_, i)| queries[*i as usize]).collect();
        let mut answers = vec![GatheredNearest::default(); queries.len()];
        let tested = self.gather_nearest_ordered(&ordered, k, kernel, parallel, &mut answers);
        order.iter().zip(answers).for_each(|((_, i), answer)| out[*i as usize] = answer);
        tested
    }

    /// The same for queries in the order of their neighbourhoods.
    pub(super) fn gather_nearest_ordered(
        &self,
        queries: &[GatherQuery],
        k: u32,
        kernel: Kernel,
        parallel: bool,
        out: &mut [GatheredNearest],
    ) -> u64 {
        let answer = |(queries, out): (&[GatherQuery], &mut [GatheredNearest])| {
            self.gather_nearest_part(queries, k, kernel, out)
        };
        if parallel && queries.len() > QUERIES_A_TASK {
            queries.par_chunks(QUERIES_A_TASK).zip(out.par_chunks_mut(QUERIES_A_TASK)).map(answer).sum()
        } else {
            queries.chunks(QUERIES_A_TASK).zip(out.chunks_mut(QUERIES_A_TASK)).map(answer).sum()
        }
    }

    fn gather_nearest_part(
        &self,
        queries: &[GatherQuery],
        k: u32,
        kernel: Kernel,
        mut out: &mut [GatheredNearest],
    ) -> u64 {
        let mut group = Group { grid: self, k, finder: NearestFinder::new() };
        let cell = |query: &GatherQuery| (self.cells.fine_cell(query.position, query.normal), query.max_depth);
        // Of the consecutive pairs that it is asked about the second of one is the first of the next.
        let mut known = None;
        let same = |a: &GatherQuery, b: &GatherQuery| {
            let [a, b] = [known.unwrap_or_else(|| cell(a)), cell(b)];
            known = Some(b);
            a == b
        };
        let mut members = Vec::new();
        for part in queries.chunk_by(same) {
            let (answers, rest) = out.split_at_mut(part.len());
            out = rest;
            members.clear();
            members.extend(part.iter().map(|q| Member { radius: q.radius, query: PreparedQuery::new(q, kernel) }));
            // Questions that make no sense have no neighbours; the rare others among them look by themselves, too.
            let sense = |member: &Member| member.query.r2 >= 0.0;
            if members.iter().all(sense) {
                group.answer(&members, answers);
            } else {
                members.iter().zip(answers).for_each(|(member, answer)| *answer = group.alone(member));
            }
        }
        group.finder.tested
    }
}

/// A query of a group.
#[derive(Clone, Copy)]
struct Member {
    radius: f32,
    query: PreparedQuery,
}

/// Answers groups of queries one after the other.
struct Group<'a> {
    grid: &'a Grid,
    k: u32,
    finder: NearestFinder,
}

impl Group<'_> {
    /// Answers members that are neighbours, in pieces no longer than a search reaches.
    fn answer(&mut self, mut members: &[Member], mut out: &mut [GatheredNearest]) {
        while !members.is_empty() {
            let longest = LONGEST * self.finder.last_radius;
            let mut bounds = Aabb::EMPTY;
            let fits = |member: &&Member| {
                bounds = bounds.union(Aabb::around([member.query.position]));
                bounds.size().max_element() <= longest
            };
            let count = members.iter().take_while(fits).count().max(1);
            let (piece, rest) = members.split_at(count);
            let (answers, rest_out) = out.split_at_mut(count);
            self.together(piece, answers);
            (members, out) = (rest, rest_out);
        }
    }

    fn alone(&mut self, member: &Member) -> GatheredNearest {
        self.grid.nearest_alone(member.query, member.radius, self.k, &mut self.finder)
    }

    fn together(&mut self, members: &[Member], mut out: &mut [GatheredNearest]) {
        let bounds = Aabb::around(members.iter().map(|member| member.query.position));
        let centre = (bounds.min + bounds.max) * 0.5;
        // The middle may be rounded by as much as members lie apart: half of the box's diagonal may fall short.
        let half_sq =
            members.iter().fold(0f32, |half, member| half.max((member.query.position - centre).length_squared()));
        let ball = Ball { centre, half: half_sq.sqrt() };
        let most = members.iter().fold(0f32, |most, member| most.max(member.radius));
        let mut reach = (self.finder.last_radius * WIDER).min(most);
        let mut left = members;
        for _ in 0..ATTEMPTS {
            if left.is_empty() || !self.share(&ball, reach, members) {
                break;
            }
            let (answered, found) = self.answer_shared(&ball, left, out);
            (left, out) = (&left[answered..], &mut out[answered..]);
            reach = (reach * wider_for(self.k, found)).min(most);
        }
        left.iter().zip(out).for_each(|(member, answer)| *answer = self.alone(member));
    }

    /// Collects the photons within a distance of all members; not where that is too small or too large to reckon with, nor
    /// where they may be too many.
    fn share(&mut self, ball: &Ball, reach: f32, members: &[Member]) -> bool {
        let extent = ball.extent(reach);
        if !(extent > LEAST_RADIUS && extent < GREATEST_RADIUS) {
            return false;
        }
        let mut query = members[0].query;
        let normals = Normals::of(members);
        (query.position, query.r2, query.normal) = (ball.centre, extent * extent, normals.middle);
        let finder = &mut self.finder;
        if normals.are_same {
            self.grid.find_facing(query.position, query.normal, extent, query.r2, &mut finder.scratch);
        } else {
            self.grid.find_blocks(query.position, extent, query.r2, &mut finder.scratch);
        }
        let reached = self.grid.photons_in(&finder.scratch);
        if reached > MOST_SHARED {
            return false;
        }
        finder.tested += reached;
        let share = Share { query, same_normal: normals.are_same, least_cos: normals.least_cos };
        (self.grid.kernels.shared.collect)(&self.grid.blocks, &finder.scratch.hits, &share, &mut finder.shared);
        finder.shared_extent = extent;
        true
    }

    /// Answers members by the photons shared, up to the first whose nearest are not all among them; returns how many,
    /// and how many photons that one found.
    fn answer_shared(&mut self, ball: &Ball, members: &[Member], out: &mut [GatheredNearest]) -> (usize, u32) {
        let SharedKernels { nearest, gather, gather_few, .. } = self.grid.kernels.shared;
        let finder = &mut self.finder;
        let photons = finder.shared.photons();
        for (i, (member, answer)) in members.iter().zip(out).enumerate() {
            let mut query = member.query;
            let whole = query.r2;
            let reach = ball.reach_from(query.position, finder.shared_extent);
            let is_whole = reach >= member.radius;
            if !is_whole {
                query.r2 = reach * reach;
            }
            // Where the last one found too few this one will, too.
            if is_whole
                && finder.had_few
                && let Some(few) = gather_few(&finder.shared, &query, self.k as usize)
            {
                (finder.tested, finder.last_radius) = (finder.tested + photons, member.radius);
                *answer = few;
                continue;
            }
            let guess_sq = finder.last_radius * finder.last_radius;
            let found = nearest(&mut finder.shared, &query, self.k as usize, guess_sq);
            finder.tested += photons;
            let has_all = found.count >= self.k;
            if !(has_all || is_whole) {
                return (i, found.count);
            }
            let radius = if has_all { found.limit_sq.sqrt() } else { member.radius };
            (finder.last_radius, finder.had_few) = (radius, !has_all);
            query.r2 = if has_all { found.limit_sq } else { whole };
            query.kernel = PreparedKernel::new(query.kernel.kernel, radius);
            let sums = gather(&finder.shared, &query);
            *answer = GatheredNearest { flux: sums.flux, count: sums.count, farthest_sq: found.limit_sq };
        }
        (members.len(), self.k)
    }
}

/// Where the members of a group are turned.
struct Normals {
    /// The normal of all, or one in the middle of them.
    middle: Vec3,
    are_same: bool,
    /// See [`Share::least_cos`].
    least_cos: f32,
}

impl Normals {
    fn of(members: &[Member]) -> Self {
        let first = members[0].query.normal;
        let normals = || members.iter().map(|member| member.query.normal);
        if normals().all(|normal| normal == first) {
            return Self { middle: first, are_same: true, least_cos: 0.0 };
        }
        let middle = normals().sum::<Vec3>().normalize_or_zero();
        let cos = normals().fold(1f32, |cos, normal| cos.min(normal.dot(middle)));
        let is_unit = |normal: Vec3| (normal.length_squared() - 1.0).abs() < NORMAL_SLACK;
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        // Nothing that faces one of them is farther from the middle than 60 degrees and the farthest of them together.
        let least_cos = 0.5 * cos - HALF_SQRT_3 * sin - 2.0 * NORMAL_SLACK;
        let narrow = cos > -0.5 && normals().all(is_unit);
        Self {
            middle,
            are_same: false,
            least_cos: if narrow { least_cos * least_cos.abs() } else { f32::NEG_INFINITY },
        }
    }
}

/// Where the members of a group lie.
struct Ball {
    centre: Vec3,
    /// Distance from the centre to the farthest of them.
    half: f32,
}

impl Ball {
    /// Distance from the centre within which everything lies that is within `reach` of a member.
    fn extent(&self, reach: f32) -> f32 {
        (reach + self.half) * (1.0 + 4.0 * SLACK)
    }

    /// A distance from a member within which everything lies within `extent` of the centre; zero where there is none.
    fn reach_from(&self, member: Vec3, extent: f32) -> f32 {
        (extent * (1.0 - SLACK) - (member - self.centre).length() * (1.0 + SLACK)).max(0.0)
    }
}
