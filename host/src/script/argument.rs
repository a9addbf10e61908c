//! From the values of a call to the parameters of a row.

use super::handle::Handle;
use super::lists::{contours, curve, indices, loops, number, numbers, objects, points, sides, vector};
use super::parameter::{Default, Kind, Parameter};
use super::spline::ControlMeaning;
use crate::color::Color;
use crate::curve::SplineCurve;
use crate::database::Library;
use crate::illumination::Paint;
use crate::illumination::distribution::FacetTable;
use crate::illumination::texture::{Band, Number, Varying};
use crate::solid::primitive::path;
use crate::surface::SurfaceSide;
use glam::DVec3;
use rhai::{Dynamic, Map};

/// A checked value.
#[derive(Clone, Debug)]
enum Argument {
    Object(Handle),
    Number(f64),
    Amount(Number),
    Integer(i64),
    Vector(DVec3),
    Text(String),
    Paint(Paint),
    Facets(FacetTable),
    Flag(bool),
    Scalar(Dynamic),
    Contours(Vec<Vec<DVec3>>),
    Numbers(Vec<Vec<f64>>),
    Indices(Vec<Vec<u32>>),
    Objects(Vec<Handle>),
    Sides(Vec<(Handle, SurfaceSide)>),
    Spline(ControlMeaning),
    Curve(SplineCurve),
    Loops(Vec<Vec<SplineCurve>>),
}

/// The checked values of a call, by parameter.
pub(super) struct Bound {
    values: Vec<(&'static str, Argument)>,
}

impl Bound {
    /// Assigns the values of a call to the parameters of a function and checks each.
    ///
    /// - `usage`: how the function is called, for messages. `library`: where names of reflectances are looked up.
    pub(super) fn new(
        parameters: &'static [Parameter],
        usage: impl Fn() -> String,
        values: &[Dynamic],
        library: &Library,
    ) -> Result<Bound, String> {
        let mut bound = Bound { values: Vec::new() };
        let mut rest = values;
        let mut following = parameters.iter();
        while let Some(first) = rest.first() {
            if rest.len() == 1 && first.is_map() && !first.is::<Handle>() {
                bound.take_map(parameters, first, library)?;
                break;
            }
            let Some(parameter) = following.next() else {
                return Err(format!("too many values; use {}", usage()));
            };
            let three =
                parameter.kind.takes_three() && rest.len() >= 3 && rest[..3].iter().all(|v| number(v).is_some());
            let (value, used) = if three { (Dynamic::from_array(rest[..3].to_vec()), 3) } else { (first.clone(), 1) };
            bound.put(parameter, &value, library)?;
            rest = &rest[used..];
        }
        let missing = |p: &&Parameter| p.default == Default::Required && bound.get(p.name).is_none();
        match parameters.iter().find(missing) {
            Some(p) => Err(format!("{} is missing; use {}", p.name, usage())),
            None => Ok(bound),
        }
    }

    fn take_map(&mut self, parameters: &'static [Parameter], map: &Dynamic, library: &Library) -> Result<(), String> {
        let map = map.read_lock::<Map>().ok_or("the map cannot be read")?;
        for (key, value) in map.iter() {
            let named = parameters.iter().find(|p| p.kind != Kind::Object && p.name == key.as_str());
            let Some(parameter) = named else {
                let names = parameters.iter().filter(|p| p.kind != Kind::Object);
                let names: Vec<&str> = names.map(|p| p.name).collect();
                return Err(format!("unknown parameter {key}; it takes {}", names.join(", ")));
            };
            if self.get(parameter.name).is_some() {
                return Err(format!("{key} is given twice"));
            }
            self.put(parameter, value, library)?;
        }
        Ok(())
    }

    fn put(&mut self, parameter: &Parameter, value: &Dynamic, library: &Library) -> Result<(), String> {
        let name = value.read_lock::<rhai::ImmutableString>().filter(|_| parameter.kind == Kind::Reflectance);
        if let Some(name) = name {
            let found = library.reflectance(&name).map_err(|error| format!("{}: {error}", parameter.name))?;
            self.values.push((parameter.name, Argument::Paint(Color::Spectrum(found).into())));
            return Ok(());
        }
        let checked = check(parameter.kind, value)
            .ok_or_else(|| format!("{} must be {}, not {}", parameter.name, parameter.kind.words(), shown(value)))?;
        self.values.push((parameter.name, checked));
        Ok(())
    }

    fn get(&self, name: &str) -> Option<&Argument> {
        self.values.iter().find(|(n, _)| *n == name).map(|(_, value)| value)
    }

    /// Lists of points; a third coordinate that was not given is 0.
    pub(super) fn contours(&self, name: &str) -> Vec<Vec<DVec3>> {
        match self.get(name) {
            Some(Argument::Contours(contours)) => contours.clone(),
            _ => Vec::new(),
        }
    }

    pub(super) fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Argument::Text(text) => Some(text),
            _ => None,
        }
    }

    /// A curve; where points were given, the one of a path.
    pub(super) fn curve(&self, name: &str, is_closed: bool) -> Result<Option<SplineCurve>, String> {
        match self.get(name) {
            Some(Argument::Curve(curve)) => Ok(Some(curve.clone())),
            Some(Argument::Contours(points)) => {
                path(&points.concat(), is_closed).map(Some).map_err(|error| error.to_string())
            }
            _ => Ok(None),
        }
    }
}

/// Values of a kind by the name of their parameter; none where none was given.
macro_rules! values {
    ($($name:ident: $variant:ident -> $of:ty),* $(,)?) => {
        impl Bound {
            $(pub(super) fn $name(&self, name: &str) -> Option<$of> {
                match self.get(name)? {
                    Argument::$variant(value) => Some(value.clone()),
                    _ => None,
                }
            })*
        }
    };
}

values! {
    object: Object -> Handle,
    number: Number -> f64,
    amount: Amount -> Number,
    integer: Integer -> i64,
    vector: Vector -> DVec3,
    paint: Paint -> Paint,
    facets: Facets -> FacetTable,
    scalar: Scalar -> Dynamic,
    flag: Flag -> bool,
    numbers: Numbers -> Vec<Vec<f64>>,
    indices: Indices -> Vec<Vec<u32>>,
    objects: Objects -> Vec<Handle>,
    sides: Sides -> Vec<(Handle, SurfaceSide)>,
    spline: Spline -> ControlMeaning,
    loops: Loops -> Vec<Vec<SplineCurve>>,
}

/// A number, or a pattern of numbers: as bright as a pattern is.
fn amount(value: &Dynamic) -> Option<Number> {
    if let Some(number) = number(value) {
        return Some(Number::Constant(number));
    }
    if let Some(amount) = value.read_lock::<Number>() {
        return Some(amount.clone());
    }
    match &*value.read_lock::<Paint>()? {
        Paint::Pattern(pattern) => {
            let varying = Varying { pattern: (**pattern).clone(), band: Band::Mean, from: 0.0, to: 1.0 };
            Some(Number::Varying(Box::new(varying)))
        }
        Paint::Plain(_) => None,
    }
}

/// A vector, or one number for all three components.
fn vector_or_number(value: &Dynamic) -> Option<DVec3> {
    number(value).map(DVec3::splat).or_else(|| vector(value))
}

fn check(kind: Kind, value: &Dynamic) -> Option<Argument> {
    let within = |v: DVec3, min: f64, max: f64| v.min_element() >= min && v.max_element() <= max;
    match kind {
        Kind::Object => value.read_lock::<Handle>().map(|h| Argument::Object(*h)),
        Kind::Number(min, max) => number(value).filter(|x| (min..=max).contains(x)).map(Argument::Number),
        Kind::Amount(min, max) => amount(value)
            .filter(|amount| {
                let [least, most] = amount.range();
                least >= min && most <= max
            })
            .map(Argument::Amount),
        Kind::NumberOrText(min, max) => check(Kind::Number(min, max), value).or_else(|| check(Kind::Text, value)),
        Kind::Length => number(value).filter(|x| *x > 0.0).map(Argument::Number),
        Kind::Integer(min, max) => {
            let whole = value.as_int().ok();
            whole.filter(|i| (min..=max).contains(i)).map(Argument::Integer)
        }
        Kind::Vector => vector(value).map(Argument::Vector),
        Kind::Factors => vector_or_number(value).filter(|v| v.abs().min_element() > 0.0).map(Argument::Vector),
        Kind::Lengths => vector_or_number(value).filter(|v| v.min_element() > 0.0).map(Argument::Vector),
        Kind::Fractions => vector_or_number(value).filter(|v| within(*v, 0.0, 1.0)).map(Argument::Vector),
        Kind::Reflectance => {
            let bands = || vector_or_number(value).filter(|v| within(*v, 0.0, 1.0)).map(Color::Bands);
            let paint = value.read_lock::<Paint>().map(|paint| paint.clone());
            paint.or_else(|| bands().map(Paint::Plain)).map(Argument::Paint)
        }
        // What was a function was sampled before the call: see the engine.
        Kind::Function => value.read_lock::<FacetTable>().map(|table| Argument::Facets(table.clone())),
        Kind::Distribution => {
            let table = value.read_lock::<FacetTable>().map(|table| Argument::Facets(table.clone()));
            table.or_else(|| check(Kind::Text, value))
        }
        Kind::Powers => vector_or_number(value).filter(|v| within(*v, 0.0, f64::MAX)).map(Argument::Vector),
        Kind::Axis => {
            let named = match &*value.read_lock::<rhai::ImmutableString>().map(|s| s.to_string()).unwrap_or_default() {
                "x" => Some(DVec3::X),
                "y" => Some(DVec3::Y),
                "z" => Some(DVec3::Z),
                _ => None,
            };
            named.or_else(|| vector(value)?.try_normalize()).map(Argument::Vector)
        }
        Kind::Flag => value.as_bool().ok().map(Argument::Flag),
        Kind::Scalar => {
            let is_scalar = value.is_bool() || value.is_string() || number(value).is_some();
            is_scalar.then(|| Argument::Scalar(value.clone()))
        }
        Kind::Points => points(value).map(|points| Argument::Contours(vec![points])),
        Kind::Contours => contours(value).map(Argument::Contours),
        Kind::Numbers => numbers(value).map(Argument::Numbers),
        Kind::Indices => indices(value).map(Argument::Indices),
        Kind::Objects => objects(value).map(Argument::Objects),
        Kind::Sides => sides(value).map(Argument::Sides),
        Kind::Spline => value.read_lock::<ControlMeaning>().map(|spline| Argument::Spline(spline.clone())),
        Kind::Curve => {
            let control = || points(value).map(|points| Argument::Contours(vec![points]));
            curve(value).map(Argument::Curve).or_else(control)
        }
        Kind::Loops => loops(value).map(Argument::Loops),
        Kind::Word(words) => {
            let text = value.read_lock::<rhai::ImmutableString>()?.to_string();
            words.contains(&text.as_str()).then_some(Argument::Text(text))
        }
        Kind::Text => value.read_lock::<rhai::ImmutableString>().map(|s| Argument::Text(s.to_string())),
    }
}

/// The value as messages show it: short.
fn shown(value: &Dynamic) -> String {
    const LONGEST: usize = 60;
    for (is_one, words) in [
        (value.is::<Handle>(), "an object"),
        (value.is::<SplineCurve>(), "a curve"),
        (value.is::<ControlMeaning>(), "a kind of spline"),
        (value.is::<Paint>(), "a pattern"),
        (value.is::<Number>(), "a pattern of numbers"),
        (value.is::<FacetTable>(), "a distribution"),
    ] {
        if is_one {
            return words.into();
        }
    }
    let text = format!("{value:?}");
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text,
    }
}
