//! Rocks are closed, as large as asked for, and rounder when they are worn; crystals have the angles of their minerals.

use super::*;
use crate::procedural::Varied;
use std::collections::HashSet;
use std::f64::consts::PI;

fn varied(mean: f64) -> Varied {
    Varied { mean, deviation: 0.0 }
}

fn numbers(wear: f64, roughness: f64) -> RockNumbers {
    let size = [2.0, 1.0, 1.5].map(varied);
    RockNumbers { size, planes: varied(16.0), wear: varied(wear), roughness: varied(roughness), grain: varied(0.3) }
}

#[test]
fn rocks_are_closed_and_as_large_as_asked_for() {
    for seed in 0..6 {
        for (wear, roughness) in [(0.0, 0.0), (0.4, 0.05), (1.0, 0.3)] {
            let rock = Rock::new(&numbers(wear, roughness), seed).expect("a rock");
            for detail in [0.4, 0.05] {
                let mesh = rock.mesh(detail).expect("a mesh");
                let sides = mesh.triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
                let sides: HashSet<[u32; 2]> = sides.collect();
                assert_eq!(sides.len(), 3 * mesh.triangles.len());
                assert!(sides.iter().all(|[a, b]| sides.contains(&[*b, *a])), "{seed} {wear} {detail}");
                assert!(mesh.signed_volume() > 0.0);
                let bounds = mesh.bounds().expect("triangles");
                assert!(bounds.max.cmple(rock.half_box()).all() && bounds.min.cmpge(-rock.half_box()).all());
                if roughness == 0.0 && detail < 0.1 {
                    let size = bounds.max - bounds.min;
                    assert!((size - glam::DVec3::new(2.0, 1.0, 1.5)).abs().max_element() < 0.05, "{size}");
                }
            }
        }
    }
}

#[test]
fn wear_rounds_a_rock_and_bumps_make_it_rough() {
    let measure = |wear: f64, roughness: f64| {
        let equal = RockNumbers { size: [1.0; 3].map(varied), ..numbers(wear, roughness) };
        let mesh = Rock::new(&equal, 5).expect("a rock").mesh(0.02).expect("a mesh");
        let area: f64 = mesh
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
                0.5 * (b - a).cross(c - a).length()
            })
            .sum();
        // 1 for a ball.
        PI.cbrt() * (6.0 * mesh.signed_volume()).powf(2.0 / 3.0) / area
    };
    let [sharp, worn, round] = [0.0, 0.5, 1.0].map(|wear| measure(wear, 0.0));
    assert!(sharp < worn && worn < round && round > 0.97 && sharp > 0.8, "{sharp} {worn} {round}");
    assert!(measure(0.5, 0.1) < worn - 0.01);
}

#[test]
fn numbers_out_of_range_are_named() {
    let wrong = RockNumbers { wear: Varied { mean: 0.9, deviation: 0.2 }, ..numbers(0.0, 0.0) };
    assert_eq!(Rock::new(&wrong, 1).expect_err("wrong").to_string(), "wear 0.7 to 1.1 is not within 0 to 1");
}

#[test]
fn faces_of_crystals_meet_at_the_angles_of_their_minerals() {
    let between = |habit, expected: f64| {
        let planes = crystal_planes(habit, 2.0, 0.2, 3);
        let angle = |a: glam::DVec3, b: glam::DVec3| a.dot(b).clamp(-1.0, 1.0).acos().to_degrees();
        let first = planes[0].0;
        let found = planes.iter().map(|(normal, _)| angle(first, *normal)).find(|found| (found - expected).abs() < 0.3);
        assert!(found.is_some(), "{habit:?}");
        assert!(planes.iter().all(|(normal, distance)| (normal.length() - 1.0).abs() < 1e-12 && *distance > 0.0));
    };
    between(CrystalHabit::Quartz, 60.0);
    // Prism and rhombohedron of quartz.
    between(CrystalHabit::Quartz, 38.2);
    between(CrystalHabit::Octahedron, 70.53);
    between(CrystalHabit::Cube, 90.0);
    between(CrystalHabit::Garnet, 60.0);
    between(CrystalHabit::Rhombohedron, 75.0);
}
