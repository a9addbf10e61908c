//! Surfaces of edges that a curve carries along.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::sphere::sine_and_cosine;
use super::{Surface, between, nearest_from};
use crate::curve::{Curve, SplineCurve};

/// Frames that are kept on each span of a curve; between them one more step is made.
const STATIONS: usize = 32;

/// Twist and taper: how a section changes along a curve, evenly in its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistAndTaper {
    /// How far it is twisted about the curve at the end, from x towards y; turns.
    pub twist_turns: f64,
    /// How much wider it is at the end than at the beginning, 0 or more.
    pub scale: f64,
}

/// Directions at a point of a curve.
#[derive(Clone, Copy, Debug)]
struct Frame {
    point: DVec3,
    /// Along the curve, unit length.
    along: DVec3,
    /// Where x of the section points, unit length.
    x: DVec3,
}

/// A curve with a frame that does not turn about it.
///
/// The plane of a section has its y upwards at the beginning as far as it can, and the curve goes towards the viewer.
///
/// # Source
/// The double reflection of Wang, Juettler, Zheng and Liu 2008.
#[derive(Clone, Debug)]
pub struct Spine {
    curve: SplineCurve,
    stations: Vec<(f64, Frame)>,
    /// What a closed curve must turn its frame to come back to where it was, turns.
    closing: f64,
}

impl Spine {
    /// The frames along a curve; `None` if it has no direction somewhere.
    pub fn new(curve: SplineCurve) -> Option<Spine> {
        let breaks = curve.basis().breaks();
        let inner = |pair: &[f64]| {
            let (low, high) = (pair[0], pair[1]);
            (0..STATIONS).map(move |k| between(low, high, k as f64 / STATIONS as f64)).collect::<Vec<_>>()
        };
        let mut at: Vec<f64> = breaks.windows(2).flat_map(inner).collect();
        at.push(breaks[breaks.len() - 1]);
        let along = direction(&curve, at[0])?;
        let up = if along.cross(DVec3::Y).length() > 1e-6 { DVec3::Y } else { DVec3::NEG_Z * along.y.signum() };
        let mut frame = Frame { point: curve.point(at[0]), along, x: up.cross(along).normalize() };
        let mut stations = vec![(at[0], frame)];
        for t in at.into_iter().skip(1) {
            frame = frame.moved(curve.point(t), direction(&curve, t)?);
            stations.push((t, frame));
        }
        let mut closing = 0.0;
        if curve.basis().is_closed() {
            let first = stations[0].1;
            closing = frame.x.dot(first.along.cross(first.x)).atan2(frame.x.dot(first.x)) / -TAU;
        }
        Some(Spine { curve, stations, closing })
    }

    /// The point of the section `point` at the parameter `t`.
    pub fn point_at(&self, point: DVec2, twist_and_taper: TwistAndTaper, t: f64) -> DVec3 {
        self.jet(point, twist_and_taper, t)[0]
    }

    /// The curvature of the curve at `t` as a vector of the section, 1 / model unit: towards the inside of the bend.
    pub fn curvature_in_section(&self, twist_and_taper: TwistAndTaper, t: f64) -> DVec2 {
        let bend = self.bend_in_space(t);
        let [x, y] = self.axes(twist_and_taper, t);
        DVec2::new(bend.dot(x), bend.dot(y))
    }

    fn bend_in_space(&self, t: f64) -> DVec3 {
        let [first, second] = self.curve.derivatives(t);
        let along = first.normalize_or_zero();
        if along == DVec3::ZERO {
            return DVec3::ZERO;
        }
        (second - along * second.dot(along)) / first.length_squared()
    }

    /// The part of the way, 0..=1.
    fn fraction(&self, t: f64) -> f64 {
        let [low, high] = self.curve.domain();
        (t - low) / (high - low)
    }

    fn frame(&self, t: f64) -> Frame {
        let after = self.stations.partition_point(|(at, _)| *at <= t);
        let (at, frame) = self.stations[after.max(1) - 1];
        match direction(&self.curve, t) {
            Some(along) if at != t => frame.moved(self.curve.point(t), along),
            _ => frame,
        }
    }

    /// Where x and y of the section point.
    fn axes(&self, twist_and_taper: TwistAndTaper, t: f64) -> [DVec3; 2] {
        let Frame { along, x, .. } = self.frame(t);
        let y = along.cross(x);
        let [sine, cosine] = sine_and_cosine((twist_and_taper.twist_turns + self.closing) * self.fraction(t));
        [x * cosine + y * sine, y * cosine - x * sine]
    }

    /// The place of a point of the section, its derivative by t, and the axes of the section.
    fn jet(&self, point: DVec2, twist_and_taper: TwistAndTaper, t: f64) -> [DVec3; 4] {
        let [low, high] = self.curve.domain();
        // A closed curve ends where it begins, to the bit.
        let t = if t == high && self.curve.basis().is_closed() { low } else { t };
        let (frame, [x, y]) = (self.frame(t), self.axes(twist_and_taper, t));
        let scale = between(1.0, twist_and_taper.scale, self.fraction(t));
        let offset = x * point.x + y * point.y;
        let rate = 1.0 / (high - low);
        let turning = (twist_and_taper.twist_turns + self.closing) * TAU * rate * scale;
        let first = self.curve.derivatives(t)[0];
        let carried = first * (1.0 - self.bend_in_space(t).dot(offset) * scale);
        let by_t = carried + offset * ((twist_and_taper.scale - 1.0) * rate) + (y * point.x - x * point.y) * turning;
        [frame.point + offset * scale, by_t, x * scale, y * scale]
    }
}

impl Frame {
    /// The frame at a point further on: reflected in the plane between the points, then in the one between the
    /// directions.
    fn moved(self, point: DVec3, along: DVec3) -> Frame {
        let reflected = |vector: DVec3, normal: DVec3| match normal.length_squared() {
            0.0 => vector,
            squared => vector - normal * (2.0 * normal.dot(vector) / squared),
        };
        let between = point - self.point;
        let (x, back) = (reflected(self.x, between), reflected(self.along, between));
        let x = reflected(x, along - back);
        // What rounding took from the right angle is given back.
        Frame { point, along, x: (x - along * along.dot(x)).normalize_or(self.x) }
    }
}

/// The unit tangent of a curve; at ends where the derivative vanishes its limit.
fn direction(curve: &SplineCurve, t: f64) -> Option<DVec3> {
    let [low, high] = curve.domain();
    let [first, second] = curve.derivatives(t);
    let size = second.length() * (high - low);
    let limit = if t == low { second } else { -second };
    let vector = if first.length() > 1e-10 * size { first } else { limit };
    vector.try_normalize()
}

/// The surface that an edge of a section makes along a [`Spine`]: u runs along the edge, 0..=1, v is the parameter of
/// the curve. The outside is on the right of the edge, seen against the curve.
#[derive(Clone, Debug)]
pub struct Swept {
    spine: Arc<Spine>,
    twist_and_taper: TwistAndTaper,
    edge: [DVec2; 2],
    part: [f64; 2],
}

impl Swept {
    /// The surface over a part of the parameters of the curve.
    pub fn new(spine: Arc<Spine>, twist_and_taper: TwistAndTaper, edge: [DVec2; 2], part: [f64; 2]) -> Swept {
        Swept { spine, twist_and_taper, edge, part }
    }

    fn section(&self, u: f64) -> DVec2 {
        let [from, to] = self.edge;
        DVec2::new(between(from.x, to.x, u), between(from.y, to.y, u))
    }
}

impl Surface for Swept {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::new(0.0, self.part[0]), DVec2::new(1.0, self.part[1])]
    }

    fn point(&self, uv: DVec2) -> DVec3 {
        self.spine.point_at(self.section(uv.x), self.twist_and_taper, uv.y)
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let [_, by_t, x, y] = self.spine.jet(self.section(uv.x), self.twist_and_taper, uv.y);
        let along = self.edge[1] - self.edge[0];
        [x * along.x + y * along.y, by_t]
    }

    /// The normal; where the section has shrunk to a point, or the parameter of the curve stands still, its limit.
    fn normal(&self, uv: DVec2) -> DVec3 {
        let [x, y] = self.spine.axes(self.twist_and_taper, uv.y);
        let along = (self.edge[1] - self.edge[0]).normalize_or_zero();
        let by_t = self.derivatives(uv)[1];
        (x * along.x + y * along.y).cross(by_t.normalize_or(self.spine.frame(uv.y).along)).normalize_or_zero()
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        nearest_from(self, point, guess)
    }
}
