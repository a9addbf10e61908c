//! Objects that move: on the machine a clock moves them as the host says they do.

use host::{
    picture::Picture,
    picture::display::DisplayTransform,
    production::{Model, Production, Progressive, RenderingEvent},
    render::{RenderOrder, Watch},
    scene::{Prepared, Scene},
    script,
    workstation::{Drawing, FlipBook, InitialView, MotionPeriod, Session, Timeouts, structure},
};
use protocol::wire::write_commands;
use ps340::{
    line::LineId,
    machine::{Event, Input, Machine, Settings},
};
use std::path::Path;
use std::time::{Duration, Instant};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
const LINE: LineId = LineId(1);

/// What stands; what turns about a slanted axis, in two objects; what only moves; instances that roll.
const SCENE: &str = r#"
    image(512, 512);
    box(6, 0.1, 4).translate(0, -1.5, 0).material([0.2, 0.5, 0.2]);
    for side in [-0.6, 0.6] {
        box(0.5, 0.3, 0.2).translate(side - 1, 0.5, 0)
            .moving(#{ axis: [0.48, 0.6, -0.64], angle: 75, through: [-1, 0.4, 0.1] });
    }
    box(0.4, 0.4, 0.4).translate(1.5, 0.3, 0.5).moving(#{ by: [-0.2, 0.3, 0.6] });
    instances(box(0.3, 0.2, 0.1), [[0, 0.5, 0], #{ at: [0.4, 0, 0.2], turn: 30 }]).translate(0, -0.8, 1)
        .moving(#{ by: [0.5, 0, 0], axis: "z", angle: -100, through: [0, -0.8, 1] });
    directional_light(#{ direction: [-1, -2, -1.5], irradiance: 1 });
    camera(#{ from: [2, 3, 12], at: [0, 0, 0], field_of_view: 30, near: 5, far: 25 });
    shutter(0.25, 0.25);
"#;
/// Frames of a period of two seconds.
const PERIOD: u32 = 120;

fn scene() -> Scene {
    script::evaluate(SCENE, "motion", Path::new(""), &script::Inputs::default()).expect("a scene").scene
}

/// The scene as it stands after seconds, without its motions.
fn after(seconds: f64) -> Scene {
    let mut scene = scene();
    for (object, motion) in std::mem::take(&mut scene.motions) {
        let object = &mut scene.objects[object as usize];
        object.transform = motion.at(seconds).matrix() * object.transform;
    }
    scene
}

fn drawing(facets: bool, period: Option<MotionPeriod>) -> Drawing {
    Drawing { facets, most: Some(1_000_000), motion: period, ..Drawing::default() }
}

/// The bytes that show a scene.
fn bytes(scene: &Scene, drawing: &Drawing) -> Vec<u8> {
    let prepared = Prepared::new(scene).expect("a scene");
    let initial = InitialView::of(&prepared).expect("a camera");
    let shown = structure::commands(scene, &initial, &prepared.subject(), drawing).expect("it is drawn");
    let mut sent = Vec::new();
    write_commands(&shown.commands, &mut sent).expect("it can be sent");
    sent
}

/// A machine that shows a scene.
fn showing(scene: &Scene, facets: bool, period: Option<MotionPeriod>) -> Machine {
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    machine.step([Input::Bytes(LINE, bytes(scene, &drawing(facets, period)))], 0);
    machine
}

fn moving(facets: bool) -> Machine {
    showing(&scene(), facets, Some(MotionPeriod::Seconds(f64::from(PERIOD) / 60.0)))
}

fn pass(machine: &mut Machine, frames: u32) {
    (0..frames).for_each(|_| machine.next_frame());
}

/// Places and intensities of all strokes.
fn strokes(machine: &Machine) -> Vec<[f32; 6]> {
    let strokes = machine.latest_update().strokes.iter();
    strokes
        .map(|stroke| {
            let ([x, y], [to_x, to_y], [from, to]) = (stroke.start, stroke.end, stroke.intensity);
            [x, y, to_x, to_y, from, to]
        })
        .collect()
}

/// The largest difference of a stroke from the one that is nearest to it, whichever way the beam goes; infinite if there
/// are not as many.
fn difference(one: &[[f32; 6]], other: &[[f32; 6]]) -> f32 {
    if one.len() != other.len() {
        return f32::INFINITY;
    }
    let apart = |a: &[f32; 6], b: &[f32; 6]| {
        let reversed = [b[2], b[3], b[0], b[1], b[5], b[4]];
        let largest = |b: &[f32; 6]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        largest(b).min(largest(&reversed))
    };
    let nearest = |a: &[f32; 6]| other.iter().map(|b| apart(a, b)).fold(f32::INFINITY, f32::min);
    one.iter().map(nearest).fold(0.0, f32::max)
}

#[test]
fn after_each_frame_the_machine_draws_what_moves_where_the_host_says_also_when_it_begins_anew() {
    let mut machine = moving(false);
    let mut passed = 0;
    let mut before = Vec::new();
    for frame in [1, 30, 77, PERIOD - 1, PERIOD, PERIOD + 45, 3 * PERIOD + 10] {
        pass(&mut machine, frame - passed);
        passed = frame;
        let seconds = f64::from(passed % PERIOD) / 60.0;
        let mut still = showing(&after(seconds), false, None);
        pass(&mut still, 1);
        let (drawn, expected) = (strokes(&machine), strokes(&still));
        let off = difference(&drawn, &expected);
        assert!(drawn.len() > 60 && off < 1e-6, "{} strokes, after {passed} frames off by {off}", drawn.len());
        assert!(difference(&drawn, &before) > 1e-3, "it moves");
        before = drawn;
    }
}

#[test]
fn a_key_stops_what_moves_and_lets_it_go_on_and_other_keys_do_not() {
    let mut machine = moving(false);
    pass(&mut machine, 20);
    machine.event(Event::Key(2));
    pass(&mut machine, 5);
    machine.event(Event::Key(5));
    let stopped = strokes(&machine);
    pass(&mut machine, 40);
    machine.event(Event::Key(3));
    pass(&mut machine, 40);
    assert_eq!(strokes(&machine), stopped);
    machine.event(Event::Key(5));
    pass(&mut machine, 10);
    let mut still = showing(&after(35.0 / 60.0), false, None);
    pass(&mut still, 1);
    let off = difference(&strokes(&machine), &strokes(&still));
    assert!(off < 1e-6, "off by {off}");
}

#[test]
fn the_machine_shades_what_moves_as_it_stands() {
    let shaded = |mut machine: Machine| {
        machine.step([Input::Bytes(LINE, b"\nSEND FIX(7) TO <1>PERIS.SHADE;".into())], 0);
        while !machine.network_rests() {
            machine.next_frame();
        }
        pass(&mut machine, 2);
        machine.raster_picture().to_srgb()
    };
    let mut machine = moving(true);
    pass(&mut machine, 50);
    machine.event(Event::Key(5));
    let [drawn, expected, first] =
        [shaded(machine), shaded(showing(&after(50.0 / 60.0), true, None)), shaded(showing(&scene(), true, None))];
    let differing = |one: &[u8], other: &[u8]| one.chunks(3).zip(other.chunks(3)).filter(|(a, b)| a != b).count();
    let lit = expected.chunks(3).filter(|pixel| *pixel != &expected[..3]).count();
    assert!(lit > 10_000, "{lit} pixels are lit");
    assert!(differing(&drawn, &expected) < lit / 500, "{} of {lit}", differing(&drawn, &expected));
    assert!(differing(&first, &expected) > lit / 20, "it moved");
}

#[test]
fn a_scene_in_which_nothing_moves_is_sent_as_if_nothing_could() {
    let still = after(0.0);
    let sent = bytes(&still, &drawing(false, None));
    assert!(bytes(&still, &drawing(false, Some(MotionPeriod::Seamless))) == sent);
    assert!(bytes(&scene(), &drawing(false, None)) == sent);
    assert!(bytes(&scene(), &drawing(false, Some(MotionPeriod::Seamless))).len() > sent.len());
}

/// The image of a rendering that was begun.
fn finished(rendering: &Progressive) -> Picture {
    let end = Instant::now() + tests::TIMEOUT;
    while Instant::now() < end {
        for event in rendering.events() {
            if let RenderingEvent::End(ended) = event {
                return ended.expect("it is rendered").rendering.picture;
            }
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("the rendering does not end");
}

#[test]
fn the_host_renders_what_moves_as_it_stands_on_the_machine_and_a_reset_lets_it_begin_anew() {
    let mut machine = tests::Machine::start(PS340, &[]);
    let line = format!("tcp:{}", machine.line).parse().expect("an address");
    let attach = || Session::attach(&line, Timeouts::default()).expect("it is taken in");
    let period = Some(MotionPeriod::Seconds(2.0));
    let begin =
        |scene: &Scene, period| Production::begin(scene, attach(), &drawing(false, period)).expect("it is shown");
    let mut production = begin(&scene(), period);
    machine.operator_command("frames 20");
    machine.operator_command("key 5");
    let seconds = production.motion_seconds().expect("it answers");
    let frame = (seconds * 60.0).round();
    assert!((1.0..120.0).contains(&frame) && (seconds * 60.0 - frame).abs() < 1e-9, "{seconds}");
    let matrix = production.view().expect("it answers");
    let order = RenderOrder { width: 64, height: 64, samples: 2, ..RenderOrder::of(&scene().settings) };
    let display = DisplayTransform::LINEAR;
    let rendered = |seconds: f64| {
        finished(&production.begin_rendering(&matrix, seconds, &order, &display).expect("it begins")).to_srgb8()
    };
    let (there, begun) = (rendered(seconds), rendered(0.0));
    let expected = begin(&after(seconds), None).render(&matrix, &order, &display, &Watch::NOBODY);
    let expected = expected.expect("it is rendered").rendering.picture.to_srgb8();
    assert!(there == expected && begun != expected);
    let mut production = begin(&scene(), period);
    machine.operator_command("key 5");
    production.reset().expect("it answers");
    assert_eq!(production.motion_seconds().expect("it answers"), 0.0);
    machine.operator_command("key 5");
    machine.operator_command("frames 3");
    assert!(production.motion_seconds().expect("it answers") > 0.0);
}

#[test]
fn a_scene_in_place_of_another_has_its_own_motions_or_none() {
    let mut machine = tests::Machine::start(PS340, &[]);
    let line = format!("tcp:{}", machine.line).parse().expect("an address");
    let session = Session::attach(&line, Timeouts::default()).expect("it is taken in");
    let period = Some(MotionPeriod::Seconds(2.0));
    let model = |scene: &Scene| Model::new(scene, &drawing(false, period), None, None).expect("a scene");
    let mut production = Production::show(model(&scene()), session).expect("it is shown");
    assert!(machine.operator_command("panel").contains("key 5: MOTION"));
    production.replace(model(&after(0.0)), true).expect("it is shown");
    assert_eq!(production.motion_seconds().expect("nothing is asked"), 0.0);
    assert!(!machine.operator_command("panel").contains("key 5: MOTION"));
    for name in ["PERIS.MOVE1", "PERIS.MOVE1.R", "PERIS_MOTION", "PERIS_MOTION_R1"] {
        assert!(!machine.reply(&format!("show {name}")).starts_with("ok"), "{name} is left");
    }
    production.replace(model(&scene()), true).expect("it is shown");
    machine.operator_command("frames 5");
    machine.operator_command("key 5");
    let seconds = production.motion_seconds().expect("it answers");
    machine.operator_command("frames 5");
    assert!(seconds > 0.0 && production.motion_seconds().expect("it answers") == seconds, "one press stops it");
}

/// What stands; what jumps; what grows; instances that turn; what comes and goes; all as functions of the time.
const CHANGING: &str = r#"
    box(6, 0.1, 4).translate(0, -1.5, 0).material([0.2, 0.5, 0.2]);
    box(0.4, 0.4, 0.4).rotate("z", 50 * time()).scale(1 + time(), 1, 1).translate(1.5, 2 * abs(sin(PI() * time())), 0.5);
    box(0.5 + time(), 0.3, 0.2).translate(-1, 0.5, 0);
    instances(box(0.3, 0.2, 0.1), [[0, 0.5, 0], #{ at: [0.4, 0, 0.2], turn: 30 }]).rotate("y", 90 * time());
    if time() > 0.2 && time() < 0.6 { box(0.2, 0.2, 0.2).translate(0, 0, 1.5); }
    directional_light(#{ direction: [-1, -2, -1.5], irradiance: 1 });
    camera(#{ from: [2, 3, 12], at: [0, 0, 0], field_of_view: 30, near: 5, far: 25 });
"#;
/// Pictures in a second.
const RATE: u32 = 24;

fn changing(time: f64) -> Scene {
    let inputs = script::Inputs { time, ..script::Inputs::default() };
    script::evaluate(CHANGING, "changing", Path::new(""), &inputs).expect("a scene").scene
}

fn flip_book(pictures: u32) -> FlipBook {
    let scene = |number: u32| changing(f64::from(number) / f64::from(RATE));
    FlipBook::new(scene(0), (1..pictures).map(scene).collect(), RATE)
}

#[test]
fn a_flip_book_shows_each_picture_at_its_time_and_sends_what_stays_once() {
    let book = flip_book(24);
    let prepared = Prepared::new(book.first()).expect("a scene");
    let initial = InitialView::of(&prepared).expect("a camera");
    let shown = structure::pictures(&book, &initial, &prepared.subject(), &drawing(false, None)).expect("it is drawn");
    assert_eq!(shown.motion.map(|motion| (motion.objects, motion.pictures, motion.frames)), Some((4, 24, 60)));
    // A floor, two boxes and two instances once, and another box in 24 sizes.
    assert_eq!(shown.lines, 12 * (1 + 1 + 1 + 2 + 24));
    let mut sent = Vec::new();
    write_commands(&shown.commands, &mut sent).expect("it can be sent");
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    machine.step([Input::Bytes(LINE, sent)], 0);
    let mut passed = 0;
    for frame in [1, 2, 3, 14, 15, 20, 37, 59, 60, 62, 63] {
        pass(&mut machine, frame - passed);
        passed = frame;
        // 24 pictures in 60 frames.
        let number = frame % 60 * RATE / 60;
        let mut still = showing(&changing(f64::from(number) / f64::from(RATE)), false, None);
        pass(&mut still, 1);
        let off = difference(&strokes(&machine), &strokes(&still));
        assert!(off < 1e-6, "frame {frame} shows picture {number} off by {off}");
        assert_eq!(book.scene(f64::from(frame % 60) / 60.0), &changing(f64::from(number) / f64::from(RATE)));
    }
}

#[test]
fn a_flip_book_of_instances_that_become_others_is_refused() {
    let instances = |turn: f64| {
        let text = format!("instances(box(1, 1, 1), [[0, 0, 0], #{{ at: [2, 0, 0], turn: {turn} }}]);");
        script::evaluate(&text, "pair", Path::new(""), &script::Inputs::default()).expect("a scene").scene
    };
    let book = FlipBook::new(instances(0.0), vec![instances(20.0)], RATE);
    let prepared = Prepared::new(book.first()).expect("a scene");
    let initial = InitialView::of(&prepared).expect("a camera");
    let refused = structure::pictures(&book, &initial, &prepared.subject(), &Drawing::default());
    let text = refused.expect_err("they are others").to_string();
    assert!(text.contains("instances are others in other pictures"), "{text}");
}
