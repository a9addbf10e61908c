//! A report of a solution: what it took, how good it is, and where the light went.

use serde::Serialize;

/// A report of a solution: what it took, how good it is, and where the light went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RadiosityReport {
    /// Sides of triangles that light may come to.
    pub patches: usize,
    /// Elements into which they are divided.
    pub elements: usize,
    /// Pairs of nodes that exchange light.
    pub links: usize,
    /// Steps of the solver, the last time.
    pub steps: u32,
    /// A bound of the error of the solver, as a part of the greatest irradiance by other elements.
    pub solver_error: f64,
    /// The part of all light exchanged that elements keep to themselves because form factors did not add up.
    pub unbalanced: f64,
    /// How far rays changed what large regions receive of each other: the sum of all changes, as a part of all flux.
    pub correction: f64,
    /// The standard error of what all elements receive of each other, as rays tell it, as a part of that.
    pub standard_error: f64,
    /// Flux that comes to elements straight from lights, and that they send from elsewhere: W, all bands together.
    pub arrived: f64,
    /// Flux that they absorb.
    pub absorbed: f64,
    /// Flux that leaves them and comes to no other element.
    pub escaped: f64,
    /// The rest of the flux that arrived: the error of the balance.
    pub left: f64,
    /// Wall-clock time, seconds.
    pub seconds: f64,
}

impl RadiosityReport {
    /// The report in words, a line each.
    pub fn lines(&self) -> [String; 3] {
        let RadiosityReport { patches, elements, links, steps, solver_error, unbalanced, seconds, .. } = *self;
        let RadiosityReport { correction, standard_error, arrived, absorbed, escaped, left, .. } = *self;
        [
            format!(
                "{elements} elements of {patches} patches, {links} links, {steps} steps of the solver in {seconds:.3} s; \
                 error of the solver at most {solver_error:.1e}, form factors out of balance by {unbalanced:.1e}"
            ),
            format!(
                "regions corrected by rays by {:.2} %, standard error of all light of others {:.2} %",
                100.0 * correction,
                100.0 * standard_error
            ),
            format!("flux {arrived:.6}: {absorbed:.6} absorbed, {escaped:.6} escaped, {left:.1e} left"),
        ]
    }
}
