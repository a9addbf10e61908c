//! Random commands for property tests.

use super::syntax::{
    Arc, Axis, Boundaries, Characters, Command, Destination, Fourth, Initialize, Input, NamePattern, Object, Operate,
    VectorClass, VectorList,
};
use crate::{Name, Value};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use proptest::prelude::*;

/// Any name, among them words of the language.
pub fn names() -> impl Strategy<Value = Name> {
    let text = prop_oneof![
        "[A-Za-z][A-Za-z0-9_$.]{0,12}",
        "[A-Z][A-Z0-9_$.]{230,255}",
        prop::sample::select(vec![
            "IF",
            "IN",
            "OF",
            "TO",
            "NIL",
            "FROM",
            "ALL",
            "F",
            "P",
            "L",
            "I",
            "N",
            "X",
            "SEND",
            "WINDOW",
            "APPLIED",
            "THEN",
            "END_STRUCTURE",
            "TRUE",
        ])
        .prop_map(str::to_owned),
    ];
    text.prop_map(|text| Name::new(text).expect("the pattern makes names only"))
}

/// Finite reals of every size.
pub fn reals() -> impl Strategy<Value = f64> {
    let any_size = any::<f64>().prop_filter("finite", |r| r.is_finite());
    prop_oneof![-1.0..1.0, (-1000..1000).prop_map(f64::from), any_size]
}

/// Finite single-precision reals of every size.
pub fn singles() -> impl Strategy<Value = f32> {
    let any_size = any::<f32>().prop_filter("finite", |r| r.is_finite());
    prop_oneof![-1.0_f32..1.0, (-1000_i16..1000).prop_map(f32::from), any_size]
}

fn vectors2() -> impl Strategy<Value = DVec2> {
    [reals(), reals()].prop_map(DVec2::from_array)
}

fn vectors3() -> impl Strategy<Value = DVec3> {
    [reals(), reals(), reals()].prop_map(DVec3::from_array)
}

fn limits() -> impl Strategy<Value = [f64; 2]> {
    [reals(), reals()]
}

fn rows<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    prop::collection::vec(reals(), N).prop_map(|row| std::array::from_fn(|i| row[i]))
}

fn matrices2() -> impl Strategy<Value = DMat2> {
    rows::<4>().prop_map(|m| DMat2::from_cols_array(&m))
}

fn matrices3() -> impl Strategy<Value = DMat3> {
    rows::<9>().prop_map(|m| DMat3::from_cols_array(&m))
}

fn matrices4() -> impl Strategy<Value = DMat4> {
    rows::<16>().prop_map(|m| DMat4::from_cols_array(&m))
}

fn matrices4x3() -> impl Strategy<Value = DMat4> {
    matrices4().prop_map(|mut m| {
        for (i, w) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
            m.col_mut(i).w = w;
        }
        m
    })
}

fn texts() -> impl Strategy<Value = Box<[u8]>> {
    let byte = prop_oneof![any::<u8>(), prop::sample::select(b"';{} A".to_vec())];
    prop::collection::vec(byte, 0..20).prop_map(Vec::into)
}

/// Values of every kind.
pub fn values() -> impl Strategy<Value = Value> {
    prop_oneof![
        any::<bool>().prop_map(Value::Boolean),
        any::<i32>().prop_map(Value::Integer),
        reals().prop_map(Value::Real),
        texts().prop_map(Value::String),
        vectors2().prop_map(Value::Vector2),
        vectors3().prop_map(Value::Vector3),
        rows::<4>().prop_map(|v| Value::Vector4(DVec4::from_array(v))),
        matrices2().prop_map(|m| Value::Matrix2(Box::new(m))),
        matrices3().prop_map(|m| Value::Matrix3(Box::new(m))),
        matrices4x3().prop_map(|m| Value::Matrix4x3(Box::new(m))),
        matrices4().prop_map(|m| Value::Matrix4(Box::new(m))),
        matrices4().prop_map(|m| Value::Transform(Box::new(m))),
    ]
}

/// Inputs by number and by word.
pub fn inputs() -> impl Strategy<Value = Input> {
    let word = prop::sample::select(Input::WORDS.map(|row| row.0).to_vec());
    prop_oneof![(1_u32..20).prop_map(Input::Number), (1..=u32::MAX).prop_map(Input::Number), word]
}

/// Inputs of named objects.
pub fn destinations() -> impl Strategy<Value = Destination> {
    (inputs(), names()).prop_map(|(input, name)| Destination { input, name })
}

/// Vector lists of every class, of up to 40 vectors.
pub fn vector_lists() -> impl Strategy<Value = VectorList> {
    let class = (0_u8..4).prop_map(|code| VectorClass::from_code(code).expect("codes 0 to 3 are classes"));
    let intensity = prop_oneof![Just(1.0_f32), 0.0_f32..=1.0, Just(500.0_f32)];
    let vector = ([singles(), singles(), singles()], intensity, any::<bool>());
    let vectors = prop::collection::vec(vector, 0..40);
    let estimate = prop::option::of(any::<u32>());
    (any::<bool>(), class, 2_u8..=3, estimate, vectors).prop_map(
        |(block_normalized, class, dimension, estimate, vectors)| {
            let z = |z: f32| if dimension == 3 { z } else { 0.0 };
            let points = vectors.iter().map(|&(p, i, _)| [p[0], p[1], z(p[2]), i]).collect();
            let lines = vectors.iter().map(|v| v.2).filter(|_| class == VectorClass::Itemized).collect();
            VectorList {
                block_normalized,
                fourth: Fourth::Intensity,
                internal_units: false,
                class,
                dimension,
                estimate,
                points,
                lines,
            }
        },
    )
}

/// Operate nodes of every kind.
pub fn operates() -> impl Strategy<Value = Operate> {
    let axis = prop::sample::select(vec![Axis::X, Axis::Y, Axis::Z]);
    let boundaries = || prop::option::of(limits().prop_map(|[front, back]| Boundaries { front, back }));
    prop_oneof![
        (axis, reals()).prop_map(|(axis, angle)| Operate::Rotate { axis, angle }),
        vectors3().prop_map(Operate::Scale),
        vectors3().prop_map(Operate::Translate),
        matrices2().prop_map(Operate::Matrix2),
        matrices3().prop_map(Operate::Matrix3),
        matrices4x3().prop_map(Operate::Matrix4x3),
        matrices4().prop_map(Operate::Matrix4),
        (vectors3(), vectors3(), prop::option::of(vectors3())).prop_map(|(at, from, up)| Operate::Look {
            at,
            from,
            up
        }),
        (limits(), limits(), boundaries()).prop_map(|(x, y, boundaries)| Operate::Window { x, y, boundaries }),
        (reals(), boundaries()).prop_map(|(angle, boundaries)| Operate::FieldOfView { angle, boundaries }),
        (limits(), limits(), prop::option::of(limits()))
            .prop_map(|(horizontal, vertical, intensity)| Operate::Viewport { horizontal, vertical, intensity }),
        limits().prop_map(|[hue, saturation]| Operate::SetColor { hue, saturation }),
        (any::<bool>(), limits()).prop_map(|(on, range)| Operate::SetIntensity { on, range }),
        any::<bool>().prop_map(Operate::SetDepthClipping),
        Just(Operate::XformMatrix),
    ]
}

/// Objects of every kind.
pub fn objects() -> impl Strategy<Value = Object> {
    let characters = (vectors3(), prop_oneof![Just(DVec2::X), vectors2()], texts())
        .prop_map(|(position, step, text)| Characters { position, step, text });
    prop_oneof![
        1 => Just(Object::Nil),
        1 => Just(Object::BeginStructure),
        2 => prop::collection::vec(names(), 0..4).prop_map(Object::Instance),
        4 => vector_lists().prop_map(Object::VectorList),
        2 => characters.prop_map(Object::Characters),
        8 => (operates(), prop::option::of(names()))
            .prop_map(|(operate, applied_to)| Object::Operate { operate, applied_to }),
        2 => (names(), prop::option::of(any::<u16>())).prop_map(|(function, size)| Object::Function { function, size }),
    ]
}

/// Commands of every kind.
pub fn commands() -> impl Strategy<Value = Command> {
    let prefix = prop_oneof![Just(String::new()), names().prop_map(|name| name.as_str().to_owned())];
    let pattern = prop_oneof![names().prop_map(NamePattern::Name), prefix.prop_map(NamePattern::Prefix)];
    let initialize =
        prop::sample::select(vec![Initialize::All, Initialize::Connections, Initialize::Displays, Initialize::Names]);
    prop_oneof![
        12 => (prop::option::of(names()), objects()).prop_map(|(name, object)| Command::Define { name, object }),
        1 => Just(Command::EndStructure),
        1 => names().prop_map(Command::Display),
        1 => names().prop_map(Command::Remove),
        1 => (names(), names()).prop_map(|(name, into)| Command::Include { name, into }),
        1 => (names(), names()).prop_map(|(name, from)| Command::RemoveFrom { name, from }),
        1 => prop::collection::vec(pattern, 1..4).prop_map(Command::Delete),
        1 => names().prop_map(Command::Forget),
        2 => (names(), 1..=u16::MAX, destinations())
            .prop_map(|(source, output, destination)| Command::Connect(Arc { source, output, destination })),
        2 => (names(), prop::option::of(1..=u16::MAX), prop::option::of(destinations()))
            .prop_map(|(source, output, destination)| Command::Disconnect { source, output, destination }),
        4 => (values(), destinations()).prop_map(|(value, destination)| Command::Send { value, destination }),
        1 => initialize.prop_map(Command::Initialize),
    ]
}
