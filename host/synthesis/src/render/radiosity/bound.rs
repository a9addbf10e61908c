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
}

impl RefinementBound {
    /// The greatest error of the irradiance of a receiver by one link, W/m²: a part of the geometric mean of its
    /// irradiance and the mean one. A part of the mean alone would leave a dim room beside a bright garden without links,
    /// a part of its own alone would spend most links where little light is.
    ///
    /// - `least`: the least irradiance of its leaves, W/m².
    pub(super) fn of(&self, least: f64) -> f64 {
        self.error * (self.mean * least.max(self.dimmest * self.mean)).sqrt()
    }
}
