//! Rows of the transformations.

use crate::command::reference::row::{InputRow, input};

/// The input of nodes that hold a 3x3 matrix.
pub(super) const MATRIX_3: &[InputRow] = &[input("<1>", "3x3 matrix", "replaces the matrix")];

macro_rules! transformation_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

TRANSFORMATIONS {
    /// `ROTATE IN X angle`, degrees.
    Rotate {
        /// About which axis.
        axis: Axis = optional(Word::In, AxisLetter),
        /// Degrees, left-hand rule.
        angle: f64 = Real,
    } "ROTATE" [Rotate] record 0x20 help {
        section: "B.5",
        confidence: Confirmed,
        summary: "Turns what is below about an axis",
        syntax: &["name := ROTate [IN] X | Y | Z angle [APPLied TO name1];"],
        options: &[option("angle", "degrees; about Z counter-clockwise on the screen", "", "")],
        inputs: MATRIX_3,
        routines: &["PROTX", "PROTY", "PROTZ"],
        example: "TURN := ROTATE IN Y 30 APPLIED TO CAR;",
    };

    /// `SCALE BY s` or `sx,sy,sz`.
    Scale(factor: DVec3 = optional(Word::By, Factors)) "SCALE" [Scale] record 0x21 help {
        section: "B.5",
        confidence: Confirmed,
        summary: "Scales what is below",
        syntax: &["name := SCAle [BY] s | sx,sy[,sz] [APPLied TO name1];"],
        options: &[option("sz", "factor along z", "", "1; s for all three")],
        inputs: MATRIX_3,
        routines: &["PSCALE"],
        example: "SCALE BY 2,2,1 -> CAR;",
    };

    /// `TRANSLATE BY tx,ty,tz`.
    Translate(component: DVec3 = optional(Word::By, Place)) "TRANSLATE" [Translate] record 0x22 help {
        section: "B.5",
        confidence: Confirmed,
        summary: "Moves what is below",
        syntax: &["name := TRANslate [BY] tx,ty[,tz] [APPLied TO name1];"],
        options: &[option("tz", "along z, into the screen", "", "0")],
        inputs: &[input("<1>", "3D or 2D vector", "replaces the translation")],
        routines: &["PTRANS"],
        example: "PLACE := TRANSLATE BY 0,-1.5 APPLIED TO CAR;",
    };

    /// `MATRIX_2X2`: multiplies the character matrix.
    Matrix2(rows: DMat2 = Matrix2) "MATRIX_2X2" [Matrix2] record 0x23 help {
        section: "B.5",
        summary: "Multiplies the matrix of the characters below",
        syntax: &["name := MATRIX_2x2 m11,m12 m21,m22 [APPLied TO name1];"],
        inputs: &[input("<1>", "2x2 matrix", "replaces the matrix")],
        routines: &["PMAT22"],
        example: "SLANT := MATRIX_2X2 1,0  0.2,1 APPLIED TO TITLE;",
        ..PLAIN
    };

    /// `MATRIX_3X3`.
    Matrix3(rows: DMat3 = Matrix3) "MATRIX_3X3" [Matrix3] record 0x24 help {
        section: "B.5",
        summary: "Multiplies the matrix of what is below; row vectors",
        syntax: &["name := MATRIX_3x3 m11,m12,m13 ... m33 [APPLied TO name1];"],
        inputs: MATRIX_3,
        routines: &["PMAT33"],
        example: "MIRROR := MATRIX_3X3 -1,0,0  0,1,0  0,0,1 APPLIED TO CAR;",
        ..PLAIN
    };

    /// `MATRIX_4X3`, the last row the translation; components (0, 0, 0, 1) complete the columns.
    Matrix4x3(rows: DMat4 = Matrix4x3) "MATRIX_4X3" [Matrix4x3] record 0x25 help {
        section: "B.5",
        summary: "As MATRIX_3X3, with a translation in the fourth row",
        syntax: &["name := MATRIX_4X3 m11 ... m43 [APPLied TO name1];"],
        inputs: &[input("<1>", "4x3 matrix", "replaces the matrix, as F:LOOKAT makes it")],
        routines: &["PMAT43"],
        example: "MATRIX_4X3 1,0,0  0,1,0  0,0,1  5,0,0 APPLIED TO CAR;",
        ..PLAIN
    };

    /// `MATRIX_4X4`.
    Matrix4(rows: DMat4 = Matrix4) "MATRIX_4X4" [Matrix4] record 0x26 help {
        section: "B.5",
        confidence: Confirmed,
        summary: "Multiplies the matrix of what is below, homogeneous",
        syntax: &["name := MATRIX_4X4 m11 ... m44 [APPLied TO name1];"],
        inputs: &[input("<1>", "4x4 matrix", "replaces the matrix, as F:WINDOW and F:FOV make it")],
        routines: &["PMAT44"],
        example: "MATRIX_4X4 1,0,0,0  0,1,0,0  0,0,1,0  0,0,0,1 APPLIED TO CAR;",
        ..PLAIN
    };

    /// `LOOK AT a FROM f UP u`.
    Look {
        /// The point looked at.
        at: DVec3 = Vector3,
        /// The eye.
        from: DVec3 = after(Word::From, Vector3),
        /// UP as given; without it, +y is upward.
        up: Option<DVec3> = OptionalAfter(Word::Up, Vector3),
    } "LOOK" as "LOOK AT" [Look At], LookFrom [Look From] {
            from = Vector3, at = after(Word::At, Vector3), up = OptionalAfter(Word::Up, Vector3),
        } record 0x27 help {
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
    };
}
    } };
}

pub(super) use transformation_rows;
