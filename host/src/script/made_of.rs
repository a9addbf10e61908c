//! Materials of what is no object: from a map, from an object, or from a database.

use super::builder::Builder;
use super::given::BoundArguments;
use super::kinds::{AmountKind, MaterialOrigin, Reflectance};
use super::parameter::{Defaulted, Parameter, with_default};
use crate::database::{Library, Record, RecordContent, RecordKind};
use crate::illumination::material::{Classic, Material, MaterialKind};
use rhai::Dynamic;

/// What material() takes, and a map that stands for it.
pub(super) const DIFFUSE: Defaulted<Reflectance, f64> = with_default(Reflectance, 0.7, "diffusely reflected fraction");
pub(super) const SPECULAR: Defaulted<Reflectance, f64> =
    with_default(Reflectance, 0.0, "fraction in the highlight, the same at every incidence");
pub(super) const EXPONENT: Defaulted<AmountKind, f64> =
    with_default(AmountKind(1.0, Classic::MOST_EXPONENT), 50.0, "sharpness of the highlight");
pub(super) const MIRROR: Defaulted<Reflectance, f64> = with_default(Reflectance, 0.0, "mirrored fraction");
pub(super) const TRANSPARENCY: Defaulted<Reflectance, f64> =
    with_default(Reflectance, 0.0, "fraction that goes straight through");

/// The material that a script tells of something that is no object, checked.
pub(super) fn material_from(builder: &mut Builder, origin: MaterialOrigin) -> Result<Material, String> {
    let material = match origin {
        MaterialOrigin::Map(map) => MaterialKind::Classic(classic(&map, &builder.databases.library)?).into(),
        MaterialOrigin::Object(handle) => builder.object(handle)?.own_material().unwrap_or_default(),
        MaterialOrigin::Record(name) => {
            let found =
                builder.databases.library.record(RecordKind::Material, &name).map_err(|error| error.to_string())?;
            match found {
                (Record { content: RecordContent::Material(material), .. }, _) => *material,
                _ => Material::default(),
            }
        }
    };
    material.check().map_err(|error| error.to_string())?;
    Ok(material)
}

/// What a map says that has what material() takes.
fn classic(map: &Dynamic, library: &Library) -> Result<Classic, String> {
    let parameters = [
        Parameter { name: "diffuse", takes: &DIFFUSE },
        Parameter { name: "specular", takes: &SPECULAR },
        Parameter { name: "exponent", takes: &EXPONENT },
        Parameter { name: "mirror", takes: &MIRROR },
        Parameter { name: "transparency", takes: &TRANSPARENCY },
    ];
    let usage = || "a map of what material() takes".into();
    let mut given = BoundArguments::new(&parameters, usage, std::slice::from_ref(map))?;
    Ok(Classic {
        diffuse: given.next("diffuse", &DIFFUSE, library)?,
        specular: given.next("specular", &SPECULAR, library)?,
        exponent: given.next("exponent", &EXPONENT, library)?,
        mirror: given.next("mirror", &MIRROR, library)?,
        transparency: given.next("transparency", &TRANSPARENCY, library)?,
    })
}
