//! Values of operate nodes as text, for people who look into the machine.

use protocol::command::CharacterOrientation;

/// A switch as the command language has it.
pub(super) const fn switch(on: bool) -> &'static str {
    if on { "ON" } else { "OFF" }
}

/// Numbers with commas between, rows with two blanks.
pub(super) fn rows(rows: &[&[f64]]) -> String {
    let row = |c: &&[f64]| c.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    rows.iter().map(row).collect::<Vec<_>>().join("  ")
}

/// The limits of a viewport.
pub(super) fn limits(horizontal: &[f64; 2], vertical: &[f64; 2], intensity: &Option<[f64; 2]>) -> String {
    rows(&[horizontal, vertical, intensity.as_ref().map_or(&[], |i| &i[..])])
}

/// The numbers of screens, a bit for each.
pub(super) fn screens(scopes: u8) -> String {
    (0..4).filter(|n| scopes & (1 << n) != 0).map(|n| n.to_string()).collect::<Vec<_>>().join(",")
}

/// How characters stand.
pub(super) const fn oriented(orientation: CharacterOrientation) -> &'static str {
    match orientation {
        CharacterOrientation::World => "WORLD_ORIENTED",
        CharacterOrientation::Screen => "SCREEN_ORIENTED",
        CharacterOrientation::ScreenFixed => "SCREEN_ORIENTED/FIXED",
    }
}
