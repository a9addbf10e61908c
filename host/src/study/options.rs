//! The options of a study: size of its pictures, samples, settings and threads.

use crate::scene::Scene;
use std::num::NonZeroUsize;

/// How a study is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Columns of the pictures; the rows follow from the shape of the scene's picture.
    pub width: u32,
    /// Samples in each pixel of the reference, or of every picture where the samples are not what is studied.
    pub samples: u32,
    /// How many settings are tried.
    pub settings: u32,
    /// Threads; every core without a number.
    pub threads: Option<NonZeroUsize>,
}

/// The scene with the picture size of a study.
pub(super) fn resized(scene: &Scene, options: &Options) -> Scene {
    let mut scene = scene.clone();
    let settings = &mut scene.settings;
    let width = options.width.max(1);
    let rows = f64::from(settings.image.height) * f64::from(width) / f64::from(settings.image.width.max(1));
    settings.image.height = (rows.round() as u32).max(1);
    settings.image.width = width;
    scene
}
