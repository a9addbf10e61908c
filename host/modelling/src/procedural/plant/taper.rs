//! The radius of a stem along its axis.

/// The radius of a stem somewhere along its axis.
///
/// - `radius`: where it begins, units of length.
/// - `length`: of the stem.
/// - `taper`: 0 a cylinder, 1 a cone, 2 a cylinder with a round end, 3 a row of balls.
/// - `part`: of its length, 0 to 1.
///
/// # Source
/// Weber and Penn 1995, section 4.4.
pub(super) fn stem_radius(radius: f64, length: f64, taper: f64, part: f64) -> f64 {
    let slope = match taper {
        taper if taper < 1.0 => taper,
        taper if taper < 2.0 => 2.0 - taper,
        _ => 0.0,
    };
    let cone = radius * (1.0 - slope * part);
    if taper < 1.0 || cone <= 0.0 {
        return cone.max(0.0);
    }
    let rest = (1.0 - part) * length;
    let depth = if taper < 2.0 || rest < cone { 1.0 } else { taper - 2.0 };
    let within = if taper < 2.0 { rest } else { (rest - 2.0 * cone * (rest / (2.0 * cone) + 0.5).floor()).abs() };
    if taper < 2.0 && within >= cone {
        return cone;
    }
    (1.0 - depth) * cone + depth * (cone * cone - (within - cone).powi(2)).max(0.0).sqrt()
}

/// How much wider a trunk is near the ground.
///
/// - `flare`: at the ground, in parts of the radius.
/// - `part`: of its length, 0 to 1.
///
/// # Source
/// Weber and Penn 1995, section 4.4.
pub(super) fn flared(flare: f64, part: f64) -> f64 {
    let y = (1.0 - 8.0 * part).max(0.0);
    1.0 + flare * (100.0_f64.powf(y) - 1.0) / 100.0
}
