//! A stroke as the graphics processor takes it.

use crate::calligraphic::{
    optics::Optics,
    spot::REACH,
    track::{Current, Track},
};
use crate::traversal::Stroke;

/// Numbers of an instance.
pub(super) const NUMBERS: usize = 20;

/// A stroke seen from a whole pixel near the middle of what is seen of it, its anchor; fields as in `beam.wgsl`.
///
/// Of a stroke that is not seen all numbers are 0: a rectangle without pixels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct StrokeInstance {
    anchor: [f32; 2],
    step: [f32; 2],
    /// Distances at the anchor from start, end, and across.
    course: [f32; 3],
    /// 0 for a point, 1 where both ends may act, 2 where the nearer does.
    kind: f32,
    terms: [f32; 4],
    /// First and last position along the stroke, from the anchor, that light can reach.
    from: f32,
    to: f32,
    last_term: f32,
    unused: f32,
    color: [f32; 4],
}

impl StrokeInstance {
    /// A stroke for a tube of some guns.
    pub fn new(optics: &Optics, guns: usize, stroke: &Stroke) -> Self {
        Self::from_stroke(optics, guns, stroke).unwrap_or_default()
    }

    fn from_stroke(optics: &Optics, guns: usize, stroke: &Stroke) -> Option<Self> {
        let (start, end, _) = optics.beam(stroke)?;
        let ends = optics.clipped_to_picture(start, end)?;
        let middle = [0, 1].map(|axis| (ends[0][axis] + ends[1][axis]) / 2.0);
        let anchor = [0, 1].map(|axis| middle[axis].clamp(0.0, (optics.size[axis] - 1) as f64) as usize);
        let track = Track::new(optics, stroke, anchor)?;
        let (kind, terms) = match track.current {
            Current::Point(terms) => (0.0, terms),
            Current::Both(current, gain) => (1.0, [current, gain, 0.0, 0.0, 0.0]),
            Current::Nearer(current, gain) => (2.0, [current, gain, 0.0, 0.0, 0.0]),
        };
        let [from, to] = ends.map(|end| {
            let from_anchor = [0, 1].map(|axis| end[axis] - anchor[axis] as f64 - 0.5);
            (from_anchor[0] * f64::from(track.step[0]) + from_anchor[1] * f64::from(track.step[1])) as f32
        });
        // A single gun draws every colour alike.
        let [red, green, blue] = if guns == 1 { [1.0; 3] } else { track.color };
        Some(Self {
            anchor: anchor.map(|pixels| pixels as f32),
            step: track.step,
            course: [track.u, track.to_end, track.v],
            kind,
            terms: [terms[0], terms[1], terms[2], terms[3]],
            from: from - REACH,
            to: to + REACH,
            last_term: terms[4],
            unused: 0.0,
            color: [red, green, blue, 0.0],
        })
    }
}
