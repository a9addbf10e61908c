//! Functions of the scene language that take things from databases, one row each.

use super::argument::Bound;
use super::builder::{Builder, value};
use super::function::Function;
use super::lighting::add;
use super::parameter::Default::Required;
use super::parameter::{Kind, OBJECT, Parameter, parameter};
use crate::database::{self, Content, Record};
use crate::scene::Shape;
use rhai::Dynamic;
use std::path::PathBuf;

const NAME: Parameter = parameter("name", Kind::Text, Required, "its name in an open database, as peris db list tells");

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "use_database",
        summary: "Opens a database: its materials, lights, geometry, reflectances, spectra of lights and metals can be used by their names, before those that ship with the program.",
        parameters: &[parameter("file", Kind::Text, Required, "its path; relative to the folder of the script")],
        example: "use_database(\"studio.redb\");",
        action: |builder, bound| {
            let path = builder.folders.file(bound.text("file").unwrap_or_default())?;
            builder.library.open(&path).map_err(|error| error.to_string())?;
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "stored",
        summary: "Gives an object a material of a database; what it emits is that of the material.",
        parameters: &[OBJECT, NAME],
        example: "ball.stored(\"copper\");",
        action: |builder, bound| {
            if let (Record { content: Content::Material(material), .. }, _) =
                find(builder, bound, database::Kind::Material)?
            {
                builder.object(bound.object("object"))?.material = Some(*material);
            }
            Ok(value(bound.object("object")))
        },
    },
    Function {
        name: "stored_light",
        summary: "Adds a light of a database, where it was when it was stored.",
        parameters: &[NAME],
        example: "stored_light(\"window\");",
        action: |builder, bound| match find(builder, bound, database::Kind::Light)? {
            (Record { content: Content::Light(light), .. }, _) => add(builder, *light),
            _ => Ok(Dynamic::UNIT),
        },
    },
    Function {
        name: "stored_mesh",
        summary: "Adds geometry of a database as an object.",
        parameters: &[NAME],
        example: "let rabbit = stored_mesh(\"bunny\");",
        action: |builder, bound| {
            let name = bound.text("name").unwrap_or_default().to_owned();
            let (_, database) = find(builder, bound, database::Kind::Geometry)?;
            builder.add(Shape::Stored { database, name }, None).map(Dynamic::from)
        },
    },
];

/// A record and the file that holds it.
fn find(builder: &Builder, bound: &Bound, kind: database::Kind) -> Result<(Record, Option<PathBuf>), String> {
    let name = bound.text("name").unwrap_or_default();
    builder.library.record(kind, name).map_err(|error| error.to_string())
}
