//! Facts about the principled material: furnaces over all of its numbers, samples against pdfs, reciprocity.

use super::super::context::ShadingContext;
use super::super::prepared_textures::{PreparedNumber, PreparedPaint};
use super::surface::*;
use crate::color::Channels;
use crate::color::WavelengthSets;
use crate::illumination::optics::InterfaceIndices;
use crate::numeric::cubature::unit_square;
use crate::numeric::sampling::{RandomStream, sphere};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The numbers of a material, its color apart.
#[derive(Clone, Copy, Debug)]
struct Numbers {
    metallic: f64,
    roughness: f64,
    specular: f64,
    index: f64,
    transmission: f64,
    thin: bool,
    coat: f64,
    coat_roughness: f64,
    sheen: f64,
    sheen_roughness: f64,
}

const PLAIN: Numbers = Numbers {
    metallic: 0.0,
    roughness: 0.5,
    specular: 1.0,
    index: 1.5,
    transmission: 0.0,
    thin: false,
    coat: 0.0,
    coat_roughness: 0.0,
    sheen: 0.0,
    sheen_roughness: 0.3,
};

fn surface(numbers: &Numbers, base: f64) -> PrincipledSurface {
    let wavelengths = WavelengthSets::bands();
    let slope = |roughness: f64| (roughness > 0.0).then_some(roughness * roughness);
    let make = PrincipledParameters {
        index: numbers.index,
        coat_index: 1.5,
        roughness: slope(numbers.roughness),
        coat_roughness: slope(numbers.coat_roughness),
        thin: numbers.thin,
        has_coat: numbers.coat > 0.0,
        transmits: numbers.transmission > 0.0,
    };
    let colors = [base, numbers.sheen].map(|value| PreparedPaint::Plain(wavelengths.constant(value)));
    let Numbers { metallic, specular, transmission, coat, sheen_roughness, .. } = *numbers;
    let numbers = [metallic, specular, transmission, coat, sheen_roughness].map(PreparedNumber::Constant);
    PrincipledSurface::new(&make, colors, numbers).expect("possible numbers")
}

fn context(numbers: &Numbers, view: DVec3, inside: bool) -> ShadingContext<'static> {
    beside(1.0, numbers, view, inside)
}

/// A context where the body is in a medium of an index.
fn beside(medium: f64, numbers: &Numbers, view: DVec3, inside: bool) -> ShadingContext<'static> {
    let [air, body] = [medium, if numbers.thin { medium } else { numbers.index }].map(Channels::splat);
    let side = match inside {
        false => InterfaceIndices { before: air, behind: body, inside },
        true => InterfaceIndices { before: body, behind: air, inside },
    };
    ShadingContext { view, wavelength_set: 0, indices: side, lane: 0, texture_values: &[] }
}

fn at(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

/// Light that comes to the viewer of a radiance of 1 from all around, times the square of the index where it is.
fn furnace(surface: &PrincipledSurface, context: &ShadingContext) -> f64 {
    let grown = (context.indices.behind.0[0] / context.indices.before.0[0]).powi(2);
    let counted =
        |light: DVec3, weight: f64, straight: bool| if light.z < 0.0 && !straight { weight * grown } else { weight };
    let mut sum = 0.0;
    for part in [PrincipledPart::Coat, PrincipledPart::Facets] {
        for sample in surface.specular_samples(part, context).into_iter().flatten() {
            sum += counted(sample.light, sample.weight.0[0], sample.is_straight);
        }
    }
    let at = surface.at(context);
    for part in [PrincipledPart::Sheen, PrincipledPart::Coat, PrincipledPart::Facets, PrincipledPart::Spread] {
        if surface.is_mirror(part) {
            continue;
        }
        // Both directions of a part that has two: each is sampled for one of the choices.
        for choice in [0.0, 1.0_f64.next_down()] {
            let term = |point: [f64; 2]| {
                let Some(light) = surface.sample(part, context, choice, point) else { return 0.0 };
                let is_asked = match part {
                    PrincipledPart::Facets | PrincipledPart::Spread => (light.z > 0.0) == (choice == 0.0),
                    _ => choice == 0.0,
                };
                let pdf = surface.pdf(part, context, light);
                if !is_asked || pdf <= 0.0 {
                    return 0.0;
                }
                let chance = match part {
                    PrincipledPart::Facets => {
                        let facet = surface.facet(context, light).map_or(1.0, |facet| facet.dot(context.view));
                        let above = surface.chance(&surface.fresnel(&at, context, facet));
                        if light.z > 0.0 { above } else { 1.0 - above }
                    }
                    PrincipledPart::Spread => {
                        let [above, below] = surface.spread_shares(&at, context);
                        if light.z > 0.0 { above / (above + below) } else { below / (above + below) }
                    }
                    _ => 1.0,
                };
                let weight = surface.value(part, context, light).0[0] * light.z.abs() / pdf * chance;
                counted(light, weight, false)
            };
            sum += unit_square(term, 2e-5, 30_000).value;
        }
    }
    sum
}

#[test]
fn a_white_one_returns_all_light_whatever_its_numbers_are() {
    // Numbers at random, the ends of their ranges often; `PERIS_LONG` takes many more.
    let mut stream = RandomStream::new(11, 3);
    let mut any = |ends: [f64; 2]| {
        let [pick, value] = stream.point();
        let at = if pick < 0.3 {
            0.0
        } else if pick < 0.6 {
            1.0
        } else {
            value
        };
        ends[0] + (ends[1] - ends[0]) * at
    };
    let count = if std::env::var_os("PERIS_LONG").is_some() { 2000 } else { 16 };
    let mut all: Vec<(Numbers, f64)> = Vec::new();
    for _ in 0..count {
        let numbers = Numbers {
            metallic: any([0.0, 1.0]),
            roughness: any([0.0, 1.0]),
            specular: any([0.0, 1.0]),
            index: any([1.1, 2.4]),
            transmission: any([0.0, 1.0]),
            thin: any([0.0, 1.0]) > 0.7,
            coat: any([0.0, 1.0]),
            coat_roughness: any([0.0, 1.0]),
            sheen: any([0.0, 1.0]),
            sheen_roughness: any([0.0, 1.0]),
        };
        all.push((numbers, any([0.0, 89.0])));
    }
    let worst = all.par_iter().map(|(numbers, degrees)| {
        let white = surface(numbers, 1.0);
        let is_body = numbers.transmission > 0.0 && !numbers.thin;
        let errors = [false, true].into_iter().filter(|inside| !inside || is_body).map(|inside| {
            let found = furnace(&white, &context(numbers, at(*degrees), inside));
            assert!((found - 1.0).abs() < 1e-3, "{numbers:?} at {degrees}, inside: {inside}: {found}");
            (found - 1.0).abs()
        });
        errors.fold(0.0, f64::max)
    });
    let worst = worst.reduce(|| 0.0, f64::max);
    println!("{} furnaces, the worst off by {worst:.1e}", all.len());
}

#[test]
fn a_white_body_returns_all_light_beside_other_media_than_air() {
    let cases = [(0.4, 1.5, 1.33), (0.7, 1.5, 1.33), (1.0, 1.5, 1.33), (0.6, 1.2, 1.6), (0.8, 2.4, 1.33)];
    cases.par_iter().for_each(|(roughness, index, other)| {
        let numbers = Numbers { roughness: *roughness, index: *index, transmission: 1.0, ..PLAIN };
        let white = surface(&numbers, 1.0);
        for inside in [false, true] {
            for degrees in [0.0, 40.0, 75.0, 89.0] {
                let found = furnace(&white, &beside(*other, &numbers, at(degrees), inside));
                assert!(
                    (found - 1.0).abs() < 1e-3,
                    "{numbers:?} beside {other} at {degrees}, inside: {inside}: {found}"
                );
            }
        }
    });
}

#[test]
fn a_grey_one_never_gains() {
    for numbers in [
        PLAIN,
        Numbers { metallic: 1.0, coat: 1.0, ..PLAIN },
        Numbers { transmission: 1.0, roughness: 0.7, ..PLAIN },
        Numbers { sheen: 0.5, coat: 0.5, coat_roughness: 0.4, ..PLAIN },
    ] {
        let grey = surface(&numbers, 0.5);
        for degrees in [0.0, 45.0, 80.0] {
            let found = furnace(&grey, &context(&numbers, at(degrees), false));
            assert!(found > 0.3 && found < 1.0, "{numbers:?} at {degrees}: {found}");
        }
    }
}

#[test]
fn light_to_and_fro_is_the_same() {
    let mut stream = RandomStream::new(5, 5);
    for numbers in [
        Numbers { metallic: 0.4, coat: 0.7, coat_roughness: 0.3, sheen: 0.3, ..PLAIN },
        Numbers { transmission: 0.8, roughness: 0.6, coat: 0.5, coat_roughness: 0.5, ..PLAIN },
        Numbers { transmission: 0.7, roughness: 0.5, thin: true, ..PLAIN },
    ] {
        let surface = surface(&numbers, 0.7);
        for _ in 0..400 {
            let [view, light] = [stream.point(), stream.point()].map(sphere);
            let (view, light) = (DVec3::new(view.x, view.y, view.z.abs()), light);
            // From below, the surface is seen from inside, upside down.
            let turned = |v: DVec3| DVec3::new(v.x, v.y, -v.z);
            let [mut there, mut back] = [0.0; 2];
            for part in [PrincipledPart::Sheen, PrincipledPart::Coat, PrincipledPart::Facets, PrincipledPart::Spread] {
                let of = context(&numbers, view, false);
                there += surface.value(part, &of, light).0[0]
                    * of.indices.behind.0[0].powi(if light.z < 0.0 { 2 } else { 0 });
                back += if light.z > 0.0 {
                    surface.value(part, &context(&numbers, light, false), view).0[0]
                } else {
                    surface.value(part, &context(&numbers, turned(light), true), turned(view)).0[0]
                };
            }
            assert!((there - back).abs() <= 1e-9 * there.abs().max(1e-6), "{numbers:?}: {there} {back}");
        }
    }
}

#[test]
fn light_to_and_fro_is_the_same_beside_other_media() {
    let mut stream = RandomStream::new(6, 8);
    let turned = |way: DVec3| DVec3::new(way.x, way.y, -way.z);
    let numbers = Numbers { transmission: 1.0, roughness: 0.7, ..PLAIN };
    let (white, medium) = (surface(&numbers, 0.8), 1.33);
    for _ in 0..60 {
        let [view, light] = [0; 2].map(|_| sphere(stream.point()));
        let view = if view.z < 0.0 { turned(view) } else { view };
        let of = beside(medium, &numbers, view, false);
        let value = |part, context: &ShadingContext, light| white.value(part, context, light).0[0];
        let (mut there, mut back) = (0.0, 0.0);
        for part in [PrincipledPart::Facets, PrincipledPart::Spread] {
            if light.z > 0.0 {
                there += value(part, &of, light);
                back += value(part, &beside(medium, &numbers, light, false), view);
            } else {
                there += value(part, &of, light) * numbers.index.powi(2);
                back += value(part, &beside(medium, &numbers, turned(light), true), turned(view)) * medium.powi(2);
            }
        }
        assert!((there - back).abs() <= 1e-6 * there.abs().max(1e-6), "{view} {light}: {there} {back}");
    }
}

#[test]
fn samples_follow_their_pdf_by_chi_squared() {
    // Directions in 6 by 12 parts of equal solid angle of the whole sphere.
    const ROWS: usize = 6;
    const COLUMNS: usize = 12;
    let place = |light: DVec3| {
        let row = ((light.z * 0.5 + 0.5) * ROWS as f64).min(ROWS as f64 - 1.0) as usize;
        let turn = (light.y.atan2(light.x) / (2.0 * PI)).rem_euclid(1.0);
        row * COLUMNS + ((turn * COLUMNS as f64) as usize).min(COLUMNS - 1)
    };
    for (numbers, inside) in [
        (Numbers { metallic: 0.5, roughness: 0.7, coat: 1.0, coat_roughness: 0.6, ..PLAIN }, false),
        (Numbers { transmission: 0.8, roughness: 0.7, ..PLAIN }, false),
        (Numbers { transmission: 1.0, roughness: 0.8, ..PLAIN }, true),
        (Numbers { transmission: 0.6, thin: true, roughness: 0.6, ..PLAIN }, false),
        (Numbers { sheen: 0.6, sheen_roughness: 0.4, roughness: 0.9, ..PLAIN }, false),
    ] {
        let surface = surface(&numbers, 0.8);
        let of = context(&numbers, at(50.0), inside);
        for part in [PrincipledPart::Sheen, PrincipledPart::Coat, PrincipledPart::Facets, PrincipledPart::Spread] {
            if surface.is_mirror(part) || surface.strength(part, &of) <= 0.0 {
                continue;
            }
            let count = 30_000;
            let mut found = [0.0; ROWS * COLUMNS];
            let mut stream = RandomStream::new(17, part as u64);
            for _ in 0..count {
                if let Some(light) = surface.sample(part, &of, stream.uniform(), stream.point()) {
                    found[place(light)] += 1.0;
                }
            }
            let (mut chi, mut degrees) = (0.0, 0);
            let (mut rare, mut rare_found) = (0.0, 0.0);
            for (cell, found) in found.into_iter().enumerate() {
                let (row, column) = ((cell / COLUMNS) as f64, (cell % COLUMNS) as f64);
                let term = |[x, y]: [f64; 2]| {
                    let z = 2.0 * (row + x) / ROWS as f64 - 1.0;
                    let (sin, cos) = (2.0 * PI * (column + y) / COLUMNS as f64).sin_cos();
                    let sine = (1.0 - z * z).max(0.0).sqrt();
                    surface.pdf(part, &of, DVec3::new(sine * cos, sine * sin, z))
                };
                let angle = 4.0 * PI / (ROWS * COLUMNS) as f64;
                let expected = unit_square(term, 1e-5, 5_200).value * angle * f64::from(count);
                if expected < 5.0 {
                    (rare, rare_found) = (rare + expected, rare_found + found);
                    continue;
                }
                chi += (found - expected).powi(2) / expected;
                degrees += 1;
            }
            if rare >= 5.0 {
                chi += (rare_found - rare).powi(2) / rare;
                degrees += 1;
            }
            // A chance of one in 10^5 by Wilson and Hilferty's approximation.
            let n = f64::from(degrees);
            let limit = n * (1.0 - 2.0 / (9.0 * n) + 4.265 * (2.0 / (9.0 * n)).sqrt()).powi(3);
            assert!(chi < limit && degrees > 4, "{numbers:?} {part:?}: {chi} of {degrees}, at most {limit}");
        }
    }
}

#[test]
fn a_polished_one_is_the_limit_of_smooth_ones() {
    let numbers = Numbers { roughness: 0.0, ..PLAIN };
    let (polished, smooth) = (surface(&numbers, 0.6), surface(&Numbers { roughness: 0.02, ..numbers }, 0.6));
    for degrees in [0.0, 50.0, 80.0] {
        let of = context(&numbers, at(degrees), false);
        let [a, b] = [&polished, &smooth].map(|surface| furnace(surface, &of));
        assert!((a - b).abs() < 2e-3, "at {degrees}: {a} {b}");
        let light = at(20.0);
        let [a, b] = [&polished, &smooth].map(|surface| surface.value(PrincipledPart::Spread, &of, light).0[0]);
        assert!((a / b - 1.0).abs() < 0.01, "at {degrees}: {a} {b}");
    }
}

#[test]
fn nothing_is_infinite_at_the_ends() {
    let mut stream = RandomStream::new(2, 9);
    for numbers in [
        Numbers { roughness: 1e-3, transmission: 0.5, ..PLAIN },
        Numbers { roughness: 1.0, index: 1.0, transmission: 1.0, ..PLAIN },
        Numbers { roughness: 1.0, index: 100.0, coat: 1.0, coat_roughness: 1e-3, ..PLAIN },
        Numbers { metallic: 1.0, sheen: 1.0, sheen_roughness: 0.0, ..PLAIN },
        Numbers { roughness: 0.3, index: 1.0 + 1e-9, transmission: 1.0, thin: true, ..PLAIN },
    ] {
        let surface = surface(&numbers, 1.0);
        for _ in 0..2000 {
            let view = sphere(stream.point());
            let grazing = if stream.uniform() < 0.3 { 1e-9 } else { 1.0 };
            let view = DVec3::new(view.x, view.y, view.z.abs() * grazing + 1e-12).normalize();
            let of = context(&numbers, view, false);
            for part in [PrincipledPart::Sheen, PrincipledPart::Coat, PrincipledPart::Facets, PrincipledPart::Spread] {
                let strength = surface.strength(part, &of);
                assert!(strength.is_finite() && strength >= 0.0, "{numbers:?} {part:?} {strength}");
                let light = sphere(stream.point());
                let value = surface.value(part, &of, light);
                assert!(value.is_finite() && value.0.iter().all(|v| *v >= 0.0), "{numbers:?} {part:?} {value:?}");
                if let Some(light) = surface.sample(part, &of, stream.uniform(), stream.point()) {
                    assert!(light.is_finite() && surface.pdf(part, &of, light) >= 0.0);
                }
            }
        }
    }
}
