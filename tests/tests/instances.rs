//! Scenes with instances on the machine: what is drawn, picked and shaded, and how much detail a dial gives.

use host::{
    production::{Model, Production},
    scene::Scene,
    script,
    workstation::{Drawing, Session, Timeouts},
};
use std::path::Path;
use tests::Machine;

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");

/// Blocks in pairs, turned, mirrored and scaled, from in front.
const INSTANCES: &str = r#"
    image(512, 512);
    let block = box(1, 0.5, 0.7).material([0.8, 0.1, 0.1]);
    let pair = instances(block, [[0, 0, 0], #{ at: [0.2, 1, 0], turn: 20 }]);
    instances(pair, [
        #{ at: [-3, 0, 0], turn: 30 }, #{ at: [0, 0, -2], scale: 1.5 }, #{ at: [3, 0, 1], axis: "x", turn: -50 },
        #{ at: [0, 2, 1], matrix: [[-1, 0, 0], [0, 1.3, 0], [0, 0, 1]] },
    ]).translate(0.1, -0.5, 0);
    directional_light(#{ direction: [-1, -2, -1.5], irradiance: 1 });
    camera(#{ from: [2, 3, 12], at: [0, 0.5, 0], field_of_view: 40, near: 5, far: 25 });
"#;
/// They, one by one.
const COPIES: &str = r#"
    image(512, 512);
    fn pair() {
        let first = box(1, 0.5, 0.7).material([0.8, 0.1, 0.1]);
        [first, first.copy().rotate("y", 20).translate(0.2, 1, 0)]
    }
    for block in pair() { block.rotate("y", 30).translate(-3, 0, 0).translate(0.1, -0.5, 0); }
    for block in pair() { block.scale(1.5).translate(0, 0, -2).translate(0.1, -0.5, 0); }
    for block in pair() { block.rotate("x", -50).translate(3, 0, 1).translate(0.1, -0.5, 0); }
    for block in pair() { block.scale(-1, 1.3, 1).translate(0, 2, 1).translate(0.1, -0.5, 0); }
    directional_light(#{ direction: [-1, -2, -1.5], irradiance: 1 });
    camera(#{ from: [2, 3, 12], at: [0, 0.5, 0], field_of_view: 40, near: 5, far: 25 });
"#;

/// Blocks in rows, as the second object.
const BLOCKS: &str = r#"
    cube(0.1).translate(0, 0, 50);
    let all = [];
    for k in 0..40 { all.push([k % 8 - 3.5, k / 8 - 2, 0]); }
    instances(box(0.5, 0.4, 0.3), all);
    camera(#{ from: [0, 1, 14], at: [0, 0, 0], field_of_view: 40 });
"#;

fn scene(text: &str) -> Scene {
    script::evaluate(text, "instances", Path::new(""), &script::Inputs::default()).expect("a scene").scene
}

fn show(machine: &Machine, text: &str, drawing: &Drawing) -> Production {
    let line = format!("tcp:{}", machine.line).parse().expect("an address");
    let session = Session::attach(&line, Timeouts::default()).expect("it is taken in");
    Production::begin(&scene(text), session, drawing).expect("it is shown")
}

/// The strokes that the machine draws, as numbers, in an order of their own.
fn strokes(machine: &mut Machine) -> Vec<Vec<f64>> {
    machine.operator_command("idle");
    let told = machine.operator_command("strokes 100000").replace("\\n", "\n");
    let stroke = |line: &str| -> Vec<f64> { line.split_whitespace().filter_map(|word| word.parse().ok()).collect() };
    let mut all: Vec<Vec<f64>> = told.lines().map(stroke).filter(|stroke| stroke.len() >= 9).collect();
    for stroke in &mut all {
        // From left to right, whichever way the beam goes.
        if stroke[0] > stroke[2] {
            stroke.swap(0, 2);
            stroke.swap(1, 3);
            stroke.swap(4, 5);
        }
    }
    all.sort_by(|a, b| {
        a[..4].iter().zip(&b[..4]).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
    all
}

#[test]
fn instances_are_drawn_as_copies_of_what_they_place() {
    let mut machine = Machine::start(PS340, &[]);
    let whole = Drawing { most: Some(1_000_000), ..Drawing::default() };
    let mut drawn = Vec::new();
    for text in [COPIES, INSTANCES] {
        let production = show(&machine, text, &whole);
        assert_eq!(production.sent().lines, 8 * 12);
        drawn.push(strokes(&mut machine));
    }
    assert!(drawn[0].len() > 80 && drawn[0].len() == drawn[1].len(), "{} {}", drawn[0].len(), drawn[1].len());
    for (copy, instance) in drawn[0].iter().zip(&drawn[1]) {
        assert!(copy.iter().zip(instance).all(|(a, b)| (a - b).abs() < 1e-5), "{copy:?} {instance:?}");
    }
}

#[test]
fn a_pick_of_an_instance_tells_its_object_and_a_dial_sets_the_detail_of_all() {
    let mut machine = Machine::start(PS340, &[]);
    let mut production = show(&machine, BLOCKS, &Drawing { most: Some(100), ..Drawing::default() });
    let chosen = strokes(&mut machine);
    assert!((40..=100).contains(&chosen.len()), "{}", chosen.len());
    let [x, y] = [0, 1].map(|axis| (chosen[0][axis] + chosen[0][axis + 2]) / 2.0);
    let mut host = machine.attach();
    host.send(format!(
        "SEND TRUE TO <1>PERIS.PICK; PICKED := F:PICK; TOLD := F:PICKINFO; SEND FIX(50) TO <2>TOLD;
         CONNECT PICKED<1>:<1>TOLD; CONNECT TOLD<2>:<1>HOST_MESSAGE; SEND V2D({x},{y}) TO <1>PICKED;"
    ));
    assert_eq!(host.message(), "O2");
    machine.operator_command("dial 8 1");
    assert_eq!(strokes(&mut machine).len(), 40 * 12, "all in full");
    machine.operator_command("dial 8 -2");
    assert_eq!(strokes(&mut machine).len(), 0, "nothing is left");
    production.reset().expect("it answers");
    assert_eq!(strokes(&mut machine).len(), chosen.len());
    assert!(machine.reply("show PERIS_I1").contains("IF LEVEL_OF_DETAIL"));
    let other = Model::new(&scene(COPIES), &Drawing::default(), None, None).expect("a scene");
    production.replace(other, true).expect("it is shown");
    assert_eq!(strokes(&mut machine).len(), 8 * 12);
    assert!(!machine.reply("show PERIS_I1").contains("IF LEVEL_OF_DETAIL"), "nothing of the scene before stays");
}

#[test]
fn the_machine_renders_polygons_of_instances_as_those_of_copies() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut machine = Machine::start(PS340, &[]);
    let mut images = Vec::new();
    for (name, text) in [("copies", COPIES), ("instances", INSTANCES)] {
        show(&machine, text, &Drawing { facets: true, ..Drawing::default() });
        let mut host = machine.attach();
        host.send("ENDED := F:PRINT; CONNECT PERIS.SHADE<1>:<1>ENDED; CONNECT ENDED<1>:<1>HOST_MESSAGE;");
        host.send("SEND FIX(4) TO <1>PERIS.SHADE;");
        assert_eq!(host.message(), "TRUE", "hidden lines are removed");
        let seen = strokes(&mut machine).len();
        host.send("SEND FIX(7) TO <1>PERIS.SHADE;");
        assert_eq!(host.message(), "TRUE", "the polygons are shaded");
        let file = folder.path().join(format!("{name}.png"));
        machine.operator_command(&format!("picture raster {}", file.display()));
        images.push((seen, image::open(file).expect("a picture").to_rgb8()));
    }
    let [(seen, copies), (also_seen, instances)] = &images[..] else { panic!("two") };
    assert!(*seen > 40 && seen.abs_diff(*also_seen) <= 2, "{seen} {also_seen}");
    let lit = copies.pixels().filter(|pixel| pixel.0[0] > 60).count();
    let other = copies.pixels().zip(instances.pixels()).filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 8).count();
    assert!(lit > 10_000 && other < lit / 200, "{other} of {lit} pixels differ");
}
