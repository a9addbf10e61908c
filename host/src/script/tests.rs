//! Facts about scene scripts.

use super::*;
use crate::color::Color;
use crate::illumination::distribution::FacetForm;
use crate::illumination::light::{LightShape, SkyDisc, SkyMap};
use crate::illumination::material::{
    Classic, Distributed, DistributionForm, Finish, MaterialKind, Metal, RefractiveIndex, Transparent,
};
use crate::illumination::{Light, Material};
use crate::scene::Shape;
use crate::solid::Primitive;
use crate::surface::Tolerance;
use glam::DVec3;
use std::f64::consts::PI;
use std::path::Path;

pub(super) fn run(text: &str) -> Evaluated {
    evaluate(text, "test.rhai", Path::new(""), &Inputs::default()).unwrap_or_else(|e| panic!("{e}"))
}

pub(super) fn problem(text: &str) -> (usize, usize, String) {
    match evaluate(text, "test.rhai", Path::new(""), &Inputs::default()) {
        Err(ScriptError::Fault(place)) => (place.line, place.column, place.message),
        other => panic!("{text}: no error with a place, but {other:?}"),
    }
}

#[test]
fn a_script_builds_what_it_says() {
    let made = run("
        let ball = sphere(#{ radius: 2, tolerance: 0.01 });
        ball.material(#{ diffuse: [1, 0.5, 0], mirror: 0.25 }).translate(1, 2, 3).name(\"ball\");
        box(4, 1, 2);
        point_light(#{ at: [0, 5, 0], power: 12.566370614359172 });
        directional_light([0, -1, 0], 3);
        ambient(0.1); background([0, 0, 0.5]); image(32, 16); samples(4); seed(9); reflection_depth(2);
        camera(#{ from: [0, 0, 9] });
        print(\"made \" + 2);
    ");
    let scene = &made.scene;
    assert_eq!(scene.objects.len(), 2);
    assert_eq!(scene.objects[0].name, "ball");
    assert_eq!(scene.objects[0].shape, Shape::from(Primitive::Sphere { radius: 2.0 }));
    assert_eq!(scene.objects[0].transform.transform_point3(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(scene.objects[0].material.clone().unwrap().preview().mirror, DVec3::splat(0.25));
    assert_eq!(scene.objects[1].shape, Shape::from(Primitive::Box { size: DVec3::new(4.0, 1.0, 2.0) }));
    assert_eq!(scene.lights[0], Light::Point { at: DVec3::new(0.0, 5.0, 0.0), intensity: Color::grey(1.0) });
    assert_eq!(scene.settings.image.width, 32);
    assert_eq!(
        (scene.settings.image.samples, scene.settings.image.seed, scene.settings.light.reflection_depth),
        (4, 9, 2)
    );
    assert_eq!(made.printed, ["made 2"]);
}

#[test]
fn lamps_reflect_as_what_they_are_made_of() {
    let made = run("
        let ring = torus(1, 0.2).principled(#{ metallic: 1 }).emits(2);
        sphere_light(#{ center: [0, 5, 0], radiance: 2, material: #{ diffuse: \"red_brick\", mirror: 0.1 } });
        disc_light(#{ center: [0, 5, 0], radiance: 2, material: ring });
        rectangle_light(#{ corner: [0, 1, 0], across: [1, 0, 0], up: [0, 0, 1], power: 3, material: \"gold\" });
        sphere_light(#{ center: [0, 5, 0], radiance: 2 });
    ");
    let words: Vec<Option<&str>> =
        made.scene.lights.iter().map(|light| light.body().map(|(_, material)| material.word())).collect();
    let of_ring = made.scene.objects[0].material.as_ref().expect("it was given one");
    assert_eq!((words[1], words[3]), (Some(of_ring.word()), None));
    let Some((LightShape::Sphere { .. }, of_map)) = made.scene.lights[0].body() else { panic!("{words:?}") };
    assert_eq!(of_map.preview().mirror, DVec3::splat(0.1));
    let Some((LightShape::Rectangle { .. }, Material { body: MaterialKind::Metal(_), .. })) =
        made.scene.lights[2].body()
    else {
        panic!("{words:?}")
    };
    let lamp = |material: &str| format!("sphere_light(#{{ center: [0, 5, 0], radiance: 2, material: {material} }});");
    assert!(problem(&lamp("#{ difuse: 0.5 }")).2.contains("unknown parameter difuse"));
    assert!(problem(&lamp("#{ diffuse: 2 }")).2.contains("diffuse must be"));
    assert!(problem(&lamp("0.5")).2.contains("material must be a map"));
    assert!(problem(&lamp("\"cheese\"")).2.contains("no material is called"));
}

#[test]
fn a_parallel_light_may_come_from_a_disc_in_the_sky_and_that_of_a_sky_through_portals() {
    let made = run("
        directional_light(#{ direction: [0, -2, 0], irradiance: 3, diameter: 60 });
        portal(#{ corner: [1, 0, 0], across: [0, 0, 2], up: [0, 2, 0] });
    ");
    let disc = SkyDisc { towards: DVec3::Y, radius: 30.0f64.to_radians() };
    let map = SkyMap { file: "a disc in the sky".into(), panorama: None, disc: Some(disc) };
    // Of a cap of 30 degrees, a surface that faces it sees a quarter of pi.
    let [Light::Sky { map: Some(seen), radiance, .. }] = &made.scene.lights[..] else { panic!("one disc") };
    assert_eq!(seen, &map);
    assert!((radiance.range()[1] - 3.0 / (0.25 * PI)).abs() < 1e-12, "{radiance:?}");
    let corner = DVec3::X;
    assert_eq!(made.scene.portals, [LightShape::Rectangle { corner, across: DVec3::Z * 2.0, up: DVec3::Y * 2.0 }]);
    assert!(problem("portal(#{ corner: [0, 0, 0], across: [1, 0, 0], up: [2, 0, 0] });").2.contains("no area"));
    assert!(problem("directional_light(#{ direction: [0, 0, 0], diameter: 1 });").2.contains("no length"));
}

#[test]
fn what_moves_stands_where_it_is_in_the_middle_of_the_shutter() {
    let made = run("
        let wheel = torus(1, 0.2).translate(0, 1, 0);
        wheel.moving(#{ by: [4, 0, 0], axis: \"z\", angle: -180, through: [0, 1, 0] });
        wheel.copy().translate(0, 0, 5);
        cube(1);
        shutter(0, 0.5);
    ");
    let scene = &made.scene;
    assert_eq!(scene.settings.geometry.shutter, 0.5);
    assert_eq!(scene.motions.iter().map(|(object, _)| *object).collect::<Vec<_>>(), [0, 1]);
    let placed = scene.objects[0].transform;
    assert!((placed.transform_point3(DVec3::ZERO) - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15);
    let turned = placed.transform_vector3(DVec3::Y);
    assert!((turned - DVec3::new(1.0, 1.0, 0.0).normalize()).length() < 1e-15, "{turned}");
    // At the time 0 it is where it was placed.
    let begun = scene.motions[0].1.at(-0.25).point(placed.transform_point3(DVec3::X));
    assert!((begun - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15, "{begun}");
    for (script, problem) in [
        ("shutter(1, 0);", "closes at 0, before it opens at 1"),
        ("let a = cube(1).moving([1, 0, 0]); a + cube(2);", "box moves"),
        ("cube(1).moving(#{ axis: [0, 0, 0] });", "axis must be"),
        ("cube(1).emits(3).moving([1, 0, 0]);", ""),
    ] {
        let result = evaluate(script, "a", Path::new(""), &Inputs::default());
        let message = result.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(message.contains(problem), "{message}");
    }
}

/// What a script makes at a time, with the shutter of an animation.
fn at_time(text: &str, time: f64, shutter: Option<[f64; 2]>) -> crate::scene::Scene {
    let made = evaluate(text, "timed.rhai", Path::new(""), &Inputs { time, shutter, ..Inputs::default() });
    let made = made.unwrap_or_else(|e| panic!("{e}"));
    assert!(made.is_timed, "{text}");
    made.scene
}

#[test]
fn what_a_script_moves_by_the_time_moves_as_what_moves_by_itself() {
    let by_itself = "sphere(1).moving(#{ by: [3, -1, 0], axis: \"z\", angle: 40, through: [0, 0, 0] });";
    let by_time = "sphere(1).rotate(\"z\", 40 * time()).translate(3 * time(), -time(), 0);";
    for (said, shutter) in [("", Some([0.0, 0.02])), ("shutter(0.25, 0.75);", None), ("shutter(-1, 1);", None)] {
        for time in [0.0, 1.5, -20.0] {
            let [one, other] = [by_itself, by_time].map(|text| at_time(&format!("{text}{said}"), time, shutter));
            let difference = one.objects[0].transform - other.objects[0].transform;
            assert!(difference.abs_diff_eq(glam::DMat4::ZERO, 1e-12), "{said} {time}: {difference}");
            let half = 0.5 * one.settings.geometry.shutter;
            assert_eq!(one.settings.geometry.shutter, other.settings.geometry.shutter);
            for part in [-half, 0.3 * half, half] {
                let [here, there] = [&one, &other].map(|scene| {
                    (scene.motions[0].1.at(part).matrix() * scene.objects[0].transform).transform_point3(DVec3::X)
                });
                assert!((here - there).length() < 1e-11, "{said} {time} {part}: {here} {there}");
            }
        }
    }
}

#[test]
fn a_scene_is_a_function_of_the_time_and_shows_an_instant_without_a_shutter() {
    let text = "print(time()); sphere(1 + time()); cube(1).translate(0, time(), 0); cube(1).emits(time());";
    for time in [0.5, 0.0, 0.5] {
        let scene = at_time(text, time, None);
        assert_eq!((scene.settings.geometry.shutter, scene.motions.len()), (0.0, 0));
        assert_eq!(scene.objects[1].transform.w_axis.y, time);
    }
    // While the shutter is open what grows, and what emits light, stands as it does in the middle.
    let lamp = "cube(1).emits(3).translate(0, time(), 0);";
    let open = at_time(&format!("{text}{lamp}"), 2.0, Some([0.0, 0.5]));
    assert_eq!(open.motions.iter().map(|(object, _)| *object).collect::<Vec<_>>(), [1]);
    assert_eq!([1, 3].map(|object: usize| open.objects[object].transform.w_axis.y), [2.25; 2]);
    // Objects that come and go have no motion that is known.
    let comes = "cube(1).translate(0, time(), 0); if time() > 2.1 { sphere(1); }";
    assert!(at_time(comes, 2.0, Some([0.0, 0.5])).motions.is_empty());
    // What is not asked for takes no further run.
    let still = evaluate("print(1); cube(1);", "a", Path::new(""), &Inputs { time: 3.0, ..Inputs::default() }).unwrap();
    assert!(!still.is_timed && still.printed.len() == 1);
    let printed = evaluate("print(time()); shutter(0, 1);", "a", Path::new(""), &Inputs::default()).unwrap().printed;
    assert_eq!(printed, ["0.5"]);
}

#[test]
fn a_function_of_a_script_becomes_a_distribution_or_an_error_with_its_place() {
    let made = run("
        let m = 0.3;
        let own = user_distribution(|angle| { let t = tan(angle) / m; exp(-t * t) / cos(angle) ** 4 });
        sphere(1).shaped(#{ reflectance: 0.5, distribution: own });
        sphere(1).shaped(0.5, user_distribution(#{ area: |angle| 1 }));
    ");
    for object in &made.scene.objects {
        let Some(Material {
            body: MaterialKind::Shaped(Distributed { form: DistributionForm::Facets(table), .. }),
            ..
        }) = &object.material
        else {
            panic!("it is {:?}", object.material)
        };
        assert!(table.error().greatest < 1e-3 && table.error().mean < 2e-4, "{:?}", table.error());
    }
    for (area, problem, column) in [
        ("|angle| cos(angle) - 0.5", "it is -", 0),
        ("|angle| 0.0 / 0.0", "it is NaN at an angle of 0: it must be finite", 0),
        ("|angle| 1 / angle", "it is inf at an angle of 0", 0),
        ("|angle| 0", "it is 0 at all angles", 0),
        ("|angle| \"wide\"", "no number", 0),
        ("|angle| angle + nothing", "unknown name nothing", 35),
        ("|angle| { loop {} }", "more than 20000000 steps", 0),
        ("|angle, more| 1", "", 0),
        ("3", "must be a function", 0),
    ] {
        let script = format!("\nuser_distribution({area});");
        let error = evaluate(&script, "a", Path::new(""), &Inputs::default()).expect_err(area);
        let ScriptError::Fault(place) = &error else { panic!("{area}: {error}") };
        assert!(place.line == 2 && place.message.contains(problem), "{area}: {error}");
        assert!(column == 0 || place.column == column, "{area}: {error}");
    }
    let own =
        "let own = user_distribution(|angle| 1); cube(1).shaped(#{ reflectance: 1, distribution: own, roughness: 1 });";
    assert!(
        evaluate(own, "a", Path::new(""), &Inputs::default())
            .expect_err("two")
            .to_string()
            .contains("has no roughness")
    );
}

#[test]
fn metal_and_glass_take_the_same_distributions() {
    let made = run("
        let own = user_distribution(|angle| exp(-9 * angle * angle));
        sphere(1).metal(#{ name: \"copper\", distribution: own });
        sphere(1).glass(#{ distribution: own });
        sphere(1).metal(\"copper\", 0.3);
        sphere(1).glass(#{ roughness: 0.3 });
        sphere(1).water(#{ roughness: 0.3, distribution: \"Beckmann, all\" });
        sphere(1).metal(#{ name: \"copper\", roughness: 0.1, along: [1, 0, 0], across: 0.3 });
    ");
    let bodies: Vec<MaterialKind> =
        made.scene.objects.iter().filter_map(|object| Some(object.material.clone()?.body)).collect();
    let [MaterialKind::Metal(metal), MaterialKind::Transparent(glass), rest @ ..] = &bodies[..] else {
        panic!("{bodies:?}")
    };
    assert!(matches!((&metal.finish, &glass.facets), (Finish::Facets(a), FacetForm::Table(b)) if a == b));
    let [MaterialKind::Metal(metal), MaterialKind::Transparent(glass), MaterialKind::Transparent(water), last] = rest
    else {
        panic!("{rest:?}")
    };
    assert!(matches!(&metal.finish, Finish::Rough { name, .. } if FacetForm::Model(name.clone()) == glass.facets));
    assert_eq!(water.facets, FacetForm::Model("Beckmann, all".into()));
    assert!(matches!(last, MaterialKind::Metal(Metal { finish: Finish::Brushed { name, .. }, .. }) if name == "GGX"));
    for (call, problem) in [
        ("glass(#{ roughness: 0.2, distribution: user_distribution(|angle| 1) })", "has no roughness"),
        ("metal(#{ name: \"gold\", roughness: 0.2, distribution: user_distribution(|angle| 1) })", "has no roughness"),
        ("glass(#{ roughness: 0.2, distribution: \"Blinn\" })", "GGX, all"),
        ("metal(#{ name: \"gold\", along: [1, 0, 0], roughness: 0.1, distribution: \"Phong\" })", "GGX"),
    ] {
        let error = evaluate(&format!("cube(1).{call};"), "a", Path::new(""), &Inputs::default()).expect_err(call);
        assert!(error.to_string().contains(problem), "{call}: {error}");
    }
}

#[test]
fn a_material_of_defaults_is_the_default_of_its_kind() {
    let body = |call: &str| run(&format!("cube(1).{call};")).scene.objects[0].material.clone().map(|made| made.body);
    assert_eq!(body("material(#{})"), Some(MaterialKind::Classic(Classic::default())));
    assert_eq!(body("principled(#{})"), Some(MaterialKind::Principled(Box::default())));
    let clear = Transparent::clear(RefractiveIndex::Constant(1.5));
    assert_eq!(body("glass(#{})"), Some(MaterialKind::Transparent(clear)));
}

#[test]
fn transformations_apply_in_the_order_of_their_calls() {
    let made = run("cube(1).translate(1, 0, 0).rotate(\"z\", 90).scale(2);");
    let moved = made.scene.objects[0].transform.transform_point3(DVec3::ZERO);
    assert!((moved - DVec3::new(0.0, 2.0, 0.0)).length() < 1e-15);
}

#[test]
fn every_example_in_the_table_runs() {
    const OF_FILES: [&str; 6] = ["mesh", "luminaire", "picture", "normals", "use_database", "stored_light"];
    let is_there = |example: &str| cfg!(feature = "bunny") || !example.contains("\"bunny\"");
    for function in functions().filter(|f| !OF_FILES.contains(&f.name) && is_there(f.example)) {
        run(&format!("let pot = teapot(); let ball = sphere(1); {}", function.example));
    }
}

#[test]
fn every_solid_has_a_function_of_its_word() {
    for word in Primitive::WORDS {
        assert!(functions().any(|function| function.name == *word), "{word}");
    }
}

#[test]
fn no_name_is_given_to_two_functions() {
    let mut names: Vec<&str> = functions().map(|function| function.name).collect();
    names.sort_unstable();
    assert_eq!(names.windows(2).find(|pair| pair[0] == pair[1]), None);
}

#[test]
fn the_reference_names_every_function_and_parameter() {
    let text = reference();
    for function in functions() {
        assert!(text.contains(&format!("## {}\n", function.name)));
        assert!(function.parameters.iter().all(|p| text.contains(p.name)));
    }
}

#[test]
fn a_syntax_error_has_its_place() {
    let (line, column, message) = problem("sphere(1);\nlet x = ;\n");
    assert_eq!((line, column), (2, 9), "{message}");
}

#[test]
fn a_bad_value_has_its_place_and_names_the_parameter() {
    assert_eq!(
        problem("cube(1);\n   sphere(#{ radius: -1 });"),
        (2, 4, "sphere: radius must be a length above 0, not -1".into())
    );
    assert_eq!(problem("let p = cube(1);\np.material(#{ colour: 1 });").0, 2);
    assert!(problem("cube(1).material(#{ colour: 1 });").2.contains("unknown parameter colour; it takes diffuse,"));
    assert!(problem("point_light(#{ at: [0, 0, 0] });").2.contains("either its intensity or its power"));
    assert!(problem("camera(#{ at: [0, 0, 0] });").2.contains("from is missing"));
    assert!(problem("camera(#{ from: [0, 1, 0] });").2.contains("up"), "up along the view");
    assert!(problem("sphere(1, #{ radius: 2 });").2.contains("given twice"));
    assert!(problem("image(3.5, 2);").2.contains("width must be a whole number"));
    assert!(problem("cube(1).rotate(\"w\", 3);").2.contains("axis must be"));
    assert!(problem("mesh(\"nowhere.ply\");").2.contains("there is no file nowhere.ply"));
}

#[test]
fn a_solid_that_does_not_exist_is_refused_where_it_is_written() {
    assert_eq!(problem("cube(1);\n  torus(1, 2);"), (2, 3, "torus: ring 1 is not greater than the tube 2".into()));
    assert!(problem("prism([[0, 0], [1, 1], [1, 0], [0, 1]]);").2.contains("crosses"));
    assert!(problem("prism(3);").2.contains("contours must be a list of points"));
    assert!(problem("revolution([[0, 0], [1, 0], [-1, 1]]);").2.contains("goes through the axis"));
    let bent = "sweep(#{ contours: [[-2, -2], [2, -2], [0, 2]], path: [[0, 0, 0], [1, 0, 0], [1, 1, 0]] });";
    assert!(problem(bent).2.contains("the path bends with the radius"));
}

#[test]
fn solids_are_split_mirrored_and_combined_by_operators() {
    let made = run("
        let ball = sphere(1).name(\"ball\");
        let cap = ball.split(\"y\", [0, 0.5, 0]);
        let bars = (cube(1) ^ cube(1).translate(0.5, 0, 0)).reflect(\"x\", [2, 0, 0]);
    ");
    let prepared = crate::scene::Prepared::new(&made.scene).expect("solids");
    let [ball, cap, bars] = &prepared.objects[..] else { panic!("three objects") };
    assert_eq!((ball.name.as_str(), ball.bounds.max.y, cap.bounds.min.y), ("ball", 0.5, 0.5));
    assert_eq!((bars.bounds.min.x, bars.bounds.max.x), (3.0, 4.5));
}

#[test]
fn an_unknown_name_is_an_error_with_a_guess() {
    assert!(problem("\n\nsphree(1);").2.contains("did you mean sphere?"));
    assert_eq!(problem("\n\nsphree(1);").0, 3);
    assert_eq!(problem("cube(size);"), (1, 6, "unknown name size".into()));
    assert!(problem("samples(1, 2);").2.contains("use samples(count)"));
}

#[test]
fn an_error_in_a_script_function_is_placed_where_it_happens() {
    let (line, _, message) = problem("fn make(r) {\n    sphere(r)\n}\nmake(0);");
    assert_eq!(line, 2);
    assert!(message.contains("radius must be") && message.contains("make called in line 4"), "{message}");
}

#[test]
fn no_script_runs_forever_or_eats_the_memory() {
    assert!(problem("loop { }").2.contains("steps"));
    assert!(problem("fn f(x) { f(x + 1) } f(0);").2.contains("recursion"));
    assert!(problem("let s = \"x\"; loop { s += s; }").2.contains("too large"));
    assert!(problem("let a = [0]; loop { a += a; }").2.contains("too large"));
    for forbidden in ["sleep(10);", "timestamp();", "eval(\"1\");", "import \"x\" as y;"] {
        assert!(evaluate(forbidden, "t", Path::new(""), &Inputs::default()).is_err(), "{forbidden}");
    }
    let deep = "(".repeat(5000);
    assert!(evaluate(&deep, "t", Path::new(""), &Inputs::default()).is_err());
}

#[test]
fn a_message_shows_the_line_and_points_at_the_column() {
    let error = evaluate("cube(1);\n  cube(0);", "a.rhai", Path::new(""), &Inputs::default()).expect_err("wrong");
    let shown = error.to_string();
    assert!(shown.starts_with("a.rhai:2:3: cube: size must be"), "{shown}");
    assert!(shown.ends_with("2 |   cube(0);\n  |   ^"), "{shown}");
}

#[test]
fn a_script_finds_meshes_beside_itself() {
    let folder = tempfile::tempdir().expect("folder");
    std::fs::write(folder.path().join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let script = folder.path().join("s.rhai");
    std::fs::write(&script, "mesh(\"a.obj\");").expect("written");
    let made = load_file(&script, &Inputs::default()).expect("a scene");
    assert_eq!(made.scene.objects[0].shape, Shape::Mesh { path: folder.path().join("a.obj") });
    assert!(matches!(load("no such file.rhai", &Inputs::default()), Err(ScriptError::Unknown { .. })));
}

#[test]
fn the_embedded_scenes_are_right() {
    for embedded in EMBEDDED {
        let made = load(embedded.name, &Inputs::default()).unwrap_or_else(|e| panic!("{e}"));
        assert!(!made.scene.objects.is_empty() && !made.scene.lights.is_empty());
    }
}

#[test]
fn parameters_take_the_kind_of_their_default() {
    let script = "
        print(parameter(\"count\", 3)); print(parameter(\"width\", 2.5, \"of the door\"));
        print(parameter(\"open\", false)); print(parameter(\"title\", \"none\"));
    ";
    let with = |given: &[&str]| {
        let given: Vec<ParameterAssignment> = given.iter().map(|text| text.parse().expect("a definition")).collect();
        evaluate(script, "door.rhai", Path::new(""), &Inputs { definitions: given, ..Inputs::default() })
    };
    assert_eq!(with(&[]).expect("defaults").printed, ["3", "2.5", "false", "none"]);
    let given = ["count=1", "count=-4", "width=1e3", "open=true", "title=a = b"];
    assert_eq!(with(&given).expect("values").printed, ["-4", "1000.0", "true", "a = b"]);
    let refused = |text: &str| with(&[text]).expect_err("wrong").to_string();
    assert!(refused("count=2.5").contains("door.rhai:2:15: parameter: count must be a whole number, not 2.5"));
    assert!(refused("width=wide").contains("must be a number") && refused("width=inf").contains("must be a number"));
    assert!(refused("open=yes").contains("must be true or false"));
    let unknown = refused("widht=3");
    assert!(unknown.starts_with("-D widht=3: door.rhai has no parameter widht; the script asks for"), "{unknown}");
    assert!(unknown.contains("\n  width=2.5  a number: of the door") && unknown.contains("\n  title=none  a text"));
    assert!(problem("parameter(\"a b\", 1);").2.contains("letters, digits"));
    assert!(problem("parameter(\"a\", [1]);").2.contains("default must be a number, true or false, or a string"));
}

#[test]
fn meetings_are_lines_and_bound_nothing() {
    let made = run("let a = sphere(1); let b = box(4, 1, 4); a.meeting(b).translate(0, 0, 7).name(\"edge\");");
    let edge = &made.scene.objects[2];
    let made = edge.shape.tessellate(Tolerance::new(1e-3, 90.0)).unwrap();
    assert!(made.mesh.triangles.is_empty() && made.lines.starts.len() == 2);
    let off = |p: &DVec3| (p.length() - 1.0).abs().max((p.y.abs() - 0.5).abs());
    assert!(made.lines.points.iter().all(|p| off(p) < 1e-14));
    let (.., message) = problem("let a = sphere(1); let b = sphere(2); a.meeting(b) - a;");
    assert!(message.contains("bounds nothing"), "{message}");
    let (.., message) = problem("half_space(\"y\").meeting(sphere(1));");
    assert!(message.contains("has no end"), "{message}");
}

#[test]
fn rounded_objects_stay_where_they_are_and_lose_their_corners() {
    let made = run("cube(2).translate(5, 0, 0).round_edges(0.2, #{ tolerance: 0.01 }).rotate(\"z\", 90);");
    let object = &made.scene.objects[0];
    let mesh = object.shape.tessellate(Tolerance::new(0.01, 90.0)).unwrap().mesh;
    let bounds = mesh.bounds().unwrap();
    assert!(
        (bounds.center() - DVec3::X * 5.0).length() < 1e-12 && (bounds.size() - DVec3::splat(2.0)).length() < 1e-12
    );
    assert!(mesh.is_closed() && mesh.signed_volume() < 7.95 && mesh.signed_volume() > 7.5);
    // What is measured is on what was made: of what was rounded, alone and in a composite, and of the part of a sphere
    // that is left.
    let error = |text: &str| run(text).scene.chord_error().unwrap();
    for text in
        ["cube(2).round_edges(0.3, #{ tolerance: 0.02 });", "cube(2).round_edges(0.3, #{ tolerance: 0.02 }) - cube(1);"]
    {
        let error = error(text);
        assert!(error > 1e-3 && error < 0.02, "{text} {error}");
    }
    let whole = error("tolerance(0.05); sphere(1);");
    let part = error("tolerance(0.05); sphere(1) * box(9, 9, 9).translate(4.5, 0, 0);");
    assert!(part > 0.01 && (part / whole - 1.0).abs() < 0.02, "{part} {whole}");
    assert_eq!(error("cube(2) - cube(1).translate(1, 1, 1);"), 0.0);
    let wide = run("cube(2).round_edges(0.6);");
    let error = wide.scene.objects[0].shape.tessellate(Tolerance::new(0.01, 90.0)).err().unwrap().to_string();
    assert!(
        error.starts_with("cube cannot be rounded: radius 0.6 is too large") || error.starts_with("box"),
        "{error}"
    );
}

#[test]
fn what_cannot_be_made_is_told_with_its_place() {
    let problem = |text: &str| {
        let scene = run(text).scene;
        crate::scene::Prepared::new(&scene).expect_err("it cannot be made").to_string()
    };
    let rounded =
        "let b = box(2, 1, 1) - cylinder(0.3, 3);\n\n  b.round_edges(0.1)\n    .translate(1, 0, 0);\nsphere(1);";
    assert!(problem(rounded).starts_with("test.rhai:3:5: difference: "), "{}", problem(rounded));
    let far = "sphere(1);\nbox(1, 1, 1).name(\"far\").translate(1e200, 0, 0);";
    assert!(problem(far).starts_with("test.rhai:2:1: far: a vertex is placed at"), "{}", problem(far));
}
