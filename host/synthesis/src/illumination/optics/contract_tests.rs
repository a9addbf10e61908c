//! The contract of every lobe: samples follow their pdf (chi-squared), reciprocity, no more light than comes, flags.

use super::lobe::{Flags, Lobe};
use super::lobes::AnyLobe;
use super::{BsdfBuilder, InterfaceIndices, Interreflection, ShadingContext};
use crate::color::{Channels, WavelengthSets, shipped};
use crate::illumination::distribution::{FacetForm, FacetTable};
use crate::illumination::material::{
    Classic, Coated, Distributed, DistributionForm, Finish, Material, MaterialKind, Metal, Principled, RefractiveIndex,
    Translucent, Transparent,
};
use crate::illumination::texture::{Band, Motif, NumberTexture, Paint, Pattern, TextureMapping, Varying};
use crate::numeric::cubature::unit_square;
use crate::numeric::sampling::RandomStream;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::convert::Infallible;
use std::f64::consts::TAU;

const SAMPLES: usize = 12_000;
/// So many standard deviations of a chi-squared test are no chance any more.
const DOUBT: f64 = 5.0;
/// Bins of the chi-squared test: of the cosine from below to above, and of the azimuth.
const BINS: [usize; 2] = [16, 12];
/// The lanes of two texture values: of a lobe that varies.
const TEXTURE_VALUES: [Channels; 2] = [Channels([0.25; crate::color::LANES]); 2];

fn varying() -> NumberTexture {
    let paints = vec![Paint::grey(0.0), Paint::grey(1.0)];
    let pattern = Pattern { motif: Motif::Noise { octaves: 3 }, laying: TextureMapping::default(), paints };
    NumberTexture::Varying(Box::new(Varying { pattern, band: Band::Mean, from: 0.2, to: 0.6 }))
}

/// Lobes of every kind.
fn lobes() -> Vec<AnyLobe> {
    let grey = Paint::grey;
    let copper = |finish| {
        let shipped::ComplexIndex { n, k } = shipped::metal("copper").expect("a metal");
        Material::from(MaterialKind::Metal(Metal { n, k, finish }))
    };
    let rough = |name: &str, roughness| Finish::Rough { name: name.into(), roughness };
    let coated =
        |roughness: NumberTexture| MaterialKind::Coated(Coated { diffuse: grey(0.6), index: 1.5, roughness }).into();
    let glass = |roughness: f64, facets| {
        MaterialKind::Transparent(Transparent {
            roughness: roughness.into(),
            facets,
            ..Transparent::clear(RefractiveIndex::Constant(1.5))
        })
        .into()
    };
    let model = |name: &str| FacetForm::Model(name.into());
    let table =
        || FacetTable::new("typed", |angle: f64| Ok::<_, Infallible>((-4.0 * angle * angle).exp())).expect("a table");
    let principled = |transmission: f64, roughness: f64| {
        MaterialKind::Principled(Box::new(Principled {
            base_color: grey(0.6),
            metallic: 0.2.into(),
            roughness: roughness.into(),
            transmission: transmission.into(),
            coat: 0.7.into(),
            coat_roughness: 0.3.into(),
            sheen: grey(0.5),
            ..Principled::default()
        }))
        .into()
    };
    let classic = Classic {
        diffuse: grey(0.4),
        specular: grey(0.2),
        exponent: 20.0.into(),
        mirror: grey(0.2),
        transparency: grey(0.2),
    };
    let leaf = Translucent { diffuse: grey(0.3), transmittance: grey(0.4), coat: None };
    let leaf = MaterialKind::Translucent(Box::new(leaf));
    let form = |roughness: f64| DistributionForm::Member { name: "GGX".into(), roughness: roughness.into() };
    let materials: Vec<Material> = vec![
        classic.into(),
        MaterialKind::Shaped(Distributed { reflectance: grey(0.8), form: form(0.4) }).into(),
        copper(Finish::Polished),
        copper(rough("GGX", 0.3.into())),
        copper(rough("GGX, all", 0.6.into())),
        copper(rough("Beckmann", varying())),
        coated(0.3.into()),
        coated(0.0.into()),
        glass(0.0, FacetForm::default()),
        glass(0.35, FacetForm::default()),
        glass(0.5, model("Beckmann, all")),
        glass(0.0, FacetForm::Table(table())),
        leaf.into(),
        principled(0.0, 0.5),
        principled(0.8, 0.5),
        principled(0.8, 0.0),
    ];
    let wavelengths = WavelengthSets::bands();
    let mut library = BsdfBuilder::new(&wavelengths, false);
    let mut all = AnyLobe::tried();
    for material in &materials {
        all.extend(library.bsdf(material, Interreflection::Followed).expect("a material").lobes().cloned());
    }
    all
}

fn context(degrees: f64, before: f64, behind: f64) -> ShadingContext<'static> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let side =
        InterfaceIndices { before: Channels::splat(before), behind: Channels::splat(behind), inside: before > behind };
    ShadingContext {
        view: DVec3::new(sin, 0.0, cos),
        wavelength_set: 0,
        indices: side,
        lane: 0,
        texture_values: &TEXTURE_VALUES,
    }
}

/// From outside and from inside, steeply and at a flat angle.
fn contexts() -> impl Iterator<Item = ShadingContext<'static>> {
    [[1.0, 1.5], [1.5, 1.0]].into_iter().flat_map(|[before, behind]| {
        [15.0, 50.0, 80.0].into_iter().map(move |degrees| context(degrees, before, behind))
    })
}

fn direction(cosine: f64, turn: f64) -> DVec3 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    DVec3::new(sine * cos, sine * sin, cosine)
}

/// The integral over a part of the sphere: from cosine to cosine, from part of a turn to part of a turn.
fn over(cosines: [f64; 2], turns: [f64; 2], most: u32, term: impl Fn(DVec3) -> f64) -> f64 {
    let at = |[x, y]: [f64; 2]| {
        let cosine = cosines[0] + (cosines[1] - cosines[0]) * x;
        term(direction(cosine, turns[0] + (turns[1] - turns[0]) * y))
    };
    unit_square(at, 1e-4, most).value * (cosines[1] - cosines[0]) * (turns[1] - turns[0]) * TAU
}

#[test]
fn there_is_a_lobe_of_every_kind() {
    let kinds: BTreeSet<&str> = lobes().iter().map(AnyLobe::kind).collect();
    assert_eq!(kinds, AnyLobe::KINDS.iter().copied().collect());
}

/// By how many standard deviations samples depart from a pdf: a chi-squared test.
///
/// - `sample`: samples a direction, or none. `pdf`: 1/sr.
fn deviations(
    mut sample: impl FnMut(&mut RandomStream) -> Option<DVec3>,
    pdf: impl Fn(DVec3) -> f64,
) -> Result<f64, String> {
    let mut stream = RandomStream::new(11, 7);
    // Samples without a direction count, too.
    let mut found = vec![0.0; BINS[0] * BINS[1] + 1];
    for _ in 0..SAMPLES {
        let bin = sample(&mut stream).map_or(found.len() - 1, |light| {
            let turn = (light.y.atan2(light.x) / TAU).rem_euclid(1.0);
            let row = ((light.z + 1.0) / 2.0 * BINS[0] as f64) as usize;
            row.min(BINS[0] - 1) * BINS[1] + (turn * BINS[1] as f64) as usize % BINS[1]
        });
        found[bin] += 1.0;
    }
    let mut expected: Vec<f64> = (0..BINS[0] * BINS[1])
        .map(|bin| {
            let (row, column) = ((bin / BINS[1]) as f64, (bin % BINS[1]) as f64);
            let cosines = [row, row + 1.0].map(|row| 2.0 * row / BINS[0] as f64 - 1.0);
            let turns = [column, column + 1.0].map(|column| column / BINS[1] as f64);
            SAMPLES as f64 * over(cosines, turns, 800, &pdf)
        })
        .collect();
    let all: f64 = expected.iter().sum();
    if all > SAMPLES as f64 * 1.002 {
        return Err(format!("the pdf integrates to {}", all / SAMPLES as f64));
    }
    expected.push((SAMPLES as f64 - all).max(0.0));
    // Bins of few samples are taken together.
    let (mut square, mut freedom, mut rest) = (0.0, 0.0, [0.0, 0.0]);
    for (found, expected) in found.iter().zip(&expected) {
        if *expected < 8.0 {
            rest = [rest[0] + found, rest[1] + expected];
        } else {
            square += (found - expected).powi(2) / expected;
            freedom += 1.0;
        }
    }
    square += (rest[0] - rest[1]).powi(2) / rest[1].max(8.0);
    // By Wilson and Hilferty the third root is about normal.
    let variance: f64 = 2.0 / (9.0 * freedom);
    Ok(((square / freedom).cbrt() - (1.0 - variance)) / variance.sqrt())
}

#[test]
fn samples_follow_their_pdf() {
    let spread: Vec<AnyLobe> = lobes().into_iter().filter(|lobe| !lobe.flags().has(Flags::DELTA)).collect();
    spread.par_iter().for_each(|lobe| {
        for context in contexts() {
            let drawn = |stream: &mut RandomStream| lobe.sample(&context, stream.uniform(), stream.point());
            let found = deviations(|stream| Some(drawn(stream)?.light), |light| lobe.pdf(&context, light));
            assert!(found.clone().is_ok_and(|d| d < DOUBT), "{} at {}: {found:?}", lobe.kind(), context.view);
        }
    });
}

#[test]
fn samples_of_a_tenth_more_roughness_are_told_apart() {
    let metal = |roughness: f64| {
        let finish = Finish::Rough { name: "GGX".into(), roughness: roughness.into() };
        let shipped::ComplexIndex { n, k } = shipped::metal("copper").expect("a metal");
        let material = MaterialKind::Metal(Metal { n, k, finish }).into();
        let bsdf = BsdfBuilder::new(&WavelengthSets::bands(), false).bsdf(&material, Interreflection::Followed);
        bsdf.expect("a material").lobes().next().expect("a lobe").clone()
    };
    let (one, other, context) = (metal(0.3), metal(0.33), context(50.0, 1.0, 1.5));
    let drawn = |stream: &mut RandomStream| Some(one.sample(&context, stream.uniform(), stream.point())?.light);
    let found = deviations(drawn, |light| other.pdf(&context, light));
    assert!(found.clone().is_ok_and(|d| d > DOUBT), "{found:?}");
}

#[test]
fn light_goes_to_and_fro_alike() {
    let mut stream = RandomStream::new(3, 5);
    for lobe in &lobes() {
        for context in contexts() {
            for _ in 0..40 {
                let [x, y] = stream.point();
                let light = direction(2.0 * x - 1.0, y);
                let value = lobe.value(&context, light).0[0];
                // Through the surface, the other side is seen in a frame of its own, and radiance is per square of the
                // index.
                let flip = |way: DVec3| DVec3::new(way.x, way.y, way.z.abs() * if light.z > 0.0 { 1.0 } else { -1.0 });
                let InterfaceIndices { before, behind, inside } = context.indices;
                let (back, squares) = match light.z > 0.0 {
                    true => (ShadingContext { view: light, ..context }, [1.0, 1.0]),
                    false => {
                        let side = InterfaceIndices { before: behind, behind: before, inside: !inside };
                        let view = DVec3::new(light.x, light.y, -light.z);
                        // A sheet has one medium on both sides.
                        let is_sheet = lobe.flags().has(Flags::TRANSLUCENT);
                        let squares = [behind, before].map(|index| if is_sheet { 1.0 } else { index.0[0].powi(2) });
                        (ShadingContext { view, indices: side, ..context }, squares)
                    }
                };
                let other = lobe.value(&back, flip(context.view)).0[0];
                let [value, other] = [value * squares[0], other * squares[1]];
                let error = (value - other).abs() / value.max(other).max(1e-3);
                assert!(error < 1e-6, "{}: {} {light}: {value} {other}", lobe.kind(), context.view);
            }
        }
    }
}

#[test]
fn no_lobe_sends_more_light_than_comes_and_its_strength_is_about_that() {
    let all = lobes();
    all.par_iter().for_each(|lobe| {
        for context in contexts() {
            let InterfaceIndices { before, behind, .. } = context.indices;
            let gained = (behind.0[0] / before.0[0]).powi(2);
            let spread =
                |cosines| over(cosines, [0.0, 1.0], 10_000, |light| lobe.value(&context, light).0[0] * light.z.abs());
            let mirrored = lobe.specular_samples(&context).into_iter().flatten();
            let mirrored =
                mirrored.map(|o| o.weight.0[0] * if o.light.z < 0.0 && !o.is_straight { gained } else { 1.0 });
            let sent = spread([0.0, 1.0]) + spread([-1.0, 0.0]) * gained + mirrored.sum::<f64>();
            assert!(sent < 1.003, "{} at {}: {sent}", lobe.kind(), context.view);
            assert!(sent < 1e-6 || lobe.strength(&context) > 0.0, "{} at {}: {sent}", lobe.kind(), context.view);
        }
    });
}

#[test]
fn flags_tell_what_lobes_do() {
    let mut stream = RandomStream::new(9, 1);
    for lobe in lobes() {
        let (flags, kind) = (lobe.flags(), lobe.kind());
        assert!(!flags.has(Flags::BLACK), "{kind}");
        assert!(!flags.has(Flags::DELTA | Flags::BROAD), "{kind}: a delta lobe is not broad");
        for context in contexts() {
            let lights = [0; 20].map(|_| stream.point()).map(|[x, y]| direction(2.0 * x - 1.0, y));
            let sample = lobe.sample(&context, stream.uniform(), stream.point());
            if flags.has(Flags::DELTA) {
                let is_nothing = |l: &DVec3| lobe.value(&context, *l).max() == 0.0 && lobe.pdf(&context, *l) == 0.0;
                assert!(lights.iter().all(is_nothing), "{kind}");
                assert!(sample.is_none_or(|sample| sample.pdf.is_none()), "{kind}");
            } else {
                assert!(lobe.specular_samples(&context).iter().all(Option::is_none), "{kind}");
                assert!(sample.is_none_or(|sample| sample.pdf.is_some()), "{kind}");
            }
            let above = lights.map(|light| DVec3::new(light.x, light.y, light.z.abs()));
            let values = above.map(|light| lobe.value(&context, light).0[0]);
            assert!(!flags.has(Flags::EVEN) || values.iter().all(|value| *value == values[0]), "{kind}");
            assert!(!flags.has(Flags::DIFFUSE) || lobe.diffuse_albedo(&context).max() > 0.0, "{kind}");
            assert!(!flags.has(Flags::STRAIGHT) || sample.is_some_and(|sample| sample.is_straight), "{kind}");
        }
    }
}
