//! Fractals of octaves of noise: one file a kind.

mod kind;
mod fbm;
mod heterogeneous;
mod hybrid;
mod ridged;

pub(super) use kind::Fractal;
pub use kind::{FractalKind, FractalRow};

use super::form::Form;

/// All kinds of fractal terrain.
pub const FRACTALS: &[FractalRow] = &[fbm::ROW, heterogeneous::ROW, hybrid::ROW, ridged::ROW];

impl Fractal {
    /// Heights over a place.
    ///
    /// - `footprint`: what is finer is left out, with smooth edges.
    pub(super) fn heights<F: Form>(&self, place: &F::Place, footprint: f64) -> F {
        match self.kind {
            FractalKind::Fbm => fbm::heights(self, place, footprint),
            FractalKind::Heterogeneous => heterogeneous::heights(self, place, footprint),
            FractalKind::Hybrid => hybrid::heights(self, place, footprint),
            FractalKind::Ridged => ridged::heights(self, place, footprint),
        }
    }
}
