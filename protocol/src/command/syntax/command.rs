//! The commands and what a name can denote.

use super::{
    Arc, Attributes, Bspline, Characters, Destination, FontCharacter, Illumination, Labels, Operate, Pattern, Polygon,
    Polynomial, VectorList,
};
use crate::{Name, Value};

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
    /// `BEGIN;`: what follows is seen at END, all at once.
    Begin,
    /// `END;`
    End,
    /// `C[code]: ...;` inside BEGIN_FONT.
    FontCharacter(FontCharacter),
    /// `END_FONT;`
    EndFont,
    /// `PREFIX name WITH operate;`
    Prefix {
        /// What gets a node above it.
        name: Name,
        /// The node.
        operate: Operate,
    },
    /// `FOLLOW name WITH operate;`
    Follow {
        /// The operate node that gets a node below it.
        name: Name,
        /// The node.
        operate: Operate,
    },
    /// `REMOVE PREFIX OF name;`
    RemovePrefix(Name),
    /// `REMOVE FOLLOWER OF name;`
    RemoveFollower(Name),
    /// `FORGET (unit);`
    ForgetUnit(Name),
    /// `OPTIMIZE STRUCTURE;`
    OptimizeStructure,
    /// `END OPTIMIZE;`
    EndOptimize,
    /// `OPTIMIZE MEMORY;`
    OptimizeMemory,
    /// `RESERVE_WORKING_STORAGE bytes;`
    ReserveWorkingStorage(u32),
    /// `PATTERN name WITH pattern;`
    PatternWith {
        /// A vector list or curve.
        name: Name,
        /// The pattern.
        pattern: Name,
    },
    /// `ERASE PATTERN FROM name;`
    ErasePattern(Name),
    /// `CONNECT name1<i>:<j>name2, <k>name3...;`
    ConnectSeveral {
        /// The function that sends.
        source: Name,
        /// Its output.
        output: u16,
        /// Two or more inputs.
        destinations: Vec<Destination>,
    },
    /// `SEND VL(list) TO <i>name;`
    SendVectors {
        /// The list whose vectors are copied.
        list: Name,
        /// The first vector that they replace, or `<append>`.
        destination: Destination,
    },
    /// `SEND number*P TO <i>name;`
    SendMarks {
        /// How many vectors are marked.
        count: u32,
        /// L: lines; P: positions.
        lines: bool,
        /// The first of them.
        destination: Destination,
    },
    /// `SEND VALUE(variable) TO <i>name;`
    SendVariable {
        /// Whose value.
        variable: Name,
        /// Where it goes.
        destination: Destination,
    },
    /// `VARIABLE name, name...;`
    Variable(Vec<Name>),
    /// `SETUP CNESS TRUE|FALSE <i>name;`
    SetupCness {
        /// TRUE: constant; FALSE: active.
        constant: bool,
        /// The input.
        destination: Destination,
    },
    /// `COMMAND STATUS;`
    CommandStatus,
    /// `REBOOT password;`
    Reboot(Name),
    /// `CONFIGURE password;`
    Configure(Name),
    /// `FINISH CONFIGURATION;`
    FinishConfiguration,
    /// `SETUP PASSWORD password;`
    SetupPassword(Name),
    /// `SETUP INTERFACE port/option=value...;`
    SetupInterface {
        /// The port.
        port: Name,
        /// The options and their values.
        options: Vec<(Name, String)>,
    },
    /// `SHOW INTERFACE port;`
    ShowInterface(Name),
    /// `SHOW INTERRUPTS;`
    ShowInterrupts,
    /// `GIVE_UP_CPU;`
    GiveUpCpu,
    /// `ALLOW_VECNORM;`
    AllowVecnorm,
    /// `!RESET;`: gives up what was begun and not ended.
    Reset,
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
    /// `name := name1`: another name for the same object.
    Alias(Name),
    /// `POLYGON ...`: at least one.
    Polygons(Vec<Polygon>),
    /// `ATTRIBUTES ...`
    Attributes(Attributes),
    /// `ILLUMINATION ...`
    Illumination(Illumination),
    /// `BSPLINE ...`
    Bspline(Bspline),
    /// `POLYNOMIAL ...`
    Polynomial(Polynomial),
    /// `LABELS ...`
    Labels(Labels),
    /// `BEGIN_FONT`; the characters follow as commands.
    BeginFont,
    /// `PATTERN ...`
    Pattern(Pattern),
    /// `RAWBLOCK bytes`
    RawBlock(u32),
    /// `COPY name START = i COUNT = n`
    Copy {
        /// What is copied from.
        source: Name,
        /// The first element, 1 and up.
        start: u32,
        /// How many elements.
        count: u32,
    },
}
