//! Tests of the operator commands.

use super::*;
use crate::{
    line::LineId,
    machine::{Input, Key, KeyboardMode, Machine, Settings},
};
use files::Sandbox;

#[test]
fn every_row_has_its_own_word() {
    for (i, row) in rows().enumerate() {
        assert!(rows().take(i).all(|r| r.word != row.word), "{}", row.word);
    }
}

#[test]
fn orders_read_back() {
    assert_eq!(parse("dial 3 -0.25"), Ok(OperatorCommand::Dial { dial: 3, turns: -0.25 }));
    assert_eq!(parse("key 2 shift"), Ok(OperatorCommand::Key(14)));
    assert_eq!(parse("puck move 0.5 -1"), Ok(OperatorCommand::PuckMove([0.5, -1.0])));
    assert_eq!(parse("type a b\\r"), Ok(OperatorCommand::Type("a b\r".into())));
    assert_eq!(parse(r"type \e[A\x41\\x41\q\x4"), Ok(OperatorCommand::Type(b"\x1b[AA\\x41\\q\\x4".to_vec())));
    assert_eq!(parse("key Up"), Ok(OperatorCommand::Press(Key::named("up").unwrap())));
    assert_eq!(parse("key setup"), Ok(OperatorCommand::Press(Key::Setup)));
    assert_eq!(parse("mode command"), Ok(OperatorCommand::Mode(Some(KeyboardMode::Command))));
    assert_eq!(parse("mode"), Ok(OperatorCommand::Mode(None)));
    assert_eq!(parse("message"), Ok(OperatorCommand::Message { fresh: false, frames: 600 }));
    assert_eq!(parse("message new 3"), Ok(OperatorCommand::Message { fresh: true, frames: 3 }));
    assert_eq!(parse("lines"), Ok(OperatorCommand::Lines(true)));
    assert_eq!(parse("stylus down"), Ok(OperatorCommand::PuckPress(1)));
    assert_eq!(parse("stylus move 1 0.5"), Ok(OperatorCommand::PuckMove([1.0, 0.5])));
    let file = "my picture.png".to_string();
    assert_eq!(
        parse("picture vector my picture.png 512"),
        Ok(OperatorCommand::Display(DisplayCommand::Picture { screen: Screen::Vector, file, size: Some([512; 2]) }))
    );
    let file = "a.svg".to_string();
    assert_eq!(
        parse("picture vector a.svg 640x480"),
        Ok(OperatorCommand::Display(DisplayCommand::Picture { screen: Screen::Vector, file, size: Some([640, 480]) }))
    );
    assert_eq!(parse("knob"), Ok(OperatorCommand::Display(DisplayCommand::Knob(None))));
    assert_eq!(parse("steady off"), Ok(OperatorCommand::Display(DisplayCommand::Steady(Some(false)))));
    assert_eq!(parse("screen 3"), Ok(OperatorCommand::Display(DisplayCommand::Screen(Some(3)))));
}

#[test]
fn bad_orders_name_the_word_that_is_wrong() {
    assert_eq!(parse(""), Err(OperatorCommandError::Missing("an order")));
    assert!(matches!(parse("dance"), Err(OperatorCommandError::Unknown { word, .. }) if word == "dance"));
    assert_eq!(parse("dial 9 1"), Err(OperatorCommandError::Bad { found: "9".into(), expected: "a dial, 1 to 8" }));
    assert_eq!(
        parse("dial 1 NaN"),
        Err(OperatorCommandError::Bad { found: "NaN".into(), expected: "a number of turns" })
    );
    let expected = "a function key, 1 to 12, or a key of the list 'keys'";
    assert_eq!(parse("key hyper"), Err(OperatorCommandError::Bad { found: "hyper".into(), expected }));
    assert_eq!(parse("key up shift"), Err(OperatorCommandError::TooMuch("shift".into())));
    let expected = "'terminal', 'command' or 'interactive'";
    assert_eq!(parse("mode chat"), Err(OperatorCommandError::Bad { found: "chat".into(), expected }));
    assert_eq!(
        parse("stylus press"),
        Err(OperatorCommandError::Bad { found: "press".into(), expected: "'move', 'down', 'up' or 'away'" })
    );
    let expected = "'dot', 'json' or the name of a file, with a point in it";
    assert_eq!(parse("graph network jsno"), Err(OperatorCommandError::Bad { found: "jsno".into(), expected }));
    assert!(parse("graph network a.dot").is_ok() && parse("graph network json").is_ok());
    assert!(
        matches!(parse("help dail"), Err(OperatorCommandError::Unknown { word, hint }) if word == "dail" && hint.contains("dial"))
    );
    let expected = "a size, 1 to 8192, or WIDTHxHEIGHT";
    assert_eq!(parse("picture vector a.png 9000"), Err(OperatorCommandError::Bad { found: "9000".into(), expected }));
    assert!(parse("picture vector a.png 0x5").is_err() && parse("knob focus 1.5").is_err());
    assert!(parse("knob volume 1").is_err() && parse("phosphor P0").is_err() && parse("screen 4").is_err());
    assert_eq!(parse("button 3 4"), Err(OperatorCommandError::TooMuch("4".into())));
}

#[test]
fn a_reply_is_one_line() {
    assert_eq!(reply(&Ok(String::new())), "ok");
    assert_eq!(reply(&Ok("a\nb\\".into())), "ok a\\nb\\\\");
    assert_eq!(reply(&Err("no".into())), "error no");
}

/// Files may be anywhere.
fn everywhere() -> Sandbox {
    Sandbox::open("/").unwrap()
}

#[test]
fn orders_that_reach_out_need_a_folder_for_it() {
    let mut machine = Machine::new(Settings::default());
    for order in ["picture vector a.png", "picture vector a.svg", "graph network a.dot", "quit"] {
        let order = parse(order).unwrap();
        let CommandOutcome::Done(Err(text)) = perform(&order, &mut machine, None) else { panic!("{order:?}") };
        assert!(text.contains("--orders"), "{text}");
    }
    for order in ["dial 1 0.5", "graph network dot", "knob focus 0.5", "panel"] {
        let outcome = perform(&parse(order).unwrap(), &mut machine, None);
        assert!(matches!(outcome, CommandOutcome::Done(Ok(_))), "{order}: {outcome:?}");
    }
    let folder = tempfile::tempdir().unwrap();
    let files = Sandbox::open(folder.path()).unwrap();
    for (order, is_written) in
        [("picture vector a.txt", true), ("picture vector ../a.txt", false), ("graph network /a.dot", false)]
    {
        let outcome = perform(&parse(order).unwrap(), &mut machine, Some(&files));
        assert_eq!(matches!(outcome, CommandOutcome::Done(Ok(_))), is_written, "{order}: {outcome:?}");
    }
}

/// A machine that received a text, with the replies to operator commands.
fn replies(text: &str, orders: &[&str]) -> Vec<String> {
    let mut machine = Machine::new(Settings::default());
    let line = LineId(1);
    machine.step([Input::Attach(line), Input::Bytes(line, text.as_bytes().to_vec())], 0);
    let one = |order: &&str| match parse(order).map(|order| perform(&order, &mut machine, Some(&everywhere()))) {
        Ok(CommandOutcome::Done(result)) => reply(&result),
        Ok(CommandOutcome::Waiting(wait)) => loop {
            if let Some(result) = wait.poll(&mut machine) {
                break reply(&result);
            }
            machine.next_frame();
        },
        other => format!("{other:?}"),
    };
    orders.iter().map(one).collect()
}

const CHAIN: &str = "A := F:ADDC; SEND 1 TO <2>A; B := F:PRINT; T := ROTATE IN Z 0;
    CONNECT DIALS<1>:<1>A; CONNECT A<1>:<1>B; CONNECT B<1>:<1>HOST_MESSAGE;";

#[test]
fn a_message_is_seen_on_its_way() {
    let said =
        replies(CHAIN, &["trace", "trace a", "dial 1 0.5", "frames 1", "trace", "trace", "trace a off", "trace"]);
    assert_eq!(said[0], "ok nothing is traced; 'trace NAME' or 'trace all' begins");
    assert_eq!(said[4], "ok DIALS<1> to <1>A: 0.5\\nA<1> to <1>B: 1.5");
    assert_eq!(said[5], "ok no message has passed");
    assert!(said[7].starts_with("ok nothing is traced"));
    assert_eq!(replies(CHAIN, &["trace nobody"]), ["error there is no NOBODY"]);
}

#[test]
fn the_network_stops_at_a_break_and_goes_on_step_by_step() {
    let orders = [
        "break b",
        "dial 1 0.5",
        "frames 1",
        "break",
        "step",
        "message 3",
        "step",
        "message 3",
        "break b off",
        "continue",
    ];
    let said = replies(CHAIN, &orders);
    assert_eq!(said[0], "ok the network runs");
    assert_eq!(said[3], "ok breaks: B; the network stands before B");
    assert_eq!(said[4], "ok B fired; the network stands before HOST_MESSAGE");
    assert_eq!(said[5], "error no message to the host");
    assert_eq!(said[6], "ok HOST_MESSAGE fired; the network stands, nothing is ready");
    assert_eq!((said[7].as_str(), said[9].as_str()), ("ok 1.5", "ok the network runs"));
    assert_eq!(replies(CHAIN, &["break t"]), ["error T is no function"]);
}

#[test]
fn functions_count_what_they_did() {
    let said = replies(CHAIN, &["counters a", "top", "count on", "dial 1 1", "frames 1", "counters a", "top 2"]);
    assert_eq!(said[0], "error nothing is counted; 'count on' begins");
    assert_eq!(said[1], said[0]);
    assert_eq!(said[5], "ok firings=1 faults=0 received=1 sent=1 lost=0 refused=0 longest_queue=1");
    assert_eq!(said[6].matches("firings=1").count(), 2, "{}", said[6]);
}

#[test]
fn clocks_and_devices_count_how_often_they_spoke() {
    let clock = "C := F:CLFRAMES; SEND FIX(2) TO <1>C; SEND TRUE TO <3>C; SEND TRUE TO <4>C; SEND FIX(0) TO <5>C; SEND FIX(1) TO <6>C; CONNECT C<1>:<1>DLABEL2;";
    let text = format!("{CHAIN}{clock}");
    let said =
        replies(&text, &["count on", "dial 1 1", "frames 4", "dial 1 1", "frames 1", "counters dials", "counters c"]);
    assert!(said[5].starts_with("ok firings=2 ") && said[5].contains("sent=2"), "{}", said[5]);
    assert!(!said[6].starts_with("ok firings=0 "), "{}", said[6]);
}

#[test]
fn messages_are_taken_one_by_one_or_all_or_only_new_ones() {
    let text = "SEND 'A' TO <1>HOST_MESSAGE; SEND 'B' TO <1>HOST_MESSAGE; SEND 'C' TO <1>HOST_MESSAGE;";
    assert_eq!(replies(text, &["message", "messages", "messages"]), ["ok A", "ok B\\nC", "ok no message to the host"]);
    assert_eq!(replies(text, &["message new 2", "message 2"]), ["error no message to the host"; 2]);
}

#[test]
fn graphs_show_functions_arcs_and_nodes() {
    let text =
        format!("{CHAIN} L := INSTANCE OF T; DISPLAY L; CONNECT A<1>:<1>T; FONTS := CHARACTER FONT NONE THEN L;");
    let said = replies(&text, &["graph network", "graph network json", "graph structure", "graph structure json"]);
    for (reply, parts) in said.iter().zip([
        &["digraph network", "\"A\" -> \"B\" [label=\"1 > 1\"]", "\"DIALS\" -> \"A\"", "F:ADDC"][..],
        &["\"from\": \"DIALS\"", "\"first\": \"1\"", "\"type\": \"PRINT\""],
        &["digraph structure", "\"the display\" -> \"L\"", "\"L\" -> \"T\""],
        &["\"displayed\": [", "\"descendants\": ["],
    ]) {
        for part in parts {
            assert!(reply.contains(part), "{part}: {reply}");
        }
    }
    for json in [&said[1], &said[3]] {
        let text = json.strip_prefix("ok ").unwrap().replace("\\n", "\n").replace("\\\\", "\\");
        serde_json::from_str::<serde_json::Value>(&text).unwrap();
    }
}

fn performed(machine: &mut Machine, order: &str) -> String {
    match perform(&parse(order).unwrap(), machine, Some(&everywhere())) {
        CommandOutcome::Done(Ok(text)) => text,
        other => panic!("{order}: {other:?}"),
    }
}

#[test]
fn help_lists_every_order_and_keys_every_key() {
    let mut machine = Machine::new(Settings::default());
    let help = performed(&mut machine, "help");
    assert_eq!(help.lines().count(), rows().count());
    for row in rows() {
        assert!(help.lines().any(|line| line.starts_with(row.word) && line.ends_with(row.summary)), "{}", row.word);
    }
    let dial = performed(&mut machine, "help DIAL");
    assert!(help.lines().any(|line| line == dial) && dial.starts_with("dial 1..8 TURNS "), "{dial}");
    for key in performed(&mut machine, "keys").split(' ') {
        assert!(parse(&format!("key {key}")).is_ok(), "{key}");
    }
}

#[test]
fn a_person_works_at_the_terminal_by_orders() {
    let mut machine = Machine::new(Settings::default());
    assert_eq!(performed(&mut machine, "mode"), "interactive");
    performed(&mut machine, "key command");
    performed(&mut machine, r"type SEND 'HELLO' TO <1>FLABEL2;\r");
    assert_eq!(performed(&mut machine, "terminal"), "@@ SEND 'HELLO' TO <1>FLABEL2;\n@@");
    let panel = performed(&mut machine, "panel");
    assert!(panel.starts_with("key 2: HELLO\n") && panel.contains("keyboard: command"), "{panel}");
    assert_eq!(performed(&mut machine, "mode"), "command");
}

#[test]
fn the_prompt_says_what_is_open() {
    let mut machine = Machine::new(Settings::default());
    performed(&mut machine, "key command");
    let mut prompt = |typed: &str| {
        performed(&mut machine, &format!("type {typed}\\r"));
        performed(&mut machine, "terminal").lines().last().unwrap_or_default().to_owned()
    };
    assert_eq!(prompt("DISPLAY"), "@@...>");
    assert_eq!(prompt("A;"), "@@");
    assert_eq!(prompt("ROBOT := BEGIN_STRUCTURE"), "@@...>");
    assert_eq!(prompt("ARM := BEGIN_STRUCTURE NIL;"), "@@2 ROBOT.ARM>");
    assert_eq!(prompt("END_STRUCTURE;"), "@@1 ROBOT>");
    assert_eq!(prompt("END_STRUCTURE; BEGIN;"), "@@BEGIN>");
    assert_eq!(prompt("!RESET;"), "@@");
}

#[test]
fn the_cursor_is_an_overlay_and_no_stroke_of_the_structure() {
    let mut machine = Machine::new(Settings::default());
    performed(&mut machine, "stylus move 0.5 0");
    machine.next_frame();
    assert_eq!(performed(&mut machine, "strokes"), "0 strokes");
    let overlay = performed(&mut machine, "overlay");
    assert!(overlay.starts_with("2 strokes\n0.46 0 0.54 0 1 1 1 1 1\n"), "{overlay}");
    assert_eq!(performed(&mut machine, "overlay 1").lines().count(), 2);
}

#[test]
fn the_display_is_set_by_orders() {
    let mut machine = Machine::new(Settings::default());
    assert_eq!(performed(&mut machine, "knob"), "brightness 0.5, contrast 0.5, focus 1");
    assert_eq!(performed(&mut machine, "knob focus 0.75"), "brightness 0.5, contrast 0.5, focus 0.75");
    assert_eq!(performed(&mut machine, "steady"), "steady on");
    assert_eq!(performed(&mut machine, "steady off"), "steady off");
    assert_eq!(performed(&mut machine, "screen 2"), "screen 2");
    assert_eq!(performed(&mut machine, "phosphor p31"), "P31");
    let phosphors = performed(&mut machine, "phosphor");
    assert!(phosphors.contains("\n* P31 ") && phosphors.starts_with("  P22 "), "{phosphors}");
    assert_eq!(performed(&mut machine, "refresh"), "0.0 microseconds, 60 Hz, drawn by the processor");
}

#[test]
fn a_pixel_is_what_the_raster_screen_shows() {
    let mut machine = Machine::new(Settings::default());
    let line = LineId(1);
    // The client's light goes along the line of sight: what the viewer sees is lit. The other comes from behind it.
    let polygon = "P := POLYGON -.5,-.5,.5 -.5,.5,.5 .5,.5,.5 .5,-.5,.5;";
    for (direction, lit) in [("0,0,1", true), ("0,0,-1", false)] {
        let text = format!(
            "{polygon} S := BEGIN_STRUCTURE R := SURFACE_RENDERING; ILLUMINATION {direction} COLOR 0,0,0.9 AMBIENT 0.7; \
             INSTANCE OF P; END_STRUCTURE; DISPLAY S; SEND FIX(6) TO <1>S.R;"
        );
        machine.step([Input::Attach(line), Input::Bytes(line, text.into())], 0);
        for _ in 0..10 {
            machine.next_frame();
        }
        let pixel = performed(&mut machine, "pixel 320 240");
        let level: u32 = pixel.split(' ').next().unwrap().parse().unwrap();
        assert!(if lit { level > 150 } else { (1..50).contains(&level) }, "{direction}: {pixel}");
        assert_eq!(performed(&mut machine, "pixel 0 479"), "0 0 0");
    }
}

#[test]
fn pictures_are_written_as_pixels_drawings_and_text() {
    let folder = tempfile::tempdir().unwrap();
    let mut machine = Machine::new(Settings::default());
    let line = LineId(1);
    let text = b"V := VECTOR_LIST N = 2 -0.5,0 0.5,0; DISPLAY V;".to_vec();
    machine.step([Input::Attach(line), Input::Bytes(line, text)], 0);
    let file = |name: &str| folder.path().join(name).display().to_string();
    for (name, reply) in
        [("a.png 30x20", "30x20"), ("b.exr 20", "20x20"), ("c.svg", "1 strokes"), ("d.txt", "1 strokes")]
    {
        let said = performed(&mut machine, &format!("picture vector {}", file(name)));
        assert!(said.ends_with(reply), "{said}");
    }
    let text = std::fs::read_to_string(file("d.txt")).unwrap();
    assert_eq!(text, "1 strokes\n-0.5 0 0.5 0 1 1 1 1 1\n");
    assert!(std::fs::read_to_string(file("c.svg")).unwrap().contains("M250.00 500.00L750.00 500.00"));
    let pixels = image::open(file("a.png")).unwrap().into_rgb8();
    assert_eq!((pixels.width(), pixels.height()), (30, 20));
    assert!(pixels.pixels().any(|pixel| pixel.0[0] > 100));
}
