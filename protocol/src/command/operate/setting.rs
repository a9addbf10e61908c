//! Notations of switches, axes, screens, phases, comparisons, names and the parts of views.

use super::notation::{FieldLabel, Fields, Notation};
use crate::{
    Name,
    command::{
        error::Fault,
        parse::{cursor::Parser, field::NUMBERS},
        print::printer::{Number, Printer},
        syntax::{Axis, Boundaries, CharacterOrientation, Comparison, Rate, Scopes},
        token::TokenKind,
        words::Word,
    },
    record::{BinaryError, BinaryProblem, Reader, Witness, Writer},
};
#[cfg(any(test, feature = "proptest"))]
use {
    crate::command::strategy::basic::{limits, names, reals},
    proptest::prelude::*,
};

/// One more than the highest number of a screen.
const SCOPES: i64 = 4;

/// ON or OFF.
pub(super) struct Switch {
    /// What an error says was expected.
    expected: &'static [&'static str],
}

/// ON or OFF, and nothing else.
pub(super) const SWITCH: Switch = Switch { expected: &["ON", "OFF"] };
/// ON or OFF of SET PICKING, where two other words can stand.
pub(super) const PICKING: Switch = Switch { expected: &["ON", "OFF", "IDENTIFIER", "LOCATION"] };

impl Notation for Switch {
    type Value = bool;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<bool, Fault> {
        Ok(parser.expect_one_of(&[Word::On, Word::Off], self.expected)? == Word::On)
    }

    fn print(&self, value: &bool, printer: &mut Printer<'_>) {
        printer.text(if *value { " ON" } else { " OFF" });
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<bool> {
        any::<bool>().boxed()
    }
}

impl Fields for Switch {
    fn write(&self, value: &bool, writer: &mut Writer<'_>) {
        writer.u8((*value).into());
    }

    fn read<W: Witness>(&self, label: FieldLabel, reader: &mut Reader<'_, '_, W>) -> Result<bool, BinaryError> {
        reader.boolean(label.name)
    }
}

/// A word that holds if it stands there.
pub(super) struct Flag(pub Word);

impl Notation for Flag {
    type Value = bool;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<bool, Fault> {
        Ok(parser.accept_word(self.0))
    }

    fn print(&self, value: &bool, printer: &mut Printer<'_>) {
        if *value {
            printer.text(" ");
            printer.word(self.0);
        }
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<bool> {
        any::<bool>().boxed()
    }
}

/// X, Y or Z.
pub(super) struct AxisLetter;

impl Notation for AxisLetter {
    type Value = Axis;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Axis, Fault> {
        Ok(match parser.expect_one_of(&[Word::X, Word::Y, Word::Z], &["X", "Y", "Z"])? {
            Word::X => Axis::X,
            Word::Y => Axis::Y,
            _ => Axis::Z,
        })
    }

    fn print(&self, value: &Axis, printer: &mut Printer<'_>) {
        printer.text(match value {
            Axis::X => " X",
            Axis::Y => " Y",
            Axis::Z => " Z",
        });
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Axis> {
        prop::sample::select(vec![Axis::X, Axis::Y, Axis::Z]).boxed()
    }
}

impl Fields for AxisLetter {
    fn write(&self, value: &Axis, writer: &mut Writer<'_>) {
        writer.u8(match value {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        });
    }

    fn read<W: Witness>(&self, label: FieldLabel, reader: &mut Reader<'_, '_, W>) -> Result<Axis, BinaryError> {
        match reader.u8(label.name)? {
            0 => Ok(Axis::X),
            1 => Ok(Axis::Y),
            2 => Ok(Axis::Z),
            other => Err(reader.error(1, label.name, BinaryProblem::Unknown(other.into()))),
        }
    }
}

/// A name.
pub(super) struct ObjectName;

impl Notation for ObjectName {
    type Value = Name;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Name, Fault> {
        parser.name()
    }

    fn print(&self, value: &Name, printer: &mut Printer<'_>) {
        printer.text(" ");
        printer.text(value.as_str());
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Name> {
        names().boxed()
    }
}

/// `FRONT [BOUNDARY] [=] f BACK [BOUNDARY] [=] b`, or nothing.
pub(super) struct DepthBoundaries;

impl DepthBoundaries {
    fn boundary(word: Word, parser: &mut Parser<'_>) -> Result<f64, Fault> {
        parser.expect_word(word, word.expected())?;
        parser.accept_word(Word::Boundary);
        parser.accept(TokenKind::Equal);
        parser.real()
    }
}

impl Notation for DepthBoundaries {
    type Value = Option<Boundaries>;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Option<Boundaries>, Fault> {
        if !parser.is(Word::Front) {
            return Ok(None);
        }
        let front = DepthBoundaries::boundary(Word::Front, parser)?;
        Ok(Some(Boundaries { front, back: DepthBoundaries::boundary(Word::Back, parser)? }))
    }

    fn print(&self, value: &Option<Boundaries>, printer: &mut Printer<'_>) {
        if let Some(Boundaries { front, back }) = value {
            printer.put(format_args!(" FRONT = {} BACK = {}", Number(*front), Number(*back)));
        }
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Option<Boundaries>> {
        prop::option::of(limits().prop_map(|[front, back]| Boundaries { front, back })).boxed()
    }
}

impl Fields for DepthBoundaries {
    fn write(&self, value: &Option<Boundaries>, writer: &mut Writer<'_>) {
        writer.u8(value.is_some().into());
        if let Some(Boundaries { front, back }) = value {
            writer.reals(&[*front, *back]);
        }
    }

    fn read<W: Witness>(
        &self,
        label: FieldLabel,
        reader: &mut Reader<'_, '_, W>,
    ) -> Result<Option<Boundaries>, BinaryError> {
        if !reader.boolean(label.given)? {
            return Ok(None);
        }
        Ok(Some(Boundaries { front: reader.f64("front")?, back: reader.f64("back")? }))
    }
}

/// An offset to one of two sides, or none: `LEFT|RIGHT x`.
pub(super) struct SideOffset {
    /// Both words, in the order in which they are tried.
    pub sides: &'static [Word; 2],
    /// The side of negative offsets.
    pub negative: Word,
}

impl Notation for SideOffset {
    type Value = f64;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<f64, Fault> {
        match parser.accept_one_of(self.sides) {
            Some(word) if word == self.negative => Ok(-parser.real()?),
            Some(_) => parser.real(),
            None => Ok(0.0),
        }
    }

    fn print(&self, value: &f64, printer: &mut Printer<'_>) {
        let [first, second] = *self.sides;
        if *value != 0.0 {
            let word = if (*value > 0.0) != (first == self.negative) { first } else { second };
            printer.put(format_args!(" {} {}", word.capitals(), Number(value.abs())));
        }
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<f64> {
        reals().boxed()
    }
}

/// `[FROM SCREEN AREA] w [WIDE]`
pub(super) struct ScreenWidth;

impl Notation for ScreenWidth {
    type Value = f64;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<f64, Fault> {
        parser.accept_word(Word::From);
        parser.accept_word(Word::Screen);
        parser.accept_word(Word::Area);
        if !parser.is_number() {
            return Err(parser.fail(&["FROM SCREEN AREA and its width"]));
        }
        let width = parser.real()?;
        parser.accept_word(Word::Wide);
        Ok(width)
    }

    fn print(&self, value: &f64, printer: &mut Printer<'_>) {
        printer.put(format_args!(" FROM SCREEN AREA {} WIDE", Number(*value)));
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<f64> {
        reals().boxed()
    }
}

/// `ALL` or `n[,m...]`, after SET DISPLAY, which is printed in the plural for all.
pub(super) struct Screens;

impl Notation for Screens {
    type Value = Scopes;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Scopes, Fault> {
        if parser.accept_word(Word::All) {
            return Ok(Scopes::All);
        }
        if !parser.is_number() {
            return Err(parser.fail(&["ALL", "the number of a screen"]));
        }
        let mut bits = 0;
        while parser.is_number() {
            bits |= 1 << parser.integer(0..SCOPES)?;
            parser.accept(TokenKind::Comma);
        }
        Ok(Scopes::Some(bits))
    }

    fn print(&self, value: &Scopes, printer: &mut Printer<'_>) {
        match value {
            Scopes::All => printer.text("S ALL"),
            Scopes::Some(bits) => {
                let mut between = " ";
                for number in (0..8).filter(|number| bits >> number & 1 != 0) {
                    printer.put(format_args!("{between}{number}"));
                    between = ", ";
                }
                if *bits == 0 {
                    printer.text(between);
                }
            }
        }
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Scopes> {
        prop_oneof![Just(Scopes::All), (1_u8..16).prop_map(Scopes::Some)].boxed()
    }
}

/// `WORLD_ORIENTED` or `SCREEN_ORIENTED[/FIXED]`
pub(super) struct Orientation;

impl Notation for Orientation {
    type Value = CharacterOrientation;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<CharacterOrientation, Fault> {
        const EXPECTED: &[&str] = &["WORLD_ORIENTED", "SCREEN_ORIENTED", "SCREEN_ORIENTED/FIXED"];
        if parser.expect_one_of(&[Word::WorldOriented, Word::ScreenOriented], EXPECTED)? == Word::WorldOriented {
            return Ok(CharacterOrientation::World);
        }
        if !parser.accept(TokenKind::Slash) {
            return Ok(CharacterOrientation::Screen);
        }
        parser.expect_word(Word::Fixed, Word::Fixed.expected())?;
        Ok(CharacterOrientation::ScreenFixed)
    }

    fn print(&self, value: &CharacterOrientation, printer: &mut Printer<'_>) {
        printer.text(match value {
            CharacterOrientation::World => " WORLD_ORIENTED",
            CharacterOrientation::Screen => " SCREEN_ORIENTED",
            CharacterOrientation::ScreenFixed => " SCREEN_ORIENTED/FIXED",
        });
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<CharacterOrientation> {
        prop::sample::select(vec![
            CharacterOrientation::World,
            CharacterOrientation::Screen,
            CharacterOrientation::ScreenFixed,
        ])
        .boxed()
    }
}

/// `on off [ON|OFF] [delay]`, where EXTERNAL can stand.
pub(super) struct PhaseRate;

impl Notation for PhaseRate {
    type Value = Rate;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Rate, Fault> {
        if !parser.is_number() {
            return Err(parser.fail(&["EXTERNAL", "the frames of the ON phase"]));
        }
        let on = parser.count()?;
        parser.accept(TokenKind::Comma);
        let off = parser.count()?;
        parser.accept(TokenKind::Comma);
        let initial = parser.accept_one_of(&[Word::On, Word::Off]) != Some(Word::Off);
        parser.accept(TokenKind::Comma);
        let delay = if parser.is_number() { parser.integer(0..NUMBERS)? as u32 } else { 0 };
        Ok(Rate { on, off, initial, delay })
    }

    fn print(&self, value: &Rate, printer: &mut Printer<'_>) {
        let initial = if value.initial { "ON" } else { "OFF" };
        printer.put(format_args!(" {} {} {initial}", value.on, value.off));
        if value.delay != 0 {
            printer.put(format_args!(" {}", value.delay));
        }
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Rate> {
        (any::<u32>(), any::<u32>(), any::<bool>(), prop_oneof![Just(0), any::<u32>()])
            .prop_map(|(on, off, initial, delay)| Rate { on, off, initial, delay })
            .boxed()
    }
}

/// `<`, `<=`, `=`, `<>`, `>=` or `>`
pub(super) struct ComparisonSign;

impl Notation for ComparisonSign {
    type Value = Comparison;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Comparison, Fault> {
        Ok(if parser.accept(TokenKind::Equal) {
            Comparison::Equal
        } else if parser.accept(TokenKind::Less) {
            if parser.accept(TokenKind::Equal) {
                Comparison::LessEqual
            } else if parser.accept(TokenKind::Greater) {
                Comparison::NotEqual
            } else {
                Comparison::Less
            }
        } else if parser.accept(TokenKind::Greater) {
            if parser.accept(TokenKind::Equal) { Comparison::GreaterEqual } else { Comparison::Greater }
        } else {
            return Err(parser.fail(&["`<`", "`<=`", "`=`", "`<>`", "`>=`", "`>`"]));
        })
    }

    fn print(&self, value: &Comparison, printer: &mut Printer<'_>) {
        printer.text(" ");
        printer.text(value.sign());
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Comparison> {
        prop::sample::select(Comparison::ALL.to_vec()).boxed()
    }
}
