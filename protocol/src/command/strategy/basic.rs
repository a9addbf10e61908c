//! Random parts of commands: names, numbers, vectors, matrices, texts.

use crate::Name;
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3};
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
            "S",
            "C",
            "WITH",
            "PATTERN",
            "PREFIX",
            "FOLLOWER",
            "ATTRIBUTES",
            "POLYGON",
            "OUTLINE",
            "WRITEBACK",
            "OPTIMIZE",
            "VALUE",
            "START",
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

/// Pairs of reals.
pub(in crate::command) fn vectors2() -> impl Strategy<Value = DVec2> {
    [reals(), reals()].prop_map(DVec2::from_array)
}

/// Vectors of three reals.
pub(in crate::command) fn vectors3() -> impl Strategy<Value = DVec3> {
    [reals(), reals(), reals()].prop_map(DVec3::from_array)
}

/// Two reals, in any order.
pub(in crate::command) fn limits() -> impl Strategy<Value = [f64; 2]> {
    [reals(), reals()]
}

/// Reals in a row.
pub(in crate::command) fn rows<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    prop::collection::vec(reals(), N).prop_map(|row| std::array::from_fn(|i| row[i]))
}

/// 2x2 matrices.
pub(in crate::command) fn matrices2() -> impl Strategy<Value = DMat2> {
    rows::<4>().prop_map(|m| DMat2::from_cols_array(&m))
}

/// 3x3 matrices.
pub(in crate::command) fn matrices3() -> impl Strategy<Value = DMat3> {
    rows::<9>().prop_map(|m| DMat3::from_cols_array(&m))
}

/// 4x4 matrices.
pub(in crate::command) fn matrices4() -> impl Strategy<Value = DMat4> {
    rows::<16>().prop_map(|m| DMat4::from_cols_array(&m))
}

/// 4x3 matrices, completed with 0, 0, 0, 1.
pub(in crate::command) fn matrices4x3() -> impl Strategy<Value = DMat4> {
    matrices4().prop_map(|mut m| {
        for (i, w) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
            m.col_mut(i).w = w;
        }
        m
    })
}

/// Bytes of texts, among them those that mean something in the language.
pub(in crate::command) fn texts() -> impl Strategy<Value = Box<[u8]>> {
    let byte = prop_oneof![any::<u8>(), prop::sample::select(b"';{} A".to_vec())];
    prop::collection::vec(byte, 0..20).prop_map(Vec::into)
}
