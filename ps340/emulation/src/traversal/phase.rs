//! What changes with the frames by itself: SET RATE and blinking.

use protocol::command::Rate;

/// The phase of a rate, and the frame of its next change; none if it never changes.
///
/// In the first `delay` frames the phase is the initial one; then it alternates, beginning with the initial one.
///
/// - `frame`: frames since the rate began.
///
/// # Source
/// Lengths and initial state as remembered from the manuals; what happens in the delay is ours.
pub(super) fn rate(rate: &Rate, frame: u64) -> (bool, Option<u64>) {
    let delay = u64::from(rate.delay);
    let (first, second) = if rate.initial { (rate.on, rate.off) } else { (rate.off, rate.on) };
    let (first, second) = (u64::from(first), u64::from(second));
    match (first, second) {
        (_, 0) => (rate.initial, None),
        (0, _) if frame < delay => (rate.initial, Some(delay)),
        (0, _) => (!rate.initial, None),
        _ if frame < delay => (rate.initial, Some(delay + first)),
        _ => {
            let place = (frame - delay) % (first + second);
            let start = frame - place;
            if place < first {
                (rate.initial, Some(start + first))
            } else {
                (!rate.initial, Some(start + first + second))
            }
        }
    }
}

/// Whether blinking data is seen in a frame, and the frame of the next change.
///
/// - `frames`: the length of a phase, not 0.
pub(super) fn blink(frames: u32, frame: u64) -> (bool, u64) {
    let frames = u64::from(frames.max(1));
    ((frame / frames).is_multiple_of(2), (frame / frames + 1) * frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twenty_on_and_ten_off_repeat_every_thirty_frames() {
        let twenty = Rate { on: 20, off: 10, initial: true, delay: 0 };
        for frame in 0..300 {
            let (phase, change) = rate(&twenty, frame);
            assert_eq!(phase, frame % 30 < 20, "{frame}");
            let change = change.unwrap();
            assert!((frame..change).all(|f| rate(&twenty, f).0 == phase) && rate(&twenty, change).0 != phase);
        }
    }

    #[test]
    fn the_delay_holds_the_initial_phase() {
        let late = Rate { on: 2, off: 3, initial: false, delay: 4 };
        let phases: Vec<bool> = (0..12).map(|frame| rate(&late, frame).0).collect();
        assert_eq!(phases, [[false; 7].as_slice(), &[true, true, false, false, false]].concat());
        assert_eq!(rate(&late, 1).1, Some(7));
    }

    #[test]
    fn a_phase_of_no_length_is_left_out() {
        assert_eq!(rate(&Rate { on: 5, off: 0, initial: true, delay: 0 }, 99), (true, None));
        assert_eq!(rate(&Rate { on: 0, off: 5, initial: true, delay: 0 }, 0), (false, None));
        assert_eq!(rate(&Rate { on: 0, off: 5, initial: true, delay: 3 }, 1), (true, Some(3)));
        assert_eq!(rate(&Rate { on: 0, off: 0, initial: true, delay: 0 }, 7), (true, None));
    }

    #[test]
    fn blinking_shows_every_other_phase() {
        assert_eq!(blink(30, 0), (true, 30));
        assert_eq!(blink(30, 59), (false, 60));
        assert_eq!(blink(0, 3), (false, 4));
    }
}
