//! Facts about terrain: rays meet it where its triangles are, but exactly, and pictures do not tell what was kept of it.

use super::instance_tests::{at, differing, diffuse, green, instances, lit, maps, object, render, render_within};
use super::{RENDERERS, Rendering, Technique};
use crate::illumination::Paint;
use crate::illumination::material::{MaterialKind, RefractiveIndex, Transparent};
use crate::illumination::texture::{Motif, Pattern, TextureMapping};
use crate::procedural::terrain::{FractalKind, FractalParameters};
use crate::scene::{FractalGround, GroundKind, Object, Scene, Shape, Terrain};
use glam::{DAffine3, DMat4, DVec3};

/// Uneven ground, checkered in its body or along its parameters.
fn ground(is_solid: bool, octaves: f64) -> Object {
    let checker = Pattern {
        motif: Motif::Checker,
        laying: TextureMapping { solid: is_solid, size: DVec3::splat(0.4), ..TextureMapping::default() },
        paints: vec![Paint::grey(0.8), Paint::grey(0.2)],
    };
    let parameters = FractalParameters { octaves, scale: 1.2, height: 0.5, seed: 2.0, ..FractalParameters::default() };
    let fractal = FractalGround { kind: GroundKind::Noise(FractalKind::Fbm), parameters, size: [2.4, 2.0], warp: 0.0 };
    let terrain = Terrain { fractal, erosion: None, base: None };
    let mut ground =
        object(Shape::Terrain(Box::new(terrain)), DMat4::IDENTITY, diffuse(Paint::Pattern(Box::new(checker))));
    ground.tolerance = Some(0.002);
    ground
}

/// Ground made of triangles: rays meet those of what instances place.
fn of_triangles(ground: &Object) -> Object {
    instances(vec![vec![ground.clone()]], vec![at(DAffine3::IDENTITY, 0, 0)], DMat4::IDENTITY)
}

#[test]
fn terrain_looks_as_its_triangles_do_however_it_is_placed() {
    for is_solid in [true, false] {
        let placed = |object: Object, map: &DAffine3| Object { transform: DMat4::from(*map), ..object };
        let exact = lit(maps().iter().map(|map| placed(ground(is_solid, 2.0), map)).collect());
        let triangles = lit(maps().iter().map(|map| placed(of_triangles(&ground(is_solid, 2.0)), map)).collect());
        let row = Technique::RayTracing.row();
        let [one, other] = [&exact, &triangles].map(|scene| render(scene, row));
        // Edges of the pattern and outlines are moved by the triangles' tolerance, and normals turned by what they leave out.
        let is_far = |(a, b): (f64, f64)| (a - b).abs() > 0.05 * (a + b);
        let differing = green(&one).into_iter().zip(green(&other)).filter(|pair| is_far(*pair)).count();
        assert!(differing <= 60, "{differing} pixels");
    }
}

#[test]
fn every_technique_draws_terrain() {
    let scene = lit(vec![ground(true, 4.0)]);
    let mean = |rendering: &Rendering| {
        let all = green(rendering);
        all.iter().sum::<f64>() / all.len() as f64
    };
    let expected = mean(&render(&scene, Technique::RayTracing.row()));
    for row in &RENDERERS {
        let found = mean(&render(&scene, row));
        assert!((found / expected - 1.0).abs() < 0.1, "{}: {found} {expected}", row.word);
    }
}

#[test]
fn pictures_do_not_tell_how_much_of_the_ground_is_kept_nor_how_many_threads_there_are() {
    let row = Technique::RayTracing.row();
    let large = DMat4::from_scale(DVec3::splat(6.0));
    let mut scene = lit(vec![Object { tolerance: None, transform: large, ..ground(true, 12.0) }]);
    (row.require)(&mut scene.settings);
    scene.settings.image.samples = 2;
    let picture = |most: Option<u64>, threads: usize| render_within(&scene, row, most, threads);
    let (whole, all) = picture(None, 1);
    assert!(all.kept > 8 && all.made == all.kept as u64, "{all:?}");
    for (most, threads) in [(None, 2), (Some(all.bytes / 4), 1), (Some(all.bytes / 4), 2)] {
        let (found, costs) = picture(most, threads);
        assert!(found == whole, "{most:?} bytes, {threads} threads");
        assert!(most.is_none_or(|most| costs.made > all.made && costs.bytes <= most.max(all.bytes / 4)), "{costs:?}");
    }
}

#[test]
fn terrain_that_light_passes_and_solid_terrain_are_met_by_their_triangles() {
    let glass = MaterialKind::Transparent(Transparent::clear(RefractiveIndex::Constant(1.5)));
    let solid = |mut ground: Object, material| {
        if let Shape::Terrain(terrain) = &mut ground.shape {
            terrain.base = Some(-0.9);
        }
        Object { material, ..ground }
    };
    let row = Technique::RayTracing.row();
    let picture = |objects: Vec<Object>| {
        let mut scene: Scene = lit(objects);
        scene.settings.light.reflection_depth = 8;
        render(&scene, row)
    };
    for material in [Some(glass.into()), ground(true, 4.0).material] {
        let block = solid(ground(true, 4.0), material);
        let differing = differing(&picture(vec![block.clone()]), &picture(vec![of_triangles(&block)]));
        assert!(differing <= 12, "{differing} pixels");
    }
}
