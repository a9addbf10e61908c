//! The keyword table: each word with its shortest abbreviation.
//!
//! A word is written as the manuals print it: the capitals at its beginning are the shortest form that is accepted, and
//! so is any longer prefix. An underscore after the shortest form may be left out. No word is reserved: the parser asks
//! whether a name *is* a certain word only where that word can stand.

macro_rules! words {
    ($($(#[$meta:meta])* $word:ident $form:literal,)*) => {
        /// A keyword of the command language.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
        }
    };
}

words! {
    // Commands.
    Connect "CONNect",
    Delete "DELete",
    Disconnect "DISCONNect",
    Display "DISPlay",
    EndStructure "END_Structure",
    Forget "FORget",
    Include "INCLude",
    Initialize "INITialize",
    Remove "REMove",
    Send "SEND",
    // What a name can be.
    BeginStructure "BEGIN_Structure",
    Characters "CHARacters",
    FieldOfView "FIELD_OF_VIEW",
    Instance "INSTance",
    Look "LOOK",
    Matrix2 "MATRIX_2x2",
    Matrix3 "MATRIX_3x3",
    Matrix4x3 "MATRIX_4X3",
    Matrix4 "MATRIX_4X4",
    Nil "NIL",
    Rotate "ROTate",
    Scale "SCAle",
    Set "SET",
    Translate "TRANslate",
    VectorList "VECtor_list",
    Viewport "VIEWport",
    Window "WINDOW",
    Xform "XFORM",
    // Options and settings.
    All "ALL",
    Applied "APPLied",
    At "AT",
    Back "BACK",
    BlockNormalized "BLOCK_normalized",
    Boundary "BOUNDary",
    By "BY",
    Color "COLOR",
    Connected "CONNected_lines",
    Connections "CONNections",
    DepthClipping "DEPTH_CLipping",
    Displays "DISPlays",
    Dots "DOTs",
    Dy "DY",
    Dz "DZ",
    From "FROM",
    Front "FRONT",
    Function "F",
    Horizontal "HORizontal",
    In "IN",
    Intensity "INTENsity",
    IntensityOfPoint "I",
    Itemized "ITEMized",
    Matrix "MATRIX",
    Names "NAMES",
    Number "N",
    Of "OF",
    Off "OFF",
    On "ON",
    Separate "SEParate_lines",
    Step "STEP",
    Then "THEN",
    To "TO",
    Up "UP",
    Vertical "VERTical",
    X "X",
    Y "Y",
    Z "Z",
    // Forms of values.
    Char "CHAR",
    False "FALSE",
    Fix "FIX",
    Matrix2Value "M2D",
    Matrix3Value "M3D",
    Matrix4x3Value "M4X3D",
    Matrix4Value "M4D",
    TransformValue "XFORMED",
    True "TRUE",
    Vector2Value "V2D",
    Vector3Value "V3D",
    Vector4Value "V4D",
}

/// The words that begin a command.
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
];

/// The words after `SET`.
pub const SETTINGS: &[Word] = &[Word::Color, Word::Intensity, Word::DepthClipping];

/// The words before the vectors of a list.
pub const VECTOR_OPTIONS: &[Word] = &[
    Word::BlockNormalized,
    Word::Connected,
    Word::Dots,
    Word::Itemized,
    Word::Separate,
    Word::Y,
    Word::Dy,
    Word::Z,
    Word::Dz,
    Word::Number,
];

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
];

impl Word {
    /// The whole word in capitals, as the printer writes it.
    pub fn upper(self) -> String {
        self.form().to_ascii_uppercase()
    }

    /// The length of the shortest form: all before the first small letter and an underscore there, or the whole word.
    pub fn shortest(self) -> usize {
        let form = self.form();
        form.find(|c: char| c.is_ascii_lowercase()).map_or(form, |end| form[..end].trim_end_matches('_')).len()
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

    /// The word among `words` that `text` is.
    pub fn find(words: &[Word], text: &[u8]) -> Option<Word> {
        words.iter().copied().find(|word| word.accepts(text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for context in [statements.as_slice(), SETTINGS, VECTOR_OPTIONS, INITIALIZE, VALUES] {
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
