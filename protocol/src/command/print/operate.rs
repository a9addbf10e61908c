//! Operate nodes as text.

use super::printer::{List, Number, Printer};
use crate::command::{
    matrix::four_by_three,
    syntax::{Axis, Boundaries, CharacterOrientation, Operate, Scopes},
};

impl Printer<'_> {
    /// An operate node without what it is applied to: transformations and viewing here, the others below.
    pub(super) fn operate(&mut self, operate: &Operate) {
        match operate {
            Operate::Rotate { axis, angle } => {
                let axis = match axis {
                    Axis::X => 'X',
                    Axis::Y => 'Y',
                    Axis::Z => 'Z',
                };
                self.put(format_args!("ROTATE IN {axis} {}", Number(*angle)));
            }
            Operate::Scale(by) => self.put(format_args!("SCALE BY {}", List(&by.to_array()))),
            Operate::Translate(by) => self.put(format_args!("TRANSLATE BY {}", List(&by.to_array()))),
            Operate::Matrix2(m) => self.put(format_args!("MATRIX_2X2 {}", List(&m.to_cols_array()))),
            Operate::Matrix3(m) => self.put(format_args!("MATRIX_3X3 {}", List(&m.to_cols_array()))),
            Operate::Matrix4x3(m) => self.put(format_args!("MATRIX_4X3 {}", List(&four_by_three(m)))),
            Operate::Matrix4(m) => self.put(format_args!("MATRIX_4X4 {}", List(&m.to_cols_array()))),
            Operate::Look { at, from, up } => {
                self.put(format_args!("LOOK AT {} FROM {}", List(&at.to_array()), List(&from.to_array())));
                if let Some(up) = up {
                    self.put(format_args!(" UP {}", List(&up.to_array())));
                }
            }
            Operate::Window { x, y, boundaries } => {
                self.limits("WINDOW X", x);
                self.limits(" Y", y);
                self.boundaries(boundaries);
            }
            Operate::FieldOfView { angle, boundaries } => {
                self.put(format_args!("FIELD_OF_VIEW {}", Number(*angle)));
                self.boundaries(boundaries);
            }
            Operate::Eye { back, right, up, width, boundaries } => {
                self.put(format_args!("EYE BACK {}", Number(*back)));
                self.offset(["LEFT", "RIGHT"], *right);
                self.offset(["DOWN", "UP"], *up);
                self.put(format_args!(" FROM SCREEN AREA {} WIDE", Number(*width)));
                self.boundaries(boundaries);
            }
            Operate::Viewport { horizontal, vertical, intensity } => {
                self.viewport("VIEWPORT HORIZONTAL", horizontal, vertical, intensity);
            }
            Operate::LoadViewport { horizontal, vertical, intensity } => {
                self.viewport("LOAD VIEWPORT HORIZONTAL", horizontal, vertical, intensity);
            }
            Operate::XformMatrix => self.text("XFORM MATRIX"),
            Operate::XformVector => self.text("XFORM VECTOR"),
            Operate::CancelXform => self.text("CANCEL XFORM"),
            Operate::WriteBack => self.text("WRITEBACK"),
            Operate::SurfaceRendering => self.text("SURFACE_RENDERING"),
            Operate::SolidRendering => self.text("SOLID_RENDERING"),
            Operate::SectioningPlane => self.text("SECTIONING_PLANE"),
            Operate::CharacterRotate(angle) => self.put(format_args!("CHARACTER ROTATE {}", Number(*angle))),
            Operate::CharacterScale(by) => self.put(format_args!("CHARACTER SCALE {}", List(&by.to_array()))),
            Operate::TextSize(size) => self.put(format_args!("TEXT SIZE {}", Number(*size))),
            Operate::CharacterFont(name) => self.put(format_args!("CHARACTER FONT {name}")),
            Operate::StandardFont => self.text("STANDARD FONT"),
            _ => self.attribute(operate),
        }
    }

    /// Attributes and conditions.
    fn attribute(&mut self, operate: &Operate) {
        match operate {
            Operate::SetColor { hue, saturation } => self.put(format_args!("SET COLOR {}", List(&[*hue, *saturation]))),
            Operate::SetColorBlending(saturation) => {
                self.put(format_args!("SET COLOR BLENDING {}", Number(*saturation)));
            }
            Operate::SetIntensity { on, range: [low, high] } => {
                self.put(format_args!("SET INTENSITY {} {}:{}", on_or_off(*on), Number(*low), Number(*high)));
            }
            Operate::SetContrast(contrast) => self.put(format_args!("SET CONTRAST TO {}", Number(*contrast))),
            Operate::SetCsm(on) => self.switch("CSM", *on),
            Operate::SetDepthClipping(on) => self.switch("DEPTH_CLIPPING", *on),
            Operate::SetDisplays { scopes: Scopes::All, on } => self.switch("DISPLAYS ALL", *on),
            Operate::SetDisplays { scopes: Scopes::Some(bits), on } => {
                let numbers: Vec<String> = (0..8).filter(|n| bits >> n & 1 != 0).map(|n: u8| n.to_string()).collect();
                self.put(format_args!("SET DISPLAY {} {}", numbers.join(", "), on_or_off(*on)));
            }
            Operate::SetCharacters(orientation) => self.text(match orientation {
                CharacterOrientation::World => "SET CHARACTERS WORLD_ORIENTED",
                CharacterOrientation::Screen => "SET CHARACTERS SCREEN_ORIENTED",
                CharacterOrientation::ScreenFixed => "SET CHARACTERS SCREEN_ORIENTED/FIXED",
            }),
            Operate::SetPicking(on) => self.switch("PICKING", *on),
            Operate::SetPickingIdentifier(name) => self.put(format_args!("SET PICKING IDENTIFIER = {name}")),
            Operate::SetPickingLocation { center, size } => {
                self.put(format_args!("SET PICKING LOCATION = {}", List(&center.to_array())));
                if let Some(size) = size {
                    self.put(format_args!(" {}", List(&size.to_array())));
                }
            }
            Operate::SetLevelOfDetail(level) => self.put(format_args!("SET LEVEL_OF_DETAIL TO {level}")),
            Operate::IncrementLevelOfDetail => self.text("INCREMENT LEVEL_OF_DETAIL"),
            Operate::DecrementLevelOfDetail => self.text("DECREMENT LEVEL_OF_DETAIL"),
            Operate::SetConditionalBit { bit, on } => {
                self.put(format_args!("SET CONDITIONAL_BIT {bit} {}", on_or_off(*on)));
            }
            Operate::SetRate(rate) => {
                self.put(format_args!("SET RATE {} {} {}", rate.on, rate.off, on_or_off(rate.initial)));
                if rate.delay != 0 {
                    self.put(format_args!(" {}", rate.delay));
                }
            }
            Operate::SetRateExternal => self.text("SET RATE EXTERNAL"),
            Operate::SetBlinking(on) => self.switch("BLINKING", *on),
            Operate::SetBlinkRate(frames) => self.put(format_args!("SET BLINK RATE {frames}")),
            Operate::SetPlotter(on) => self.switch("PLOTTER", *on),
            Operate::SetPriority(priority) => self.put(format_args!("SET PRIORITY {priority}")),
            Operate::SetLineTexture { around_corners, texture } => {
                let corners = if *around_corners { "AROUND_CORNERS " } else { "" };
                self.put(format_args!("SET LINE_TEXTURE {corners}{texture}"));
            }
            Operate::IfConditionalBit { bit, on } => {
                self.put(format_args!("IF CONDITIONAL_BIT {bit} IS {}", on_or_off(*on)));
            }
            Operate::IfLevelOfDetail { comparison, level } => {
                self.put(format_args!("IF LEVEL_OF_DETAIL {} {level}", comparison.sign()));
            }
            Operate::IfPhase(on) => self.put(format_args!("IF PHASE IS {}", on_or_off(*on))),
            _ => {}
        }
    }

    fn switch(&mut self, what: &str, on: bool) {
        self.put(format_args!("SET {what} {}", on_or_off(on)));
    }

    fn limits(&mut self, word: &str, [low, high]: &[f64; 2]) {
        self.put(format_args!("{word} = {}:{}", Number(*low), Number(*high)));
    }

    fn viewport(&mut self, word: &str, horizontal: &[f64; 2], vertical: &[f64; 2], intensity: &Option<[f64; 2]>) {
        self.limits(word, horizontal);
        self.limits(" VERTICAL", vertical);
        if let Some(intensity) = intensity {
            self.limits(" INTENSITY", intensity);
        }
    }

    /// An offset to one of two sides: the first for negative ones.
    fn offset(&mut self, sides: [&str; 2], offset: f64) {
        if offset != 0.0 {
            self.put(format_args!(" {} {}", sides[usize::from(offset > 0.0)], Number(offset.abs())));
        }
    }

    fn boundaries(&mut self, boundaries: &Option<Boundaries>) {
        if let Some(Boundaries { front, back }) = boundaries {
            self.put(format_args!(" FRONT = {} BACK = {}", Number(*front), Number(*back)));
        }
    }
}

const fn on_or_off(on: bool) -> &'static str {
    if on { "ON" } else { "OFF" }
}
