//! What of a scene is drawn, and how finely.

/// Vectors that a picture with instances has at the most, unless more or fewer are asked for: about as many as the beam
/// draws 30 times a second, when most of them are short.
const MOST_VECTORS: usize = 40_000;
/// Corners of polygons that a scene with instances has at the most, unless more or fewer are asked for: the machine shades
/// so many within a second.
const MOST_CORNERS: usize = 200_000;

/// The lines of objects that are sent, and how they are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawing {
    /// The edges of the objects that are sent.
    pub lines: DrawnEdges,
    /// Edges at which two triangles meet at more than this angle are sent whatever `lines` says, degrees.
    pub crease_degrees: f64,
    /// Largest distance between a curved surface and its triangles, as a part of the object's diagonal.
    pub tolerance: f64,
    /// Whether polygons are sent instead of vectors, with materials and lights, below a node `SHADE` that renders them:
    /// a SURFACE_RENDERING. The lines are then those of its pictures without hidden lines.
    pub facets: bool,
    /// Vectors of a picture, or corners of its polygons, to which instances are thinned out; without it, as many as the
    /// machine draws 30 times a second, or shades within a second.
    pub most: Option<usize>,
    /// How long what moves does so on the workstation before it begins anew; without it, everything stands where it is
    /// in the middle of the time in which the shutter is open.
    pub motion: Option<MotionPeriod>,
}

/// The edges of objects that are sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum DrawnEdges {
    /// Creases, boundaries, and the parameter lines of curved surfaces; all edges of a mesh that has none.
    Grid,
    /// Creases and boundaries, and the outline that the camera sees.
    Outline,
    /// All edges of all triangles.
    All,
}

/// How long what moves on the workstation does so before it begins anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionPeriod {
    /// The shortest time of one second to ten minutes after which everything is back where it was, so that nobody sees
    /// where it begins anew; four seconds if there is none.
    Seamless,
    /// So many seconds, rounded to frames of 1/60 s, at least one.
    Seconds(f64),
}

impl Default for Drawing {
    fn default() -> Drawing {
        Drawing {
            lines: DrawnEdges::Grid,
            crease_degrees: 25.0,
            tolerance: 1.0 / 400.0,
            facets: false,
            most: None,
            motion: None,
        }
    }
}

impl Drawing {
    /// Vectors, or corners of polygons, to which instances are thinned out.
    pub fn most(&self) -> usize {
        self.most.unwrap_or(if self.facets { MOST_CORNERS } else { MOST_VECTORS })
    }
}
