//! Surfaces, and data that is read back.

use super::row::{CommandRow, Confidence::*, InputRow, PLAIN, input, option};

/// Inputs and output of rendering nodes.
const RENDERING: &[InputRow] = &[
    input("<1>", "integer 0", "swaps the original and the last rendering"),
    input("<1>", "integer 1, 2", "cross-section; sectioned, front half removed"),
    input("<1>", "integer 3, 4", "backface removal; hidden-line removal"),
    input("<1>", "integer 5 to 8", "wash, flat, smooth and highlight shading on the raster screen"),
    input("<1>", "Boolean", "TRUE shows the last rendering, FALSE the original"),
    input("<1>", "string", "keeps the rendering under that name"),
    input("<2>", "Boolean", "TRUE for a solid, FALSE for a surface"),
];

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "SURFACE_RENDERING",
        section: "F.2",
        confidence: Confirmed,
        summary: "Polygons below can be rendered, as surfaces; output 1 tells when that is done",
        syntax: &["name := SURFace_rendering [APPLied TO name1];"],
        inputs: RENDERING,
        routines: &["PSURRE"],
        example: "RENDERED := SURFACE_RENDERING APPLIED TO PLATE;",
        ..PLAIN
    },
    CommandRow {
        name: "SOLID_RENDERING",
        section: "F.2",
        summary: "As SURFACE_RENDERING, for closed solids",
        syntax: &["name := SOLID_rendering [APPLied TO name1];"],
        inputs: RENDERING,
        routines: &["PSOLRE"],
        example: "RENDERED := SOLID_RENDERING APPLIED TO BLOCK;",
        ..PLAIN
    },
    CommandRow {
        name: "SECTIONING_PLANE",
        section: "F.2",
        summary: "The first polygon below is the plane of sections",
        syntax: &["name := SECTioning_plane [APPLied TO name1];"],
        routines: &["PSECPL"],
        example: "CUT := SECTIONING_PLANE APPLIED TO PLATE;",
        ..PLAIN
    },
    CommandRow {
        name: "RESERVE_WORKING_STORAGE",
        section: "B.3",
        confidence: Confirmed,
        summary: "Memory for rendering; to be given before, unless 1,000 vertices are enough",
        syntax: &["RESERVE_WORKING_STORAGE bytes;"],
        options: &[option("bytes", "about 50 for each vertex; a larger request replaces the first", "0 and up", "")],
        routines: &["PRSVST"],
        example: "RESERVE_WORKING_STORAGE 100000;",
        ..PLAIN
    },
    CommandRow {
        name: "XFORM MATRIX",
        section: "B.9",
        confidence: Confirmed,
        summary: "A place whose accumulated matrix F:XFORMDATA reads",
        syntax: &["name := XFORM MATRIX [APPLied TO name1];"],
        routines: &["PXFMAT"],
        example: "PROBE := XFORM MATRIX APPLIED TO CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "XFORM VECTOR",
        section: "B.9",
        summary: "Data whose transformed vectors F:XFORMDATA reads",
        syntax: &["name := XFORM VECtor [APPLied TO name1];"],
        routines: &["PXFVEC"],
        example: "PROBE := XFORM VECTOR APPLIED TO CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "CANCEL XFORM",
        section: "B.9",
        summary: "Excludes what is below from an XFORM VECTOR above",
        syntax: &["name := CANCEL XFORM [APPLied TO name1];"],
        routines: &["PXFCAN"],
        example: "CANCEL XFORM APPLIED TO WHEELS;",
        ..PLAIN
    },
    CommandRow {
        name: "WRITEBACK",
        section: "B.9",
        summary: "Data whose picture goes to the function WRITEBACK",
        syntax: &["name := WRITEBACK [APPLied TO name1];"],
        inputs: &[input("<1>", "Boolean", "TRUE reads the next update")],
        routines: &["PWRTBK"],
        example: "READER := WRITEBACK APPLIED TO CAR;",
        ..PLAIN
    },
];
