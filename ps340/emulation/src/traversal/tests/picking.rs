//! Tests of picking, of transformed vectors and of what is written back.

use super::*;
use glam::DVec2;
use protocol::{Name, command::VectorClass};

fn identifier(name: &str) -> Member {
    operate(Operation::PickIdentifier(Name::new(name).unwrap()))
}

fn pickable(members: Vec<Member>) -> Structures {
    let mut structures = Structures::default();
    let mut all = vec![operate(Operation::Picking(true))];
    all.extend(members);
    structures.define(ObjectId::new(0), Node::Group(all));
    structures.display(ObjectId::new(0));
    structures
}

fn pick(structures: &Structures, x: f64, y: f64) -> Option<PickHit> {
    let request = PickRequest { center: DVec2::new(x, y), half_size: DVec2::splat(0.01), coordinates: true };
    update(structures, 0, &Requests { pick: Some(request), ..Requests::default() }).picked
}

fn path() -> Node {
    list(VectorClass::Connected, &[[-0.5, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.5, 0.0]])
}

#[test]
fn the_first_vector_in_the_box_is_picked_with_its_identifiers_nearest_first() {
    let structures = pickable(vec![identifier("OUTER"), identifier("INNER"), Member::Unnamed(path())]);
    let hit = pick(&structures, 0.005, 0.3).unwrap();
    assert_eq!(hit.index, 3);
    assert_eq!(hit.identifiers.iter().map(Name::as_str).collect::<Vec<_>>(), ["INNER", "OUTER"]);
    assert_eq!(hit.kind, PickedKind::Vectors);
    let place = hit.coordinates.unwrap();
    assert!(place.point.abs_diff_eq(DVec3::new(0.0, 0.3, 0.0), 1e-12), "{place:?}");
    assert_eq!(pick(&structures, 0.0, 0.0).map(|hit| hit.index), Some(2), "both meet there: the first drawn");
    assert_eq!(pick(&structures, 0.2, 0.2), None);
}

#[test]
fn nothing_is_picked_without_picking_or_without_an_identifier() {
    let mut off = pickable(vec![identifier("A"), operate(Operation::Picking(false)), Member::Unnamed(path())]);
    assert_eq!(pick(&off, 0.0, 0.3), None);
    off = pickable(vec![Member::Unnamed(path())]);
    assert_eq!(pick(&off, 0.0, 0.3), None);
}

#[test]
fn what_is_not_seen_is_not_picked() {
    let window = matrices::window([-1.0, 1.0], [-1.0, 1.0], [0.0, 1.0]).unwrap();
    let far = operate(Operation::Translate(DVec3::new(0.0, 0.0, 2.0)));
    for clipping in [false, true] {
        let structures = pickable(vec![
            identifier("A"),
            operate(Operation::DepthClipping(clipping)),
            operate(Operation::Projective(window)),
            far.clone(),
            Member::Unnamed(path()),
        ]);
        assert_eq!(pick(&structures, 0.0, 0.3).is_some(), !clipping);
    }
    let behind = pickable(vec![
        identifier("A"),
        operate(fov(90.0, 1.0, 10.0)),
        operate(Operation::Translate(DVec3::new(0.0, 0.0, -2.0))),
        Member::Unnamed(path()),
    ]);
    assert_eq!(pick(&behind, 0.0, -0.15), None);
}

#[test]
fn the_picked_point_is_right_in_perspective_and_in_a_viewport() {
    // A line from (0, 0) at depth 1 to (2, 0) at depth 4: at parameter t it is seen at x = 2t / (1 + 3t).
    let data = list(VectorClass::Connected, &[[0.0, 0.0, 1.0], [2.0, 0.0, 4.0]]);
    let viewport = Operation::Viewport { horizontal: [0.0, 1.0], vertical: [0.0, 1.0], intensity: None };
    let structures =
        pickable(vec![identifier("A"), operate(viewport), operate(fov(90.0, 0.5, 10.0)), Member::Unnamed(data)]);
    let t = 0.4;
    let seen = 2.0 * t / (1.0 + 3.0 * t);
    let place = pick(&structures, 0.5 + seen / 2.0, 0.5).unwrap().coordinates.unwrap();
    assert!(place.point.abs_diff_eq(DVec3::new(2.0 * t, 0.0, 1.0 + 3.0 * t), 1e-6), "{place:?}");
}

#[test]
fn the_pick_box_of_the_structure_has_precedence() {
    let structures = pickable(vec![
        identifier("A"),
        operate(Operation::PickLocation { center: DVec2::new(0.0, 0.3), size: DVec2::splat(0.02) }),
        Member::Unnamed(path()),
    ]);
    assert!(pick(&structures, 0.9, 0.9).is_some());
}

#[test]
fn a_curve_tells_its_parameter() {
    let mut node = path();
    if let Node::Vectors(vectors) = &mut node {
        vectors.parameters = Some([10.0, 20.0]);
    }
    let hit = pick(&pickable(vec![identifier("A"), Member::Unnamed(node)]), 0.0, 0.25).unwrap();
    assert_eq!(hit.kind, PickedKind::Curve);
    assert!((hit.coordinates.unwrap().parameter.unwrap() - 17.5).abs() < 1e-9);
}

#[test]
fn a_character_is_picked_by_its_number() {
    let text = Characters { position: DVec3::ZERO, step: DVec2::X, text: (*b"HHH").into() };
    let structures = pickable(vec![
        identifier("A"),
        operate(Operation::TextSize(0.1)),
        Member::Unnamed(Node::Characters(Box::new(text))),
    ]);
    let left = 0.1 + 0.1 / 20.0;
    assert_eq!(pick(&structures, left, 0.02).map(|hit| (hit.index, hit.kind)), Some((2, PickedKind::Characters)));
}

#[test]
fn the_node_of_the_data_is_told() {
    let data = ObjectId::new(1);
    let mut structures = pickable(vec![identifier("A"), Member::Included(data)]);
    structures.define(data, path());
    assert_eq!(pick(&structures, 0.0, 0.3).unwrap().node, Some(data));
}

#[test]
fn xform_vector_gathers_the_vectors_below_and_cancel_excludes() {
    let [group, node] = [ObjectId::new(0), ObjectId::new(1)];
    let mut structures = Structures::default();
    structures.define(node, Node::operate(Operation::XformVector, None));
    structures.define(
        group,
        Node::Group(vec![
            operate(fov(90.0, 1.0, 10.0)),
            Member::Unnamed(path()),
            Member::Named(node),
            operate(Operation::Translate(DVec3::new(0.0, 0.0, 2.0))),
            Member::Unnamed(path()),
            operate(Operation::CancelXform),
            Member::Unnamed(path()),
        ]),
    );
    structures.display(group);
    let requests = Requests { transforms: BTreeSet::from([node]), ..Requests::default() };
    let found = &update(&structures, 0, &requests).transformed[&node];
    assert_eq!(found.lines, [false, true, true]);
    assert!(found.points[2].truncate().abs_diff_eq(DVec2::new(0.0, 0.25), 1e-12));
    assert!(update(&structures, 0, &Requests::default()).transformed.is_empty());
}

#[test]
fn only_what_is_below_a_wanted_node_is_written_back() {
    let [group, node] = [ObjectId::new(0), ObjectId::new(1)];
    let mut structures = Structures::default();
    structures.define(node, Node::operate(Operation::WriteBack, None));
    let data = || Member::Unnamed(path());
    structures.define(group, Node::Group(vec![data(), Member::Named(node), data(), data()]));
    structures.display(group);
    let requests = Requests { write_back: BTreeSet::from([node]), ..Requests::default() };
    assert_eq!(update(&structures, 0, &requests).write_back, std::slice::from_ref(&(2..6)));
}
