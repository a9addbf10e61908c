//! The shape of a crown: how long boughs are by their height, and the envelope to which a tree is cut back.

use std::f64::consts::{FRAC_PI_2, PI};

/// The shape of a crown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CrownShape {
    /// Boughs are the longer, the lower they are.
    #[default]
    Conical,
    /// Longest at the middle.
    Spherical,
    /// Longest below, as half a ball.
    Hemispherical,
    /// All of one length.
    Cylindrical,
    /// Half as long above as below.
    TaperedCylindrical,
    /// Longest at a third of the height, with points above and below.
    Flame,
    /// The longer, the higher they are.
    InverseConical,
    /// Longest at a third of the height, half as long above and below.
    TendFlame,
}

/// The shapes with their words, in the order of Weber and Penn.
pub const CROWN_SHAPES: [(&str, CrownShape); 8] = [
    ("conical", CrownShape::Conical),
    ("spherical", CrownShape::Spherical),
    ("hemispherical", CrownShape::Hemispherical),
    ("cylindrical", CrownShape::Cylindrical),
    ("tapered_cylindrical", CrownShape::TaperedCylindrical),
    ("flame", CrownShape::Flame),
    ("inverse_conical", CrownShape::InverseConical),
    ("tend_flame", CrownShape::TendFlame),
];

impl CrownShape {
    /// How long a bough is, in parts of the longest.
    ///
    /// - `depth`: where it stands in the crown, 0 at its top to 1 at its base.
    ///
    /// # Source
    /// Weber and Penn 1995, section 4.3, ShapeRatio.
    pub fn ratio(self, depth: f64) -> f64 {
        let peaked = |low: f64| {
            if depth <= 0.7 { low + (1.0 - low) * depth / 0.7 } else { low + (1.0 - low) * (1.0 - depth) / 0.3 }
        };
        match self {
            CrownShape::Conical => 0.2 + 0.8 * depth,
            CrownShape::Spherical => 0.2 + 0.8 * (PI * depth).sin(),
            CrownShape::Hemispherical => 0.2 + 0.8 * (FRAC_PI_2 * depth).sin(),
            CrownShape::Cylindrical => 1.0,
            CrownShape::TaperedCylindrical => 0.5 + 0.5 * depth,
            CrownShape::Flame => peaked(0.0),
            CrownShape::InverseConical => 1.0 - 0.8 * depth,
            CrownShape::TendFlame => peaked(0.5),
        }
    }
}

/// The envelope to which the crown of a tree is cut back.
#[derive(Clone, Copy, Debug)]
pub(super) struct PruningEnvelope {
    /// Height of the tree, and where its crown begins, units of length.
    pub height: f64,
    pub base: f64,
    /// Its largest radius in parts of the height, where that is in parts of the crown from below, and the powers of its
    /// curve below and above.
    pub width: f64,
    pub peak: f64,
    pub low: f64,
    pub high: f64,
}

impl PruningEnvelope {
    /// Whether a place is inside.
    ///
    /// - `radius`: distance from the axis of the tree.
    ///
    /// # Source
    /// Weber and Penn 1995, section 4.6.
    pub fn contains(&self, radius: f64, height: f64) -> bool {
        let ratio = (self.height - height) / (self.height - self.base);
        radius <= self.width * self.height * self.part(ratio)
    }

    fn part(&self, ratio: f64) -> f64 {
        let below = 1.0 - self.peak;
        match ratio {
            ratio if !(0.0..=1.0).contains(&ratio) => 0.0,
            ratio if ratio < below => (ratio / below).powf(self.high),
            ratio if self.peak > 0.0 => ((1.0 - ratio) / self.peak).powf(self.low),
            _ => 1.0,
        }
    }
}
