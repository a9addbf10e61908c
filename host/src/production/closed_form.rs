//! The view that dials make, in closed form: what is read back from the workstation is checked against it.

use crate::{
    scene::Prepared,
    workstation::{
        network::{DEGREES_PER_TURN, DIAGONALS_PER_TURN, SCALE_LIMITS, SCALE_PER_TURN},
        structure::elongation,
    },
};
use glam::{DMat3, DMat4, DVec3};

/// The matrix that the workstation should report after the dials were turned, except for its depth row: scene
/// coordinates (z negated) to clip space, in the glam form of [`protocol::Value`].
///
/// With p a column vector: `P L T C Rx Ry Rz S C^-1 p`, where P L is the view of the camera, T what dials 5 to 7
/// moved, C the shift to the centre, R the rotations of dials 1 to 3 and S the scale of dial 4. Rows x, y and w
/// of the result do not depend on front and back.
///
/// - `turns`: of dials 1 to 7. The scene's diagonal sets how far dials 5 to 7 move.
///
/// Returns none for a camera that cannot see.
pub fn view_of_dials(prepared: &Prepared, turns: &[f64; 7]) -> Option<DMat4> {
    let (center, diagonal) = (prepared.bounds.center(), prepared.bounds.diagonal());
    let mirror = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let shrink = 1.0 / elongation(&prepared.settings);
    let whole_picture = DMat4::from_scale(DVec3::new(shrink, shrink, 1.0));
    let camera = whole_picture * prepared.camera.projection()?.to_clip * mirror;
    let center = DVec3::new(center.x, center.y, -center.z);
    let moved = DVec3::new(turns[4], turns[5], turns[6]) * diagonal * DIAGONALS_PER_TURN;
    let scale = (1.0 + turns[3] * SCALE_PER_TURN).clamp(SCALE_LIMITS[0], SCALE_LIMITS[1]);
    let [x, y, z] = [turns[0], turns[1], turns[2]].map(|t| (t * DEGREES_PER_TURN).to_radians());
    // The left-hand rule in left-handed axes is the usual matrix of the right-hand rule in right-handed ones.
    let turn = DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y) * DMat3::from_rotation_z(z);
    let placed = DMat4::from_translation(moved + center)
        * DMat4::from_mat3(turn * DMat3::from_diagonal(DVec3::splat(scale)))
        * DMat4::from_translation(-center);
    Some(camera * placed)
}

/// The largest difference between two matrices in rows x, y and w, relative to the largest element of each row.
pub fn difference(a: &DMat4, b: &DMat4) -> f64 {
    [0, 1, 3]
        .map(|row| (a.row(row) - b.row(row)).abs().max_element() / b.row(row).abs().max_element())
        .into_iter()
        .fold(0.0, f64::max)
}
