//! Facts about the other commands: structures, attributes, conditions, networks, the system.

use super::*;
use crate::command::{
    print,
    strategy::commands,
    syntax::{CharacterOrientation, Comparison, Destination, Rate, Scopes},
};
use glam::DVec2;
use proptest::{prelude::*, sample::Index};

fn command(text: &str) -> Command {
    parse(text.as_bytes()).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn to(input: Input, target: &str) -> Destination {
    Destination { input, name: name(target) }
}

#[test]
fn a_lone_name_is_an_alias() {
    assert_eq!(object("A := B.C;"), Object::Alias(name("B.C")));
    for word in ["IF", "IN", "IS", "P", "L", "I", "N", "X", "S", "C", "SET", "ROTATE", "F", "SEND", "END"] {
        assert_eq!(object(&format!("A := {word};")), Object::Alias(name(word)));
        assert!(matches!(command(&format!("{word} := NIL;")), Command::Define { name: Some(_), .. }));
        assert_eq!(command(&format!("DISPLAY {word};")), Command::Display(name(word)));
    }
    assert_eq!(object("A := NIL;"), Object::Nil);
    assert_eq!(object("A := NIL,;"), Object::Alias(name("NIL")));
    assert!(message("A := B C;").starts_with("1:6: expected what the name is to be"));
    assert!(parse(b"B;").is_err());
}

#[test]
fn applied_to_has_three_forms() {
    same("A := ROT X 3 APPL TO B;", "A := ROT X 3 -> B;");
    same("A := ROT X 3 APPLIED B;", "A := ROT X 3 THEN B;");
    same("A := ROT X -3->B;", "A := ROT X -3 -> B;");
    assert!(message("A := ROT X -> B;").starts_with("1:12: expected a number"));
}

#[test]
fn prefix_and_follow_take_operate_nodes_only() {
    let Command::Prefix { operate, .. } = command("PRE A WITH SET COLOR 1,1;") else { panic!("PREFIX") };
    assert_eq!(operate, Operate::SetColor { hue: 1.0, saturation: 1.0 });
    assert!(matches!(command("FOLL WITH WITH CHAR ROT 3;"), Command::Follow { .. }));
    let expected = "1:15: expected an operate command (such as ROTATE), found `VECTOR_LIST`";
    assert_eq!(message("PREFIX A WITH VECTOR_LIST 1,1;"), expected);
    assert!(message("FOLLOW A WITH ROT X 3 -> B;").starts_with("1:15: expected an operate command without APPLIED TO"));
    assert!(message("FOLLOW A WITH CHAR 'x';").starts_with("1:15: expected an operate command"));
}

#[test]
fn remove_has_four_forms() {
    assert_eq!(command("REM PRE OF A;"), Command::RemovePrefix(name("A")));
    assert_eq!(command("REMOVE FOLLOWER A;"), Command::RemoveFollower(name("A")));
    assert_eq!(command("REMOVE PREFIX OF OF;"), Command::RemovePrefix(name("OF")));
    assert_eq!(command("REMOVE PREFIX;"), Command::Remove(name("PREFIX")));
    let from = Command::RemoveFrom { name: name("PREFIX"), from: name("OF") };
    assert_eq!(command("REMOVE PREFIX FROM OF;"), from);
    assert_eq!(command("FORGET (UNIT);"), Command::ForgetUnit(name("UNIT")));
}

#[test]
fn every_view_is_read() {
    let eye = operate("EYE BACK 30 LEFT 1.25 UP 0.5 FROM SCREEN AREA 12 WIDE FRONT=12 BACK=70;");
    let Operate::Eye { back, right, up, width, boundaries: Some(limits) } = eye else { panic!("EYE") };
    assert_eq!((back, right, up, width, limits.front, limits.back), (30.0, -1.25, 0.5, 12.0, 12.0, 70.0));
    same("EYE BACK 3 FROM SCREEN AREA 2 WIDE;", "EYE BACK 3 RIGHT 0 DOWN 0 FROM SCREEN AREA 2 WIDE;");
    assert!(message("EYE BACK 3;").starts_with("1:11: expected FROM SCREEN AREA"));
    let load = operate("LOAD VIEW HOR=-1:0 VERT=0:1 INTEN=0:1;");
    assert!(matches!(load, Operate::LoadViewport { intensity: Some([0.0, 1.0]), .. }));
}

#[test]
fn every_attribute_is_read() {
    for (text, expected) in [
        ("SET COLOR BLENDING 1;", Operate::SetColorBlending(1.0)),
        ("SET CONTRAST TO .5;", Operate::SetContrast(0.5)),
        ("SET CONTRAST .5;", Operate::SetContrast(0.5)),
        ("SET CSM ON;", Operate::SetCsm(true)),
        ("SET DISP ALL OFF;", Operate::SetDisplays { scopes: Scopes::All, on: false }),
        ("SET DISPLAY 0, 3 ON;", Operate::SetDisplays { scopes: Scopes::Some(9), on: true }),
        ("SET CHAR WORLD;", Operate::SetCharacters(CharacterOrientation::World)),
        ("SET CHARACTERS SCREEN;", Operate::SetCharacters(CharacterOrientation::Screen)),
        ("SET CHAR SCREEN_ORIENTED/FIXED;", Operate::SetCharacters(CharacterOrientation::ScreenFixed)),
        ("SET PICK ON;", Operate::SetPicking(true)),
        ("SET PICKING ID = ON;", Operate::SetPickingIdentifier(name("ON"))),
        ("SET PICKING IDENTIFIER X;", Operate::SetPickingIdentifier(name("X"))),
        ("SET PICK LOC = .5,1;", Operate::SetPickingLocation { center: DVec2::new(0.5, 1.0), size: None }),
        ("SET PICK LOC 0 0, 1 1;", Operate::SetPickingLocation { center: DVec2::ZERO, size: Some(DVec2::ONE) }),
        ("SET LEV TO 32767;", Operate::SetLevelOfDetail(32_767)),
        ("INCR LEV;", Operate::IncrementLevelOfDetail),
        ("DECREMENT LEVEL_OF_DETAIL;", Operate::DecrementLevelOfDetail),
        ("SET COND 14 OFF;", Operate::SetConditionalBit { bit: 14, on: false }),
        ("SET RATE EXT;", Operate::SetRateExternal),
        ("SET BLINKING ON;", Operate::SetBlinking(true)),
        ("SET BLINK RATE 30;", Operate::SetBlinkRate(30)),
        ("SET PLOT OFF;", Operate::SetPlotter(false)),
        ("SET PRIOR -2;", Operate::SetPriority(-2)),
        ("SET LINE AROUND 3;", Operate::SetLineTexture { around_corners: true, texture: 3 }),
        ("CHAR FONT SCRIPT;", Operate::CharacterFont(name("SCRIPT"))),
        ("FONT SCRIPT;", Operate::CharacterFont(name("SCRIPT"))),
        ("STAN FONT;", Operate::StandardFont),
        ("CHARACTER SCALE 2;", Operate::CharacterScale(DVec2::splat(2.0))),
        ("CHARACTER SCALE 2,3;", Operate::CharacterScale(DVec2::new(2.0, 3.0))),
        ("CHAR ROT 90;", Operate::CharacterRotate(90.0)),
        ("TEXT SIZE .1;", Operate::TextSize(0.1)),
        ("XFORM VEC;", Operate::XformVector),
        ("CANCEL XFORM;", Operate::CancelXform),
        ("WRITEBACK;", Operate::WriteBack),
        ("SURF;", Operate::SurfaceRendering),
        ("SOLID;", Operate::SolidRendering),
        ("SECT;", Operate::SectioningPlane),
    ] {
        assert_eq!(operate(text), expected, "{text}");
    }
    assert_eq!(message("SET LEVEL TO 32768;"), "1:14: the number must be 0 to 32767, found `32768`");
    assert_eq!(message("SET CONDITIONAL_BIT 15 ON;"), "1:21: the number must be 0 to 14, found `15`");
    assert_eq!(message("SET DISPLAY 4 ON;"), "1:13: the number must be 0 to 3, found `4`");
    assert!(message("SET DISPLAY ON;").starts_with("1:13: expected ALL or the number of a screen"));
}

#[test]
fn a_rate_starts_on_and_at_once_unless_said() {
    let rate = |on, off, initial, delay| Operate::SetRate(Rate { on, off, initial, delay });
    assert_eq!(operate("SET RATE 20 10;"), rate(20, 10, true, 0));
    assert_eq!(operate("SET RATE 20,10,OFF,5;"), rate(20, 10, false, 5));
    assert_eq!(operate("SET RATE 20 10 7;"), rate(20, 10, true, 7));
    same("R := SET RATE 20 10 ON 3 THEN A;", "R := SET RATE 20 10 3 -> A;");
}

#[test]
fn every_condition_is_read() {
    assert_eq!(operate("IF COND 2 IS ON THEN CUD;"), Operate::IfConditionalBit { bit: 2, on: true });
    assert_eq!(operate("IF PHASE OFF;"), Operate::IfPhase(false));
    for comparison in Comparison::ALL {
        let expected = Operate::IfLevelOfDetail { comparison, level: 3 };
        assert_eq!(operate(&format!("IF LEVEL_OF_DETAIL {} 3;", comparison.sign())), expected);
        assert_eq!(operate(&format!("IF LEV{}3;", comparison.sign())), expected);
    }
    assert!(message("IF LEVEL 3;").starts_with("1:10: expected `<`, `<=`, `=`, `<>`, `>=` or `>`"));
    assert!(message("IF COND 15 IS ON;").starts_with("1:9: the number must be 0 to 14"));
}

#[test]
fn messages_go_to_inputs_in_every_form() {
    let one = to(Input::Number(1), "A");
    same("STORE FIX(3) IN A;", "SEND FIX(3) TO <1>A;");
    same("STORE 'x' IN;", "SEND 'x' TO <1>IN;");
    assert_eq!(
        command("SEND VALUE(V) TO <1>A;"),
        Command::SendVariable { variable: name("V"), destination: one.clone() }
    );
    same("STORE VALUE(V) IN A;", "SEND VALUE(V) TO <1>A;");
    let append = to(Input::Append, "B");
    assert_eq!(command("SEND VL(A) TO <append>B;"), Command::SendVectors { list: name("A"), destination: append });
    let marks = Command::SendMarks { count: 3, lines: true, destination: to(Input::Number(2), "V") };
    assert_eq!(command("SEND 3*L TO <2>V;"), marks);
    assert!(matches!(command("SEND 3 * p <2>V;"), Command::SendMarks { lines: false, .. }));
    assert!(message("SEND 1.5*L TO <2>V;").starts_with("1:6: expected a whole number"));
    assert_eq!(command("VARIABLE A, B;"), Command::Variable(vec![name("A"), name("B")]));
    let constant = Command::SetupCness { constant: true, destination: one.clone() };
    assert_eq!(command("SETUP CNESS TRUE <1>A;"), constant);
    let several =
        Command::ConnectSeveral { source: name("S"), output: 2, destinations: vec![one, to(Input::Last, "B")] };
    assert_eq!(command("CONN S<2>:<1>A, <last>B;"), several);
    same("SEND M4D(1,0,0,0 0,1,0,0 0,0,1,0 0,0,0,1) TO <1>A;", "SEND M4D(1 0 0 0,0 1 0 0,0 0 1 0,0 0 0 1) TO <1>A;");
}

#[test]
fn every_command_to_the_system_is_read() {
    for (text, expected) in [
        ("BEGIN;", Command::Begin),
        ("END;", Command::End),
        ("END_F;", Command::EndFont),
        ("OPTIMIZE STRUCTURE;", Command::OptimizeStructure),
        ("END OPTIMIZE;", Command::EndOptimize),
        ("OPTIMIZE MEMORY;", Command::OptimizeMemory),
        ("RESERVE_WORKING_STORAGE 100000;", Command::ReserveWorkingStorage(100_000)),
        ("COMMAND STAT;", Command::CommandStatus),
        ("REBOOT SECRET;", Command::Reboot(name("SECRET"))),
        ("CONFIGURE SECRET;", Command::Configure(name("SECRET"))),
        ("FINISH CONFIGURATION;", Command::FinishConfiguration),
        ("SETUP PASSWORD SECRET;", Command::SetupPassword(name("SECRET"))),
        ("SHOW INTERFACE PORT1;", Command::ShowInterface(name("PORT1"))),
        ("SHOW INTERRUPTS;", Command::ShowInterrupts),
        ("GIVE_UP_CPU;", Command::GiveUpCpu),
        ("ALLOW_VECNORM;", Command::AllowVecnorm),
        ("!RESET;", Command::Reset),
        ("! reset", Command::Reset),
    ] {
        assert_eq!(command(text), expected, "{text}");
    }
    let Command::SetupInterface { port, options } = command("SETUP INTERFACE port1/speed=9600/parity=Even/XON;") else {
        panic!("SETUP INTERFACE");
    };
    let options: Vec<(&str, &str)> = options.iter().map(|(option, value)| (option.as_str(), value.as_str())).collect();
    assert_eq!((port.as_str(), &options[..]), ("PORT1", &[("SPEED", "9600"), ("PARITY", "EVEN"), ("XON", "")][..]));
    assert!(message("!RESTE;").ends_with("found `RESTE`; did you mean RESET?"));
    assert!(message("SETUP CNESS;").starts_with("1:12: expected TRUE or FALSE"));
}

#[test]
fn every_example_of_the_reference_is_read() {
    for (text, count) in [
        (&include_bytes!("../picking.ps300")[..], 36),
        (&include_bytes!("../clock.ps300")[..], 47),
        (&include_bytes!("../rendering.ps300")[..], 17),
    ] {
        let mut reader = CommandReader::default();
        reader.push(text);
        let commands: Result<Vec<_>, _> = reader.by_ref().collect();
        assert!(!reader.is_unfinished());
        assert_eq!(commands.map(|commands| commands.len()), Ok(count));
    }
}

proptest! {
    #[test]
    fn a_damaged_command_is_read_or_its_error_lies_inside(
        command in commands(),
        damage in prop::collection::vec((any::<Index>(), prop::sample::select(b" ;,:=<>()[]*/!-'{}0.EPLSNIHT".to_vec())), 1..4),
        cut in any::<Index>()
    ) {
        let mut text = Vec::new();
        print(&command, &mut text);
        for (place, byte) in damage {
            let at = place.index(text.len());
            text[at] = byte;
        }
        text.truncate(cut.index(text.len()) + 1);
        if let Err(error) = parse(&text) {
            prop_assert!(error.span.start <= error.span.end && error.span.end <= text.len());
            prop_assert!(!error.message().is_empty() && error.line >= 1 && error.column >= 1);
        }
    }
}
