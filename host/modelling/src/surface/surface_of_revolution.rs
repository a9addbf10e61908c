//! Exact surfaces of revolution: cylinders, cones, discs, zones of spheres, tori, paraboloids, hyperboloids and more.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::curvature::Curved;
use super::sphere::sine_and_cosine;
use super::{ParameterLine, Profile, Surface, between};

/// The surface that a [`Profile`] makes when it revolves about the y axis.
///
/// u is the angle from the z axis towards the x axis in turns; v is the parameter of the profile, 0..=1. The outside is
/// on the right of a profile that is followed upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceOfRevolution {
    profile: Profile,
    turns: [f64; 2],
}

impl SurfaceOfRevolution {
    /// The surface of a whole turn.
    pub fn whole(profile: Profile) -> SurfaceOfRevolution {
        SurfaceOfRevolution { profile, turns: [0.0, 1.0] }
    }

    /// The surface from the first angle to the second, turns; the second is greater by at most 1.
    pub fn part(profile: Profile, turns: [f64; 2]) -> SurfaceOfRevolution {
        SurfaceOfRevolution { profile, turns }
    }

    /// Where a point of the half plane comes to at an angle, turns.
    pub fn revolve(point: DVec2, turns: f64) -> DVec3 {
        let [sine, cosine] = sine_and_cosine(turns);
        DVec3::new(point.x * sine, point.y, point.x * cosine)
    }
}

/// The direction in which u grows.
fn azimuthal(turns: f64) -> DVec3 {
    let [sine, cosine] = sine_and_cosine(turns);
    DVec3::new(cosine, 0.0, -sine)
}

impl Surface for SurfaceOfRevolution {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::new(self.turns[0], 0.0), DVec2::new(self.turns[1], 1.0)]
    }

    fn point(&self, uv: DVec2) -> DVec3 {
        SurfaceOfRevolution::revolve(self.profile.point(uv.y), uv.x)
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let radius = self.profile.point(uv.y).x;
        [azimuthal(uv.x) * (TAU * radius), SurfaceOfRevolution::revolve(self.profile.derivatives(uv.y)[0], uv.x)]
    }

    fn point_and_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let [sine, cosine] = sine_and_cosine(uv.x);
        let turned = |p: DVec2| DVec3::new(p.x * sine, p.y, p.x * cosine);
        let [point, along] = self.profile.point_and_derivative(uv.y);
        [turned(point), DVec3::new(cosine, 0.0, -sine) * (TAU * point.x), turned(along)]
    }

    /// The normal; on the axis, where every angle has a limit of its own, that of the angle.
    fn normal(&self, uv: DVec2) -> DVec3 {
        let along = self.profile.direction(uv.y);
        SurfaceOfRevolution::revolve(DVec2::new(along.y, -along.x), uv.x)
    }

    /// The circle of a parameter v, for which the profile is asked once.
    fn line(&self, v: f64) -> ParameterLine<'_> {
        let [point, along] = self.profile.point_and_direction(v);
        let normal = DVec2::new(along.y, -along.x);
        Box::new(move |u| {
            let [sine, cosine] = sine_and_cosine(u);
            [point, normal].map(|own| DVec3::new(own.x * sine, own.y, own.x * cosine))
        })
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        let [low, high] = self.turns;
        let across = point.x.hypot(point.z);
        if across == 0.0 {
            return DVec2::new(guess.x, self.profile.nearest(DVec2::new(0.0, point.y), guess.y));
        }
        let angle = point.x.atan2(point.z) / TAU;
        let near = |t: f64| angle + (t - angle).round();
        // Of the two ends of the seam the one that the guess is near.
        let found = [near(guess.x), near(between(low, high, 0.5))].into_iter().find(|u| (low..=high).contains(u));
        let u = found.unwrap_or_else(|| {
            let gap = |end: f64| (near(end) - end).abs();
            if gap(low) <= gap(high) { low } else { high }
        });
        // Beside an open end, what counts is the half plane of that end.
        let radius = if found.is_some() { across } else { across * sine_and_cosine(angle - u)[1] };
        DVec2::new(u, self.profile.nearest(DVec2::new(radius, point.y), guess.y))
    }
}

impl Curved for SurfaceOfRevolution {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let radius = self.profile.point(uv.y).x;
        let [first, second] = self.profile.derivatives(uv.y);
        let out = SurfaceOfRevolution::revolve(DVec2::X, uv.x);
        [out * (-TAU * TAU * radius), azimuthal(uv.x) * (TAU * first.x), SurfaceOfRevolution::revolve(second, uv.x)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::normal_curvature;
    use super::*;

    #[test]
    fn the_seam_and_the_poles_agree_to_the_bit() {
        let dome = SurfaceOfRevolution::whole(Profile::Arc {
            center: DVec2::new(0.0, 0.3),
            radius: 0.7,
            turns: [-0.25, 0.25],
        });
        for k in 0..=64 {
            let t = f64::from(k) / 64.0;
            assert_eq!(dome.point(DVec2::new(0.0, t)), dome.point(DVec2::new(1.0, t)));
            assert_eq!(dome.point(DVec2::new(t, 1.0)), DVec3::Y);
            assert_eq!(dome.point(DVec2::new(t, 0.5)).y, 0.3);
        }
    }

    #[test]
    fn tori_have_the_curvatures_of_the_book() {
        let torus = SurfaceOfRevolution::whole(Profile::Arc { center: DVec2::X * 3.0, radius: 1.0, turns: [0.0, 1.0] });
        for k in 0..16 {
            let v = f64::from(k) / 16.0;
            let uv = DVec2::new(0.3, v);
            let [around, along] = torus.derivatives(uv);
            let [sine_v, cosine_v] = sine_and_cosine(v);
            assert!((torus.point(uv).y - sine_v).abs() < 1e-15);
            assert!((normal_curvature(&torus, uv, along).unwrap() + 1.0).abs() < 1e-13);
            let expected = -cosine_v / (3.0 + cosine_v);
            assert!((normal_curvature(&torus, uv, around).unwrap() - expected).abs() < 1e-13);
        }
    }

    #[test]
    fn quadrics_fulfil_their_equations() {
        let on = |profile: Profile, equation: fn(DVec3) -> f64| {
            let surface = SurfaceOfRevolution::whole(profile);
            for k in 0..=400 {
                let uv = DVec2::new(f64::from(k % 20) / 19.0, f64::from(k / 20) / 20.0);
                assert!(equation(surface.point(uv)).abs() < 1e-14, "{uv} {}", equation(surface.point(uv)));
            }
        };
        on(Profile::line(DVec2::new(2.0, 1.0), DVec2::Y * 3.0), |p| p.x.hypot(p.z) - (3.0 - p.y));
        on(Profile::Parabola { apex: 1.0, rise: 0.5, reach: [0.0, 2.0] }, |p| {
            1.0 + 0.5 * (p.x * p.x + p.z * p.z) - p.y
        });
        on(Profile::HyperbolaOneSheet { across: 0.5, along: 2.0, reach: [-1.0, 1.5] }, |p| {
            4.0 * (p.x * p.x + p.z * p.z) - p.y * p.y / 4.0 - 1.0
        });
        on(Profile::HyperbolaTwoSheets { across: 0.5, along: 2.0, reach: [0.0, 1.0] }, |p| {
            p.y * p.y / 4.0 - 4.0 * (p.x * p.x + p.z * p.z) - 1.0
        });
    }
}
