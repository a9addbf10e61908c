//! Facts about tiles.

use super::*;
use crate::color::Color;
use crate::illumination::light::LightShape;
use crate::illumination::material::Classic;
use crate::illumination::{Material, Paint};
use crate::render::Watch;
use crate::render::World;
use crate::render::indirect::{IndirectLight, IrradiancePart};
use crate::scene::{Interreflection, RadiositySettings};
use crate::scene::{Object, Scene, Shape};
use crate::solid::Primitive;
use glam::DMat4;
use std::collections::{HashMap, HashSet};
use std::f64::consts::FRAC_1_PI;

fn matt(red: f64, green: f64, blue: f64) -> Material {
    Classic { diffuse: Color::Bands(DVec3::new(red, green, blue)).into(), ..Classic::default() }.into()
}

fn solid(primitive: Primitive, at: DVec3, material: Material) -> Object {
    let (shape, transform) = (Shape::from(primitive), DMat4::from_translation(at));
    Object { name: "solid".into(), shape, transform, material: Some(material), tolerance: Some(0.05) }
}

/// A red floor, a white block on it, and a lamp above them.
fn room() -> Prepared {
    let floor = Primitive::Box { size: DVec3::new(4.0, 0.5, 4.0) };
    let block = Primitive::Box { size: DVec3::new(1.0, 1.0, 1.0) };
    let patch = LightShape::Rectangle { corner: DVec3::new(-0.5, 3.0, -0.5), across: DVec3::X, up: DVec3::Z };
    let scene = Scene {
        objects: vec![
            solid(floor, DVec3::new(0.0, -0.25, 0.0), matt(0.8, 0.1, 0.1)),
            solid(block, DVec3::new(0.3, 0.5, 0.2), matt(0.7, 0.7, 0.7)),
        ],
        lights: vec![Light::Area { patch, radiance: Color::Bands(DVec3::new(8.0, 8.0, 0.25)) }],
        ..Scene::default()
    };
    ready(scene)
}

fn ready(mut scene: Scene) -> Prepared {
    scene.settings.light.interreflection = Interreflection::Followed;
    Prepared::new(&scene).expect("a scene")
}

fn tiling(prepared: &Prepared, most: usize) -> (Radiosity, Tiling) {
    let plan = Plan::new(prepared, &prepared.view());
    let settings = RadiositySettings { error: 0.02, finest: 1.0 / 64.0, ..RadiositySettings::default() };
    let solution =
        Radiosity::new(&World::new(prepared, &plan).expect("a world"), &plan, &settings, None, &Watch::NOBODY)
            .expect("a solution");
    let tiling = Tiling::new(&solution, prepared, &plan, most).expect("tiles");
    (solution, tiling)
}

/// Twice the area of a polygon times its normal.
fn newell(corners: &[DVec3]) -> DVec3 {
    corners.windows(2).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0])).sum()
}

#[test]
fn tiles_of_solids_meet_edge_to_edge_and_cover_them() {
    let prepared = room();
    for most in [usize::MAX, 600] {
        let (_, tiling) = tiling(&prepared, most);
        let (lamp, tiles) = tiling.tiles.split_last().expect("tiles");
        let mut edges: HashMap<([u64; 3], [u64; 3]), i32> = HashMap::new();
        for corners in tiles.iter().map(|tile| &tile.corners) {
            for (k, from) in corners.iter().enumerate() {
                let [a, b] =
                    [*from, corners[(k + 1) % corners.len()]].map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
                assert_ne!(a, b);
                *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|sum| *sum == 0), "each edge is run along as often in each direction");
        let area: f64 = tiles.iter().map(|tile| newell(&tile.corners).length() / 2.0).sum();
        let expected = 2.0 * 16.0 + 4.0 * 2.0 + 6.0;
        assert!((area / expected - 1.0).abs() < 1e-6, "{area} {expected}");
        assert_eq!(lamp.corners.len(), 4);
    }
}

#[test]
fn tiles_stand_for_more_elements_where_the_light_is_even_and_have_their_colours() {
    let prepared = room();
    let (solution, tiling) = tiling(&prepared, usize::MAX);
    assert_eq!(tiling.tolerance, TOLERANCE);
    assert!(tiling.tiles.len() < tiling.elements, "{} for {}", tiling.tiles.len(), tiling.elements);
    // The light in the middle of tiles, from the solution, by a search for the triangle around it.
    let (mut sum, mut count) = (0.0, 0);
    for tile in tiling.tiles.iter().filter(|tile| tile.corners.len() == 3) {
        let middle = tile.corners.iter().sum::<DVec3>() / 3.0;
        let normal = newell(&tile.corners);
        let around = (0..prepared.triangles.len() as u32).find(|triangle| {
            let corners = prepared.corners(*triangle);
            let weights = crate::numeric::triangle::weights(corners, middle);
            let found: DVec3 = (0..3).map(|k| corners[k] * weights[k]).sum();
            newell(&corners).dot(normal) > 0.0 && found.distance(middle) < 1e-7
        });
        let Some(triangle) = around else { continue };
        let weights = crate::numeric::triangle::weights(prepared.corners(triangle), middle);
        let irradiance = solution.irradiance(triangle, true, weights, IrradiancePart::All);
        let body = if prepared.object_of[triangle as usize] == 0 { [0.8, 0.1, 0.1] } else { [0.7; 3] };
        let expected = srgb::encoded(DVec3::from([0, 1, 2].map(|k| irradiance.0[k] * body[k] * FRAC_1_PI)));
        let shown = tile.colors.iter().map(|[front, _]| *front).sum::<DVec3>() / 3.0;
        sum += (shown - expected).abs().max_element();
        count += 1;
    }
    assert!(count > 100 && sum / f64::from(count) < TOLERANCE, "{count}: {}", sum / f64::from(count));
}

#[test]
fn few_corners_are_had_by_coarser_colours_and_no_triangle_is_lost() {
    let prepared = room();
    let (_, all) = tiling(&prepared, usize::MAX);
    let (_, fewer) = tiling(&prepared, all.corners() / 3);
    assert!(fewer.corners() <= all.corners() / 3 && fewer.tolerance > all.tolerance);
    assert_eq!(fewer.elements, all.elements);
    let (_, least) = tiling(&prepared, 0);
    assert_eq!(least.tiles.len(), prepared.triangles.len() + 1);
}

#[test]
fn what_emits_has_its_own_colour_and_is_not_divided() {
    let glow = Material::from(Classic { diffuse: Paint::grey(0.0), ..Classic::default() });
    let glow = Material { emission: Color::Bands(DVec3::new(0.5, 0.25, 2.0)), ..glow };
    let ball = solid(Primitive::Sphere { radius: 1.0 }, DVec3::ZERO, glow);
    let prepared = ready(Scene { objects: vec![ball], ..Scene::default() });
    let (_, tiling) = tiling(&prepared, usize::MAX);
    assert_eq!(tiling.tiles.len(), prepared.triangles.len());
    let expected = srgb::encoded(DVec3::new(0.5, 0.25, 1.0));
    for [front, _] in tiling.tiles.iter().flat_map(|tile| &tile.colors) {
        assert!((*front - expected).length() < 1e-6, "{front}");
    }
}

#[test]
fn lamps_are_bright_on_the_side_to_which_they_emit_and_black_behind() {
    let (_, tiling) = tiling(&room(), usize::MAX);
    let lamp = tiling.tiles.last().expect("tiles");
    let color = srgb::encoded(DVec3::new(1.0, 1.0, 0.25));
    assert!(lamp.colors.iter().all(|sides| *sides == [color, DVec3::ZERO]));
    assert!(newell(&lamp.corners).y < 0.0, "across turns to up about what is below");
}

#[test]
fn tiles_do_not_depend_on_the_number_of_threads() {
    let prepared = room();
    let by = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| tiling(&prepared, 2000).1)
    };
    assert!(by(1) == by(3));
}

#[test]
fn a_long_edge_beside_many_small_elements_is_cut_so_that_no_tile_has_too_many_corners() {
    let triangle = |corners: [[f64; 2]; 3]| {
        let corners = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
        TrianglePiece { corners, weights: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] }
    };
    let mut small = vec![triangle([[0.0, 0.0], [1.0, 0.0], [0.0, -1.0]])];
    for _ in 0..9 {
        // Those at the upper edge.
        small = small
            .iter()
            .flat_map(TrianglePiece::quarters)
            .filter(|piece| piece.corners.iter().filter(|corner| corner.y == 0.0).count() == 2)
            .collect();
    }
    assert_eq!(small.len(), 512);
    let mut pieces = vec![vec![triangle([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]])], small];
    let outlines = outlines(&mut pieces, Grid { step: NEAR });
    assert!(pieces[0].len() > 4, "{}", pieces[0].len());
    assert!(outlines.iter().flatten().all(|outline| outline.len() <= MOST_IN_TILE));
    let beside =
        outlines[0].iter().flatten().filter(|(corner, _)| corner.y == 0.0).map(|(corner, _)| corner.x.to_bits());
    assert_eq!(beside.collect::<HashSet<_>>().len(), 513, "they have all corners of those beside them");
}
