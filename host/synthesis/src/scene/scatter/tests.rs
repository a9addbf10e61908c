//! Tests of scattered instances: how many, where, and how they stand.

use super::super::object::{Instances, Object, Placing, Scatter, Shape, Sway};
use super::super::{FractalGround, GroundKind, Terrain};
use super::ScatterParts;
use crate::illumination::Paint;
use crate::illumination::texture::{Band, Motif, NumberTexture, Pattern, TextureMapping, Varying};
use crate::numeric::bounds::Bounds;
use crate::octree::{CellInstances, CellPlace, Instance, InstanceParts, Octree, OctreeSettings, Prototype};
use crate::procedural::Wind;
use crate::procedural::terrain::{FractalKind, FractalParameters};
use crate::solid::Primitive;
use crate::surface::Tolerance;
use glam::{DMat3, DMat4, DVec2, DVec3};
use std::sync::Arc;

/// Everything about the origin, on a level square of 10 or on something else.
fn scatter(count: usize) -> Scatter {
    Scatter { seed: 7, ..Scatter::over(on(Shape::Ground { size: 10.0 }, DMat4::IDENTITY), count) }
}

fn on(shape: Shape, transform: DMat4) -> Object {
    Object { name: "ground".into(), shape, transform, material: None, tolerance: Some(1e-3) }
}

fn instances(scatter: &Scatter) -> Instances {
    let placing = Placing::Scattered(Box::new(scatter.clone()));
    Instances { prototypes: vec![Vec::new(); scatter.shares.len()], placing }
}

fn all(scatter: &Scatter) -> Vec<Instance> {
    scatter.check(scatter.shares.len()).expect("in range");
    instances(scatter).places(None, 45.0).expect("a surface").all().collect()
}

#[test]
fn every_part_of_an_area_gets_as_many() {
    let mut counts = [0; 16];
    for Instance { placement, .. } in all(&scatter(16_000)) {
        let at = placement.translation;
        assert!(at.y == 0.0 && at.x.abs() <= 5.0 && at.z.abs() <= 5.0);
        let cell = |x: f64| ((x + 5.0) / 2.5) as usize;
        counts[cell(at.x).min(3) * 4 + cell(at.z).min(3)] += 1;
    }
    // Five standard deviations.
    assert!(counts.iter().all(|count| (840..1160).contains(count)), "{counts:?}");
}

#[test]
fn instances_stand_square_to_the_surface_or_upright_and_turn_and_lean_as_far_as_told() {
    let ball = || on(Shape::from(Primitive::Sphere { radius: 2.0 }), DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
    for Instance { placement, .. } in all(&Scatter { on: ball(), scale: [0.5, 2.0], ..scatter(500) }) {
        let [x, y, z] = [placement.matrix3.x_axis, placement.matrix3.y_axis, placement.matrix3.z_axis];
        let scale = y.length();
        assert!((0.5..=2.0).contains(&scale) && (x.length() / scale - 1.0).abs() < 1e-12);
        assert!((x.cross(y).dot(z) / scale.powi(3) - 1.0).abs() < 1e-12, "right-handed");
        assert!(y.dot(placement.translation) / (2.0 * scale) > 0.999);
    }
    let straight = Scatter { on: ball(), upright: 1.0, turn: 0.0, sink: 0.25, ..scatter(50) };
    for Instance { placement, .. } in all(&straight) {
        assert!((placement.matrix3 - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-12));
        assert!(((placement.translation + DVec3::Y * 0.25).length() - 2.0).abs() < 1e-3);
    }
    let leaning = all(&Scatter { lean: 20.0, turn: 10.0, ..scatter(2000) });
    let angles: Vec<f64> = leaning.iter().map(|i| i.placement.matrix3.y_axis.y.acos().to_degrees()).collect();
    let most = angles.iter().copied().fold(0.0, f64::max);
    assert!(most <= 20.0 + 1e-9 && most > 19.0, "{most}");
}

#[test]
fn distance_slope_height_and_density_are_kept() {
    let apart = all(&Scatter { distance: 0.4, ..scatter(300) });
    assert_eq!(apart.len(), 300);
    for (number, one) in apart.iter().enumerate() {
        let far = |other: &Instance| one.placement.translation.distance(other.placement.translation) >= 0.4;
        assert!(apart[..number].iter().all(far));
    }
    let full = all(&Scatter { distance: 1.0, ..scatter(1_000) }).len();
    assert!((60..120).contains(&full), "no room for more: {full}");
    let ball = || on(Shape::from(Primitive::Sphere { radius: 2.0 }), DMat4::IDENTITY);
    for Instance { placement, .. } in all(&Scatter { on: ball(), slope: [30.0, 60.0], ..scatter(500) }) {
        let slope = (placement.translation.y / 2.0).acos().to_degrees();
        assert!((29.0..61.0).contains(&slope), "{slope}");
    }
    let band = all(&Scatter { on: ball(), height: [-0.5, 0.25], ..scatter(500) });
    assert!(band.len() == 500 && band.iter().all(|i| (-0.5..=0.25).contains(&i.placement.translation.y)));
    assert!(all(&Scatter { height: [5.0, 6.0], ..scatter(500) }).is_empty());
}

/// Nothing on two of four squares, everything on the others.
#[test]
fn what_is_scattered_on_terrain_stands_on_the_ground_itself() {
    let parameters = FractalParameters { octaves: 8.0, scale: 4.0, height: 1.0, ..FractalParameters::default() };
    let fractal =
        FractalGround { kind: GroundKind::Noise(FractalKind::Hybrid), parameters, size: [10.0, 8.0], warp: 0.3 };
    let terrain = Terrain { fractal, erosion: None, base: None };
    let field = terrain.field().expect("sound");
    let transform = DMat4::from_rotation_x(0.7) * DMat4::from_scale(DVec3::new(2.0, 0.5, -1.0));
    let coarse = Object { tolerance: Some(0.1), ..on(Shape::Terrain(Box::new(terrain)), transform) };
    for distance in [0.0, 0.05] {
        let mut off_triangles: f64 = 0.0;
        for Instance { placement, .. } in all(&Scatter { on: coarse.clone(), distance, ..scatter(800) }) {
            let own = transform.inverse().transform_point3(placement.translation);
            let at = DVec2::new(own.x, own.z);
            assert!((own.y - field.height(at, 0.0)).abs() < 1e-9, "{own}");
            off_triangles = off_triangles.max((own.y - field.height(at, 1.0)).abs());
            let normal = (transform.inverse().transpose().transform_vector3(field.normal(at, 0.0))).normalize();
            assert!(placement.matrix3.y_axis.normalize().dot(normal) > 1.0 - 1e-9);
        }
        assert!(off_triangles > 0.01);
    }
}

fn checkered() -> NumberTexture {
    let checker = Pattern {
        motif: Motif::Checker,
        laying: TextureMapping::default(),
        paints: vec![Paint::grey(0.0), Paint::grey(1.0)],
    };
    let density = Varying { pattern: checker, band: Band::Mean, from: 0.0, to: 1.0 };
    NumberTexture::Varying(Box::new(density))
}

#[test]
fn a_pattern_of_density_lies_as_a_paint_does() {
    let density = checkered();
    let mut sides = Vec::new();
    for mirror in [1.0, -1.0] {
        let on = on(Shape::Ground { size: 10.0 }, DMat4::from_scale(DVec3::new(mirror, 1.0, 1.0)));
        let all = all(&Scatter { density: density.clone(), on, ..scatter(2000) });
        let is_first = |instance: &&Instance| instance.placement.translation.x * instance.placement.translation.z > 0.0;
        let first = all.iter().filter(is_first).count();
        assert!(all.len() == 2000 && (first == 0 || first == 2000), "{first}: two of four squares");
        assert!(all.iter().all(|instance| instance.placement.matrix3.y_axis.y > 0.999), "they stand on top");
        sides.push(first);
    }
    assert_eq!(sides[0] + sides[1], 2000, "a mirrored square has a mirrored pattern");
}

#[test]
fn prototypes_come_as_often_as_their_shares_tell_and_all_is_drawn_from_the_seed() {
    let shares = || Scatter { shares: vec![1.0, 0.0, 3.0], ..scatter(4000) };
    let first = all(&shares());
    let count = |which: u16| first.iter().filter(|instance| instance.prototype == which).count();
    assert!(count(1) == 0 && (850..1150).contains(&count(0)), "{}", count(0));
    assert_eq!(first, all(&shares()));
    assert_ne!(first, all(&Scatter { seed: 8, ..shares() }));
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| all(&Scatter { distance: 0.05, slope: [0.0, 10.0], ..scatter(3000) }))
    };
    assert_eq!(of(1), of(3));
}

#[test]
fn a_part_of_a_surface_has_as_many_as_its_area_tells_and_they_are_in_its_box() {
    for (shape, transform) in [
        (Shape::Ground { size: 10.0 }, DMat4::IDENTITY),
        (Shape::from(Primitive::Sphere { radius: 3.0 }), DMat4::from_scale(DVec3::new(-1.0, 2.0, 1.0))),
    ] {
        let scatter = Scatter { on: on(shape, transform), ..scatter(100_000) };
        let parts = ScatterParts::new(&scatter, None, 10.0).expect("a surface");
        assert!((25..60).contains(&parts.parts()), "{}", parts.parts());
        let (mut next, mut sizes) = (0, 0.0);
        for part in 0..parts.parts() {
            let count = parts.count(part);
            assert!((1..=4096).contains(&count), "{count}");
            let Bounds { min, max } = parts.bounds(part);
            sizes += (max - min).max_element();
            for own in (0..count).step_by(7) {
                let instance = parts.instance(part, own);
                let at = instance.placement.translation;
                assert!(at.cmpge(min - 1e-9).all() && at.cmple(max + 1e-9).all(), "{at} {min} {max}");
                assert_eq!(parts.instance_of_all(next + own), instance);
            }
            next += count;
        }
        let mean = sizes / parts.parts() as f64;
        assert!(next == 100_000 && mean < 4.5, "{next} {mean}");
    }
}

#[test]
fn no_instances_and_a_single_one_are_parts_too() {
    for count in [0, 1, 2] {
        assert_eq!(all(&scatter(count)).len(), count);
    }
    let flat = on(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::from_scale(DVec3::new(1.0, 1e-12, 1.0)));
    assert_eq!(all(&Scatter { on: flat, ..scatter(50) }).len(), 50);
}

#[test]
fn cells_have_as_many_each_as_density_height_and_the_end_of_the_ground_leave() {
    let in_cells = |cell: f64, count: usize| Scatter { cell: Some(cell), ..scatter(count) };
    assert_eq!(all(&in_cells(2.5, 7)).len(), 4 * 4 * 7);
    // The last cells are cut in half.
    let cut = all(&in_cells(4.0, 100));
    assert!((cut.len() as f64 / 625.0 - 1.0).abs() < 0.1, "{}", cut.len());
    assert!(cut.iter().all(|instance| instance.placement.translation.abs().max_element() <= 5.0));
    let half = all(&Scatter { density: NumberTexture::Constant(0.5), ..in_cells(0.5, 10) });
    assert!((half.len() as f64 / 2000.0 - 1.0).abs() < 0.08, "{}", half.len());
    // Those that are left are as they were.
    let full = all(&in_cells(0.5, 10));
    assert!(half.iter().all(|instance| full.contains(instance)));
    let turned = DMat4::from_translation(DVec3::Y * 3.0) * DMat4::from_rotation_z(0.5);
    let slope = Scatter { on: on(Shape::Ground { size: 10.0 }, turned), height: [3.0, 9.0], ..in_cells(0.5, 10) };
    let above = all(&slope);
    assert!(above.len() > 1500 && above.iter().all(|instance| instance.placement.translation.y >= 3.0));
    assert!(above.iter().all(|instance| (instance.placement.matrix3.y_axis.y - 0.5_f64.cos()).abs() < 1e-12));
    assert!(all(&Scatter { slope: [0.0, 20.0], ..slope }).is_empty());
}

#[test]
fn those_about_a_point_are_the_nearest() {
    let whole = scatter(40_000);
    let cells = Scatter { cell: Some(0.1), ..scatter(4) };
    for of in [&whole, &cells] {
        let instances = instances(of);
        let places = instances.places(None, 45.0).expect("a surface");
        let at = DVec3::new(4.0, 1.0, -2.0);
        let near: Vec<usize> = places.near(at, 9000).into_iter().flatten().collect();
        assert!((6000..14_000).contains(&near.len()), "{}", near.len());
        let far = |number: usize| (places.instance(number).placement.translation - at).length();
        let farthest = near.iter().map(|number| far(*number)).fold(0.0, f64::max);
        let mut kept = vec![false; places.count()];
        near.iter().for_each(|number| kept[*number] = true);
        let nearest = (0..places.count()).filter(|number| !kept[*number]).map(far).fold(f64::INFINITY, f64::min);
        assert!(nearest > 1.5 && farthest < 7.0, "{nearest} {farthest}");
        assert_eq!(places.near(DVec3::ZERO, usize::MAX).into_iter().map(|all| all.len()).sum::<usize>(), 40_000);
    }
}

#[test]
fn a_pattern_of_density_lies_in_cells_as_a_paint_does() {
    for mirror in [1.0, -1.0] {
        let transform = DMat4::from_rotation_y(0.3) * DMat4::from_scale(DVec3::new(mirror, 1.0, 2.0));
        let on = on(Shape::Ground { size: 10.0 }, transform);
        let patterned = Scatter { density: checkered(), on: on.clone(), ..scatter(2000) };
        let [found, cells] = [patterned.clone(), Scatter { cell: Some(0.5), count: 5, ..patterned }].map(|of| all(&of));
        let own = |instance: &Instance| transform.inverse().transform_point3(instance.placement.translation);
        let first = |all: &[Instance]| all.iter().filter(|instance| own(instance).x * own(instance).z > 0.0).count();
        assert!(cells.len() > 1500 && (first(&cells) == 0 || first(&cells) == cells.len()));
        assert_eq!(first(&found) == 0, first(&cells) == 0);
        assert!(cells.iter().all(|instance| instance.placement.matrix3.y_axis.y > 0.999), "they stand on top");
    }
}

#[test]
fn cells_that_cannot_be_are_refused() {
    let refusal = |scatter: Scatter| scatter.check(1).expect_err("a problem");
    let in_cells = |cell: f64| Scatter { cell: Some(cell), ..scatter(4) };
    let ball = on(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY);
    let skewed =
        DMat4::from_rotation_y(0.4) * DMat4::from_scale(DVec3::new(1.0, 1.0, 2.0)) * DMat4::from_rotation_y(0.4);
    assert_eq!(refusal(in_cells(0.0)), "cell is out of range");
    assert!(refusal(in_cells(1e-9)).contains("1.000e10 cells along a side are more than"));
    assert!(refusal(Scatter { on: ball, ..in_cells(1.0) }).contains("which ground is not"));
    assert!(refusal(Scatter { on: on(Shape::Ground { size: 10.0 }, skewed), ..in_cells(1.0) }).contains("not skewed"));
    assert!(refusal(Scatter { distance: 0.1, ..in_cells(1.0) }).contains("a distance is not kept"));
    assert!(refusal(Scatter { count: 1 << 23, ..in_cells(1.0) }).contains("instances in a cell"));
}

/// A wind along x.
fn wind(speed: f64, gusts: f64) -> Wind {
    Wind {
        mean: DVec3::X * speed,
        gusts,
        gust_size: 4.0,
        turbulence: 0.5 * gusts,
        eddy_size: 2.0,
        octaves: 2,
        period: None,
        seed: 3,
    }
}

#[test]
fn the_wind_bends_by_the_square_of_its_speed_the_way_it_blows() {
    let bent = |wind: &Wind, time: f64, of: Scatter| {
        all(&Scatter { sway: Some(Sway { wind: wind.clone(), time, lean: 6.0 }), ..of })
    };
    let axis = |instance: &Instance| instance.placement.matrix3.y_axis.normalize();
    for (speed, degrees) in
        [(0.0, 0.0_f64), (10.0, 6.0), (20.0, (4.0 * 6.0_f64.to_radians().tan()).atan().to_degrees())]
    {
        for instance in bent(&wind(speed, 0.0), 3.0, scatter(40)) {
            let leans = axis(&instance).angle_between(DVec3::Y).to_degrees();
            assert!((leans - degrees).abs() < 1e-5 && axis(&instance).z.abs() < 1e-12, "{speed}: {leans}");
        }
    }
    // It changes where nothing is but how it stands, as long as it is of one time; and a storm lays all flat.
    let gusty = wind(10.0, 0.5);
    let [now, again, later] = [1.0, 1.0, 1.3].map(|time| bent(&gusty, time, scatter(200)));
    assert!(now == again && now != later);
    for (one, other) in now.iter().zip(&later) {
        assert_eq!((one.placement.translation, one.variation), (other.placement.translation, other.variation));
    }
    let leaning: Vec<f64> = now.iter().map(|one| axis(one).angle_between(DVec3::Y)).collect();
    let most = ((1.0 + 2.0 * 0.5_f64.hypot(0.25)).powi(2) * 6.0_f64.to_radians().tan()).atan();
    assert!(leaning.iter().all(|angle| *angle <= most + 1e-9) && leaning.iter().any(|angle| *angle > 0.2));
    assert!(bent(&wind(1e6, 0.3), 1e6, scatter(50)).iter().all(|one| axis(one).y < 1e-3 && axis(one).x > 0.3));
}

#[test]
fn cells_hold_what_the_wind_bends_in_them_however_the_ground_is_placed() {
    let shape = Shape::Solid(Primitive::Box { size: DVec3::new(0.1, 1.0, 0.1) }.into());
    let mesh = on(shape, DMat4::from_translation(DVec3::Y * 0.5));
    let mesh = mesh.in_place(mesh.shape.tessellate(Tolerance { chord: 1e-3, angle: 45.0 }).expect("a box")).mesh;
    let octree = Octree::sharing(Arc::new(mesh.vertices), Arc::new(mesh.triangles), &OctreeSettings::default());
    let prototype = Prototype::surface(Arc::new(octree.expect("small")), 0);
    let post = prototype.bounds();
    let sway = |speed: f64| Some(Sway { wind: wind(speed, 0.6), time: 2.0, lean: 10.0 });
    for turned in [DMat4::IDENTITY, DMat4::from_rotation_y(2.0), DMat4::from_rotation_z(0.4)] {
        for speed in [5.0, 20.0, 1e6] {
            let ground = on(Shape::Ground { size: 10.0 }, turned);
            let scatter = Scatter {
                on: ground,
                cell: Some(1.0),
                sway: sway(speed),
                upright: 1.0,
                scale: [0.4, 2.0],
                ..scatter(3)
            };
            let cells = super::ScatterCells::new(&scatter, 1.0, 45.0).expect("a ground");
            let grid = cells.grid(std::slice::from_ref(&prototype));
            for number in 0..cells.count_of_all() {
                let cell = [number / 30, number / 3 % 10];
                let instance = cells.instance(cell.map(|side| side as u32), (number % 3) as u32).expect("all count");
                let own = Bounds::of(post.corners().map(|corner| instance.placement.transform_point3(corner)));
                let CellPlace { at, part } = cells.place(cell.map(|side| side as u32), (number % 3) as u32);
                assert!((instance.placement.matrix3.y_axis.length() - 2.0 * part).abs() < 1e-12, "{part}");
                let (over, [low, high]) = (grid.overhang * part + 1e-9, grid.heights.map(|height| height * part));
                let least = DVec3::new(at.x - over, low - 1e-9, at.y - over);
                let most = DVec3::new(at.x + over, high + 1e-9, at.y + over);
                assert!(own.min.cmpge(least).all() && own.max.cmple(most).all(), "{speed}: {own:?} {grid:?}");
            }
            // Where it is bent does not depend on how its cell is turned.
            let of_all = cells.instance_of_all(7).placement;
            let bends = wind(speed, 0.6).at(of_all.translation, 2.0).normalize();
            let y = of_all.matrix3.y_axis.normalize();
            assert!(y.dot(DVec3::Y.cross(bends)).abs() < 0.1, "{y} {bends}");
        }
    }
}
