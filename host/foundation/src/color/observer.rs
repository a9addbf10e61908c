//! The CIE 1931 standard observer, 2 degrees.

use super::shipped::OBSERVER;
use super::{Spectrum, integral};
use glam::{DVec2, DVec3};

/// Luminous efficacy of radiation of 540 THz, lm/W: Y of spectral radiance times this is luminance in cd/m².
pub const LUMENS_PER_WATT: f64 = 683.0;

/// The wavelengths that the observer sees, nm.
pub const VISIBLE: (f64, f64) = (360.0, 830.0);

/// The functions x, y and z of the observer.
pub fn functions() -> &'static [Spectrum; 3] {
    &OBSERVER
}

/// X, Y and Z of light: the integrals of its spectrum times the functions of the observer, unit of the spectrum times
/// nm.
pub fn tristimulus(light: &Spectrum) -> DVec3 {
    DVec3::from_array(functions().each_ref().map(|function| integral(&[light, function], VISIBLE.0, VISIBLE.1)))
}

/// X, Y and Z of a surface under a light, relative to the Y of a perfect reflector.
///
/// - `reflectance`: 0..=1. `light`: in any unit.
/// - Returns none if the light cannot be seen.
pub fn surface_tristimulus(reflectance: &Spectrum, light: &Spectrum) -> Option<DVec3> {
    let [x, y, z] = functions();
    let white = integral(&[light, y], VISIBLE.0, VISIBLE.1);
    let sum = |function| integral(&[reflectance, light, function], VISIBLE.0, VISIBLE.1) / white;
    (white > 0.0).then(|| DVec3::new(sum(x), sum(y), sum(z)))
}

/// Chromaticity x, y; none for black.
pub fn chromaticity(xyz: DVec3) -> Option<DVec2> {
    let sum = xyz.element_sum();
    (sum > 0.0).then(|| xyz.truncate() / sum)
}

#[cfg(test)]
mod tests {
    use super::super::{Extrapolation, daylight, shipped, srgb};
    use super::*;

    fn white() -> Spectrum {
        Spectrum::regular(300.0, 600.0, vec![1.0; 2], Extrapolation::Held).expect("a spectrum")
    }

    #[test]
    fn lights_have_the_chromaticities_of_the_standard() {
        // CIE 15:2004, tables T.3 and T.8.1.
        let table = [
            ("A", 0.44758, 0.40745),
            ("D65", 0.31272, 0.32903),
            ("F2", 0.37208, 0.37529),
            ("F7", 0.31292, 0.32933),
            ("F11", 0.38052, 0.37713),
        ];
        for (name, x, y) in table {
            let light = shipped::light(name).expect("a light");
            let seen = surface_tristimulus(&white(), &light).expect("light");
            let found = chromaticity(seen).expect("not black");
            assert!((found - DVec2::new(x, y)).abs().max_element() < 1e-4, "{name}: {found}");
            assert!((seen.y - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn illuminant_a_is_the_black_body_of_its_definition() {
        let light = shipped::light("A").expect("a light");
        for (wavelength, power) in light.samples() {
            // ISO/CIE 11664-2: the second constant of radiation is 1.435e7 nm K, the temperature 2848 K.
            let planck = |w: f64| w.powi(-5) / (1.435e7 / (2848.0 * w)).exp_m1();
            assert!((100.0 * planck(wavelength) / planck(560.0) / power - 1.0).abs() < 1e-5, "{wavelength}");
        }
    }

    #[test]
    fn metals_have_the_colours_that_a_reference_gives_them() {
        // Chromaticity and Y at normal incidence under D65, computed with colour-science 0.4.7 from the same indices.
        let table = [
            ("copper", 0.355777, 0.345619, 0.681141),
            ("gold", 0.381798, 0.388735, 0.767860),
            ("silver", 0.313522, 0.329717, 0.984659),
            ("aluminium", 0.311638, 0.328298, 0.914514),
            ("iron", 0.317382, 0.333026, 0.515352),
        ];
        for (name, x, y, luminance) in table {
            let metal = shipped::metal(name).expect("a metal");
            let reflectance = |w: f64| {
                let (n, k) = (metal.n.at(w), metal.k.at(w));
                ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
            };
            let values = (360..=830).map(|w| reflectance(f64::from(w))).collect();
            let spectrum = Spectrum::regular(360.0, 1.0, values, Extrapolation::Held).expect("a spectrum");
            let seen = surface_tristimulus(&spectrum, &shipped::D65).expect("light");
            let found = chromaticity(seen).expect("not black");
            assert!((found - DVec2::new(x, y)).abs().max_element() < 5e-5, "{name}: {found}");
            assert!((seen.y - luminance).abs() < 5e-5, "{name}: {}", seen.y);
            let rgb = srgb::from_xyz(seen);
            assert!(!["copper", "gold"].contains(&name) || rgb.x > rgb.y && rgb.y > rgb.z, "{name}: {rgb}");
        }
    }

    #[test]
    fn patches_of_the_checker_have_their_published_colours() {
        // x, y, Y under D50: published mean of charts by X-Rite 2005. A single chart differs by some hundredths.
        let published: [[f64; 3]; 6] = [
            [0.4316, 0.3777, 0.1008],
            [0.4197, 0.3744, 0.3495],
            [0.2760, 0.3016, 0.1836],
            [0.3703, 0.4499, 0.1325],
            [0.2999, 0.2856, 0.2304],
            [0.2848, 0.3911, 0.4178],
        ];
        // The same, computed with colour-science 0.4.7 from the reflectances that ship here.
        let computed: [[f64; 3]; 6] = [
            [0.4451, 0.3803, 0.0999],
            [0.4181, 0.3759, 0.3628],
            [0.2770, 0.3024, 0.1871],
            [0.3660, 0.4536, 0.1296],
            [0.3038, 0.2887, 0.2417],
            [0.2886, 0.3903, 0.4182],
        ];
        let light = daylight::spectrum(5000.0 * 1.4388 / 1.4380).expect("D50");
        for ((name, published), computed) in shipped::patches().iter().zip(published).zip(computed) {
            let seen = surface_tristimulus(&shipped::reflectance(name).expect("a patch"), &light).expect("light");
            let found = chromaticity(seen).expect("not black").extend(seen.y);
            assert!((found - DVec3::from_array(published)).abs().max_element() < 0.015, "{name}: {found}");
            assert!((found - DVec3::from_array(computed)).abs().max_element() < 2e-4, "{name}: {found}");
        }
    }

    #[test]
    fn what_is_not_seen_has_no_colour() {
        let infrared = Spectrum::irregular(&[(900.0, 1.0), (1000.0, 1.0)], Extrapolation::Zero).expect("a spectrum");
        assert_eq!((surface_tristimulus(&white(), &infrared), chromaticity(DVec3::ZERO)), (None, None));
    }
}
