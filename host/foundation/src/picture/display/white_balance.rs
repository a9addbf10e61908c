//! White balance: colours as they look to one who is adapted to the light.

use crate::color::{Spectrum, observer, srgb};
use glam::{DMat3, DVec2, DVec3};

/// From X, Y and Z to the sharpened cone responses in which adaptation scales.
///
/// # Source
/// Lam 1985, the Bradford transform, in its linear form as ICC.1 uses it.
const BRADFORD: DMat3 = DMat3::from_cols(
    DVec3::new(0.8951, -0.7502, 0.0389),
    DVec3::new(0.2664, 1.7135, -0.0685),
    DVec3::new(-0.1614, 0.0367, 1.0296),
);

/// Chromaticity x, y of a light whose white is to be shown as white; none of a spectrum that cannot be seen.
pub fn neutral(light: &Spectrum) -> Option<DVec2> {
    observer::chromaticity(observer::tristimulus(light))
}

/// The matrix that takes linear sRGB under a light to linear sRGB under D65: white of that light becomes (1, 1, 1) times its
/// luminance. None for a chromaticity to which no eye adapts: a cone response of it is not above 0.
///
/// - `white`: chromaticity x, y of the light.
pub(super) fn matrix(white: DVec2) -> Option<DMat3> {
    let xyz = DVec3::new(white.x / white.y, 1.0, (1.0 - white.x - white.y) / white.y);
    let (from, to) = (BRADFORD * xyz, BRADFORD * srgb::to_xyz(DVec3::ONE));
    if !(from.is_finite() && from.min_element() > 0.0) {
        return None;
    }
    let adapted = BRADFORD.inverse() * DMat3::from_diagonal(to / from) * BRADFORD;
    let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| srgb::from_xyz(adapted * srgb::to_xyz(axis)));
    Some(DMat3::from_cols(columns[0], columns[1], columns[2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::shipped;

    #[test]
    fn white_of_a_light_becomes_white() {
        for name in ["A", "D65", "F11"] {
            let light = shipped::light(name).expect("shipped");
            let white = neutral(&light).expect("seen");
            let xyz = observer::tristimulus(&light);
            let shown = matrix(white).expect("a light") * srgb::from_xyz(xyz / xyz.y);
            assert!((shown - DVec3::ONE).abs().max_element() < 1e-9, "{name}: {shown}");
        }
    }

    #[test]
    fn the_matrix_from_d50_is_that_of_the_icc() {
        // ICC.1:2022, annex E, has the matrix from D65 to D50 with white points (0.9505, 1, 1.0891) and (0.9642, 1, 0.8249).
        let expected = DMat3::from_cols(
            DVec3::new(1.04791, 0.02961, -0.00924),
            DVec3::new(0.02295, 0.99046, 0.01506),
            DVec3::new(-0.05022, -0.01707, 0.75179),
        );
        let (d65, d50) = (DVec3::new(0.9505, 1.0, 1.0891), DVec3::new(0.9642, 1.0, 0.8249));
        let made = BRADFORD.inverse() * DMat3::from_diagonal(BRADFORD * d50 / (BRADFORD * d65)) * BRADFORD;
        assert!(made.abs_diff_eq(expected, 5e-4), "{made}");
        let white = DVec2::new(d50.x, d50.y) / d50.element_sum();
        let back = matrix(white).expect("a light") * srgb::from_xyz(d50);
        assert!((back - 1.0).abs().max_element() < 1e-9, "{back}");
    }
}
