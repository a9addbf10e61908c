//! Linear sRGB: the three bands of a screen.

use super::{observer, shipped};
use glam::{DMat3, DVec2, DVec3};
use std::sync::LazyLock;

/// Chromaticities x, y of the red, green and blue of sRGB (IEC 61966-2-1).
pub const PRIMARIES: [DVec2; 3] = [DVec2::new(0.64, 0.33), DVec2::new(0.30, 0.60), DVec2::new(0.15, 0.06)];

/// Weights of red, green and blue in luminance (ITU-R BT.709).
pub const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// The matrix from red, green and blue to X, Y and Z, and its inverse.
///
/// White, (1, 1, 1), is a perfect reflector under D65 with Y = 1, by the very tables that this program uses: IEC
/// 61966-2-1 rounds its chromaticity to (0.3127, 0.3290), from which the matrix here differs by less than 5e-4.
static MATRICES: LazyLock<[DMat3; 2]> = LazyLock::new(|| {
    let light = observer::tristimulus(&shipped::D65);
    let white = light / light.y;
    let [r, g, b] = PRIMARIES.map(|at| DVec3::new(at.x / at.y, 1.0, (1.0 - at.x - at.y) / at.y));
    let directions = DMat3::from_cols(r, g, b);
    // How much of each primary makes white.
    let amounts = directions.inverse() * white;
    let matrix = directions * DMat3::from_diagonal(amounts);
    [matrix, matrix.inverse()]
});

/// X, Y and Z of linear sRGB; Y of white (1, 1, 1) is 1.
pub fn to_xyz(rgb: DVec3) -> DVec3 {
    MATRICES[0] * rgb
}

/// Linear sRGB of X, Y and Z; negative where the screen cannot show the colour.
pub fn from_xyz(xyz: DVec3) -> DVec3 {
    MATRICES[1] * xyz
}

/// Linear sRGB as displays get it, each part held within 0..=1.
///
/// # Source
/// IEC 61966-2-1.
pub fn encoded(rgb: DVec3) -> DVec3 {
    let power = |light: f64| light.powf(1.0 / 2.4);
    // 1.055 p - 0.055, which is 1 where p is.
    let curved = |power: f64| power + 0.055 * (power - 1.0);
    let encode = |light: f64| if light <= 0.003_130_8 { 12.92 * light } else { curved(power(light)) };
    // Written so that NaN becomes 0.
    DVec3::from(rgb.to_array().map(|light| if light > 0.0 { encode(light.min(1.0)) } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoded_light_rounds_to_the_bytes_of_pictures() {
        for step in -10..=4200 {
            let light = f64::from(step) / 4096.0;
            let byte = protocol::raster::srgb_from_linear(light as f32);
            let encoded = encoded(DVec3::splat(light)).x;
            assert!((encoded * 255.0 - f64::from(byte)).abs() <= 0.5 + 1e-4, "{light}: {encoded} {byte}");
        }
        assert_eq!(encoded(DVec3::new(f64::NAN, f64::INFINITY, 1.0)), DVec3::new(0.0, 1.0, 1.0));
    }

    #[test]
    fn white_is_d65_and_comes_back() {
        let white = to_xyz(DVec3::ONE);
        let xy = observer::chromaticity(white).expect("not black");
        assert!((xy - DVec2::new(0.31272, 0.32903)).length() < 1e-4 && (white.y - 1.0).abs() < 1e-14);
        assert!((from_xyz(white) - DVec3::ONE).length() < 1e-14);
        for rgb in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.2, -0.1, 3.0)] {
            assert!((from_xyz(to_xyz(rgb)) - rgb).length() < 1e-14);
        }
    }

    #[test]
    fn the_matrix_is_that_of_the_standard_but_for_the_rounding_of_white() {
        // IEC 61966-2-1, X, Y and Z to red, green and blue.
        let standard = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        for (row, numbers) in standard.iter().enumerate() {
            for (column, number) in numbers.iter().enumerate() {
                assert!((from_xyz(DVec3::AXES[column])[row] - number).abs() < 5e-4, "{row} {column}");
            }
        }
    }
}
