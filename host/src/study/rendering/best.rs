//! The knobs of a renderer in a scene: which of them change anything, and all of them at their best.

use super::knob::{RENDER_KNOBS, RenderKnob};
use super::setup::{Setup, StudiedScene};
use crate::plan::Stage;
use crate::render::Technique;

/// The knobs that a renderer has.
pub(super) fn knobs_of(technique: Technique) -> impl Iterator<Item = &'static RenderKnob> {
    RENDER_KNOBS.iter().filter(move |knob| (knob.renderers)(technique.row()))
}

impl StudiedScene {
    /// The reason for which a knob changes nothing, or nothing that it does not change by another renderer, where that
    /// is so.
    pub(super) fn idle(&self, technique: Technique, knob: &RenderKnob) -> Option<&'static str> {
        let why = "no photons are traced from lamps: this is ray tracing";
        let not_followed = technique.row().always_maps_photons.then(|| self.lacks(Stage::PhotonMap, why)).flatten();
        not_followed.or_else(|| (knob.idle)(self))
    }

    /// Every knob at its best, but those that say which light counts: of these only the one that is studied.
    pub(super) fn best(&self, technique: Technique, studied: &RenderKnob) -> Setup {
        let mut setup = self.own(technique);
        for knob in knobs_of(technique).filter(|knob| self.idle(technique, knob).is_none()) {
            if !knob.is_model || knob.name == studied.name {
                (knob.set)(&mut setup, (knob.best)(self, technique));
            }
        }
        setup
    }
}
