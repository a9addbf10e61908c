//! Polygons to spans: which samples of a line a polygon covers, and how near it is there.

use super::screen::ScreenPoint;
use std::ops::Range;

/// Most lines of samples that are drawn together.
pub(super) const MOST_LINES: usize = 64;

/// Where in a pixel the sample of each line lies, 0..1 from the left: one sample in each row and column of a grid of as
/// many rows and columns, which lie apart like multiples of the golden section.
///
/// # Source
/// The n rooks of Shirley 1991; which of them: ours.
pub(super) fn rooks(samples: u32) -> Vec<f64> {
    let golden = (5f64.sqrt() - 1.0) / 2.0;
    let key = |line: u32| (f64::from(line + 1) * golden).fract();
    let mut order: Vec<u32> = (0..samples).collect();
    order.sort_by(|a, b| key(*a).total_cmp(&key(*b)));
    let mut offsets = vec![0.5; samples as usize];
    for (rank, line) in order.into_iter().enumerate() {
        offsets[line as usize] = (rank as f64 + 0.5) / f64::from(samples);
    }
    offsets
}

/// By how much nearness may be rounded where it is estimated, as a fraction.
const ROUNDING: f64 = 1e-9;

/// Samples of a line that a polygon covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    /// Number of the line, from the top of the picture.
    pub(super) line: usize,
    /// From this column.
    pub(super) from: usize,
    /// Up to and without this one.
    pub(super) to: usize,
    /// 1 where the polygon turns clockwise as it is seen, else -1.
    pub(super) turns: i32,
}

/// Lines that are drawn together.
#[derive(Clone, Debug)]
pub(super) struct SampleLines {
    /// Numbers of the lines, [`MOST_LINES`] at the most.
    pub(super) range: Range<usize>,
    /// Columns.
    pub(super) width: usize,
    /// Places of the samples of each line in their pixels.
    offsets: [f64; MOST_LINES],
}

/// The part of the picture in which a polygon is wanted: columns, and lines.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PictureRegion {
    pub(super) columns: Range<usize>,
    pub(super) lines: Range<usize>,
}

impl PictureRegion {
    /// All of the picture.
    pub(super) const ALL: PictureRegion = PictureRegion { columns: 0..usize::MAX, lines: 0..usize::MAX };
}

impl SampleLines {
    /// - `range`: which lines; `width`: how many columns. `offsets`: where samples lie in their pixels, for each line
    ///   of a row of pixels.
    pub(super) fn new(range: Range<usize>, width: usize, offsets: &[f64]) -> SampleLines {
        let offset = |i: usize| offsets[(range.start + i) % offsets.len()];
        SampleLines { offsets: std::array::from_fn(offset), range, width }
    }

    /// Places of the samples of a line in their pixels.
    #[inline]
    pub(super) fn offset(&self, line: usize) -> f64 {
        self.offsets[line - self.range.start]
    }

    /// Gives the spans of a convex polygon within a part of the picture.
    ///
    /// Sides that two polygons share are crossed at the same place bit by bit: no sample between them is lost or found
    /// twice.
    #[inline]
    pub(super) fn spans(&self, corners: &[ScreenPoint], within: &PictureRegion, mut give: impl FnMut(Span)) {
        if rises_once(corners) {
            self.monotone(corners, within, &mut give);
        } else {
            // Rounding has dented it: triangles cannot be dented, and what they share cancels out.
            for pair in corners[1..].windows(2) {
                self.monotone(&[corners[0], pair[0], pair[1]], within, &mut give);
            }
        }
    }

    #[inline]
    fn monotone(&self, corners: &[ScreenPoint], within: &PictureRegion, give: &mut impl FnMut(Span)) {
        let range = self.range.start.max(within.lines.start)..self.range.end.min(within.lines.end);
        let columns = within.columns.start.min(self.width)..within.columns.end.min(self.width);
        if columns.is_empty() {
            return;
        }
        let mut crossings = [[0.0; 2]; MOST_LINES];
        let (mut first, mut last) = (usize::MAX, 0);
        let mut from = corners[corners.len() - 1];
        for &to in corners {
            let falls = usize::from(to.y < from.y);
            let [low, high] = if falls == 1 { [to, from] } else { [from, to] };
            let begin = up(low.y).max(range.start);
            let end = up(high.y).min(range.end);
            if begin < end {
                let slope = (high.x - low.x) / (high.y - low.y);
                for line in begin..end {
                    crossings[line - self.range.start][falls] = low.x + (line as f64 - low.y) * slope;
                }
                (first, last) = (first.min(begin), last.max(end));
            }
            from = to;
        }
        for line in first.min(last)..last {
            let [rising, falling] = crossings[line - self.range.start];
            let offset = self.offset(line);
            let [a, b] = [rising, falling].map(|x| up(x - offset).clamp(columns.start, columns.end));
            if a < b {
                give(Span { line, from: a, to: b, turns: -1 });
            } else if b < a {
                give(Span { line, from: b, to: a, turns: 1 });
            }
        }
    }
}

/// Whether the corners go down and up once only.
#[inline]
fn rises_once(corners: &[ScreenPoint]) -> bool {
    if corners.len() <= 3 {
        return true;
    }
    let mut changes = 0;
    let mut from = corners[corners.len() - 1];
    let mut rose = from.y >= corners[corners.len() - 2].y;
    for &to in corners {
        let rises = if to.y == from.y { rose } else { to.y > from.y };
        changes += u32::from(rises != rose);
        (rose, from) = (rises, to);
    }
    changes <= 2
}

/// The least whole number that is not below, 0 and more.
#[inline]
fn up(value: f64) -> usize {
    let whole = value as i32;
    (whole + i32::from(f64::from(whole) < value)).max(0) as usize
}

/// Nearness over the picture: linear, and never beyond that of the corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nearness {
    at: ScreenPoint,
    by_column: f64,
    by_line: f64,
    least: f64,
    most: f64,
}

impl Nearness {
    /// Through the corners of a polygon in a plane; none if it is seen edge on.
    #[inline]
    pub(super) fn new(corners: &[ScreenPoint]) -> Option<Nearness> {
        let at = corners[0];
        let apart = |p: &ScreenPoint| (p.x - at.x, p.y - at.y, p.near - at.near);
        // The fan of the whole polygon: thin ends count little.
        let (mut area, mut by_column, mut by_line) = (0.0, 0.0, 0.0);
        let (mut least, mut most) = (at.near, at.near);
        let mut before = apart(&corners[1]);
        for p in &corners[2..] {
            let next = apart(p);
            area += before.0 * next.1 - before.1 * next.0;
            by_column += before.2 * next.1 - before.1 * next.2;
            by_line += before.0 * next.2 - before.2 * next.0;
            before = next;
        }
        for p in &corners[1..] {
            (least, most) = (least.min(p.near), most.max(p.near));
        }
        let nearness = Nearness { at, by_column: by_column / area, by_line: by_line / area, least, most };
        (nearness.by_column.is_finite() && nearness.by_line.is_finite()).then_some(nearness)
    }

    /// Along a span: nearness at its first sample, what each sample adds, and whether it has to be kept within bounds.
    ///
    /// - `offset`: where samples lie in their pixels.
    #[inline]
    pub(super) fn along(&self, span: &Span, offset: f64) -> (f64, f64, bool) {
        let start = self.at.near
            + self.by_column * (span.from as f64 + offset - self.at.x)
            + self.by_line * (span.line as f64 - self.at.y);
        let end = start + self.by_column * (span.to - 1 - span.from) as f64;
        let bounded = start.min(end) < self.least || start.max(end) > self.most;
        (start, self.by_column, bounded)
    }

    /// The greatest in a rectangle.
    #[inline]
    pub(super) fn most(&self, columns: [f64; 2], lines: [f64; 2]) -> f64 {
        let along = |slope: f64, [from, to]: [f64; 2], at: f64| (slope * (from - at)).max(slope * (to - at));
        let parts = [self.at.near, along(self.by_column, columns, self.at.x), along(self.by_line, lines, self.at.y)];
        let error = ROUNDING * parts.iter().map(|part| part.abs()).sum::<f64>();
        self.bound(parts.iter().sum::<f64>() + error)
    }

    /// Keeps a value within bounds.
    #[inline]
    pub(super) fn bound(&self, value: f64) -> f64 {
        value.clamp(self.least, self.most)
    }
}
