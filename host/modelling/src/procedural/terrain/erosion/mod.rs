//! Erosion of heights on a grid: by running water, by slides to the angle of repose, and by rivers over long times.

mod settings;
mod account;
mod ground;
mod flow;
mod hydraulic;
mod thermal;
mod receivers;
mod depressions;
mod drainage;
mod hillslope;
mod stream_power;
mod eroded;

pub use account::ErosionAccount;
pub use eroded::{ErodedTerrain, erode};
pub use settings::{EROSION_PARAMETERS, ErosionEdge, ErosionParameter, ErosionSettings};
pub use stream_power::RiverOutcome;

#[cfg(test)]
mod drainage_tests;
#[cfg(test)]
mod eroded_tests;
#[cfg(test)]
mod hydraulic_tests;
#[cfg(test)]
mod stream_power_tests;
#[cfg(test)]
mod thermal_tests;
