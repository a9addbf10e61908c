//! Commands as plain data: what the parser and the binary decoder make, and the printer and encoder take.

use crate::{Name, Value};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3};

/// One command of the language.
///
/// A structure travels as [`Command::Define`] with [`Object::BeginStructure`], the commands inside it, and
/// [`Command::EndStructure`].
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// `name := object;`, or an unnamed object inside a structure.
    Define {
        /// Its name; none only inside a structure.
        name: Option<Name>,
        /// What it is.
        object: Object,
    },
    /// `END_STRUCTURE;`
    EndStructure,
    /// `DISPLAY name;`
    Display(Name),
    /// `REMOVE name;` from the display list.
    Remove(Name),
    /// `INCLUDE name1 IN name2;`
    Include {
        /// The new descendant.
        name: Name,
        /// The instance node.
        into: Name,
    },
    /// `REMOVE name1 FROM name2;`
    RemoveFrom {
        /// The descendant.
        name: Name,
        /// The instance node.
        from: Name,
    },
    /// `DELETE name, name...;` or `DELETE prefix*;`
    Delete(Vec<NamePattern>),
    /// `FORGET name;`
    Forget(Name),
    /// `CONNECT name1<i>:<j>name2;`
    Connect(Arc),
    /// `DISCONNECT name1[<i>][:<j>name2];` or `DISCONNECT name1:ALL;`
    Disconnect {
        /// The function whose arcs go.
        source: Name,
        /// Only arcs of this output; all outputs if none.
        output: Option<u16>,
        /// Only arcs to this input.
        destination: Option<Destination>,
    },
    /// `SEND value TO <i>name;`
    Send {
        /// The message.
        value: Value,
        /// Where it goes.
        destination: Destination,
    },
    /// `INITIALIZE [CONNECTIONS|DISPLAYS|NAMES];`
    Initialize(Initialize),
}

/// One arc of a function network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arc {
    /// The function that sends.
    pub source: Name,
    /// Its output, 1 and up.
    pub output: u16,
    /// Where the messages go.
    pub destination: Destination,
}

/// An input of a named object: `<i>name`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    /// Which input.
    pub input: Input,
    /// Of what.
    pub name: Name,
}

/// Which input of a function or a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// `<1>`, `<2>`, ... For the data nodes, the index of an element.
    Number(u32),
    /// `<append>`, 0 in the library of the time.
    Append,
    /// `<delete>`, -1.
    Delete,
    /// `<clear>`, -2.
    Clear,
    /// `<step>`, -3.
    Step,
    /// `<position>`, -4.
    Position,
    /// `<last>`, -5.
    Last,
    /// `<substitute>`, -6.
    Substitute,
}

impl Input {
    /// The inputs that have a word, with that word.
    pub const WORDS: [(Input, &str); 7] = [
        (Input::Append, "append"),
        (Input::Delete, "delete"),
        (Input::Clear, "clear"),
        (Input::Step, "step"),
        (Input::Position, "position"),
        (Input::Last, "last"),
        (Input::Substitute, "substitute"),
    ];

    /// The input number of the library of the time: 0 for append, -1 for delete, and so on. \[S\]
    pub const fn code(self) -> i64 {
        match self {
            Input::Number(n) => n as i64,
            Input::Append => 0,
            Input::Delete => -1,
            Input::Clear => -2,
            Input::Step => -3,
            Input::Position => -4,
            Input::Last => -5,
            Input::Substitute => -6,
        }
    }

    /// The input with a [`code`](Self::code).
    pub fn from_code(code: i64) -> Option<Input> {
        match code {
            1.. => u32::try_from(code).ok().map(Input::Number),
            _ => Input::WORDS.iter().map(|w| w.0).find(|i| i.code() == code),
        }
    }
}

impl std::fmt::Display for Input {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Input::Number(n) => write!(f, "<{n}>"),
            word => {
                let text = Input::WORDS.iter().find(|w| w.0 == *word).map_or("", |w| w.1);
                write!(f, "<{text}>")
            }
        }
    }
}

/// A name, or all names that begin with a prefix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NamePattern {
    /// That name.
    Name(Name),
    /// `prefix*`; the prefix may be empty (`*`: all user names).
    Prefix(String),
}

/// What INITIALIZE clears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Initialize {
    /// User names, connections and the display list.
    All,
    /// Connections that the user made.
    Connections,
    /// The display list.
    Displays,
    /// User names.
    Names,
}

/// What a name can denote.
#[derive(Clone, Debug, PartialEq)]
pub enum Object {
    /// `NIL`: a null definition; draws nothing.
    Nil,
    /// `BEGIN_STRUCTURE`; the members follow as commands.
    BeginStructure,
    /// `INSTANCE OF name1, name2...`; may be empty.
    Instance(Vec<Name>),
    /// `VECTOR_LIST ...`
    VectorList(VectorList),
    /// `CHARACTERS ...`
    Characters(Characters),
    /// An operate node.
    Operate {
        /// What it does.
        operate: Operate,
        /// The descendant; inside a structure, none applies it to all that follows.
        applied_to: Option<Name>,
    },
    /// `F:type` or `F:type(n)`.
    Function {
        /// The type without `F:`, upper case.
        function: Name,
        /// Size of a family such as ROUTE(n).
        size: Option<u16>,
    },
}

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
    /// x, y, z (0 if 2D) and intensity 0..=1 of each point (1 where not given; larger values are kept and
    /// clamped when drawn).
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

/// What an operate node does to the state of its descendant.
///
/// Matrices follow [`Value`]: row `i` of the machine is column `i` of the glam matrix.
#[derive(Clone, Debug, PartialEq)]
pub enum Operate {
    /// `ROTATE IN X angle`, degrees.
    Rotate {
        /// About which axis.
        axis: Axis,
        /// Degrees, left-hand rule.
        angle: f64,
    },
    /// `SCALE BY s` or `sx,sy,sz`.
    Scale(DVec3),
    /// `TRANSLATE BY tx,ty,tz`.
    Translate(DVec3),
    /// `MATRIX_2X2`: multiplies the character matrix.
    Matrix2(DMat2),
    /// `MATRIX_3X3`.
    Matrix3(DMat3),
    /// `MATRIX_4X3`, the last row the translation; components (0, 0, 0, 1) complete the columns.
    Matrix4x3(DMat4),
    /// `MATRIX_4X4`.
    Matrix4(DMat4),
    /// `LOOK AT a FROM f UP u`.
    Look {
        /// The point looked at.
        at: DVec3,
        /// The eye.
        from: DVec3,
        /// UP as given; without it, +y is upward.
        up: Option<DVec3>,
    },
    /// `WINDOW X = a:b Y = c:d FRONT = f BACK = b`.
    Window {
        /// Left and right.
        x: [f64; 2],
        /// Bottom and top.
        y: [f64; 2],
        /// Front and back; a wide default if not given.
        boundaries: Option<Boundaries>,
    },
    /// `FIELD_OF_VIEW angle FRONT = f BACK = b`.
    FieldOfView {
        /// Full angle in degrees.
        angle: f64,
        /// Front and back; a wide default if not given.
        boundaries: Option<Boundaries>,
    },
    /// `VIEWPORT HORIZONTAL = a:b VERTICAL = c:d INTENSITY = e:f`.
    Viewport {
        /// Left and right, -1..=1 of the enclosing viewport.
        horizontal: [f64; 2],
        /// Bottom and top.
        vertical: [f64; 2],
        /// Intensity at the back and at the front, 0..=1; that of the enclosing viewport if not given.
        intensity: Option<[f64; 2]>,
    },
    /// `SET COLOR hue, saturation`.
    SetColor {
        /// Degrees on the circle that starts at blue.
        hue: f64,
        /// 0 white, 1 pure.
        saturation: f64,
    },
    /// `SET INTENSITY ON|OFF imin:imax`.
    SetIntensity {
        /// OFF ignores the range.
        on: bool,
        /// Intensity at the back and at the front.
        range: [f64; 2],
    },
    /// `SET DEPTH_CLIPPING ON|OFF`.
    SetDepthClipping(bool),
    /// `XFORM MATRIX`: marks a place whose accumulated matrix can be read.
    XformMatrix,
}
