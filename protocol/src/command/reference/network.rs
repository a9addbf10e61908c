//! Function networks.

use super::row::{CommandRow, Confidence::*, PLAIN, option};

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "F:",
        section: "B.10",
        confidence: Confirmed,
        summary: "An instance of a function",
        syntax: &["name := F:function_name;", "name := F:function_name(n);"],
        options: &[option("n", "number of inputs or outputs, for functions of variable size", "0 to 65535", "")],
        routines: &["PFN", "PFNN"],
        example: "SUM := F:ADD;\nSWITCH := F:ROUTE(4);",
        ..PLAIN
    },
    CommandRow {
        name: "CONNECT",
        section: "B.10",
        confidence: Confirmed,
        summary: "Messages of an output go to an input of a function or a node",
        syntax: &["CONNect name1<i>:<j>name2 [,<k>name3 ...];"],
        options: &[
            option("<i>", "output", "1 to 65535", ""),
            option("<j>", "input: a number or append, clear, delete, last, position, step, substitute", "", ""),
        ],
        routines: &["PCONN"],
        example: "CONNECT DIALS<1>:<1>SUM, <1>SWITCH;",
        ..PLAIN
    },
    CommandRow {
        name: "DISCONNECT",
        section: "B.10",
        confidence: Confirmed,
        summary: "Removes arcs; harmless if there are none",
        syntax: &["DISCONNect name1[<i>][:<j>name2];", "DISCONNect name1:ALL;"],
        options: &[option("<i>", "only arcs of this output", "1 to 65535", "all")],
        routines: &["PDI", "PDIOUT", "PDIALL"],
        example: "DISCONNECT DIALS<1>:<1>SUM;\nDISCONNECT SWITCH:ALL;",
        ..PLAIN
    },
    CommandRow {
        name: "SEND",
        section: "B.10",
        confidence: Confirmed,
        summary: "Puts a message on an input",
        syntax: &[
            "SEND value [TO] <j>name;",
            "STORE value [IN] name;",
            "value: TRUE | FALSE | FIX(i) | r | 'string' | CHAR(n) | VALUE(variable)",
            "       | V2D(x,y) | V3D(x,y,z) | V4D(x,y,z,w) | M2D(row row) | M3D(row row row)",
            "       | M4D(row row row row) | M4X3D(row row row row) | XFORMED(row row row row)",
        ],
        options: &[
            option("STORE", "sends to <1>", "", ""),
            option("FIX(i)", "an integer", "32 bits with sign", ""),
            option("r", "a real, also without a point", "", ""),
            option("'string'", "a text; a quote in it is doubled", "up to 240 characters", ""),
            option("CHAR(n)", "a text of one character", "0 to 255", ""),
            option("VALUE(variable)", "what the variable holds", "", ""),
            option("M4X3D, XFORMED", "a 4x3 matrix, transformed data: ours, so that every value has a text", "", ""),
        ],
        routines: &[
            "PSNBOO", "PSNFIX", "PSNREA", "PSNST", "PSNV2D", "PSNV3D", "PSNV4D", "PSNM2D", "PSNM3D", "PSNM4D", "PSNVAL",
        ],
        example: "SEND V3D(0,0.5,1) TO <2>SUM;\nSTORE FIX(3) IN COUNTER;\nSEND VALUE(COUNTER) TO <1>SUM;",
        ..PLAIN
    },
    CommandRow {
        name: "SEND VL",
        section: "B.10",
        summary: "Copies the vectors of a list into another",
        syntax: &["SEND VL(name1) [TO] <i>name2;"],
        options: &[option("<i>", "the first vector that is replaced, or <append>", "", "")],
        routines: &["PSNVL"],
        example: "SEND VL(STROKE) TO <append>DRAWING;",
        ..PLAIN
    },
    CommandRow {
        name: "SEND NUMBER*MODE",
        section: "B.10",
        summary: "Marks consecutive vectors of a list as positions or lines",
        syntax: &["SEND number*P | number*L [TO] <i>name;"],
        options: &[option("number", "how many vectors, from the i-th on", "0 and up", "")],
        routines: &["PSNPL"],
        example: "SEND 3*P TO <2>DRAWING;",
        ..PLAIN
    },
    CommandRow {
        name: "VARIABLE",
        section: "B.10",
        summary: "Named storage for a value, which F:FETCH reads",
        syntax: &["VARIABLE name [, name ...];"],
        routines: &["PVAR"],
        example: "VARIABLE COUNTER, LAST_PICK;",
        ..PLAIN
    },
    CommandRow {
        name: "SETUP CNESS",
        section: "B.10",
        summary: "Makes an input constant or active",
        syntax: &["SETUP CNESS TRUE | FALSE <i>name;"],
        options: &[option("TRUE", "constant: keeps its value; FALSE: active, each message is used once", "", "")],
        routines: &["PSECNS"],
        example: "SETUP CNESS TRUE <2>SUM;",
        ..PLAIN
    },
];
