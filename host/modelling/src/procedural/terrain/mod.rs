//! Terrain: heights as a function of the place, met by rays exactly, with triangles to a tolerance.

mod error;
mod four;
mod octaves;
mod parameters;
mod enclosure;
mod octave_sum;
mod grid;
mod form;
mod interval;
mod point;
mod fractal;
mod function;
mod field;
mod march;
mod certificate;
mod spline;
mod height_lattice;
mod triangulation;
mod displacement;
mod erosion;

pub use certificate::{ProofBy, Verdict, certify, crossing_by_subdivision};
pub use displacement::MidpointDisplacement;
pub use enclosure::Enclosure;
pub use erosion::{
    EROSION_PARAMETERS, ErodedTerrain, ErosionAccount, ErosionEdge, ErosionParameter, ErosionSettings, RiverOutcome,
    erode,
};
pub use error::TerrainError;
pub use field::HeightField;
pub use fractal::{FRACTALS, FractalKind, FractalRow};
pub use function::{HeightFunction, MOST_NESTED};
pub use grid::HeightGrid;
pub use interval::{BoundedSlopes, Interval};
pub use march::{TerrainHit, TerrainWork};
pub use octaves::MOST_OCTAVES;
pub use parameters::{FRACTAL_PARAMETERS, FractalParameter, FractalParameters};
pub use spline::{GroundView, TerrainCosts, TerrainSurface};
pub use triangulation::TerrainTriangles;

#[cfg(test)]
mod tests;
