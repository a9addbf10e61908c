//! The view that dials make, in closed form: what is read back from the workstation is checked against it.

use crate::workstation::{
    InitialView,
    network::{DEGREES_PER_TURN, SCALE_LIMITS, SCALE_SQUARINGS},
};
use glam::{DMat3, DMat4, DVec3};

/// The matrix that the workstation should report after the dials were turned, except for its depth row: scene
/// coordinates (z negated) to clip space, in the glam form of [`protocol::Value`].
///
/// With p a column vector: `P T L C A Rx Ry Rz S A^-1 C^-1 p`, where P is the projection of the camera, L where it looks, T
/// what dials 5 to 7 moved, C the shift to the centre, A the axes that dials turn about, R the rotations of dials 1 to 3 and
/// S the scale of dial 4. Rows x, y and w of the result do not depend on front and back.
///
/// - `turns`: of dials 1 to 7.
///
/// Returns none for a camera that cannot see.
pub fn view_of_dials(initial: &InitialView, turns: &[f64; 7]) -> Option<DMat4> {
    let InitialView { camera, center, elongation } = initial;
    let flip = DVec3::new(1.0, 1.0, -1.0);
    let whole_picture = DMat4::from_scale(DVec3::new(1.0 / elongation, 1.0 / elongation, 1.0));
    let seen = whole_picture * camera.projection()?.to_clip * DMat4::from_scale(flip);
    let [right, up, forward] = initial.picture_axes();
    let [x, y, depth] = [turns[4], turns[5], turns[6]].map(|turns| turns * initial.movement());
    // Along oblique lines of sight nothing moves in the picture: depths are moved along these.
    let oblique = camera.parallel.map(|parallel| parallel.oblique * depth).unwrap_or_default();
    let moved = flip * (right * (x + oblique.x) + up * (y + oblique.y) + forward * depth);
    let center = flip * *center;
    let squared = 2f64.powi(SCALE_SQUARINGS as i32);
    let scale = (1.0 + turns[3].clamp(SCALE_LIMITS[0], SCALE_LIMITS[1]) / squared).powf(squared);
    let [x, y, z] = [turns[0], turns[1], turns[2]].map(|t| (t * DEGREES_PER_TURN).to_radians());
    // The left-hand rule in left-handed axes is the usual matrix of the right-hand rule in right-handed ones.
    let turn = DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y) * DMat3::from_rotation_z(z);
    let mirror = DMat3::from_diagonal(flip);
    let axes = mirror * initial.axes() * mirror;
    let placed = DMat4::from_translation(moved + center)
        * DMat4::from_mat3(axes * turn * DMat3::from_diagonal(DVec3::splat(scale)) * axes.transpose())
        * DMat4::from_translation(-center);
    Some(seen * placed)
}

/// The largest difference between two matrices in rows x, y and w, relative to the largest element of each row.
pub fn difference(a: &DMat4, b: &DMat4) -> f64 {
    [0, 1, 3]
        .map(|row| (a.row(row) - b.row(row)).abs().max_element() / b.row(row).abs().max_element())
        .into_iter()
        .fold(0.0, f64::max)
}
