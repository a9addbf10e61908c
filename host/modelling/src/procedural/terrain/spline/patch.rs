//! One cell of a surface of biquadratic B-splines: its height and slope, and the first crossing of a segment.

use glam::DVec2;

/// Parts of a segment are halved so often at the most: until doubles tell nothing between their ends.
const MOST_HALVINGS: u32 = 52;
/// Steps of the search for a root, which halve its interval at the worst.
const MOST_STEPS: u32 = 80;

/// The height over a unit square as a polynomial of degree 2 along each side, by its Bezier control heights: rows along
/// z, entries along x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch([[f64; 3]; 3]);

impl Patch {
    /// The cell in the middle of nine control heights of B-splines, which stand above the middles of cells.
    pub(super) fn new(controls: [[f64; 3]; 3]) -> Patch {
        let bezier = |[before, own, after]: [f64; 3]| [0.5 * (before + own), own, 0.5 * (own + after)];
        let rows = controls.map(bezier);
        let columns: [[f64; 3]; 3] = std::array::from_fn(|x| bezier([rows[0][x], rows[1][x], rows[2][x]]));
        Patch(std::array::from_fn(|z| std::array::from_fn(|x| columns[x][z])))
    }

    /// The least and the greatest control height: the surface is between them.
    pub(super) fn range(&self) -> [f64; 2] {
        let all = || self.0.iter().flatten().copied();
        [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Bounds over a rectangle: its control heights as a patch of its own.
    #[cfg(test)]
    pub(super) fn range_over(&self, from: DVec2, to: DVec2) -> [f64; 2] {
        let rows = self.0.map(|row| blossoms(row, from.x, to.x));
        let columns = [0, 1, 2].map(|k| blossoms([rows[0][k], rows[1][k], rows[2][k]], from.y, to.y));
        Patch(columns).range()
    }

    /// The height, and its derivatives in sides of the cell.
    pub(super) fn height_and_slope(&self, at: DVec2) -> (f64, DVec2) {
        let line = |[a, b, c]: [f64; 3], t: f64| {
            let (one, two) = (mixed(a, b, t), mixed(b, c, t));
            (mixed(one, two, t), 2.0 * (two - one))
        };
        let rows = self.0.map(|row| line(row, at.x));
        let (height, along_z) = line(rows.map(|(height, _)| height), at.y);
        let (along_x, _) = line(rows.map(|(_, slope)| slope), at.y);
        (height, DVec2::new(along_x, along_z))
    }

    /// The height along a segment, a polynomial of degree 4 of the part of it that is passed, by its Bezier control
    /// heights.
    ///
    /// # Source
    /// Ramshaw 1987, blossoms: the polar form of the surface at both ends.
    pub(super) fn along(&self, from: DVec2, to: DVec2) -> [f64; 5] {
        let rows = self.0.map(|row| blossoms(row, from.x, to.x));
        let [first, mixture, last]: [[f64; 3]; 3] =
            std::array::from_fn(|k| blossoms([rows[0][k], rows[1][k], rows[2][k]], from.y, to.y));
        [
            first[0],
            0.5 * (first[1] + mixture[0]),
            (first[2] + 4.0 * mixture[1] + last[0]) / 6.0,
            0.5 * (mixture[2] + last[1]),
            last[2],
        ]
    }
}

/// A polynomial of degree 2 by its values at two places and its polar form between them.
fn blossoms([a, b, c]: [f64; 3], from: f64, to: f64) -> [f64; 3] {
    let polar = |one: f64, two: f64| mixed(mixed(a, b, one), mixed(b, c, one), two);
    [polar(from, from), polar(from, to), polar(to, to)]
}

/// Where a polynomial of degree 4, which begins at 0 or above, first becomes negative between 0 and 1; none where it
/// only touches 0.
///
/// - `points`: its Bezier control values.
///
/// # Source
/// Descartes' rule of signs for Bernstein polynomials: Lane and Riesenfeld 1981.
pub(super) fn first_negative(points: [f64; 5]) -> Option<f64> {
    if points[0] < 0.0 { Some(0.0) } else { first_negative_within(points, [0.0, 1.0], MOST_HALVINGS) }
}

fn first_negative_within(points: [f64; 5], [from, to]: [f64; 2], halvings: u32) -> Option<f64> {
    let first_below = points.iter().position(|point| *point < 0.0)?;
    if points[..first_below].iter().all(|point| *point == 0.0) {
        return Some(from);
    }
    let changes_once = points[first_below..].iter().all(|point| *point <= 0.0);
    if changes_once && points[4] < 0.0 {
        return Some(from + (to - from) * root(points));
    }
    if halvings == 0 {
        return (points[4] < 0.0).then_some(to);
    }
    let middle = from + 0.5 * (to - from);
    let [before, after] = halves(points);
    first_negative_within(before, [from, middle], halvings - 1)
        .or_else(|| first_negative_within(after, [middle, to], halvings - 1))
}

/// The one root between 0 and 1 of a polynomial that begins above 0 and ends below.
fn root(points: [f64; 5]) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = points[0] / (points[0] - points[4]);
    for _ in 0..MOST_STEPS {
        let (value, slope) = value_and_slope(points, t);
        if value == 0.0 {
            return t;
        }
        if value > 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 2.0 * f64::EPSILON * t || next <= low || next >= high {
            return next;
        }
        t = next;
    }
    t
}

fn value_and_slope([a, b, c, d, e]: [f64; 5], t: f64) -> (f64, f64) {
    let (a, b, c, d) = (mixed(a, b, t), mixed(b, c, t), mixed(c, d, t), mixed(d, e, t));
    let (a, b, c) = (mixed(a, b, t), mixed(b, c, t), mixed(c, d, t));
    let (a, b) = (mixed(a, b, t), mixed(b, c, t));
    (mixed(a, b, t), 4.0 * (b - a))
}

/// Control values of both halves.
fn halves([a, b, c, d, e]: [f64; 5]) -> [[f64; 5]; 2] {
    let middle = |a: f64, b: f64| 0.5 * (a + b);
    let (ab, bc, cd, de) = (middle(a, b), middle(b, c), middle(c, d), middle(d, e));
    let (abc, bcd, cde) = (middle(ab, bc), middle(bc, cd), middle(cd, de));
    let (abcd, bcde) = (middle(abc, bcd), middle(bcd, cde));
    let all = middle(abcd, bcde);
    [[a, ab, abc, abcd, all], [all, bcde, cde, de, e]]
}

fn mixed(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::RandomStream;

    fn random_patch(stream: &mut RandomStream) -> Patch {
        Patch::new(std::array::from_fn(|_| std::array::from_fn(|_| 2.0 * stream.uniform() - 1.0)))
    }

    #[test]
    fn heights_along_a_segment_are_those_of_the_surface() {
        let mut stream = RandomStream::new(4, 0);
        for _ in 0..200 {
            let patch = random_patch(&mut stream);
            let [from, to] = [0, 1].map(|_| DVec2::from(stream.point()));
            let points = patch.along(from, to);
            for k in 0..=10 {
                let t = f64::from(k) / 10.0;
                let (value, slope) = value_and_slope(points, t);
                let (height, gradient) = patch.height_and_slope(from + (to - from) * t);
                assert!((value - height).abs() < 1e-14 && (slope - gradient.dot(to - from)).abs() < 1e-13);
                let [low, high] = patch.range();
                assert!((low..=high).contains(&height));
            }
        }
    }

    #[test]
    fn the_first_root_is_the_one_that_a_scan_finds() {
        let mut stream = RandomStream::new(5, 0);
        let mut found = 0;
        for _ in 0..20_000 {
            let mut points: [f64; 5] = std::array::from_fn(|_| 2.0 * stream.uniform() - 1.0);
            points[0] = points[0].abs() * 0.2;
            const STEPS: usize = 400;
            let at = |k: usize| value_and_slope(points, k as f64 / STEPS as f64).0;
            let scanned = (1..=STEPS).find(|k| at(*k) < 0.0);
            match (first_negative(points), scanned) {
                (Some(t), Some(k)) => {
                    found += 1;
                    // The scan may step over two roots.
                    assert!(t <= k as f64 / STEPS as f64 && value_and_slope(points, t).0.abs() < 1e-14);
                    let is_first = (0..40).all(|k| value_and_slope(points, t * f64::from(k) / 40.0).0 > -1e-14);
                    assert!(is_first, "{points:?} {t}");
                }
                (Some(t), None) => assert!(value_and_slope(points, t).0.abs() < 1e-14),
                (None, Some(k)) => panic!("{points:?}: {k} was missed"),
                (None, None) => {}
            }
        }
        assert!(found > 10_000, "{found}");
    }

    #[test]
    fn what_touches_0_does_not_cross_it() {
        // (2t - 1)^2 and its square, lifted to degree 4.
        assert_eq!(first_negative([1.0, 0.0, -1.0 / 3.0, 0.0, 1.0]), None);
        assert_eq!(first_negative([0.0, 0.0, 0.0, 0.0, 0.0]), None);
        assert_eq!(first_negative([0.0, -1.0, 0.0, 1.0, 1.0]), Some(0.0));
        assert_eq!(first_negative([-1e-300, 1.0, 1.0, 1.0, 1.0]), Some(0.0));
    }
}
