//! The kinds of splines, in one direction: what turns control points into Bezier curves.

use serde::{Deserialize, Serialize};

use super::SplineError;
use super::bbb::Bbb;
use super::bezier::check_degree;
use super::control::{ControlCombination, ControlPoint};
use super::form::{BezierForm, apply};
use super::knots::Knots;

/// One direction of a spline: its kind, its parameters, and the Bezier form that follows from them.
///
/// Every kind has Bezier points that are convex combinations of a few neighbouring control points, with sum 1: the
/// spline lies in the convex hull of its control points, follows affine maps, and changes only near what is changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Kind", into = "Kind")]
pub struct Basis {
    kind: Kind,
    form: BezierForm,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Kind {
    Knots(Knots),
    Bbb(Bbb),
}

impl TryFrom<Kind> for Basis {
    type Error = SplineError;

    fn try_from(kind: Kind) -> Result<Basis, SplineError> {
        match kind {
            Kind::Knots(knots) => Basis::of_knots(knots.checked()?).checked(),
            Kind::Bbb(bbb) => Basis::of_bbb(bbb.checked()?).checked(),
        }
    }
}

impl From<Basis> for Kind {
    fn from(basis: Basis) -> Kind {
        basis.kind
    }
}

/// Another basis for the same curve, and the steps that lead to its control points.
pub(crate) struct Refinement {
    pub basis: Basis,
    steps: Vec<Vec<ControlCombination>>,
}

impl Refinement {
    /// The new control points for those before.
    pub fn control(&self, control: &[ControlPoint]) -> Vec<ControlPoint> {
        self.steps.iter().fold(control.to_vec(), |control, rows| apply(rows, &control))
    }

    fn then(mut self, next: Refinement) -> Refinement {
        self.steps.extend(next.steps);
        Refinement { basis: next.basis, steps: self.steps }
    }
}

impl Basis {
    fn of_knots(knots: Knots) -> Basis {
        Basis { form: knots.form(), kind: Kind::Knots(knots) }
    }

    fn of_bbb(bbb: Bbb) -> Basis {
        Basis { form: bbb.form(), kind: Kind::Bbb(bbb) }
    }

    fn checked(self) -> Result<Basis, SplineError> {
        self.form.check_spans().map(|()| self)
    }

    /// A single Bezier curve, parameters 0..=1.
    ///
    /// # Errors
    /// [`SplineError::Degree`].
    pub fn bezier(degree: usize) -> Result<Basis, SplineError> {
        Basis::clamped(degree, degree.saturating_add(1))
    }

    /// A B-spline over `knots`: as many as control points and `degree` + 1 more. The domain begins and ends `degree`
    /// knots from the ends of the list; a knot there may occur `degree` + 1 times, one inside `degree` times.
    ///
    /// # Errors
    /// [`SplineError`] with the knot that is wrong.
    pub fn b_spline(degree: usize, knots: &[f64]) -> Result<Basis, SplineError> {
        Basis::of_knots(Knots::new(degree, knots.to_vec(), false)?).checked()
    }

    /// A closed B-spline: `knots` are those of one period with its end, one more than control points. Control point i has
    /// influence from knot i to knot i + `degree` + 1.
    ///
    /// # Errors
    /// [`SplineError`] with the knot that is wrong.
    pub fn closed_b_spline(degree: usize, knots: &[f64]) -> Result<Basis, SplineError> {
        Basis::of_knots(Knots::new(degree, knots.to_vec(), true)?).checked()
    }

    /// The uniform B-spline of `count` control points, parameters 0..=`count` - `degree`.
    ///
    /// # Errors
    /// [`SplineError`] if the degree or the number of points does not fit.
    pub fn uniform(degree: usize, count: usize) -> Result<Basis, SplineError> {
        check_degree(degree)?;
        Basis::check_count(count, degree + 1)?;
        Basis::b_spline(degree, &(0..=count + degree).map(|k| k as f64 - degree as f64).collect::<Vec<_>>())
    }

    /// The closed uniform B-spline of `count` control points, parameters 0..=`count`.
    ///
    /// # Errors
    /// [`SplineError`] if the degree or the number of points does not fit.
    pub fn closed_uniform(degree: usize, count: usize) -> Result<Basis, SplineError> {
        check_degree(degree)?;
        Basis::check_count(count, degree + 1)?;
        Basis::closed_b_spline(degree, &(0..=count).map(|k| k as f64).collect::<Vec<_>>())
    }

    /// The B-spline of `count` control points that passes through the first and the last, with equal spans between,
    /// parameters 0..=`count` - `degree`.
    ///
    /// # Errors
    /// [`SplineError`] if the degree or the number of points does not fit.
    pub fn clamped(degree: usize, count: usize) -> Result<Basis, SplineError> {
        check_degree(degree)?;
        Basis::check_count(count, degree + 1)?;
        let knot = |k: usize| k.clamp(degree, count) as f64 - degree as f64;
        Basis::b_spline(degree, &(0..=count + degree).map(knot).collect::<Vec<_>>())
    }

    fn check_count(found: usize, least: usize) -> Result<(), SplineError> {
        let what = "control points";
        if found < least {
            return Err(SplineError::TooFew { what, found, least });
        }
        if found > MAX_CONTROL { Err(SplineError::TooMany { what, found, most: MAX_CONTROL }) } else { Ok(()) }
    }

    /// The cubic BBB-spline with a bias and a tension for each control point and an interval before and after each.
    ///
    /// The joint that belongs to a control point has its bias (1e-9..=1e9, 1 in a B-spline) and its tension (0..=1e12, 0
    /// in a B-spline). `intervals` is one longer than the others: interval i lies before joint i and interval i + 1 after
    /// it; each is 0 or within 1e-12..=1e12. The curve runs from joint 1 to the last but one. Two zero intervals at
    /// either end make it begin and end in the control points there; two zeros in a row make it pass through the control
    /// point between them; three are refused. A bias or a tension changes the two spans on either side of its joint; an
    /// interval changes its span and two on either side.
    ///
    /// With one bias and one tension and equal intervals it is the Beta-spline; with bias 1 and tension 0 the cubic
    /// B-spline whose knots lie the intervals apart (without the first and the last knot, which have no influence); with
    /// two zero intervals between those of length above zero, Bezier curves.
    ///
    /// # Errors
    /// [`SplineError`] with the joint or interval that is wrong.
    pub fn bbb(bias: &[f64], tension: &[f64], intervals: &[f64]) -> Result<Basis, SplineError> {
        Basis::of_bbb(Bbb::new(bias.to_vec(), tension.to_vec(), intervals.to_vec(), false)?).checked()
    }

    /// The closed BBB-spline, as [`Basis::bbb`] but with as many intervals as joints, and a curve that begins and ends
    /// in joint 0. Interval 0 lies between the last joint and the first.
    ///
    /// # Errors
    /// [`SplineError`] with the joint or interval that is wrong.
    pub fn closed_bbb(bias: &[f64], tension: &[f64], intervals: &[f64]) -> Result<Basis, SplineError> {
        Basis::of_bbb(Bbb::new(bias.to_vec(), tension.to_vec(), intervals.to_vec(), true)?).checked()
    }

    /// The Beta-spline of `count` control points: one bias and one tension for all joints, intervals of 1.
    ///
    /// # Errors
    /// [`SplineError`] if a parameter is out of range.
    ///
    /// # Source
    /// Barsky 1981.
    pub fn beta(count: usize, bias: f64, tension: f64) -> Result<Basis, SplineError> {
        Basis::check_count(count, 4)?;
        Basis::bbb(&vec![bias; count], &vec![tension; count], &vec![1.0; count + 1])
    }

    /// The closed Beta-spline of `count` control points.
    ///
    /// # Errors
    /// [`SplineError`] if a parameter is out of range.
    pub fn closed_beta(count: usize, bias: f64, tension: f64) -> Result<Basis, SplineError> {
        Basis::check_count(count, 3)?;
        Basis::closed_bbb(&vec![bias; count], &vec![tension; count], &vec![1.0; count])
    }

    /// The number of control points.
    pub fn control_count(&self) -> usize {
        self.form.control_count
    }

    /// The degree.
    pub fn degree(&self) -> usize {
        self.form.degree
    }

    /// Whether the end of the domain is its beginning.
    pub fn is_closed(&self) -> bool {
        match &self.kind {
            Kind::Knots(knots) => knots.is_closed,
            Kind::Bbb(bbb) => bbb.is_closed,
        }
    }

    /// The parameters of the joints that bound the spans, increasing.
    pub fn breaks(&self) -> &[f64] {
        &self.form.breaks
    }

    /// The lowest and the highest parameter.
    pub fn domain(&self) -> [f64; 2] {
        [self.form.breaks[0], self.form.breaks[self.form.spans()]]
    }

    pub(crate) fn form(&self) -> &BezierForm {
        &self.form
    }

    /// Whether the same control points give the same curve, to rounding, with spans of the same lengths.
    pub(crate) fn agrees_with(&self, other: &Basis) -> bool {
        let (a, b) = (&self.form, &other.form);
        let lengths =
            |form: &BezierForm| -> Vec<f64> { form.breaks.windows(2).map(|pair| pair[1] - pair[0]).collect() };
        let is_shaped_alike = (a.degree, a.control_count, a.spans(), a.rows.len())
            == (b.degree, b.control_count, b.spans(), b.rows.len());
        is_shaped_alike
            && lengths(a).iter().zip(lengths(b)).all(|(x, y)| (x - y).abs() <= CLOSE * x)
            && a.rows.iter().zip(&b.rows).all(|(x, y)| x.is_close(y, CLOSE))
    }

    /// Whether the spline passes through a control point at `t`, so that it can be cut there.
    fn is_full(&self, t: f64) -> bool {
        match &self.kind {
            Kind::Knots(knots) => knots.multiplicity(t) >= knots.degree,
            Kind::Bbb(bbb) => bbb.is_full(t),
        }
    }

    fn unchanged(&self) -> Refinement {
        Refinement { basis: self.clone(), steps: Vec::new() }
    }

    /// # Errors
    /// [`SplineError::Outside`] unless `t` is in the domain, and inside if `inside`.
    fn check_parameter(&self, t: f64, inside: bool) -> Result<(), SplineError> {
        let [low, high] = self.domain();
        let is_in = if inside { t > low && t < high } else { t >= low && t <= high };
        if is_in { Ok(()) } else { Err(SplineError::Outside { parameter: t, low, high }) }
    }

    /// This spline with another joint at `t`.
    ///
    /// # Errors
    /// [`SplineError::Outside`]; [`SplineError::Multiplicity`] if there is no room for another joint, [`SplineError::Short`]
    /// if it would lie too near to another.
    pub(crate) fn inserted(&self, t: f64) -> Result<Refinement, SplineError> {
        self.check_parameter(t, false)?;
        if self.is_full(t) {
            let index = self.form.breaks.partition_point(|at| *at < t);
            let most = self.degree();
            return Err(SplineError::Multiplicity { index, value: t, found: most + 1, most });
        }
        let (basis, rows) = match &self.kind {
            Kind::Knots(knots) => with(knots.inserted(t), Basis::of_knots),
            Kind::Bbb(bbb) => with(bbb.inserted(t), Basis::of_bbb),
        };
        Ok(Refinement { basis: basis.checked()?, steps: vec![rows] })
    }

    /// This spline with as many joints at `t` as there is room for, and the parameter of these joints.
    fn filled(&self, t: f64) -> Result<(Refinement, f64), SplineError> {
        let (mut refined, mut t) = (self.unchanged(), t);
        while !refined.basis.is_full(t) {
            let next = refined.basis.inserted(t)?;
            refined = refined.then(next);
            // Sums of intervals are rounded: the joint may lie a little beside t.
            let breaks = refined.basis.breaks();
            t = breaks.iter().copied().fold(f64::INFINITY, |a, b| if (b - t).abs() < (a - t).abs() { b } else { a });
        }
        Ok((refined, t))
    }

    /// The parts before and after `t`; a closed spline becomes one that begins and ends there.
    ///
    /// # Errors
    /// [`SplineError::Outside`] if `t` is not inside the domain; a closed spline may be opened at its ends too.
    pub(crate) fn subdivided(&self, t: f64) -> Result<Vec<Refinement>, SplineError> {
        self.check_parameter(t, !self.is_closed())?;
        self.cut(t)
    }

    fn cut(&self, t: f64) -> Result<Vec<Refinement>, SplineError> {
        let (filled, t) = self.filled(t)?;
        let parts: Vec<(Basis, Vec<ControlCombination>)> = match &filled.basis.kind {
            Kind::Knots(knots) => knots.cut(t).into_iter().map(|part| with(part, Basis::of_knots)).collect(),
            Kind::Bbb(bbb) => bbb.cut(t).into_iter().map(|part| with(part, Basis::of_bbb)).collect(),
        };
        let join = |(basis, rows)| Refinement { basis, steps: [filled.steps.clone(), vec![rows]].concat() };
        Ok(parts.into_iter().map(join).collect())
    }

    /// This spline, open, beginning and ending in its first and last control point.
    pub(crate) fn clamped_at_ends(&self) -> Result<Refinement, SplineError> {
        let mut refined = self.unchanged();
        for end in [1, 0] {
            let t = refined.basis.domain()[end];
            // At an end the cut leaves one part: what lies beyond has no span.
            for part in refined.basis.cut(t)?.into_iter().take(1) {
                refined = refined.then(part);
            }
        }
        Ok(refined)
    }

    /// This spline with a degree higher by one, open and passing through its ends. A BBB-spline, which is cubic by
    /// its nature, first becomes the B-spline of its Bezier points.
    ///
    /// # Errors
    /// [`SplineError::Degree`] if it is too high.
    pub(crate) fn elevated(&self) -> Result<Refinement, SplineError> {
        let open = if self.is_closed() { self.unchanged() } else { self.clamped_at_ends()? };
        let open = match &open.basis.kind {
            Kind::Knots(_) => open,
            Kind::Bbb(_) => {
                let pieces = open.basis.as_pieces()?;
                open.then(pieces)
            }
        };
        let Kind::Knots(knots) = &open.basis.kind else { return Ok(open) };
        let (basis, rows) = with(knots.elevated()?, Basis::of_knots);
        Ok(open.then(Refinement { basis, steps: vec![rows] }))
    }

    /// The B-spline whose control points are the Bezier points.
    fn as_pieces(&self) -> Result<Refinement, SplineError> {
        let (degree, breaks) = (self.degree(), &self.form.breaks);
        let last = breaks.len() - 1;
        let copies = |k: usize| match k {
            _ if self.is_closed() => {
                if k < last {
                    degree
                } else {
                    1
                }
            }
            0 => degree + 1,
            k => degree + usize::from(k == last),
        };
        let knots: Vec<f64> = (0..=last).flat_map(|k| std::iter::repeat_n(breaks[k], copies(k))).collect();
        let mut rows = self.form.rows.clone();
        if self.is_closed() {
            // Control point i of a closed B-spline begins at knot i: the Bezier point of the first joint is the last.
            rows.rotate_left(1);
        }
        let basis = Basis::of_knots(Knots::new(degree, knots, self.is_closed())?);
        Ok(Refinement { basis, steps: vec![rows] })
    }

    /// This spline from the other end.
    pub(crate) fn reversed(&self) -> Refinement {
        let (basis, rows) = match &self.kind {
            Kind::Knots(knots) => with(knots.reversed(), Basis::of_knots),
            Kind::Bbb(bbb) => with(bbb.reversed(), Basis::of_bbb),
        };
        Refinement { basis, steps: vec![rows] }
    }
}

/// The difference that reversing a basis twice may make.
const CLOSE: f64 = 1e-12;

/// The most control points in one direction.
const MAX_CONTROL: usize = 1 << 20;

fn with<T>((kind, rows): (T, Vec<ControlCombination>), basis: impl Fn(T) -> Basis) -> (Basis, Vec<ControlCombination>) {
    (basis(kind), rows)
}
