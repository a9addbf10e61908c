//! How a picture is to be made.

use crate::picture::Filter;
use crate::scene::{ImageSettings, Settings};
use std::num::NonZeroUsize;

/// How a picture is to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderOrder {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples in each pixel, 1 and more; one samples the centre. With a target or a budget, the most of them.
    pub samples: u32,
    /// So many samples of a pixel share the footprint in which textures are filtered, 1 and more: as many as there are,
    /// or are thought to become.
    pub footprints: u32,
    /// How samples around a pixel become one value.
    pub filter: Filter,
    /// Relative error of the luminance at which a pixel has samples enough; none for all samples everywhere.
    pub target: Option<f64>,
    /// Seconds after which no sample is begun.
    pub seconds: Option<f64>,
    /// Whether samples that hit nothing are black: a picture whose radiance is premultiplied by its coverage. The
    /// background behind glass and in mirrors stays.
    pub matte: bool,
    /// Whether the picture is denoised, by ray tracing; scan line has no noise.
    pub denoise: bool,
    /// Seed of the sample positions.
    pub seed: u64,
    /// Threads; every core without a number.
    pub threads: Option<NonZeroUsize>,
}

impl RenderOrder {
    /// The order that the scene's settings ask for, on every core.
    pub fn of(settings: &Settings) -> RenderOrder {
        let ImageSettings { width, height, samples, filter, seed } = settings.image;
        RenderOrder {
            width,
            height,
            samples,
            footprints: samples,
            filter,
            target: None,
            seconds: None,
            matte: false,
            denoise: false,
            seed,
            threads: None,
        }
    }
}
