//! Knot vectors: spans, insertion, elevation and cutting of B-splines.
//!
//! All of it by blossoms: the control point i of a B-spline of degree p is the value of its polar form at the knots
//! i + 1 ..= i + p (Ramshaw 1987; Boehm 1980 for the insertion).

use serde::{Deserialize, Serialize};

use super::bezier::check_degree;
use super::control::ControlCombination;
use super::form::BezierForm;
use super::{MAX_DEGREE, SplineError};

/// A checked knot vector.
///
/// Open: control points and degree and 1 more knots; the domain leaves `degree` knots at either side. Closed: the knots
/// of one period, its end included, which is the domain; beyond it they repeat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Knots {
    pub degree: usize,
    values: Vec<f64>,
    pub is_closed: bool,
}

impl Knots {
    /// These knots after all checks, where they were read and not made here.
    pub fn checked(self) -> Result<Knots, SplineError> {
        Knots::new(self.degree, self.values, self.is_closed)
    }

    pub fn new(degree: usize, values: Vec<f64>, is_closed: bool) -> Result<Knots, SplineError> {
        check_degree(degree)?;
        let least = if is_closed { degree + 2 } else { 2 * degree + 2 };
        if values.len() < least {
            return Err(SplineError::TooFew { what: "knots", found: values.len(), least });
        }
        for (index, &value) in values.iter().enumerate() {
            if !value.is_finite() || value.abs() > 1e100 {
                return Err(SplineError::Value { what: "knot", index, value, range: "a number within 1e100" });
            }
            if index > 0 && value < values[index - 1] {
                return Err(SplineError::Decreasing { index, value });
            }
        }
        let knots = Knots { degree, values, is_closed };
        let [low, high] = knots.domain();
        if low >= high {
            return Err(SplineError::NoSpan);
        }
        knots.check_multiplicity().map(|()| knots)
    }

    fn check_multiplicity(&self) -> Result<(), SplineError> {
        let [low, high] = self.domain();
        let mut index = 0;
        for run in self.values.chunk_by(|a, b| a == b) {
            let (value, mut found) = (run[0], run.len());
            if self.is_closed && value == low {
                found += self.values.iter().filter(|knot| **knot == high).count() - 1;
            }
            let is_inner = self.is_closed || (value > low && value < high);
            let most = if is_inner { self.degree } else { self.degree + 1 };
            if found > most {
                return Err(SplineError::Multiplicity { index, value, found, most });
            }
            index += run.len();
        }
        Ok(())
    }

    pub fn control_count(&self) -> usize {
        if self.is_closed { self.values.len() - 1 } else { self.values.len() - self.degree - 1 }
    }

    pub fn domain(&self) -> [f64; 2] {
        let outside = if self.is_closed { 0 } else { self.degree };
        [self.values[outside], self.values[self.values.len() - 1 - outside]]
    }

    /// Knot `j`, in a closed spline any.
    fn at(&self, j: isize) -> f64 {
        if !self.is_closed {
            return self.values[j as usize];
        }
        let count = self.values.len() as isize - 1;
        let period = self.values[count as usize] - self.values[0];
        self.values[j.rem_euclid(count) as usize] + period * j.div_euclid(count) as f64
    }

    /// The control point `i`, in a closed spline any.
    fn wrap(&self, i: isize) -> usize {
        if self.is_closed { i.rem_euclid(self.control_count() as isize) as usize } else { i as usize }
    }

    /// The first knots of the spans.
    fn spans(&self) -> Vec<isize> {
        let (from, to) = if self.is_closed { (0, self.control_count()) } else { (self.degree, self.control_count()) };
        (from as isize..to as isize).filter(|&j| self.at(j) < self.at(j + 1)).collect()
    }

    /// The value of the polar form of the span after knot `k`, by de Boor's construction. Arguments within the span give
    /// convex combinations.
    fn blossom(&self, k: isize, arguments: &[f64]) -> ControlCombination {
        let p = self.degree;
        let mut rows = vec![vec![0.0; p + 1]; p + 1];
        for (j, row) in rows.iter_mut().enumerate() {
            row[j] = 1.0;
        }
        for (r, &x) in (1..).zip(arguments) {
            for j in (r..=p).rev() {
                let low = self.at(k - (p - j) as isize);
                let high = self.at(k + (j + 1 - r) as isize);
                let (keep, take) = ((high - x) / (high - low), (x - low) / (high - low));
                let (before, own) = rows.split_at_mut(j);
                for (own, other) in own[0].iter_mut().zip(&before[j - 1]) {
                    *own = keep * other + take * *own;
                }
            }
        }
        ControlCombination::new(self.wrap(k - p as isize), &rows[p])
    }

    pub fn form(&self) -> BezierForm {
        let spans = self.spans();
        let mut rows = Vec::with_capacity(spans.len() * self.degree + 1);
        for &k in &spans {
            let (low, high) = (self.at(k), self.at(k + 1));
            for m in usize::from(!rows.is_empty())..=self.degree {
                let mut arguments = [low; MAX_DEGREE];
                arguments[..m].fill(high);
                rows.push(self.blossom(k, &arguments[..self.degree]));
            }
        }
        if self.is_closed {
            rows.pop();
        }
        let mut breaks: Vec<f64> = spans.iter().map(|&k| self.at(k)).collect();
        breaks.push(self.domain()[1]);
        BezierForm { degree: self.degree, control_count: self.control_count(), breaks, rows }
    }

    /// The last knot that is not above `x`.
    fn span_of(&self, x: f64) -> isize {
        self.values.partition_point(|knot| *knot <= x) as isize - 1
    }

    /// With `x` as another knot, and the control points of that.
    pub fn inserted(&self, x: f64) -> (Knots, Vec<ControlCombination>) {
        let [low, high] = self.domain();
        let x = if self.is_closed && x == high { low } else { x };
        let k = self.span_of(x);
        let (p, count) = (self.degree as isize, self.control_count() as isize);
        let multiplicity = (0..=p).take_while(|back| (self.is_closed || *back <= k) && self.at(k - back) == x).count();
        let first = if self.is_closed { k - p + 1 } else { 0 };
        let mut rows = vec![ControlCombination::one(0); count as usize + 1];
        for i in first..=first + count {
            let row = if i <= k - p {
                ControlCombination::one(self.wrap(i))
            } else if i > k - multiplicity as isize {
                ControlCombination::one(self.wrap(i - 1))
            } else {
                let (from, to) = (self.at(i), self.at(i + p));
                ControlCombination::new(self.wrap(i - 1), &[(to - x) / (to - from), (x - from) / (to - from)])
            };
            rows[i.rem_euclid(count + 1) as usize] = row;
        }
        let mut values = self.values.clone();
        values.insert((k + 1) as usize, x);
        (Knots { degree: self.degree, values, is_closed: self.is_closed }, rows)
    }

    /// How often `x` occurs.
    pub fn multiplicity(&self, x: f64) -> usize {
        let [low, high] = self.domain();
        let found = self.values.iter().filter(|knot| **knot == x).count();
        let is_seam = self.is_closed && (x == low || x == high);
        if is_seam { self.values.iter().filter(|knot| **knot == low || **knot == high).count() - 1 } else { found }
    }

    /// The parts before and after `x`, which must occur at least `degree` times; a closed spline becomes one open part.
    pub fn cut(&self, x: f64) -> Vec<(Knots, Vec<ControlCombination>)> {
        let p = self.degree;
        let open = |values: Vec<f64>, from: usize, count: usize| {
            let rows = (from..from + count).map(|i| ControlCombination::one(self.wrap(i as isize))).collect();
            (Knots { degree: p, values, is_closed: false }, rows)
        };
        if self.is_closed {
            let [low, high] = self.domain();
            let x = if x == high { low } else { x };
            let (k, count) = (self.span_of(x), self.control_count() as isize);
            let period = high - low;
            let inner = (k - p as isize + 1..=k + count).map(|j| self.at(j));
            let values = [x].into_iter().chain(inner).chain([x + period]).collect();
            let from = (k - p as isize).rem_euclid(count) as usize;
            return vec![open(values, from, count as usize + 1)];
        }
        let begin = self.values.partition_point(|knot| *knot < x);
        let end = self.values.partition_point(|knot| *knot <= x);
        let left = || [&self.values[..end], &[x][..]].concat()[..begin + p + 1].to_vec();
        let right = || [&[x][..], &self.values[end - p..]].concat();
        let mut parts = Vec::new();
        if begin > p {
            parts.push(open(left(), 0, begin));
        }
        if end - 1 < self.control_count() {
            parts.push(open(right(), end - p - 1, self.control_count() - (end - p - 1)));
        }
        parts
    }

    /// With a degree higher by one: every knot occurs once more. An open one must be clamped.
    pub fn elevated(&self) -> Result<(Knots, Vec<ControlCombination>), SplineError> {
        let degree = self.degree + 1;
        check_degree(degree)?;
        let (inner, last) = self.values.split_at(self.values.len() - usize::from(self.is_closed));
        let mut values: Vec<f64> =
            inner.chunk_by(|a, b| a == b).flat_map(|run| run.iter().copied().chain([run[0]])).collect();
        values.extend(last);
        let higher = Knots { degree, values, is_closed: self.is_closed };
        let spans = self.spans();
        let rows = (0..higher.control_count() as isize).map(|i| {
            let arguments: Vec<f64> = (1..=degree as isize).map(|j| higher.at(i + j)).collect();
            self.mean_blossom(&spans, &arguments)
        });
        let rows = rows.collect();
        Ok((higher, rows))
    }

    /// The mean of the polar form over all ways to leave one of the arguments out.
    fn mean_blossom(&self, spans: &[isize], arguments: &[f64]) -> ControlCombination {
        let mean = arguments.iter().sum::<f64>() / arguments.len() as f64;
        let [low, high] = self.domain();
        // In a closed spline the arguments may lie beyond the period: count whole periods off.
        let turns = if self.is_closed { ((mean - low) / (high - low)).floor() } else { 0.0 };
        let local: Vec<f64> = arguments.iter().map(|x| x - turns * (high - low)).collect();
        let middle = mean - turns * (high - low);
        let k = spans[spans.partition_point(|&k| self.at(k) <= middle).clamp(1, spans.len()) - 1];
        let center = 0.5 * (self.at(k) + self.at(k + 1));
        let count = self.control_count();
        let mut sum = vec![0.0; self.degree + 1];
        let first = self.wrap(k - self.degree as isize);
        for left_out in 0..local.len() {
            let mut rest: Vec<f64> =
                local.iter().enumerate().filter(|(j, _)| *j != left_out).map(|(_, x)| *x).collect();
            // The farthest first, where the knots that de Boor's construction divides by lie farthest apart.
            rest.sort_by(|a, b| (b - center).abs().total_cmp(&(a - center).abs()));
            for (index, weight) in self.blossom(k, &rest).terms(count) {
                sum[(index + count - first) % count] += weight / local.len() as f64;
            }
        }
        ControlCombination::new(first, &sum)
    }

    /// The knots from the other end, and the order of the control points.
    pub fn reversed(&self) -> (Knots, Vec<ControlCombination>) {
        let [low, high] = self.domain();
        let values = self.values.iter().rev().map(|knot| low + (high - knot)).collect();
        let count = self.control_count();
        let shift = if self.is_closed { self.degree } else { 0 };
        let rows = (0..count).map(|i| ControlCombination::one((2 * count - 1 - i - shift) % count)).collect();
        (Knots { degree: self.degree, values, is_closed: self.is_closed }, rows)
    }
}
