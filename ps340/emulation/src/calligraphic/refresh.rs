//! How long the beam needs for a picture, and how often it can draw it.
//!
//! The beam goes over the whole list of strokes, for all screens together, since one line generator drives them:
//! a screen that does not show a stroke is blanked meanwhile. Then it begins again, at the next frame of 1/60 s: the
//! refresh rate is 60 Hz divided by a whole number. *Update* and *refresh* are separate: the list may change in every
//! frame, and what is drawn is the list at the beginning of a refresh.
//!
//! # Source
//! That the rate is 60 Hz at best and falls with number and length of the vectors is remembered (also 40 Hz, which is
//! no part of 60; whole frames are ours: a rate in between would beat with the frames of a window). The times are
//! ours, such that they agree with what is reported of these machines: about 95,000 short connected vectors at 30 Hz,
//! and 20,000 short separate ones at 60 Hz.
//!
//! # Not modelled
//! The brighter and slower drive of SET CSM ON, positioning that depends on direction, lines that the generator
//! draws as several.

use super::{DOT_LENGTH, limits::FRAME_SECONDS};
use crate::traversal::Stroke;

/// Speed at which the beam writes, screen units a microsecond: across the screen in 20 microseconds.
const WRITING_SPEED: f64 = 0.1;
/// Speed at which the dark beam moves, screen units a microsecond.
const POSITIONING_SPEED: f64 = 0.4;
/// Time until the dark beam stands still where it has moved to, microseconds.
const SETTLING_TIME: f64 = 0.5;
/// Time to begin a stroke or a dot, microseconds.
const STARTING_TIME: f64 = 0.15;
/// Longest distance that the beam moves: the diagonal of the screen.
const DIAGONAL: f64 = 2.0 * std::f64::consts::SQRT_2;
/// Frames of the longest refresh: a minute.
const MOST_FRAMES: f64 = 3600.0;

/// How long a refresh takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refresh {
    /// Time that the beam needs, microseconds.
    pub micros: f64,
    /// Frames of 1/60 s from the beginning of a refresh to that of the next, at least 1.
    pub frames: u64,
}

impl Refresh {
    /// The refresh of a list of strokes, in their order; the beam begins at the centre.
    pub fn of<'a>(strokes: impl IntoIterator<Item = &'a Stroke>) -> Self {
        let mut place = [0.0; 2];
        let mut micros = 0.0;
        for stroke in strokes {
            if place != stroke.start {
                micros += SETTLING_TIME + distance(place, stroke.start) / POSITIONING_SPEED;
            }
            let length = if stroke.is_dot() { f64::from(DOT_LENGTH) } else { distance(stroke.start, stroke.end) };
            micros += STARTING_TIME + length / WRITING_SPEED;
            place = stroke.end;
        }
        let frames = (micros / (FRAME_SECONDS * 1e6)).ceil().clamp(1.0, MOST_FRAMES);
        Self { micros, frames: frames as u64 }
    }

    /// Refreshes a second: 60, 30, 20, 15, ...
    pub fn rate(&self) -> f64 {
        1.0 / (FRAME_SECONDS * self.frames as f64)
    }

    /// The refresh in words: time, rate, and whether a long picture is held still (`steady`).
    pub fn describe(&self, steady: bool) -> String {
        let held = if steady && self.frames > 1 { ", held steady" } else { "" };
        format!("{:.1} microseconds, {} Hz{held}", self.micros, self.rate() as f32)
    }
}

/// Distance of two positions, at most the diagonal of the screen, also if it is not finite.
fn distance(from: [f32; 2], to: [f32; 2]) -> f64 {
    let [dx, dy] = [0, 1].map(|axis| f64::from(to[axis]) - f64::from(from[axis]));
    let square = dx * dx + dy * dy;
    if square < DIAGONAL * DIAGONAL { square.sqrt() } else { DIAGONAL }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stroke(start: [f32; 2], end: [f32; 2]) -> Stroke {
        Stroke { start, end, intensity: [1.0; 2], color: [1.0; 3] }
    }

    #[test]
    fn an_empty_picture_takes_no_time_and_is_refreshed_60_times_a_second() {
        assert_eq!(Refresh::of(&[]), Refresh { micros: 0.0, frames: 1 });
        assert!((Refresh::of(&[]).rate() - 60.0).abs() < 1e-9);
    }

    #[test]
    fn a_square_from_the_centre_takes_what_is_counted_by_hand() {
        // From the centre to (0.5, 0): 0.5 + 0.5 / 0.4 = 1.75. Four connected sides of 0.5: 4 (0.15 + 5) = 20.6.
        let corners = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5], [0.0, 0.0], [0.5, 0.0]];
        let sides: Vec<Stroke> = corners.windows(2).map(|ends| stroke(ends[0], ends[1])).collect();
        assert_eq!(corners[3], [0.0, 0.0]);
        assert!((sides[1].start[0] - 0.5).abs() < 1e-9);
        let refresh = Refresh::of(&sides);
        assert!((refresh.micros - 22.35).abs() < 1e-9, "{refresh:?}");
        assert_eq!(refresh.frames, 1);
    }

    #[test]
    fn separate_strokes_and_dots_pay_for_positioning() {
        // Stroke from the centre: 0.15 + 3 = 3.15; back by 0.3: 0.5 + 0.75; the same: 3.15.
        let line = stroke([0.0, 0.0], [0.3, 0.0]);
        assert!((Refresh::of(&[line, line]).micros - 7.55).abs() < 1e-6);
        // A dot at the centre: 0.15 + 0.06; the next 0.4 away: 0.5 + 1 + 0.21.
        let dots = [stroke([0.0; 2], [0.0; 2]), stroke([0.4, 0.0], [0.4, 0.0])];
        assert!((Refresh::of(&dots).micros - 1.92).abs() < 1e-6);
    }

    #[test]
    fn the_rate_falls_to_whole_parts_of_60() {
        // There and back over 1: 2 (0.15 + 10) = 20.3 microseconds a pair.
        let pair = [stroke([0.0, 0.0], [1.0, 0.0]), stroke([1.0, 0.0], [0.0, 0.0])];
        // A frame has 16,666.7: 821 pairs fill one, 1642 two.
        for (pairs, rate) in [(1, 60.0), (821, 60.0), (822, 30.0), (1642, 30.0), (1643, 20.0), (8210, 6.0)] {
            let refresh = Refresh::of(pair.iter().cycle().take(2 * pairs));
            assert!((refresh.rate() - rate).abs() < 1e-9, "{pairs} pairs: {refresh:?}");
        }
    }

    #[test]
    fn short_vectors_fit_as_many_as_is_told_of_the_machines() {
        let step = 10.0 / 512.0;
        let connected = [stroke([0.0, 0.0], [step, 0.0]), stroke([step, 0.0], [0.0, 0.0])];
        let refresh = Refresh::of(connected.iter().cycle().take(95_000));
        assert_eq!(refresh.frames, 2, "{refresh:?}");
        let separate = [stroke([0.0, 0.0], [step, 0.0]), stroke([0.0, step], [step, step])];
        let refresh = Refresh::of(separate.iter().cycle().take(18_000));
        assert_eq!(refresh.frames, 1, "{refresh:?}");
    }

    #[test]
    fn numbers_that_are_not_finite_take_the_time_of_the_diagonal() {
        let refresh = Refresh::of(&[stroke([0.0; 2], [f32::NAN, 0.0]), stroke([f32::INFINITY; 2], [1e30, 0.0])]);
        assert!(refresh.micros.is_finite() && refresh.micros > 50.0 && refresh.frames == 1, "{refresh:?}");
    }
}
