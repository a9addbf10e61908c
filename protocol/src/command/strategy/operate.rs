//! Random operate nodes of every kind.

use super::basic::{limits, matrices2, matrices3, matrices4, matrices4x3, names, reals, vectors2, vectors3};
use crate::command::syntax::{Axis, Boundaries, CharacterOrientation, Comparison, Operate, Rate, Scopes};
use proptest::prelude::*;

/// Operate nodes of every kind.
pub fn operates() -> impl Strategy<Value = Operate> {
    prop_oneof![
        3 => transformations(),
        2 => views(),
        3 => attributes(),
        1 => conditions(),
        1 => plain(),
    ]
}

fn transformations() -> impl Strategy<Value = Operate> {
    let axis = prop::sample::select(vec![Axis::X, Axis::Y, Axis::Z]);
    prop_oneof![
        (axis, reals()).prop_map(|(axis, angle)| Operate::Rotate { axis, angle }),
        vectors3().prop_map(Operate::Scale),
        vectors3().prop_map(Operate::Translate),
        matrices2().prop_map(Operate::Matrix2),
        matrices3().prop_map(Operate::Matrix3),
        matrices4x3().prop_map(Operate::Matrix4x3),
        matrices4().prop_map(Operate::Matrix4),
        reals().prop_map(Operate::CharacterRotate),
        vectors2().prop_map(Operate::CharacterScale),
        reals().prop_map(Operate::TextSize),
        names().prop_map(Operate::CharacterFont),
    ]
}

fn views() -> impl Strategy<Value = Operate> {
    let intensity = || prop::option::of(limits());
    prop_oneof![
        (vectors3(), vectors3(), prop::option::of(vectors3())).prop_map(|(at, from, up)| Operate::Look {
            at,
            from,
            up
        }),
        (limits(), limits(), boundaries()).prop_map(|(x, y, boundaries)| Operate::Window { x, y, boundaries }),
        (reals(), boundaries()).prop_map(|(angle, boundaries)| Operate::FieldOfView { angle, boundaries }),
        ([reals(), reals(), reals(), reals()], boundaries())
            .prop_map(|([back, right, up, width], boundaries)| { Operate::Eye { back, right, up, width, boundaries } }),
        (limits(), limits(), intensity()).prop_map(|(horizontal, vertical, intensity)| Operate::Viewport {
            horizontal,
            vertical,
            intensity
        }),
        (limits(), limits(), intensity()).prop_map(|(horizontal, vertical, intensity)| Operate::LoadViewport {
            horizontal,
            vertical,
            intensity
        }),
    ]
}

fn attributes() -> impl Strategy<Value = Operate> {
    let scopes = prop_oneof![Just(Scopes::All), (1_u8..16).prop_map(Scopes::Some)];
    let orientation = prop::sample::select(vec![
        CharacterOrientation::World,
        CharacterOrientation::Screen,
        CharacterOrientation::ScreenFixed,
    ]);
    let rate = (any::<u32>(), any::<u32>(), any::<bool>(), prop_oneof![Just(0), any::<u32>()])
        .prop_map(|(on, off, initial, delay)| Rate { on, off, initial, delay });
    prop_oneof![
        limits().prop_map(|[hue, saturation]| Operate::SetColor { hue, saturation }),
        reals().prop_map(Operate::SetColorBlending),
        (any::<bool>(), limits()).prop_map(|(on, range)| Operate::SetIntensity { on, range }),
        reals().prop_map(Operate::SetContrast),
        any::<bool>().prop_map(Operate::SetCsm),
        any::<bool>().prop_map(Operate::SetDepthClipping),
        (scopes, any::<bool>()).prop_map(|(scopes, on)| Operate::SetDisplays { scopes, on }),
        orientation.prop_map(Operate::SetCharacters),
        any::<bool>().prop_map(Operate::SetPicking),
        names().prop_map(Operate::SetPickingIdentifier),
        (vectors2(), prop::option::of(vectors2()))
            .prop_map(|(center, size)| Operate::SetPickingLocation { center, size }),
        (0..=32_767_u16).prop_map(Operate::SetLevelOfDetail),
        (0..=14_u8, any::<bool>()).prop_map(|(bit, on)| Operate::SetConditionalBit { bit, on }),
        rate.prop_map(Operate::SetRate),
        any::<bool>().prop_map(Operate::SetBlinking),
        any::<u32>().prop_map(Operate::SetBlinkRate),
        any::<bool>().prop_map(Operate::SetPlotter),
        any::<i32>().prop_map(Operate::SetPriority),
        (any::<bool>(), any::<u32>())
            .prop_map(|(around_corners, texture)| Operate::SetLineTexture { around_corners, texture }),
    ]
}

fn conditions() -> impl Strategy<Value = Operate> {
    let comparison = prop::sample::select(Comparison::ALL.to_vec());
    prop_oneof![
        (0..=14_u8, any::<bool>()).prop_map(|(bit, on)| Operate::IfConditionalBit { bit, on }),
        (comparison, 0..=32_767_u16).prop_map(|(comparison, level)| Operate::IfLevelOfDetail { comparison, level }),
        any::<bool>().prop_map(Operate::IfPhase),
    ]
}

/// Nodes without parameters.
fn plain() -> impl Strategy<Value = Operate> {
    prop::sample::select(vec![
        Operate::XformMatrix,
        Operate::XformVector,
        Operate::CancelXform,
        Operate::WriteBack,
        Operate::StandardFont,
        Operate::IncrementLevelOfDetail,
        Operate::DecrementLevelOfDetail,
        Operate::SetRateExternal,
        Operate::SurfaceRendering,
        Operate::SolidRendering,
        Operate::SectioningPlane,
    ])
}

/// Boundaries of views, or none.
fn boundaries() -> impl Strategy<Value = Option<Boundaries>> {
    prop::option::of(limits().prop_map(|[front, back]| Boundaries { front, back }))
}
