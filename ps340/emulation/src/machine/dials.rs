//! The eight dials and their sampling.
//!
//! # Source
//! Modes, smallest change and samples a second are settings of DSET1 to DSET8, remembered; their numbers are ours. The
//! real dials were sampled 10 to 20 times a second at the start; ours are sampled at every frame, for a smooth picture.

use super::{FRAMES_PER_SECOND, device_message::DeviceMessage};
use crate::port::DialSetting;
use protocol::Value;

/// Steps of a dial in a turn, the unit of the smallest change. Ours.
const STEPS: f64 = 1024.0;

/// How much of a step the rounding of sums may hide.
const ROUNDING: f64 = 1e-6;

/// The dials.
#[derive(Debug, Default)]
pub(super) struct Dials {
    dials: [Dial; 8],
}

#[derive(Debug)]
struct Dial {
    /// Turns since the last sample.
    pending: f64,
    /// Turns since the start or the last reset.
    position: f64,
    /// The position that was sent last.
    sent: f64,
    absolute: bool,
    minimum: u32,
    samples: u8,
}

impl Default for Dial {
    fn default() -> Dial {
        let samples = FRAMES_PER_SECOND as u8;
        Dial { pending: 0.0, position: 0.0, sent: 0.0, absolute: false, minimum: 0, samples }
    }
}

impl Dials {
    /// Turns a dial, 1..=8; others, and turns that are not finite, are no matter.
    pub(super) fn turn(&mut self, dial: u8, turns: f64) {
        if let Some(dial) = self.dial(dial)
            && (dial.position + turns).is_finite()
        {
            dial.pending += turns;
            dial.position += turns;
        }
    }

    /// Changes a setting of a dial.
    pub(super) fn set(&mut self, dial: u8, setting: DialSetting) {
        let Some(dial) = self.dial(dial) else { return };
        match setting {
            DialSetting::Absolute(absolute) => dial.absolute = absolute,
            DialSetting::MinimumChange(steps) => dial.minimum = steps,
            DialSetting::SamplesPerSecond(samples) => dial.samples = samples.clamp(1, FRAMES_PER_SECOND as u8),
            DialSetting::Reset(turns) => (dial.position, dial.pending) = (turns, 0.0),
        }
    }

    /// What the dials send at a frame: one message a dial at most. Relative dials send the sum of their turns.
    pub(super) fn sample(&mut self, frame: u64) -> Vec<DeviceMessage> {
        let sampled = (1..).zip(&mut self.dials);
        sampled.filter_map(|(output, dial)| Some(("DIALS", output, Value::Real(dial.sample(frame)?)))).collect()
    }

    /// Whether no dial has something to send.
    pub(super) fn is_idle(&self) -> bool {
        self.dials.iter().all(|dial| dial.due().is_none())
    }

    fn dial(&mut self, dial: u8) -> Option<&mut Dial> {
        self.dials.get_mut(usize::from(dial).wrapping_sub(1))
    }
}

impl Dial {
    /// What a sample would send now.
    fn due(&self) -> Option<f64> {
        let (change, value) =
            if self.absolute { (self.position - self.sent, self.position) } else { (self.pending, self.pending) };
        let enough = change != 0.0 && change.abs() * STEPS + ROUNDING >= f64::from(self.minimum);
        enough.then_some(value)
    }

    fn sample(&mut self, frame: u64) -> Option<f64> {
        let samples_until = |frame: u64| frame * u64::from(self.samples) / FRAMES_PER_SECOND;
        if samples_until(frame) == samples_until(frame.saturating_sub(1)) {
            return None;
        }
        let value = self.due()?;
        self.pending = 0.0;
        self.sent = self.position;
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What dial 1 sends over some frames while it is turned by a step of `turns` before each.
    fn sent(settings: &[DialSetting], frames: u64, turns: f64) -> Vec<(u64, f64)> {
        let mut dials = Dials::default();
        settings.iter().for_each(|setting| dials.set(1, *setting));
        let mut sent = Vec::new();
        for frame in 1..=frames {
            dials.turn(1, turns);
            for (name, output, value) in dials.sample(frame) {
                assert_eq!((name, output), ("DIALS", 1));
                sent.push((frame, value.number().unwrap()));
            }
        }
        sent
    }

    #[test]
    fn a_relative_dial_sends_its_change_at_each_sample_and_loses_none() {
        assert_eq!(sent(&[], 3, 0.25), [(1, 0.25), (2, 0.25), (3, 0.25)]);
        let slow = sent(&[DialSetting::SamplesPerSecond(20)], 60, 0.25);
        assert_eq!(slow.len(), 20);
        assert_eq!(slow[..2], [(3, 0.75), (6, 0.75)]);
        let odd = sent(&[DialSetting::SamplesPerSecond(7)], 600, 0.25);
        assert_eq!((odd.len(), odd.iter().map(|s| s.1).sum::<f64>()), (70, 150.0));
    }

    #[test]
    fn an_absolute_dial_sends_its_position_when_that_changes() {
        let absolute = [DialSetting::Absolute(true)];
        assert_eq!(sent(&absolute, 3, 0.25), [(1, 0.25), (2, 0.5), (3, 0.75)]);
        assert_eq!(sent(&absolute, 3, 0.0), []);
        assert_eq!(sent(&[DialSetting::Absolute(true), DialSetting::Reset(2.0)], 1, -0.5), [(1, 1.5)]);
    }

    #[test]
    fn small_changes_wait_until_they_are_large_enough() {
        // Eight steps are 1/128 of a turn.
        let sent = sent(&[DialSetting::MinimumChange(8)], 8, 1.0 / 256.0);
        assert_eq!(sent, [(2, 1.0 / 128.0), (4, 1.0 / 128.0), (6, 1.0 / 128.0), (8, 1.0 / 128.0)]);
        let mut dials = Dials::default();
        dials.set(1, DialSetting::MinimumChange(8));
        dials.turn(1, 1.0 / 256.0);
        assert!(dials.is_idle(), "a change that is too small makes no work");
        dials.turn(1, 1.0 / 256.0);
        assert!(!dials.is_idle());
    }

    #[test]
    fn dials_that_do_not_exist_and_turns_without_end_are_no_matter() {
        let mut dials = Dials::default();
        for dial in [0, 9, 255] {
            dials.turn(dial, 1.0);
            dials.set(dial, DialSetting::Reset(1.0));
        }
        dials.turn(1, f64::NAN);
        dials.turn(1, f64::INFINITY);
        assert!(dials.is_idle() && dials.sample(1).is_empty());
    }
}
