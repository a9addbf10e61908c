//! Plants: numbers, growth, seasons, and the species that ship with the program.

use super::parameters::StemNumber;
use super::*;
use crate::numeric::bounds::Bounds;
use crate::procedural::Varied;
use crate::procedural::drawing::PlantDrawing;
use glam::DVec3;
use std::f64::consts::PI;

fn shipped(name: &str) -> Species {
    let row = SPECIES.iter().find(|row| row.name == name).expect("a species");
    Species::parse(row.text).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// An oak of few branches, which grows in less time.
fn sparse_oak() -> Species {
    let mut oak = shipped("oak");
    for name in ["branches_1", "branches_2"] {
        oak.set(name, Varied { mean: 9.0, deviation: 0.0 }).expect("a number");
    }
    oak
}

fn grown_up(species: &Species, seed: u32, detail: f64) -> PlantDrawing {
    species.grow(seed, PlantInstant::default(), detail).expect("a plant")
}

#[test]
fn every_species_is_read_and_grows_within_its_published_measures() {
    for row in SPECIES {
        let species = shipped(row.name);
        let mut measured = [0.0, 0.0];
        const SEEDS: u32 = 4;
        for seed in 0..SEEDS {
            let drawing = grown_up(&species, seed, 0.001);
            let tips = drawing.placed.iter().map(|one| one.placement.transform_point3(DVec3::Y));
            let bounds = Bounds::of(tips.chain([drawing.bounds().min, drawing.bounds().max]));
            let size = bounds.max - bounds.min;
            measured[0] += bounds.max.y / f64::from(SEEDS);
            measured[1] += 0.5 * (size.x + size.z) / bounds.max.y / f64::from(SEEDS);
        }
        for PublishedRange { what, range: [least, most] } in &species.published {
            let found = match what.as_str() {
                "height" => measured[0],
                "crown_ratio" => measured[1],
                _ => {
                    let angle = species.parts[0].tree.numbers.stem(1, StemNumber::DownAngle);
                    assert!(
                        angle.mean - angle.deviation >= *least && angle.mean + angle.deviation <= *most,
                        "{}",
                        row.name
                    );
                    angle.mean
                }
            };
            assert!(found >= *least && found <= *most, "{}: {what} {found} is not within {least} to {most}", row.name);
        }
    }
}

/// A plant of stems alone, of one level, without anything that varies.
fn pole(changes: &[(&str, f64)]) -> PlantDrawing {
    let mut numbers = TreeNumbers::default();
    let given = [("height", 10.0), ("levels", 1.0), ("flare", 0.0), ("ratio", 0.1), ("taper_0", 1.0)];
    for (name, mean) in given.iter().chain(changes) {
        numbers.set(name, &[Varied { mean: *mean, deviation: 0.0 }]).expect("a number");
    }
    let tree = TreeModel { shape: CrownShape::Conical, numbers, organs: Vec::new(), colonisation: None };
    tree.grow(1, PlantInstant::default(), 1e-3).expect("a plant")
}

#[test]
fn a_trunk_has_the_volume_that_its_taper_tells() {
    let volume = |taper: f64| pole(&[("taper_0", taper)]).stroke_mesh(1e-3).expect("a mesh").signed_volume();
    let cylinder = PI * 10.0;
    let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    // A dome of half a ball is at the end of what is not pointed.
    near(volume(0.0), cylinder + 2.0 / 3.0 * PI);
    near(volume(1.0), cylinder / 3.0);
    near(volume(0.5), cylinder * (1.0 + 0.5 + 0.25) / 3.0 + 2.0 / 3.0 * PI / 8.0);
}

#[test]
fn flare_lobes_and_forks_are_those_of_weber_and_penn() {
    let straight = pole(&[]);
    let flared = pole(&[("flare", 2.0)]);
    // 1 + flare (100 - 1) / 100 at the ground, 1 above an eighth of the height.
    assert!((flared.nodes[0].radius / straight.nodes[0].radius - 2.98).abs() < 1e-9);
    let high = |drawing: &PlantDrawing| drawing.nodes.iter().find(|node| node.position.y > 6.0).expect("a node").radius;
    assert!((high(&flared) - high(&straight)).abs() < 1e-9);
    let lobed = pole(&[("lobes", 5.0), ("lobe_depth", 0.2)]).stroke_mesh(1e-3).expect("a mesh");
    let radius = |v: &DVec3| v.x.hypot(v.z);
    let ring: Vec<f64> = lobed.vertices.iter().filter(|v| v.y.abs() < 1e-9).map(radius).collect();
    let [least, most] = ring.iter().fold([f64::MAX, 0.0_f64], |[a, b], r| [a.min(*r), b.max(*r)]);
    assert!((least - 0.8).abs() < 0.01 && (most - 1.2).abs() < 0.01, "{least} {most}");
    // A fork at each of seven ends of segments doubles the stems each time.
    assert_eq!(pole(&[("splits_0", 1.0), ("split_angle_0", 20.0)]).strokes.len(), 1 << 7);
    assert_eq!(pole(&[("base_splits", 2.0)]).strokes.len(), 3);
}

#[test]
fn boughs_are_as_long_as_the_shape_of_the_crown_tells() {
    let boughs = |shape: CrownShape| -> Vec<(f64, f64)> {
        let mut numbers = TreeNumbers::default();
        let given = [("height", 10.0), ("levels", 2.0), ("base", 0.2), ("length_1", 0.3), ("branches_1", 60.0)];
        for (name, mean) in given {
            numbers.set(name, &[Varied { mean, deviation: 0.0 }]).expect("a number");
        }
        let tree = TreeModel { shape, numbers, organs: Vec::new(), colonisation: None };
        let drawing = tree.grow(3, PlantInstant::default(), 1e-4).expect("a plant");
        drawing
            .strokes()
            .skip(1)
            .map(|nodes| {
                let [first, last] = [nodes[0].position, nodes[nodes.len() - 1].position];
                (first.y, first.distance(last))
            })
            .collect()
    };
    for (name, shape) in CROWN_SHAPES {
        let all = boughs(shape);
        assert!(all.len() >= 59, "{name} {}", all.len());
        for (height, length) in all {
            let expected = 3.0 * shape.ratio((10.0 - height) / 8.0);
            assert!((length - expected).abs() < 1e-6, "{name} at {height}: {length} {expected}");
        }
    }
}

#[test]
fn growth_has_no_jumps() {
    let species = sparse_oak();
    const STEP: f64 = 1e-6;
    let at = |age: f64| species.grow(2, PlantInstant { age, season: 0.0 }, 1e-13).expect("a plant");
    let (mut compared, mut fastest) = (0, 0.0_f64);
    for frame in 1..12 {
        let age = f64::from(frame) * 0.083;
        let (before, after) = (at(age), at(age + STEP));
        if before.nodes.len() == after.nodes.len() {
            compared += 1;
            let moved = before.nodes.iter().zip(&after.nodes).map(|(a, b)| a.position.distance(b.position));
            fastest = fastest.max(moved.fold(0.0, f64::max) / STEP);
        } else {
            // What is born has no size yet.
            assert!(after.strokes.len().abs_diff(before.strokes.len()) < 60, "{age}");
        }
    }
    let height = species.bounds(2, 1, PlantInstant::default()).expect("a plant").max.y;
    assert!(compared >= 6 && fastest < 8.0 * height, "{compared} {fastest} {height}");
}

#[test]
fn leaves_come_turn_and_fall_without_jumps() {
    let species = sparse_oak();
    let area = |season: f64| -> f64 {
        let drawing = species.grow(1, PlantInstant { age: 1.0, season }, 0.4).expect("a plant");
        drawing.placed.iter().map(|placed| placed.placement.matrix3.determinant().abs().powf(2.0 / 3.0)).sum()
    };
    let summer = area(0.5);
    assert!(area(0.0) == 0.0 && area(0.25) == 0.0 && summer > 0.0 && area(1.5) == summer);
    let mut before = area(0.0);
    for day in 1..=365 {
        let now = area(f64::from(day) / 365.0);
        assert!((now - before).abs() < 0.12 * summer, "day {day}: {before} {now} of {summer}");
        before = now;
    }
    let organ = &species.parts[0].tree.organs[0];
    let greener = |season: f64| {
        let c = organ.colours.at(season);
        c.y / c.x
    };
    assert!(greener(0.5) > 1.5 && greener(0.84) < 0.8);
}

#[test]
fn coarser_plants_show_as_much() {
    let species = shipped("oak");
    let shown = |detail: f64| {
        let drawing = species.grow(1, PlantInstant::default(), detail).expect("a plant");
        let leaves: f64 = drawing.placed.iter().map(|one| one.placement.matrix3.x_axis.length_squared()).sum();
        (leaves, drawing.placed.len(), drawing.strokes.len())
    };
    let fine = shown(1e-3);
    for detail in [0.1, 0.3, 0.8] {
        let coarse = shown(detail);
        assert!((coarse.0 / fine.0 - 1.0).abs() < 0.05, "{detail}: {coarse:?} {fine:?}");
        assert!(coarse.1 as f64 <= fine.1 as f64 * (0.2 / detail).powi(2).min(1.0) && coarse.2 <= fine.2);
    }
    let bounds = species.bounds(1, 1, PlantInstant::default()).expect("a plant");
    for detail in [1e-3, 0.1, 0.8, 1e9] {
        let mesh = grown_up(&species, 1, detail).mesh(0.25 * detail.min(1.0)).expect("a mesh");
        let own = mesh.bounds().expect("triangles");
        assert!(own.min.cmpge(bounds.min).all() && own.max.cmple(bounds.max).all(), "{detail}: {own:?} {bounds:?}");
    }
}

/// A small species, of which the tests of faults change words.
const SHRUB: &str = r#"name = "a shrub"
[tree]
shape = "spherical"
height = [2, 0.5]
levels = 2
base = 0.14
[[tree.organ]]
name = "leaf"
outline = "ovate"
size = 0.05
colours = [[0.3, [0.1, 0.2, 0.03]], [0.8, [0.3, 0.2, 0.03]]]
"#;

#[test]
fn faults_of_a_species_have_their_line_and_what_may_be_meant() {
    assert!(Species::parse(SHRUB).is_ok());
    for (from, to, words) in [
        ("height = [2, 0.5]", "hight = 2", "line 4, column 1: a tree has no number \"hight\"; did you mean height?"),
        ("base = 0.14", "base = 1.4", "line 6, column 1: base 1.4 to 1.4 is not within 0 to 0.99"),
        ("[2, 0.5]", "[2, -0.5]", "line 4, column 10: height: the deviation is below 0"),
        ("[2, 0.5]", "[2, 0.5, 1]", "line 4, column 10: height must be a number, or a mean with a deviation"),
        ("\"spherical\"", "\"round\"", "line 3, column 9: shape \"round\" is not known; there are conical"),
        ("levels = 2", "levels = ", "line 5"),
        ("\"ovate\"", "\"ovat\"", "line 9, column 11: outline \"ovat\" is not known; did you mean ovate?"),
        ("\"ovate\"", "[[-1, 0.5]]", "line 9, column 11: the corners of an outline are right of its midrib"),
        ("size = 0.05\n", "", "\"size\" is missing"),
        ("size = 0.05", "size = 0.05\nfalls = 0.8", "\"emerges\" is missing"),
        ("0.3, [0.1", "0.9, [0.1", "colours must be in the order of the year"),
        ("name = \"a shrub\"", "", "\"name\" is missing"),
        ("[tree]", "[trees]", "line 2, column 2: key \"trees\" is not known; did you mean tree?"),
        ("base = 0.14", "length = [1, 0.4, 0.4, 0.4, 0.4]", "length has 5 numbers; there are 4 levels of stems"),
    ] {
        let text = SHRUB.replacen(from, to, 1);
        assert_ne!(text, SHRUB);
        let found = Species::parse(&text).expect_err(to).to_string();
        assert!(found.contains(words), "{to}: {found}");
    }
    let mut species = shipped("oak");
    assert!(species.set("down_angle_1", Varied { mean: 50.0, deviation: 5.0 }).is_ok());
    assert!(species.set("down_angle_7", Varied { mean: 50.0, deviation: 5.0 }).is_err());
}

#[test]
fn a_crown_that_is_colonised_is_full_of_branches_as_thick_as_the_pipe_model_tells() {
    let species = shipped("elm");
    let TreeModel { colonisation, .. } = &species.parts[0].tree;
    let exponent = colonisation.expect("a crown to fill").exponent;
    let drawing = species.grow(4, PlantInstant { age: 1.0, season: 0.0 }, 1e-6).expect("a plant");
    assert!(drawing.strokes.len() > 500, "{}", drawing.strokes.len());
    // The trunk, above its flare, bears all tips: each stroke ends in one.
    let trunk: Vec<_> = drawing.strokes().next().expect("a trunk").to_vec();
    let radius = trunk.iter().find(|node| node.position.y > 3.5).expect("a trunk").radius;
    let tip = trunk[trunk.len() - 1].radius;
    let expected = (drawing.strokes.len() as f64).powf(exponent.recip());
    assert!((radius / tip / expected).ln().abs() < 0.5, "{radius} {tip} {expected}");
    let young = species.grow(4, PlantInstant { age: 0.4, season: 0.0 }, 1e-6).expect("a plant");
    assert!(young.bounds().max.y < 0.8 * drawing.bounds().max.y);
}

#[test]
fn a_blade_bends_evenly_from_its_base_to_its_tip() {
    for (outline, width) in [("needle", 0.05), ("linear", 0.1), ("oak", 0.6)] {
        let text = SHRUB.replace("\"ovate\"", &format!("\"{outline}\"\nwidth = {width}\ncurl = 90"));
        let species = Species::parse(&text).expect("a species");
        let mesh = grown_up(&species, 1, 1e-4).surfaces[0].mesh(1e-3).expect("a mesh");
        // Along a quarter of a circle of this radius about a place below the base.
        let radius = 2.0 / PI;
        let on_arc = |v: &DVec3| ((v.y).hypot(v.z + radius) - radius).abs() < 1e-3;
        assert!(mesh.vertices.iter().all(on_arc), "{outline}");
        for corners in &mesh.triangles {
            let corners = corners.map(|corner| mesh.vertices[corner as usize]);
            let middle = corners.iter().sum::<DVec3>() / 3.0;
            let off = (middle.y).hypot(middle.z + radius) - radius;
            assert!(off.abs() < 0.02, "{outline}: {off} in {corners:?}");
        }
    }
}
