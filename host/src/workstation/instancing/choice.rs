//! Which instances are drawn, and in how much detail: those that are largest on the screen, as many as the machine holds.
//!
//! # Method
//! The vectors that something deserves grow with its size on the screen. One length tells them all: what is larger is drawn
//! in full, what is down to a quarter of it coarse, down to a quarter of that as outlines, then as strokes, and the rest
//! is left out. The length is the least with which everything together fits. Ours.

use super::super::structure_commands::DETAILS;
use super::placed::PlacedObject;
use super::seen::SeenFrom;
use rayon::prelude::*;
use std::cmp::Ordering;

/// From one step of detail to the next, sizes on the screen fall by this factor.
pub(super) const STEP: f64 = 4.0;
/// Instances that a thread looks at in one go.
const CHUNK: usize = 1 << 14;
/// Halvings of the range in which the length is sought.
const HALVINGS: usize = 60;

/// An instance that may be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    /// On the screen, as [`SeenFrom::size`] tells it.
    pub(super) size: f32,
    /// Number of the object whose instances it is of, among those that have any.
    pub(super) object: u32,
    /// Its number there.
    pub(super) number: u32,
    /// What it places.
    pub(super) prototype: u16,
}

impl Candidate {
    /// The largest first; no two are equal.
    fn order(&self, other: &Candidate) -> Ordering {
        other.size.total_cmp(&self.size).then((self.object, self.number).cmp(&(other.object, other.number)))
    }
}

/// The instances that are largest on the screen, the largest first. All are looked at, one after the other, and none
/// but these is kept.
///
/// - `most`: how many.
pub(super) fn largest(most: usize, objects: &[PlacedObject<'_>], seen: &SeenFrom) -> Vec<Candidate> {
    let mut best: Vec<Candidate> = Vec::new();
    for (object, placed) in (0..).zip(objects) {
        let count = placed.places.count();
        let candidate = |number: usize| {
            let instance = placed.places.instance(number);
            let prototype = placed.prototypes.get(usize::from(instance.prototype))?;
            let (center, radius) = prototype.ball_at(&(placed.transform * instance.placement));
            let size = seen.size(center, radius) as f32;
            Some(Candidate { size, object, number: number as u32, prototype: instance.prototype })
        };
        let chunks = (0..count.div_ceil(CHUNK)).into_par_iter();
        let of_threads = chunks.fold(Vec::new, |mut kept: Vec<Candidate>, chunk| {
            let first = chunk * CHUNK;
            kept.extend((first..count.min(first + CHUNK)).filter_map(candidate));
            keep(&mut kept, most, most + CHUNK);
            kept
        });
        let found = of_threads.reduce(Vec::new, |mut kept, mut other| {
            kept.append(&mut other);
            keep(&mut kept, most, most);
            kept
        });
        best.extend(found);
        keep(&mut best, most, most);
    }
    best.sort_unstable_by(Candidate::order);
    best
}

/// Keeps the largest candidates, if there are more than `limit`.
fn keep(candidates: &mut Vec<Candidate>, most: usize, limit: usize) {
    if candidates.len() > limit && most > 0 {
        candidates.select_nth_unstable_by(most - 1, Candidate::order);
    }
    if candidates.len() > limit {
        candidates.truncate(most);
    }
}

/// How large what is drawn in full is at the least, such that all together are drawn by no more vectors than `most`.
///
/// - `lines`: vectors of a candidate in each step of detail, no more in any than in the one before.
pub(super) fn least_size(candidates: &[Candidate], most: usize, lines: impl Fn(&Candidate) -> [usize; DETAILS]) -> f64 {
    let lines: Vec<(f64, [usize; DETAILS])> =
        candidates.iter().map(|candidate| (candidate.size.into(), lines(candidate))).collect();
    let fits = |least: f64| {
        let of = |(size, lines): &(f64, [usize; DETAILS])| step(*size, least).map_or(0, |step| lines[step]);
        lines.iter().map(of).sum::<usize>() <= most
    };
    if fits(0.0) {
        return 0.0;
    }
    let (mut low, mut high) = (1e-12_f64, 1e12_f64);
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if fits(middle) { high = middle } else { low = middle }
    }
    high
}

/// The step of detail of a size on the screen, none for what is left out.
///
/// - `least`: of what is drawn in full.
pub(super) fn step(size: f64, least: f64) -> Option<usize> {
    (0..DETAILS).find(|step| size * STEP.powi(*step as i32) >= least)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_size(number: u32, size: f32) -> Candidate {
        Candidate { size, object: 0, number, prototype: 0 }
    }

    #[test]
    fn the_length_is_the_least_that_fits() {
        let candidates: Vec<Candidate> = (0..1000).map(|k| of_size(k, 1.0 / (1.0 + k as f32))).collect();
        let lines = |_: &Candidate| [100, 30, 8, 1];
        let drawn = |least: f64| {
            let steps = candidates.iter().filter_map(|candidate| step(candidate.size.into(), least));
            steps.map(|step| [100, 30, 8, 1][step]).sum::<usize>()
        };
        assert_eq!(least_size(&candidates, 100_000, lines), 0.0, "all in full");
        for most in [0, 1, 50, 100, 1_000, 5_000, 50_000, 99_999] {
            let least = least_size(&candidates, most, lines);
            assert!(drawn(least) <= most && drawn(least * (1.0 - 1e-6)) > most, "{most}: {}", drawn(least));
        }
        assert_eq!([1.0, 0.3, 0.25, 0.02, 0.01].map(|size| step(size, 1.0)), [Some(0), Some(1), Some(1), Some(3), None]);
    }

    #[test]
    fn the_largest_are_kept() {
        let mut kept: Vec<Candidate> = Vec::new();
        for k in 0..100 {
            kept.push(of_size(k, (k * 37 % 100) as f32));
            keep(&mut kept, 5, 10);
        }
        keep(&mut kept, 5, 5);
        kept.sort_unstable_by(Candidate::order);
        assert_eq!(kept.iter().map(|c| c.size).collect::<Vec<f32>>(), [99.0, 98.0, 97.0, 96.0, 95.0]);
    }
}
