//! Tests of the nodes as message sinks.

use super::*;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};
use protocol::{
    Kind,
    command::{Characters, VectorClass, VectorList},
};

const ID: ObjectId = ObjectId::new(7);

fn operate(operation: Operation) -> Structures {
    let mut structures = Structures::default();
    structures.define(ID, Node::Operate { operation, descendant: None });
    structures
}

fn send(structures: &mut Structures, input: u32, value: Value) -> Result<(), NodeFault> {
    structures.accept(ID, Input::Number(input), value)
}

fn vectors(class: VectorClass, count: usize) -> Structures {
    let mut structures = Structures::default();
    let list = VectorList {
        block_normalized: false,
        fourth: protocol::command::Fourth::Intensity,
        internal_units: false,
        class,
        dimension: 3,
        estimate: None,
        points: vec![[0.0, 0.0, 0.0, 1.0]; count],
        lines: Vec::new(),
    };
    structures.define(ID, Node::Vectors(Box::new(list.into())));
    structures
}

fn the_list(structures: &Structures) -> &VectorList {
    match structures.node(ID) {
        Some(Node::Vectors(vectors)) => &vectors.list,
        other => panic!("no vector list: {other:?}"),
    }
}

#[test]
fn a_rotation_takes_a_3x3_matrix_and_nothing_else() {
    let mut structures = operate(Operation::Linear(DMat3::IDENTITY));
    let m = DMat3::from_diagonal(DVec3::splat(2.0));
    assert_eq!(send(&mut structures, 1, Value::Matrix3(Box::new(m))), Ok(()));
    let node = structures.node(ID).cloned();
    let fault = send(&mut structures, 1, Value::Real(1.0));
    assert_eq!(fault, Err(NodeFault::Kind { input: Input::Number(1), kind: Kind::Real }));
    let fault = send(&mut structures, 2, Value::Matrix3(Box::new(m)));
    assert_eq!(fault, Err(NodeFault::NoSuchInput { input: Input::Number(2) }));
    assert_eq!(structures.node(ID).cloned(), node, "a refused message changes nothing");
}

#[test]
fn the_viewport_takes_a_3x3_matrix_of_its_limits() {
    let before = Operation::Viewport { horizontal: [-1.0, 1.0], vertical: [-1.0, 1.0], intensity: None };
    let mut structures = operate(before);
    let rows = DMat3::from_cols(DVec3::new(-0.5, 0.5, 0.0), DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.1, 0.9, 0.0));
    send(&mut structures, 1, Value::Matrix3(Box::new(rows))).unwrap();
    let after = Operation::Viewport { horizontal: [-0.5, 0.5], vertical: [0.0, 1.0], intensity: Some([0.1, 0.9]) };
    assert_eq!(structures.node(ID), Some(&Node::Operate { operation: after, descendant: None }));
}

#[test]
fn window_look_and_clipping_take_what_the_clients_send() {
    let cases = [
        (Operation::Projective(DMat4::IDENTITY), Value::Matrix4(Box::new(DMat4::ZERO))),
        (Operation::Affine(DMat4::IDENTITY), Value::Matrix4x3(Box::new(DMat4::IDENTITY))),
        (Operation::DepthClipping(false), Value::Boolean(true)),
        (Operation::Translate(DVec3::ZERO), Value::Vector3(DVec3::X)),
        (Operation::Translate(DVec3::ZERO), Value::Vector2(DVec2::X)),
        (Operation::Color { hue: 0.0, saturation: 0.0 }, Value::Real(120.0)),
        (Operation::Intensity { on: true, range: [0.0, 1.0] }, Value::Boolean(false)),
    ];
    for (operation, value) in cases {
        let what = format!("{operation:?}");
        assert_eq!(send(&mut operate(operation), 1, value), Ok(()), "{what}");
    }
}

#[test]
fn numbers_that_are_not_finite_stay_out() {
    let mut structures = operate(Operation::Translate(DVec3::ZERO));
    let fault = send(&mut structures, 1, Value::Vector3(DVec3::NAN));
    assert_eq!(fault, Err(NodeFault::Range { input: Input::Number(1) }));
    let mut structures = vectors(VectorClass::Connected, 2);
    let fault = send(&mut structures, 1, Value::Vector3(DVec3::splat(1e300)));
    assert_eq!(fault, Err(NodeFault::Range { input: Input::Number(1) }));
}

#[test]
fn a_vector_list_is_edited_by_index_append_delete_and_clear() {
    let mut structures = vectors(VectorClass::Connected, 2);
    send(&mut structures, 2, Value::Vector4(DVec4::new(1.0, 2.0, 3.0, 0.5))).unwrap();
    assert_eq!(the_list(&structures).points[1], [1.0, 2.0, 3.0, 0.5]);
    structures.accept(ID, Input::Append, Value::Vector2(DVec2::new(4.0, 5.0))).unwrap();
    structures.accept(ID, Input::Last, Value::Boolean(false)).unwrap();
    let list = the_list(&structures);
    assert_eq!((list.class, list.lines.as_slice()), (VectorClass::Itemized, &[false, true, false][..]));
    let fault = send(&mut structures, 4, Value::Vector3(DVec3::ZERO));
    assert_eq!(fault, Err(NodeFault::Range { input: Input::Number(4) }));
    structures.accept(ID, Input::Delete, Value::Integer(2)).unwrap();
    assert_eq!((the_list(&structures).points.len(), the_list(&structures).lines.len()), (1, 1));
    structures.accept(ID, Input::Clear, Value::Boolean(true)).unwrap();
    assert!(the_list(&structures).points.is_empty());
    assert_eq!(structures.bytes(), Structures::default().bytes() + structures.node(ID).map_or(0, Node::bytes));
}

#[test]
fn characters_are_edited_in_place() {
    let mut structures = Structures::default();
    let characters = Characters { position: DVec3::ZERO, step: DVec2::X, text: (*b"HELLO").into() };
    structures.define(ID, Node::Characters(Box::new(characters)));
    let text = |structures: &Structures| match structures.node(ID) {
        Some(Node::Characters(c)) => String::from_utf8_lossy(&c.text).into_owned(),
        other => panic!("{other:?}"),
    };
    send(&mut structures, 2, Value::string("AR")).unwrap();
    assert_eq!(text(&structures), "HARLO");
    send(&mut structures, 6, Value::string("!!")).unwrap();
    assert_eq!(text(&structures), "HARLO!!");
    structures.accept(ID, Input::Delete, Value::Integer(4)).unwrap();
    structures.accept(ID, Input::Append, Value::string("D")).unwrap();
    assert_eq!(text(&structures), "HARD");
    structures.accept(ID, Input::Substitute, Value::string("X")).unwrap();
    structures.accept(ID, Input::Step, Value::Vector2(DVec2::Y)).unwrap();
    assert_eq!(text(&structures), "X");
    assert!(send(&mut structures, 9, Value::string("A")).is_err());
    assert_eq!(text(&structures), "X");
}

#[test]
fn the_account_of_memory_follows_what_is_there() {
    let mut structures = vectors(VectorClass::Connected, 1000);
    assert!(structures.bytes() >= 16_000);
    structures.undefine(ID);
    assert_eq!(structures.bytes(), 0);
}
