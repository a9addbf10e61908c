//! What functions take: names, kinds of values, defaults, help.

/// What a function takes.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name, as in the map.
    pub name: &'static str,
    /// What values it takes.
    pub kind: Kind,
    /// What it is when it is not given.
    pub default: Default,
    /// What it means, with its unit.
    pub help: &'static str,
}

/// What holds for a parameter that is not given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Default {
    /// It must be given.
    Required,
    /// The text says what holds instead.
    Is(&'static str),
}

/// What values a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// An object that another function returned; before the dot in `object.function(...)`.
    Object,
    /// A number within limits.
    Number(f64, f64),
    /// A number within limits, or a pattern of such numbers.
    Amount(f64, f64),
    /// A number within limits, or a string.
    NumberOrText(f64, f64),
    /// A whole number within limits.
    Integer(i64, i64),
    /// A length above 0.
    Length,
    /// Three numbers `[x, y, z]`; as the only arguments also without brackets.
    Vector,
    /// One number for all directions or three numbers; none is 0.
    Factors,
    /// Three lengths above 0, or one for all.
    Lengths,
    /// Reflected fractions 0 to 1: `[red, green, blue]`, or one number for all.
    Fractions,
    /// A function of one number.
    Function,
    /// The name of a distribution, or one of the user's.
    Distribution,
    /// What is reflected: fractions, the name of a spectrum, or a pattern.
    Reflectance,
    /// Powers 0 and more: `[red, green, blue]`, or one number for all.
    Powers,
    /// "x", "y", "z" or a vector `[x, y, z]`.
    Axis,
    /// A string.
    Text,
    /// true or false.
    Flag,
    /// A number, a whole number, true or false, or a string.
    Scalar,
    /// A list of points [x, y] or [x, y, z].
    Points,
    /// A list of points, or of several such lists.
    Contours,
    /// A number, a list of numbers, or several such lists.
    Numbers,
    /// A list of whole numbers from 0, or several such lists.
    Indices,
    /// A list of objects.
    Objects,
    /// A list of objects, each with the name of a side.
    Sides,
    /// What control points mean in one direction.
    Spline,
    /// A curve, or the control points of a path.
    Curve,
    /// A closed loop of curves, or several.
    Loops,
    /// One of some words.
    Word(&'static [&'static str]),
}

/// How closely the triangles of a curved object follow it.
pub(super) const TOLERANCE: Parameter = Parameter {
    name: "tolerance",
    kind: Kind::Length,
    default: Default::Is("that of the scene"),
    help: "largest distance between surface and triangles, scene units",
};

/// The object before the dot.
pub(super) const OBJECT: Parameter =
    Parameter { name: "object", kind: Kind::Object, default: Default::Required, help: "the object" };

/// A row of the parameters of a function.
pub(super) const fn parameter(name: &'static str, kind: Kind, default: Default, help: &'static str) -> Parameter {
    Parameter { name, kind, default, help }
}

impl Kind {
    /// The kind in words, as in "must be ...".
    pub fn words(self) -> String {
        match self {
            Kind::Object => "an object".into(),
            Kind::Number(min, max) if max.is_infinite() && min.is_infinite() => "a number".into(),
            Kind::Number(min, max) if max.is_infinite() => format!("a number not below {min}"),
            Kind::Number(min, max) => format!("a number from {min} to {max}"),
            Kind::Amount(min, max) => format!("{} or a pattern of such numbers", Kind::Number(min, max).words()),
            Kind::NumberOrText(min, max) => format!("{} or a string", Kind::Number(min, max).words()),
            Kind::Integer(min, max) => format!("a whole number from {min} to {max}"),
            Kind::Length => "a length above 0".into(),
            Kind::Vector => "three numbers [x, y, z]".into(),
            Kind::Factors => "a number or three [x, y, z], none of them 0".into(),
            Kind::Lengths => "a length above 0, or three [x, y, z]".into(),
            Kind::Fractions => "a number from 0 to 1, or three [red, green, blue]".into(),
            Kind::Reflectance => {
                "a number from 0 to 1, three [red, green, blue], the name of a reflectance, or a pattern".into()
            }
            Kind::Powers => "a number not below 0, or three [red, green, blue]".into(),
            Kind::Axis => "\"x\", \"y\", \"z\" or a vector [x, y, z]".into(),
            Kind::Text => "a string".into(),
            Kind::Function => "a function |x| ... of a number".into(),
            Kind::Distribution => "a name, or what user_distribution() returned".into(),
            Kind::Flag => "true or false".into(),
            Kind::Scalar => "a number, true or false, or a string".into(),
            Kind::Points => "a list of points [[x, y], ...], with a third number where it is used".into(),
            Kind::Contours => "a list of points [[x, y], ...] or a list of such lists".into(),
            Kind::Numbers => "a number or a list of numbers, or several lists of them".into(),
            Kind::Indices => "a list of whole numbers from 0, or several such lists".into(),
            Kind::Objects => "a list of objects".into(),
            Kind::Sides => {
                "a list of pairs of an object and one of \"low u\", \"high u\", \"low v\", \"high v\"".into()
            }
            Kind::Spline => "what bezier(), b_spline(), beta_spline() or bbb_spline() return".into(),
            Kind::Curve => "a curve, or a list of points [[x, y, z], ...]".into(),
            Kind::Loops => {
                "a list of loops, each a closed curve, a list of curves, or a list of corners [[u, v], ...]".into()
            }
            Kind::Word(words) => words.iter().map(|word| format!("{word:?}")).collect::<Vec<_>>().join(" or "),
        }
    }
}

impl Kind {
    /// Whether three bare numbers may stand for one value.
    pub(super) fn takes_three(self) -> bool {
        matches!(self, Kind::Vector | Kind::Factors | Kind::Lengths | Kind::Fractions | Kind::Powers)
    }
}
