//! Commands as text, such that parsing the text gives the same commands.

mod object;
pub(super) mod printer;

use super::{
    matrix::four_by_three,
    parse::is_plain_value,
    syntax::{Arc, Command, Destination, FontCharacter, Initialize, NamePattern, Object},
    words::Word,
};
use crate::{Name, Value};
use printer::{List, Number, Printer};
use std::fmt;

/// Appends a command as text, with its `;`. BEGIN_STRUCTURE and BEGIN_FONT have none; a line end follows them, so that
/// commands can be printed one after the other.
///
/// What the parser would refuse (reals that are not finite, a text longer than [`MAX_TEXT`](super::MAX_TEXT), an alias
/// without a name) is printed as it is, and the text cannot be parsed. The text is printable except for the bytes of
/// texts in quotes, which stand as they are.
pub fn print(command: &Command, out: &mut Vec<u8>) {
    Printer::new(out).command(command);
}

impl fmt::Display for Command {
    /// The command as text, without a line end; bytes that are not UTF-8 are replaced.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut out = Vec::new();
        print(self, &mut out);
        f.write_str(String::from_utf8_lossy(&out).trim_end())
    }
}

impl fmt::Display for Value {
    /// The value as SEND has it: `FIX(1)`, `0.5`, `'text'`, `V3D(1,2,3)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut out = Vec::new();
        Printer::new(&mut out).value(self);
        f.write_str(&String::from_utf8_lossy(&out))
    }
}

impl Printer<'_> {
    /// Names with commas between them.
    fn names(&mut self, names: &[Name]) {
        for (index, name) in names.iter().enumerate() {
            self.put(format_args!("{}{name}", if index > 0 { ", " } else { "" }));
        }
    }

    fn command(&mut self, command: &Command) {
        match command {
            Command::Define { name, object } => {
                if let Some(name) = name {
                    self.put(format_args!("{name} := "));
                }
                self.object(object);
                if matches!(object, Object::BeginStructure | Object::BeginFont) {
                    return self.text("\n");
                }
            }
            Command::EndStructure => self.word(Word::EndStructure),
            Command::EndFont => self.word(Word::EndFont),
            Command::FontCharacter(character) => self.font_character(character),
            Command::Begin => self.word(Word::Begin),
            Command::End => self.word(Word::End),
            Command::Display(name) => self.put(format_args!("DISPLAY {name}")),
            Command::Remove(name) => self.put(format_args!("REMOVE {name}")),
            Command::Include { name, into } => self.put(format_args!("INCLUDE {name} IN {into}")),
            Command::RemoveFrom { name, from } => self.put(format_args!("REMOVE {name} FROM {from}")),
            Command::RemovePrefix(name) => self.put(format_args!("REMOVE PREFIX OF {name}")),
            Command::RemoveFollower(name) => self.put(format_args!("REMOVE FOLLOWER OF {name}")),
            Command::Prefix { name, operate } => {
                self.put(format_args!("PREFIX {name} WITH "));
                operate.print(self);
            }
            Command::Follow { name, operate } => {
                self.put(format_args!("FOLLOW {name} WITH "));
                operate.print(self);
            }
            Command::PatternWith { name, pattern } => self.put(format_args!("PATTERN {name} WITH {pattern}")),
            Command::ErasePattern(name) => self.put(format_args!("ERASE PATTERN FROM {name}")),
            Command::Delete(patterns) => self.patterns(patterns),
            Command::Forget(name) => self.put(format_args!("FORGET {name}")),
            Command::ForgetUnit(unit) => self.put(format_args!("FORGET ({unit})")),
            Command::Initialize(what) => self.text(match what {
                Initialize::All => "INITIALIZE",
                Initialize::Connections => "INITIALIZE CONNECTIONS",
                Initialize::Displays => "INITIALIZE DISPLAYS",
                Initialize::Names => "INITIALIZE NAMES",
            }),
            Command::Connect(_)
            | Command::ConnectSeveral { .. }
            | Command::Disconnect { .. }
            | Command::Send { .. }
            | Command::SendVectors { .. }
            | Command::SendMarks { .. }
            | Command::SendVariable { .. }
            | Command::Variable(_)
            | Command::SetupCness { .. } => self.network(command),
            _ => self.system(command),
        }
        self.text(";");
    }

    fn patterns(&mut self, patterns: &[NamePattern]) {
        for (index, pattern) in patterns.iter().enumerate() {
            self.text(if index == 0 { "DELETE " } else { ", " });
            match pattern {
                NamePattern::Name(name) => self.put(format_args!("{name}")),
                NamePattern::Prefix(prefix) => self.put(format_args!("{prefix}*")),
            }
        }
    }

    /// Connections and messages.
    fn network(&mut self, command: &Command) {
        let to = match command {
            Command::Connect(Arc { source, output, destination }) => {
                self.put(format_args!("CONNECT {source}<{output}>:"));
                destination
            }
            Command::ConnectSeveral { source, output, destinations } => {
                self.put(format_args!("CONNECT {source}<{output}>:"));
                for (index, destination) in destinations.iter().enumerate() {
                    self.text(if index > 0 { ", " } else { "" });
                    self.destination(destination);
                }
                return;
            }
            Command::Disconnect { source, output, destination } => {
                self.put(format_args!("DISCONNECT {source}"));
                if let Some(output) = output {
                    self.put(format_args!("<{output}>"));
                }
                let Some(destination) = destination else {
                    return self.text(":ALL");
                };
                self.text(":");
                destination
            }
            Command::Send { value, destination } => {
                self.text("SEND ");
                self.value(value);
                self.text(" TO ");
                destination
            }
            Command::SendVectors { list, destination } => {
                self.put(format_args!("SEND VL({list}) TO "));
                destination
            }
            Command::SendMarks { count, lines, destination } => {
                self.put(format_args!("SEND {count}*{} TO ", if *lines { "L" } else { "P" }));
                destination
            }
            Command::SendVariable { variable, destination } => {
                self.put(format_args!("SEND VALUE({variable}) TO "));
                destination
            }
            Command::Variable(names) => {
                self.text("VARIABLE ");
                return self.names(names);
            }
            Command::SetupCness { constant, destination } => {
                self.text(if *constant { "SETUP CNESS TRUE " } else { "SETUP CNESS FALSE " });
                destination
            }
            _ => return,
        };
        self.destination(to);
    }

    /// Commands to the system.
    fn system(&mut self, command: &Command) {
        match command {
            Command::OptimizeStructure => self.text("OPTIMIZE STRUCTURE"),
            Command::EndOptimize => self.text("END OPTIMIZE"),
            Command::OptimizeMemory => self.text("OPTIMIZE MEMORY"),
            Command::ReserveWorkingStorage(bytes) => self.put(format_args!("RESERVE_WORKING_STORAGE {bytes}")),
            Command::CommandStatus => self.text("COMMAND STATUS"),
            Command::Reboot(password) => self.put(format_args!("REBOOT {password}")),
            Command::Configure(password) => self.put(format_args!("CONFIGURE {password}")),
            Command::FinishConfiguration => self.text("FINISH CONFIGURATION"),
            Command::SetupPassword(password) => self.put(format_args!("SETUP PASSWORD {password}")),
            Command::SetupInterface { port, options } => {
                self.put(format_args!("SETUP INTERFACE {port}"));
                for (option, value) in options {
                    self.put(format_args!("/{option}"));
                    if is_plain_value(value) {
                        self.put(format_args!("={value}"));
                    } else if !value.is_empty() {
                        self.text("=");
                        self.quoted(value.as_bytes());
                    }
                }
            }
            Command::ShowInterface(port) => self.put(format_args!("SHOW INTERFACE {port}")),
            Command::ShowInterrupts => self.text("SHOW INTERRUPTS"),
            Command::GiveUpCpu => self.word(Word::GiveUpCpu),
            Command::AllowVecnorm => self.word(Word::AllowVecnorm),
            Command::Reset => self.text("!RESET"),
            _ => {}
        }
    }

    fn font_character(&mut self, character: &FontCharacter) {
        self.put(format_args!("C[{}]:", character.code));
        if let Some(estimate) = character.estimate {
            self.put(format_args!(" N={estimate}"));
        }
        for ([x, y], line) in &character.points {
            let mark = if *line { 'L' } else { 'P' };
            self.put(format_args!(" {mark} {},{}", Number(*x), Number(*y)));
        }
    }

    fn destination(&mut self, destination: &Destination) {
        self.put(format_args!("{}{}", destination.input, destination.name));
    }

    fn value(&mut self, value: &Value) {
        match value {
            Value::Boolean(true) => self.text("TRUE"),
            Value::Boolean(false) => self.text("FALSE"),
            Value::Integer(i) => self.put(format_args!("FIX({i})")),
            Value::Real(r) => self.put(format_args!("{}", Number(*r))),
            Value::String(text) => match **text {
                [byte] if !byte.is_ascii_graphic() => self.put(format_args!("CHAR({byte})")),
                _ => self.quoted(text),
            },
            Value::Vector2(v) => self.call(Word::Vector2Value, &v.to_array()),
            Value::Vector3(v) => self.call(Word::Vector3Value, &v.to_array()),
            Value::Vector4(v) => self.call(Word::Vector4Value, &v.to_array()),
            Value::Matrix2(m) => self.call(Word::Matrix2Value, &m.to_cols_array()),
            Value::Matrix3(m) => self.call(Word::Matrix3Value, &m.to_cols_array()),
            Value::Matrix4x3(m) => self.call(Word::Matrix4x3Value, &four_by_three(m)),
            Value::Matrix4(m) => self.call(Word::Matrix4Value, &m.to_cols_array()),
            Value::Transform(m) => self.call(Word::TransformValue, &m.to_cols_array()),
            // No command sends these: the text is for people only.
            Value::Pick(pick) => self.quoted(pick.to_string().as_bytes()),
            Value::Label(label) => self.quoted(&label.text),
            Value::Vectors(vectors) => self.put(format_args!("VECTORS({})", vectors.ends.len())),
        }
    }

    fn call(&mut self, word: Word, numbers: &[f64]) {
        self.put(format_args!("{}({})", word.form(), List(numbers)));
    }

    fn quoted(&mut self, text: &[u8]) {
        self.text("'");
        for &byte in text {
            self.byte(byte);
            if byte == b'\'' {
                self.byte(byte);
            }
        }
        self.text("'");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{parse, strategy::commands};
    use proptest::prelude::*;

    #[test]
    fn commands_are_printed_as_the_manuals_write_them() {
        for text in [
            "WORLD := BEGIN_STRUCTURE",
            "PER := FIELD_OF_VIEW 30 FRONT = 6 BACK = 14;",
            "CONNECT DIALS<1>:<1>WORLD.RX;",
            "SEND V3D(0,0.5,-1E-7) TO <append>TAC;",
            "SEND 'it''s' TO <1>DLABEL1;",
            "SEND CHAR(13) TO <1>A;",
            "V := VECTOR_LIST ITEMIZED N=2\n P 0,0\n L 0.1,1 I=0.5;",
            "A := INSTANCE OF;",
            "A := INSTANCE OF NIL,;",
            "DELETE A, T*, *;",
            "A := B;",
            "A := WRITEBACK,;",
            "A := WRITEBACK;",
            "EYE BACK 3 LEFT 1 UP 0.5 FROM SCREEN AREA 2 WIDE FRONT = 1 BACK = 9;",
            "V := VECTOR_LIST COLOR SEPARATE_LINES\n 0,0\n 1,1 H=120;",
            "T := WITH ATTRIBUTES MAT POLYGON\n 1,1,1\n S 1,-1,-1\n -1,1,-1;",
            "IF LEVEL_OF_DETAIL <= 3 APPLIED TO A;",
            "SETUP INTERFACE PORT1/SPEED=9600/PARITY=EVEN/XON/BREAK='1.5 s';",
            "!RESET;",
        ] {
            assert_eq!(parse(text.as_bytes()).unwrap().to_string(), text);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn parsing_what_was_printed_gives_the_command(command in commands()) {
            let mut text = Vec::new();
            print(&command, &mut text);
            prop_assert_eq!(parse(&text), Ok(command), "{}", String::from_utf8_lossy(&text));
        }
    }
}
