//! Tiles: pieces of surfaces with the colours that are seen at their corners.

use glam::DVec3;

/// A piece of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorTile {
    /// Its corners, counter-clockwise seen from outside, in scene coordinates; 3 and more.
    pub corners: Vec<DVec3>,
    /// The colours seen at each of them from outside and from inside: red, green and blue of sRGB as displays get them,
    /// 0..=1.
    pub colors: Vec<[DVec3; 2]>,
}

/// A corner of a tile, and the weights of the corners of its triangle there.
pub(super) type TileCorner = (DVec3, [f64; 3]);
