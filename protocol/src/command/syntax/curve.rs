//! Curves, which become vector lists.

/// `[RATIONAL] BSPLINE ORDER = k ... CHORDS = q`.
#[derive(Clone, Debug, PartialEq)]
pub struct Bspline {
    /// Whether the vertices have a weight.
    pub rational: bool,
    /// Degree + 1, 1..=10.
    pub order: u8,
    /// Whether the last vertex joins the first.
    pub closed: bool,
    /// Uniform knots (the default of closed curves), or end knots of full multiplicity (that of open ones).
    pub periodic: bool,
    /// 2 or 3: coordinates that the client gave for each vertex.
    pub dimension: u8,
    /// `N = n`: the client's count of vertices.
    pub estimate: Option<u32>,
    /// x, y, z (0 if 2D) and weight (1 if not rational) of each vertex.
    pub vertices: Vec<[f64; 4]>,
    /// Knots, if given.
    pub knots: Option<Vec<f64>>,
    /// Number of straight pieces.
    pub chords: u32,
}

impl Bspline {
    /// Highest order, also of polynomials, as remembered from the manuals.
    pub const MAX_ORDER: u8 = 10;
    /// Most vertices, and most knots. Ours.
    pub const MAX_VERTICES: usize = 1 << 16;
    /// Most chords, also of polynomials. Ours.
    pub const MAX_CHORDS: u32 = 1 << 20;
}

/// `[RATIONAL] POLYNOMIAL ORDER = i COEFFICIENTS = ... CHORDS = q`.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// Whether there is a fourth polynomial that divides the others.
    pub rational: bool,
    /// `ORDER = i`: the degree, one less than the number of rows.
    pub order: Option<u8>,
    /// 2 or 3: coordinates that the client gave in each row.
    pub dimension: u8,
    /// x, y, z (0 if 2D) and w (0, and 1 in the last row, if not rational) of each power of t, the highest first.
    pub coefficients: Vec<[f64; 4]>,
    /// Number of straight pieces.
    pub chords: u32,
}
