//! Commands as text, such that parsing the text gives the same commands.

use super::{
    syntax::{
        Arc, Axis, Boundaries, Command, Destination, Initialize, NamePattern, Object, Operate, VectorClass, VectorList,
    },
    words::Word,
};
use crate::{Name, Value};
use glam::{DMat4, DVec2, DVec3};
use std::{fmt, io::Write};

/// Appends a command as text, with its `;`. BEGIN_STRUCTURE has none; a line end follows it, so that commands can be
/// printed one behind the other.
///
/// All reals must be finite and a text must fit [`MAX_STRING`](crate::value::MAX_STRING), or the text cannot be parsed.
/// The text is printable except for the bytes of texts in quotes, which stand as they are.
pub fn print(command: &Command, out: &mut Vec<u8>) {
    Printer { out }.command(command);
}

impl fmt::Display for Command {
    /// The command as text, without a line end; bytes that are not UTF-8 are replaced.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut out = Vec::new();
        print(self, &mut out);
        f.write_str(String::from_utf8_lossy(&out).trim_end())
    }
}

/// A number that is written so that it reads back equal.
struct Number<T>(T);

impl<T: fmt::Display + fmt::UpperExp + Copy + Into<f64>> fmt::Display for Number<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size: f64 = self.0.into();
        if size == 0.0 || (1e-5..1e16).contains(&size.abs()) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:E}", self.0)
        }
    }
}

/// Numbers with commas between them.
struct List<'n>(&'n [f64]);

impl fmt::Display for List<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, number) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str(",")?;
            }
            Number(*number).fmt(f)?;
        }
        Ok(())
    }
}

struct Printer<'o> {
    out: &'o mut Vec<u8>,
}

impl Printer<'_> {
    fn put(&mut self, text: fmt::Arguments<'_>) {
        self.out.write_fmt(text).expect("a vector takes all bytes");
    }

    fn text(&mut self, text: &str) {
        self.out.extend_from_slice(text.as_bytes());
    }

    fn word(&mut self, word: Word) {
        self.text(&word.upper());
    }

    fn command(&mut self, command: &Command) {
        match command {
            Command::Define { name, object } => {
                if let Some(name) = name {
                    self.put(format_args!("{name} := "));
                }
                self.object(object);
                if *object == Object::BeginStructure {
                    return self.text("\n");
                }
            }
            Command::EndStructure => self.word(Word::EndStructure),
            Command::Display(name) => self.put(format_args!("DISPLAY {name}")),
            Command::Remove(name) => self.put(format_args!("REMOVE {name}")),
            Command::Include { name, into } => self.put(format_args!("INCLUDE {name} IN {into}")),
            Command::RemoveFrom { name, from } => self.put(format_args!("REMOVE {name} FROM {from}")),
            Command::Delete(patterns) => {
                for (index, pattern) in patterns.iter().enumerate() {
                    self.text(if index == 0 { "DELETE " } else { ", " });
                    match pattern {
                        NamePattern::Name(name) => self.put(format_args!("{name}")),
                        NamePattern::Prefix(prefix) => self.put(format_args!("{prefix}*")),
                    }
                }
            }
            Command::Forget(name) => self.put(format_args!("FORGET {name}")),
            Command::Connect(Arc { source, output, destination }) => {
                self.put(format_args!("CONNECT {source}<{output}>:"));
                self.destination(destination);
            }
            Command::Disconnect { source, output, destination } => {
                self.put(format_args!("DISCONNECT {source}"));
                if let Some(output) = output {
                    self.put(format_args!("<{output}>"));
                }
                match destination {
                    Some(destination) => {
                        self.text(":");
                        self.destination(destination);
                    }
                    None => self.text(":ALL"),
                }
            }
            Command::Send { value, destination } => {
                self.text("SEND ");
                self.value(value);
                self.text(" TO ");
                self.destination(destination);
            }
            Command::Initialize(what) => self.text(match what {
                Initialize::All => "INITIALIZE",
                Initialize::Connections => "INITIALIZE CONNECTIONS",
                Initialize::Displays => "INITIALIZE DISPLAYS",
                Initialize::Names => "INITIALIZE NAMES",
            }),
        }
        self.text(";");
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
            self.out.push(byte);
            if byte == b'\'' {
                self.out.push(byte);
            }
        }
        self.text("'");
    }

    fn object(&mut self, object: &Object) {
        match object {
            Object::Nil => self.word(Word::Nil),
            Object::BeginStructure => self.word(Word::BeginStructure),
            Object::Instance(names) => self.instance(names),
            Object::VectorList(list) => self.vector_list(list),
            Object::Characters(characters) => {
                self.word(Word::Characters);
                if characters.position != DVec3::ZERO {
                    self.put(format_args!(" {}", List(&characters.position.to_array())));
                }
                if characters.step != DVec2::X {
                    self.put(format_args!(" STEP {}", List(&characters.step.to_array())));
                }
                self.text(" ");
                self.quoted(&characters.text);
            }
            Object::Operate { operate, applied_to } => {
                self.operate(operate);
                if let Some(name) = applied_to {
                    self.put(format_args!(" APPLIED TO {name}"));
                }
            }
            Object::Function { function, size: None } => self.put(format_args!("F:{function}")),
            Object::Function { function, size: Some(size) } => self.put(format_args!("F:{function}({size})")),
        }
    }

    fn instance(&mut self, names: &[Name]) {
        self.text("INSTANCE OF");
        for (index, name) in names.iter().enumerate() {
            self.put(format_args!("{} {name}", if index > 0 { "," } else { "" }));
        }
        // A lone name that reads as NIL would mean no name at all.
        if let [only] = names
            && Word::Nil.accepts(only.as_str().as_bytes())
        {
            self.text(",");
        }
    }

    fn vector_list(&mut self, list: &VectorList) {
        self.word(Word::VectorList);
        if list.block_normalized {
            self.text(" BLOCK_NORMALIZED");
        }
        self.text(match list.class {
            VectorClass::Connected => " CONNECTED_LINES",
            VectorClass::Dots => " DOTS",
            VectorClass::Itemized => " ITEMIZED",
            VectorClass::Separate => " SEPARATE_LINES",
        });
        if list.points.is_empty() && list.dimension == 3 {
            self.text(" Y=0 Z=0");
        }
        if let Some(estimate) = list.estimate {
            self.put(format_args!(" N={estimate}"));
        }
        for (index, &[x, y, z, intensity]) in list.points.iter().enumerate() {
            self.text("\n ");
            if list.class == VectorClass::Itemized {
                self.text(if list.lines.get(index) == Some(&true) { "L " } else { "P " });
            }
            self.put(format_args!("{},{}", Number(x), Number(y)));
            if list.dimension == 3 {
                self.put(format_args!(",{}", Number(z)));
            }
            if intensity != 1.0 {
                self.put(format_args!(" I={}", Number(intensity)));
            }
        }
    }

    fn operate(&mut self, operate: &Operate) {
        match operate {
            Operate::Rotate { axis, angle } => {
                let axis = match axis {
                    Axis::X => 'X',
                    Axis::Y => 'Y',
                    Axis::Z => 'Z',
                };
                self.put(format_args!("ROTATE IN {axis} {}", Number(*angle)));
            }
            Operate::Scale(by) => self.put(format_args!("SCALE BY {}", List(&by.to_array()))),
            Operate::Translate(by) => self.put(format_args!("TRANSLATE BY {}", List(&by.to_array()))),
            Operate::Matrix2(m) => self.put(format_args!("MATRIX_2X2 {}", List(&m.to_cols_array()))),
            Operate::Matrix3(m) => self.put(format_args!("MATRIX_3X3 {}", List(&m.to_cols_array()))),
            Operate::Matrix4x3(m) => self.put(format_args!("MATRIX_4X3 {}", List(&four_by_three(m)))),
            Operate::Matrix4(m) => self.put(format_args!("MATRIX_4X4 {}", List(&m.to_cols_array()))),
            Operate::Look { at, from, up } => {
                self.put(format_args!("LOOK AT {} FROM {}", List(&at.to_array()), List(&from.to_array())));
                if let Some(up) = up {
                    self.put(format_args!(" UP {}", List(&up.to_array())));
                }
            }
            Operate::Window { x, y, boundaries } => {
                self.limits("WINDOW X", x);
                self.limits(" Y", y);
                self.boundaries(boundaries);
            }
            Operate::FieldOfView { angle, boundaries } => {
                self.put(format_args!("FIELD_OF_VIEW {}", Number(*angle)));
                self.boundaries(boundaries);
            }
            Operate::Viewport { horizontal, vertical, intensity } => {
                self.limits("VIEWPORT HORIZONTAL", horizontal);
                self.limits(" VERTICAL", vertical);
                if let Some(intensity) = intensity {
                    self.limits(" INTENSITY", intensity);
                }
            }
            Operate::SetColor { hue, saturation } => self.put(format_args!("SET COLOR {}", List(&[*hue, *saturation]))),
            Operate::SetIntensity { on, range: [low, high] } => {
                self.put(format_args!("SET INTENSITY {} {}:{}", on_or_off(*on), Number(*low), Number(*high)));
            }
            Operate::SetDepthClipping(on) => self.put(format_args!("SET DEPTH_CLIPPING {}", on_or_off(*on))),
            Operate::XformMatrix => self.text("XFORM MATRIX"),
        }
    }

    fn limits(&mut self, word: &str, [low, high]: &[f64; 2]) {
        self.put(format_args!("{word} = {}:{}", Number(*low), Number(*high)));
    }

    fn boundaries(&mut self, boundaries: &Option<Boundaries>) {
        if let Some(Boundaries { front, back }) = boundaries {
            self.put(format_args!(" FRONT = {} BACK = {}", Number(*front), Number(*back)));
        }
    }
}

const fn on_or_off(on: bool) -> &'static str {
    if on { "ON" } else { "OFF" }
}

/// The numbers of a 4x3 matrix, row by row of the machine.
pub(super) fn four_by_three(matrix: &DMat4) -> [f64; 12] {
    let columns = matrix.to_cols_array();
    std::array::from_fn(|i| columns[i / 3 * 4 + i % 3])
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
