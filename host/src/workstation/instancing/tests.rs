//! What is sent of scenes with instances, and what of it is drawn.

use super::*;
use crate::numeric::bounds::Bounds;
use crate::scene::Camera;
use crate::script;
use crate::workstation::{network, structure};
use glam::DVec3;
use protocol::Name;
use protocol::command::{NamePattern, Object as Node, encode};
use std::collections::BTreeMap;
use std::path::Path;

fn scene(text: &str) -> Scene {
    script::evaluate(text, "test", Path::new(""), &script::Inputs::default()).expect("a scene").scene
}

/// What a scene becomes, seen from z.
fn shown(text: &str, drawing: &Drawing) -> StructureCommands {
    let bounds = Bounds::of([DVec3::splat(-10.0), DVec3::splat(10.0)]);
    let camera = Camera { from: DVec3::Z * 30.0, at: DVec3::ZERO, field_of_view: 60.0, ..Camera::framing(&bounds) };
    let initial = InitialView { camera, center: DVec3::ZERO, elongation: 1.0 };
    structure::commands(&scene(text), &initial, &bounds, drawing).expect("it is drawn")
}

fn bytes(shown: &StructureCommands) -> usize {
    let mut sent = Vec::new();
    shown.commands.iter().for_each(|command| encode(command, &mut sent).expect("it fits"));
    sent.len()
}

/// Vectors that the machine draws, by its rules for structures, conditions and levels of detail.
fn drawn(shown: &StructureCommands) -> usize {
    let mut structures: BTreeMap<String, Vec<&Command>> = BTreeMap::new();
    let mut open: Vec<String> = Vec::new();
    for command in &shown.commands {
        match command {
            Command::Define { name: Some(name), object: Node::BeginStructure } => {
                let within = open.last().map_or(String::new(), |outer| format!("{outer}."));
                if let Some(outer) = open.last() {
                    structures.entry(outer.clone()).or_default().push(command);
                }
                open.push(format!("{within}{name}"));
                structures.entry(format!("{within}{name}")).or_default();
            }
            Command::EndStructure => _ = open.pop(),
            _ => {
                if let Some(outer) = open.last() {
                    structures.entry(outer.clone()).or_default().push(command);
                }
            }
        }
    }
    fn walk(structures: &BTreeMap<String, Vec<&Command>>, at: &str, mut level: u16) -> usize {
        let mut sum = 0;
        for command in &structures[at] {
            let Command::Define { name, object } = command else { continue };
            let below =
                |to: &Option<Name>, level: u16| to.as_ref().map_or(0, |to| walk(structures, to.as_str(), level));
            match object {
                Node::BeginStructure => {
                    sum += walk(structures, &format!("{at}.{}", name.as_ref().expect("named")), level);
                }
                Node::VectorList(list) => sum += list.lines.iter().filter(|line| **line).count(),
                Node::Polygons(polygons) => sum += polygons.iter().map(|p| p.vertices.len()).sum::<usize>(),
                Node::Operate { operate: Operate::SetLevelOfDetail(to), .. } => level = *to,
                Node::Operate { operate: Operate::IncrementLevelOfDetail, .. } => level += 1,
                Node::Operate { operate: Operate::IfLevelOfDetail { comparison, level: with }, applied_to } => {
                    let admits = comparison.holds(i32::from(level), i32::from(*with));
                    sum += if admits { below(applied_to, level) } else { 0 };
                }
                Node::Operate { applied_to, .. } => sum += below(applied_to, level),
                _ => {}
            }
        }
        sum
    }
    walk(&structures, super::super::ROOT, 0)
}

/// A row of balls that are far from each other.
fn balls(count: usize) -> String {
    format!("let all = []; for k in 0..{count} {{ all.push([0.1 * k - 5, 0, 0]); }} instances(sphere(0.001), all);")
}

#[test]
fn bytes_grow_by_a_node_an_instance_whatever_it_places() {
    let drawing = Drawing { most: Some(1_000_000), ..Drawing::default() };
    let fine = Drawing { tolerance: drawing.tolerance / 16.0, ..drawing };
    for drawing in [drawing, fine] {
        let [few, many] = [50, 150].map(|count| shown(&balls(count), &drawing));
        let each = (bytes(&many) - bytes(&few)) as f64 / 100.0;
        assert!(each < 130.0, "{each} bytes an instance");
        let lines = few.instances.expect("there are some").lines / 50;
        assert_eq!(many.lines, 150 * lines);
        assert_eq!([&few, &many].map(drawn), [50 * lines, 150 * lines], "as many as the machine draws");
    }
}

const FOREST: &str = r#"
    let leaf = sphere(0.05).material(varied([0.2, 0.5, 0.1], [0.8, 0.3, 0.0]));
    let crown = scatter(leaf, sphere(0.6), #{ count: 900, stays: false }).translate(0, 1.5, 0);
    let tree = [crown, cylinder(0.05, 1.6).translate(0, 0.8, 0)];
    let blade = cone(0.02, 0.4).translate(0, 0.2, 0);
    let tuft = scatter(blade, ground(0.4), #{ count: 30, lean: 30, stays: false });
    let field = ground(60);
    scatter(tree, field, #{ count: 300 });
    scatter(tuft, field, #{ count: 40000 });
"#;

#[test]
fn instances_are_thinned_out_to_what_the_machine_draws_and_the_largest_stay() {
    for (most, facets) in [(2_000, false), (20_000, false), (20_000, true)] {
        let drawing = Drawing { most: Some(most), facets, ..Drawing::default() };
        let shown = shown(FOREST, &drawing);
        let DrawnInstances { count, drawn: steps, lines } = shown.instances.expect("there are some");
        assert!(count == 40_300 && lines <= most && lines > most / 2, "{lines} of {most}: {steps:?}");
        assert_eq!(drawn(&shown), shown.lines, "{most}: as many as the machine draws");
        let all: u64 = steps.iter().sum();
        assert!(all > 100 && all < count && steps[2] > 0, "{steps:?}");
        assert!(bytes(&shown) < 2_000_000, "{} bytes", bytes(&shown));
        let story = shown.instances.expect("there are some").describe();
        assert!(story.contains(&format!("{} are left out", count - all)), "{story}");
    }
}

#[test]
fn what_is_nested_seven_times_is_drawn_and_costs_as_many_nodes_as_are_told() {
    let mut text = "let a = cube(0.5);".to_owned();
    for level in 0..7 {
        let far = 0.6 * 1.5_f64.powi(level);
        text += &format!("a = instances(a, [[0, 0, 0], [{far}, 0, 0]]);");
    }
    let all = shown(&text, &Drawing { most: Some(1_000_000), ..Drawing::default() });
    assert_eq!((all.instances.expect("there are some").count, drawn(&all)), (2, all.lines));
    assert!(bytes(&all) < 40_000);
    let few = shown(&text, &Drawing { most: Some(20), ..Drawing::default() });
    assert!(drawn(&few) <= 20 && drawn(&few) > 0);
}

#[test]
fn nothing_a_network_needs_is_deleted_with_the_objects() {
    let Command::Delete(patterns) = structure::delete_objects() else { panic!("it deletes") };
    let is_deleted = |name: &str| {
        patterns.iter().any(|pattern| match pattern {
            NamePattern::Prefix(prefix) => name.starts_with(prefix.as_str()),
            NamePattern::Name(other) => other.as_str() == name,
        })
    };
    let names = |command: &Command| match command {
        Command::Define { name: Some(name), .. } => Some(name.to_string()),
        _ => None,
    };
    let all = network::commands(1.0).into_iter().chain(network::detail()).chain(network::shading());
    let kept: Vec<String> = all.filter_map(|command| names(&command)).collect();
    assert!(kept.len() > 20 && kept.iter().all(|name| !is_deleted(name)), "{kept:?}");
    let shown = shown(FOREST, &Drawing { facets: true, ..Drawing::default() });
    let mut depth = 0;
    for command in &shown.commands {
        match command {
            Command::Define { name: Some(name), object } => {
                assert!(depth > 0 || name.as_str() == super::super::ROOT || is_deleted(name.as_str()), "{name}");
                depth += i32::from(*object == Node::BeginStructure);
            }
            Command::EndStructure => depth -= 1,
            _ => {}
        }
    }
}

#[test]
fn a_surface_without_room_and_an_empty_list_of_places_draw_nothing() {
    let text = "instances(cube(1), []); scatter(cube(1), ground(5), #{ count: 10, height: [3, 4] });";
    let shown = shown(text, &Drawing::default());
    assert_eq!(shown.instances, Some(DrawnInstances::default()));
    assert_eq!(shown.instances.expect("it has").describe(), "0 of 0 instances drawn");
}

#[test]
fn a_varied_paint_has_its_color_at_each_instance_and_other_paints_have_theirs() {
    let text = "let a = [cube(1).material([0, 1, 0]), cube(2).material(varied([1, 0, 0], [0, 0, 1]))];
        instances(a, [#{ at: [0, 0, 0], variation: 0 }, #{ at: [2, 0, 0], variation: 1 }]);";
    let shown = shown(text, &Drawing::default());
    let (mut within, mut hues) = (String::new(), Vec::new());
    for command in &shown.commands {
        match command {
            Command::Define { name: Some(name), object: Node::BeginStructure } => within = name.to_string(),
            Command::Define { object: Node::Operate { operate: Operate::SetColor { hue, .. }, .. }, .. } => {
                hues.push((within.clone(), *hue));
            }
            _ => {}
        }
    }
    let of = |structure: &str| -> Vec<f64> {
        hues.iter().filter(|(within, _)| within == structure).map(|(_, hue)| *hue).collect()
    };
    let mut at_instances = of("O1");
    at_instances.sort_by(f64::total_cmp);
    assert_eq!(at_instances, [0.0, 120.0], "blue and red");
    assert_eq!(of("PERIS_I1_0"), [240.0], "green");
}
