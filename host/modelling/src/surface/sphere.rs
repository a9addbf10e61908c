//! The sphere.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Surface;
use super::curvature::Curved;

/// A sphere; u is the longitude from the z axis towards the x axis, 0..=1 turn, v the latitude above the x-z plane,
/// -1/4..=1/4 turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

impl Sphere {
    /// The sphere around `center`; `radius` in model units, positive.
    pub fn new(center: DVec3, radius: f64) -> Sphere {
        Sphere { center, radius }
    }
}

impl Surface for Sphere {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::new(0.0, -0.25), DVec2::new(1.0, 0.25)]
    }

    fn point(&self, uv: DVec2) -> DVec3 {
        self.center + self.normal(uv) * self.radius
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let ([su, cu], [sv, cv]) = (sine_and_cosine(uv.x), sine_and_cosine(uv.y));
        let scale = TAU * self.radius;
        [DVec3::new(cu * cv, 0.0, -su * cv) * scale, DVec3::new(-su * sv, cv, -cu * sv) * scale]
    }

    fn point_and_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let ([su, cu], [sv, cv]) = (sine_and_cosine(uv.x), sine_and_cosine(uv.y));
        let out = DVec3::new(su * cv, sv, cu * cv) * self.radius;
        let scale = TAU * self.radius;
        [self.center + out, DVec3::new(cu * cv, 0.0, -su * cv) * scale, DVec3::new(-su * sv, cv, -cu * sv) * scale]
    }

    fn normal(&self, uv: DVec2) -> DVec3 {
        let ([su, cu], [sv, cv]) = (sine_and_cosine(uv.x), sine_and_cosine(uv.y));
        DVec3::new(su * cv, sv, cu * cv)
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        let offset = point - self.center;
        let across = offset.x.hypot(offset.z);
        if across == 0.0 && offset.y == 0.0 {
            return guess;
        }
        let latitude = offset.y.atan2(across) / TAU;
        if across == 0.0 {
            return DVec2::new(guess.x, latitude);
        }
        // Of the two ends of the seam the one that the guess is near.
        let longitude = (offset.x.atan2(offset.z) / TAU).rem_euclid(1.0);
        let near = longitude + (guess.x - longitude).round();
        DVec2::new(if (0.0..=1.0).contains(&near) { near } else { longitude }, latitude)
    }
}

impl Curved for Sphere {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let ([su, cu], [sv, cv]) = (sine_and_cosine(uv.x), sine_and_cosine(uv.y));
        let scale = TAU * TAU * self.radius;
        [DVec3::new(-su * cv, 0.0, -cu * cv), DVec3::new(-cu * sv, 0.0, su * sv), -self.normal(uv)].map(|d| d * scale)
    }
}

/// Sine and cosine of an angle in turns; exact at whole quarters, and the same bits for the same angle.
pub(super) fn sine_and_cosine(turns: f64) -> [f64; 2] {
    let quarters = (turns * 4.0).round();
    let (sine, cosine) = ((turns - quarters * 0.25) * TAU).sin_cos();
    match quarters.rem_euclid(4.0) as u8 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_seam_and_the_poles_agree_to_the_bit() {
        let sphere = Sphere::new(DVec3::new(0.1, 0.2, 0.3), 0.7);
        for k in 0..=64 {
            let v = f64::from(k) / 128.0 - 0.25;
            assert_eq!(sphere.point(DVec2::new(0.0, v)), sphere.point(DVec2::new(1.0, v)));
            let u = f64::from(k) / 64.0;
            assert_eq!(sphere.point(DVec2::new(u, 0.25)), sphere.point(DVec2::new(0.0, 0.25)));
        }
    }

    #[test]
    fn quarters_are_exact() {
        let sphere = Sphere::new(DVec3::ZERO, 1.0);
        assert_eq!(sphere.point(DVec2::new(0.25, 0.0)), DVec3::X);
        assert_eq!(sphere.point(DVec2::new(0.0, 0.0)), DVec3::Z);
        assert_eq!(sphere.point(DVec2::new(0.7, 0.25)), DVec3::Y);
    }
}
