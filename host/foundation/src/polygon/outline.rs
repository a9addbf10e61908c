//! The contours of a polygon prepared for the sweep: scaled, without useless corners, sorted.

use glam::DVec2;

use super::error::{PolygonEdge, PolygonError};
use crate::numeric::predicates::turn;

/// The greatest coordinate after scaling is about two to this power. Then products of four differences do not overflow.
const SCALE_EXPONENT: i32 = 200;

/// All coordinates become multiples of two to this power, so that products of four differences do not underflow either
/// and every sign is exact. Only coordinates below 2^-367 of the greatest are rounded at all.
const GRID_EXPONENT: i32 = -220;

/// The corners that matter, ranked by x, then y, then index. An edge bears the rank of the corner where it begins.
pub(super) struct Outline {
    /// All corners of all contours, scaled by a power of two.
    pub corners: Vec<DVec2>,
    /// By rank: the position.
    pub points: Vec<DVec2>,
    /// By rank: the corner.
    pub originals: Vec<u32>,
    /// By rank: the rank of the corner before it in its contour.
    pub before: Vec<u32>,
    /// By rank: the rank of the corner after it in its contour.
    pub after: Vec<u32>,
    /// For each contour its first corner.
    starts: Vec<usize>,
}

impl Outline {
    pub fn of<C: AsRef<[DVec2]>>(contours: &[C]) -> Result<Outline, PolygonError> {
        let (corners, starts) = scaled(contours)?;
        let mut outline = Outline {
            points: Vec::new(),
            originals: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
            corners,
            starts,
        };
        let mut turning = Vec::with_capacity(outline.corners.len());
        let mut ends = Vec::with_capacity(contours.len());
        let mut distinct = Vec::new();
        for contour in 0..contours.len() {
            outline.append_turning(contour, &mut distinct, &mut turning)?;
            ends.push(turning.len());
        }
        outline.rank(&turning, &ends);
        Ok(outline)
    }

    /// The number of corners that were left out.
    pub fn dropped(&self) -> usize {
        self.corners.len() - self.points.len()
    }

    /// The name of the edge that begins at a rank.
    pub fn edge(&self, rank: u32) -> PolygonEdge {
        self.edge_from(self.originals[rank as usize] as usize)
    }

    fn edge_from(&self, corner: usize) -> PolygonEdge {
        let contour = self.starts.partition_point(|&start| start <= corner) - 1;
        PolygonEdge { contour, corner: corner - self.starts[contour] }
    }

    /// Appends the corners of a contour where it turns.
    fn append_turning(
        &self,
        contour: usize,
        distinct: &mut Vec<u32>,
        turning: &mut Vec<u32>,
    ) -> Result<(), PolygonError> {
        let end = self.starts.get(contour + 1).copied().unwrap_or(self.corners.len());
        let at = |index: u32| self.corners[index as usize];
        distinct.clear();
        for corner in self.starts[contour] as u32..end as u32 {
            if distinct.last().is_none_or(|&last| at(last) != at(corner)) {
                distinct.push(corner);
            }
        }
        while distinct.len() > 1 && at(distinct[0]) == at(distinct[distinct.len() - 1]) {
            distinct.pop();
        }
        let count = distinct.len();
        if count < 3 {
            return Err(PolygonError::TooFewCorners { contour, corners: count });
        }
        let first_kept = turning.len();
        let mut folded = None;
        let mut previous = distinct[count - 1];
        for (position, &here) in distinct.iter().enumerate() {
            let next = distinct[if position + 1 == count { 0 } else { position + 1 }];
            let [a, b, c] = [previous, here, next].map(at);
            if turn(a, b, c) != 0.0 {
                turning.push(here);
            } else if precedes(a, b) != precedes(b, c) {
                folded = folded.or(Some((previous, here)));
            }
            previous = here;
        }
        match folded {
            _ if turning.len() == first_kept => Err(PolygonError::NoArea { contour }),
            Some((first, second)) => {
                let [first, second] = [first, second].map(|corner| self.edge_from(corner as usize));
                Err(PolygonError::Overlap { first, second })
            }
            None => Ok(()),
        }
    }

    /// Sorts the corners where contours turn and links them by rank. `ends`: where each contour ends in `turning`.
    fn rank(&mut self, turning: &[u32], ends: &[usize]) {
        let order = sorted(&self.corners, turning);
        let mut rank_of = vec![0_u32; turning.len()];
        for (rank, &position) in order.iter().enumerate() {
            rank_of[position as usize] = rank as u32;
        }
        self.originals = order.iter().map(|&position| turning[position as usize]).collect();
        self.points = self.originals.iter().map(|&corner| self.corners[corner as usize]).collect();
        self.before = vec![0; turning.len()];
        self.after = vec![0; turning.len()];
        let mut begin = 0;
        for &end in ends {
            let mut previous = rank_of[end - 1];
            for &rank in &rank_of[begin..end] {
                self.before[rank as usize] = previous;
                self.after[previous as usize] = rank;
                previous = rank;
            }
            begin = end;
        }
    }
}

/// Whether the sweep comes to `a` before `b`.
pub(super) fn precedes(a: DVec2, b: DVec2) -> bool {
    a.x < b.x || a.x == b.x && a.y < b.y
}

/// All corners in one scale, and where each contour begins.
fn scaled<C: AsRef<[DVec2]>>(contours: &[C]) -> Result<(Vec<DVec2>, Vec<usize>), PolygonError> {
    let count = contours.iter().map(|contour| contour.as_ref().len()).sum();
    // Three links for each corner must have an index below the greatest of 32 bits.
    if count > u32::MAX as usize / 4 {
        return Err(PolygonError::TooManyCorners { corners: count });
    }
    let mut corners: Vec<DVec2> = Vec::with_capacity(count);
    let mut starts = Vec::with_capacity(contours.len());
    let mut greatest = 0.0_f64;
    for (contour, loop_corners) in contours.iter().enumerate() {
        starts.push(corners.len());
        for (corner, point) in loop_corners.as_ref().iter().enumerate() {
            if !point.is_finite() {
                return Err(PolygonError::NotFinite { contour, corner });
            }
            greatest = greatest.max(point.x.abs()).max(point.y.abs());
            corners.push(*point);
        }
    }
    // Two steps, since one factor may not be representable.
    let shift = SCALE_EXPONENT - exponent(greatest);
    let (first, second) = (shift / 2, shift - shift / 2);
    let (first, second) = (2.0_f64.powi(first), 2.0_f64.powi(second));
    for corner in &mut corners {
        *corner = on_grid(*corner * first * second);
    }
    Ok((corners, starts))
}

fn on_grid(point: DVec2) -> DVec2 {
    let (grid, inverse) = (2.0_f64.powi(GRID_EXPONENT), 2.0_f64.powi(-GRID_EXPONENT));
    // Larger numbers have no digits below the grid. Adding zero makes negative zero positive: equal points have equal
    // bits.
    if point.abs().min_element() > grid * 2.0_f64.powi(53) {
        point
    } else {
        (point * inverse).round() * grid + DVec2::ZERO
    }
}

/// The power of two at or below a number; that of the smallest normal number for less.
fn exponent(number: f64) -> i32 {
    ((number.to_bits() >> 52 & 0x7ff) as i32 - 1023).max(-1022)
}

/// The positions in `turning` in the order of the sweep.
fn sorted(corners: &[DVec2], turning: &[u32]) -> Vec<u32> {
    // Whole numbers compare without branches: the sort is several times faster than by coordinates.
    let key = |number: f64| {
        let bits = number.to_bits();
        bits ^ ((bits as i64 >> 63) as u64 | 1 << 63)
    };
    let at = |position: u32| corners[turning[position as usize] as usize];
    let mut keys: Vec<(u64, u32)> = (0..turning.len() as u32).map(|position| (key(at(position).x), position)).collect();
    keys.sort_unstable_by_key(|&(x, _)| x);
    for column in keys.chunk_by_mut(|a, b| a.0 == b.0).filter(|column| column.len() > 1) {
        column.iter_mut().for_each(|(x, position)| *x = key(at(*position).y));
        column.sort_unstable();
    }
    keys.into_iter().map(|(_, position)| position).collect()
}
