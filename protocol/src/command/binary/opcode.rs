//! The opcodes of binary records.

use crate::command::operate::OperateKind;

macro_rules! opcodes {
    ($($(#[$meta:meta])* $opcode:ident $code:literal $word:literal,)*) => {
        /// What a binary record is: its first byte.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Opcode {
            $(#[doc = $word] $opcode,)*
            /// The definition of an operate node that has a record of its own.
            Operate(OperateKind),
        }

        impl Opcode {
            /// The words for the record in listings.
            pub const fn word(self) -> &'static str {
                match self {
                    $(Opcode::$opcode => $word,)*
                    Opcode::Operate(kind) => kind.name(),
                }
            }

            /// The byte; 0, no record, for an operate node that has none of its own.
            pub const fn code(self) -> u8 {
                match self {
                    $(Opcode::$opcode => $code,)*
                    Opcode::Operate(kind) => match kind.code() {
                        Some(code) => code,
                        None => 0,
                    },
                }
            }

            /// The opcode with a code.
            pub const fn from_code(code: u8) -> Option<Opcode> {
                match (code, OperateKind::from_code(code)) {
                    $(($code, _) => Some(Opcode::$opcode),)*
                    (_, Some(kind)) => Some(Opcode::Operate(kind)),
                    (_, None) => None,
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
    /// Every opcode, in the order of the codes.
    pub const ALL: &[Opcode] = {
        const COUNT: usize = {
            let (mut count, mut code) = (0, 0);
            while code < 256 {
                count += Opcode::from_code(code as u8).is_some() as usize;
                code += 1;
            }
            count
        };
        const ALL: [Opcode; COUNT] = {
            let mut all = [Opcode::Nil; COUNT];
            let (mut count, mut code) = (0, 0);
            while code < 256 {
                if let Some(opcode) = Opcode::from_code(code as u8) {
                    all[count] = opcode;
                    count += 1;
                }
                code += 1;
            }
            all
        };
        &ALL
    };
}
