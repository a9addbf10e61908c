//! Text and fonts as data.

use super::row::{CommandRow, Confidence::*, PLAIN, input, option};

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "CHARACTERS",
        section: "B.4",
        confidence: Confirmed,
        summary: "A line of text",
        syntax: &["name := CHARacters [x,y[,z]] [STEP dx,dy] 'string';"],
        options: &[
            option("x,y,z", "lower left corner of the first cell", "", "0,0,0"),
            option("STEP dx,dy", "from cell to cell, in cells", "", "1,0"),
            option("'string'", "the text; a quote in it is doubled", "up to 240 characters", ""),
        ],
        inputs: &[
            input("<i>", "string", "replaces characters from the i-th on"),
            input("<last>", "string", "replaces the last character"),
            input("<append>", "string", "adds at the end"),
            input("<delete>", "integer", "removes so many characters from the end"),
            input("<clear>", "any", "removes all"),
            input("<position>", "2D or 3D vector", "the place"),
            input("<step>", "2D vector", "the step"),
            input("<substitute>", "string", "replaces the whole text"),
        ],
        routines: &["PCHS"],
        example: "TITLE := CHARACTERS -0.9,0.9 STEP 1,0 'It''s a title';",
    },
    CommandRow {
        name: "LABELS",
        section: "B.4",
        summary: "Many lines of text in one node",
        syntax: &["name := LABELS x,y[,z] 'string' [x,y[,z] 'string'] ...;"],
        options: &[option("'string'", "one text", "up to 240 characters", "")],
        inputs: &[
            input("<i>", "string", "the text of label i"),
            input("<i>", "2D or 3D vector", "the place of label i"),
            input("<i>", "Boolean", "whether label i is shown"),
            input("<i>", "label", "the whole label i, from F:LABEL"),
            input("<last>", "as <i>", "the same for the last label"),
            input("<append>", "label", "adds a label"),
            input("<delete>", "integer", "removes so many labels from the end"),
            input("<clear>", "any", "removes all"),
            input("<step>", "2D vector", "the step of all"),
        ],
        routines: &["PLABEG", "PLAADD", "PLAEND"],
        example: "SCALE_MARKS := LABELS 0,0 '0'  1,0 '10'  2,0 '20';",
        ..PLAIN
    },
    CommandRow {
        name: "BEGIN_FONT",
        section: "B.4",
        summary: "A font: how characters are drawn in the unit square",
        syntax: &["name := BEGIN_Font", "  C[i]: [N = n] P x,y L x,y ...; ...", "END_Font;"],
        options: &[
            option("i", "code of the character; those not defined draw nothing", "0 to 127", ""),
            option("N = n", "estimate of the count of vectors", "0 and up", "the count"),
            option("P, L", "position and line, as in an itemized vector list", "", ""),
        ],
        example: "SCRIPT := BEGIN_FONT\n  C[73]: N = 2 P 0.5,0 L 0.5,1;\n  C[45]: P 0.2,0.5 L 0.8,0.5;\nEND_FONT;",
        ..PLAIN
    },
];
