//! Random choices of a sample: each has its number, so that what one needs does not move another.

use crate::numeric::sequence::Sequence;

/// What a choice is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub(super) enum Purpose {
    /// Place in the pixel.
    Pixel,
    /// Place on the lens.
    Lens,
    /// Which comb of wavelengths, and which of them where they part.
    Wavelengths,
    /// Which lobe carries a ray on.
    Choice,
    /// Whether a faint leg goes on.
    Survival,
    /// The direction in which it goes on.
    Direction,
    /// Points of lights: one purpose for each from here on.
    Lights,
    /// When the sample is taken; beyond all that points of lights may have.
    Time = 1 << 31,
}

/// The choices of one sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draws {
    sequence: Sequence,
    index: u32,
    of: u32,
    /// When the sample is taken, from the middle of the time in which the shutter is open.
    pub(super) time: f64,
}

impl Draws {
    /// - `seed`: of the picture. `pixel`: its number. `index`: of the sample, of `of` at the most.
    pub(super) fn new(seed: u64, pixel: u64, index: u32, of: u32) -> Draws {
        Draws { sequence: Sequence::new(seed, pixel), index, of, time: 0.0 }
    }

    /// The same at a time drawn from those in which a shutter is open for so long; a single sample in their middle.
    pub(super) fn within(self, shutter: f64) -> Draws {
        let part = if self.of <= 1 { 0.5 } else { self.point(Purpose::Time)[0] };
        Draws { time: (part - 0.5) * shutter, ..self }
    }

    /// Where in the pixel the sample lies, 0..1 both; a single one in the middle.
    pub(super) fn position(&self) -> [f64; 2] {
        if self.of <= 1 { [0.5; 2] } else { self.sequence.point(self.index, Purpose::Pixel as u64) }
    }

    /// A point of the unit square for the sample as a whole.
    pub(super) fn point(&self, purpose: Purpose) -> [f64; 2] {
        self.sequence.point(self.index, purpose as u64)
    }

    /// A point of the unit square for a leg of the sample's way.
    ///
    /// - `leg`: its number, above 0, unlike that of all other legs. `more`: which of several for the same purpose.
    pub(super) fn leg(&self, leg: u32, purpose: Purpose, more: u32) -> [f64; 2] {
        self.sequence.point(self.index, u64::from(leg) << 32 | (purpose as u64 + u64::from(more)))
    }
}
