//! How a command becomes what an operate node does to the state.

use super::Operation;
use crate::{matrices, port::ObjectId};
use glam::{DMat2, DMat3, DVec2, DVec3};
use protocol::command::{Boundaries, Operate, Scopes};

/// Most a level of detail can be.
pub const MAX_LEVEL: u16 = 32_767;

/// How many conditional bits there are.
pub const CONDITIONAL_BITS: u8 = 15;

/// Front and back when a view does not give them: about what the manuals name, and what a client passed.
const DEFAULT_BOUNDARIES: Boundaries = Boundaries { front: 1e-15, back: 1e15 };

/// Half the size of the pick box when SET PICKING LOCATION does not give it: what a client sends. Ours.
const DEFAULT_PICK_SIZE: DVec2 = DVec2::splat(0.01);

/// An operation that cannot be: numbers that are not finite or out of range, a view of nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Degenerate(pub &'static str);

impl Operation {
    /// The operation of a command.
    ///
    /// - `font`: what the name in CHARACTER FONT means.
    /// - `since`: the frame from which SET RATE counts.
    ///
    /// # Errors
    /// [`Degenerate`] says what is wrong: an empty window, an angle outside 0..180, a LOOK whose eye and centre
    /// coincide, a bit or a level that does not exist.
    pub fn new(operate: &Operate, font: Option<ObjectId>, since: u64) -> Result<Operation, Degenerate> {
        if let Some(viewing) = viewing(operate)? {
            return Ok(viewing);
        }
        Ok(match *operate {
            Operate::Rotate { axis, angle } => Operation::Linear(matrices::rotation(axis, angle)),
            Operate::Scale(factors) => Operation::Linear(DMat3::from_diagonal(factors)),
            Operate::Translate(by) => Operation::Translate(by),
            Operate::Matrix2(m) => Operation::Character(m),
            Operate::Matrix3(m) => Operation::Linear(m),
            Operate::Matrix4x3(m) => Operation::Affine(m),
            Operate::Matrix4(m) => Operation::Projective(m),
            Operate::CharacterRotate(angle) => {
                let (sine, cosine) = matrices::sine_and_cosine(angle);
                Operation::Character(DMat2::from_cols_array(&[cosine, sine, 0.0 - sine, cosine]))
            }
            Operate::CharacterScale(factors) => Operation::Character(DMat2::from_diagonal(factors)),
            Operate::TextSize(size) => Operation::TextSize(size),
            Operate::CharacterFont(_) => Operation::Font(Some(font.ok_or(Degenerate("FONT needs a name"))?)),
            Operate::StandardFont => Operation::Font(None),
            Operate::SetRate(rate) => Operation::Rate { rate, since },
            _ => return attribute(operate),
        })
    }
}

/// The operations that place the view; none for others.
fn viewing(operate: &Operate) -> Result<Option<Operation>, Degenerate> {
    let range = |boundaries: Option<Boundaries>| {
        let b = boundaries.unwrap_or(DEFAULT_BOUNDARIES);
        [b.front, b.back]
    };
    Ok(Some(match *operate {
        Operate::Look { at, from, up } => Operation::Affine(
            matrices::look(at, from, up.unwrap_or(at + DVec3::Y))
                .ok_or(Degenerate("LOOK needs FROM and AT apart, and UP across the line of sight"))?,
        ),
        Operate::Window { x, y, boundaries } => {
            let window = matrices::window(x, y, range(boundaries));
            Operation::Projective(window.ok_or(Degenerate("WINDOW needs three ranges that are not empty"))?)
        }
        Operate::FieldOfView { angle, boundaries } => Operation::Projective(
            matrices::field_of_view(angle, range(boundaries))
                .ok_or(Degenerate("FIELD_OF_VIEW needs an angle between 0 and 180 and FRONT before BACK"))?,
        ),
        Operate::Eye { back, right, up, width, boundaries } => Operation::Projective(
            matrices::eye(back, right, up, width, range(boundaries))
                .ok_or(Degenerate("EYE needs a distance and a width above 0 and FRONT before BACK"))?,
        ),
        Operate::Viewport { horizontal, vertical, intensity } => {
            Operation::Viewport { horizontal, vertical, intensity }
        }
        Operate::LoadViewport { horizontal, vertical, intensity } => {
            Operation::LoadViewport { horizontal, vertical, intensity }
        }
        _ => return Ok(None),
    }))
}

/// The operations that set or test something other than a matrix.
fn attribute(operate: &Operate) -> Result<Operation, Degenerate> {
    Ok(match operate {
        Operate::SetColor { hue, saturation } => Operation::Color { hue: *hue, saturation: saturation.clamp(0.0, 1.0) },
        Operate::SetColorBlending(saturation) => Operation::ColorBlending(saturation.clamp(0.0, 1.0)),
        Operate::SetIntensity { on, range } => Operation::Intensity { on: *on, range: *range },
        Operate::SetContrast(contrast) => Operation::Contrast(contrast.clamp(0.0, 1.0)),
        Operate::SetCsm(on) => Operation::Csm(*on),
        Operate::SetDepthClipping(on) => Operation::DepthClipping(*on),
        Operate::SetDisplays { scopes, on } => {
            let scopes = match scopes {
                Scopes::All => 0b1111,
                Scopes::Some(bits) => *bits,
            };
            Operation::Displays { scopes, on: *on }
        }
        Operate::SetCharacters(orientation) => Operation::Orientation(*orientation),
        Operate::SetPicking(on) => Operation::Picking(*on),
        Operate::SetPickingIdentifier(id) => Operation::PickIdentifier(id.clone()),
        Operate::SetPickingLocation { center, size } => {
            Operation::PickLocation { center: *center, size: size.unwrap_or(DEFAULT_PICK_SIZE) }
        }
        Operate::SetLevelOfDetail(level) => Operation::LevelOfDetail(checked_level(*level)?),
        Operate::IncrementLevelOfDetail => Operation::ChangeLevelOfDetail(1),
        Operate::DecrementLevelOfDetail => Operation::ChangeLevelOfDetail(-1),
        Operate::SetConditionalBit { bit, on } => Operation::ConditionalBit { bit: checked_bit(*bit)?, on: *on },
        Operate::IfConditionalBit { bit, on } => Operation::IfBit { bit: checked_bit(*bit)?, on: *on },
        Operate::IfLevelOfDetail { comparison, level } => {
            Operation::IfLevel { comparison: *comparison, level: checked_level(*level)? }
        }
        Operate::IfPhase(on) => Operation::IfPhase(*on),
        Operate::SetRateExternal => Operation::ExternalRate(true),
        Operate::SetBlinking(on) => Operation::Blinking(*on),
        Operate::SetBlinkRate(frames) => Operation::BlinkRate(*frames),
        Operate::SetPlotter(on) => Operation::Plotter(*on),
        Operate::SetPriority(priority) => Operation::Priority(*priority),
        Operate::SetLineTexture { around_corners, texture } => {
            Operation::LineTexture { around_corners: *around_corners, texture: *texture }
        }
        Operate::XformMatrix => Operation::XformMatrix,
        Operate::XformVector => Operation::XformVector,
        Operate::CancelXform => Operation::CancelXform,
        Operate::WriteBack => Operation::WriteBack,
        Operate::SurfaceRendering => Operation::Rendering { solid: false, rendered: None },
        Operate::SolidRendering => Operation::Rendering { solid: true, rendered: None },
        Operate::SectioningPlane => Operation::SectioningPlane,
        Operate::Rotate { .. }
        | Operate::Scale(_)
        | Operate::Translate(_)
        | Operate::Matrix2(_)
        | Operate::Matrix3(_)
        | Operate::Matrix4x3(_)
        | Operate::Matrix4(_)
        | Operate::Look { .. }
        | Operate::Window { .. }
        | Operate::FieldOfView { .. }
        | Operate::Eye { .. }
        | Operate::Viewport { .. }
        | Operate::LoadViewport { .. }
        | Operate::CharacterRotate(_)
        | Operate::CharacterScale(_)
        | Operate::TextSize(_)
        | Operate::CharacterFont(_)
        | Operate::StandardFont
        | Operate::SetRate(_) => return Err(Degenerate("this is no attribute")),
    })
}

fn checked_level(level: u16) -> Result<u16, Degenerate> {
    if level <= MAX_LEVEL { Ok(level) } else { Err(Degenerate("a level of detail is 0 to 32767")) }
}

fn checked_bit(bit: u8) -> Result<u8, Degenerate> {
    if bit < CONDITIONAL_BITS { Ok(bit) } else { Err(Degenerate("a conditional bit is 0 to 14")) }
}
