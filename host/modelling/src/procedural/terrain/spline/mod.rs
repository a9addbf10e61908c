//! Terrain as rays meet it: a smooth surface of biquadratic B-splines whose control heights are those of the height
//! function, on lattices that are as fine as the surface is seen.
//!
//! A square of cells is halved again and again. The control heights of a level stand above the middles of its cells.
//! Those of the next level are either what the spline of this level has there, as corner cutting gives it, or the
//! heights of the function, with those octaves that the finer lattice can hold; in between both are mixed. How much of
//! each depends on the place and on the views alone. So the surface is one for all rays, has no cracks and no steps,
//! changes smoothly with the views, and is polynomial in each of its cells, where rays meet it exactly.
//!
//! # Source
//! Corner cutting with displacements: Miller 1986, "The definition and rendering of terrain maps". Corner cutting: Chaikin
//! 1974; Riesenfeld 1975.

mod patch;
mod ground;
mod block;
mod surface;
mod walk;

#[cfg(test)]
mod tests;

pub use ground::GroundView;
pub use surface::{TerrainCosts, TerrainSurface};
