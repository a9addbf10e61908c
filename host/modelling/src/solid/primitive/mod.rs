//! The solids of the book: each a few measures, and a body between exact surfaces that comes of them.
//!
//! What has an axis has it along y. Blocks, quadrics and the torus lie around the origin; polygons and profiles stay where
//! their coordinates are.

mod error;
mod flat;
mod half_space;
mod kind;
mod patches;
mod revolution;
mod round;
mod sweep;

pub use error::PrimitiveError;
pub use flat::{block, prism, pyramid, wedge};
pub use half_space::half_space;
pub use kind::Primitive;
pub use patches::sculptured;
pub use revolution::{revolution, revolved_polygon, smooth_revolution};
pub use round::{
    cylinder, ellipsoid, frustum, hyperboloid_of_one_sheet, hyperboloid_of_two_sheets, paraboloid, sphere, torus,
};
pub use sweep::{path, sweep};

#[cfg(test)]
mod tests;
