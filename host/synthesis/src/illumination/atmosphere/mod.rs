//! The sky of a clear day: light of the sun that air, haze and ozone scatter and absorb, wavelength by wavelength, and
//! the ground below.
//!
//! Single scattering is integrated along the line of sight; all further scattering is taken for isotropic. Fitted
//! models, of Hosek and Wilkie 2012 or Wilkie and others 2021, are tables of 13 thousand and of many millions of
//! numbers that end at the horizon; this one needs a page of measured figures, and knows twilight, altitude and the
//! ground.
//!
//! *Not modelled*: polarisation, refraction, clouds, light that the ground reflects other than evenly, and stars.
//!
//! # Source
//! Hillaire 2020, *A scalable and production ready sky and atmosphere rendering technique*; figures of air by Bruneton
//! 2017.

mod solar;
mod air;
mod columns;
mod scattering;
mod sky;

#[cfg(test)]
mod tests;

pub use air::{NODES, Spectral, node};
pub use sky::{Atmosphere, COLUMNS, ClearSky, ROWS};
pub use solar::{Moment, SUN_RADIUS, solar_position};
