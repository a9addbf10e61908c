//! What a rendering makes: lines or an image.

use glam::DVec3;

/// A line that a rendering draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Its ends in the coordinates of the rendering node.
    pub ends: [DVec3; 2],
    /// Hue and saturation.
    pub color: [f64; 2],
}

/// A part of the raster screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Columns left of it.
    pub left: u32,
    /// Lines below it.
    pub bottom: u32,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Red, green and blue; the bottom line first, left to right.
    pub pixels: Vec<[u8; 3]>,
}

/// What a rendering makes.
#[derive(Clone, Debug, PartialEq)]
pub enum RenderingResult {
    /// Lines for the vector screen.
    Lines(Vec<Segment>),
    /// An image for the raster screen.
    Image(Image),
}
