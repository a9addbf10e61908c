//! Facts about the clear sky: closed forms, a random walk through the same air, and what people see.

use super::air::{Air, density, extinction, phases};
use super::columns::{Columns, GROUND, TOP, integrated, to_ground, to_top};
use super::scattering::Scattering;
use super::*;
use crate::color::observer::{self, LUMENS_PER_WATT};
use crate::color::{Extrapolation, Spectrum};
use crate::numeric::sampling::{RandomStream, sphere};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

fn sky(elevation: f64, turbidity: f64, albedo: f64) -> ClearSky {
    ClearSky::new(&Atmosphere { turbidity, albedo, altitude: 50.0, elevation: elevation.to_radians() })
}

/// The node of 560 nm.
const GREEN: usize = 5;

#[test]
fn phase_functions_hold_all_light() {
    for kind in 0..2 {
        let steps = 100_000;
        let sum: f64 = (0..steps).map(|i| phases(2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0)[kind]).sum();
        assert!((sum * 2.0 / f64::from(steps) * TAU - 1.0).abs() < 1e-6, "{kind}");
    }
}

#[test]
fn the_table_of_columns_is_that_of_its_integrals() {
    let (columns, air) = (Columns::new(), Air::new(3.0));
    for height in [0.001, 0.5, 3.0, 12.0, 40.0, 90.0] {
        let radius = GROUND + height;
        let horizon = -(1.0 - (GROUND / radius).powi(2)).sqrt();
        for cosine in [1.0, 0.5, 0.1, 0.02, horizon + 1e-3] {
            let both = [columns.to_top(radius, cosine), integrated(radius, cosine, to_top(radius, cosine))];
            let [found, expected] = both.map(|amounts| (-extinction(&air.extinction, &amounts, GREEN)).exp());
            assert!((found - expected).abs() < 5e-3, "{height} {cosine}: {found} {expected}");
        }
    }
    // Straight up through all air: the scale height, and half of the ozone layer's width.
    let [air, haze, ozone] = columns.to_top(GROUND, 1.0);
    assert!(
        (air - 8.0).abs() < 0.01 && (haze - 1.2).abs() < 0.01 && (ozone - 15.0).abs() < 0.05,
        "{air} {haze} {ozone}"
    );
}

/// A path through the air: where it is, where it goes, and its throughput.
struct Way {
    at: DVec3,
    towards: DVec3,
    left: f64,
}

/// Radiance by a random walk with collisions sampled against the densest air (delta tracking), at one node, under a sun
/// of irradiance 1.
fn walked(air: &Air, eye: f64, view: DVec3, sun: DVec3, albedo: f64, count: u32) -> f64 {
    let columns = Columns::new();
    let mut stream = RandomStream::new(7, 11);
    let taken = |amounts: &[f64; 3]| extinction(&air.extinction, amounts, GREEN);
    let most = taken(&density(0.0)).max(taken(&density(25.0)));
    let lit = |at: DVec3| {
        let (radius, cosine) = (at.length(), at.dot(sun) / at.length());
        let is_hidden = to_ground(radius, cosine).is_some();
        if is_hidden { 0.0 } else { (-taken(&columns.to_top(radius, cosine))).exp() }
    };
    let mut sum = 0.0;
    for _ in 0..count {
        let mut way = Way { at: DVec3::Y * (GROUND + eye), towards: view, left: 1.0 };
        for _ in 0..200 {
            let (radius, cosine) = (way.at.length(), way.at.dot(way.towards) / way.at.length());
            let ground = to_ground(radius, cosine);
            let limit = ground.unwrap_or_else(|| to_top(radius, cosine));
            // To the next real collision.
            let mut t = 0.0;
            let met = loop {
                let [u, v] = stream.point();
                t -= (1.0 - u).ln() / most;
                if t >= limit {
                    break None;
                }
                let density = density((way.at + way.towards * t).length() - GROUND);
                if v * most < taken(&density) {
                    break Some(density);
                }
            };
            let at = way.at + way.towards * t.min(limit);
            match (met, ground) {
                (Some(density), _) => {
                    let [gas, haze] = [0, 1].map(|kind| air.scattering[kind][GREEN] * density[kind]);
                    way.left *= (gas + haze) / taken(&density);
                    let phase = |cosine: f64| {
                        let [a, b] = phases(cosine);
                        (gas * a + haze * b) / (gas + haze)
                    };
                    sum += way.left * phase(way.towards.dot(sun)) * lit(at);
                    let next = sphere(stream.point());
                    way = Way { at, left: way.left * phase(way.towards.dot(next)) * 2.0 * TAU, towards: next };
                }
                (None, Some(_)) => {
                    let up = at.normalize();
                    sum += way.left * albedo / PI * up.dot(sun).max(0.0) * lit(up * (GROUND + 1e-3));
                    let next = sphere(stream.point());
                    let next = if next.dot(up) < 0.0 { -next } else { next };
                    way = Way { at: up * (GROUND + 1e-3), towards: next, left: way.left * albedo * 2.0 * next.dot(up) };
                }
                (None, None) => break,
            }
            // Russian roulette of faint paths.
            let [u, _] = stream.point();
            let kept = way.left.clamp(0.05, 1.0);
            if u >= kept {
                break;
            }
            way.left /= kept;
        }
    }
    sum / f64::from(count)
}

#[test]
fn light_that_is_scattered_often_is_that_of_a_random_walk() {
    let (air, columns) = (Air::new(3.0), Columns::new());
    let scattering = Scattering::new(&air, &columns, 0.3);
    for (elevation, zenith, turn, most) in
        [(45.0, 30.0, 90.0, 0.06), (20.0, 70.0, 150.0, 0.12), (70.0, 10.0, 40.0, 0.06)]
    {
        let [elevation, angle, around] = [elevation, zenith, turn].map(f64::to_radians);
        let view = DVec3::new(angle.sin() * around.cos(), angle.cos(), angle.sin() * around.sin());
        let sun = DVec3::new(elevation.cos(), elevation.sin(), 0.0);
        let expected = walked(&air, 0.05, view, sun, 0.3, 40_000) * air.sun[GREEN];
        let found = scattering.radiance(0.05, view, sun)[GREEN];
        assert!((found / expected - 1.0).abs() < most, "{elevation} {zenith} {turn}: {found} {expected}");
    }
}

#[test]
fn a_sky_is_blue_above_pale_at_the_horizon_and_red_about_a_low_sun() {
    let noon = sky(60.0, 2.5, 0.2);
    let row = |zenith: f64| (zenith / 180.0 * (ROWS - 1) as f64).round() as usize * COLUMNS;
    let tint = |sky: &ClearSky, index: usize| sky.radiance[index][2] / sky.radiance[index][7];
    let across = COLUMNS / 2;
    assert!(
        tint(&noon, row(20.0) + across) > 2.0
            && tint(&noon, row(20.0) + across) > 1.4 * tint(&noon, row(89.0) + across)
    );
    let low = sky(1.0, 3.0, 0.2);
    assert!(low.sun[2] < 0.2 * low.sun[7] && tint(&low, row(89.0)) < 0.6 * tint(&low, row(30.0)));
    // Twilight is faint and not black; nothing is negative.
    let dusk = sky(-5.0, 3.0, 0.2);
    assert_eq!(dusk.sun, [0.0; NODES]);
    let up = dusk.radiance[row(0.0)][GREEN];
    assert!(up > 0.0 && up < 1e-2 * noon.radiance[row(0.0)][GREEN], "{up}");
    assert!([&noon, &low, &dusk].iter().all(|sky| sky.radiance.iter().flatten().all(|light| *light >= 0.0)));
}

#[test]
fn the_day_is_as_bright_as_it_is_measured() {
    let lux = |spectral: &Spectral| {
        let samples: Vec<(f64, f64)> = spectral.iter().enumerate().map(|(i, v)| (node(i), *v)).collect();
        let spectrum = Spectrum::irregular(&samples, Extrapolation::Zero).expect("a spectrum");
        LUMENS_PER_WATT * observer::tristimulus(&spectrum).y
    };
    for elevation in [15.0, 60.0] {
        let clear = sky(elevation, 2.0, 0.2);
        // The IES's fit to measurements of clear skies, Lighting Handbook 1984: level ground under the sky alone.
        let expected = 800.0 + 15_500.0 * f64::to_radians(elevation).sin().sqrt();
        let found = lux(&clear.irradiance());
        assert!((found / expected - 1.0).abs() < 0.2, "{elevation}: {found} {expected}");
        // And of the sun: 127.5 klx outside the air, with an extinction of 0.21 for the air straight up.
        let (found, expected) = (lux(&clear.sun), 127.5e3 * (-0.21 / f64::to_radians(elevation).sin()).exp());
        assert!((found / expected - 1.0).abs() < 0.2, "{elevation}: {found} {expected}");
    }
}

#[test]
fn a_higher_eye_has_a_darker_sky_above_and_the_ground_below() {
    let from = |altitude: f64| {
        let atmosphere = Atmosphere { turbidity: 2.0, albedo: 0.3, altitude, elevation: 0.8 };
        ClearSky::new(&atmosphere).radiance
    };
    let (low, high) = (from(0.0), from(50_000.0));
    assert!(high[0][GREEN] < 0.05 * low[0][GREEN]);
    let down = (ROWS - 1) * COLUMNS;
    assert!(low[down][GREEN] > 0.05 && high[down][GREEN] > 0.5 * low[down][GREEN]);
    assert!(to_top(TOP, 1.0) == 0.0);
}

#[test]
fn a_sky_is_found_once_until_another_one_is_asked_for() {
    let of = |elevation: f64| Atmosphere { turbidity: 2.0, albedo: 0.2, altitude: 0.0, elevation };
    let first = ClearSky::shared(&of(0.3));
    assert!(Arc::ptr_eq(&first, &ClearSky::shared(&of(0.3))));
    assert_eq!(first.radiance, ClearSky::new(&of(0.3)).radiance);
    let other = ClearSky::shared(&of(0.4));
    assert!(!Arc::ptr_eq(&first, &other) && other.radiance != first.radiance);
}
