//! Joining one spline surface to another along a side.

use glam::{DVec3, DVec4};

use super::continuity::SurfaceSide;
use super::{Direction, SplineSurface};
use crate::curve::{Basis, ControlPoint, SplineError};

/// How smoothly surfaces meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Smoothness {
    /// In a common curve.
    G0,
    /// With a common tangent plane.
    G1,
    /// With a common curvature.
    G2,
}

/// A fault that keeps two surfaces from being joined.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JoinError {
    /// Sides of different kinds.
    #[error("the sides differ in degree, joints or parameters: {first} and {second} control points")]
    Sides {
        /// Control points along the first side.
        first: usize,
        /// Control points along the second.
        second: usize,
    },
    /// Too few rows, or too low a degree, for the smoothness.
    #[error("{smoothness:?} needs degree {needed} across the side, the second surface has {degree}")]
    Degree {
        /// What was asked for.
        smoothness: Smoothness,
        /// The degree that it takes.
        needed: usize,
        /// The degree of the second surface.
        degree: usize,
    },
    /// A weight that would have to be zero or negative.
    #[error("control point {column} of row {row} from the side would need the weight {weight}")]
    Weight {
        /// The row, 0 at the side.
        row: usize,
        /// The place in the row.
        column: usize,
        /// The weight.
        weight: f64,
    },
    /// A surface that cannot be brought to the form that joining takes.
    #[error(transparent)]
    Spline(#[from] SplineError),
}

/// The rows of control points parallel to a side, the nearest first, of a surface that passes through the first.
struct Rows {
    lines: Vec<Vec<ControlPoint>>,
    /// The first three Bezier points across the side, as weighted sums of the rows.
    bezier: Vec<Vec<(usize, f64)>>,
    degree: f64,
    /// The length in parameters of the span at the side.
    length: f64,
}

fn across(side: SurfaceSide) -> Direction {
    if matches!(side, SurfaceSide::LowU | SurfaceSide::HighU) { Direction::U } else { Direction::V }
}

fn homogeneous(control: ControlPoint) -> DVec4 {
    (control.point * control.weight).extend(control.weight)
}

impl Rows {
    fn of(surface: &SplineSurface, side: SurfaceSide) -> Rows {
        let [rows, columns] = surface.counts();
        let direction = across(side);
        let basis: &Basis = surface.basis(direction);
        let count = basis.control_count();
        let from_side = |k: usize| if side.is_high() { count - 1 - k } else { k };
        let line = |k: usize| -> Vec<ControlPoint> {
            match direction {
                Direction::U => (0..columns).map(|j| surface.control()[from_side(k) * columns + j]).collect(),
                Direction::V => (0..rows).map(|i| surface.control()[i * columns + from_side(k)]).collect(),
            }
        };
        let (form, degree) = (basis.form(), basis.degree());
        let (span, last) = if side.is_high() { (form.spans() - 1, degree) } else { (0, 0) };
        let bezier = (0..=degree.min(2)).map(|k| {
            let row = &form.rows[form.index(span, last.abs_diff(k))];
            row.terms(count).map(|(index, weight)| (from_side(index), weight)).collect()
        });
        Rows {
            bezier: bezier.collect(),
            lines: (0..count).map(line).collect(),
            degree: degree as f64,
            length: form.breaks[span + 1] - form.breaks[span],
        }
    }

    /// Position, first and second derivative by the way from the side inwards, in homogeneous coordinates.
    fn jet(&self, column: usize) -> [DVec4; 3] {
        let point = |k: usize| -> DVec4 {
            let terms = self.bezier.get(k).into_iter().flatten();
            terms.map(|(row, weight)| homogeneous(self.lines[*row][column]) * *weight).sum()
        };
        let [a, b, c] = [0, 1, 2].map(point);
        let (rate, second) = (self.degree / self.length, (self.degree - 1.0) / self.length);
        [a, (b - a) * rate, if self.bezier.len() > 2 { ((c - b) - (b - a)) * (rate * second) } else { DVec4::ZERO }]
    }

    /// Changes the first rows so that the derivatives are as in `jet`, as many as it has.
    fn set(&mut self, column: usize, jet: &[DVec4]) -> Result<(), JoinError> {
        let step = self.length / self.degree;
        let second = step * self.length / (self.degree - 1.0);
        let mut targets = vec![jet[0]];
        targets.extend(jet.get(1).map(|first| jet[0] + *first * step));
        targets.extend(jet.get(2).map(|bend| targets[1] * 2.0 - jet[0] + *bend * second));
        let is_polynomial = jet.iter().enumerate().all(|(k, term)| term.w == if k == 0 { 1.0 } else { 0.0 })
            && self.lines.iter().all(|line| line[column].weight == 1.0);
        for (row, target) in targets.into_iter().enumerate().skip(1) {
            // The surface passes through its first row: the Bezier point k depends on the first k + 1 rows alone.
            let others = self.bezier[row].iter().filter(|(other, _)| *other < row);
            let rest: DVec4 = others.map(|(other, part)| homogeneous(self.lines[*other][column]) * *part).sum();
            let own: f64 = self.bezier[row].iter().filter(|(other, _)| *other == row).map(|(_, part)| *part).sum();
            let found = (target - rest) / own;
            let weight = if is_polynomial { 1.0 } else { found.w };
            if !(weight > 0.0 && found.is_finite()) {
                return Err(JoinError::Weight { row, column, weight });
            }
            self.lines[row][column] = ControlPoint { point: found.truncate() / weight, weight };
        }
        Ok(())
    }
}

/// Joins `second` to `first`: the rows of control points of `second` at `sides[1]` are changed so that it meets
/// `sides[0]` of `first` as smoothly as asked.
///
/// Both come back passing through their outer rows, `first` otherwise unchanged; `second` has both its parameters
/// reversed if its side runs the other way. G0 changes one row, G1 two, G2 three; how fast and how unevenly the
/// parameter advances across the joint (its bias and tension) is taken from `second` as it was. The outsides must
/// agree.
///
/// # Errors
/// [`JoinError`] if the two sides are splines of different kinds, the degree is too low, or weights would not be
/// positive.
pub fn joined(
    first: &SplineSurface,
    second: &SplineSurface,
    sides: [SurfaceSide; 2],
    smoothness: Smoothness,
) -> Result<[SplineSurface; 2], JoinError> {
    let first = first.with_passing_sides(across(sides[0]))?;
    let mut second = second.with_passing_sides(across(sides[1]))?;
    let mut side = sides[1];
    let fixed = Rows::of(&first, sides[0]);
    let (length, found) = (fixed.lines[0].len(), Rows::of(&second, side).lines[0].len());
    if length != found {
        return Err(JoinError::Sides { first: length, second: found });
    }
    if runs_against(&fixed.lines[0], &Rows::of(&second, side).lines[0]) {
        second = second.reversed(Direction::U).reversed(Direction::V);
        side = side.opposite();
    }
    let along = first.basis(across(sides[0]).other());
    if !along.agrees_with(second.basis(across(side).other())) {
        return Err(JoinError::Sides { first: length, second: found });
    }
    let order = smoothness as usize;
    let degree = second.basis(across(side)).degree();
    if degree < order {
        return Err(JoinError::Degree { smoothness, needed: order, degree });
    }
    let mut moved = Rows::of(&second, side);
    moved.fit(&fixed, order)?;
    let [rows, columns] = second.counts();
    let mut control = Vec::with_capacity(rows * columns);
    for i in 0..rows {
        for j in 0..columns {
            let (line, column, count) = if across(side) == Direction::U { (i, j, rows) } else { (j, i, columns) };
            control.push(moved.lines[if side.is_high() { count - 1 - line } else { line }][column]);
        }
    }
    // With the very basis of the first along the side, it is the same curve to the bit.
    let basis = |direction| if direction == across(side) { second.basis(direction) } else { along };
    let bases = [Direction::U, Direction::V].map(|direction| basis(direction).clone());
    Ok([first, SplineSurface::of(bases, control)])
}

impl Rows {
    /// Changes the first `order` + 1 rows so that they continue `fixed`.
    fn fit(&mut self, fixed: &Rows, order: usize) -> Result<(), JoinError> {
        let count = self.lines[0].len();
        // Outwards from the first surface is inwards into the second.
        let outward: Vec<[DVec4; 3]> = (0..count).map(|k| fixed.jet(k)).map(|[a, b, c]| [a, -b, c]).collect();
        let own: Vec<[DVec4; 3]> = (0..count).map(|k| self.jet(k)).collect();
        let affine = |jet: &[DVec4; 3]| {
            let origin = jet[0] / jet[0].w;
            (jet[1] - origin * jet[1].w).truncate() / jet[0].w
        };
        let speed = |jets: &[[DVec4; 3]]| jets.iter().map(|jet| affine(jet).length()).sum::<f64>();
        let bias = speed(&own) / speed(&outward);
        let bias = if bias.is_finite() && bias > 0.0 { bias } else { 1.0 };
        let bends = outward.iter().zip(&own).map(|(b, c)| {
            let bend: DVec3 = (c[2] - b[2] * (bias * bias)).truncate();
            (bend.dot(b[1].truncate()), b[1].truncate().length_squared())
        });
        let (dot, square) = bends.fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1));
        let tension = if square > 0.0 { dot / square } else { 0.0 };
        for (column, [a, b, c]) in outward.into_iter().enumerate() {
            self.lines[0][column] = fixed.lines[0][column];
            self.set(column, &[a, b * bias, c * (bias * bias) + b * tension][..=order])?;
        }
        Ok(())
    }
}

/// Whether two rows of points fit better if one is reversed.
fn runs_against(a: &[ControlPoint], b: &[ControlPoint]) -> bool {
    let gaps = |b: &mut dyn Iterator<Item = &ControlPoint>| -> f64 {
        a.iter().zip(b).map(|(a, b)| a.point.distance(b.point)).sum()
    };
    gaps(&mut b.iter().rev()) < gaps(&mut b.iter())
}
