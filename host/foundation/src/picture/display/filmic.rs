//! The filmic tone curve: an S-shaped curve of the logarithm, channel by channel between primaries that are drawn in, with
//! the hue of the light.
//!
//! # Source
//! The way is that of AgX (Sobotka 2019): logarithms from 10 stops below middle grey to 6.5 above it, a curve of two
//! hyperbolas, and primaries drawn in by a fifth, so that bright colours go to white. *Ours*: the primaries are let out again,
//! and the hue, in Oklab (Ottosson 2020), is that of the light instead of that which the channels bend to.

use super::MIDDLE_GREY;
use super::gamut::fitted;
use crate::color::srgb;
use glam::{DMat3, DVec2, DVec3};
use std::sync::LazyLock;

/// Stops from middle grey to black and to white.
const RANGE: [f64; 2] = [-10.0, 6.5];
/// The least grey that is shown as white: 2^6.5 times middle grey.
pub(super) const WHITE: f64 = MIDDLE_GREY * 90.509_667_991_878_09;
/// Where middle grey is in the range, and which code of a display it gets.
const PIVOT: DVec2 = DVec2::new(10.0 / 16.5, 0.5);
/// Slope of the curve at middle grey: that of a display alone is 2.4.
const SLOPE: f64 = 2.7;
/// How sharply the curve bends to black and to white.
const POWER: f64 = 1.5;
/// Exponent of the display for which codes are meant.
const GAMMA: f64 = 2.2;
/// How far primaries are drawn in to white.
const INSET: f64 = 0.2;
/// How much more colourful the channels are shown than the curve leaves them, as drawing primaries in makes them paler.
const CHROMA: f64 = 1.2;

/// From linear sRGB to channels of the primaries that are drawn in, and back.
static PRIMARIES: LazyLock<[DMat3; 2]> = LazyLock::new(|| {
    let white = srgb::to_xyz(DVec3::ONE);
    let middle = DVec2::new(white.x, white.y) / white.element_sum();
    let drawn = srgb::PRIMARIES.map(|primary| {
        let DVec2 { x, y } = middle + (primary - middle) / (1.0 - INSET);
        DVec3::new(x, y, 1.0 - x - y)
    });
    let directions = DMat3::from_cols(drawn[0], drawn[1], drawn[2]);
    let to_xyz = directions * DMat3::from_diagonal(directions.inverse() * white);
    let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| srgb::from_xyz(to_xyz * axis));
    let out = DMat3::from_cols(columns[0], columns[1], columns[2]);
    [out.inverse(), out]
});

/// How far each hyperbola reaches from the pivot.
static SCALES: LazyLock<[f64; 2]> = LazyLock::new(|| {
    let scale = |x: f64, y: f64| {
        let run = SLOPE * x;
        (run.powf(-POWER) * ((run / y).powf(POWER) - 1.0)).powf(-1.0 / POWER)
    };
    [-scale(PIVOT.x, PIVOT.y), scale(1.0 - PIVOT.x, 1.0 - PIVOT.y)]
});

/// From linear sRGB to the cone responses of Oklab, and from their cube roots to lightness, green to red and blue to yellow.
/// The last digits of the last number are those with which greys have no hue.
const OKLAB: [DMat3; 2] = [
    DMat3::from_cols(
        DVec3::new(0.412_221_470_8, 0.211_903_498_2, 0.088_302_461_9),
        DVec3::new(0.536_332_536_3, 0.680_699_545_1, 0.281_718_837_6),
        DVec3::new(0.051_445_992_9, 0.107_396_956_6, 0.629_978_700_5),
    ),
    DMat3::from_cols(
        DVec3::new(0.210_454_255_3, 1.977_998_495_1, 0.025_904_037_1),
        DVec3::new(0.793_617_785_0, -2.428_592_205_0, 0.782_771_766_2),
        DVec3::new(-0.004_072_046_8, 0.450_593_709_9, -0.808_675_803_3),
    ),
];
/// The inverse of the second of them, and of the first.
static FROM_OKLAB: LazyLock<[DMat3; 2]> = LazyLock::new(|| [OKLAB[1].inverse(), OKLAB[0].inverse()]);

/// From exposed radiance, linear sRGB, to the light of a display, 0..=1.
pub(super) fn curve(rgb: DVec3) -> DVec3 {
    // Written so that NaN becomes 0.
    let rgb = DVec3::from(rgb.to_array().map(|light| if light > 0.0 { light.min(1e30) } else { 0.0 }));
    let [inset, outset] = &*PRIMARIES;
    let shown = *outset * DVec3::from((*inset * rgb).to_array().map(channel));
    let (light, seen) = (oklab(rgb), oklab(shown));
    let hue = DVec2::new(light.y, light.z).normalize_or_zero();
    let chroma = CHROMA * DVec2::new(seen.y, seen.z).length();
    let [to_roots, to_light] = &*FROM_OKLAB;
    let roots = *to_roots * DVec3::new(seen.x, hue.x * chroma, hue.y * chroma);
    fitted(*to_light * (roots * roots * roots))
}

/// The curve of one channel, to light of a display.
fn channel(light: f64) -> f64 {
    let [black, white] = RANGE;
    let at = ((light.max(f64::MIN_POSITIVE) / MIDDLE_GREY).log2() - black) / (white - black);
    let at = at.clamp(0.0, 1.0);
    let scale = SCALES[usize::from(at >= PIVOT.x)];
    let run = SLOPE * (at - PIVOT.x) / scale;
    let code = scale * run / (1.0 + run.powf(POWER)).powf(1.0 / POWER) + PIVOT.y;
    code.clamp(0.0, 1.0).powf(GAMMA)
}

/// Lightness, green to red and blue to yellow.
fn oklab(rgb: DVec3) -> DVec3 {
    OKLAB[1] * DVec3::from((OKLAB[0] * rgb).to_array().map(f64::cbrt))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{Color, shipped};

    #[test]
    fn middle_grey_stays_about_as_it_is_and_the_ends_are_black_and_white() {
        let grey = |light: f64| curve(DVec3::splat(light));
        assert!((grey(MIDDLE_GREY) - DVec3::splat(0.5f64.powf(2.2))).abs().max_element() < 1e-9);
        assert!(grey(0.18 / 1030.0).max_element() < 1e-6 && (grey(WHITE) - 1.0).abs().max_element() < 1e-9);
        assert!((WHITE / (MIDDLE_GREY * RANGE[1].exp2()) - 1.0).abs() < 1e-12);
        // It has an eighth more contrast than a display alone.
        let slope = (grey(0.19).x.powf(1.0 / GAMMA) - grey(0.17).x.powf(1.0 / GAMMA)) / 0.02;
        let display = (0.19f64.powf(1.0 / GAMMA) - 0.17f64.powf(1.0 / GAMMA)) / 0.02;
        assert!((slope / display / 1.125 - 1.0).abs() < 0.05, "{slope} {display}");
    }

    #[test]
    fn primaries_are_drawn_in_as_those_of_agx() {
        let red = PRIMARIES[0] * DVec3::X;
        assert!((red - DVec3::new(0.8424, 0.0424, 0.0424)).abs().max_element() < 2e-4, "{red}");
    }

    #[test]
    fn hues_of_the_colour_checker_stay() {
        let mut largest: f64 = 0.0;
        for name in &shipped::patches()[..18] {
            let patch = Color::Spectrum(shipped::reflectance(name).expect("shipped")).bands_of_reflectance();
            for stops in -4..=4 {
                let (light, shown) = (patch * f64::from(stops).exp2(), curve(patch * f64::from(stops).exp2()));
                let [before, after] = [light.max(DVec3::ZERO), shown].map(|rgb| {
                    let lab = oklab(rgb);
                    DVec2::new(lab.y, lab.z)
                });
                // What is nearly white has no hue.
                if after.length() > 0.01 {
                    largest = largest.max(before.angle_to(after).abs().to_degrees());
                }
            }
        }
        assert!(largest < 4.0, "{largest} degrees");
    }
}
