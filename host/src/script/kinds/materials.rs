//! Kinds of what surfaces reflect, and how.

use super::numbers::{NumberKind, number, shown};
use super::vectors::vector_or_number;
use super::words::{ObjectKind, TextKind};
use crate::color::Color;
use crate::database::Library;
use crate::illumination::Paint;
use crate::illumination::distribution::FacetTable;
use crate::illumination::texture::{Band, NumberTexture as TextureNumber, Varying};
use crate::script::handle::Handle;
use crate::script::parameter::{HasDefault, ParameterKind};
use glam::DVec3;
use rhai::{Array, Dynamic};

/// What is reflected: fractions, the name of a spectrum, or a pattern.
#[derive(Clone, Copy)]
pub(in crate::script) struct Reflectance;

/// A list of reflectances, one at least.
#[derive(Clone, Copy)]
pub(in crate::script) struct Reflectances;

/// A number within limits, the least and the greatest, or a pattern of such numbers.
#[derive(Clone, Copy)]
pub(in crate::script) struct AmountKind(pub(in crate::script) f64, pub(in crate::script) f64);

/// A function of one number, an angle: it is a table when a value is read, see the engine.
#[derive(Clone, Copy)]
pub(in crate::script) struct FunctionOfAngle;

/// The name of a distribution, or one of the user's.
#[derive(Clone, Copy)]
pub(in crate::script) struct DistributionKind;

/// What a distribution becomes.
pub(in crate::script) enum DistributionValue {
    /// A member of the family, by its name.
    Name(String),
    /// One of the user's.
    Table(FacetTable),
}

/// What something is made of: a map, an object of the same material, or a name.
#[derive(Clone, Copy)]
pub(in crate::script) struct MaterialOriginKind;

/// Where a material is taken from.
pub(in crate::script) enum MaterialOrigin {
    /// A map of what material() takes.
    Map(Dynamic),
    /// Another object.
    Object(Handle),
    /// The name of a record of an open database.
    Record(String),
}

impl ParameterKind for MaterialOriginKind {
    type Value = MaterialOrigin;

    fn words(&self) -> String {
        "a map of what material() takes, an object of the same material, or the name of a stored material".into()
    }

    fn read(&self, value: &Dynamic) -> Option<MaterialOrigin> {
        if let Some(handle) = ObjectKind.read(value) {
            return Some(MaterialOrigin::Object(handle));
        }
        if value.is_map() {
            return Some(MaterialOrigin::Map(value.clone()));
        }
        TextKind.read(value).map(MaterialOrigin::Record)
    }
}

impl ParameterKind for Reflectance {
    type Value = Paint;

    fn words(&self) -> String {
        "a number from 0 to 1, three [red, green, blue], the name of a reflectance, or a pattern".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Paint> {
        let is_fraction = |bands: &glam::DVec3| bands.min_element() >= 0.0 && bands.max_element() <= 1.0;
        let bands = || vector_or_number(value).filter(is_fraction).map(Color::Bands);
        let paint = value.read_lock::<Paint>().map(|paint| paint.clone());
        paint.or_else(|| bands().map(Paint::Plain))
    }

    fn look_up(&self, name: &str, library: &Library) -> Option<Result<Paint, String>> {
        let found = library.reflectance(name).map(|spectrum| Color::Spectrum(spectrum).into());
        Some(found.map_err(|error| error.to_string()))
    }
}

impl ParameterKind for Reflectances {
    type Value = Vec<Paint>;

    fn words(&self) -> String {
        "a list of reflectances: numbers from 0 to 1, [red, green, blue], or patterns".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<Paint>> {
        let paints: Option<Vec<Paint>> =
            value.read_lock::<Array>()?.iter().map(|paint| Reflectance.read(paint)).collect();
        paints.filter(|paints| !paints.is_empty())
    }
}

impl ParameterKind for AmountKind {
    type Value = TextureNumber;

    fn words(&self) -> String {
        format!("{} or a pattern of such numbers", NumberKind(self.0, self.1).words())
    }

    fn read(&self, value: &Dynamic) -> Option<TextureNumber> {
        amount(value).filter(|amount| {
            let [least, most] = amount.range();
            least >= self.0 && most <= self.1
        })
    }
}

impl ParameterKind for FunctionOfAngle {
    type Value = FacetTable;
    const IS_FUNCTION: bool = true;

    fn words(&self) -> String {
        "a function |x| ... of a number".into()
    }

    fn read(&self, value: &Dynamic) -> Option<FacetTable> {
        value.read_lock::<FacetTable>().map(|table| table.clone())
    }
}

impl ParameterKind for DistributionKind {
    type Value = DistributionValue;

    fn words(&self) -> String {
        "a name, or what user_distribution() returned".into()
    }

    fn read(&self, value: &Dynamic) -> Option<DistributionValue> {
        let table = FunctionOfAngle.read(value).map(DistributionValue::Table);
        table.or_else(|| TextKind.read(value).map(DistributionValue::Name))
    }
}

impl HasDefault for Reflectance {
    type Default = f64;

    fn of_default(&self, default: f64) -> Paint {
        Paint::grey(default)
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

impl HasDefault for Reflectances {
    type Default = &'static [[f64; 3]];

    fn of_default(&self, default: &'static [[f64; 3]]) -> Vec<Paint> {
        default.iter().map(|bands| Paint::Plain(Color::Bands(DVec3::from_array(*bands)))).collect()
    }

    fn shown(&self, default: &'static [[f64; 3]]) -> String {
        format!("{default:?}")
    }
}

impl HasDefault for AmountKind {
    type Default = f64;

    fn of_default(&self, default: f64) -> TextureNumber {
        TextureNumber::Constant(default)
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

/// A number, or a pattern of numbers: as bright as a pattern is.
fn amount(value: &Dynamic) -> Option<TextureNumber> {
    if let Some(number) = number(value) {
        return Some(TextureNumber::Constant(number));
    }
    if let Some(amount) = value.read_lock::<TextureNumber>() {
        return Some(amount.clone());
    }
    match &*value.read_lock::<Paint>()? {
        Paint::Pattern(pattern) => {
            let varying = Varying { pattern: (**pattern).clone(), band: Band::Mean, from: 0.0, to: 1.0 };
            Some(TextureNumber::Varying(Box::new(varying)))
        }
        Paint::Plain(_) => None,
    }
}
