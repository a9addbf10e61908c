//! How matrices that place objects turn normals and lengthen.

use glam::{DMat3, DMat4};

/// The matrix of cofactors with the sign of its determinant, |det(M)| M^-T: carries outward normals to outward normals,
/// and needs no division.
pub(super) fn cofactors(m: &DMat3) -> DMat3 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    let matrix = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if m.determinant() < 0.0 { matrix * -1.0 } else { matrix }
}

/// An upper bound of how much a transformation lengthens: the root of the sum of its squared columns, but never more
/// than the longest column when they are orthogonal.
pub fn largest_stretch(m: &DMat4) -> f64 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(|c| c.truncate());
    let longest = x.length().max(y.length()).max(z.length());
    let skew = x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs());
    if skew <= 1e-12 * longest * longest {
        longest
    } else {
        (x.length_squared() + y.length_squared() + z.length_squared()).sqrt()
    }
}
