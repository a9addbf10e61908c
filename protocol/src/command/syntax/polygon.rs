//! Data for surfaces: polygons, what they look like, and lights.

use crate::Name;
use glam::DVec3;

/// One polygon of a POLYGON command.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// `WITH ATTRIBUTES name` given here; it holds for this and the following polygons of the command.
    pub attributes: Option<Name>,
    /// `OUTLINE hue` given here, degrees; it holds for this and the following polygons of the command.
    pub outline: Option<f64>,
    /// Whether it lies in the plane of the polygon before and belongs to it: a hole or a further outline.
    pub coplanar: bool,
    /// Its corners, 3..=250; the closing edge is implied.
    pub vertices: Vec<PolygonVertex>,
}

impl Polygon {
    /// Most corners of one polygon, as remembered from the manuals.
    pub const MAX_VERTICES: usize = 250;
}

/// A corner of a polygon: `S x,y,z N nx,ny,nz C h,s,i AND h,s,i`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonVertex {
    /// Whether the edge that ends here is soft: smoothed in shading.
    pub soft: bool,
    /// Where it is.
    pub position: [f32; 3],
    /// The normal for smooth shading; given for all corners of a polygon or for none.
    pub normal: Option<[f32; 3]>,
    /// The colour there, in the place of that of ATTRIBUTES; given for all corners of a polygon or for none.
    pub color: Option<CornerColor>,
}

/// The colour of the corner of a polygon: hue in degrees, saturation 0..=1 and intensity 0..=1.
///
/// # Source
/// That there are such colours: the names of two GSR routines for later models. The syntax is ours, after ATTRIBUTES.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornerColor {
    /// On the front side.
    pub front: [f32; 3],
    /// On the reverse side, after AND; like the front if not given.
    pub back: Option<[f32; 3]>,
}

/// What one side of a polygon looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceColor {
    /// Hue in degrees, saturation 0..=1 and intensity 0..=1; default white.
    pub color: [f64; 3],
    /// Share of diffuse reflection, 0..=1; default 0.75.
    pub diffuse: f64,
    /// Concentration of the highlight, 0..=10; default 4.
    pub specular: u8,
    /// 1 opaque, 0 transparent; default 1.
    pub opaque: f64,
}

impl Default for SurfaceColor {
    fn default() -> SurfaceColor {
        SurfaceColor { color: [0.0, 0.0, 1.0], diffuse: 0.75, specular: 4, opaque: 1.0 }
    }
}

/// `ATTRIBUTES COLOR h,s,i DIFFUSE d SPECULAR s OPAQUE t AND ...`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attributes {
    /// The front sides.
    pub front: SurfaceColor,
    /// The reverse sides, after AND; like the front if not given.
    pub back: Option<SurfaceColor>,
}

/// `ILLUMINATION x,y,z COLOR h,s,i AMBIENT a`: a light at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// Where the light goes, of any length: 0,0,1 goes along the line of sight, from behind the viewer.
    pub direction: DVec3,
    /// Hue in degrees, saturation and intensity 0..=1; default white.
    pub color: [f64; 3],
    /// Its share in the ambient light, 0..=1; default 1.
    pub ambient: f64,
}
