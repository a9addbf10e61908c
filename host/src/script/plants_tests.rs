//! Facts about plants, rocks and crystals in scripts.

use super::tests::{problem, run};
use crate::procedural::plant::SPECIES;
use crate::scene::{Instances, Object, Procedural, Shape};
use crate::surface::Tolerance;

/// The model of the last object.
fn model(script: &str) -> Procedural {
    let objects = run(script).scene.objects;
    let Some(Object { shape: Shape::Instances(instances), .. }) = objects.last() else { panic!("{objects:?}") };
    let Instances { prototypes, .. } = &**instances;
    match &prototypes[0][0].shape {
        Shape::Procedural(model) => model.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_species_grows_by_its_name_at_every_season() {
    for row in SPECIES {
        for season in [0.1, 0.35, 0.6] {
            let made = model(&format!("plant(\"{}\", #{{ season: {season}, age: 0.6 }});", row.name));
            let bounds = made.bounds();
            assert!(bounds.max.y > 0.01 && bounds.max.y < 60.0, "{} {bounds:?}", row.name);
        }
    }
}

#[test]
fn numbers_of_a_plant_are_others_where_they_are_given() {
    let height = |vary: &str| model(&format!("plant(\"birch\", #{{ seed: 3{vary} }});")).bounds().max.y;
    let usual = height("");
    assert!(height(", vary: #{ height: 4, length_1: [0.2, 0] }") < 0.4 * usual);
    assert!(height(", age: 0.0") < 0.01 * usual);
    assert_eq!(height(", season: 7.5"), usual);
}

#[test]
fn kinds_are_different_plants() {
    let made = model("plant(\"birch\", #{ kinds: 3, season: 0 });");
    let volumes: Vec<f64> = (0..3)
        .map(|kind| {
            let script = format!("plant(\"birch\", #{{ seed: {}, season: 0 }});", 1 + kind);
            let alone = run(&script).scene.objects.remove(0).shape.tessellate(Tolerance::new(0.05, 60.0));
            alone.expect("a plant").mesh.signed_volume()
        })
        .collect();
    assert!(volumes.iter().all(|volume| *volume > 0.0) && volumes[0] != volumes[1] && volumes[1] != volumes[2]);
    assert_eq!([made.seed(4), made.seed(5)], [1, 2]);
}

#[test]
fn grammars_grow_by_name_with_their_parameters() {
    let size = |script: &str| model(script).bounds().diagonal();
    let usual = size("lsystem(\"ternary\");");
    assert!((size("lsystem(\"ternary\", #{ unit: 0.01 });") / usual - 0.01).abs() < 1e-9);
    assert!(size("lsystem(\"ternary\", #{ steps: 3 });") < 0.7 * usual);
    assert!(size("lsystem(\"ternary\", #{ vary: #{ lr: 1.05 } });") < usual);
}

#[test]
fn crystals_are_solids_that_booleans_take() {
    let made = run("crystal(\"cube\", #{ width: 2, irregularity: 0 }) - box(1, 9, 1);");
    let mesh = made.scene.objects[0].shape.tessellate(Tolerance::new(0.05, 30.0)).expect("a solid").mesh;
    assert!((mesh.signed_volume() - 6.0).abs() < 1e-9, "{}", mesh.signed_volume());
    let quartz = run("crystal(#{ width: 1, length: 3, irregularity: 0 });");
    let mesh = quartz.scene.objects[0].shape.tessellate(Tolerance::new(0.05, 30.0)).expect("a solid").mesh;
    let bounds = mesh.bounds().expect("triangles");
    assert!((bounds.max.y - 1.5).abs() < 1e-9 && mesh.triangles.len() == 24, "{bounds:?} {}", mesh.triangles.len());
}

#[test]
fn wrong_plants_have_their_place_and_advice() {
    for (script, words) in [
        ("plant(\"oack\");", "no species is called \"oack\"; did you mean oak?"),
        ("plant(\"none.toml\");", "none.toml"),
        ("plant(\"oak\", #{ vary: #{ hight: 3 } });", "did you mean height?"),
        ("plant(\"oak\", #{ vary: #{ base: [0.9, 0.3] } });", "is not within 0 to 0.99"),
        ("plant(\"oak\", #{ age: 2 });", "age must be a number from 0 to 1"),
        ("lsystem(\"hilbrt\");", "did you mean hilbert?"),
        ("lsystem(\"ternary\", #{ vary: #{ x: 3 } });", "has no parameter `x`"),
        ("lsystem(\"ternary\", #{ steps: 40 });", "ternary: step"),
        ("rock(#{ wear: [0.9, 0.3] });", "wear 0.6"),
        ("crystal(\"ruby\");", "habit must be"),
        (
            "procedural(|p| { plant(\"oak\"); }, #{ bounds: [[0, 0, 0], [1, 1, 1]] });",
            "within the function of another model",
        ),
    ] {
        let (line, _, text) = problem(script);
        assert!(text.contains(words) && line == 1, "{script}: {text}");
    }
}
