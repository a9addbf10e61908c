//! BBB-splines: cubic spans with a bias and a tension at each joint and an interval for each span.
//!
//! At joint i the span b before it and the span c after it meet with c' = bias b' and c'' = bias^2 b'' + tension b', by
//! a parameter that advances by the interval over each span. The Bezier points come from the control polygon by ratios
//! alone (the construction of Boehm 1985 for curvature continuous splines, with the bias as another factor): the edge
//! from control point i to i + 1 is divided in the ratio
//!
//!   g(i) before(i) / bias(i)  :  after(i)  :  g(i+1) bias(i+1) after(i+1)
//!
//! where before(i) and after(i) are the intervals at joint i, and
//!
//!   g = 1 / (1 + tension before after / (2 bias (before + bias after)));
//!
//! the joint divides the way between the inner Bezier points beside it in the ratio before(i) : bias(i) after(i). All
//! ratios are positive: the Bezier points are convex combinations, whatever the parameters.

use serde::{Deserialize, Serialize};

use super::SplineError;
use super::control::ControlCombination;
use super::form::BezierForm;

/// Bias and tension of each joint; the intervals, of which interval i lies before joint i and i + 1 behind it. An open
/// spline has one interval more than joints; its curve runs from joint 1 to the last but one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Bbb {
    bias: Vec<f64>,
    tension: Vec<f64>,
    intervals: Vec<f64>,
    pub is_closed: bool,
    /// The parameter at which the first span begins.
    start: f64,
}

impl Bbb {
    /// These parameters after all checks, for a spline that was read and not made here.
    pub fn checked(self) -> Result<Bbb, SplineError> {
        let start = [self.start];
        check("first parameter", &start, "a number within 1e100", |x| x.abs() <= 1e100)?;
        let bbb = Bbb::new(self.bias, self.tension, self.intervals, self.is_closed)?;
        Ok(Bbb { start: self.start, ..bbb })
    }

    pub fn new(bias: Vec<f64>, tension: Vec<f64>, intervals: Vec<f64>, closed: bool) -> Result<Bbb, SplineError> {
        let (count, least) = (bias.len(), if closed { 3 } else { 4 });
        if count < least {
            return Err(SplineError::TooFew { what: "joints", found: count, least });
        }
        let lengths =
            [("tensions", tension.len(), count), ("intervals", intervals.len(), count + usize::from(!closed))];
        for (what, found, needed) in lengths {
            if found != needed {
                return Err(SplineError::Count { what, found, needed });
            }
        }
        let is_interval = |x: f64| x == 0.0 || (1e-12..=1e12).contains(&x);
        check("bias", &bias, "within 1e-9..=1e9", |x| (1e-9..=1e9).contains(&x))?;
        check("tension", &tension, "within 0..=1e12", |x| (0.0..=1e12).contains(&x))?;
        check("interval", &intervals, "0, or within 1e-12..=1e12", is_interval)?;
        let bbb = Bbb { bias, tension, intervals, is_closed: closed, start: 0.0 };
        let is_zero = |i: usize| (i..i + 3).all(|i| bbb.before(i) == 0.0);
        let last = if closed { count } else { bbb.intervals.len() - 2 };
        if let Some(index) = (0..last).find(|&i| is_zero(i)) {
            return Err(SplineError::Zeros { index });
        }
        if bbb.spans().is_empty() { Err(SplineError::NoSpan) } else { Ok(bbb) }
    }

    pub fn control_count(&self) -> usize {
        self.bias.len()
    }

    fn before(&self, joint: usize) -> f64 {
        self.intervals[joint % self.intervals.len()]
    }

    fn after(&self, joint: usize) -> f64 {
        self.before(joint + 1)
    }

    fn bias(&self, joint: usize) -> f64 {
        self.bias[joint % self.bias.len()]
    }

    /// The factor g of a joint between intervals `before` and `after`.
    fn factor(&self, joint: usize, before: f64, after: f64) -> f64 {
        if before == 0.0 || after == 0.0 {
            return 1.0;
        }
        let (bias, tension) = (self.bias(joint), self.tension[joint % self.tension.len()]);
        1.0 / (1.0 + tension * before * (after / (2.0 * bias * (before + bias * after))))
    }

    /// The last part of the edge of the control polygon that ends in `joint`, if the interval after it is `after`.
    fn ahead(&self, joint: usize, after: f64) -> f64 {
        self.factor(joint, self.before(joint), after) * self.bias(joint) * after
    }

    /// The first part of the edge of the control polygon that begins in `joint`, if the interval before it is `before`.
    fn behind(&self, joint: usize, before: f64) -> f64 {
        self.factor(joint, before, self.after(joint)) * before / self.bias(joint)
    }

    /// The parts of the edge of the control polygon from control point `joint` to the next; their sum is not zero.
    fn polygon_edge(&self, joint: usize) -> [f64; 3] {
        [self.behind(joint, self.before(joint)), self.after(joint), self.ahead(joint + 1, self.after(joint + 1))]
    }

    /// The joints at which spans of a positive length begin.
    fn spans(&self) -> Vec<usize> {
        let count = self.control_count();
        let joints = if self.is_closed { 0..count } else { 1..count - 2 };
        joints.filter(|&joint| self.after(joint) > 0.0).collect()
    }

    /// The two inner Bezier points on an edge of the control polygon.
    fn inner(&self, joint: usize) -> [ControlCombination; 2] {
        let [a, b, c] = self.polygon_edge(joint);
        let sum = a + b + c;
        let row = |low: f64, high: f64| ControlCombination::new(joint, &[low / sum, high / sum]);
        [row(b + c, a), row(c, a + b)]
    }

    /// The Bezier point of a joint.
    fn joint(&self, joint: usize) -> ControlCombination {
        let count = self.control_count();
        let previous = (joint + count - 1) % count;
        let (left, right) = (self.before(joint), self.bias(joint) * self.after(joint));
        if left + right == 0.0 {
            return ControlCombination::one(joint % count);
        }
        let ([a, b, c], [d, e, f]) = (self.polygon_edge(previous), self.polygon_edge(joint));
        let (left, right) = (left / (left + right) / (d + e + f), right / (left + right) / (a + b + c));
        ControlCombination::new(previous, &[right * c, right * (a + b) + left * (e + f), left * d])
    }

    pub fn form(&self) -> BezierForm {
        let spans = self.spans();
        let mut rows = vec![self.joint(spans[0])];
        let (mut breaks, mut at) = (vec![self.start], self.start);
        for &joint in &spans {
            rows.extend(self.inner(joint));
            rows.push(self.joint(joint + 1));
            at += self.after(joint);
            breaks.push(at);
        }
        if self.is_closed {
            rows.pop();
        }
        BezierForm { degree: 3, control_count: self.control_count(), breaks, rows }
    }

    /// The span of a parameter as the joint at which it begins, the part of its interval before and that after.
    fn locate(&self, t: f64) -> (usize, [f64; 2]) {
        let (spans, breaks) = (self.spans(), self.form().breaks);
        let span = breaks.partition_point(|at| *at <= t).clamp(1, spans.len()) - 1;
        let interval = self.after(spans[span]);
        let part = if t >= breaks[span + 1] { interval } else { (t - breaks[span]).clamp(0.0, interval) };
        (spans[span], [part, interval - part])
    }

    /// How many joints lie at a parameter, 3 at most, and the one that is followed by or ends the span there.
    fn joints_at(&self, t: f64) -> Vec<usize> {
        let (joint, [part, rest]) = self.locate(t);
        let count = self.control_count();
        if part > 0.0 && rest > 0.0 {
            return Vec::new();
        }
        let mut joints = vec![if part == 0.0 { joint } else { (joint + 1) % count }];
        // Joints before the first; the end intervals of an open spline bound joints that have no control point.
        while joints.len() < 3 && self.before(joints[0]) == 0.0 && (self.is_closed || joints[0] > 0) {
            joints.insert(0, (joints[0] + count - 1) % count);
        }
        while joints.len() < 3 {
            let last = joints[joints.len() - 1];
            if self.after(last) != 0.0 || !(self.is_closed || last + 1 < count) {
                break;
            }
            joints.push((last + 1) % count);
        }
        joints
    }

    /// The control point in which the spline passes through the parameter, if three joints or the end of the polygon
    /// lie there.
    fn interpolated_at(&self, t: f64) -> Option<usize> {
        let joints = self.joints_at(t);
        joints.into_iter().find(|&joint| self.before(joint) == 0.0 && self.after(joint) == 0.0)
    }

    /// Whether no further joint can be inserted at a parameter.
    pub fn is_full(&self, t: f64) -> bool {
        self.interpolated_at(t).is_some()
    }

    /// With another joint of bias 1 and tension 0 at `t`, which must not be full, and the control points of that.
    pub fn inserted(&self, t: f64) -> (Bbb, Vec<ControlCombination>) {
        let (joint, [part, rest]) = self.locate(t);
        let count = self.control_count();
        let previous = (joint + count - 1) % count;
        let line = |first: usize, low: f64, high: f64| {
            let sum = low + high;
            ControlCombination::new(first % count, &[low / sum, high / sum])
        };
        let mut rows: Vec<ControlCombination> = (0..count).map(ControlCombination::one).collect();
        let [a, b, c] = self.polygon_edge(previous);
        let ahead = self.ahead(joint, part);
        rows[joint] = line(previous, (c - ahead).max(0.0), a + b + ahead);
        let [a, b, c] = self.polygon_edge(joint + 1);
        let behind = self.behind(joint + 1, rest);
        rows[(joint + 1) % count] = line(joint + 1, behind + b + c, (a - behind).max(0.0));
        let [a, _, c] = self.polygon_edge(joint);
        rows.insert(joint + 1, line(joint, rest + c, a + part));
        let mut finer = self.clone();
        finer.bias.insert(joint + 1, 1.0);
        finer.tension.insert(joint + 1, 0.0);
        let interval = (joint + 1) % self.intervals.len();
        finer.intervals[interval] = rest;
        finer.intervals.insert(joint + 1, part);
        (finer, rows)
    }

    /// The parts before and after `t`, which must be full; a closed spline becomes one open part.
    pub fn cut(&self, t: f64) -> Vec<(Bbb, Vec<ControlCombination>)> {
        let Some(joint) = self.interpolated_at(t) else {
            return Vec::new();
        };
        let count = self.control_count();
        let part = |from: usize, joints: usize, start: f64| {
            let pick = |list: &[f64], length: usize| (from..from + length).map(|i| list[i % list.len()]).collect();
            let bbb = Bbb {
                bias: pick(&self.bias, joints),
                tension: pick(&self.tension, joints),
                intervals: pick(&self.intervals, joints + 1),
                is_closed: false,
                start,
            };
            (bbb, (from..from + joints).map(|i| ControlCombination::one(i % count)).collect())
        };
        if self.is_closed {
            return vec![part(joint, count + 1, t)];
        }
        let mut parts = Vec::new();
        if joint > 2 {
            parts.push(part(0, joint + 1, self.start));
        }
        if joint + 3 < count {
            parts.push(part(joint, count - joint, t));
        }
        parts
    }

    /// From the other end: there the bias is 1 / bias, and the tension is tension / bias^3. In a closed spline joint 0
    /// stays the first.
    pub fn reversed(&self) -> (Bbb, Vec<ControlCombination>) {
        let turn = |list: &[f64], back: usize| {
            let mut turned: Vec<f64> = list.iter().rev().copied().collect();
            turned.rotate_right(if self.is_closed { back } else { 0 });
            turned
        };
        let (bias, tension) = (turn(&self.bias, 1), turn(&self.tension, 1));
        let bbb = Bbb {
            tension: bias.iter().zip(tension).map(|(bias, tension)| tension / (bias * bias * bias)).collect(),
            bias: bias.iter().map(|bias| 1.0 / bias).collect(),
            intervals: turn(&self.intervals, 2),
            is_closed: self.is_closed,
            start: self.start,
        };
        let mut rows: Vec<ControlCombination> = (0..self.control_count()).rev().map(ControlCombination::one).collect();
        rows.rotate_right(usize::from(self.is_closed));
        (bbb, rows)
    }
}

fn check(
    what: &'static str,
    list: &[f64],
    range: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), SplineError> {
    match list.iter().position(|value| !holds(*value)) {
        Some(index) => Err(SplineError::Value { what, index, value: list[index], range }),
        None => Ok(()),
    }
}
