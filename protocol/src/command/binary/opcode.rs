//! The opcodes of binary records.

macro_rules! opcodes {
    ($($(#[$meta:meta])* $opcode:ident $code:literal $word:literal,)*) => {
        /// What a binary record is: its first byte.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        pub enum Opcode {
            $(#[doc = $word] $opcode = $code,)*
        }

        impl Opcode {
            /// Every opcode.
            pub const ALL: &[Opcode] = &[$(Opcode::$opcode,)*];

            /// The words for the record in listings.
            pub const fn word(self) -> &'static str {
                match self {
                    $(Opcode::$opcode => $word,)*
                }
            }

            /// The opcode with a code.
            pub const fn from_code(code: u8) -> Option<Opcode> {
                match code {
                    $($code => Some(Opcode::$opcode),)*
                    _ => None,
                }
            }
        }
    };
}

opcodes! {
    Nil 0x01 "NIL",
    BeginStructure 0x02 "BEGIN_STRUCTURE",
    EndStructure 0x03 "END_STRUCTURE",
    Instance 0x04 "INSTANCE",
    Characters 0x05 "CHARACTERS",
    Function 0x06 "function instance",
    VectorsBegin 0x10 "VECTOR_LIST, begin",
    VectorsPart 0x11 "VECTOR_LIST, part",
    VectorsEnd 0x12 "VECTOR_LIST, end",
    Rotate 0x20 "ROTATE",
    Scale 0x21 "SCALE",
    Translate 0x22 "TRANSLATE",
    Matrix2 0x23 "MATRIX_2X2",
    Matrix3 0x24 "MATRIX_3X3",
    Matrix4x3 0x25 "MATRIX_4X3",
    Matrix4 0x26 "MATRIX_4X4",
    Look 0x27 "LOOK",
    Window 0x28 "WINDOW",
    FieldOfView 0x29 "FIELD_OF_VIEW",
    Viewport 0x2a "VIEWPORT",
    SetColor 0x2b "SET COLOR",
    SetIntensity 0x2c "SET INTENSITY",
    SetDepthClipping 0x2d "SET DEPTH_CLIPPING",
    XformMatrix 0x2e "XFORM MATRIX",
    Display 0x40 "DISPLAY",
    Remove 0x41 "REMOVE",
    Include 0x42 "INCLUDE",
    RemoveFrom 0x43 "REMOVE FROM",
    Delete 0x44 "DELETE",
    Forget 0x45 "FORGET",
    Initialize 0x46 "INITIALIZE",
    Connect 0x50 "CONNECT",
    Disconnect 0x51 "DISCONNECT",
    Send 0x52 "SEND",
    Text 0x60 "command as text",
}

impl Opcode {
    /// The byte.
    pub const fn code(self) -> u8 {
        self as u8
    }
}
