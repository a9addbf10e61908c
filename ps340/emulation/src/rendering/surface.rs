//! Light on a surface.
//!
//! # Model
//! ```text
//! I = sum over lights of  C L (ambient a + diffuse max(N.l, 0)) + L (1 - diffuse) max(R.V, 0)^(2^specular)
//! ```
//! C is the colour of the surface, L that of the light, a its share in the ambient light, l the direction towards it,
//! R the mirrored l, V the direction towards the eye; R counts only where N.l > 0. All by red, green and blue, which
//! are numbers of the frame buffer, not linear light: 1 is 255.
//!
//! # Source
//! Phong 1975; the exponent as a power of two, and the ambient light taken through each light, are ours.

use crate::hue;
use glam::{DMat3, DVec3};
use protocol::command::{Illumination, SurfaceColor};

/// The surface of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Red, green, blue, 0..=1.
    pub color: [f64; 3],
    /// Share of diffuse reflection, 0..=1.
    pub diffuse: f64,
    /// The exponent of the highlight is 2 to this power, 0..=10.
    pub specular: u8,
}

/// A light at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Towards it, of length 1, in eye coordinates.
    pub direction: DVec3,
    /// Red, green, blue, 0..=1.
    pub color: [f64; 3],
    /// Its share in the ambient light, 0..=1.
    pub ambient: f64,
}

impl Surface {
    /// A side as ATTRIBUTES gives it.
    pub fn new(side: &SurfaceColor) -> Surface {
        Surface { color: rgb(side.color), diffuse: side.diffuse.clamp(0.0, 1.0), specular: side.specular.min(10) }
    }

    /// The defaults of ATTRIBUTES, in a hue and saturation.
    pub fn plain([hue, saturation]: [f64; 2]) -> SurfaceColor {
        SurfaceColor { color: [hue, saturation, 1.0], ..SurfaceColor::default() }
    }
}

impl Default for DirectionalLight {
    /// White, from behind the viewer.
    fn default() -> DirectionalLight {
        DirectionalLight { direction: DVec3::NEG_Z, color: [1.0; 3], ambient: 1.0 }
    }
}

impl DirectionalLight {
    /// A light whose direction goes through a matrix; none if nothing is left of the direction.
    ///
    /// ILLUMINATION gives where the light goes: a client of the time, whose eye looks along +z, lights what it sees
    /// with 0,0,1.
    pub fn new(light: &Illumination, matrix: &DMat3) -> Option<DirectionalLight> {
        let direction = -(*matrix * light.direction).try_normalize()?;
        Some(DirectionalLight { direction, color: rgb(light.color), ambient: light.ambient.clamp(0.0, 1.0) })
    }
}

/// Red, green and blue of a hue, a saturation and an intensity.
pub fn rgb([hue, saturation, intensity]: [f64; 3]) -> [f64; 3] {
    let intensity = intensity.clamp(0.0, 1.0);
    hue::rgb(hue as f32, saturation as f32).map(|part| f64::from(part) * intensity)
}

/// The light that a surface sends towards the eye; see the module. May be above 1.
///
/// - `normal`, `eye`: of length 1; the normal on the side of the eye.
/// - `ambient`: red, green and blue of the ambient light.
/// - `highlights`: whether the second term counts.
pub fn light(
    surface: &Surface,
    lights: &[DirectionalLight],
    normal: DVec3,
    eye: DVec3,
    ambient: [f64; 3],
    highlights: bool,
) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for light in lights {
        let facing = normal.dot(light.direction);
        let diffuse = surface.diffuse * facing.max(0.0);
        let mut highlight = 0.0;
        if highlights && facing > 0.0 {
            highlight = (normal * (2.0 * facing) - light.direction).dot(eye).max(0.0);
            for _ in 0..surface.specular {
                highlight *= highlight;
            }
        }
        for (k, sum) in sum.iter_mut().enumerate() {
            let body = surface.color[k] * (ambient[k] * light.ambient + diffuse);
            *sum += light.color[k] * (body + (1.0 - surface.diffuse) * highlight);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const GREY: Surface = Surface { color: [0.5; 3], diffuse: 0.75, specular: 4 };

    fn at(degrees: f64) -> DVec3 {
        let (s, c) = degrees.to_radians().sin_cos();
        DVec3::new(s, 0.0, -c)
    }

    #[test]
    fn the_terms_are_those_of_the_formula() {
        let lamp = DirectionalLight { direction: at(60.0), color: [1.0, 0.5, 0.0], ambient: 0.5 };
        let got = light(&GREY, &[lamp], DVec3::NEG_Z, at(-60.0), [0.2, 0.4, 0.6], true);
        // cos 60 = 1/2; the eye stands in the mirrored direction.
        let expected = [0.5 * (0.2 * 0.5 + 0.75 * 0.5) + 0.25, 0.5 * (0.5 * (0.4 * 0.5 + 0.75 * 0.5) + 0.25), 0.0];
        for (got, expected) in got.into_iter().zip(expected) {
            assert!((got - expected).abs() < 1e-12, "{got} {expected}");
        }
    }

    #[test]
    fn the_highlight_falls_as_the_cosine_to_the_power_of_two_to_the_concentration() {
        let lamp = DirectionalLight { direction: DVec3::NEG_Z, color: [1.0; 3], ambient: 0.0 };
        for specular in 0..=10 {
            let surface = Surface { diffuse: 0.0, specular, ..GREY };
            let got = light(&surface, &[lamp], DVec3::NEG_Z, at(20.0), [0.0; 3], true)[0];
            let expected = 20_f64.to_radians().cos().powi(1 << specular);
            assert!((got - expected).abs() < 1e-12, "{specular}: {got} {expected}");
            assert_eq!(light(&surface, &[lamp], DVec3::NEG_Z, at(20.0), [0.0; 3], false), [0.0; 3]);
        }
    }

    #[test]
    fn light_from_behind_leaves_the_ambient_part() {
        let lamp = DirectionalLight { direction: at(120.0), ..DirectionalLight::default() };
        assert_eq!(light(&GREY, &[lamp], DVec3::NEG_Z, at(0.0), [0.25; 3], true), [0.125; 3]);
    }

    #[test]
    fn lights_add_up() {
        let lamps =
            [-30.0, 10.0, 70.0].map(|angle| DirectionalLight { direction: at(angle), ..DirectionalLight::default() });
        let of = |lamps: &[DirectionalLight]| light(&GREY, lamps, DVec3::NEG_Z, at(5.0), [0.1; 3], true)[0];
        let sum: f64 = lamps.iter().map(|lamp| of(std::slice::from_ref(lamp))).sum();
        assert!((of(&lamps) - sum).abs() < 1e-12);
    }

    #[test]
    fn directions_of_lights_go_through_the_matrix_and_may_vanish() {
        let lamp = Illumination { direction: DVec3::new(0.0, 0.0, 5.0), color: [0.0, 0.0, 1.0], ambient: 1.0 };
        let turned = DirectionalLight::new(&lamp, &DMat3::from_rotation_y(std::f64::consts::FRAC_PI_2)).unwrap();
        assert!((turned.direction - DVec3::NEG_X).length() < 1e-12, "towards the light");
        assert_eq!(DirectionalLight::new(&lamp, &DMat3::ZERO), None);
    }
}
