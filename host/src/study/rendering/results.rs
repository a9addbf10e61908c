//! What a study of renderers found: rows of settings, and a verdict for each knob.

use super::error_floor::ErrorFloor;
use super::measure::ErrorMeasures;
use crate::render::Technique;
use serde::Serialize;

/// Error against run time of renderers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RenderStudy {
    /// One study for each renderer and knob.
    pub knobs: Vec<KnobStudy>,
    /// Whether nothing is missing because the study was stopped.
    pub complete: bool,
}

/// One knob of one renderer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KnobStudy {
    /// The renderer.
    pub technique: Technique,
    /// The knob.
    pub name: &'static str,
    /// What it sets, with its unit.
    pub sets: &'static str,
    /// How the scene has it.
    pub scene: f64,
    /// How the reference has it.
    pub best: f64,
    /// What the reference is.
    pub reference: String,
    /// Root mean squared error of the reference, by its halves: what is less than about this cannot be told.
    pub reference_error: f64,
    /// What the reference took, seconds; it may serve several knobs.
    pub reference_seconds: f64,
    /// Its settings, from the coarsest to the finest.
    pub rows: Vec<RenderRow>,
    /// The floor of its error, if it has one.
    #[serde(rename = "bend")]
    pub error_floor: Option<ErrorFloor>,
    /// What the rows tell, in words.
    pub verdict: String,
}

/// One setting of a knob.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RenderRow {
    /// The setting.
    pub setting: f64,
    /// Run time, seconds: the least of some runs; with the making of triangles if these depend on the knob.
    pub seconds: f64,
    /// From the scene to a renderer that has taken it up, seconds.
    pub build: f64,
    /// How far it is from the reference.
    #[serde(flatten)]
    pub measures: ErrorMeasures,
}

impl RenderRow {
    /// Mean squared error times run time: where all error is noise, more samples do not change it.
    pub fn cost(&self) -> f64 {
        self.measures.rmse.powi(2) * self.seconds
    }
}
