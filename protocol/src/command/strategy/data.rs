//! Random objects: data of every kind.

use super::basic::{names, reals, singles, texts, vectors2, vectors3};
use crate::command::{
    operate::operates,
    syntax::{
        Attributes, Bspline, Characters, CornerColor, FontCharacter, Fourth, Illumination, LabelText, Labels, Object,
        Pattern, Polygon, PolygonVertex, Polynomial, SurfaceColor, VectorClass, VectorList,
    },
};
use glam::DVec2;
use proptest::prelude::*;

/// Vector lists of every class, of up to 40 vectors.
pub fn vector_lists() -> impl Strategy<Value = VectorList> {
    let class = (0_u8..4).prop_map(|code| VectorClass::from_code(code).expect("codes 0 to 3 are classes"));
    let fourth = prop_oneof![Just(Fourth::Intensity), prop::sample::select(Fourth::ALL.to_vec())];
    let component = prop_oneof![Just(None), (0.0_f32..=1.0).prop_map(Some), Just(Some(500.0_f32))];
    let vector = ([singles(), singles(), singles()], component, any::<bool>());
    let vectors = prop::collection::vec(vector, 0..40);
    let estimate = prop::option::of(any::<u32>());
    let flags = (any::<bool>(), prop::bool::weighted(0.2));
    (flags, class, fourth, 2_u8..=3, estimate, vectors).prop_map(
        |((block_normalized, internal_units), class, fourth, dimension, estimate, vectors)| {
            let z = |z: f32| if dimension == 3 { z } else { 0.0 };
            let point = |p: &[f32; 3], i: &Option<f32>| [p[0], p[1], z(p[2]), i.unwrap_or(fourth.absent())];
            let points = vectors.iter().map(|(p, i, _)| point(p, i)).collect();
            let lines = vectors.iter().map(|v| v.2).filter(|_| class == VectorClass::Itemized).collect();
            VectorList { block_normalized, class, dimension, estimate, fourth, internal_units, points, lines }
        },
    )
}

pub(super) fn font_characters() -> impl Strategy<Value = FontCharacter> {
    let points = prop::collection::vec(([singles(), singles()], any::<bool>()), 0..20);
    (0_u8..128, prop::option::of(any::<u32>()), points).prop_map(|(code, estimate, mut points)| {
        if let Some(first) = points.first_mut() {
            first.1 = false;
        }
        FontCharacter { code, estimate, points }
    })
}

fn polygons() -> impl Strategy<Value = Polygon> {
    let three = || [singles(), singles(), singles()];
    let color = || (three(), prop::option::of(three())).prop_map(|(front, back)| CornerColor { front, back });
    let vertex = move || (three(), three(), color(), any::<bool>());
    let few = prop::collection::vec(vertex(), 3..8);
    let vertices = prop_oneof![30 => few, 1 => prop::collection::vec(vertex(), Polygon::MAX_VERTICES)];
    let attributes = prop::option::of(names());
    (attributes, prop::option::of(reals()), any::<bool>(), any::<[bool; 2]>(), vertices).prop_map(
        |(attributes, outline, coplanar, [normals, colors], vertices)| {
            let vertex = |(position, normal, color, soft)| PolygonVertex {
                soft,
                position,
                normal: Some(normal).filter(|_| normals),
                color: Some(color).filter(|_| colors),
            };
            Polygon { attributes, outline, coplanar, vertices: vertices.into_iter().map(vertex).collect() }
        },
    )
}

fn sides() -> impl Strategy<Value = SurfaceColor> {
    ([reals(), reals(), reals()], reals(), 0_u8..=10, reals())
        .prop_map(|(color, diffuse, specular, opaque)| SurfaceColor { color, diffuse, specular, opaque })
}

/// Rows of a curve: dimension, whether rational, and the rows; `weights` are those of all rows and the last if it is
/// not.
fn rows(weights: [f64; 2], count: std::ops::Range<usize>) -> impl Strategy<Value = (u8, bool, Vec<[f64; 4]>)> {
    let rows = prop::collection::vec([reals(), reals(), reals(), reals()], count);
    (2_u8..=3, any::<bool>(), rows).prop_map(move |(dimension, rational, mut rows)| {
        let last = rows.len() - 1;
        for (index, row) in rows.iter_mut().enumerate() {
            if dimension == 2 {
                row[2] = 0.0;
            }
            if !rational {
                row[3] = weights[usize::from(index == last)];
            }
        }
        (dimension, rational, rows)
    })
}

fn bsplines() -> impl Strategy<Value = Bspline> {
    let knots = prop::option::of(prop::collection::vec(reals(), 1..20));
    let flags = (any::<bool>(), any::<bool>(), prop::option::of(any::<u32>()));
    (1..=Bspline::MAX_ORDER, flags, rows([1.0, 1.0], 1..20), knots, 1..=Bspline::MAX_CHORDS).prop_map(
        |(order, (closed, periodic, estimate), (dimension, rational, vertices), knots, chords)| Bspline {
            rational,
            order,
            closed,
            periodic,
            dimension,
            estimate,
            vertices,
            knots,
            chords,
        },
    )
}

fn polynomials() -> impl Strategy<Value = Polynomial> {
    (any::<bool>(), rows([0.0, 1.0], 1..12), 1..=Bspline::MAX_CHORDS).prop_map(
        |(given, (dimension, rational, coefficients), chords)| {
            let order = Some(coefficients.len() as u8 - 1).filter(|_| given);
            Polynomial { rational, order, dimension, coefficients, chords }
        },
    )
}

fn patterns() -> impl Strategy<Value = Pattern> {
    (prop::collection::vec(reals(), 1..=32), any::<bool>(), any::<bool>(), reals())
        .prop_map(|(segments, around_corners, matched, length)| Pattern { segments, around_corners, matched, length })
}

/// Objects of every kind.
pub fn objects() -> impl Strategy<Value = Object> {
    let characters = (vectors3(), prop_oneof![Just(DVec2::X), vectors2()], texts())
        .prop_map(|(position, step, text)| Characters { position, step, text });
    let label = (vectors3(), texts()).prop_map(|(position, text)| LabelText { position, text });
    let light = (vectors3(), [reals(), reals(), reals()], reals())
        .prop_map(|(direction, color, ambient)| Illumination { direction, color, ambient });
    prop_oneof![
        1 => Just(Object::Nil),
        1 => Just(Object::BeginStructure),
        1 => Just(Object::BeginFont),
        2 => prop::collection::vec(names(), 0..4).prop_map(Object::Instance),
        2 => names().prop_map(Object::Alias),
        4 => vector_lists().prop_map(Object::VectorList),
        2 => characters.prop_map(Object::Characters),
        1 => prop::collection::vec(label, 1..4).prop_map(|labels| Object::Labels(Labels { labels })),
        10 => (operates(), prop::option::of(names()))
            .prop_map(|(operate, applied_to)| Object::Operate { operate, applied_to }),
        2 => (names(), prop::option::of(any::<u16>())).prop_map(|(function, size)| Object::Function { function, size }),
        1 => prop::collection::vec(polygons(), 1..4).prop_map(Object::Polygons),
        1 => (sides(), prop::option::of(sides()))
            .prop_map(|(front, back)| Object::Attributes(Attributes { front, back })),
        1 => light.prop_map(Object::Illumination),
        1 => bsplines().prop_map(Object::Bspline),
        1 => polynomials().prop_map(Object::Polynomial),
        1 => patterns().prop_map(Object::Pattern),
        1 => any::<u32>().prop_map(Object::RawBlock),
        1 => (names(), 1..=u32::MAX, any::<u32>())
            .prop_map(|(source, start, count)| Object::Copy { source, start, count }),
    ]
}
