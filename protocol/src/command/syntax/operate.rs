//! The settings of operate commands besides numbers: axes, boundaries, screens, phases, comparisons.

/// An axis of rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// x, to the right.
    X,
    /// y, up.
    Y,
    /// z, into the screen.
    Z,
}

/// Front and back boundary of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundaries {
    /// Nearest z.
    pub front: f64,
    /// Farthest z.
    pub back: f64,
}

/// The screens that SET DISPLAYS means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scopes {
    /// All.
    All,
    /// Bit n for screen n, 0..=3; at least one.
    Some(u8),
}

/// How characters stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum CharacterOrientation {
    /// Transformed like vectors.
    #[default]
    World,
    /// Unrotated, but scaled.
    Screen,
    /// Neither rotated nor scaled, at full intensity.
    ScreenFixed,
}

/// The phases of SET RATE, in refresh frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    /// Frames of the ON phase.
    pub on: u32,
    /// Frames of the OFF phase.
    pub off: u32,
    /// The state before the first change; default ON.
    pub initial: bool,
    /// Frames before the first phase begins; default 0.
    pub delay: u32,
}

/// A comparison of levels of detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `<`
    Less,
    /// `=`
    Equal,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `<>`
    NotEqual,
    /// `>=`
    GreaterEqual,
}

impl Comparison {
    /// Every comparison, in the order of its code in the library of the time: 0 less to 5 greater or equal. \[S\]
    pub const ALL: [Comparison; 6] = [
        Comparison::Less,
        Comparison::Equal,
        Comparison::LessEqual,
        Comparison::Greater,
        Comparison::NotEqual,
        Comparison::GreaterEqual,
    ];

    /// The sign in commands.
    pub const fn sign(self) -> &'static str {
        match self {
            Comparison::Less => "<",
            Comparison::Equal => "=",
            Comparison::LessEqual => "<=",
            Comparison::Greater => ">",
            Comparison::NotEqual => "<>",
            Comparison::GreaterEqual => ">=",
        }
    }

    /// Whether `left` compares so with `right`.
    pub fn holds(self, left: i32, right: i32) -> bool {
        match self {
            Comparison::Less => left < right,
            Comparison::Equal => left == right,
            Comparison::LessEqual => left <= right,
            Comparison::Greater => left > right,
            Comparison::NotEqual => left != right,
            Comparison::GreaterEqual => left >= right,
        }
    }
}
