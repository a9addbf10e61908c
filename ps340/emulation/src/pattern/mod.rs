//! Patterns: the dashed form of a vector list, made when the pattern is applied.
//!
//! # Source
//! The command PATTERN as remembered and as two clients of the time use it. Ours: what an odd number of
//! entries does, which length MATCH takes, and what becomes of vectors of no length.
//! Not modelled: the indices that picking of a dashed list gave; they are those of the dashes.

use protocol::command::{Pattern, VectorClass, VectorList};

/// Most entries of a pattern.
pub const MAX_SEGMENTS: usize = 32;
/// Most dashes of a list; their points take 32 bytes each.
pub const MAX_DASHES: usize = 1 << 20;

/// A dash or a gap shorter than this part of the pattern's length is a rounding.
const TOLERANCE: f64 = 1e-9;
/// So is one that the coordinates of the line cannot tell, up to this part of the pattern's length: a line to 0.8,
/// which is 0.80000001 in 32 bits, is two repetitions of 0.4 long.
const UNTOLD: f64 = 1e-3;

/// The reason why a pattern cannot be applied.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PatternFault {
    /// No entries, or more than [`MAX_SEGMENTS`].
    #[error("a pattern has 1 to {MAX_SEGMENTS} entries, not {0}")]
    Segments(usize),
    /// An entry that is negative or not finite. Counted from 1.
    #[error("entry {0} of the pattern is not a length")]
    Segment(usize),
    /// All entries are zero.
    #[error("all entries of the pattern are zero")]
    Empty,
    /// A length that is not positive and finite.
    #[error("the length of a pattern is positive, not {0}")]
    Length(f64),
    /// A point of the list is not finite. Counted from 1.
    #[error("vector {0} of the list is not finite")]
    NotFinite(usize),
    /// The list would have more than [`MAX_DASHES`] dashes.
    #[error("the pattern makes more than {MAX_DASHES} dashes of this list")]
    TooManyDashes,
}

/// The dashed form of a list: itemized, the dashes drawn, each begun by a move.
///
/// Every line is measured in the coordinates of the list. A repetition of the pattern begins with a drawn
/// part; after an odd number of entries the last one and the first of the next repetition make one dash. The
/// pattern starts anew at each line, or, around corners, at each move. With MATCH, the length of a repetition
/// becomes the nearest that divides the line (or the polyline, around corners) into whole repetitions, at
/// least one. Intensities inside a line are interpolated. A line of no length stays, as a dot, where the
/// pattern draws. Lists of dots have no lines and come back as they are, and so does every list under a
/// pattern without gaps.
///
/// # Errors
/// A pattern without meaning, points that are not finite, more than [`MAX_DASHES`] dashes.
pub fn dashed(list: &VectorList, pattern: &Pattern) -> Result<VectorList, PatternFault> {
    let bounds = bounds(pattern)?;
    if let Some(index) = list.points.iter().position(|point| point.iter().any(|c| !c.is_finite())) {
        return Err(PatternFault::NotFinite(index + 1));
    }
    let gaps: f64 = pattern.segments.iter().skip(1).step_by(2).sum();
    if list.class == VectorClass::Dots || gaps == 0.0 {
        return Ok(list.clone());
    }
    // Lines that are shorter than the pattern cost no more than they did.
    let mut pen = Pen { left: MAX_DASHES + list.points.len(), ..Pen::default() };
    for run in runs(list, pattern.around_corners) {
        let period = period(pattern, &run);
        let mut phase = 0.0;
        pen.at = None;
        for to in run.first..=run.last {
            let line = Line::new(list.points[to - 1], list.points[to]);
            pen.line(&line, &bounds, period, phase)?;
            phase = (phase + line.length) % period;
            if period - phase < line.slack(period) {
                phase = 0.0;
            }
        }
    }
    Ok(VectorList { class: VectorClass::Itemized, points: pen.points, lines: pen.lines, estimate: None, ..*list })
}

/// Where the entries begin, and where the last ends, as parts of the whole: 0 ... 1.
fn bounds(pattern: &Pattern) -> Result<Vec<f64>, PatternFault> {
    let segments = &pattern.segments;
    if !(1..=MAX_SEGMENTS).contains(&segments.len()) {
        return Err(PatternFault::Segments(segments.len()));
    }
    if let Some(index) = segments.iter().position(|length| !(length.is_finite() && *length >= 0.0)) {
        return Err(PatternFault::Segment(index + 1));
    }
    if !(pattern.length.is_finite() && pattern.length > 0.0) {
        return Err(PatternFault::Length(pattern.length));
    }
    // Parts of the largest first: the sum of the entries themselves may be beyond the numbers.
    let largest = segments.iter().copied().fold(0.0, f64::max);
    if largest == 0.0 {
        return Err(PatternFault::Empty);
    }
    let whole: f64 = segments.iter().map(|length| length / largest).sum();
    let mut sum = 0.0;
    let mut bounds = vec![0.0];
    bounds.extend(segments.iter().map(|length| {
        sum += length / largest;
        sum / whole
    }));
    Ok(bounds)
}

/// Lines over which the pattern goes on.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// The point that the first line is drawn to.
    first: usize,
    /// The point that the last line is drawn to.
    last: usize,
    /// Length of all lines.
    length: f64,
}

/// The lines of a list; around corners, those that are connected as one run.
fn runs(list: &VectorList, around_corners: bool) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for to in (1..list.points.len()).filter(|to| list.is_line(*to)) {
        let length = Line::new(list.points[to - 1], list.points[to]).length;
        match runs.last_mut() {
            Some(run) if around_corners && run.last == to - 1 => {
                run.last = to;
                run.length += length;
            }
            _ => runs.push(Run { first: to, last: to, length }),
        }
    }
    runs
}

/// Length of a repetition along a run.
fn period(pattern: &Pattern, run: &Run) -> f64 {
    if pattern.matched && run.length > 0.0 {
        run.length / (run.length / pattern.length).round().max(1.0)
    } else {
        pattern.length
    }
}

/// One line, measured.
#[derive(Clone, Copy, Debug)]
struct Line {
    start: [f32; 4],
    end: [f32; 4],
    length: f64,
    /// What the rounding of the coordinates can make of the length.
    rounding: f64,
}

impl Line {
    fn new(start: [f32; 4], end: [f32; 4]) -> Line {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(end[axis]) - f64::from(start[axis]));
        let largest = start[..3].iter().chain(&end[..3]).fold(0.0_f32, |largest, c| largest.max(c.abs()));
        let rounding = 2.0 * f64::from(f32::EPSILON) * f64::from(largest);
        Line { start, end, length: (x * x + y * y + z * z).sqrt(), rounding }
    }

    /// The longest dash or gap that is a rounding.
    fn slack(&self, period: f64) -> f64 {
        (TOLERANCE * period.min(self.length)).max(self.rounding.min(UNTOLD * period.min(self.length)))
    }

    /// The point at a distance from the start; both ends exact.
    fn at(&self, distance: f64) -> [f32; 4] {
        if distance <= 0.0 {
            return self.start;
        }
        if distance >= self.length {
            return self.end;
        }
        let part = distance / self.length;
        [0, 1, 2, 3].map(|k| (f64::from(self.start[k]) * (1.0 - part) + f64::from(self.end[k]) * part) as f32)
    }
}

/// What has been drawn so far.
#[derive(Clone, Debug, Default)]
struct Pen {
    points: Vec<[f32; 4]>,
    lines: Vec<bool>,
    /// How many dashes there may still be.
    left: usize,
    /// Where on the line at hand the last dash ended; none if that is not on this line.
    at: Option<f64>,
}

impl Pen {
    /// Draws the dashes of a line whose start lies `phase` after the beginning of a repetition.
    fn line(&mut self, line: &Line, bounds: &[f64], period: f64, phase: f64) -> Result<(), PatternFault> {
        if line.length == 0.0 {
            let part = phase / period + TOLERANCE;
            let entry = bounds.windows(2).position(|entry| part < entry[1]);
            return if entry.is_some_and(|entry| entry % 2 == 0) { self.dash(line, 0.0, 0.0, 0.0) } else { Ok(()) };
        }
        let slack = line.slack(period);
        let mut repetition = 0.0;
        while repetition * period - phase < line.length - slack {
            for entry in bounds.windows(2).step_by(2) {
                let [from, to] = [entry[0], entry[1]].map(|bound| (repetition + bound) * period - phase);
                let dot = to - from <= slack;
                // Nothing of it is on this line, or no more than a rounding.
                if from >= line.length - slack || to < -slack || !dot && to <= slack {
                    continue;
                }
                let from = if from <= slack { 0.0 } else { from };
                self.dash(line, from, if to >= line.length - slack { line.length } else { to.max(0.0) }, slack)?;
            }
            repetition += 1.0;
        }
        self.at = (self.at == Some(line.length)).then_some(0.0);
        Ok(())
    }

    /// Draws one dash between two distances from the start of a line.
    fn dash(&mut self, line: &Line, from: f64, to: f64, slack: f64) -> Result<(), PatternFault> {
        self.left = self.left.checked_sub(1).ok_or(PatternFault::TooManyDashes)?;
        let end = line.at(to);
        match (self.at, self.points.last_mut()) {
            // The dash before it ended here, on the same line or at its corner.
            (Some(at), Some(last)) if from - at <= slack && at > 0.0 => *last = end,
            (Some(at), _) if from - at <= slack => self.put(end, true),
            _ => {
                self.put(line.at(from), false);
                self.put(end, true);
            }
        }
        self.at = Some(to);
        Ok(())
    }

    fn put(&mut self, point: [f32; 4], line: bool) {
        self.points.push(point);
        self.lines.push(line);
    }
}

#[cfg(test)]
mod tests;
