//! The bounds of refinement.

/// The bounds of refinement: how far links are divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct RefinementBound {
    /// The greatest error of an irradiance by one link, as a part of the bright and the dim together.
    pub(super) error: f64,
    /// The mean irradiance: of the scene, and as it is shown, W/m².
    pub(super) mean: f64,
    /// What the irradiance of a receiver counts as at the least, as a part of the mean.
    pub(super) dimmest: f64,
    /// The irradiance of what pictures show, W/m²: what no picture shows counts as no dimmer.
    pub(super) shown: f64,
}

impl RefinementBound {
    /// The greatest error of the irradiance of a receiver by one link, W/m²: a part of the geometric mean of its
    /// irradiance and the mean one. A part of the mean alone would leave a dim room beside a bright garden without links,
    /// a part of its own alone would spend most links where little light is.
    ///
    /// - `least`: the least irradiance of its leaves, W/m². `importance`: the most of its leaves, 0..=1.
    pub(super) fn of(&self, least: f64, importance: f64) -> f64 {
        let least = least.max(self.dimmest * self.mean).max((1.0 - importance) * self.shown);
        self.error / importance * (self.mean * least).sqrt()
    }
}
