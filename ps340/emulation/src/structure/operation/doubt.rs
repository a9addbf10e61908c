//! Numbers that the machine takes and that are probably not meant, and what becomes of them. Ours: the real machine's
//! limits are not known, so that a definition is not refused for them.

use protocol::command::Rate;

/// What is said of two numbers, with a comma between.
pub(super) fn both(first: Option<String>, second: Option<String>) -> Option<String> {
    match (first, second) {
        (Some(first), Some(second)) => Some(format!("{first}, {second}")),
        (first, second) => first.or(second),
    }
}

/// An angle that counts as another in 0..=360.
pub(super) fn wrapped(what: &str, angle: f64) -> Option<String> {
    (!(0.0..=360.0).contains(&angle)).then(|| format!("{what} {angle} counts as {}", angle.rem_euclid(360.0)))
}

/// A number that counts as the nearest of 0 and 1 if it is not between them.
pub(super) fn clamped(what: &str, number: f64) -> Option<String> {
    let counts = number.clamp(0.0, 1.0);
    (counts != number).then(|| format!("{what} {number} counts as {counts}"))
}

/// Limits of a viewport, the lower one first.
pub(super) fn doubtful_limits(what: &str, [low, high]: [f64; 2]) -> Option<String> {
    if low < high {
        return None;
    }
    let effect = if low == high { "is empty, so nothing is seen" } else { "is reversed, so the picture is mirrored" };
    Some(format!("{what} {low}:{high} {effect}"))
}

/// Phases that never change.
pub(super) fn endless(rate: &Rate) -> Option<String> {
    let state = if rate.initial { "ON" } else { "OFF" };
    ((rate.on, rate.off) == (0, 0)).then(|| format!("both phases last 0 frames, so the phase is always {state}"))
}

#[cfg(test)]
mod tests {
    use crate::structure::Operation;
    use protocol::command::{Command, Object, parse};

    fn of(text: &str) -> Option<String> {
        match parse(text.as_bytes()) {
            Ok(Command::Define { object: Object::Operate { operate, .. }, .. }) => Operation::doubt(&operate),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn odd_numbers_are_told_with_what_becomes_of_them() {
        for (text, told) in [
            ("SET COLOR 500,3;", "hue 500 counts as 140, saturation 3 counts as 1"),
            ("SET COLOR -60,1;", "hue -60 counts as 300"),
            ("SET COLOR 0,-1;", "saturation -1 counts as 0"),
            ("SET CONTRAST TO 2;", "contrast 2 counts as 1"),
            ("VIEWPORT HORIZONTAL 1:-1 VERTICAL -1:1;", "HORIZONTAL 1:-1 is reversed, so the picture is mirrored"),
            ("VIEWPORT HORIZONTAL -1:1 VERTICAL 0:0;", "VERTICAL 0:0 is empty, so nothing is seen"),
            ("SET RATE 0 0;", "both phases last 0 frames, so the phase is always ON"),
            ("SET RATE 0 0 OFF;", "both phases last 0 frames, so the phase is always OFF"),
            ("SET BLINK RATE 0;", "a phase of 0 frames counts as 1"),
        ] {
            assert_eq!(of(text).as_deref(), Some(told), "{text}");
        }
    }

    #[test]
    fn usual_numbers_are_not_told() {
        for text in [
            "SET COLOR 0,0;",
            "SET COLOR 360,1;",
            "SET CONTRAST TO 1;",
            "VIEWPORT HORIZONTAL -1:1 VERTICAL -1:1;",
            "SET RATE 0 5;",
            "SCALE BY 0;",
        ] {
            assert_eq!(of(text), None, "{text}");
        }
    }
}
