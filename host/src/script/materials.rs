//! Functions of the scene language that say of what objects are, one row each.

use super::argument::Bound;
use super::builder::{Builder, value};
use super::function::Function;
use super::handle::Done;
use super::lighting::{SPECTRUM, color_of_light};
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, OBJECT, Parameter, parameter};
use crate::color::{Color, shipped};
use crate::illumination::Paint;
use crate::illumination::material::{
    Body, Classic, Coated, Finish, Form, Index, Material, Metal, Principled, Shaped, Transparent,
};
use crate::illumination::texture::Number;
use rhai::Dynamic;

/// A roughness; 0 is polished.
const ROUGHNESS: Parameter = parameter(
    "roughness",
    Kind::Amount(0.0, 1000.0),
    Is("0: polished"),
    "roughness m: root mean square slope of its facets, times the root of 2",
);

/// A part of the whole.
const PART: Kind = Kind::Amount(0.0, 1.0);

/// What a transparent body absorbs.
const ABSORPTION: Parameter =
    parameter("absorption", Kind::Powers, Is("0"), "light falls by exp(-absorption) in one unit of length");

/// Which of several bodies in one place is there.
const fn priority(default: &'static str) -> Parameter {
    let most = Material::MOST_PRIORITY as i64;
    parameter(
        "priority",
        Kind::Integer(-most, most),
        Is(default),
        "of bodies that overlap, that of the greatest priority is there; of several with the same, the smallest",
    )
}

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "material",
        summary: "Says how the surface of an object reflects; what is not given becomes the default. Faces of a combined object keep what their operand was given.",
        parameters: &[
            OBJECT,
            parameter("diffuse", Kind::Reflectance, Is("0.7"), "diffusely reflected fraction"),
            parameter("specular", Kind::Reflectance, Is("0"), "fraction in the highlight"),
            parameter("exponent", Kind::Amount(1.0, Classic::MOST_EXPONENT), Is("50"), "sharpness of the highlight"),
            parameter("mirror", Kind::Reflectance, Is("0"), "mirrored fraction"),
            parameter("transparency", Kind::Reflectance, Is("0"), "fraction that goes straight through"),
        ],
        example: "pot.material(#{ diffuse: [0.8, 0.5, 0.3], specular: 0.1, exponent: 60, mirror: 0.1 });",
        action: |builder, bound| {
            let Classic { diffuse, specular, exponent, mirror, transparency } = Classic::default();
            let classic = Classic {
                diffuse: bound.paint("diffuse").unwrap_or(diffuse),
                specular: bound.paint("specular").unwrap_or(specular),
                exponent: bound.amount("exponent").unwrap_or(exponent),
                mirror: bound.paint("mirror").unwrap_or(mirror),
                transparency: bound.paint("transparency").unwrap_or(transparency),
            };
            give(builder, bound, Body::Classic(classic))
        },
    },
    Function {
        name: "metal",
        summary: "Makes an object of a metal, with the refractive indices that were measured of it.",
        parameters: &[
            OBJECT,
            parameter(
                "name",
                Kind::Text,
                Required,
                "brass, bronze, chromium, copper, gold, iron, nickel, silver, stainless_steel, titanium or another: peris db list names them",
            ),
            ROUGHNESS,
            parameter(
                "distribution",
                Kind::Text,
                Is("\"Beckmann, all\""),
                "how its facets are distributed: a member of the family that peris study illumination lists",
            ),
            parameter("along", Kind::Vector, Is("not brushed"), "the direction in which it is brushed"),
            parameter("across", Kind::Amount(0.0, 1000.0), Is("roughness"), "roughness across that direction"),
        ],
        example: "pot.metal(\"copper\", 0.2);",
        action: add_metal,
    },
    Function {
        name: "glass",
        summary: "Makes an object of glass, plastic or a gem: it reflects, refracts and absorbs. It must be closed. Where bodies overlap, that of the greatest priority is there: let water reach a little into the glass in which it stands.",
        parameters: &[
            OBJECT,
            parameter(
                "index",
                Kind::NumberOrText(1e-6, 1e6),
                Is("1.5"),
                "refractive index of all wavelengths, or the name of a glass that disperses, as BK7, SF11 or diamond",
            ),
            parameter("name", Kind::Text, Is("none"), "the name of a glass, instead of an index"),
            ROUGHNESS,
            ABSORPTION,
            priority("0"),
        ],
        example: "pot.glass(\"BK7\");",
        action: |builder, bound| {
            let named = |name: &str| shipped::glass(name).map(Index::Dispersive).map_err(|error| error.to_string());
            let index = match (bound.number("index"), bound.text("index"), bound.text("name")) {
                (None, None, None) => Index::Constant(1.5),
                (Some(index), None, None) => Index::Constant(index),
                (None, Some(name), None) | (None, None, Some(name)) => named(name)?,
                _ => return Err("give either an index or the name of a glass".into()),
            };
            transparent(builder, bound, Transparent::clear(index))
        },
    },
    Function {
        name: "water",
        summary: "Makes an object of water. It must be closed; in a vessel of glass, let it reach a little into the glass, which keeps its place.",
        parameters: &[OBJECT, ABSORPTION, ROUGHNESS, priority("-1")],
        example: "pot.water([0.35, 0.06, 0.02]);",
        action: |builder, bound| liquid(builder, bound, "water"),
    },
    Function {
        name: "liquid",
        summary: "Makes an object of a liquid. It must be closed; in a vessel of glass, let it reach a little into the glass, which keeps its place.",
        parameters: &[
            OBJECT,
            parameter("name", Kind::Text, Required, "water, ethanol, glycerol, acetone or toluene"),
            ABSORPTION,
            ROUGHNESS,
            priority("-1"),
        ],
        example: "pot.liquid(\"ethanol\", [0.1, 0.8, 2]);",
        action: |builder, bound| liquid(builder, bound, bound.text("name").unwrap_or_default()),
    },
    Function {
        name: "coated",
        summary: "Gives an object a diffuse ground under a transparent coat, as plastic, varnish and glaze have it.",
        parameters: &[
            OBJECT,
            parameter("diffuse", Kind::Reflectance, Is("0.7"), "what the ground reflects"),
            ROUGHNESS,
            parameter("index", Kind::Number(1e-6, 1e6), Is("1.5"), "refractive index of the coat"),
        ],
        example: "pot.coated([0.7, 0.1, 0.1], 0.05);",
        action: |builder, bound| {
            let diffuse = bound.paint("diffuse").unwrap_or(Paint::grey(0.7));
            let (index, roughness) = (bound.number("index").unwrap_or(1.5), roughness(bound));
            give(builder, bound, Body::Coated(Coated { diffuse, index, roughness }))
        },
    },
    Function {
        name: "principled",
        summary: "Gives an object the principled material, as many programs have it: metal, opaque ground and transparent body in any mixture, with a coat and a sheen. A white one loses no light. What is transparent and not thin must be closed.",
        parameters: &[
            OBJECT,
            parameter("base_color", Kind::Reflectance, Is("0.8"), "color of the ground, the metal or the glass"),
            parameter("roughness", PART, Is("0.5"), "0 is polished; the slope of its facets is the square of it"),
            parameter("metallic", PART, Is("0"), "the part that is a metal"),
            parameter("specular", PART, Is("1"), "how much its clear surface reflects, of what its index tells"),
            parameter("index", Kind::Number(1e-6, 1e6), Is("1.5"), "refractive index of surface and body"),
            parameter("transmission", PART, Is("0"), "the part that is transparent, of what is no metal"),
            parameter(
                "thin",
                Kind::Flag,
                Is("false"),
                "whether it is a thin wall, as a pane or a bubble, that bends nothing",
            ),
            ABSORPTION,
            parameter("coat", PART, Is("0"), "the part that has a clear coat"),
            parameter("coat_roughness", PART, Is("0"), "roughness of the coat"),
            parameter("coat_index", Kind::Number(1e-6, 1e6), Is("1.5"), "refractive index of the coat"),
            parameter("sheen", Kind::Reflectance, Is("0"), "the part that is a cloth, with a rim of this color"),
            parameter("sheen_roughness", PART, Is("0.3"), "how wide that rim is"),
            priority("0"),
        ],
        example: "pot.principled(#{ base_color: [0.5, 0.02, 0.02], metallic: 0.6, roughness: 0.4, coat: 1 });",
        action: |builder, bound| {
            let default = Principled::default();
            let amount = |name, default: Number| bound.amount(name).unwrap_or(default);
            let principled = Principled {
                base_color: bound.paint("base_color").unwrap_or(default.base_color),
                metallic: amount("metallic", default.metallic),
                roughness: amount("roughness", default.roughness),
                specular: amount("specular", default.specular),
                index: bound.number("index").unwrap_or(default.index),
                transmission: amount("transmission", default.transmission),
                thin: bound.flag("thin").unwrap_or(default.thin),
                absorption: bound.vector("absorption").map_or(default.absorption, Color::Bands),
                priority: priority_of(bound).unwrap_or(default.priority),
                coat: amount("coat", default.coat),
                coat_roughness: amount("coat_roughness", default.coat_roughness),
                coat_index: bound.number("coat_index").unwrap_or(default.coat_index),
                sheen: bound.paint("sheen").unwrap_or(default.sheen),
                sheen_roughness: amount("sheen_roughness", default.sheen_roughness),
            };
            give(builder, bound, Body::Principled(Box::new(principled)))
        },
    },
    Function {
        name: "shaped",
        summary: "Lets an object reflect a fraction, distributed by a member of the family of distributions.",
        parameters: &[
            OBJECT,
            parameter("reflectance", Kind::Reflectance, Required, "the reflected fraction K"),
            parameter("distribution", Kind::Distribution, Required, "its name, as peris study illumination lists it"),
            parameter("roughness", Kind::Amount(0.0, 1000.0), Is("0.3"), "its roughness m; not of one of the user's"),
        ],
        example: "pot.shaped(#{ reflectance: 0.6, distribution: \"Blinn\", roughness: 0.2 });",
        action: |builder, bound| {
            let form = match (bound.facets("distribution"), bound.amount("roughness")) {
                (Some(_), Some(_)) => return Err("a distribution of the user's has no roughness".into()),
                (Some(table), None) => Form::Facets(table),
                (None, roughness) => Form::Member {
                    name: bound.text("distribution").unwrap_or_default().to_owned(),
                    roughness: roughness.unwrap_or(Number::Constant(0.3)),
                },
            };
            let reflectance = bound.paint("reflectance").unwrap_or(Paint::grey(0.0));
            give(builder, bound, Body::Shaped(Shaped { reflectance, form }))
        },
    },
    Function {
        name: "user_distribution",
        summary: "Makes a distribution for shaped() of the area of facets per solid angle of their normals, a function of the angle between facet and surface. It is scaled to a whole surface, masked after Smith, and sampled to a table; peris plan tells how well the table stands for it.",
        parameters: &[parameter(
            "area",
            Kind::Function,
            Required,
            "of the angle in radians, 0 to pi/2; finite, not negative, of any unit",
        )],
        example: "pot.shaped(0.8, user_distribution(|angle| exp(-angle * angle / 0.09)));",
        action: |_, bound| Ok(bound.facets("area").map_or(Dynamic::UNIT, Dynamic::from)),
    },
    Function {
        name: "emits",
        summary: "Lets the surface of an object emit light, beside what it reflects.",
        parameters: &[OBJECT, parameter("radiance", Kind::Powers, Required, "its radiance, W/(m² sr)"), SPECTRUM],
        example: "pot.emits([3, 2, 1]);",
        action: |builder, bound| {
            let emission = color_of_light(builder, bound, bound.vector("radiance").unwrap_or_default())?;
            let object = builder.object(bound.object("object"))?;
            object.material.get_or_insert_default().emission = emission;
            Ok(value(bound.object("object")))
        },
    },
];

/// Gives an object a body; what it emits and its relief stay.
fn give(builder: &mut Builder, bound: &Bound, body: Body) -> Done {
    let object = builder.object(bound.object("object"))?;
    let Material { emission, relief, .. } = object.material.clone().unwrap_or_default();
    let material = Material { body, emission, relief };
    material.check().map_err(|error| error.to_string())?;
    object.material = Some(material);
    Ok(value(bound.object("object")))
}

fn roughness(bound: &Bound) -> Number {
    bound.amount("roughness").unwrap_or(Number::Constant(0.0))
}

fn liquid(builder: &mut Builder, bound: &Bound, name: &str) -> Done {
    let liquid = shipped::liquid(name).map_err(|error| error.to_string())?;
    let clear = Transparent::clear(Index::Dispersive(liquid));
    transparent(builder, bound, Transparent { priority: Transparent::LIQUID, ..clear })
}

/// Gives an object what is transparent, with the roughness, the absorption and the priority of a call.
fn transparent(builder: &mut Builder, bound: &Bound, clear: Transparent) -> Done {
    let absorption = bound.vector("absorption").map_or(clear.absorption, Color::Bands);
    let priority = priority_of(bound).unwrap_or(clear.priority);
    let body = Transparent { roughness: roughness(bound), absorption, priority, ..clear };
    give(builder, bound, Body::Transparent(body))
}

fn priority_of(bound: &Bound) -> Option<i32> {
    bound.integer("priority").and_then(|priority| i32::try_from(priority).ok())
}

fn add_metal(builder: &mut Builder, bound: &Bound) -> Done {
    let shipped::Metal { n, k } =
        builder.library.metal(bound.text("name").unwrap_or_default()).map_err(|error| error.to_string())?;
    let roughness = roughness(bound);
    let name = bound.text("distribution");
    let finish = match (bound.vector("along"), bound.amount("across")) {
        (Some(along), across) => {
            if along.try_normalize().is_none() {
                return Err("along must not have the length 0".into());
            }
            if name.is_some() {
                return Err("a brushed metal has Beckmann's facets; leave the distribution out".into());
            }
            let across = across.unwrap_or_else(|| roughness.clone());
            Finish::Brushed { roughness: [roughness, across], along }
        }
        (None, Some(_)) => return Err("across needs along".into()),
        (None, None) if roughness == Number::Constant(0.0) => Finish::Polished,
        (None, None) => Finish::Rough { name: name.unwrap_or("Beckmann, all").to_owned(), roughness },
    };
    give(builder, bound, Body::Metal(Metal { n, k, finish }))
}
