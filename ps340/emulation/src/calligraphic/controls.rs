//! What a person sets at the display: knobs, phosphor, steadiness, and which screen is looked at.

use super::{Beam, Exposure, PHOSPHORS, Phosphor};

/// The settings of the display.
///
/// # Source
/// That such displays had knobs for brightness, contrast and focus is remembered; their ranges and laws are ours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// 0..=1; the gain of the exposure grows with its square, from nothing at 0 to four times that of 0.5 at 1.
    pub brightness: f32,
    /// 0..=1; at 0.5 intensities are as they are, at 0 all are full, at 1 those below a half are dark. The full
    /// intensity stays.
    pub contrast: f32,
    /// 0..=1; at 1 the spot is sharp, at 0 it is ten times as wide. The light of a stroke stays the same in all.
    pub focus: f32,
    /// The phosphor of the screen.
    pub phosphor: &'static Phosphor,
    /// Whether a picture that takes long is nevertheless refreshed in every frame, and so does not flicker.
    ///
    /// On at the start, as light that flickers 3 to 30 times a second can harm people.
    pub steady: bool,
    /// The screen that is looked at, of those that SET DISPLAYS distinguishes, 0..=3.
    pub screen: u8,
}

impl Default for Controls {
    fn default() -> Self {
        Self { brightness: 0.5, contrast: 0.5, focus: 1.0, phosphor: &PHOSPHORS[0], steady: true, screen: 0 }
    }
}

/// Screens that SET DISPLAYS distinguishes.
pub const SCREENS: u8 = 4;

/// A knob of the display.
#[derive(Clone, Copy, Debug)]
pub struct Knob {
    /// What is written at it.
    pub name: &'static str,
    get: fn(&Controls) -> f32,
    set: fn(&mut Controls, f32),
}

impl PartialEq for Knob {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// The knobs, each from 0 to 1.
pub const KNOBS: &[Knob] = &[
    Knob { name: "brightness", get: |c| c.brightness, set: |c, to| c.brightness = to },
    Knob { name: "contrast", get: |c| c.contrast, set: |c, to| c.contrast = to },
    Knob { name: "focus", get: |c| c.focus, set: |c, to| c.focus = to },
];

impl Knob {
    /// Where it stands, 0..=1.
    pub fn get(&self, controls: &Controls) -> f32 {
        (self.get)(controls)
    }

    /// Turns it; values outside 0..=1 are brought inside, NaN leaves it as it is.
    pub fn set(&self, controls: &mut Controls, to: f32) {
        if !to.is_nan() {
            (self.set)(controls, to.clamp(0.0, 1.0));
        }
    }
}

impl Controls {
    /// The beam for a picture of some pixels.
    pub fn beam(&self, [width, height]: [u32; 2]) -> Beam {
        Beam { blur: 10.0_f32.powf(1.0 - self.focus), contrast: 2.0 * self.contrast, ..Beam::new(width, height) }
    }

    /// Whether what is seen depends on what was seen before, so that a display must be shown every frame.
    pub fn remembers(&self) -> bool {
        !self.steady || self.phosphor.glows()
    }

    /// The response of the picture.
    pub fn exposure(&self) -> Exposure {
        let factor = 2.0 * self.brightness;
        Exposure { gain: Exposure::default().gain * factor * factor }
    }
}
