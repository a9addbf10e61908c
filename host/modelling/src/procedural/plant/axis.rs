//! The axis of a stem: a smooth curve.

use super::frame::StemFrame;
use glam::DVec3;

/// The axis of a stem, or of the rest of one: a curve through the ends of its segments.
pub(super) struct StemAxis {
    pub frames: Vec<StemFrame>,
    pub tangents: Vec<DVec3>,
    /// The segment of the stem with which it begins, and how many the stem has.
    pub first: usize,
    pub segments: usize,
}

impl StemAxis {
    /// - `before`: the direction before its first node. `first`: the segment of the stem with which it begins.
    pub fn new(before: DVec3, frames: Vec<StemFrame>, first: usize, segments: usize) -> StemAxis {
        let last = frames.len() - 1;
        let tangent = |node: usize| match node {
            0 => before,
            node if node == last => frames[last - 1].ahead(),
            node => (frames[node - 1].ahead() + frames[node].ahead()).normalize_or(frames[node].ahead()),
        };
        let tangents = (0..=last).map(tangent).collect();
        StemAxis { frames, tangents, first, segments }
    }

    /// The part of the stem at which it begins.
    pub fn begin(&self) -> f64 {
        self.first as f64 / self.segments as f64
    }

    /// A place of the stem, and its direction there.
    ///
    /// - `part`: of the length of the stem, from where this run begins to 1.
    pub fn at(&self, part: f64) -> StemFrame {
        let along = (part * self.segments as f64 - self.first as f64).max(0.0);
        let segment = (along as usize).min(self.frames.len() - 2);
        self.within(segment, along - segment as f64)
    }

    /// A place of a segment: a cubic through its ends with the tangents there.
    pub fn within(&self, segment: usize, t: f64) -> StemFrame {
        let [from, to] = [self.frames[segment], self.frames[segment + 1]];
        let length = from.at.distance(to.at);
        let [a, b] = [self.tangents[segment] * length, self.tangents[segment + 1] * length];
        let (t2, t3) = (t * t, t * t * t);
        let at = from.at * (2.0 * t3 - 3.0 * t2 + 1.0)
            + a * (t3 - 2.0 * t2 + t)
            + to.at * (3.0 * t2 - 2.0 * t3)
            + b * (t3 - t2);
        let slope =
            (to.at - from.at) * (6.0 * t - 6.0 * t2) + a * (3.0 * t2 - 4.0 * t + 1.0) + b * (3.0 * t2 - 2.0 * t);
        StemFrame { at, ..from }.heading(slope.normalize_or(from.ahead()))
    }
}
