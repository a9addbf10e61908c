//! Tests of the nodes as message sinks.

use super::*;
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use proptest::{
    strategy::{Strategy, ValueTree},
    test_runner::TestRunner,
};
use protocol::{
    Kind,
    command::{Characters, OperateKind, VectorClass, VectorList},
};

const ID: ObjectId = ObjectId::new(7);

fn operate(operation: Operation) -> Structures {
    let mut structures = Structures::default();
    structures.define(ID, Node::operate(operation, None));
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
    assert_eq!(structures.node(ID), Some(&Node::operate(after, None)));
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

/// An operation that a kind of command makes of numbers at random, of which some make none.
fn some(kind: OperateKind) -> Option<Operation> {
    let mut runner = TestRunner::deterministic();
    let mut operates = std::iter::repeat_with(|| kind.any().new_tree(&mut runner).unwrap().current()).take(1000);
    operates.find_map(|operate| Operation::new(&operate, Some(ID), 0).ok())
}

/// One node of each kind, the operate nodes of each command.
fn every_node() -> Vec<Node> {
    use protocol::command::{Attributes, Fourth, Illumination, LabelText, Pattern, SurfaceColor};
    let commands =
        OperateKind::ALL.iter().map(|kind| some(*kind).unwrap_or_else(|| panic!("{kind:?} makes no operation")));
    let mut nodes: Vec<Node> = commands.map(|operation| Node::operate(operation, None)).collect();
    let list = |class, lines: &[bool]| VectorList {
        block_normalized: false,
        fourth: Fourth::Intensity,
        internal_units: false,
        class,
        dimension: 3,
        estimate: None,
        points: vec![[0.0, 0.0, 0.0, 1.0]; 3],
        lines: lines.to_vec(),
    };
    let label = LabelText { position: DVec3::ZERO, text: (*b"A").into() };
    let front = SurfaceColor::default();
    nodes.extend([
        Node::Nil,
        Node::Instance(vec![]),
        Node::Group(vec![]),
        Node::Vectors(Box::new(list(VectorClass::Connected, &[]).into())),
        Node::Vectors(Box::new(list(VectorClass::Dots, &[]).into())),
        Node::Vectors(Box::new(list(VectorClass::Separate, &[]).into())),
        Node::Vectors(Box::new(list(VectorClass::Itemized, &[false, true, true]).into())),
        Node::Characters(Box::new(Characters { position: DVec3::ZERO, step: DVec2::X, text: (*b"ABC").into() })),
        Node::Labels(Box::new(Labels { labels: vec![(label.clone(), true), (label, false)], step: DVec2::X })),
        Node::Illumination(Illumination { direction: DVec3::Z, color: [0.0; 3], ambient: 1.0 }),
        Node::Attributes(Attributes { front, back: None }),
        Node::Polygons(Box::new(Polygons { polygons: vec![], attributes: vec![] })),
        Node::Font(Box::default()),
        Node::Pattern(Pattern { segments: vec![1.0], around_corners: false, matched: false, length: 1.0 }),
        Node::RawBlock(vec![0; 4]),
        Node::Variable(None),
    ]);
    nodes
}

fn every_input() -> Vec<Input> {
    let mut inputs: Vec<Input> = [0, 1, 2, 3, 4, 5, 1000, u32::MAX].map(Input::Number).to_vec();
    inputs.extend(Input::WORDS.iter().map(|w| w.0));
    inputs
}

/// Values of every kind: ordinary ones and extreme ones, if `finite`, else with something that is not finite.
fn values(finite: bool) -> Vec<Value> {
    let numbers: &[f64] = if finite { &[0.0, 1.0, -3.0, 1e300] } else { &[f64::NAN, f64::INFINITY] };
    let mut values = Vec::new();
    for &x in numbers {
        values.extend([
            Value::Real(x),
            Value::Vector2(DVec2::new(1.0, x)),
            Value::Vector3(DVec3::new(1.0, x, 0.5)),
            Value::Vector4(DVec4::new(1.0, 2.0, 0.5, x)),
            Value::Matrix2(Box::new(DMat2::from_diagonal(DVec2::splat(x)))),
            Value::Matrix3(Box::new(DMat3::from_diagonal(DVec3::splat(x)))),
            Value::Matrix4x3(Box::new(DMat4::from_diagonal(DVec4::splat(x)))),
            Value::Matrix4(Box::new(DMat4::from_diagonal(DVec4::splat(x)))),
            Value::Transform(Box::new(DMat4::from_diagonal(DVec4::splat(x)))),
        ]);
    }
    if finite {
        values.extend([0, 1, 3, -1, i32::MAX, i32::MIN].map(Value::Integer));
        values.extend([true, false].map(Value::Boolean));
        values.extend([&b""[..], b"X", &[b'Y'; 70_000]].map(Value::string));
    }
    values
}

#[test]
fn a_refused_message_changes_nothing_and_an_accepted_one_is_accounted_for() {
    for node in every_node() {
        for input in every_input() {
            for value in values(true) {
                let what = format!("{:?} to {input} of {node:?}", value.kind());
                let mut structures = Structures::default();
                structures.define(ID, node.clone());
                let version = structures.version();
                match structures.accept(ID, input, value) {
                    Ok(()) => assert_eq!(structures.bytes(), structures.node(ID).map_or(0, Node::bytes), "{what}"),
                    Err(_) => {
                        assert_eq!(structures.node(ID), Some(&node), "{what}");
                        assert_eq!(structures.version(), version, "{what}");
                    }
                }
            }
        }
    }
}

#[test]
fn no_node_takes_a_number_that_is_not_finite() {
    for node in every_node() {
        for input in every_input() {
            for value in values(false) {
                let mut structures = Structures::default();
                structures.define(ID, node.clone());
                assert_eq!(structures.accept(ID, input, value), Err(NodeFault::Range { input }), "{node:?}");
            }
        }
    }
}

fn operation(structures: &Structures) -> &Operation {
    match structures.node(ID) {
        Some(Node::Operate { operation, .. }) => operation,
        other => panic!("no operate node: {other:?}"),
    }
}

#[test]
fn each_operate_node_takes_what_its_command_says() {
    use protocol::command::{Comparison, Rate};
    let (half, ones) = (DVec2::splat(0.5), DVec2::ONE);
    let rate = Rate { on: 2, off: 3, initial: true, delay: 0 };
    let old = Operation::Rate { rate, since: 5 };
    let place = |center, size| Operation::PickLocation { center, size };
    let displays = |on| Operation::Displays { scopes: 0b10, on };
    let level = |level| Operation::IfLevel { comparison: Comparison::Less, level };
    let render = |solid| Operation::Rendering { solid };
    let texture = |texture| Operation::LineTexture { around_corners: true, texture };
    let load = |horizontal, vertical| Operation::LoadViewport { horizontal, vertical, intensity: Some([0.1, 0.9]) };
    let limits = Value::Matrix2(Box::new(DMat2::from_cols_array(&[-0.5, 0.5, 0.0, 1.0])));
    let cases = vec![
        (load([-1.0, 1.0], [-1.0, 1.0]), 1, limits, load([-0.5, 0.5], [0.0, 1.0])),
        (Operation::TextSize(1.0), 1, Value::Real(2.5), Operation::TextSize(2.5)),
        (
            Operation::TextSize(1.0),
            1,
            Value::Matrix2(Box::new(DMat2::from_diagonal(DVec2::splat(3.0)))),
            Operation::TextSize(3.0),
        ),
        (Operation::ColorBlending(0.0), 1, Value::Real(2.0), Operation::ColorBlending(1.0)),
        (Operation::Contrast(1.0), 1, Value::Integer(0), Operation::Contrast(0.0)),
        (Operation::Csm(false), 1, Value::Boolean(true), Operation::Csm(true)),
        (displays(false), 1, Value::Boolean(true), displays(true)),
        (Operation::Picking(false), 1, Value::Boolean(true), Operation::Picking(true)),
        (place(ones, ones), 1, Value::Vector2(half), place(half, ones)),
        (place(ones, ones), 2, Value::Vector2(-half), place(ones, half)),
        (Operation::LevelOfDetail(7), 1, Value::Integer(-1), Operation::LevelOfDetail(0)),
        (Operation::LevelOfDetail(7), 1, Value::Integer(40_000), Operation::LevelOfDetail(32_767)),
        (level(7), 1, Value::Integer(9), level(9)),
        (
            Operation::ConditionalBit { bit: 3, on: false },
            1,
            Value::Boolean(true),
            Operation::ConditionalBit { bit: 3, on: true },
        ),
        (old.clone(), 1, Value::Integer(9), Operation::Rate { rate: Rate { on: 9, ..rate }, since: 5 }),
        (old.clone(), 2, Value::Integer(9), Operation::Rate { rate: Rate { off: 9, ..rate }, since: 5 }),
        (old.clone(), 3, Value::Boolean(false), Operation::Rate { rate: Rate { initial: false, ..rate }, since: 40 }),
        (old, 4, Value::Integer(9), Operation::Rate { rate: Rate { delay: 9, ..rate }, since: 40 }),
        (Operation::ExternalRate(true), 1, Value::Boolean(false), Operation::ExternalRate(false)),
        (Operation::Blinking(false), 1, Value::Boolean(true), Operation::Blinking(true)),
        (Operation::BlinkRate(9), 1, Value::Integer(0), Operation::BlinkRate(1)),
        (Operation::Plotter(false), 1, Value::Boolean(true), Operation::Plotter(true)),
        (Operation::Priority(0), 1, Value::Integer(-4), Operation::Priority(-4)),
        (texture(0), 1, Value::Integer(3), texture(3)),
        (render(false), 2, Value::Boolean(true), render(true)),
    ];
    for (before, input, value, after) in cases {
        let what = format!("{before:?}");
        let mut structures = operate(before);
        structures.set_frame(40);
        assert_eq!(send(&mut structures, input, value), Ok(()), "{what}");
        assert_eq!(operation(&structures), &after, "{what}");
    }
}

#[test]
fn labels_are_moved_written_shown_and_hidden_one_by_one() {
    let mut structures = Structures::default();
    let label = |text: &[u8]| (protocol::command::LabelText { position: DVec3::ZERO, text: text.into() }, true);
    let block = Labels { labels: vec![label(b"A"), label(b"B")], step: DVec2::X };
    structures.define(ID, Node::Labels(Box::new(block)));
    send(&mut structures, 1, Value::string("ONE")).unwrap();
    send(&mut structures, 1, Value::Vector2(DVec2::Y)).unwrap();
    send(&mut structures, 2, Value::Boolean(false)).unwrap();
    structures.accept(ID, Input::Append, Value::Vector3(DVec3::Z)).unwrap();
    structures.accept(ID, Input::Last, Value::string("C")).unwrap();
    structures.accept(ID, Input::Step, Value::Vector2(DVec2::NEG_Y)).unwrap();
    assert!(send(&mut structures, 4, Value::string("D")).is_err());
    let Some(Node::Labels(block)) = structures.node(ID) else { panic!() };
    let shown: Vec<(&[u8], DVec3, bool)> = block.labels.iter().map(|(l, on)| (&l.text[..], l.position, *on)).collect();
    assert_eq!(shown, [(&b"ONE"[..], DVec3::Y, true), (b"B", DVec3::ZERO, false), (b"C", DVec3::Z, true)]);
    assert_eq!(block.step, DVec2::NEG_Y);
    structures.accept(ID, Input::Delete, Value::Integer(2)).unwrap();
    let Some(Node::Labels(block)) = structures.node(ID) else { panic!() };
    assert_eq!(block.labels.len(), 1);
}

#[test]
fn a_light_is_turned_coloured_and_dimmed() {
    use protocol::command::Illumination;
    let mut structures = Structures::default();
    structures.define(ID, Node::Illumination(Illumination { direction: DVec3::Z, color: [0.0; 3], ambient: 1.0 }));
    send(&mut structures, 1, Value::Vector3(DVec3::X)).unwrap();
    send(&mut structures, 2, Value::Vector3(DVec3::new(120.0, 2.0, 0.5))).unwrap();
    send(&mut structures, 3, Value::Real(-1.0)).unwrap();
    let after = Illumination { direction: DVec3::X, color: [120.0, 1.0, 0.5], ambient: 0.0 };
    assert_eq!(structures.node(ID), Some(&Node::Illumination(after)));
    let nowhere = send(&mut structures, 1, Value::Vector3(DVec3::ZERO));
    assert_eq!(nowhere, Err(NodeFault::Range { input: Input::Number(1) }));
}

#[test]
fn a_vector_without_a_fourth_component_keeps_that_of_its_place() {
    let mut structures = vectors(VectorClass::Connected, 2);
    send(&mut structures, 1, Value::Vector4(DVec4::new(0.0, 0.0, 0.0, 0.25))).unwrap();
    send(&mut structures, 1, Value::Vector3(DVec3::ONE)).unwrap();
    assert_eq!(the_list(&structures).points[0], [1.0, 1.0, 1.0, 0.25]);
    assert_eq!(the_list(&structures).points[1][3], 1.0);
}
