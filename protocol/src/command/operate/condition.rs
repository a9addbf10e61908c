//! Rows of the conditions.

macro_rules! condition_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

CONDITIONS {
    /// `IF CONDITIONAL_BIT n IS ON|OFF`.
    IfConditionalBit {
        /// 0..=14.
        bit: u8 = BIT,
        /// The state that lets through.
        on: bool = optional(Word::Is, SWITCH),
    } "IF CONDITIONAL_BIT" [If ConditionalBit] help {
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
    };

    /// `IF LEVEL_OF_DETAIL <= n`.
    IfLevelOfDetail {
        /// How the level is compared with `level`.
        comparison: Comparison = ComparisonSign,
        /// 0..=32767.
        level: u16 = LEVEL,
    } "IF LEVEL_OF_DETAIL" [If LevelOfDetail] help {
        section: "B.8",
        summary: "Draws what is below only at some levels of detail",
        syntax: &["name := IF LEVel_of_detail < | <= | = | <> | >= | > n [THEN name1];"],
        options: &[option("n", "what the level is compared with", "0 to 32767", "")],
        inputs: &[input("<1>", "integer", "n")],
        routines: &["PIFLEV"],
        example: "IF LEVEL_OF_DETAIL >= 3 THEN BOLTS;",
        ..PLAIN
    };

    /// `IF PHASE IS ON|OFF`.
    IfPhase(on: bool = optional(Word::Is, SWITCH)) "IF PHASE" [If Phase] help {
        section: "B.8",
        summary: "Draws what is below only in one phase of the nearest SET RATE above",
        syntax: &["name := IF PHASE [IS] ON | OFF [THEN name1];"],
        routines: &["PIFPHA"],
        example: "IF PHASE IS ON THEN LAMP;",
        ..PLAIN
    };
}
    } };
}

pub(super) use condition_rows;
