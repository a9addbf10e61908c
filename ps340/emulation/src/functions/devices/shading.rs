//! SHADINGENVIRONMENT: the settings of shaded pictures.

use super::{
    super::{FunctionExample, FunctionRow, Source},
    common::request,
};
use crate::{
    hue,
    port::{
        Effect, Firing, KindSet,
        Literal::{B, I, M2, R, V3, V4},
        PortSpec, Problem,
    },
};
use protocol::{
    Kind, Value,
    raster::{RASTER_HEIGHT, RASTER_WIDTH},
};

const AMBIENT: u16 = 1;
const BACKGROUND: u16 = 2;
const VIEWPORT: u16 = 3;
const EXPOSURE: u16 = 4;
const QUALITY: u16 = 5;
const DEPTH_CUE: u16 = 6;
const WASH: u16 = 7;
const HIGHLIGHTS: u16 = 10;

/// The row of the settings of shading.
pub static ROWS: &[FunctionRow] = &[FunctionRow {
    name: "SHADINGENVIRONMENT",
    summary: "settings of shaded pictures; FIX(2) at <7> washes the raster screen",
    source: Source::confirmed(
        "clients send <5>, <7>, <9> and <15>; what the others mean is uncertain, and <8>, <9>, <11> to <15> have no \
         effect",
    ),
    inputs: &[
        PortSpec::default(KindSet::VECTOR3, V3([0.0, 0.0, 0.25]), "hue, saturation, intensity of the ambient light"),
        PortSpec::default(KindSet::VECTOR3, V3([0.0; 3]), "hue, saturation, intensity of the background"),
        PortSpec::optional(
            KindSet::of(&[Kind::Vector3, Kind::Vector4, Kind::Matrix2, Kind::Matrix3]),
            "viewport in pixels: left, bottom, side; left, bottom, right, top; or rows of a matrix",
        ),
        PortSpec::default(KindSet::NUMBER, R(1.0), "exposure, 0.3 to 3"),
        PortSpec::default(KindSet::INTEGER, I(1), "quality of edges: 0 hard, 1 to 3 smooth"),
        PortSpec::default(KindSet::NUMBER, R(0.2), "depth cueing of shaded pictures, 0 to 1"),
        PortSpec::active(KindSet::INTEGER, "wash: 0 and 1 the viewport, 2 the whole screen"),
        PortSpec::optional(KindSet::INTEGER, "update mode"),
        PortSpec::default(KindSet::BOOLEAN, B(false), "transparency"),
        PortSpec::default(KindSet::BOOLEAN, B(true), "highlights"),
        PortSpec::optional(KindSet::ANY, "unknown"),
        PortSpec::optional(KindSet::ANY, "unknown"),
        PortSpec::optional(KindSet::ANY, "unknown"),
        PortSpec::optional(KindSet::ANY, "unknown"),
        PortSpec::optional(KindSet::BOOLEAN, "of later models"),
    ],
    behaviour: wash,
    examples: &[
        FunctionExample::of(&[(5, I(1)), (9, B(true)), (15, B(true)), (7, I(2))], &[]),
        FunctionExample::of(
            &[(3, V3([80.0, 0.0, 480.0])), (7, I(0)), (3, V4([0.0, 0.0, 639.0, 479.0])), (7, I(1))],
            &[],
        ),
        FunctionExample::of(&[(3, M2([[0.0, 639.0], [0.0, 479.0]])), (7, I(0))], &[]),
        FunctionExample::of(&[(7, I(3)), (7, I(-1))], &[]).faults(&[6, 6]),
    ],
    ..FunctionRow::PLAIN
}];

/// The settings of shaded pictures as they are used: out-of-range values brought into range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingEnvironment {
    /// Hue, saturation and intensity of the ambient light.
    pub ambient: [f64; 3],
    /// Hue, saturation and intensity of the background.
    pub background: [f64; 3],
    /// Left, bottom, width and height on the raster screen in pixels; 0 wide or high if nothing of it is on the screen.
    pub viewport: [u32; 4],
    /// Multiplies all light, 0.3..=3.
    pub exposure: f64,
    /// 0 for hard edges, 1..=3 for smooth ones.
    pub quality: u32,
    /// How much darker the back is, 0..=1.
    pub depth_cue: f64,
    /// Whether highlights are seen.
    pub highlights: bool,
}

impl Default for ShadingEnvironment {
    /// The values of the row.
    fn default() -> ShadingEnvironment {
        ShadingEnvironment {
            ambient: [0.0, 0.0, 0.25],
            background: [0.0; 3],
            viewport: SQUARE,
            exposure: 1.0,
            quality: 1,
            depth_cue: 0.2,
            highlights: true,
        }
    }
}

/// The largest square in the middle of the raster screen, so that pictures have the shape that they have on the vector
/// screen.
const SQUARE: [u32; 4] = [(RASTER_WIDTH - RASTER_HEIGHT) / 2, 0, RASTER_HEIGHT, RASTER_HEIGHT];

impl ShadingEnvironment {
    /// The settings from the constants at the inputs.
    ///
    /// - `input`: the value at an input, if there is one.
    pub fn from_inputs<'v>(input: impl Fn(u16) -> Option<&'v Value>) -> ShadingEnvironment {
        let default = ShadingEnvironment::default();
        let vector = |number, otherwise| match input(number) {
            Some(Value::Vector3(v)) => v.to_array(),
            _ => otherwise,
        };
        let number = |number, otherwise| input(number).and_then(Value::number).unwrap_or(otherwise);
        ShadingEnvironment {
            ambient: vector(AMBIENT, default.ambient),
            background: vector(BACKGROUND, default.background),
            viewport: input(VIEWPORT).and_then(viewport).unwrap_or(default.viewport),
            exposure: number(EXPOSURE, default.exposure).clamp(0.3, 3.0),
            quality: number(QUALITY, f64::from(default.quality)).clamp(0.0, 3.0) as u32,
            depth_cue: number(DEPTH_CUE, default.depth_cue).clamp(0.0, 1.0),
            highlights: input(HIGHLIGHTS).is_none_or(|value| *value != Value::Boolean(false)),
        }
    }

    /// Samples along a side of a pixel: 1, 4, 8 or 16.
    pub fn samples(&self) -> usize {
        [1, 4, 8, 16][self.quality.min(3) as usize]
    }
}

/// The part of the screen that a value at `<3>` means, in pixels; none if it is no viewport.
///
/// A 3D vector is the lower left pixel and the side of a square; a 4D vector the left, bottom, right and top pixel; a
/// matrix has left and right in its first row, bottom and top in its second, as that of VIEWPORT. Ours.
fn viewport(value: &Value) -> Option<[u32; 4]> {
    let [left, bottom, right, top] = match value {
        Value::Vector3(v) => [v.x, v.y, v.x + v.z - 1.0, v.y + v.z - 1.0],
        Value::Vector4(v) => v.to_array(),
        Value::Matrix2(m) => [m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y],
        Value::Matrix3(m) => [m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y],
        _ => return None,
    };
    // The casts clamp: what is left of the screen is pixel 0, what is right of it ends at its edge.
    let range = |from: f64, to: f64, pixels: u32| {
        let from = (from.round().max(0.0) as u32).min(pixels);
        let end = ((to.round() + 1.0).max(0.0) as u32).min(pixels);
        [from, end.saturating_sub(from)]
    };
    let ([left, width], [bottom, height]) = (range(left, right, RASTER_WIDTH), range(bottom, top, RASTER_HEIGHT));
    Some([left, bottom, width, height])
}

fn wash(f: &mut Firing) -> Result<(), Problem> {
    let what = f.integer(WASH)?;
    if !(0..=2).contains(&what) {
        return Err(Problem::Range(WASH));
    }
    let settings = ShadingEnvironment::from_inputs(|input| f.optional(input));
    let [hue, saturation, intensity] = settings.background;
    let intensity = intensity.clamp(0.0, 1.0) as f32;
    let color = hue::rgb(hue as f32, saturation as f32).map(|part| (part * intensity * 255.0).round() as u8);
    request(f, Effect::WashScreen { color, part: (what < 2).then_some(settings.viewport) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat2, DVec3, DVec4};

    #[test]
    fn defaults_are_those_of_the_row() {
        let values: Vec<Option<Value>> = ROWS[0]
            .inputs
            .iter()
            .map(|spec| match spec.role {
                crate::port::QueueRole::Default(literal) => Some(literal.value()),
                _ => None,
            })
            .collect();
        let settings = ShadingEnvironment::from_inputs(|input| values[usize::from(input) - 1].as_ref());
        assert_eq!(settings, ShadingEnvironment::default());
    }

    #[test]
    fn viewports_are_cut_to_the_screen() {
        let part = |value| viewport(&value);
        assert_eq!(part(Value::Vector3(DVec3::new(80.0, 0.0, 480.0))), Some([80, 0, 480, 480]));
        assert_eq!(part(Value::Vector4(DVec4::new(-5.0, 10.0, 1e9, 10.0))), Some([0, 10, 640, 1]));
        assert_eq!(part(Value::Matrix2(Box::new(DMat2::from_cols_array(&[3.0, 4.0, 5.0, 4.0])))), Some([3, 5, 2, 0]));
        assert_eq!(part(Value::Vector3(DVec3::new(700.0, 500.0, 10.0))), Some([640, 480, 0, 0]));
        assert_eq!(part(Value::Integer(3)), None);
    }
}
