//! The choice of the instances that are drawn, and in how much detail: the largest on the screen, within a budget.
//!
//! # Method
//! The vectors that something deserves grow with its size on the screen. One length tells them all: what is larger is drawn
//! in full, what is down to a quarter of it coarse, down to a quarter of that as outlines, then as strokes, and the rest
//! is left out. The length is the least with which everything together fits. What does not fit in full is not crowded,
//! either: where the screen is full of lines of larger instances, an instance is drawn by as many steps coarser as it is
//! too full. A wood of a thousand trees behind each other would be one patch of light. Ours.

use super::super::structure_commands::DETAILS;
use super::ink::Ink;
use super::placed::PlacedObject;
use super::seen::SeenFrom;
use rayon::prelude::*;
use std::cmp::Ordering;

/// From one step of detail to the next, sizes on the screen fall by this factor.
pub(super) const STEP: f64 = 4.0;
/// Instances that a thread looks at in one go.
const CHUNK: usize = 1 << 14;
/// Of more instances than so many, only about as many are looked at, those about the eye, where that can be told.
const LOOKED_AT: usize = 1 << 20;
/// Halvings of the range in which the length is sought.
const HALVINGS: usize = 40;

/// An instance that may be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    /// On the screen, as [`SeenFrom::size`] tells it.
    pub(super) size: f32,
    /// Where on the screen, -1 to 1; none for what is out of the picture.
    pub(super) at: Option<[f32; 2]>,
    /// Number of the object whose instances it is of, among those that have any.
    pub(super) object: u32,
    /// Its number there.
    pub(super) number: u64,
    /// What it places.
    pub(super) prototype: u16,
}

impl Candidate {
    /// The largest first; no two are equal.
    fn order(&self, other: &Candidate) -> Ordering {
        other.size.total_cmp(&self.size).then((self.object, self.number).cmp(&(other.object, other.number)))
    }
}

/// The instances that are largest on the screen, the largest first. All are looked at, but of very many those about the
/// eye, one after the other, and none but these is kept.
///
/// - `most`: how many.
pub(super) fn largest(most: usize, objects: &[PlacedObject<'_>], seen: &SeenFrom) -> Vec<Candidate> {
    let mut best: Vec<Candidate> = Vec::new();
    for (object, placed) in (0..).zip(objects) {
        let candidate = |number: usize| {
            let instance = placed.places.has(number).then(|| placed.places.instance(number))?;
            let prototype = placed.prototypes.get(usize::from(instance.prototype))?;
            let (center, radius) = prototype.ball_at(&(placed.transform * instance.placement));
            let (size, at) = seen.size(center, radius);
            Some(Candidate { size: size as f32, at, object, number: number as u64, prototype: instance.prototype })
        };
        let ranges = placed.places.near(placed.transform.inverse().transform_point3(seen.eye()), LOOKED_AT);
        let chunks = ranges
            .into_par_iter()
            .flat_map_iter(|range| range.clone().step_by(CHUNK).map(move |first| first..range.end.min(first + CHUNK)));
        let of_threads = chunks.fold(Vec::new, |mut kept: Vec<Candidate>, chunk| {
            kept.extend(chunk.filter_map(candidate));
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

/// What it costs to draw a candidate in each step of detail, no more in any than in the one before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DrawingCost {
    /// Vectors, or corners of polygons.
    pub(super) lines: [usize; DETAILS],
    /// Length of all vectors on the screen, in halves of its side; 0 for polygons, which hide each other.
    pub(super) length: [f64; DETAILS],
}

/// The steps of detail in which candidates are drawn, none for those that are left out, such that all together are drawn
/// by no more vectors than `most`: all in full, if these are no more.
///
/// - `candidates`: the largest first. `costs`: of each.
pub(super) fn steps(candidates: &[Candidate], costs: &[DrawingCost], most: usize) -> Vec<Option<usize>> {
    let whole = vec![Some(0); candidates.len()];
    if lines(&whole, costs) <= most {
        return whole;
    }
    let (mut low, mut high, mut fitting) = (1e-9_f64, 1e9_f64, vec![None; candidates.len()]);
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        let found = steps_of(candidates, costs, middle);
        if lines(&found, costs) <= most {
            (high, fitting) = (middle, found);
        } else {
            low = middle;
        }
    }
    fitting
}

fn lines(steps: &[Option<usize>], costs: &[DrawingCost]) -> usize {
    steps.iter().zip(costs).filter_map(|(step, cost)| step.map(|step| cost.lines[step])).sum()
}

/// The steps of detail for one length.
///
/// - `least`: size of what is drawn in full.
fn steps_of(candidates: &[Candidate], costs: &[DrawingCost], least: f64) -> Vec<Option<usize>> {
    let mut ink = Ink::default();
    let step = |(candidate, cost): (&Candidate, &DrawingCost)| {
        let size = f64::from(candidate.size);
        let deserved = (0..DETAILS).find(|step| size * STEP.powi(*step as i32) >= least)?;
        let Some(at) = candidate.at else { return Some(deserved) };
        let step = Some(deserved + ink.layers(at, size)).filter(|step| *step < DETAILS)?;
        ink.add(at, size, cost.length[step]);
        Some(step)
    };
    candidates.iter().zip(costs).map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_size(number: u32, size: f32) -> Candidate {
        Candidate { size, at: None, object: 0, number: number.into(), prototype: 0 }
    }

    #[test]
    fn as_much_is_drawn_as_fits_and_the_largest_in_most_detail() {
        let candidates: Vec<Candidate> = (0..1000).map(|k| of_size(k, 1.0 / (1.0 + k as f32))).collect();
        let costs = vec![DrawingCost { lines: [100, 30, 8, 1], length: [0.0; DETAILS] }; 1000];
        assert!(steps(&candidates, &costs, 100_000).iter().all(|step| *step == Some(0)), "all in full");
        for most in [0, 1, 50, 100, 1_000, 5_000, 50_000, 99_999] {
            let steps = steps(&candidates, &costs, most);
            let drawn = lines(&steps, &costs);
            assert!(drawn <= most && drawn + 100 > most.min(99_901), "{drawn} of {most}");
            let order = |step: &Option<usize>| step.unwrap_or(DETAILS);
            assert!(steps.is_sorted_by_key(order), "{most}");
        }
        let sizes = [1.0, 0.3, 0.25, 0.02, 0.01].map(|size| of_size(0, size));
        assert_eq!(steps_of(&sizes, &costs, 1.0), [Some(0), Some(1), Some(1), Some(3), None]);
    }

    #[test]
    fn where_the_screen_is_full_the_smaller_are_coarser_or_left_out() {
        let here = |number: u32, at: f32| Candidate { at: Some([at, 0.0]), ..of_size(number, 0.1) };
        let crowd: Vec<Candidate> = (0..40).map(|k| here(k, 0.0)).chain([here(40, 0.7)]).collect();
        let costs = vec![DrawingCost { lines: [50, 20, 8, 1], length: [2.0, 1.0, 0.5, 0.1] }; 41];
        let steps = steps(&crowd, &costs, 2_000);
        assert!(steps[0] == Some(0) && steps[40] == Some(0), "{steps:?}");
        assert!(steps[..40].is_sorted_by_key(|step| step.unwrap_or(DETAILS)) && steps[39].is_none(), "{steps:?}");
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
