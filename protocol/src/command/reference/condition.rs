//! Conditions.

use super::row::{CommandRow, Confidence::*, PLAIN, input, option};

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "IF CONDITIONAL_BIT",
        section: "B.8",
        confidence: Confirmed,
        summary: "Draws what is below only if a bit is on, or off",
        syntax: &["name := IF CONDitional_bit n [IS] ON | OFF [THEN name1];"],
        options: &[
            option("n", "which bit", "0 to 14", ""),
            option("THEN name1", "governs name1 only; without it, all that follows in the structure", "", ""),
        ],
        routines: &["PIFBIT"],
        example: "IF CONDITIONAL_BIT 2 IS ON THEN CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "IF LEVEL_OF_DETAIL",
        section: "B.8",
        summary: "Draws what is below only at some levels of detail",
        syntax: &["name := IF LEVel_of_detail < | <= | = | <> | >= | > n [THEN name1];"],
        options: &[option("n", "what the level is compared with", "0 to 32767", "")],
        inputs: &[input("<1>", "integer", "n")],
        routines: &["PIFLEV"],
        example: "IF LEVEL_OF_DETAIL >= 3 THEN BOLTS;",
        ..PLAIN
    },
    CommandRow {
        name: "IF PHASE",
        section: "B.8",
        summary: "Draws what is below only in one phase of the nearest SET RATE above",
        syntax: &["name := IF PHASE [IS] ON | OFF [THEN name1];"],
        routines: &["PIFPHA"],
        example: "IF PHASE IS ON THEN LAMP;",
        ..PLAIN
    },
];
