//! Facts about procedural models that scripts make.

use super::calling;
use super::model::{ModelParameter, ModelParameterValue, ScriptModel};
use super::plain::PlainValue;
use super::source::ScriptSource;
use super::tests::{problem, run};
use super::*;
use crate::database::{Record, RecordContent, Store};
use crate::illumination::Paint;
use crate::illumination::material::{Classic, MaterialKind};
use crate::numeric::bounds::Bounds;
use crate::procedural::Varied;
use crate::scene::{Object, ProceduralModel, ScriptPosition, Shape};
use crate::surface::Tolerance;
use glam::DVec3;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// A model of the function `made` of a script.
fn model(text: &str) -> ScriptModel {
    let source = ScriptSource {
        text: text.into(),
        name: "stones.rhai".into(),
        folder: "".into(),
        inputs: Inputs::default(),
        call: calling::call,
    };
    let drawn = |name: &str, mean: f64, deviation: f64| ModelParameter {
        name: name.into(),
        value: ModelParameterValue::Drawn(Varied { mean, deviation }),
    };
    ScriptModel {
        source: Arc::new(source),
        at: Some(ScriptPosition { line: 1, column: 1 }),
        now: 0.0,
        databases: Default::default(),
        function: "made".into(),
        captured: Vec::new(),
        parameters: vec![drawn("size", 0.7, 0.2), drawn("lean", 0.7, 0.2)],
        bounds: Bounds { min: -DVec3::ONE, max: DVec3::ONE },
        kinds: 1000,
        first_operations: MAX_OPERATIONS,
        first: OnceLock::new(),
    }
}

/// The names of what a model makes, where each is a list of numbers.
fn numbers(objects: &[Object]) -> Vec<f64> {
    objects.iter().flat_map(|object| object.name.split(' ')).map(|text| text.parse().expect(text)).collect()
}

/// A call of `procedural` with the box that tests have.
fn procedural(function: &str, more: &str) -> String {
    format!("procedural({function}, #{{ bounds: [[-1, -1, -1], [1, 1, 1]]{more} }});")
}

/// The extent along x of an object of a script, tessellated; or what is wrong.
fn width(shape: &Shape) -> Result<f64, String> {
    let made = shape.tessellate(Tolerance::new(0.01, 60.0)).map_err(|error| error.to_string())?;
    Ok(made.mesh.bounds().expect("triangles").size().x)
}

const STONE: &str = "
    fn chip(size) { cube(size).rotate(\"y\", 20 * size) }
    fn made(p) {
        let stone = sphere(p.size) - chip(p.lean).translate(p.size, 0, 0);
        if p.detail < 0.05 {
            scatter(sphere(0.02), stone, #{ count: 5, seed: p.seed });
        }
    }
";

#[test]
fn the_same_seed_makes_the_same_on_every_thread() {
    let stone = model(STONE);
    let all = || -> Vec<Vec<Object>> { (0..20).map(|seed| stone.make(seed, 0.01).expect("a stone")).collect() };
    let here = all();
    assert!(here.iter().all(|made| made.len() == 2));
    assert!(here.windows(2).all(|pair| pair[0] != pair[1]));
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..3).map(|_| scope.spawn(all)).collect();
        threads.into_iter().for_each(|thread| assert!(thread.join().expect("made") == here));
    });
    assert_eq!(stone.make(3, 0.1).expect("a coarse stone")[..], here[3][..1]);
}

#[test]
fn functions_without_a_name_are_found_again_on_another_thread() {
    let text = "
        let one = 0.5; let other = #{ width: [1.5, 2] };
        for i in 0..2 {
            procedural(|p| { box(one + p.seed, 0.2, 0.2); }, #{ bounds: [[-2, -2, -2], [2, 2, 2]], kinds: 2 });
            procedural(|p| { box(other.width[i], 0.2, 0.2); }, #{ bounds: [[-2, -2, -2], [2, 2, 2]] });
        }
    ";
    let made = run(text);
    let widths = || -> Vec<f64> { made.scene.objects.iter().map(|object| width(&object.shape).expect("it")).collect() };
    assert_eq!(widths(), [0.5, 1.5, 0.5, 2.0]);
    let there = std::thread::scope(|scope| scope.spawn(widths).join().expect("widths"));
    assert_eq!(there, widths());
}

#[test]
fn what_varies_stays_within_its_range_and_two_names_are_unrelated() {
    let made = model("fn made(p) { cube(1).name(`${p.size} ${p.lean} ${p.seed} ${p.detail}`); }");
    let drawn: Vec<Vec<f64>> = (0..1000).map(|seed| numbers(&made.make(seed, 0.25).expect("it"))).collect();
    let [mut least, mut most] = [f64::INFINITY, f64::NEG_INFINITY];
    for (seed, kind) in drawn.iter().enumerate() {
        assert_eq!(kind[2..], [seed as f64, 0.25]);
        assert_ne!(kind[0], kind[1]);
        (least, most) = (least.min(kind[0]), most.max(kind[0]));
    }
    assert!((0.5..0.51).contains(&least) && (0.89..=0.9).contains(&most), "{least} {most}");
    let alike = run(&procedural(
        "|p| { if type_of(p.count) == \"i64\" { cube(p.size * p.count); } }",
        ", vary: #{ size: 0.25, count: 2 }",
    ));
    assert_eq!(width(&alike.scene.objects[0].shape), Ok(0.5));
}

#[test]
fn a_model_is_an_object_that_is_painted_moved_and_placed() {
    let made = run(&format!(
        "fn stone(p) {{ sphere(p.size).scale(1, 0.5, 1); }}
         let one = {call} one.material(#{{ diffuse: 0.2 }}).translate(0, 3, 0).name(\"first\");
         let two = {call} scatter(two, ground(100), #{{ count: 30, scale: [0.5, 2] }});
         let three = {call} instances([[cube(1), three]], [[0, 0, 0], [2, 0, 0]]);",
        call = procedural("Fn(\"stone\")", ", kinds: 400, vary: #{ size: [0.7, 0.2] }")
    ));
    let names: Vec<&str> = made.scene.objects.iter().map(|object| &*object.name).collect();
    assert_eq!(names, ["first", "ground", "instances", "instances 2"]);
    let [first, _, scattered, listed] = &made.scene.objects[..] else { panic!("{names:?}") };
    assert!([first, scattered, listed].iter().all(|object| object.has_models()));
    assert_eq!(first.transform.w_axis.y, 3.0);
    assert!(first.own_material().is_some());
    assert_eq!(made.scene.origins.of["first"].line, 2);
    // What instances place are others of its kinds.
    let pair = run(&format!(
        "let m = {} instances(m, [#{{ variation: 0.3 }}, #{{ at: [9, 0, 0], variation: 0.7 }}]);",
        procedural("|p| { cube(p.size); }", ", vary: #{ size: [0.7, 0.2] }")
    ));
    let mesh = pair.scene.objects[0].shape.tessellate(Tolerance::new(0.1, 60.0)).expect("both").mesh;
    let reaches = |from: f64| mesh.vertices.iter().map(|v| (v.x - from).abs()).filter(|x| *x < 2.0).fold(0.0, f64::max);
    assert!((reaches(0.0) - reaches(9.0)).abs() > 1e-6);
}

#[test]
fn errors_have_their_place_and_tell_the_kind() {
    let faulty = model("fn made(p) {\n    cube(1);\n    if p.seed == 17 {\n        cone(-p.size, 1);\n    }\n}");
    assert!(faulty.make(0, 0.0123456).is_ok());
    let error = faulty.make(17, 0.0123456).expect_err("a cone");
    assert!(error.starts_with("stones.rhai:4:9: in the model of seed 17 at detail 0.0123: cone: "), "{error}");
    assert!(error.contains("\n4 |         cone(-p.size, 1);\n"), "{error}");
    // The first of its kinds is made where the model is.
    let (line, column, message) = problem(&format!("fn f(p) {{\n  cone(0, 1);\n}}\n{}", procedural("Fn(\"f\")", "")));
    assert_eq!((line, column), (2, 3));
    assert!(message.starts_with("procedural: in the model of seed 0 at detail 0.00677: cone: "), "{message}");
    for (body, expected) in [
        ("half_space(\"y\");", (2, 1, "half_space has no end")),
        ("let a = sphere(1); let b = cube(1);\na.meeting(b);", (3, 3, "curve is a curve")),
        ("cube(1).emits(3);", (2, 1, "box emits light")),
        ("cube(1).scale(1e-200);", (2, 1, "box: its transformation is singular")),
        ("nothing + 1;", (2, 1, "unknown name nothing")),
        ("cube(global::SIZE);", (2, 6, "unknown name global::SIZE; the function of a model knows its parameter")),
        ("let a = cube(1);\na.instances([[0, 0]]);", (3, 3, "places must be")),
    ] {
        let (line, column, message) = problem(&procedural(&format!("|p| {{\n{body} }}"), ""));
        assert!(message.contains(expected.2), "{message}");
        assert_eq!((line, column), (expected.0, expected.1), "{message}");
    }
}

#[test]
fn what_is_no_model_is_refused_in_words() {
    let cube = "|p| { cube(1); }";
    for (text, expected) in [
        ("procedural(|p| { cube(1); });".into(), "bounds is missing"),
        ("procedural(3, #{ bounds: [[0, 0, 0], [1, 1, 1]] });".into(), "function must be a function of one parameter"),
        ("procedural(|p| { cube(1); }, #{ bounds: [[0, 0, 0], [1, -1, 1]] });".into(), "bounds must be two corners"),
        (procedural("|p| 3", ""), "it makes nothing"),
        (procedural("Fn(\"nothing\")", ""), "the script has no function nothing"),
        (procedural("Fn(\"sphere\")", ""), "the script has no function sphere"),
        (procedural("|p, q| cube(1)", ""), "the function takes 2 parameters, not one"),
        (procedural("|| cube(1)", ""), "the function takes 0 parameters, not one"),
        (procedural(cube, ", kinds: 0"), "kinds must be a whole number from 1 to 65536"),
        (procedural(cube, ", sorts: 3"), "unknown parameter sorts; it takes function, bounds, kinds, vary"),
        (procedural(cube, ", vary: 3"), "vary must be a map"),
        (procedural(cube, ", vary: #{ size: [1, -0.5] }"), "size of vary must be a number, or two [mean, deviation]"),
        (procedural(cube, ", vary: #{ size: \"wide\" }"), "size of vary must be a number"),
        (procedural(cube, ", vary: #{ size: 1e308 * 10 }"), "size of vary must be a number"),
        (procedural(cube, ", vary: #{ size: [1, 2, 3] }"), "size of vary must be a number"),
        (procedural(cube, ", vary: #{ seed: 1 }"), "seed of vary is what each model has already"),
        (procedural(cube, ", vary: #{ detail: 1 }"), "detail of vary is what each model has already"),
        (
            format!("let ball = sphere(1); {}", procedural("|p| { ball.copy(); }", "")),
            "the function captures an object",
        ),
        (format!("let f = |x| 3; {}", procedural("|p| { cube(f.call(1)); }", "")), "the function captures a function"),
        (format!("let f = [1, ()]; {}", procedural("|p| { cube(f[0]); }", "")), "the function captures ()"),
        (
            format!("fn f(p) {{ {} }} {}", procedural(cube, ""), procedural("Fn(\"f\")", "")),
            "within the function of another",
        ),
    ] {
        let message = problem(&text).2;
        assert!(message.contains(expected), "{text}: {message}");
    }
}

#[test]
fn a_model_makes_objects_only() {
    for body in [
        "point_light(#{ at: [0, 5, 0], power: 1 });",
        "camera(#{ from: [0, 1, 9] });",
        "samples(9);",
        "ambient(0.1);",
        "background(0.1);",
        "studio();",
        "exposure(2);",
        "wind(3);",
        "shutter(0, 0.5);",
        "sky(#{ radiance: 1 });",
        "tolerance(0.1);",
    ] {
        let (line, column, message) = problem(&procedural(&format!("|p| {{ cube(1);\n  {body} }}"), ""));
        assert!(message.contains("a model makes objects only"), "{body}: {message}");
        assert_eq!((line, column), (2, 3), "{body}");
    }
    let moves = problem(&procedural("|p| { cube(1).moving([1, 0, 0]); }", "")).2;
    assert!(moves.contains("what a model makes stands still"), "{moves}");
    let blows = problem(&format!("wind(3); {}", procedural("|p| { wind_at(0, 0, 0); }", ""))).2;
    assert!(blows.contains("within a model there is no wind"), "{blows}");
}

#[test]
fn no_model_runs_forever() {
    let text =
        "fn deep(n) { deep(n + 1) } fn made(p) { cube(1); if p.seed == 1 { loop {} } if p.seed == 2 { deep(0); } }";
    let endless = model(text);
    assert!(endless.make(0, 0.1).is_ok());
    assert!(endless.make(1, 0.1).expect_err("no end").contains("more than 20000000 steps; does it end?"));
    assert!(endless.make(2, 0.1).expect_err("no end").contains("does the recursion end?"));
    assert!(endless.make(3, 0.1).is_ok());
    // Nor does it take the stack of a small thread, however deep its expressions are.
    for (begin, end) in [("1 + (", ")"), ("switch n { -1 => 0, _ => ", "}"), ("abs(", ")")] {
        let nested = format!("{}deep(n + 1){}", begin.repeat(15), end.repeat(15));
        let deep = model(&format!("fn deep(n) {{ {nested} }} fn made(p) {{ deep(0); }}"));
        let error = std::thread::scope(|scope| {
            let small = std::thread::Builder::new().stack_size(2 << 20);
            small.spawn_scoped(scope, || deep.make(0, 0.1).expect_err("no end")).expect("a thread").join().expect("it")
        });
        assert!(error.starts_with("stones.rhai:1:1: in") && error.contains("does the recursion end?"), "{error}");
    }
    // All models together take no more steps when the script runs.
    let many = format!("for i in 0..1000 {{ {} }}", procedural("|p| { cube(1); for j in 0..1000000 { j + 1 } }", ""));
    assert!(problem(&many).2.contains("more than 20000000 steps"), "{}", problem(&many).2);
}

#[test]
fn models_of_one_script_and_of_many_do_not_disturb_each_other() {
    let made = run("
        for w in [0.5, 0.75, 1.0] {
            procedural(|p| { box(w, 0.1, 0.1); }, #{ bounds: [[-1, -1, -1], [1, 1, 1]] });
        }
        fn f(p) { box(p.wide, 0.1, 0.1); }
        procedural(Fn(\"f\"), #{ bounds: [[-1, -1, -1], [1, 1, 1]], vary: #{ wide: 0.25 } });
    ");
    let others: Vec<Evaluated> =
        (1..8).map(|n| run(&procedural(&format!("|p| {{ box({n} / 8.0, 0.1, 0.1); }}"), ""))).collect();
    for _ in 0..3 {
        let widths: Vec<f64> = made.scene.objects.iter().map(|object| width(&object.shape).expect("it")).collect();
        assert_eq!(widths, [0.5, 0.75, 1.0, 0.25]);
        for (other, n) in others.iter().zip(1..) {
            assert_eq!(width(&other.scene.objects[0].shape), Ok(f64::from(n) / 8.0));
        }
    }
}

#[test]
fn a_model_asks_for_the_time_and_for_parameters_as_its_script_does() {
    let text = procedural("|p| { box(parameter(\"wide\", 0.25) + time(), 0.1, 0.1); }", "");
    let inputs = |time: f64, wide: &str| Inputs {
        time,
        definitions: vec![format!("wide={wide}").parse().expect("a definition")],
        ..Inputs::default()
    };
    let at = |text: &str, time: f64, wide: &str| evaluate(text, "a", Path::new(""), &inputs(time, wide));
    let [one, same, late, narrow] = [(0.25, "0.5"), (0.25, "0.5"), (0.5, "0.5"), (0.25, "0.125")]
        .map(|(time, wide)| at(&text, time, wide).expect("it"));
    assert!(one.is_timed);
    let shape = |made: &Evaluated| made.scene.objects[0].shape.clone();
    assert_eq!([&one, &late, &narrow].map(|made| width(&shape(made))), [Ok(0.75), Ok(1.0), Ok(0.375)]);
    assert!(shape(&one) == shape(&same) && shape(&one) != shape(&late) && shape(&one) != shape(&narrow));
    let unknown = at("cube(1);", 0.0, "1").expect_err("no parameter").to_string();
    assert!(unknown.contains("has no parameter wide"), "{unknown}");
    // What does not ask is the same at all times.
    let still = format!("parameter(\"wide\", 1.0); {}", procedural("|p| { cube(1); }", ""));
    let [one, late] = [0.0, 3.0].map(|time| at(&still, time, "1").expect("it"));
    assert!(!one.is_timed && shape(&one) == shape(&late));
    let some = model("fn made(p) { cube(1);\n  if p.seed == 1 { time(); } }");
    assert!(some.make(0, 0.1).is_ok());
    let error = some.make(1, 0.1).expect_err("the time");
    assert!(error.starts_with("stones.rhai:2:20: in the model of seed 1 at detail 0.1: time: a model asks"), "{error}");
}

#[test]
fn all_that_decides_what_is_made_is_in_the_definition() {
    let definition = |change: fn(&mut ScriptModel)| {
        let mut made = model(STONE);
        change(&mut made);
        made.definition()
    };
    let source = |change: fn(&mut ScriptSource)| {
        let mut made = model(STONE);
        change(Arc::get_mut(&mut made.source).expect("one"));
        made.definition()
    };
    let all = [
        definition(|_| {}),
        definition(|made| made.function = "chip".into()),
        definition(|made| made.captured = vec![PlainValue::Number(0.5)]),
        definition(|made| made.now = 1.0),
        definition(|made| made.bounds.max.x = 2.0),
        definition(|made| made.kinds = 3),
        definition(|made| made.parameters.truncate(1)),
        definition(|made| made.parameters[0].name = "other".into()),
        source(|source| source.text.push(' ')),
        source(|source| source.folder = "elsewhere".into()),
        source(|source| source.inputs.definitions = vec!["a=1".parse().expect("a definition")]),
    ];
    for (place, one) in all.iter().enumerate() {
        assert!(all[..place].iter().all(|other| other != one), "{place}");
    }
    assert_eq!(all[0], model(STONE).definition());
}

#[test]
fn a_model_finds_the_databases_that_were_open_and_opens_none() {
    let folder = tempfile::tempdir().expect("a folder");
    for (file, mirror) in [("one.redb", 0.25), ("two.redb", 0.5)] {
        let classic = Classic { mirror: Paint::grey(mirror), ..Classic::default() };
        let content = RecordContent::Material(Box::new(MaterialKind::Classic(classic).into()));
        let record = Record { name: "own".into(), origin: Default::default(), content };
        let store = Store::open_to_write(folder.path().join(file)).expect("a new database");
        store.add(&[record], false).expect("added");
    }
    let made = |text: &str| evaluate(text, "a", folder.path(), &Inputs::default());
    let own = procedural("|p| { cube(1).stored(\"own\"); }", "");
    let both = made(&format!("use_database(\"one.redb\"); {own} use_database(\"two.redb\"); {own}")).expect("both");
    let mirrors: Vec<f64> =
        both.scene.objects.iter().map(|object| object.materials(&[]).0[0].preview().mirror.x).collect();
    assert_eq!(mirrors, [0.25, 0.5]);
    assert!(both.files.iter().all(|file| file.starts_with(folder.path())));
    let error = made(&own).expect_err("no database").to_string();
    assert!(error.contains("in the model of seed 0") && error.contains("own"), "{error}");
    let inside = procedural("|p| { use_database(\"one.redb\"); cube(1); }", "");
    assert!(made(&inside).expect_err("inside").to_string().contains("a model makes objects only"));
}
