//! Facts about terrain in scripts.

use super::tests::{problem, run};
use crate::procedural::terrain::FractalKind;
use crate::scene::{GroundKind, Shape, Terrain};
use crate::surface::Tolerance;

fn terrain(script: &str) -> Terrain {
    match &run(script).scene.objects.last().expect("an object").shape {
        Shape::Terrain(terrain) => (**terrain).clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_not_said_follows_from_the_size() {
    let usual = terrain("terrain();");
    assert_eq!(
        (usual.fractal.kind, usual.fractal.size, usual.base),
        (GroundKind::Noise(FractalKind::Fbm), [100.0; 2], None)
    );
    let asked = terrain("terrain(\"ridged\", #{ size: [30, 60], octaves: 5, seed: 7, base: -40 });");
    assert_eq!(
        (asked.fractal.kind, asked.fractal.size, asked.base),
        (GroundKind::Noise(FractalKind::Ridged), [30.0, 60.0], Some(-40.0))
    );
    let numbers = asked.fractal.parameters;
    assert_eq!([numbers.scale, numbers.height, numbers.octaves, numbers.seed], [20.0, 5.0, 5.0, 7.0]);
}

#[test]
fn ground_with_a_base_is_a_solid_for_booleans() {
    let made = run("terrain(#{ size: 8, octaves: 4, base: -4 }) - box(2, 20, 2).translate(0, -10, 0);");
    let mesh = made.scene.objects[0].shape.tessellate(Tolerance::new(0.05, 30.0)).expect("a solid").mesh;
    let volume = mesh.signed_volume();
    assert!((200.0..300.0).contains(&volume), "60 square units, about 4 high: {volume}");
}

#[test]
fn wrong_numbers_have_their_place() {
    for (script, words) in [
        ("terrain(\"alps\");", "kind must be"),
        ("terrain(#{ size: [3, -1] });", "size must be a length above 0, or two [x, z]"),
        ("terrain(#{ octaves: 40 });", "octaves must be a number from 1 to 32"),
        ("terrain(#{ octaves: 32, lacunarity: 8 });", "octave"),
        ("terrain(\"midpoint\", #{ hurst: 2 });", "hurst is 2"),
    ] {
        let (line, column, text) = problem(script);
        assert!(text.contains(words) && (line, column) == (1, 1), "{script}: {line}:{column} {text}");
    }
}

#[test]
fn terrain_is_eroded_once() {
    let eroded = terrain("terrain(#{ size: 20, octaves: 6 }).erode(#{ cells: 32, river_steps: 2, water_steps: 5 });");
    let erosion = eroded.erosion.expect("eroded");
    assert_eq!(
        [erosion.settings.river_steps, erosion.settings.water_steps, f64::from(erosion.cells)],
        [2.0, 5.0, 32.0]
    );
    for (script, words) in [
        ("let a = terrain(#{ octaves: 3 }).erode(#{ cells: 16 }); a.erode();", "terrain is eroded"),
        ("let a = box(1, 1, 1); a.erode();", "box is no terrain"),
        ("let a = terrain(); a.erode(#{ rain: -1 });", "rain must be"),
    ] {
        let (_, _, text) = problem(script);
        assert!(text.contains(words), "{script}: {text}");
    }
}
