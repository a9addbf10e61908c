//! Facts about light as it leaves its source.

use super::{EmissionSample, Goniometry, Light, LightShape, LightSource};
use crate::color::{Color, WavelengthSets};
use crate::numeric::sampling::sphere;
use crate::numeric::sequence::SobolSequence;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The flux that leaves a source in all directions, by samples.
fn sampled(source: &LightSource) -> f64 {
    let sequence = SobolSequence::new(1, 1);
    let count = 1 << 14;
    let of = |index: u32| {
        let start = source.sample_emission(sequence.point(index, 0), 0);
        let Some(EmissionSample::Point { normal, .. }) = start else { return 0.0 };
        source.intensity(normal, sphere(sequence.point(index, 1)), 0).0[0] * 2.0 * TAU
    };
    (0..count).map(of).sum::<f64>() / f64::from(count)
}

#[test]
fn what_leaves_a_source_is_its_power() {
    let one = || Color::grey(1.0);
    let area = |patch| Light::Area { patch, radiance: one() };
    let (at, y) = (DVec3::new(1.0, 2.0, 3.0), DVec3::Y);
    // A table of intensities that fall with the height: 1 + cos of the angle from straight down.
    let vertical: Vec<f64> = (0..=180).map(f64::from).collect();
    let candelas = vertical.iter().map(|v| 683.0 * (1.0 + v.to_radians().cos())).collect();
    let goniometry = Goniometry::new(vertical, vec![0.0], candelas).expect("a table");
    let lights = [
        (Light::Point { at, intensity: one() }, 2.0 * TAU),
        (
            Light::Spot { at, direction: y, intensity: one(), inner: 20.0, outer: 60.0 },
            TAU * (1.0 - 0.5 * (20f64.to_radians().cos() + 60f64.to_radians().cos())),
        ),
        (area(LightShape::Rectangle { corner: at, across: DVec3::X * 2.0, up: DVec3::Z * 3.0 }), 6.0 * PI),
        (area(LightShape::Disc { center: at, normal: y, radius: 2.0 }), 4.0 * PI * PI),
        (area(LightShape::Sphere { center: at, radius: 2.0 }), 16.0 * PI * PI),
        (Light::Luminaire { at, down: -y, front: DVec3::X, goniometry, color: one() }, 2.0 * TAU),
    ];
    for (light, expected) in lights {
        let source = LightSource::new(&light, &WavelengthSets::bands());
        let (found, power) = (sampled(&source), source.power(1.0, 0).0[0]);
        assert!((power / expected - 1.0).abs() < 1e-4, "{}: {power} {expected}", light.words());
        assert!((found / expected - 1.0).abs() < 1e-2, "{}: {found} {expected}", light.words());
    }
}

#[test]
fn a_sky_sends_its_light_through_every_disc() {
    let light = Light::Sky { map: None, radiance: Color::grey(2.0), turned: 0.0 };
    let source = LightSource::new(&light, &WavelengthSets::bands());
    let Some(EmissionSample::Parallel { irradiance, .. }) = source.sample_emission([0.3, 0.7], 0) else {
        panic!("parallel")
    };
    assert!((irradiance.0[0] - 4.0 * TAU).abs() < 1e-9);
    assert!((source.power(3.0, 0).0[0] - 4.0 * TAU * 9.0 * PI).abs() < 1e-9);
}
