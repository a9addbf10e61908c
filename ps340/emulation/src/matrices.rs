//! The matrices of the machine: rotation, scale, look, window and field of view.
//!
//! Row vectors, left-handed, x right, y up, z into the screen. Row `i` of the machine's matrix is column `i` of
//! the glam matrix, so that `p M` is `glam * p` and the machine's `A B` is `glam_b * glam_a`.
//!
//! Functions and display nodes share these formulas, so that a matrix made by F:LOOKAT equals the node LOOK.

use glam::{DMat3, DMat4, DVec3, DVec4};
use protocol::command::Axis;

/// Sine of the angle between UP and the line of sight below which UP cannot say what is upward.
const PARALLEL: f64 = 1e-12;

/// The sine and cosine of an angle in degrees, exact at multiples of 90 degrees.
///
/// The angle is reduced in degrees, which loses nothing in double precision, to at most 45 degrees from a
/// multiple of 90; only the rest is turned into radians.
///
/// - `degrees`: any finite angle.
/// - Returns (sine, cosine), each in -1..=1; NaN for an angle that is not finite.
pub fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    let turn = degrees % 360.0;
    let quarter = (turn / 90.0).round();
    let (s, c) = (turn - 90.0 * quarter).to_radians().sin_cos();
    let (sine, cosine) = match (quarter as i64).rem_euclid(4) {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    };
    // Adding zero turns -0 into +0.
    (sine + 0.0, cosine + 0.0)
}

/// The rotation about an axis: the cyclic rule x to y, y to z, z to x for positive angles.
///
/// ```text
/// Z: [ c  s  0 ]   X: [1  0  0]   Y: [ c 0 -s]
///    [-s  c  0 ]      [0  c  s]      [ 0 1  0]
///    [ 0  0  1 ]      [0 -s  c]      [ s 0  c]
/// ```
///
/// - `degrees`: any finite angle; multiples of 90 give entries that are exactly 0, 1 or -1.
///
/// # Source
/// Matrices of the command ROTATE; sense confirmed by client programs of the time.
pub fn rotation(axis: Axis, degrees: f64) -> DMat3 {
    let (s, c) = sine_and_cosine(degrees);
    // `0.0 - s` instead of `-s`: an exact zero stays +0.
    let n = 0.0 - s;
    match axis {
        Axis::X => rows3([1.0, 0.0, 0.0], [0.0, c, s], [0.0, n, c]),
        Axis::Y => rows3([c, 0.0, n], [0.0, 1.0, 0.0], [s, 0.0, c]),
        Axis::Z => rows3([c, s, 0.0], [n, c, 0.0], [0.0, 0.0, 1.0]),
    }
}

/// The scale by three factors, one an axis.
pub fn scale(factors: DVec3) -> DMat3 {
    DMat3::from_diagonal(factors)
}

/// The view from a point to a point: FROM goes to the origin, the line FROM-AT to +z, UP to upward.
///
/// ```text
/// z = norm(at - from); x = norm(u x z); y = z x x
/// rows: (x.x y.x z.x) (x.y y.y z.y) (x.z y.z z.z) (-from.x -from.y -from.z in the new axes)
/// ```
///
/// - `at`, `from`: points.
/// - `up`: a *point* above AT: the upward direction is `up - at`; where both are the same point, `up` itself is
///   the direction. An UP along the line of sight says nothing; +y takes its place, or +z for a line of sight
///   along y.
/// - Returns a 4x3 matrix in the 4x4 form; none if FROM and AT are the same point or not finite.
///
/// # Source
/// The formulas are ordinary left-handed viewing. UP as a point: the structures of a client of the time pass
/// AT + up after a correction; for AT at the origin a point and a direction are the same.
pub fn look(at: DVec3, from: DVec3, up: DVec3) -> Option<DMat4> {
    let z = direction(at - from)?;
    let upward = direction(up - at).or_else(|| direction(up)).unwrap_or(DVec3::Y);
    let mut x = upward.cross(z);
    if x.length() < PARALLEL {
        let substitute = if z.y.abs() > 0.5 { DVec3::Z } else { DVec3::Y };
        x = substitute.cross(z);
    }
    let x = direction(x)?;
    let y = z.cross(x);
    let matrix = DMat4::from_cols(
        DVec4::new(x.x, y.x, z.x, 0.0),
        DVec4::new(x.y, y.y, z.y, 0.0),
        DVec4::new(x.z, y.z, z.z, 0.0),
        DVec4::new(0.0 - from.dot(x), 0.0 - from.dot(y), 0.0 - from.dot(z), 1.0),
    );
    matrix.is_finite().then_some(matrix)
}

/// The orthographic view of a box: x and y to -1..=1, front to depth 0, back to depth 1, w' = 1.
///
/// ```text
/// x' = (2x - right - left)/(right - left)      y' likewise
/// z' = (z - front)/(back - front)
/// ```
///
/// - `x`: left and right; `y`: bottom and top; `z`: front and back. Descending ranges mirror.
/// - Returns none for an empty range or one whose matrix is not finite.
pub fn window(x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> Option<DMat4> {
    let across = 2.0 / extent(x)?;
    let upward = 2.0 / extent(y)?;
    let inward = 1.0 / extent(z)?;
    let matrix = DMat4::from_cols(
        DVec4::new(across, 0.0, 0.0, 0.0),
        DVec4::new(0.0, upward, 0.0, 0.0),
        DVec4::new(0.0, 0.0, inward, 0.0),
        DVec4::new(0.0 - middle(x) * across, 0.0 - middle(y) * upward, 0.0 - z[0] * inward, 1.0),
    );
    matrix.is_finite().then_some(matrix)
}

/// The perspective view of a pyramid with its tip, the eye, in the origin.
///
/// ```text
/// t = tan(angle/2)   x' = x/t   y' = y/t   w' = z
/// z' = back (z - front)/(back - front)            0 at the front, w' at the back
/// ```
///
/// - `degrees`: the full angle, between 0 and 180, both excluded.
/// - `z`: front and back boundary, distances from the eye.
/// - Returns none for another angle, an empty range or one whose matrix is not finite.
pub fn field_of_view(degrees: f64, z: [f64; 2]) -> Option<DMat4> {
    if !(degrees > 0.0 && degrees < 180.0) {
        return None;
    }
    let (sine, cosine) = sine_and_cosine(degrees / 2.0);
    let aperture = cosine / sine;
    let depth = z[1] / extent(z)?;
    let matrix = DMat4::from_cols(
        DVec4::new(aperture, 0.0, 0.0, 0.0),
        DVec4::new(0.0, aperture, 0.0, 0.0),
        DVec4::new(0.0, 0.0, depth, 1.0),
        DVec4::new(0.0, 0.0, 0.0 - z[0] * depth, 0.0),
    );
    matrix.is_finite().then_some(matrix)
}

/// The view of a pyramid that need not be upright: the eye before a screen in the plane z = 0, whose middle is the
/// origin.
///
/// ```text
/// s = z + back   x' = ((x - right) back + right s) 2/width   y' likewise with up   w' = s
/// z' = (z[1] + back)(z - z[0])/(z[1] - z[0])                 0 at the front, w' at the back
/// ```
///
/// - `back`: distance of the eye before the screen, above 0.
/// - `right`, `up`: how far the eye is from the middle of the screen.
/// - `width`: width and height of the screen, above 0.
/// - `z`: front and back boundary, in the coordinates of the data. Ours; measured from the screen, not from the eye.
/// - Returns none for other values or a matrix that is not finite.
pub fn eye(back: f64, right: f64, up: f64, width: f64, z: [f64; 2]) -> Option<DMat4> {
    if !(back > 0.0 && width > 0.0) {
        return None;
    }
    let half = 2.0 / width;
    let depth = (z[1] + back) / extent(z)?;
    let matrix = DMat4::from_cols(
        DVec4::new(half * back, 0.0, 0.0, 0.0),
        DVec4::new(0.0, half * back, 0.0, 0.0),
        DVec4::new(half * right, half * up, depth, 1.0),
        DVec4::new(0.0, 0.0, 0.0 - z[0] * depth, back),
    );
    matrix.is_finite().then_some(matrix)
}

/// A 3x3 matrix from the machine's rows.
fn rows3(first: [f64; 3], second: [f64; 3], third: [f64; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&[first, second, third])
}

/// The unit vector along `v` at any scale; none for a zero vector or one that is not finite.
fn direction(v: DVec3) -> Option<DVec3> {
    let size = v.abs().max_element();
    (v.is_finite() && size > 0.0).then(|| (v / size).normalize())
}

/// The length of a range, negative if it descends; none if it is empty or not finite.
fn extent(range: [f64; 2]) -> Option<f64> {
    let length = range[1] - range[0];
    (length.is_finite() && length != 0.0).then_some(length)
}

/// The middle of a range.
fn middle(range: [f64; 2]) -> f64 {
    0.5 * range[0] + 0.5 * range[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    #[test]
    fn quarter_turns_are_exact_however_many() {
        for turns in [-1_000_000_i32, -4, -1, 0, 1, 5, 123_456_789] {
            for (axis, of, to) in
                [(Axis::X, DVec3::Y, DVec3::Z), (Axis::Y, DVec3::Z, DVec3::X), (Axis::Z, DVec3::X, DVec3::Y)]
            {
                let expected = match turns.rem_euclid(4) {
                    0 => of,
                    1 => to,
                    2 => -of,
                    _ => -to,
                };
                assert_eq!(
                    rotation(axis, f64::from(turns) * 90.0) * of,
                    expected,
                    "{turns} quarter turns about {axis:?}"
                );
            }
        }
    }

    #[test]
    fn rotations_are_orthogonal_and_add_up() {
        for axis in AXES {
            for degrees in [0.1, 20.0, 45.0, 44.999, 135.0, -290.0, 1e7 + 0.25] {
                let m = rotation(axis, degrees);
                assert!((m * m.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-15));
                assert!((m.determinant() - 1.0).abs() < 1e-15);
                let twice = rotation(axis, 2.0 * degrees);
                assert!((m * m).abs_diff_eq(twice, 1e-14), "{axis:?} {degrees}");
            }
        }
    }

    #[test]
    fn large_angles_are_reduced_without_loss() {
        // 1e15 + 30 is exactly representable; its rest modulo 360 is computed in integers.
        let rest = ((1_000_000_000_000_030_i64) % 360) as f64;
        assert_eq!(sine_and_cosine(1e15 + 30.0), sine_and_cosine(rest));
    }

    #[test]
    fn look_moves_from_to_the_origin_and_at_onto_the_z_axis() {
        let (at, from) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 6.0, -9.0));
        let m = look(at, from, at + DVec3::Y).unwrap();
        assert!(m.transform_point3(from).length() < 1e-14);
        let distance = (at - from).length();
        assert!(m.transform_point3(at).abs_diff_eq(DVec3::new(0.0, 0.0, distance), 1e-13));
        let above = m.transform_point3(at + DVec3::Y);
        assert!(above.x.abs() < 1e-14 && above.y > 0.0);
    }

    #[test]
    fn look_from_the_front_changes_no_axis() {
        let m = look(DVec3::ZERO, DVec3::new(0.0, 0.0, -10.0), DVec3::Y).unwrap();
        assert_eq!(m, DMat4::from_translation(DVec3::new(0.0, 0.0, 10.0)));
    }

    #[test]
    fn look_refuses_a_point_at_itself_and_survives_a_parallel_up() {
        assert_eq!(look(DVec3::ONE, DVec3::ONE, DVec3::Y), None);
        assert_eq!(look(DVec3::ONE, DVec3::splat(f64::NAN), DVec3::Y), None);
        let down = look(DVec3::ZERO, DVec3::new(0.0, 10.0, 0.0), DVec3::Y).unwrap();
        assert_eq!(down.transform_vector3(DVec3::Z), DVec3::Y, "+z is upward when one looks down");
        for size in [1e-200, 1e-15, 1e15, 1e200] {
            let m = look(DVec3::ZERO, DVec3::new(0.0, 0.0, -size), DVec3::Y * size).unwrap();
            assert_eq!(m.transform_point3(DVec3::ZERO), DVec3::new(0.0, 0.0, size));
        }
    }

    #[test]
    fn window_maps_its_corners_at_any_scale() {
        for size in [1e-15, 1.0, 1e15] {
            let m = window([-size, 3.0 * size], [0.0, size], [1e-15, 1e15]).unwrap();
            let near = m * DVec4::new(-size, 0.0, 1e-15, 1.0);
            let far = m * DVec4::new(3.0 * size, size, 1e15, 1.0);
            assert!(near.abs_diff_eq(DVec4::new(-1.0, -1.0, 0.0, 1.0), 1e-15), "{near}");
            assert!(far.abs_diff_eq(DVec4::new(1.0, 1.0, 1.0, 1.0), 1e-15), "{far}");
        }
        assert_eq!(window([1.0, 1.0], [0.0, 1.0], [0.0, 1.0]), None);
        assert_eq!(window([0.0, 1.0], [0.0, 1.0], [5.0, 5.0]), None);
        assert_eq!(window([-1e308, 1e308], [0.0, 1.0], [0.0, 1.0]), None);
    }

    #[test]
    fn field_of_view_maps_front_and_back_to_depth_0_and_1() {
        for [front, back] in [[6.0, 14.0], [1e-15, 1e15], [1e5, 2e5]] {
            let m = field_of_view(90.0, [front, back]).unwrap();
            let near = m * DVec4::new(front, 0.0, front, 1.0);
            let far = m * DVec4::new(0.0, -back, back, 1.0);
            assert!((near / near.w).abs_diff_eq(DVec4::new(1.0, 0.0, 0.0, 1.0), 1e-15), "{near}");
            assert!((far / far.w).abs_diff_eq(DVec4::new(0.0, -1.0, 1.0, 1.0), 1e-15), "{far}");
        }
        for angle in [0.0, 180.0, -30.0, f64::NAN, f64::INFINITY] {
            assert_eq!(field_of_view(angle, [1.0, 2.0]), None);
        }
        assert_eq!(field_of_view(30.0, [2.0, 2.0]), None);
    }

    #[test]
    fn eye_keeps_the_screen_and_looks_from_its_side() {
        let (back, right, up, width) = (3.0, 0.5, -0.25, 4.0);
        let m = eye(back, right, up, width, [-1.0, 7.0]).unwrap();
        // Points of the screen stay where they are: its right edge at 1, its top at 1.
        for (x, y) in [(2.0, 2.0), (-2.0, 0.0), (0.0, 1.0)] {
            let p = m * DVec4::new(x, y, 0.0, 1.0);
            assert!((p / p.w).truncate().abs_diff_eq(DVec3::new(x / 2.0, y / 2.0, p.z / p.w), 1e-15));
        }
        // What lies on a line through the eye falls on one point of the screen.
        let (eye_at, direction) = (DVec3::new(right, up, -back), DVec3::new(0.3, 0.2, 1.0));
        let seen = [2.0, 5.0, 9.0].map(|t| {
            let p = m * (eye_at + t * direction).extend(1.0);
            (p / p.w).truncate().truncate()
        });
        assert!(seen.iter().all(|p| p.abs_diff_eq(seen[0], 1e-14)), "{seen:?}");
        for (z, depth) in [(-1.0, 0.0), (7.0, 1.0)] {
            let p = m * DVec4::new(1.0, 1.0, z, 1.0);
            assert!((p.z / p.w - depth).abs() < 1e-15);
        }
        assert_eq!(eye(0.0, 0.0, 0.0, 1.0, [0.0, 1.0]), None);
        assert_eq!(eye(1.0, 0.0, 0.0, f64::NAN, [0.0, 1.0]), None);
    }
}
