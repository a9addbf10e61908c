//! Rows of surfaces, and of data that is read back.

use crate::command::reference::row::{InputRow, input};

/// Inputs and output of rendering nodes.
pub(super) const RENDERING_INPUTS: &[InputRow] = &[
    input("<1>", "integer 0", "swaps the original and the last rendering"),
    input("<1>", "integer 1, 2", "cross-section; sectioned, front half removed"),
    input("<1>", "integer 3, 4", "backface removal; hidden-line removal"),
    input("<1>", "integer 5 to 8", "wash, flat, smooth and highlight shading on the raster screen"),
    input("<1>", "Boolean", "TRUE shows the last rendering, FALSE the original"),
    input("<1>", "string", "keeps the rendering under that name"),
    input("<2>", "Boolean", "TRUE for a solid, FALSE for a surface"),
];

macro_rules! rendering_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

RENDERING {
    /// `SURFACE_RENDERING`.
    SurfaceRendering "SURFACE_RENDERING" [SurfaceRendering] help {
        section: "F.2",
        confidence: Confirmed,
        summary: "Polygons below can be rendered, as surfaces; output 1 tells when that is done",
        syntax: &["name := SURFace_rendering [APPLied TO name1];"],
        inputs: RENDERING_INPUTS,
        routines: &["PSURRE"],
        example: "RENDERED := SURFACE_RENDERING APPLIED TO PLATE;",
        ..PLAIN
    };

    /// `SOLID_RENDERING`.
    SolidRendering "SOLID_RENDERING" [SolidRendering] help {
        section: "F.2",
        summary: "As SURFACE_RENDERING, for closed solids",
        syntax: &["name := SOLID_rendering [APPLied TO name1];"],
        inputs: RENDERING_INPUTS,
        routines: &["PSOLRE"],
        example: "RENDERED := SOLID_RENDERING APPLIED TO BLOCK;",
        ..PLAIN
    };

    /// `SECTIONING_PLANE`.
    SectioningPlane "SECTIONING_PLANE" [SectioningPlane] help {
        section: "F.2",
        summary: "The first polygon below is the plane of sections",
        syntax: &["name := SECTioning_plane [APPLied TO name1];"],
        routines: &["PSECPL"],
        example: "CUT := SECTIONING_PLANE APPLIED TO PLATE;",
        ..PLAIN
    };
}

READING_BACK {
    /// `XFORM MATRIX`: marks a point of the structure whose accumulated matrix can be read.
    XformMatrix "XFORM MATRIX" [Xform Matrix] record 0x2e help {
        section: "B.9",
        confidence: Confirmed,
        summary: "A place whose accumulated matrix F:XFORMDATA reads",
        syntax: &["name := XFORM MATRIX [APPLied TO name1];"],
        routines: &["PXFMAT"],
        example: "PROBE := XFORM MATRIX APPLIED TO CAR;",
        ..PLAIN
    };

    /// `XFORM VECTOR`: marks data whose transformed vectors can be read.
    XformVector "XFORM VECTOR" [Xform Vector] help {
        section: "B.9",
        summary: "Data whose transformed vectors F:XFORMDATA reads",
        syntax: &["name := XFORM VECtor [APPLied TO name1];"],
        routines: &["PXFVEC"],
        example: "PROBE := XFORM VECTOR APPLIED TO CAR;",
        ..PLAIN
    };

    /// `CANCEL XFORM`: excludes what is below from an XFORM VECTOR above.
    CancelXform "CANCEL XFORM" [Cancel Xform] help {
        section: "B.9",
        summary: "Excludes what is below from an XFORM VECTOR above",
        syntax: &["name := CANCEL XFORM [APPLied TO name1];"],
        routines: &["PXFCAN"],
        example: "CANCEL XFORM APPLIED TO WHEELS;",
        ..PLAIN
    };

    /// `WRITEBACK`: marks data whose picture can be read.
    WriteBack "WRITEBACK" [WriteBack] help {
        section: "B.9",
        summary: "Data whose picture goes to the function WRITEBACK",
        syntax: &["name := WRITEBACK [APPLied TO name1];"],
        inputs: &[input("<1>", "Boolean", "TRUE reads the next update")],
        routines: &["PWRTBK"],
        example: "READER := WRITEBACK APPLIED TO CAR;",
        ..PLAIN
    };
}
    } };
}

pub(super) use rendering_rows;
