//! SHADINGENVIRONMENT: the settings of shaded pictures.

use super::{
    super::{Example, FunctionRow, Source},
    ask,
};
use crate::{
    hue,
    port::{
        Effect, Firing, KindSet,
        Literal::{B, I, R, V3},
        PortSpec, Problem,
    },
};
use protocol::Value;

const BACKGROUND: u16 = 2;
const WASH: u16 = 7;

/// The row of the settings of shading.
pub static ROWS: &[FunctionRow] = &[FunctionRow {
    name: "SHADINGENVIRONMENT",
    summary: "settings of shaded pictures; FIX(2) at <7> washes the raster screen",
    source: Source::confirmed(
        "clients send <5>, <7>, <9> and <15>; what the others mean is uncertain, and kept unused until pictures are \
         shaded here",
    ),
    inputs: &[
        PortSpec::default(KindSet::VECTOR3, V3([0.0, 0.0, 0.25]), "hue, saturation, intensity of the ambient light"),
        PortSpec::default(KindSet::VECTOR3, V3([0.0; 3]), "hue, saturation, intensity of the background"),
        PortSpec::optional(KindSet::VECTOR.or(KindSet::MATRIX), "viewport on the raster screen"),
        PortSpec::default(KindSet::NUMBER, R(1.0), "exposure, 0.3 to 3"),
        PortSpec::default(KindSet::INTEGER, I(1), "quality of edges"),
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
        Example::of(&[(5, I(1)), (9, B(true)), (15, B(true)), (7, I(2))], &[]),
        Example::of(&[(7, I(3)), (7, I(-1))], &[]).faults(&[6, 6]),
    ],
    ..FunctionRow::PLAIN
}];

fn wash(f: &mut Firing) -> Result<(), Problem> {
    if !(0..=2).contains(&f.integer(WASH)?) {
        return Err(Problem::Range(WASH));
    }
    let Value::Vector3(color) = f.value(BACKGROUND) else { return Err(Problem::Kind(BACKGROUND)) };
    let intensity = color.z.clamp(0.0, 1.0) as f32;
    let color = hue::rgb(color.x as f32, color.y as f32).map(|part| (part * intensity * 255.0).round() as u8);
    ask(f, Effect::WashScreen { color })
}
