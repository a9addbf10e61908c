//! Facts about what surfaces scatter: white furnaces, closed forms, and samples against pdfs.

use super::*;
use crate::color::Channels;
use crate::color::{Color, WavelengthSets, shipped};
use crate::illumination::material::{
    Classic, Coated, Distributed, DistributionForm, Finish, Material, MaterialKind, Metal, RefractiveIndex, Transparent,
};
use crate::illumination::texture::{Band, Motif, NumberTexture, Paint, Pattern, TextureMapping, Varying};
use crate::numeric::cubature::unit_square;
use crate::numeric::sampling::{RandomStream, sphere};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

fn ready(material: &Material, wavelengths: &WavelengthSets) -> Bsdf {
    BsdfBuilder::new(wavelengths, false)
        .bsdf(material, Interreflection::Followed)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn context(degrees: f64, before: f64, behind: f64) -> ShadingContext<'static> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let side =
        InterfaceIndices { before: Channels::splat(before), behind: Channels::splat(behind), inside: before > behind };
    ShadingContext { view: DVec3::new(sin, 0.0, cos), wavelength_set: 0, indices: side, lane: 0, texture_values: &[] }
}

fn copper(finish: Finish) -> Material {
    let shipped::ComplexIndex { n, k } = shipped::metal("copper").expect("a metal");
    MaterialKind::Metal(Metal { n, k, finish }).into()
}

fn rough(name: &str, roughness: f64) -> Finish {
    Finish::Rough { name: name.into(), roughness: f64::into(roughness) }
}

/// Light that comes to the viewer of a radiance of 1 from everywhere, by samples that are spread evenly.
fn furnace(bsdf: &Bsdf, context: &ShadingContext) -> f64 {
    let mirrored: f64 = bsdf.specular_samples(context).map(|sample| sample.weight.0[0]).sum();
    let spread = |choice: f64| {
        let drawn = |point| {
            bsdf.sample(context, choice, point, LobeSelection::NonDelta).map_or(0.0, |sample| sample.weight.0[0])
        };
        unit_square(drawn, 1e-4, 20_000).value
    };
    // Lobes are chosen by the first number; it is averaged over evenly.
    let steps = 64;
    mirrored + (0..steps).map(|k| spread((f64::from(k) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps)
}

/// The integral of value times cosine over all directions, by cubature.
fn integral(bsdf: &Bsdf, context: &ShadingContext) -> f64 {
    let half = |below: f64| {
        let term = |[x, y]: [f64; 2]| {
            let cosine = x.sqrt();
            let (sin, cos) = (TAU * y).sin_cos();
            let sine = (1.0 - x).max(0.0).sqrt();
            let light = DVec3::new(sine * cos, sine * sin, cosine * below);
            PI * [LobeClass::Broad, LobeClass::Narrow, LobeClass::LightsOnly]
                .map(|which| bsdf.value(which, context, light).0[0])
                .iter()
                .sum::<f64>()
        };
        unit_square(term, 1e-5, 400_000).value
    };
    half(1.0) + half(-1.0)
}

#[test]
fn a_white_coated_ground_returns_what_it_gets() {
    let wavelengths = WavelengthSets::bands();
    for (index, roughness) in [(1.5, 0.0), (1.33, 0.0), (2.4, 0.0), (1.0, 0.0), (1.5, 0.1), (1.5, 0.7)] {
        let material =
            MaterialKind::Coated(Coated { diffuse: Paint::grey(1.0), index, roughness: f64::into(roughness) }).into();
        let bsdf = ready(&material, &wavelengths);
        for degrees in [0.0, 40.0, 75.0, 88.0] {
            let context = context(degrees, 1.0, 1.0);
            let mirrored: f64 = bsdf.specular_samples(&context).map(|sample| sample.weight.0[0]).sum();
            let all = mirrored + integral(&bsdf, &context);
            assert!((all - 1.0).abs() < 3e-4, "{index} {roughness} at {degrees}: {all}");
        }
    }
}

#[test]
fn samples_and_values_tell_the_same_of_every_material() {
    let wavelengths = WavelengthSets::bands();
    let classic =
        Classic { diffuse: Paint::grey(0.4), specular: Paint::grey(0.3), exponent: 20.0.into(), ..Classic::default() };
    let glass = |roughness| {
        Material::from(MaterialKind::Transparent(Transparent {
            roughness: f64::into(roughness),
            ..Transparent::clear(RefractiveIndex::Constant(1.5))
        }))
    };
    let shaped = DistributionForm::Member { name: "Blinn".into(), roughness: 0.4.into() };
    let materials = [
        (Material::from(classic), 1.0),
        (copper(rough("Beckmann", 0.3)), 1.0),
        (copper(rough("GGX, all", 0.6)), 1.0),
        (copper(rough("improved (7)", 0.4)), 1.0),
        (MaterialKind::Shaped(Distributed { reflectance: Paint::grey(0.8), form: shaped }).into(), 1.0),
        (MaterialKind::Coated(Coated { diffuse: Paint::grey(0.6), index: 1.5, roughness: 0.2.into() }).into(), 1.0),
        (glass(0.3), 1.5),
        (glass(0.15), 1.5),
    ];
    for (material, behind) in materials {
        let bsdf = ready(&material, &wavelengths);
        for degrees in [5.0, 60.0] {
            for (before, behind) in [(1.0, behind), (behind, 1.0)] {
                let context = context(degrees, before, behind);
                let (drawn, sum) = (furnace(&bsdf, &context), integral(&bsdf, &context));
                let error = (drawn - sum).abs() / sum.max(0.1);
                assert!(error < 0.02, "{} at {degrees} from {before}: {drawn} {sum}", material.word());
            }
        }
    }
}

/// A number that a pattern tells, from one to another.
fn varying(from: f64, to: f64) -> NumberTexture {
    let paints = vec![Paint::grey(0.0), Paint::grey(1.0)];
    let pattern = Pattern {
        motif: Motif::Noise { octaves: 3 },
        laying: TextureMapping { solid: true, ..TextureMapping::default() },
        paints,
    };
    NumberTexture::Varying(Box::new(Varying { pattern, band: Band::Mean, from, to }))
}

#[test]
fn a_lobe_that_varies_is_that_of_the_value_at_the_place() {
    let wavelengths = WavelengthSets::bands();
    let metal = |roughness| copper(Finish::Rough { name: "GGX".into(), roughness });
    let coated = |roughness| MaterialKind::Coated(Coated { diffuse: Paint::grey(0.6), index: 1.5, roughness }).into();
    let glass = |roughness| {
        MaterialKind::Transparent(Transparent { roughness, ..Transparent::clear(RefractiveIndex::Constant(1.5)) })
            .into()
    };
    let kinds: [&dyn Fn(NumberTexture) -> Material; 3] = [&metal, &coated, &glass];
    for made in kinds {
        let varied = ready(&made(varying(0.1, 0.5)), &wavelengths);
        assert!(varied.is_textured());
        for roughness in [0.1, 0.17, 0.3, 0.5] {
            let texture_values = [Channels::splat(roughness); 2];
            let of = context(40.0, 1.0, 1.5);
            let at = ShadingContext { texture_values: &texture_values, ..of };
            let same = ready(&made(roughness.into()), &wavelengths);
            let (drawn, sum) = (furnace(&varied, &at), integral(&varied, &at));
            assert!((drawn - sum).abs() < 0.01, "{roughness}: {drawn} {sum}");
            let constant = integral(&same, &of);
            assert!((constant - sum).abs() < 2e-3, "{roughness}: {constant} {sum}");
            let light = DVec3::new(-0.55, 0.1, 0.8).normalize();
            let [a, b] = [varied.total_value(&at, light).0[0], same.total_value(&of, light).0[0]];
            assert!((a / b - 1.0).abs() < 0.03, "{roughness}: {a} {b}");
        }
    }
    // The ends are exact, and so is what lies beyond them.
    let varied = ready(&metal(varying(0.1, 0.5)), &wavelengths);
    let same = ready(&metal(0.5.into()), &wavelengths);
    let of = context(40.0, 1.0, 1.5);
    let light = DVec3::new(-0.4, 0.1, 0.8).normalize();
    for beyond in [0.5, 0.9] {
        let texture_values = [Channels::splat(beyond)];
        let [a, b] = [
            varied.total_value(&ShadingContext { texture_values: &texture_values, ..of }, light),
            same.total_value(&of, light),
        ];
        assert_eq!(a, b);
    }
}

#[test]
fn a_metal_may_be_brushed_as_patterns_tell() {
    let wavelengths = WavelengthSets::bands();
    let brushed = |roughness| copper(Finish::Brushed { name: "Beckmann".into(), roughness, along: DVec3::X });
    let varied = ready(&brushed([varying(0.05, 0.2), varying(0.2, 0.6)]), &wavelengths);
    let same = ready(&brushed([0.1.into(), 0.4.into()]), &wavelengths);
    let of = context(30.0, 1.0, 1.0);
    // The pattern of the roughness across is the first.
    let texture_values = [Channels::splat(0.4), Channels::splat(0.1)];
    let at = ShadingContext { texture_values: &texture_values, ..of };
    for light in [DVec3::new(-0.5, 0.0, 0.86), DVec3::new(-0.45, 0.3, 0.8)] {
        let [a, b] = [varied.total_value(&at, light.normalize()), same.total_value(&of, light.normalize())];
        assert!((a.0[0] / b.0[0] - 1.0).abs() < 0.04, "{a:?} {b:?}");
    }
}

#[test]
fn pdfs_are_those_of_the_sampled_directions() {
    let wavelengths = WavelengthSets::bands();
    let rough_glass = Transparent { roughness: 0.4.into(), ..Transparent::clear(RefractiveIndex::Constant(1.5)) };
    let materials = [
        copper(rough("GGX", 0.4)),
        MaterialKind::Coated(Coated { diffuse: Paint::grey(0.6), index: 1.5, roughness: 0.3.into() }).into(),
        MaterialKind::Transparent(rough_glass).into(),
    ];
    for material in materials {
        let bsdf = ready(&material, &wavelengths);
        for (before, behind) in [(1.0, 1.5), (1.5, 1.0)] {
            let context = context(35.0, before, behind);
            // Share of samples in a cap, counted and integrated.
            let mut stream = RandomStream::new(5, 1);
            let axis =
                DVec3::new(-0.4, 0.3, if matches!(material.body, MaterialKind::Transparent(_)) { -0.6 } else { 0.6 });
            let (axis, cosine) = (axis.normalize(), 0.8);
            let count = 40_000;
            let mut inside = 0.0;
            for _ in 0..count {
                let sample = bsdf.sample(&context, stream.uniform(), stream.point(), LobeSelection::All);
                inside += f64::from(u8::from(sample.is_some_and(|sample| sample.light.dot(axis) > cosine)));
            }
            let frame = crate::illumination::distribution::ShadingFrame::from_normal(axis);
            let term = |[x, y]: [f64; 2]| {
                let z = 1.0 - x * (1.0 - cosine);
                let (sin, cos) = (TAU * y).sin_cos();
                let sine = (1.0 - z * z).sqrt();
                let light = frame.world(DVec3::new(sine * cos, sine * sin, z));
                LobeClass::CONTINUING
                    .iter()
                    .map(|which| bsdf.pdf(*which, &context, light, LobeSelection::All))
                    .sum::<f64>()
            };
            let expected = TAU * (1.0 - cosine) * unit_square(term, 1e-5, 100_000).value;
            let found = inside / f64::from(count);
            let error = (expected * (1.0 - expected) / f64::from(count)).sqrt();
            assert!((found - expected).abs() < 5.0 * error + 1e-3, "{}: {found} {expected}", material.word());
        }
    }
}

#[test]
fn smooth_glass_splits_light_without_loss_and_bends_it_by_snells_law() {
    let wavelengths = WavelengthSets::bands();
    let glass = Transparent::clear(RefractiveIndex::Constant(1.5));
    let bsdf = ready(&MaterialKind::Transparent(glass).into(), &wavelengths);
    for degrees in [0.0, 30.0, 80.0, 89.9] {
        let context = context(degrees, 1.0, 1.5);
        let both: Vec<BsdfSample> = bsdf.specular_samples(&context).collect();
        let [reflected, refracted] = both.try_into().expect("two directions");
        let all = reflected.weight.0[0] + refracted.weight.0[0] * 2.25;
        assert!((all - 1.0).abs() < 1e-12, "{degrees}: {all}");
        assert!((refracted.light.x + degrees.to_radians().sin() / 1.5).abs() < 1e-12);
    }
    let total: Vec<BsdfSample> = bsdf.specular_samples(&context(60.0, 1.5, 1.0)).collect();
    assert_eq!((total.len(), total[0].weight.0[0]), (1, 1.0), "total reflection");
}

#[test]
fn a_rough_metal_with_all_reflections_loses_only_what_it_absorbs() {
    // A metal that reflects everything: n = 0, k > 0.
    let flat = |value: f64| {
        crate::color::Spectrum::regular(300.0, 600.0, vec![value; 2], crate::color::Extrapolation::Held)
            .expect("a spectrum")
    };
    let wavelengths = WavelengthSets::bands();
    for roughness in [0.1, 0.5, 1.0] {
        let metal = Metal { n: flat(0.0), k: flat(3.0), finish: rough("GGX, all", roughness) };
        let bsdf = ready(&MaterialKind::Metal(metal).into(), &wavelengths);
        for degrees in [0.0, 45.0, 80.0] {
            let all = integral(&bsdf, &context(degrees, 1.0, 1.0));
            assert!((all - 1.0).abs() < 3e-4, "{roughness} at {degrees}: {all}");
        }
    }
}

#[test]
fn copper_under_white_light_has_the_color_of_its_reflectance() {
    let wavelengths = WavelengthSets::spectral();
    let bsdf = ready(&copper(Finish::Polished), &wavelengths);
    let white = wavelengths.light(&Color::grey(1.0));
    let sets = wavelengths.count();
    let seen: DVec3 = (0..sets)
        .map(|wavelength_set| {
            let context = ShadingContext { wavelength_set, ..context(0.0, 1.0, 1.0) };
            let mirrored = bsdf.specular_samples(&context).next().expect("a mirror");
            wavelengths.to_srgb(wavelength_set, mirrored.weight * white.of(wavelength_set))
        })
        .sum::<DVec3>()
        / sets as f64;
    // Chromaticity and Y from colour-science 0.4.7, from the same indices.
    let xyz = crate::color::srgb::to_xyz(seen);
    let xy = crate::color::observer::chromaticity(xyz).expect("not black");
    assert!(
        (xy - glam::DVec2::new(0.355777, 0.345619)).length() < 2e-4 && (xyz.y - 0.681141).abs() < 2e-4,
        "{xy} {xyz}"
    );
}

#[test]
fn light_goes_straight_through_and_impossible_materials_are_errors() {
    let wavelengths = WavelengthSets::bands();
    let curtain = Classic { transparency: Paint::grey(0.25), ..Classic::default() };
    let bsdf = ready(&curtain.into(), &wavelengths);
    let straight: Vec<BsdfSample> = bsdf.specular_samples(&context(30.0, 1.0, 1.0)).collect();
    assert!(straight[0].is_straight && straight[0].weight.0[0] == 0.25 && bsdf.straight_transmission.is_some());
    let mut library = BsdfBuilder::new(&wavelengths, false);
    let mut refused = |material: Material| library.bsdf(&material, Interreflection::Followed).unwrap_err().to_string();
    let loud = Classic { diffuse: Paint::grey(1.5), ..Classic::default() };
    assert!(refused(loud.into()).contains("diffuse reflectance"));
    assert!(refused(copper(rough("Beckman", 0.3))).contains("did you mean Beckmann?"));
    assert!(refused(copper(rough("Beckmann", -0.3))).contains("roughness"));
    let hollow = Coated { diffuse: Paint::grey(0.5), index: 0.0, roughness: 0.0.into() };
    assert!(refused(MaterialKind::Coated(hollow).into()).contains("index"));
}

#[test]
fn nothing_is_infinite_at_the_extremes() {
    let wavelengths = WavelengthSets::bands();
    let glass = |index, roughness| {
        Material::from(MaterialKind::Transparent(Transparent {
            roughness: f64::into(roughness),
            ..Transparent::clear(RefractiveIndex::Constant(index))
        }))
    };
    let mut materials =
        vec![glass(1.0 + 1e-9, 0.0), glass(1e3, 0.0), glass(1.0 + 1e-9, 0.1), glass(1e3, 1e-6), glass(1.5, 10.0)];
    for roughness in [1e-6, 1e-3, 1.0, 10.0] {
        materials.extend(
            ["Beckmann", "GGX, all", "Cook-Torrance", "improved (7)"].map(|name| copper(rough(name, roughness))),
        );
    }
    let mut stream = RandomStream::new(3, 3);
    for material in materials {
        let bsdf = ready(&material, &wavelengths);
        let index = bsdf.interior.as_ref().map_or(1.0, |interior| interior.index.of(0).0[0]);
        for (before, behind) in [(1.0, index), (index, 1.0)] {
            for degrees in [0.0, 60.0, 89.9999] {
                let context = context(degrees, before, behind);
                for _ in 0..200 {
                    let light = sphere(stream.point());
                    let value = bsdf.total_value(&context, light);
                    assert!(value.is_finite() && value.0.iter().all(|v| *v >= 0.0));
                    assert!(LobeClass::CONTINUING.iter().all(|which| bsdf.pdf(
                        *which,
                        &context,
                        light,
                        LobeSelection::All
                    ) >= 0.0));
                    let sample = bsdf.sample(&context, stream.uniform(), stream.point(), LobeSelection::All);
                    assert!(sample.is_none_or(|o| o.weight.is_finite() && (o.light.length() - 1.0).abs() < 1e-6));
                }
            }
        }
    }
}

#[test]
fn absorption_over_the_wavelength_has_its_colour_however_strong_it_is() {
    let wavelengths = WavelengthSets::spectral();
    let white = wavelengths.light(&Color::grey(1.0));
    let sets = wavelengths.count();
    for scale in [0.1, 1.0, 100.0] {
        let bands = glam::DVec3::new(0.2, 9.0, 7.0) * scale;
        let glass =
            Transparent { absorption: Color::Bands(bands), ..Transparent::clear(RefractiveIndex::Constant(1.5)) };
        let absorption =
            ready(&MaterialKind::Transparent(glass).into(), &wavelengths).interior.expect("glass").absorption;
        let seen: DVec3 = (0..sets)
            .map(|wavelength_set| {
                wavelengths.to_srgb(wavelength_set, absorption.of(wavelength_set) * white.of(wavelength_set))
            })
            .sum::<DVec3>()
            / sets as f64;
        assert!((seen - bands).length() < 2e-2 * bands.max_element(), "{seen} {bands}");
    }
}
