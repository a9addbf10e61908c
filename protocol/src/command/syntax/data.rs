//! Data nodes: vectors and text.

use glam::{DVec2, DVec3};

/// How the points of a vector list are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorClass {
    /// First a move, the others lines. The default. Code 0 \[S\].
    Connected,
    /// A dot at each point. Code 1 \[S\].
    Dots,
    /// Each says P (position) or L (line). Code 2 \[S\].
    Itemized,
    /// Pairs: odd a move, even a line. Code 3 \[S\].
    Separate,
}

impl VectorClass {
    /// The class code of the library of the time.
    pub const fn code(self) -> u8 {
        match self {
            VectorClass::Connected => 0,
            VectorClass::Dots => 1,
            VectorClass::Itemized => 2,
            VectorClass::Separate => 3,
        }
    }

    /// The class with a [`code`](Self::code).
    pub fn from_code(code: u8) -> Option<VectorClass> {
        [VectorClass::Connected, VectorClass::Dots, VectorClass::Itemized, VectorClass::Separate]
            .into_iter()
            .find(|c| c.code() == code)
    }
}

/// What the fourth component of the points of a list is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fourth {
    /// `I = i`: intensity 0..=1, 1 where not given; larger values are kept and clamped when drawn.
    #[default]
    Intensity,
    /// `COLOR` and `H = hue`: hue in degrees 0..=720, so that a blend can go either way round; 0 where not given.
    Hue,
    /// `TABULATED` and `T = t`: an index into a table; 0 where not given. Of later models.
    Table,
}

impl Fourth {
    /// Every kind, in the order of its code in binary records: 0 intensity, 1 hue, 2 table.
    pub const ALL: [Fourth; 3] = [Fourth::Intensity, Fourth::Hue, Fourth::Table];

    /// The component where a command does not give it.
    pub const fn absent(self) -> f32 {
        match self {
            Fourth::Intensity => 1.0,
            Fourth::Hue | Fourth::Table => 0.0,
        }
    }
}

/// A list of vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorList {
    /// One common exponent for all vectors. Kept, without effect on our reals.
    pub block_normalized: bool,
    /// How the points are joined.
    pub class: VectorClass,
    /// 2 or 3: the number of components that the client gave.
    pub dimension: u8,
    /// `N = n`: the client's estimate of the count.
    pub estimate: Option<u32>,
    /// What the fourth component of the points is.
    pub fourth: Fourth,
    /// `INTERNAL_UNITS`: the client gave the fixed-point numbers of the machine. Kept, without effect on our reals.
    pub internal_units: bool,
    /// x, y, z (0 if 2D) and the [`fourth`](Self::fourth) component of each point.
    pub points: Vec<[f32; 4]>,
    /// Whether the vector *to* each point is a line (L) or a move (P); as long as `points` for
    /// [`VectorClass::Itemized`], else empty.
    pub lines: Vec<bool>,
}

impl VectorList {
    /// Whether the vector to point `index` is drawn as a line, by the class. The first never is.
    pub fn is_line(&self, index: usize) -> bool {
        index > 0
            && match self.class {
                VectorClass::Connected => true,
                VectorClass::Dots => false,
                VectorClass::Itemized => self.lines.get(index).copied().unwrap_or(false),
                VectorClass::Separate => index % 2 == 1,
            }
    }
}

/// `CHARACTERS x,y,z STEP dx,dy 'text'`.
#[derive(Clone, Debug, PartialEq)]
pub struct Characters {
    /// Lower left corner of the first cell.
    pub position: DVec3,
    /// Advance from cell to cell, in cells; default (1, 0).
    pub step: DVec2,
    /// The text.
    pub text: Box<[u8]>,
}

/// One text of [`Labels`].
#[derive(Clone, Debug, PartialEq)]
pub struct LabelText {
    /// Lower left corner of the first cell.
    pub position: DVec3,
    /// The text.
    pub text: Box<[u8]>,
}

/// `LABELS x,y,z 'text' x,y,z 'text'...`: many texts in one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Labels {
    /// The texts, at least one.
    pub labels: Vec<LabelText>,
}

/// `C[code]: N = n P x,y L x,y...;` inside BEGIN_FONT: how a character is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct FontCharacter {
    /// The character, 0..=127.
    pub code: u8,
    /// `N = n`: the client's estimate of the count.
    pub estimate: Option<u32>,
    /// Each point in the unit square, with whether the vector to it is a line; the first never is.
    pub points: Vec<([f32; 2], bool)>,
}

/// `PATTERN i i... AROUND_CORNERS MATCH LENGTH r`.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// Lengths of dashes and gaps in turn, in relative units, 1..=32 of them.
    pub segments: Vec<f64>,
    /// Whether the pattern goes on from one vector to the next.
    pub around_corners: bool,
    /// Whether the length is adjusted so that the pattern comes out whole at the end of each line.
    pub matched: bool,
    /// Length of one repetition in the coordinates of the data.
    pub length: f64,
}

impl Pattern {
    /// Most lengths of one pattern, as remembered from the manuals.
    pub const MAX_SEGMENTS: usize = 32;
}
