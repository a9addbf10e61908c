//! Tests of the walk and of the pipeline behind it.

mod attributes;
mod picking;

use super::*;
use crate::{
    matrices,
    port::ObjectId,
    structure::{Member, Node, Operation, Structures},
};
use glam::{DMat3, DMat4, DVec2, DVec3};
use protocol::command::{Axis, Characters, VectorClass, VectorList};
use std::collections::BTreeSet;

fn list(class: VectorClass, points: &[[f32; 3]]) -> Node {
    let list = VectorList {
        block_normalized: false,
        fourth: protocol::command::Fourth::Intensity,
        internal_units: false,
        class,
        dimension: 3,
        estimate: None,
        points: points.iter().map(|p| [p[0], p[1], p[2], 1.0]).collect(),
        lines: vec![true; if class == VectorClass::Itemized { points.len() } else { 0 }],
    };
    Node::Vectors(Box::new(list.into()))
}

fn operate(operation: Operation) -> Member {
    Member::Unnamed(Node::operate(operation, None))
}

/// The strokes of a group of operations over one node.
fn draw(operations: &[Operation], data: Node) -> Vec<Stroke> {
    let mut members: Vec<Member> = operations.iter().cloned().map(operate).collect();
    members.push(Member::Unnamed(data));
    let mut structures = Structures::default();
    structures.define(ObjectId::new(0), Node::Group(members));
    structures.display(ObjectId::new(0));
    update(&structures, 0, &Requests::default()).strokes
}

/// Where a dot at `p` appears.
fn dot(operations: &[Operation], p: [f32; 3]) -> Option<[f32; 2]> {
    draw(operations, list(VectorClass::Dots, &[p])).first().map(|s| s.start)
}

fn near(a: [f32; 2], b: [f32; 2]) {
    assert!((a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6, "{a:?} is not {b:?}");
}

fn fov(angle: f64, front: f64, back: f64) -> Operation {
    Operation::Projective(matrices::field_of_view(angle, [front, back]).unwrap())
}

#[test]
fn the_node_nearest_the_data_acts_first() {
    let turn = Operation::Linear(matrices::rotation(Axis::Z, 90.0));
    let shift = Operation::Translate(DVec3::new(0.5, 0.0, 0.0));
    near(dot(&[turn.clone(), shift.clone()], [0.0; 3]).unwrap(), [0.0, 0.5]);
    near(dot(&[shift, turn], [0.0; 3]).unwrap(), [0.5, 0.0]);
}

#[test]
fn perspective_divides_by_the_distance_along_z() {
    // 90 degrees: at depth z the window is -z..z.
    let view = [fov(90.0, 1.0, 10.0)];
    near(dot(&view, [1.0, -1.0, 2.0]).unwrap(), [0.5, -0.5]);
    assert_eq!(dot(&view, [0.0, 0.0, -2.0]), None, "behind the eye");
    assert_eq!(dot(&view, [0.0, 0.0, 0.0]), None, "at the eye");
}

#[test]
fn lines_end_at_the_window() {
    let strokes = draw(&[], list(VectorClass::Connected, &[[0.0, 0.0, 0.0], [4.0, 2.0, 0.0]]));
    assert_eq!(strokes.len(), 1);
    near(strokes[0].start, [0.0, 0.0]);
    near(strokes[0].end, [1.0, 0.5]);
    let outside = draw(&[], list(VectorClass::Connected, &[[2.0, -3.0, 0.0], [3.0, 2.0, 0.0]]));
    assert!(outside.is_empty());
}

#[test]
fn a_line_through_the_plane_of_the_eye_keeps_its_visible_part() {
    let strokes = draw(&[fov(90.0, 1.0, 10.0)], list(VectorClass::Connected, &[[0.5, 0.0, 5.0], [0.5, 0.0, -5.0]]));
    assert_eq!(strokes.len(), 1);
    near(strokes[0].start, [0.1, 0.0]);
    near(strokes[0].end, [1.0, 0.0]);
}

#[test]
fn front_and_back_clip_only_when_told() {
    let data = || list(VectorClass::Connected, &[[0.0, 0.0, 0.5], [0.0, 0.0, 20.0]]);
    let view = fov(90.0, 1.0, 10.0);
    let open = draw(std::slice::from_ref(&view), data());
    let clipped = draw(&[Operation::DepthClipping(true), view], data());
    assert_eq!(open[0].intensity, [1.0, 0.0], "depth is clamped for the cue");
    assert_eq!(clipped.len(), 1);
    assert!((clipped[0].intensity[0] - 1.0).abs() < 1e-6 && clipped[0].intensity[1] < 1e-6);
}

#[test]
fn intensity_runs_from_front_to_back() {
    let viewport = Operation::Viewport { horizontal: [-1.0, 1.0], vertical: [-1.0, 1.0], intensity: Some([0.2, 0.8]) };
    let window = Operation::Projective(matrices::window([-1.0, 1.0], [-1.0, 1.0], [0.0, 4.0]).unwrap());
    let data = list(VectorClass::Connected, &[[0.0, 0.0, 0.0], [0.5, 0.0, 2.0]]);
    let strokes = draw(&[viewport.clone(), window.clone()], data.clone());
    assert!((strokes[0].intensity[0] - 0.8).abs() < 1e-6 && (strokes[0].intensity[1] - 0.5).abs() < 1e-6);
    let over = Operation::Intensity { on: true, range: [1.0, 1.0] };
    assert_eq!(draw(&[viewport, over, window], data)[0].intensity, [1.0, 1.0]);
}

#[test]
fn viewports_nest() {
    let half = Operation::Viewport { horizontal: [0.0, 1.0], vertical: [-1.0, 0.0], intensity: None };
    near(dot(std::slice::from_ref(&half), [1.0, 1.0, 0.0]).unwrap(), [1.0, 0.0]);
    near(dot(&[half.clone(), half], [-1.0, 1.0, 0.0]).unwrap(), [0.5, -0.5]);
}

#[test]
fn a_matrix_with_w_0_draws_nothing() {
    let flat = DMat4::from_diagonal(glam::DVec4::new(1.0, 1.0, 1.0, 0.0));
    let data = list(VectorClass::Connected, &[[0.0, 0.0, 0.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0]]);
    assert!(draw(&[Operation::Projective(flat)], data.clone()).is_empty());
    assert!(draw(&[Operation::Projective(DMat4::ZERO)], data).is_empty());
}

#[test]
fn extreme_boundaries_keep_x_and_y() {
    for [front, back] in [[1e-15, 1e15], [1e-7, 1e7], [1e-15, 1e-14]] {
        let window = Operation::Projective(matrices::window([-2.0, 2.0], [-2.0, 2.0], [front, back]).unwrap());
        near(dot(&[window], [1.0, -0.5, 3.0]).unwrap(), [0.5, -0.25]);
        near(dot(&[fov(90.0, front, back)], [1.0, -0.5, 4.0]).unwrap(), [0.25, -0.125]);
    }
    let tiny = Operation::Projective(matrices::window([-1e-15, 1e-15], [-1e-15, 1e-15], [0.0, 1.0]).unwrap());
    near(dot(&[tiny], [5e-16, -5e-16, 0.0]).unwrap(), [0.5, -0.5]);
    let huge = Operation::Projective(matrices::window([-1e15, 1e15], [-1e15, 1e15], [0.0, 1.0]).unwrap());
    near(dot(&[huge], [5e14, -5e14, 0.0]).unwrap(), [0.5, -0.5]);
}

#[test]
fn a_vector_of_no_length_is_a_dot() {
    let strokes = draw(&[], list(VectorClass::Connected, &[[0.25, 0.0, 0.0], [0.25, 0.0, 0.0]]));
    assert_eq!(strokes.len(), 1);
    assert!(strokes[0].is_dot());
}

#[test]
fn points_that_are_no_numbers_after_the_matrix_are_left_out() {
    let wild = Operation::Linear(DMat3::from_diagonal(DVec3::splat(f64::MAX)));
    let strokes = draw(&[wild], list(VectorClass::Connected, &[[1e30, 0.0, 0.0], [-1e30, 1e30, 0.0], [0.0; 3]]));
    assert!(strokes.iter().all(|s| s.start.iter().chain(&s.end).all(|c| c.is_finite())));
}

#[test]
fn the_classes_join_points_in_their_ways() {
    let points = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]];
    assert_eq!(draw(&[], list(VectorClass::Connected, &points)).len(), 3);
    assert_eq!(draw(&[], list(VectorClass::Separate, &points)).len(), 2);
    assert_eq!(draw(&[], list(VectorClass::Dots, &points)).len(), 4);
    assert_eq!(draw(&[], list(VectorClass::Itemized, &points)).len(), 3, "the first is forced to be a position");
}

#[test]
fn a_long_list_is_drawn_in_the_order_of_its_points() {
    let points: Vec<[f32; 3]> = (0..100_000).map(|i| [(i % 997) as f32 / 997.0, (i % 89) as f32 / 89.0, 0.0]).collect();
    let strokes = draw(&[], list(VectorClass::Connected, &points));
    assert_eq!(strokes.len(), points.len() - 1);
    for (stroke, ends) in strokes.iter().zip(points.windows(2)) {
        near(stroke.start, [ends[0][0], ends[0][1]]);
        near(stroke.end, [ends[1][0], ends[1][1]]);
    }
}

#[test]
fn an_object_included_twice_is_drawn_twice() {
    let mut structures = Structures::default();
    let [frame, line] = [ObjectId::new(0), ObjectId::new(1)];
    structures.define(line, list(VectorClass::Connected, &[[0.0; 3], [0.5; 3]]));
    assert!(structures.include(line, frame) && structures.include(line, frame));
    structures.display(frame);
    assert_eq!(update(&structures, 0, &Requests::default()).strokes.len(), 2);
    assert!(structures.exclude(line, frame));
    assert_eq!(update(&structures, 0, &Requests::default()).strokes.len(), 1);
}

#[test]
fn a_structure_that_contains_itself_ends() {
    let mut structures = Structures::default();
    let id = ObjectId::new(0);
    structures.define(id, Node::Instance(vec![id]));
    structures.display(id);
    assert_eq!(update(&structures, 0, &Requests::default()).fault, Some(UpdateFault::ContainsItself(id)));
}

#[test]
fn instances_of_instances_of_instances_end() {
    let mut structures = Structures::default();
    for i in 1..64 {
        structures.define(ObjectId::new(i), Node::Instance(vec![ObjectId::new(i - 1); 2]));
    }
    structures.define(ObjectId::new(0), Node::Nil);
    structures.display(ObjectId::new(63));
    assert_eq!(update(&structures, 0, &Requests::default()).fault, Some(UpdateFault::TooManyVisits));
}

#[test]
fn an_operate_node_with_a_descendant_spares_its_siblings() {
    let mut structures = Structures::default();
    let [group, below] = [ObjectId::new(0), ObjectId::new(1)];
    let data = list(VectorClass::Dots, &[[0.0; 3]]);
    structures.define(below, data.clone());
    let shift = Operation::Translate(DVec3::new(0.5, 0.0, 0.0));
    let members = vec![Member::Unnamed(Node::operate(shift, Some(below))), Member::Unnamed(data)];
    structures.define(group, Node::Group(members));
    structures.display(group);
    let strokes = update(&structures, 0, &Requests::default()).strokes;
    near(strokes[0].start, [0.5, 0.0]);
    near(strokes[1].start, [0.0, 0.0]);
}

#[test]
fn the_matrix_of_an_xform_node_is_the_product_of_what_is_above() {
    let mut structures = Structures::default();
    let [group, node] = [ObjectId::new(0), ObjectId::new(1)];
    structures.define(node, Node::operate(Operation::XformMatrix, None));
    let turn = Operation::Linear(matrices::rotation(Axis::Y, 30.0));
    let members = vec![operate(fov(60.0, 1.0, 9.0)), operate(turn), Member::Named(node)];
    structures.define(group, Node::Group(members));
    structures.display(group);
    let expected =
        matrices::field_of_view(60.0, [1.0, 9.0]).unwrap() * DMat4::from_mat3(matrices::rotation(Axis::Y, 30.0));
    let found = update(&structures, 0, &Requests { transforms: BTreeSet::from([node]), ..Requests::default() })
        .transforms[&node];
    assert!(found.abs_diff_eq(expected, 1e-15));
}

#[test]
fn text_stands_on_its_lower_left_corner_and_follows_the_character_matrix() {
    let text = |scale: f64| {
        let characters = Characters { position: DVec3::new(-0.5, -0.5, 0.0), step: DVec2::X, text: (*b"HI").into() };
        let small = Operation::Character(glam::DMat2::from_diagonal(DVec2::splat(scale)));
        draw(&[small], Node::Characters(Box::new(characters)))
    };
    let strokes = text(0.1);
    assert!(!strokes.is_empty());
    let xs = strokes.iter().flat_map(|s| [s.start[0], s.end[0]]);
    let (low, high) = xs.fold((f32::MAX, f32::MIN), |(l, h), x| (l.min(x), h.max(x)));
    assert!(low >= -0.5 && high <= -0.3 + 1e-6, "two cells of 0.1: {low} to {high}");
    assert_eq!(strokes.len(), text(0.2).len());
}

#[test]
fn text_under_instances_of_instances_ends() {
    let mut structures = Structures::default();
    let characters = Characters { position: DVec3::ZERO, step: DVec2::X, text: vec![b'#'; 60_000].into() };
    structures.define(ObjectId::new(0), Node::Characters(Box::new(characters)));
    for i in 1..4 {
        structures.define(ObjectId::new(i), Node::Instance(vec![ObjectId::new(i - 1); 100]));
    }
    structures.display(ObjectId::new(3));
    assert_eq!(update(&structures, 0, &Requests::default()).fault, Some(UpdateFault::TooManyVectors));
}

/// A text and lists of 1 to 300,000 vectors, the second on screen 1 only.
fn crowd() -> Structures {
    let mut structures = Structures::default();
    let long = |count: u32| {
        let points: Vec<[f32; 3]> =
            (0..count).map(|i| [(i % 997) as f32 / 997.0, (i % 13) as f32 / 13.0, 0.0]).collect();
        list(VectorClass::Connected, &points)
    };
    let text = Characters { position: DVec3::ZERO, step: DVec2::X, text: (*b"TEXT").into() };
    let members = vec![
        Member::Unnamed(long(2)),
        operate(Operation::Displays { scopes: 0b1101, on: false }),
        Member::Unnamed(long(5_000)),
        operate(Operation::Displays { scopes: 0b1111, on: true }),
        Member::Unnamed(Node::Characters(Box::new(text))),
        Member::Unnamed(long(300_000)),
    ];
    structures.define(ObjectId::new(0), Node::Group(members));
    structures.display(ObjectId::new(0));
    structures
}

#[test]
fn parts_are_together_what_a_screen_shows() {
    let structures = crowd();
    let whole = update(&structures, 0, &Requests::default());
    assert!(whole.strokes.len() > 305_000 && !whole.is_counted_only);
    for screen in 0..4 {
        let (mut parts, mut strokes) = (0, Vec::new());
        draw_in_parts(&structures, 0, screen, &mut |part| {
            parts += 1;
            strokes.extend_from_slice(part);
        });
        let shown: Vec<Stroke> = whole.on_screen(screen).copied().collect();
        assert!(strokes == shown, "screen {screen}: {} and {}", strokes.len(), shown.len());
        assert!(parts > 2, "{parts}");
    }
}

#[test]
fn a_picture_of_too_many_vectors_is_counted_and_answers_requests() {
    let structures = crowd();
    let whole = update(&structures, 0, &Requests::default());
    let counted = update_into(&structures, 0, &Requests::default(), Vec::new(), 100_000);
    assert!(counted.is_counted_only && counted.strokes.is_empty() && counted.scopes.is_empty());
    assert_eq!(counted.vectors, whole.vectors);
    assert_eq!(counted.visits, whole.visits);
    let enough = update_into(&structures, 0, &Requests::default(), Vec::new(), whole.vectors);
    assert!(!enough.is_counted_only && enough.strokes == whole.strokes);
}
