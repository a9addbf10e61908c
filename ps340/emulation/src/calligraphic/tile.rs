//! The tiles in which the light of a picture lies.

/// Pixels are written in multiples of this number, into padding beyond the last one if need be.
pub(super) const LANES: usize = 8;
/// Width of a tile in pixels.
pub(super) const TILE_WIDTH: usize = 64;
/// Height of a tile in pixels.
pub(super) const TILE_HEIGHT: usize = 32;
/// Floats of a row of a tile: with padding for a whole vector of lanes that begins at the last pixel.
pub(super) const STRIDE: usize = TILE_WIDTH + LANES;
/// Floats of a plane of a tile.
pub(super) const PLANE: usize = STRIDE * TILE_HEIGHT;

/// The light of 64 by 32 pixels. Memory is allocated when light first falls on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Tile {
    /// A plane for each gun: what one refresh writes. Worth something if `lit`.
    pub planes: Vec<f32>,
    /// Whether the picture writes here.
    pub lit: bool,
    /// A plane for each slow component of the phosphor: what it sends out in a frame. Worth something if `glowing`.
    pub glow: Vec<f32>,
    /// Whether a slow component is seen.
    pub glowing: bool,
    /// Whether the exposed picture is other than black here.
    pub visible: bool,
}

/// Columns and rows of tiles of a picture.
pub(super) fn tiles([width, height]: [usize; 2]) -> [usize; 2] {
    [width.div_ceil(TILE_WIDTH), height.div_ceil(TILE_HEIGHT)]
}
