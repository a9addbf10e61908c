//! The keyword table: each word with its shortest abbreviation.
//!
//! A word is written as the manuals print it: the capitals at its beginning are the shortest form that is accepted, and
//! so is any longer prefix. An underscore after the shortest form may be left out. No word is reserved: the parser asks
//! whether a name *is* a certain word only where that word can stand.

macro_rules! words {
    ($($(#[$meta:meta])* $word:ident $form:literal,)*) => {
        /// A keyword of the command language.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Word {
            $(#[doc = concat!("`", $form, "`")] $word,)*
        }

        impl Word {
            /// Every word.
            pub const ALL: &[Word] = &[$(Word::$word,)*];

            /// The word as the manuals print it: the shortest form in capitals.
            pub const fn form(self) -> &'static str {
                match self {
                    $(Word::$word => $form,)*
                }
            }

            /// The whole word in capitals, as a list of it alone: what an error says was expected.
            pub const fn expected(self) -> &'static [&'static str] {
                match self {
                    $(Word::$word => {
                        const BYTES: &[u8] = &capitals::<{ $form.len() }>($form);
                        const TEXT: &str = ascii(BYTES);
                        &[TEXT]
                    })*
                }
            }
        }
    };
}

const fn capitals<const N: usize>(form: &str) -> [u8; N] {
    let mut bytes = [0; N];
    bytes.copy_from_slice(form.as_bytes());
    bytes.make_ascii_uppercase();
    bytes
}

/// Words as text. It is called in constants only: what is no text does not compile.
const fn ascii(bytes: &'static [u8]) -> &'static str {
    match str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => panic!("words are ASCII"),
    }
}

words! {
    // Commands.
    AllowVecnorm "ALLOW_VECNORM",
    Begin "BEGIN",
    Cness "CNESS",
    Command "COMMAND",
    Configuration "CONFIGURATION",
    Configure "CONFIGURE",
    Connect "CONNect",
    Delete "DELete",
    Disconnect "DISCONNect",
    Display "DISPlay",
    End "END",
    EndFont "END_Font",
    EndStructure "END_Structure",
    Erase "ERASE",
    Finish "FINISH",
    Follow "FOLLow",
    Follower "FOLLOWer",
    Forget "FORget",
    GiveUpCpu "GIVE_UP_CPU",
    Include "INCLude",
    Initialize "INITialize",
    Interface "INTERFACE",
    Interrupts "INTERRUPTS",
    Memory "MEMORY",
    Optimize "OPTIMIZE",
    Password "PASSWORD",
    Prefix "PREfix",
    Reboot "REBOOT",
    Remove "REMove",
    ReserveWorkingStorage "RESERVE_WORKING_STORAGE",
    Reset "RESET",
    Send "SEND",
    Setup "SETUP",
    Show "SHOW",
    Status "STATus",
    Store "STORE",
    Structure "STRUCTURE",
    Variable "VARIABLE",
    // What a name can be.
    Attributes "ATTRibutes",
    BeginFont "BEGIN_Font",
    BeginStructure "BEGIN_Structure",
    Bspline "BSpline",
    Cancel "CANCEL",
    Characters "CHARacters",
    Copy "COPY",
    Decrement "DECRement",
    Eye "EYE",
    FieldOfView "FIELD_OF_VIEW",
    Font "FONT",
    Function "F",
    If "IF",
    Illumination "ILLUMination",
    Increment "INCRement",
    Instance "INSTance",
    Labels "LABELS",
    Load "LOAD",
    Look "LOOK",
    Matrix2 "MATRIX_2x2",
    Matrix3 "MATRIX_3x3",
    Matrix4x3 "MATRIX_4X3",
    Matrix4 "MATRIX_4X4",
    Nil "NIL",
    Pattern "PATtern",
    Polygon "POLYGon",
    Polynomial "POLYnomial",
    Rational "RATIONAL",
    RawBlock "RAWBLOCK",
    Rotate "ROTate",
    Scale "SCAle",
    SectioningPlane "SECTioning_plane",
    Set "SET",
    SolidRendering "SOLID_rendering",
    Standard "STANdard",
    SurfaceRendering "SURFace_rendering",
    Text "TEXT",
    Translate "TRANslate",
    VectorList "VECtor_list",
    Viewport "VIEWport",
    Window "WINDOW",
    WriteBack "WRITEBACK",
    Xform "XFORM",
    // Options and settings.
    All "ALL",
    Ambient "AMBIENT",
    And "AND",
    Applied "APPLied",
    Area "AREA",
    AroundCorners "AROUND_corners",
    At "AT",
    Back "BACK",
    Blending "BLENDING",
    Blinking "BLINKing",
    BlockNormalized "BLOCK_normalized",
    Boundary "BOUNDary",
    By "BY",
    Chords "CHORDS",
    Closed "CLOSED",
    CodeOfCharacter "C",
    Coefficients "COEFFicients",
    Color "COLOR",
    ConditionalBit "CONDitional_bit",
    Connected "CONNected_lines",
    Connections "CONNections",
    Contrast "CONTRAST",
    Coplanar "COPLANar",
    Count "COUNT",
    Csm "CSM",
    DepthClipping "DEPTH_CLipping",
    Diffuse "DIFFUSE",
    Displays "DISPlays",
    Dots "DOTs",
    Down "DOWN",
    Dy "DY",
    Dz "DZ",
    External "EXTernal",
    Fixed "FIXED",
    From "FROM",
    Front "FRONT",
    Horizontal "HORizontal",
    HueOfPoint "H",
    Identifier "IDentifier",
    In "IN",
    Intensity "INTENsity",
    IntensityOfPoint "I",
    InternalUnits "INTERNAL_units",
    Is "IS",
    Itemized "ITEMized",
    Knots "KNOTS",
    Left "LEFT",
    Length "LENgth",
    LevelOfDetail "LEVel_of_detail",
    LineMark "L",
    LineTexture "LINE_texture",
    Location "LOCation",
    Match "MATCH",
    Matrix "MATRIX",
    Names "NAMES",
    NoMatch "NOMATCH",
    NonPeriodic "NONPERIODIC",
    Number "N",
    Of "OF",
    Off "OFF",
    On "ON",
    Opaque "OPAQUE",
    Open "OPEN",
    Order "ORDER",
    Outline "OUTLINE",
    Periodic "PERIODIC",
    Phase "PHASE",
    Picking "PICKing",
    Plotter "PLOTter",
    PositionMark "P",
    Priority "PRIORity",
    Rate "RATE",
    Right "RIGHT",
    Screen "SCREEN",
    ScreenOriented "SCREEN_oriented",
    Separate "SEParate_lines",
    Size "SIZE",
    SoftMark "S",
    Specular "SPECular",
    Start "START",
    Step "STEP",
    TableOfPoint "T",
    Tabulated "TABulated",
    Then "THEN",
    To "TO",
    Up "UP",
    Vector "VECtor",
    Vertical "VERTical",
    Vertices "VERTICES",
    Wide "WIDE",
    With "WITH",
    WorldOriented "WORLD_oriented",
    X "X",
    Y "Y",
    Z "Z",
    // Forms of values.
    Char "CHAR",
    False "FALSE",
    Fix "FIX",
    ListValue "VL",
    Matrix2Value "M2D",
    Matrix3Value "M3D",
    Matrix4x3Value "M4X3D",
    Matrix4Value "M4D",
    TransformValue "XFORMED",
    True "TRUE",
    VariableValue "VALUE",
    Vector2Value "V2D",
    Vector3Value "V3D",
    Vector4Value "V4D",
}

/// The words that begin a command which defines nothing; `!` stands before RESET, and PATTERN, which also begins a
/// definition, before a name.
pub const COMMANDS: &[Word] = &[
    Word::Connect,
    Word::Send,
    Word::Display,
    Word::Include,
    Word::Remove,
    Word::Delete,
    Word::Disconnect,
    Word::Forget,
    Word::Initialize,
    Word::EndStructure,
    Word::Store,
    Word::Variable,
    Word::Begin,
    Word::End,
    Word::EndFont,
    Word::Prefix,
    Word::Follow,
    Word::Erase,
    Word::Optimize,
    Word::ReserveWorkingStorage,
    Word::Setup,
    Word::Show,
    Word::Command,
    Word::Configure,
    Word::Finish,
    Word::Reboot,
    Word::GiveUpCpu,
    Word::AllowVecnorm,
];

/// The words that begin the definition of an object.
pub const OBJECTS: &[Word] = &[
    Word::VectorList,
    Word::BeginStructure,
    Word::Instance,
    Word::Characters,
    Word::Rotate,
    Word::Scale,
    Word::Translate,
    Word::Set,
    Word::Look,
    Word::Window,
    Word::FieldOfView,
    Word::Viewport,
    Word::Matrix2,
    Word::Matrix3,
    Word::Matrix4x3,
    Word::Matrix4,
    Word::Xform,
    Word::Nil,
    Word::Polygon,
    Word::With,
    Word::Outline,
    Word::Attributes,
    Word::Illumination,
    Word::Bspline,
    Word::Polynomial,
    Word::Rational,
    Word::Labels,
    Word::BeginFont,
    Word::Pattern,
    Word::RawBlock,
    Word::Copy,
    Word::Eye,
    Word::Load,
    Word::Font,
    Word::Standard,
    Word::Text,
    Word::Increment,
    Word::Decrement,
    Word::If,
    Word::Cancel,
    Word::WriteBack,
    Word::SurfaceRendering,
    Word::SolidRendering,
    Word::SectioningPlane,
];

/// The words that are a whole object on their own, so that a lone one is no name of another object.
pub const COMPLETE: &[Word] = &[
    Word::Nil,
    Word::BeginStructure,
    Word::BeginFont,
    Word::Instance,
    Word::VectorList,
    Word::Attributes,
    Word::WriteBack,
    Word::SurfaceRendering,
    Word::SolidRendering,
    Word::SectioningPlane,
];

/// The words before the vectors of a list.
pub const VECTOR_OPTIONS: &[Word] = &[
    Word::BlockNormalized,
    Word::Color,
    Word::Connected,
    Word::Dots,
    Word::Itemized,
    Word::Separate,
    Word::Tabulated,
    Word::Y,
    Word::Dy,
    Word::Z,
    Word::Dz,
    Word::InternalUnits,
    Word::Number,
];

/// The words in front of a polygon.
pub const POLYGON_OPTIONS: &[Word] = &[Word::With, Word::Outline, Word::Polygon];

/// The words of one side of ATTRIBUTES.
pub const SURFACE_OPTIONS: &[Word] = &[Word::Color, Word::Diffuse, Word::Specular, Word::Opaque];

/// The words of ILLUMINATION.
pub const LIGHT_OPTIONS: &[Word] = &[Word::Color, Word::Ambient];

/// The words of BSPLINE.
pub const BSPLINE_OPTIONS: &[Word] = &[
    Word::Order,
    Word::Open,
    Word::Closed,
    Word::NonPeriodic,
    Word::Periodic,
    Word::Number,
    Word::Vertices,
    Word::Knots,
    Word::Chords,
];

/// The words of POLYNOMIAL.
pub const POLYNOMIAL_OPTIONS: &[Word] = &[Word::Order, Word::Coefficients, Word::Chords];

/// The words of PATTERN.
pub const PATTERN_OPTIONS: &[Word] = &[Word::AroundCorners, Word::Match, Word::NoMatch, Word::Length];

/// The words after `SETUP`.
pub const SETUP: &[Word] = &[Word::Cness, Word::Password, Word::Interface];

/// The words after `SHOW`.
pub const SHOW: &[Word] = &[Word::Interface, Word::Interrupts];

/// The words after `INITIALIZE`.
pub const INITIALIZE: &[Word] = &[Word::Connections, Word::Displays, Word::Names];

/// The words that begin a value in `SEND`. `M4X3D` and `XFORMED` are ours.
pub const VALUES: &[Word] = &[
    Word::True,
    Word::False,
    Word::Fix,
    Word::Char,
    Word::Vector2Value,
    Word::Vector3Value,
    Word::Vector4Value,
    Word::Matrix2Value,
    Word::Matrix3Value,
    Word::Matrix4x3Value,
    Word::Matrix4Value,
    Word::TransformValue,
    Word::VariableValue,
    Word::ListValue,
];

impl Word {
    /// The whole word in capitals, as the printer writes it.
    pub const fn capitals(self) -> &'static str {
        self.expected()[0]
    }

    /// The whole word in capitals, as a text of its own.
    pub fn upper(self) -> String {
        self.capitals().to_owned()
    }

    /// The shortest form.
    pub fn least(self) -> &'static str {
        &self.form()[..self.shortest()]
    }

    /// The length of the shortest form: all before the first small letter and an underscore there, or the whole word.
    pub const fn shortest(self) -> usize {
        /// The length for each word, so that it is not counted for each word that is read.
        const LENGTHS: [u8; Word::ALL.len()] = {
            let mut lengths = [0; Word::ALL.len()];
            let mut index = 0;
            while index < lengths.len() {
                let form = Word::ALL[index].form().as_bytes();
                let mut end = 0;
                while end < form.len() && !form[end].is_ascii_lowercase() {
                    end += 1;
                }
                while end < form.len() && end > 0 && form[end - 1] == b'_' {
                    end -= 1;
                }
                lengths[index] = end as u8;
                index += 1;
            }
            lengths
        };
        LENGTHS[self as usize] as usize
    }

    /// Whether `text` is the word, or a prefix of it that is long enough, in any case.
    pub fn accepts(self, text: &[u8]) -> bool {
        let form = self.form().as_bytes();
        let first = |bytes: &[u8]| bytes.first().map(u8::to_ascii_uppercase);
        if first(form) != first(text) {
            return false;
        }
        let shortest = self.shortest();
        let mut at = 0;
        for byte in text {
            if at >= shortest && *byte != b'_' && form.get(at) == Some(&b'_') {
                at += 1;
            }
            match form.get(at) {
                Some(wanted) if wanted.eq_ignore_ascii_case(byte) => at += 1,
                _ => return false,
            }
        }
        at >= shortest
    }

    /// The list of this word alone.
    pub const fn alone(self) -> &'static [Word] {
        Word::ALL.split_at(self as usize).1.split_at(1).0
    }

    /// The word among `words` that `text` is.
    pub fn find(words: &[Word], text: &[u8]) -> Option<Word> {
        words.iter().copied().find(|word| word.accepts(text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::operate::words_after;

    #[test]
    fn any_prefix_from_the_shortest_form_on_is_accepted() {
        for &word in Word::ALL {
            let upper = word.upper();
            for length in 0..=upper.len() {
                assert_eq!(
                    word.accepts(&upper.as_bytes()[..length]),
                    length >= word.shortest(),
                    "{}",
                    &upper[..length]
                );
            }
            assert!(word.accepts(upper.to_lowercase().as_bytes()));
            assert!(!word.accepts(format!("{upper}X").as_bytes()));
        }
    }

    #[test]
    fn a_word_alone_is_the_list_of_it() {
        for &word in Word::ALL {
            assert_eq!(word.alone(), [word]);
        }
    }

    #[test]
    fn underscores_may_be_dropped_behind_the_shortest_form_only() {
        assert!(Word::VectorList.accepts(b"VECTORLIST"));
        assert!(Word::VectorList.accepts(b"vectorl"));
        assert!(Word::VectorList.accepts(b"VECTOR_"));
        assert!(!Word::VectorList.accepts(b"VEC_"));
        assert!(Word::BeginStructure.accepts(b"BEGIN_S"));
        assert!(!Word::BeginStructure.accepts(b"BEGINS"));
        assert!(!Word::BeginStructure.accepts(b"BEGIN"));
        assert!(Word::DepthClipping.accepts(b"DEPTH_CL"));
        assert!(!Word::DepthClipping.accepts(b"DEPTHCL"));
    }

    #[test]
    fn no_abbreviation_means_two_words_in_one_place() {
        let statements: Vec<Word> = COMMANDS.iter().chain(OBJECTS).copied().collect();
        for context in [
            statements.as_slice(),
            words_after(Word::Set),
            words_after(Word::If),
            VECTOR_OPTIONS,
            POLYGON_OPTIONS,
            SURFACE_OPTIONS,
            LIGHT_OPTIONS,
            BSPLINE_OPTIONS,
            POLYNOMIAL_OPTIONS,
            PATTERN_OPTIONS,
            SETUP,
            SHOW,
            INITIALIZE,
            VALUES,
        ] {
            for &word in context {
                let upper = word.upper();
                for length in word.shortest()..=upper.len() {
                    let text = &upper.as_bytes()[..length];
                    let matches: Vec<Word> = context.iter().copied().filter(|w| w.accepts(text)).collect();
                    assert_eq!(matches, [word], "{}", &upper[..length]);
                }
            }
        }
    }
}
