//! Facts about instances that scripts place.

use super::tests::{problem, run};
use crate::octree::Instance;
use crate::scene::{Instances, Placing, Prepared, Shape};
use glam::{DAffine3, DVec3};

fn of(shape: &Shape) -> &Instances {
    match shape {
        Shape::Instances(instances) => instances,
        other => panic!("{other:?}"),
    }
}

fn listed(instances: &Instances) -> &[Instance] {
    match &instances.placing {
        Placing::Listed(list) => &list.0,
        other => panic!("{other:?}"),
    }
}

#[test]
fn places_are_points_or_tell_how_to_place() {
    let made = run("
        let ball = sphere(0.2);
        let rod = box(0.1, 2, 0.1);
        let pair = [ball, rod.translate(0, 1, 0)];
        let row = instances([pair, [cube(1)]], [
            [1, 2, 3],
            #{ at: [4, 0, 0], turn: 90, scale: 2, which: 1, variation: 1 },
            #{ axis: \"x\", turn: 90, scale: [1, 2, 3] },
            #{ at: [0, 1, 0], matrix: [[1, 0, 0], [0.5, 1, 0], [0, 0, -1]] },
        ]).name(\"row\").translate(0, 5, 0);
        sphere(1);
    ");
    let [row, ball] = &made.scene.objects[..] else { panic!("{}", made.scene.objects.len()) };
    assert_eq!((&*row.name, &*ball.name), ("row", "sphere 2"));
    assert_eq!(row.transform.transform_point3(DVec3::ZERO), DVec3::Y * 5.0);
    let instances = of(&row.shape);
    let sizes: Vec<usize> = instances.prototypes.iter().map(Vec::len).collect();
    assert_eq!(sizes, [2, 1]);
    let all = listed(instances);
    let maps = |number: usize, from: DVec3| all[number].placement.transform_point3(from);
    assert_eq!(all[0].placement, DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0)));
    assert_eq!((all[1].prototype, all[1].variation), (1, u16::MAX));
    assert!((maps(1, DVec3::Z) - DVec3::new(6.0, 0.0, 0.0)).length() < 1e-12);
    assert!((maps(2, DVec3::ONE) - DVec3::new(1.0, -3.0, 2.0)).length() < 1e-12);
    assert_eq!(maps(3, DVec3::ONE), DVec3::new(1.5, 2.0, -1.0));
    assert_ne!(all[0].variation, all[2].variation);
}

#[test]
fn instances_of_scattered_instances_stand_where_their_surface_is() {
    let made = run("
        let tuft = scatter(box(0.02, 0.2, 0.02), ground(1), #{ count: 30, seed: 5, stays: false });
        let hill = sphere(3).translate(0, -1, 0);
        scatter(tuft, hill, #{ count: 20, slope: [0, 40], upright: 1, scale: [0.5, 1] });
        hill.translate(100, 0, 0);
    ");
    let names: Vec<&str> = made.scene.objects.iter().map(|object| &*object.name).collect();
    assert_eq!(names, ["sphere", "instances 2"]);
    let prepared = Prepared::new(&made.scene).expect("a scene");
    let group = &prepared.objects[1];
    assert_eq!(
        (group.instances, prepared.triangles.len() as u32),
        (20, prepared.objects.iter().map(|o| o.count).sum())
    );
    // The hill was where it was scattered on.
    assert!(group.bounds.min.x > -4.0 && group.bounds.max.x < 4.0 && group.bounds.min.y > 1.0);
    assert!(group.bounds.max.y < 2.5);
}

#[test]
fn what_stands_in_cells_is_stored_nowhere() {
    let made = run("
        let tuft = scatter(box(0.02, 0.2, 0.02), ground(0.5), #{ count: 30, lean: 20, stays: false });
        scatter(tuft, ground(100000), #{ count: 40, cell: 0.5, scale: [0.5, 1] });
    ");
    let costs = Prepared::new(&made.scene).expect("a scene").instance_costs().expect("instances");
    assert_eq!((costs.instances, costs.stored), (200_000 * 200_000 * 40 + 30, 30));
    assert_eq!(costs.triangles, 200_000 * 200_000 * 40 * 30 * 12);
    let crowded = run("scatter(cube(1), ground(10), #{ count: 4, cell: 0.05 });");
    let error = Prepared::new(&crowded.scene).expect_err("cells that are too small").to_string();
    assert!(error.contains("out of its cell, more than 8 times its side 0.05; enlarge the cells"), "{error}");
}

#[test]
fn aggregates_stand_in_for_what_is_in_cells_if_the_script_asks_for_them() {
    let aggregate = |option: &str| {
        let made = run(&format!("scatter(cone(0.1, 1), ground(500), #{{ count: 4, cell: 1{option} }});"));
        let Shape::Instances(instances) = &made.scene.objects[1].shape else { panic!("instances") };
        let Placing::Scattered(scatter) = &instances.placing else { panic!("scattered") };
        let prepared = Prepared::new(&made.scene).expect("a scene");
        (scatter.aggregate, prepared.aggregate_views(1, &[prepared.view()], &prepared.settings).len())
    };
    assert_eq!(aggregate(""), (None, 0));
    assert_eq!(aggregate(", aggregate: 0.5"), (Some(0.5), 1));
}

#[test]
fn what_cannot_be_placed_is_told_with_its_place() {
    for (text, expected) in [
        (
            "let b = sphere(1);\nb + instances(cube(1), [[0, 0, 0]]);",
            (2, 3, "made of instances; combine solids before"),
        ),
        ("let b = cube(1); instances(b, [[0, 0, 0]]);\nb.translate(1, 0, 0);", (2, 3, "became part of another")),
        ("let b = cube(1);\ninstances([b, b], [[0, 0, 0]]);", (2, 1, "an object is told twice")),
        ("instances(cube(1), [[0, 0]]);", (1, 1, "places must be a list of points")),
        ("instances(cube(1), [#{ at: [0, 0, 0], spin: 4 }]);", (1, 1, "places must be a list of points")),
        ("instances(cube(1), [#{ which: 1 }]);", (1, 1, "which 1 of place 1 is not within 0 to 0")),
        ("instances([], [[0, 0, 0]]);", (1, 1, "objects must be an object, a list of objects")),
        ("let b = cube(1).moving([1, 0, 0]);\ninstances(b, [[0, 0, 0]]);", (2, 1, "moves; let the whole move")),
        ("let b = cube(1); scatter(b, b, 10);", (1, 18, "an object cannot be scattered on itself")),
        ("scatter(cube(1), half_space(\"y\"), 10);", (1, 1, "has no surface of its own")),
        ("scatter(cube(1), cube(4), #{ count: 10, shares: [1, 2] });", (1, 1, "shares is out of range")),
        ("scatter(cube(1), cube(4), #{ count: 10, slope: [40, 20] });", (1, 1, "slope must be a number from 0 to 180")),
        ("scatter(cube(1), cube(4), #{ count: 10, cell: 1 });", (1, 1, "cells lie on a ground")),
        (
            "scatter(cube(1), ground(4), #{ count: 10, cell: 1, distance: 1 });",
            (1, 1, "a distance is not kept in cells"),
        ),
        ("scatter(cube(1), ground(4), #{ count: 10, aggregate: 1 });", (1, 1, "tell the side of a cell")),
        (
            "scatter(cube(1), ground(4), #{ count: 10, cell: 1, aggregate: 0 });",
            (1, 1, "aggregate must be a number from 0.0039"),
        ),
        (
            "let a = scatter(cube(1), ground(4), #{ count: 10, cell: 1, aggregate: 1 });\ninstances(a, [[0, 0, 0]]);",
            (2, 1, "has aggregates, which stand in for what the scene itself has, not for what is placed again"),
        ),
        ("let b = cube(1); for i in 0..8 { b = instances(b, [[0, 0, 0]]); }", (1, 38, "nested more than 7 times")),
    ] {
        let (line, column, message) = problem(text);
        assert!(message.contains(expected.2), "{text}: {message}");
        assert_eq!((line, column), (expected.0, expected.1), "{text}");
    }
}

#[test]
fn the_wind_blows_where_it_is_told_and_bends_what_is_scattered_behind_it() {
    let made = run("
        wind(5, #{ from: 180, gusts: 0, turbulence: 0 });
        let v = wind_at(1, 2, 3);
        print(v.map(|x| abs(round(x * 1000.0) / 1000.0)));
        scatter(cone(0.1, 1), ground(10), #{ count: 20, sway: 30 });
    ");
    assert_eq!(made.printed, ["[0.0, 0.0, 5.0]"]);
    assert!(made.is_timed);
    let Shape::Instances(instances) = &made.scene.objects[1].shape else { panic!("instances") };
    let Placing::Scattered(scatter) = &instances.placing else { panic!("scattered") };
    let sway = scatter.sway.as_ref().expect("it sways");
    assert_eq!((sway.lean, sway.time, sway.wind.mean.z), (30.0, 0.0, -5.0));
    for (script, expected) in [
        ("scatter(cone(0.1, 1), ground(10), #{ count: 20, sway: 30 });", "there is no wind; call wind() before"),
        ("wind_at(0, 0, 0);", "there is no wind"),
        ("wind(-1);", "speed must be"),
        ("wind(1, #{ period: 0 });", "period must be"),
    ] {
        let message = problem(script).2;
        assert!(message.contains(expected), "{message}");
    }
}
