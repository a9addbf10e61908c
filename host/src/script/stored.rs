//! Functions of the scene language that take things from databases, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::kinds::TextKind;
use super::lighting::add;
use super::parameter::{Required, required};
use super::shared::OBJECT;
use crate::database::{self, Record, RecordContent};
use crate::scene::Shape;
use rhai::Dynamic;
use std::path::PathBuf;

const NAME: Required<TextKind> = required(TextKind, "its name in an open database, as peris db list tells");

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        use_database(file: required(TextKind, "its path; relative to the folder of the script"))
        "Opens a database: its materials, lights, geometry, reflectances, spectra of lights and metals can be used by their names, before those that ship with the program."
        "use_database(\"studio.redb\");"
        |builder| {
            let path = builder.folders.file(&file)?;
            builder.databases.open(&path)?;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        stored(object: OBJECT, name: NAME)
        "Gives an object a material of a database; what it emits is that of the material."
        "ball.stored(\"copper\");"
        |builder| {
            let (record, _) = find(builder, &name, database::RecordKind::Material)?;
            if let Record { content: RecordContent::Material(material), .. } = record {
                builder.object(object)?.material = Some(*material);
            }
            Ok(Dynamic::from(object))
        }
    },
    function! {
        stored_light(name: NAME)
        "Adds a light of a database, where it was when it was stored."
        "stored_light(\"window\");"
        |builder| match find(builder, &name, database::RecordKind::Light)? {
            (Record { content: RecordContent::Light(light), .. }, _) => add(builder, *light),
            _ => Ok(Dynamic::UNIT),
        }
    },
    function! {
        stored_mesh(name: NAME)
        "Adds geometry of a database as an object."
        "let rabbit = stored_mesh(\"bunny\");"
        |builder| {
            let (_, database) = find(builder, &name, database::RecordKind::Geometry)?;
            builder.add(Shape::Stored { database, name }, None).map(Dynamic::from)
        }
    },
];

/// A record and the file that holds it.
fn find(builder: &Builder, name: &str, kind: database::RecordKind) -> Result<(Record, Option<PathBuf>), String> {
    builder.databases.library.record(kind, name).map_err(|error| error.to_string())
}
