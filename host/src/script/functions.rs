//! The tables of all functions.

use super::function::Function;
use super::{
    daylight, instancing, lighting, materials, plants, procedural, rocks, shaping, showing, solids, stored,
    subdividing, surfaces, table, terrain, texturing, wind,
};

/// The tables of functions that give objects their shapes.
const SHAPES: [&[Function]; 9] = [
    solids::FUNCTIONS,
    shaping::FUNCTIONS,
    surfaces::FUNCTIONS,
    subdividing::FUNCTIONS,
    terrain::FUNCTIONS,
    instancing::FUNCTIONS,
    procedural::FUNCTIONS,
    plants::FUNCTIONS,
    rocks::FUNCTIONS,
];

/// Every function that a script may call: those that make and combine objects, then the others.
pub fn functions() -> impl Iterator<Item = &'static Function> {
    let others = [
        wind::FUNCTIONS,
        materials::FUNCTIONS,
        texturing::FUNCTIONS,
        lighting::FUNCTIONS,
        daylight::FUNCTIONS,
        showing::FUNCTIONS,
        stored::FUNCTIONS,
        table::FUNCTIONS,
    ];
    SHAPES.into_iter().chain(others).flatten()
}

/// Whether a function gives an object its shape, rather than a place, a material or a name.
pub(super) fn makes_shapes(function: &Function) -> bool {
    SHAPES.into_iter().flatten().any(|row| row.name == function.name)
}

/// The reference of all functions, as Markdown.
pub fn reference() -> String {
    let mut text = String::from("# Functions of a scene script\n");
    for function in functions() {
        text.push_str(&format!("\n## {}\n\n```\n{}\n```\n", function.name, function.help()));
    }
    text
}
