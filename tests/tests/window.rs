//! The window of the PS 340, worked by real events of the X window system. Where Xvfb or xdotool is not installed these
//! tests say so and do nothing; where `CI` is set they fail.

#![cfg(target_os = "linux")]

use std::{
    fs,
    process::Command,
    time::{Duration, Instant},
};
use tests::{TIMEOUT, run, windowed::WindowedMachine};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");

#[test]
fn dials_keys_puck_and_keyboard_reach_the_machine() {
    let Some(mut desk) = WindowedMachine::open(PS340) else { return };

    // A dial that is dragged by 120 points to the right makes half a turn.
    desk.send(
        "SUM := F:ACCUMULATE; SEND 0 TO <2>SUM; SEND 0 TO <3>SUM; SEND 1 TO <4>SUM; SEND 9 TO <5>SUM; \
               SEND -9 TO <6>SUM; CONNECT DIALS<1>:<1>SUM; CONNECT SUM<1>:<1>TEXT; TEXT := F:PRINT; \
               CONNECT TEXT<1>:<1>HOST_MESSAGE;\n",
    );
    desk.expect("show TEXT", "PRINT");
    desk.drag("dial 1", [120, 0]);
    let begin = Instant::now();
    let mut turned = 0.0_f64;
    while (turned - 0.5).abs() > 1e-3 {
        assert!(begin.elapsed() < TIMEOUT, "the dial was turned by {turned}");
        let reply = desk.operator_command("message 60");
        turned = reply.strip_prefix("ok ").and_then(|text| text.trim().parse().ok()).unwrap_or(turned);
    }

    // F3 is function key 3.
    desk.send(
        "CONNECT FKEYS<1>:<1>TEXT; CONNECT BUTTONSIN<1>:<1>TEXT; LATER := VECTOR_LIST ITEMIZED N=2 P 0,0 L 0,0;\n",
    );
    desk.expect("show LATER", "VECTOR_LIST");
    let [x, y] = desk.position_of("vector screen");
    desk.click("vector screen");
    desk.act("key F3");
    desk.expect("message 60", "ok 3");

    // A lighted button that is clicked.
    desk.click("button 7");
    desk.expect("message 60", "ok 7");

    // The word OPEN of the menu is picked with the puck.
    desk.send(include_str!("../../ps340/programs/pick.ps300"));
    desk.expect("show MENU", "BEGIN_STRUCTURE");
    let [corner_x, _] = desk.position_of("vector screen's corner");
    let half = f64::from(corner_x - x);
    let (word_x, word_y) = (f64::from(x) + 0.62 * half, f64::from(y) - 0.5 * half);
    desk.act(&format!("mousemove {word_x:.0} {word_y:.0}"));
    desk.act("mousedown 1");
    desk.act("mouseup 1");
    desk.expect("message 60", "OPEN");

    // A command that is typed on the keyboard.
    desk.act("key ctrl+alt+c");
    desk.expect("mode", "command");
    desk.act("type --delay 60 TYPED:=F:PRINT;");
    desk.act("key Return");
    desk.expect("show TYPED", "PRINT");

    // The pane of the tablet: the puck in the middle of its right half.
    desk.send("CONNECT TABLETIN<1>:<1>TEXT; CONNECT BUTTONSIN<1>:<1>TEXT;\n");
    desk.inspect("Tablet");
    let [x, y] = desk.position_of("tablet");
    desk.act(&format!("mousemove {} {y}", x + 60));
    desk.expect("message 60", "ok V 0.");

    // The knob of the brightness at its lowest. Where frames are slow, a whole drag may fall into one: it is done
    // again.
    desk.inspect("Display");
    let begin = Instant::now();
    while !desk.operator_command("knob").contains("brightness 0,") {
        assert!(begin.elapsed() < TIMEOUT, "the knob does not turn: {}", desk.operator_command("knob"));
        let [x, y] = desk.position_of("knob brightness");
        let steps = [format!("mousemove {} {y}", x + 30), "mousedown 1".into(), format!("mousemove {} {y}", x - 20)];
        for step in steps.iter().map(String::as_str).chain(["mouseup 1"]) {
            desk.act(step);
            desk.operator_command("frames 3");
        }
    }
    desk.inspect("Display");

    // From a pixel to 8K and back, the window shows what it is given, while polygons are shaded.
    desk.send(
        "RESERVE_WORKING_STORAGE 100000; SEND FIX(3) TO <5>SHADINGENVIRONMENT; \
               T := POLYGON .5,.5,.5 .5,-.5,-.5 -.5,.5,-.5 POLYGON .5,.5,.5 -.5,.5,-.5 -.5,-.5,.5 \
               POLYGON .5,.5,.5 -.5,-.5,.5 .5,-.5,-.5 POLYGON .5,-.5,-.5 -.5,-.5,.5 -.5,.5,-.5; \
               SOLID := SOLID_RENDERING APPLIED TO T; DISPLAY SOLID;\n",
    );
    desk.send(&"SEND FIX(8) TO <1>SOLID;".repeat(60));
    let before = desk.position_of("button 9");
    for size in ["1 1", "7680 4320", "1 8400", "1280 860"] {
        desk.resize(size);
        desk.expect("refresh", "Hz");
    }
    let begin = Instant::now();
    while desk.position_of("button 9") != before {
        assert!(begin.elapsed() < TIMEOUT, "the window is not as it was");
    }
    desk.click("button 9");
    desk.expect("message 60", "ok 9");
    desk.send("CONNECT SOLID<1>:<1>TEXT; SEND FIX(8) TO <1>SOLID;\n");
    desk.expect("message 60", "ok T");
}

#[test]
fn the_mouse_turns_what_a_program_shows_and_the_empty_screen_offers_programs() {
    let Some(mut desk) = WindowedMachine::open(PS340) else { return };
    // The smallest window that is looked after has every device, too.
    desk.resize("800 600");
    desk.click("example dials");
    desk.expect("show WORLD", "BEGIN_STRUCTURE");
    desk.position_of("button 32");
    desk.send("TEXT := F:PRINT; SUM := F:ACCUMULATE; CONNECT DIALS<2>:<1>SUM; CONNECT DIALS<5>:<1>SUM;\n");
    desk.send("SEND 0 TO <2>SUM; SEND 1 TO <4>SUM; CONNECT SUM<1>:<1>TEXT; CONNECT TEXT<1>:<1>HOST_MESSAGE;\n");
    desk.expect("show TEXT", "PRINT");
    let [x, _] = desk.position_of("vector screen");
    let [corner, _] = desk.position_of("vector screen's corner");
    let quarter = (corner - x) / 2;
    desk.drag("vector screen", [quarter, 0]);
    let sum = |desk: &mut WindowedMachine| {
        let mut sum = 0.0;
        while let Some(text) = desk.operator_command("message 60").strip_prefix("ok ") {
            sum = text.trim().parse::<f64>().expect("a number");
        }
        sum
    };
    let turned = sum(&mut desk);
    assert!((turned + 0.9 / 4.0).abs() < 5e-3, "a drag over a quarter of the screen turned dial 2 by {turned}");
    desk.act("keydown shift");
    desk.drag("vector screen", [quarter, 0]);
    desk.act("keyup shift");
    let moved = sum(&mut desk) - turned;
    assert!((moved - 0.25).abs() < 5e-3, "with SHIFT it turned dial 5 by {moved}");
    desk.leave();
    desk.resize("2560 1440");
    desk.position_of("button 32");
}

/// A pot that takes hours to render.
const POT: &str = r#"
    image(160, 120);
    samples(40000);
    teapot().rotate("y", 20);
    directional_light(#{ direction: [0, 0, -1], irradiance: 1 });
    camera(#{ from: [0, 4, 14], at: [0, 1.5, 0], field_of_view: 34 });
"#;

#[test]
fn a_scene_is_turned_rendered_while_one_looks_on_and_kept() {
    let Some(mut desk) = WindowedMachine::open(PS340) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    fs::write(file("pot.rhai"), POT).expect("written");
    let (to, path) = (format!("tcp:{}", desk.line), folder.path().to_path_buf());
    let shown = std::thread::spawn(move || {
        run(PERIS, &["show", "pot.rhai", "--watch", "--camera", "camera.txt", "--to", &to], &[], &path, TIMEOUT * 5)
    });
    desk.expect("panel", "key 4: CANCEL");
    let before = desk.operator_command("show PERIS.RY");
    desk.drag("vector screen", [60, 24]);
    assert_ne!(desk.operator_command("show PERIS.RY"), before);

    // Rows arrive while it renders, and the label shows how far it is.
    desk.click("key 1");
    desk.expect("panel", "of 40000 samples");
    let raster = file("raster.png");
    let lit = |desk: &mut WindowedMachine| {
        desk.operator_command(&format!("picture raster {}", raster.display()));
        let picture = image::open(&raster).expect("a picture").to_rgb8();
        picture.pixels().filter(|pixel| pixel.0.iter().any(|byte| *byte > 8)).count()
    };
    let begin = Instant::now();
    while lit(&mut desk) < 1000 {
        assert!(begin.elapsed() < TIMEOUT, "nothing arrives");
        std::thread::sleep(Duration::from_millis(50));
    }
    assert!(desk.operator_command("panel").contains("key 1: 0 %"), "{}", desk.operator_command("panel"));
    std::thread::sleep(Duration::from_secs(1));
    desk.click("key 4");
    desk.expect("panel", "key 1: RENDER");
    desk.expect("panel", "message: stopped after");
    let rendered = lit(&mut desk);

    // The line that keeps the view renders to the same silhouette.
    desk.click("key 3");
    let begin = Instant::now();
    while !file("camera.txt").exists() {
        assert!(begin.elapsed() < TIMEOUT, "nobody tells the view");
        std::thread::sleep(Duration::from_millis(20));
    }
    let camera = fs::read_to_string(file("camera.txt")).expect("read");
    let own = POT.lines().find(|line| line.trim_start().starts_with("camera(")).expect("there is one");
    let again = POT.replace(own, &camera).replace("40000", "16");
    fs::write(file("again.rhai"), again).expect("written");
    let ended = run(PERIS, &["render", "again.rhai", "-o", "again.png"], &[], folder.path(), TIMEOUT);
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    let picture = image::open(file("again.png")).expect("a picture").to_rgb8();
    let again = picture.pixels().filter(|pixel| pixel.0.iter().any(|byte| *byte > 8)).count();
    assert!(again > 2000 && rendered.abs_diff(again) <= again / 50, "{rendered} and {again} pixels");

    // A script that is saved is shown within a second, and stays turned; one that is wrong is reported.
    let turned = desk.operator_command("show PERIS.RY");
    fs::write(file("pot.rhai"), POT.replace("teapot()", "sphere(1)")).expect("written");
    let saved = Instant::now();
    let vectors = |desk: &mut WindowedMachine| desk.operator_command("counters").replace("\\n", "\n");
    let many = vectors(&mut desk);
    while vectors(&mut desk).lines().find(|line| line.contains("vectors"))
        == many.lines().find(|l| l.contains("vectors"))
    {
        assert!(saved.elapsed() < TIMEOUT, "the script is not shown anew");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(desk.operator_command("show PERIS.RY"), turned);
    fs::write(file("pot.rhai"), "sphere(-1);").expect("written");
    desk.expect("panel", "pot.rhai:1:");
    desk.click("key 12");
    let ended = shown.join().expect("it ends");
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    assert!(ended.errors.contains("pot.rhai:1:"), "{}", ended.errors);
}

#[test]
fn a_display_that_nobody_serves_is_named_and_the_machine_does_not_start() {
    let mut command = Command::new(PS340);
    command.args(["--window", "--listen", "tcp:127.0.0.1:0"]).env("DISPLAY", ":9999").env_remove("WAYLAND_DISPLAY");
    let output = command.output().expect("ps340 runs");
    let text = String::from_utf8_lossy(&output.stderr);
    // Where the libraries of the window system are missing too, the first of them is named instead.
    let is_named = text.contains("the display :9999 cannot be reached") || text.contains("apt install");
    assert!(is_named && output.status.code() == Some(1), "{text}");
    assert!(output.stdout.is_empty(), "{}", String::from_utf8_lossy(&output.stdout));
}
