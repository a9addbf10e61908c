//! Operate nodes: what changes the state of the descendants.

use crate::Name;
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3};

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
/// Matrices follow [`Value`](crate::Value): row `i` of the machine is column `i` of the glam matrix.
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
    /// `XFORM VECTOR`: marks data whose transformed vectors can be read.
    XformVector,
    /// `CANCEL XFORM`: excludes what is below from an XFORM VECTOR above.
    CancelXform,
    /// `WRITEBACK`: marks data whose picture can be read.
    WriteBack,
    /// `EYE BACK z LEFT|RIGHT x UP|DOWN y FROM SCREEN AREA w WIDE FRONT = f BACK = b`.
    Eye {
        /// Distance of the eye before the screen.
        back: f64,
        /// Offset of the eye from the middle of the screen, positive to the right.
        right: f64,
        /// Offset upward.
        up: f64,
        /// Width of the screen.
        width: f64,
        /// Front and back; a wide default if not given.
        boundaries: Option<Boundaries>,
    },
    /// `LOAD VIEWPORT ...`: replaces the enclosing viewport. Of later models.
    LoadViewport {
        /// Left and right on the screen, -1..=1.
        horizontal: [f64; 2],
        /// Bottom and top.
        vertical: [f64; 2],
        /// Intensity at the back and at the front.
        intensity: Option<[f64; 2]>,
    },
    /// `CHARACTER ROTATE angle`, degrees.
    CharacterRotate(f64),
    /// `CHARACTER SCALE s` or `sx,sy`.
    CharacterScale(DVec2),
    /// `TEXT SIZE x`: an absolute size; cancels the character matrix above.
    TextSize(f64),
    /// `CHARACTER FONT name`.
    CharacterFont(Name),
    /// `STANDARD FONT`.
    StandardFont,
    /// `SET COLOR BLENDING saturation`.
    SetColorBlending(f64),
    /// `SET CONTRAST TO c`, 0..=1.
    SetContrast(f64),
    /// `SET CSM ON|OFF`: drive of the colour tube.
    SetCsm(bool),
    /// `SET DISPLAYS ALL ON|OFF`, `SET DISPLAY n, m... ON|OFF`.
    SetDisplays {
        /// Which screens.
        scopes: Scopes,
        /// ON or OFF.
        on: bool,
    },
    /// `SET CHARACTERS WORLD_ORIENTED|SCREEN_ORIENTED[/FIXED]`.
    SetCharacters(CharacterOrientation),
    /// `SET PICKING ON|OFF`.
    SetPicking(bool),
    /// `SET PICKING IDENTIFIER = id`.
    SetPickingIdentifier(Name),
    /// `SET PICKING LOCATION = x,y sx,sy`.
    SetPickingLocation {
        /// Centre of the pick box on the screen, -1..=1.
        center: DVec2,
        /// Half its size.
        size: Option<DVec2>,
    },
    /// `SET LEVEL_OF_DETAIL TO n`, 0..=32767.
    SetLevelOfDetail(u16),
    /// `INCREMENT LEVEL_OF_DETAIL`.
    IncrementLevelOfDetail,
    /// `DECREMENT LEVEL_OF_DETAIL`.
    DecrementLevelOfDetail,
    /// `SET CONDITIONAL_BIT n ON|OFF`.
    SetConditionalBit {
        /// 0..=14.
        bit: u8,
        /// ON or OFF.
        on: bool,
    },
    /// `SET RATE on off ON|OFF delay`.
    SetRate(Rate),
    /// `SET RATE EXTERNAL`.
    SetRateExternal,
    /// `SET BLINKING ON|OFF`. Of later models.
    SetBlinking(bool),
    /// `SET BLINK RATE n`, frames of a phase. Of later models.
    SetBlinkRate(u32),
    /// `SET PLOTTER ON|OFF`.
    SetPlotter(bool),
    /// `SET PRIORITY n`. Of later models.
    SetPriority(i32),
    /// `SET LINE_TEXTURE AROUND_CORNERS n`. Of later models.
    SetLineTexture {
        /// Whether the texture goes on from one vector to the next.
        around_corners: bool,
        /// Which texture.
        texture: u32,
    },
    /// `IF CONDITIONAL_BIT n IS ON|OFF`.
    IfConditionalBit {
        /// 0..=14.
        bit: u8,
        /// The state that lets through.
        on: bool,
    },
    /// `IF LEVEL_OF_DETAIL <= n`.
    IfLevelOfDetail {
        /// How the level is compared with `level`.
        comparison: Comparison,
        /// 0..=32767.
        level: u16,
    },
    /// `IF PHASE IS ON|OFF`.
    IfPhase(bool),
    /// `SURFACE_RENDERING`.
    SurfaceRendering,
    /// `SOLID_RENDERING`.
    SolidRendering,
    /// `SECTIONING_PLANE`.
    SectioningPlane,
}

/// Which screens SET DISPLAYS means.
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
