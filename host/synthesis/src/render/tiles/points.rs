//! Points, and which of them lie on a line from one place to another.

use glam::DVec3;

/// Points in one leaf.
const FEW: usize = 8;

/// Points in boxes within boxes.
#[derive(Debug, Default)]
pub(super) struct PointTree {
    points: Vec<DVec3>,
    boxes: Vec<Enclosing>,
}

/// A box around some points.
#[derive(Clone, Copy, Debug)]
struct Enclosing {
    low: DVec3,
    high: DVec3,
    first: usize,
    count: usize,
    /// The two boxes into which it is divided; 0 for none.
    parts: [usize; 2],
}

impl PointTree {
    /// Takes points up.
    pub(super) fn new(points: Vec<DVec3>) -> PointTree {
        let mut all = PointTree { points, boxes: Vec::new() };
        if !all.points.is_empty() {
            all.enclose(0, all.points.len());
        }
        all
    }

    fn enclose(&mut self, first: usize, count: usize) -> usize {
        let part = &mut self.points[first..first + count];
        let (low, high) = part.iter().fold((part[0], part[0]), |(low, high), p| (low.min(*p), high.max(*p)));
        let place = self.boxes.len();
        self.boxes.push(Enclosing { low, high, first, count, parts: [0; 2] });
        if count > FEW {
            let size = high - low;
            let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
            let half = count / 2;
            part.select_nth_unstable_by(half, |a, b| a[axis].total_cmp(&b[axis]));
            self.boxes[place].parts = [self.enclose(first, half), self.enclose(first + half, count - half)];
        }
        place
    }

    /// The points between two others that are no farther than `near` from the line, with the part of the way from the
    /// first to the second, in their order.
    pub(super) fn between(&self, [from, to]: [DVec3; 2], near: f64) -> Vec<(f64, DVec3)> {
        let mut found = Vec::new();
        if !self.boxes.is_empty() {
            self.collect(0, [from, to], near, &mut found);
        }
        found.sort_by(|a: &(f64, DVec3), b| a.0.total_cmp(&b.0));
        found
    }

    fn collect(&self, place: usize, [from, to]: [DVec3; 2], near: f64, found: &mut Vec<(f64, DVec3)>) {
        let Enclosing { low, high, first, count, parts } = self.boxes[place];
        let along = to - from;
        let (mut begin, mut end) = (0.0f64, 1.0f64);
        for axis in 0..3 {
            let sides = [low[axis] - near - from[axis], high[axis] + near - from[axis]];
            if along[axis] == 0.0 {
                if sides[0] > 0.0 || sides[1] < 0.0 {
                    return;
                }
                continue;
            }
            let [a, b] = sides.map(|side| side / along[axis]);
            (begin, end) = (begin.max(a.min(b)), end.min(a.max(b)));
        }
        if begin > end {
            return;
        }
        if parts != [0; 2] {
            return parts.into_iter().for_each(|part| self.collect(part, [from, to], near, found));
        }
        for point in &self.points[first..first + count] {
            let part = (*point - from).dot(along) / along.length_squared();
            if *point != from && *point != to && part > 0.0 && part < 1.0 && point.distance(from + along * part) <= near
            {
                found.push((part, *point));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_line_are_found_in_their_order_and_no_others() {
        let step = |k: usize| k as f64 / 16.0;
        let grid = (0..17).flat_map(|i| (0..17).map(move |k| DVec3::new(step(i), step(k), step((i * k) % 5))));
        let points: Vec<DVec3> = grid.collect();
        let all = PointTree::new(points.clone());
        for (from, to) in [(0, 288), (3, 200), (17, 33), (16, 272), (40, 41), (5, 5)] {
            let ends = [points[from], points[to]];
            let along = ends[1] - ends[0];
            let mut expected: Vec<f64> = points
                .iter()
                .map(|point| (*point, (*point - ends[0]).dot(along) / along.length_squared()))
                .filter(|(point, part)| {
                    *part > 0.0 && *part < 1.0 && (ends[0] + along * *part - *point).length() < 1e-9
                })
                .filter(|(point, _)| !ends.contains(point))
                .map(|(_, part)| part)
                .collect();
            expected.sort_by(f64::total_cmp);
            let found: Vec<f64> = all.between(ends, 1e-9).into_iter().map(|(part, _)| part).collect();
            assert_eq!(found, expected, "{from} {to}");
        }
        assert!(PointTree::new(Vec::new()).between([DVec3::ZERO, DVec3::X], 1.0).is_empty());
    }
}
