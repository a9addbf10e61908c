//! Rows of text and fonts.

use crate::command::reference::row::{InputRow, input};

/// The input of nodes that change the matrix of characters.
pub(super) const MATRIX_2: &[InputRow] = &[input("<1>", "2x2 matrix", "replaces the matrix")];

macro_rules! text_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

TEXT {
    /// `CHARACTER FONT name`.
    CharacterFont(font: Name = ObjectName) "CHARACTER FONT" [Characters Font], Font [Font] { 0 = ObjectName, } help {
        section: "B.4",
        summary: "The font of the characters below",
        syntax: &["name := [CHARacters] FONT font_name [APPLied TO name1];"],
        routines: &["PCHFON"],
        example: "CHARACTER FONT SCRIPT APPLIED TO TITLE;",
        ..PLAIN
    };

    /// `STANDARD FONT`.
    StandardFont "STANDARD FONT" [Standard Font] help {
        section: "B.4",
        summary: "The standard font for the characters below",
        syntax: &["name := STANdard FONT [APPLied TO name1];"],
        routines: &["PSTDFO"],
        example: "STANDARD FONT APPLIED TO TITLE;",
        ..PLAIN
    };

    /// `CHARACTER ROTATE angle`, degrees.
    CharacterRotate(angle: f64 = Real) "CHARACTER ROTATE" [Characters Rotate] help {
        section: "B.4",
        summary: "Turns the characters below in their plane",
        syntax: &["name := CHARacters ROTate angle [APPLied TO name1];"],
        options: &[option("angle", "degrees, counter-clockwise", "", "")],
        inputs: MATRIX_2,
        routines: &["PCHROT"],
        example: "CHARACTER ROTATE 90 APPLIED TO TITLE;",
        ..PLAIN
    };

    /// `CHARACTER SCALE s` or `sx,sy`.
    CharacterScale(factor: DVec2 = unprinted(Word::By, CharacterFactors)) "CHARACTER SCALE" [Characters Scale] help {
        section: "B.4",
        confidence: Confirmed,
        summary: "Scales the characters below",
        syntax: &["name := CHARacters SCAle [BY] s | sx,sy [APPLied TO name1];"],
        inputs: MATRIX_2,
        routines: &["PCHSCA"],
        example: "CHARACTER SCALE 0.05,0.08 APPLIED TO TITLE;",
        ..PLAIN
    };

    /// `TEXT SIZE x`: an absolute size; cancels the character matrix above.
    TextSize(size: f64 = Real) "TEXT SIZE" [Text Size] help {
        section: "B.4",
        summary: "An absolute size of the characters below",
        syntax: &["name := TEXT SIZE x [APPLied TO name1];"],
        inputs: MATRIX_2,
        example: "TEXT SIZE 0.04 APPLIED TO TITLE;",
        ..PLAIN
    };
}
    } };
}

pub(super) use text_rows;
