//! Rows of the conditions.

macro_rules! condition_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

    /// IF CONDITIONAL_BIT.
    IfBit {
        /// 0..=14.
        bit: u8,
        /// The state that lets through.
        on: bool,
    } = {
        named "IF CONDITIONAL_BIT";
        from Operate::IfConditionalBit { bit, on } => Operation::IfBit { bit: checked_bit(bit)?, on };
        admits state => (state.bits.checked_shr(u32::from(*bit)).unwrap_or(0) & 1 == 1) == *on;
        shows format!("{bit} IS {}", switch(*on));
    }

    /// IF LEVEL_OF_DETAIL.
    IfLevel {
        /// How the level compares with `level`.
        comparison: Comparison,
        /// 0..=32767.
        level: u16,
    } = {
        named "IF LEVEL_OF_DETAIL";
        from Operate::IfLevelOfDetail { comparison, level } =>
            Operation::IfLevel { comparison, level: checked_level(level)? };
        at FIRST takes KindSet::INTEGER, given => *level = given.level()?;
        admits state => comparison.holds(state.level, i32::from(*level));
        shows format!("{} {level}", comparison.sign());
    }

    /// IF PHASE.
    IfPhase(on: bool) = {
        named "IF PHASE";
        from Operate::IfPhase(on) => Operation::IfPhase(on);
        admits state => state.phase == *on;
        shows switch(*on).into();
    }
    } };
}

pub(super) use condition_rows;
