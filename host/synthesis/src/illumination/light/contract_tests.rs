//! The contract of every light: it is seen as it is sampled, what leaves it is its power, and it is where it says.

use super::{AnyEmitter, EmissionSample, Light, LightOrigin, LightShape, LightSource, SkyDisc, SkyMap};
use crate::color::{Color, WavelengthSets};
use crate::numeric::cubature::unit_square;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::{RandomStream, cosine_hemisphere, sphere};
use crate::numeric::sequence::SobolSequence;
use glam::DVec3;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// Corners of an emitting triangle.
const TRIANGLE: [DVec3; 3] = [DVec3::new(-1.0, 2.0, -0.5), DVec3::new(1.5, 2.5, 0.0), DVec3::new(0.0, 2.0, 1.5)];
/// A point where light arrives, on a surface that faces up.
const POINT: DVec3 = DVec3::new(0.2, 0.1, -0.3);

/// Lights of every kind, all above the point.
fn sources() -> Vec<LightSource> {
    let one = || Color::grey(1.0);
    let at = DVec3::new(0.5, 3.0, 0.4);
    let area = |patch| Light::Area { patch, radiance: one() };
    let towards = DVec3::new(0.3, 0.8, -0.2).normalize();
    let disc = SkyMap { disc: Some(SkyDisc { towards, radius: 0.3 }), ..SkyMap::default() };
    let lights = [
        Light::Point { at, intensity: one() },
        Light::Directional { direction: DVec3::new(0.4, -1.0, 0.1), irradiance: one() },
        area(LightShape::Rectangle { corner: at, across: DVec3::new(1.5, 0.2, 0.0), up: DVec3::new(-0.2, 1.5, 2.0) }),
        area(LightShape::Disc { center: at, normal: DVec3::new(0.2, -1.0, 0.1), radius: 0.8 }),
        area(LightShape::Sphere { center: at, radius: 0.7 }),
        Light::Sky { map: None, radiance: one(), turned: 0.0 },
        Light::Sky { map: Some(disc), radiance: one(), turned: 30.0 },
    ];
    let wavelengths = WavelengthSets::bands();
    let made = |light: &Light| {
        light.check().unwrap_or_else(|error| panic!("{error}"));
        LightSource::new(light, &wavelengths)
    };
    let mesh = LightSource::of_triangles(vec![TRIANGLE], wavelengths.light(&one()));
    lights.iter().chain(&AnyEmitter::tried()).map(made).chain(mesh).collect()
}

#[test]
fn there_is_a_light_of_every_kind() {
    let kinds: BTreeSet<&str> = sources().iter().map(LightSource::kind).collect();
    assert_eq!(kinds, AnyEmitter::KINDS.iter().copied().collect());
}

/// Irradiance of a surface that faces up, by samples of a light.
fn sampled(source: &LightSource) -> f64 {
    let term = |uniform| {
        let light_sample = source.sample_incident(POINT, Some(DVec3::Y), uniform, 0);
        light_sample.map_or(0.0, |beam| beam.irradiance.0[0] * beam.towards.y.max(0.0))
    };
    unit_square(term, 1e-6, 100_000).value
}

/// The radiance that comes from a direction, and the pdf of samples there.
fn seen(source: &LightSource, towards: DVec3) -> (f64, f64) {
    let ray = Ray { origin: POINT, direction: towards };
    let light_hit =
        source.intersect(&ray, 0.0, f64::INFINITY, 0).or_else(|| source.sky_radiance(&ray, Some(DVec3::Y), 0));
    if let Some(light_hit) = light_hit {
        return (light_hit.radiance.0[0], light_hit.pdf);
    }
    // Of a triangle, whoever intersects it knows that it was hit.
    let [a, b, c] = TRIANGLE;
    let normal = (b - a).cross(c - a).normalize();
    let distance = (a - POINT).dot(normal) / towards.dot(normal);
    let met = POINT + towards * distance;
    let is_in = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(met - *p).dot(normal) > 0.0);
    match source.pdf_on_object(POINT, towards, distance, towards.dot(normal)) {
        pdf if pdf > 0.0 && distance > 0.0 && is_in => (1.0, pdf),
        _ => (0.0, 0.0),
    }
}

#[test]
fn sampled_irradiance_is_that_of_all_that_is_seen() {
    let sequence = SobolSequence::new(3, 1);
    let count = 1 << 18;
    for source in sources().iter().filter(|source| !source.is_delta()) {
        let (mut irradiance, mut pdf) = (0.0, 0.0);
        for index in 0..count {
            let (radiance, _) = seen(source, cosine_hemisphere(sequence.point(index, 0), DVec3::Y));
            irradiance += radiance * PI / f64::from(count);
            // The pdf of all directions: over that with which they are sampled here, the sphere's is flat.
            pdf += seen(source, sphere(sequence.point(index, 1))).1 * 2.0 * TAU / f64::from(count);
        }
        let found = sampled(source);
        assert!((found / irradiance - 1.0).abs() < 5e-3, "{}: {found} {irradiance}", source.kind());
        assert!((pdf - 1.0).abs() < 2e-2, "{}: the pdf of its samples integrates to {pdf}", source.kind());
    }
}

#[test]
fn samples_have_the_pdf_that_is_told_and_come_from_where_lights_are() {
    let mut stream = RandomStream::new(1, 2);
    for source in sources() {
        for _ in 0..200 {
            let uniform = stream.point();
            let Some(light_sample) = source.sample_incident(POINT, Some(DVec3::Y), uniform, 0) else { continue };
            assert_eq!(light_sample.pdf.is_none(), source.is_delta(), "{}", source.kind());
            if let Some(pdf) = light_sample.pdf {
                let (radiance, told) = seen(&source, light_sample.towards);
                let error = (told / pdf - 1.0).abs().max((light_sample.irradiance.0[0] * pdf / radiance - 1.0).abs());
                assert!(error < 1e-6, "{}: {pdf} {told} {radiance}", source.kind());
            }
            let is_there = match source.origin() {
                LightOrigin::Within(bounds) => {
                    let end = POINT + light_sample.towards * light_sample.distance;
                    (end - end.clamp(bounds.min, bounds.max)).length() < 1e-9
                }
                LightOrigin::Towards(towards) => light_sample.towards == towards && light_sample.distance.is_infinite(),
                LightOrigin::Everywhere => light_sample.distance.is_infinite() && source.is_infinite(),
            };
            assert!(is_there, "{}", source.kind());
        }
    }
}

#[test]
fn points_that_stand_for_a_light_light_as_it_does() {
    // A disc in the sky stands in its middle, and other skies have no points.
    for source in sources().iter().filter(|source| !source.is_infinite()) {
        let points = source.points(4096);
        let term = |point| {
            source
                .incident_from(point, POINT, 0)
                .map_or(0.0, |light_sample| light_sample.irradiance.0[0] * light_sample.towards.y)
        };
        let (found, expected) = (points.iter().map(term).sum::<f64>(), sampled(source));
        assert!((found / expected - 1.0).abs() < 5e-3, "{}: {found} {expected}", source.kind());
        assert!(points.len() == 1 || !source.is_delta(), "{}", source.kind());
    }
}

#[test]
fn what_leaves_a_light_is_its_power() {
    let sequence = SobolSequence::new(1, 1);
    let (count, radius) = (1 << 14, 2.0);
    for source in sources() {
        let of = |index: u32| match source.sample_emission(sequence.point(index, 0), 0) {
            Some(EmissionSample::Point { normal, .. }) => {
                source.intensity(normal, sphere(sequence.point(index, 1)), 0).0[0] * 2.0 * TAU
            }
            Some(EmissionSample::Parallel { irradiance, .. }) => irradiance.0[0] * PI * radius * radius,
            None => 0.0,
        };
        let found = (0..count).map(of).sum::<f64>() / f64::from(count);
        let power = source.power(radius, 0).0[0];
        assert!((found / power - 1.0).abs() < 1e-2, "{}: {found} {power}", source.kind());
    }
}
