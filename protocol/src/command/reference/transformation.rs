//! Transformations.

use super::row::{CommandRow, Confidence::*, InputRow, PLAIN, input, option};

/// The input of nodes that hold a 3x3 matrix.
const MATRIX_3: &[InputRow] = &[input("<1>", "3x3 matrix", "replaces the matrix")];

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "ROTATE",
        section: "B.5",
        confidence: Confirmed,
        summary: "Turns what is below about an axis",
        syntax: &["name := ROTate [IN] X | Y | Z angle [APPLied TO name1];"],
        options: &[option("angle", "degrees; about Z counter-clockwise on the screen", "", "")],
        inputs: MATRIX_3,
        routines: &["PROTX", "PROTY", "PROTZ"],
        example: "TURN := ROTATE IN Y 30 APPLIED TO CAR;",
    },
    CommandRow {
        name: "SCALE",
        section: "B.5",
        confidence: Confirmed,
        summary: "Scales what is below",
        syntax: &["name := SCAle [BY] s | sx,sy[,sz] [APPLied TO name1];"],
        options: &[option("sz", "factor along z", "", "1; s for all three")],
        inputs: MATRIX_3,
        routines: &["PSCALE"],
        example: "SCALE BY 2,2,1 -> CAR;",
    },
    CommandRow {
        name: "TRANSLATE",
        section: "B.5",
        confidence: Confirmed,
        summary: "Moves what is below",
        syntax: &["name := TRANslate [BY] tx,ty[,tz] [APPLied TO name1];"],
        options: &[option("tz", "along z, into the screen", "", "0")],
        inputs: &[input("<1>", "3D or 2D vector", "replaces the translation")],
        routines: &["PTRANS"],
        example: "PLACE := TRANSLATE BY 0,-1.5 APPLIED TO CAR;",
    },
    CommandRow {
        name: "MATRIX_2X2",
        section: "B.5",
        summary: "Multiplies the matrix of the characters below",
        syntax: &["name := MATRIX_2x2 m11,m12 m21,m22 [APPLied TO name1];"],
        inputs: &[input("<1>", "2x2 matrix", "replaces the matrix")],
        routines: &["PMAT22"],
        example: "SLANT := MATRIX_2X2 1,0  0.2,1 APPLIED TO TITLE;",
        ..PLAIN
    },
    CommandRow {
        name: "MATRIX_3X3",
        section: "B.5",
        summary: "Multiplies the matrix of what is below; row vectors",
        syntax: &["name := MATRIX_3x3 m11,m12,m13 ... m33 [APPLied TO name1];"],
        inputs: MATRIX_3,
        routines: &["PMAT33"],
        example: "MIRROR := MATRIX_3X3 -1,0,0  0,1,0  0,0,1 APPLIED TO CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "MATRIX_4X3",
        section: "B.5",
        summary: "As MATRIX_3X3, with a translation in the fourth row",
        syntax: &["name := MATRIX_4X3 m11 ... m43 [APPLied TO name1];"],
        inputs: &[input("<1>", "4x3 matrix", "replaces the matrix, as F:LOOKAT makes it")],
        routines: &["PMAT43"],
        example: "MATRIX_4X3 1,0,0  0,1,0  0,0,1  5,0,0 APPLIED TO CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "MATRIX_4X4",
        section: "B.5",
        confidence: Confirmed,
        summary: "Multiplies the matrix of what is below, homogeneous",
        syntax: &["name := MATRIX_4X4 m11 ... m44 [APPLied TO name1];"],
        inputs: &[input("<1>", "4x4 matrix", "replaces the matrix, as F:WINDOW and F:FOV make it")],
        routines: &["PMAT44"],
        example: "MATRIX_4X4 1,0,0,0  0,1,0,0  0,0,1,0  0,0,0,1 APPLIED TO CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "LOOK",
        section: "B.5",
        confidence: Confirmed,
        summary: "Looks from one point at another",
        syntax: &[
            "name := LOOK AT ax,ay,az FROM fx,fy,fz [UP ux,uy,uz] [APPLied TO name1];",
            "name := LOOK FROM fx,fy,fz AT ax,ay,az [UP ux,uy,uz] [APPLied TO name1];",
        ],
        options: &[
            option("FROM", "the eye, which becomes the origin", "", ""),
            option("AT", "the point on the positive z axis", "", ""),
            option("UP", "a point that appears above AT", "", "AT + 0,1,0"),
        ],
        inputs: &[input("<1>", "4x3 matrix", "replaces the matrix, as F:LOOKAT makes it")],
        routines: &["PLOOKA"],
        example: "LOOK AT 0,0,0 FROM 3,2,-10 UP 0,1,0 APPLIED TO CAR;",
    },
];
