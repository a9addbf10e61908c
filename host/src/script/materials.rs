//! Functions of the scene language that say of what objects are, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::{CallResult, Handle};
use super::kinds::{
    AmountKind, DistributionKind, DistributionValue, Flag, FunctionOfAngle, Integer, NumberKind, NumberOrText,
    NumberOrTextValue, Powers, Reflectance, TextKind, Vector,
};
use super::lighting::{SPECTRUM, color_of_light};
use super::made_of::{DIFFUSE, EXPONENT, MIRROR, SPECULAR, TRANSPARENCY};
use super::parameter::{Defaulted, Optional, optional, required, with_default};
use super::shared::OBJECT;
use crate::color::{Color, shipped};
use crate::illumination::distribution::FacetForm;
use crate::illumination::material::{
    Classic, Coated, Distributed, DistributionForm, Finish, Material, MaterialKind, Metal, Principled, RefractiveIndex,
    Translucent, Transparent,
};
use crate::illumination::texture::NumberTexture as PaintedNumber;
use glam::DVec3;
use rhai::Dynamic;

/// A roughness; 0 is polished.
const ROUGHNESS: Defaulted<AmountKind, f64> = with_default(
    AmountKind(0.0, 1000.0),
    0.0,
    "roughness m: root mean square slope of its facets, times the root of 2",
)
.note("polished");

/// How the facets of a rough surface are distributed.
const FACETS: Optional<DistributionKind> = optional(
    DistributionKind,
    "\"GGX, all\"",
    "how its facets are distributed: \"GGX, all\", \"Beckmann, all\", these without \", all\" for a single reflection, or what user_distribution() returned",
);

/// A part of the whole.
const PART: AmountKind = AmountKind(0.0, 1.0);

/// Refractive indices.
const INDEX: NumberKind = NumberKind(1e-6, 1e6);

/// What a transparent body absorbs.
const ABSORPTION: Defaulted<Powers, f64> =
    with_default(Powers, 0.0, "light falls by exp(-absorption) in one unit of length");

/// The priority by which one of several bodies in one place is there.
const fn priority(default: i32) -> Defaulted<Integer<i32>, i32> {
    with_default(
        Integer(-Material::MOST_PRIORITY, Material::MOST_PRIORITY),
        default,
        "of bodies that overlap, that of the greatest priority is there; of several with the same, the smallest",
    )
}

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        material(
            object: OBJECT,
            diffuse: DIFFUSE,
            specular: SPECULAR,
            exponent: EXPONENT,
            mirror: MIRROR,
            transparency: TRANSPARENCY,
        )
        "Says how the surface of an object reflects; what is not given becomes the default. Faces of a combined object keep what their operand was given."
        "pot.material(#{ diffuse: [0.8, 0.5, 0.3], specular: 0.1, exponent: 60, mirror: 0.1 });"
        |builder| {
            let classic = Classic { diffuse, specular, exponent, mirror, transparency };
            give(builder, object, MaterialKind::Classic(classic))
        }
    },
    function! {
        metal(
            object: OBJECT,
            name: required(
                TextKind,
                "brass, bronze, chromium, copper, gold, iron, nickel, silver, stainless_steel, titanium or another: peris db list names them",
            ),
            roughness: ROUGHNESS,
            distribution: optional(
                DistributionKind,
                "\"GGX, all\"",
                "how its facets are distributed: a member of the family that peris study illumination lists, or what user_distribution() returned",
            ),
            along: optional(Vector, "not brushed", "the direction in which it is brushed"),
            across: optional(AmountKind(0.0, 1000.0), "roughness", "roughness across that direction"),
        )
        "Makes an object of a metal, with the refractive indices that were measured of it."
        "pot.metal(\"copper\", 0.2);"
        |builder| {
            let shipped::ComplexIndex { n, k } = builder.databases.library.metal(&name).map_err(|error| error.to_string())?;
            let finish = match (along, across) {
                (Some(along), _) if along.try_normalize().is_none() => {
                    return Err("along must not have the length 0".into());
                }
                (Some(along), across) => {
                    let across = across.unwrap_or_else(|| roughness.clone());
                    let name = match distribution {
                        Some(DistributionValue::Table(_)) => {
                            return Err("a brushed metal has the facets of \"GGX\" or \"Beckmann\"".into());
                        }
                        Some(DistributionValue::Name(name)) => name,
                        None => "GGX".into(),
                    };
                    Finish::Brushed { name, roughness: [roughness, across], along }
                }
                (None, Some(_)) => return Err("across needs along".into()),
                (None, None) => match facet_form(distribution, &roughness)? {
                    FacetForm::Table(table) => Finish::Facets(table),
                    FacetForm::Model(_) if roughness == PaintedNumber::Constant(0.0) => Finish::Polished,
                    FacetForm::Model(name) => Finish::Rough { name, roughness },
                },
            };
            give(builder, object, MaterialKind::Metal(Metal { n, k, finish }))
        }
    },
    function! {
        glass(
            object: OBJECT,
            index: optional(
                NumberOrText(1e-6, 1e6),
                "1.5",
                "refractive index of all wavelengths, or the name of a glass that disperses, as BK7, SF11 or diamond",
            ),
            name: optional(TextKind, "none", "the name of a glass, instead of an index"),
            roughness: ROUGHNESS,
            absorption: ABSORPTION,
            priority: priority(0),
            distribution: FACETS,
        )
        "Makes an object of glass, plastic or a gem: it reflects, refracts and absorbs. It must be closed. Where bodies overlap, that of the greatest priority is there: let water reach a little into the glass in which it stands."
        "pot.glass(\"BK7\");"
        |builder| {
            let named = |name: &str| shipped::glass(name).map(RefractiveIndex::Dispersive).map_err(|error| error.to_string());
            let index = match (index, name) {
                (None, None) => RefractiveIndex::Constant(1.5),
                (Some(NumberOrTextValue::Number(index)), None) => RefractiveIndex::Constant(index),
                (None, Some(name)) | (Some(NumberOrTextValue::Text(name)), None) => named(&name)?,
                _ => return Err("give either an index or the name of a glass".into()),
            };
            let facets = facet_form(distribution, &roughness)?;
            transparent(builder, object, Transparent { roughness, facets, priority, ..absorbing(index, absorption) })
        }
    },
    function! {
        water(
            object: OBJECT,
            absorption: ABSORPTION,
            roughness: ROUGHNESS,
            priority: priority(Transparent::LIQUID),
            distribution: FACETS,
        )
        "Makes an object of water. It must be closed; in a vessel of glass, let it reach a little into the glass, which keeps its place."
        "pot.water([0.35, 0.06, 0.02]);"
        |builder| {
            let index = liquid("water")?;
            let facets = facet_form(distribution, &roughness)?;
            transparent(builder, object, Transparent { roughness, facets, priority, ..absorbing(index, absorption) })
        }
    },
    function! {
        liquid(
            object: OBJECT,
            name: required(TextKind, "water, ethanol, glycerol, acetone or toluene"),
            absorption: ABSORPTION,
            roughness: ROUGHNESS,
            priority: priority(Transparent::LIQUID),
            distribution: FACETS,
        )
        "Makes an object of a liquid. It must be closed; in a vessel of glass, let it reach a little into the glass, which keeps its place."
        "pot.liquid(\"ethanol\", [0.1, 0.8, 2]);"
        |builder| {
            let index = liquid(&name)?;
            let facets = facet_form(distribution, &roughness)?;
            transparent(builder, object, Transparent { roughness, facets, priority, ..absorbing(index, absorption) })
        }
    },
    function! {
        coated(
            object: OBJECT,
            diffuse: with_default(Reflectance, 0.7, "what the ground reflects"),
            roughness: ROUGHNESS,
            index: with_default(INDEX, 1.5, "refractive index of the coat"),
        )
        "Gives an object a diffuse ground under a transparent coat, as plastic, varnish and glaze have it."
        "pot.coated([0.7, 0.1, 0.1], 0.05);"
        |builder| give(builder, object, MaterialKind::Coated(Coated { diffuse, index, roughness }))
    },
    function! {
        translucent(
            object: OBJECT,
            diffuse: with_default(Reflectance, 0.3, "diffusely reflected fraction"),
            transmittance: with_default(Reflectance, 0.3, "fraction that comes through, diffusely; with what is reflected no more than 1"),
            coat: optional(AmountKind(0.0, 1000.0), "no coat", "roughness of a transparent coat of index 1.4, as of wax on leaves"),
        )
        "Makes an object a thin sheet that light comes through diffusely: leaves, petals, paper, cloth. Both sides are alike."
        "let leaf = ground(1).rotate(\"x\", 60); leaf.translucent([0.08, 0.14, 0.02], [0.09, 0.16, 0.01], #{ coat: 0.4 });"
        |builder| {
            let sheet = Translucent { diffuse, transmittance, coat };
            give(builder, object, MaterialKind::Translucent(Box::new(sheet)))
        }
    },
    function! {
        principled(
            object: OBJECT,
            base_color: with_default(Reflectance, 0.8, "color of the ground, the metal or the glass"),
            roughness: with_default(PART, 0.5, "0 is polished; the slope of its facets is the square of it"),
            metallic: with_default(PART, 0.0, "the part that is a metal"),
            specular: with_default(PART, 1.0, "how much its clear surface reflects, of what its index tells"),
            index: with_default(INDEX, 1.5, "refractive index of surface and body"),
            transmission: with_default(PART, 0.0, "the part that is transparent, of what is no metal"),
            thin: with_default(Flag, false, "whether it is a thin wall, as a pane or a bubble, that bends nothing"),
            absorption: ABSORPTION,
            coat: with_default(PART, 0.0, "the part that has a clear coat"),
            coat_roughness: with_default(PART, 0.0, "roughness of the coat"),
            coat_index: with_default(INDEX, 1.5, "refractive index of the coat"),
            sheen: with_default(Reflectance, 0.0, "the part that is a cloth, with a rim of this color"),
            sheen_roughness: with_default(PART, 0.3, "how wide that rim is"),
            priority: priority(0),
        )
        "Gives an object the principled material, as many programs have it: metal, opaque ground and transparent body in any mixture, with a coat and a sheen. A white one loses no light. What is transparent and not thin must be closed."
        "pot.principled(#{ base_color: [0.5, 0.02, 0.02], metallic: 0.6, roughness: 0.4, coat: 1 });"
        |builder| {
            let principled = Principled {
                base_color,
                metallic,
                roughness,
                specular,
                index,
                transmission,
                thin,
                absorption: Color::Bands(absorption),
                priority,
                coat,
                coat_roughness,
                coat_index,
                sheen,
                sheen_roughness,
            };
            give(builder, object, MaterialKind::Principled(Box::new(principled)))
        }
    },
    function! {
        shaped(
            object: OBJECT,
            reflectance: required(Reflectance, "the reflected fraction K"),
            distribution: required(DistributionKind, "its name, as peris study illumination lists it"),
            roughness: optional(AmountKind(0.0, 1000.0), "0.3", "its roughness m; not of one of the user's"),
        )
        "Lets an object reflect a fraction, distributed by a member of the family of distributions."
        "pot.shaped(#{ reflectance: 0.6, distribution: \"Blinn\", roughness: 0.2 });"
        |builder| {
            let form = match (distribution, roughness) {
                (DistributionValue::Table(_), Some(_)) => {
                    return Err("a distribution of the user's has no roughness".into());
                }
                (DistributionValue::Table(table), None) => DistributionForm::Facets(table),
                (DistributionValue::Name(name), roughness) => {
                    DistributionForm::Member { name, roughness: roughness.unwrap_or(PaintedNumber::Constant(0.3)) }
                }
            };
            give(builder, object, MaterialKind::Shaped(Distributed { reflectance, form }))
        }
    },
    function! {
        user_distribution(
            area: required(FunctionOfAngle, "of the angle in radians, 0 to pi/2; finite, not negative, of any unit"),
        )
        "Makes a distribution for shaped(), metal() and glass() of the area of facets per solid angle of their normals, a function of the angle between facet and surface. It is scaled to a whole surface, masked after Smith, and sampled to a table; peris plan tells how well the table stands for it."
        "pot.shaped(0.8, user_distribution(|angle| exp(-angle * angle / 0.09)));"
        |_| Ok(Dynamic::from(area))
    },
    function! {
        emits(object: OBJECT, radiance: required(Powers, "its radiance, W/(m² sr)"), spectrum: SPECTRUM)
        "Lets the surface of an object emit light, beside what it reflects."
        "pot.emits([3, 2, 1]);"
        |builder| {
            let emission = color_of_light(builder, spectrum.as_deref(), radiance)?;
            builder.object(object)?.material.get_or_insert_default().emission = emission;
            Ok(Dynamic::from(object))
        }
    },
];

/// Gives an object a body; what it emits and its relief stay.
fn give(builder: &mut Builder, handle: Handle, body: MaterialKind) -> CallResult {
    let object = builder.object(handle)?;
    let Material { emission, relief, .. } = object.material.clone().unwrap_or_default();
    let material = Material { body, emission, relief };
    material.check().map_err(|error| error.to_string())?;
    object.material = Some(material);
    Ok(Dynamic::from(handle))
}

/// The facets that a distribution tells; the table of a user's has its roughness in it.
fn facet_form(distribution: Option<DistributionValue>, roughness: &PaintedNumber) -> Result<FacetForm, String> {
    match distribution {
        None => Ok(FacetForm::default()),
        Some(DistributionValue::Name(name)) => Ok(FacetForm::Model(name)),
        Some(DistributionValue::Table(_)) if *roughness != PaintedNumber::Constant(0.0) => {
            Err("a distribution of the user's has no roughness".into())
        }
        Some(DistributionValue::Table(table)) => Ok(FacetForm::Table(table)),
    }
}

fn transparent(builder: &mut Builder, handle: Handle, body: Transparent) -> CallResult {
    give(builder, handle, MaterialKind::Transparent(body))
}

/// A polished body that absorbs.
fn absorbing(index: RefractiveIndex, absorption: DVec3) -> Transparent {
    Transparent { absorption: Color::Bands(absorption), ..Transparent::clear(index) }
}

/// The refractive index of a liquid that ships with the program.
fn liquid(name: &str) -> Result<RefractiveIndex, String> {
    shipped::liquid(name).map(RefractiveIndex::Dispersive).map_err(|error| error.to_string())
}
