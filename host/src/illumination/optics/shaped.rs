//! A fraction of light, distributed by a D of the family or by a table; Phong's highlight is one of them.

use super::lobe::{Flags, Lobe};
use super::shade::Shade;
use super::sighting::{Onward, Sighting};
use crate::color::Channels;
use crate::illumination::distribution::{Distribution, Phong};
use glam::DVec3;
use std::sync::Arc;

/// Reflects a fraction of light as a distribution has it.
#[derive(Clone, Debug)]
pub(super) struct Shaped<D> {
    pub(super) fraction: Shade,
    pub(super) form: D,
}

/// What a lobe holds a distribution by.
pub(super) trait Form {
    /// The distribution.
    fn distribution(&self) -> &dyn Distribution;
}

impl Form for Phong {
    #[inline]
    fn distribution(&self) -> &dyn Distribution {
        self
    }
}

impl Form for Arc<dyn Distribution> {
    #[inline]
    fn distribution(&self) -> &dyn Distribution {
        self.as_ref()
    }
}

impl<D: Form> Lobe for Shaped<D> {
    fn flags(&self) -> Flags {
        let density = self.form.distribution().sample_density(DVec3::Z, DVec3::Z);
        Flags::of_density(density) | Flags::BLACK.when(self.fraction.is_black())
    }

    #[inline]
    fn value(&self, sighting: &Sighting, light: DVec3) -> Channels {
        if sighting.is_behind(light) {
            return Channels::ZERO;
        }
        let view = sighting.view;
        self.fraction.of(sighting) * (self.form.distribution().density(light, view) / view.z)
    }

    #[inline]
    fn density(&self, sighting: &Sighting, light: DVec3) -> f64 {
        if sighting.is_behind(light) { 0.0 } else { self.form.distribution().sample_density(sighting.view, light) }
    }

    fn sample(&self, sighting: &Sighting, _: f64, point: [f64; 2]) -> Option<Onward> {
        self.form.distribution().sample(sighting.view, point).map(Onward::spread)
    }

    #[inline]
    fn strength(&self, sighting: &Sighting) -> f64 {
        self.fraction.of(sighting).max()
    }
}
