//! Facts about rough glass: furnaces from both sides, facets of every kind, agreement with what is known of smooth ones.

use super::interface_losses::InterfaceLosses;
use super::lobe::Lobe;
use super::lobes::AnyLobe;
use super::{BsdfBuilder, InterfaceIndices, Interreflection, ShadingContext};
use crate::color::{Channels, WavelengthSets};
use crate::illumination::distribution::{FacetForm, FacetTable, RoughFacets, SlopeDistribution};
use crate::illumination::material::{MaterialKind, RefractiveIndex, Transparent};
use crate::numeric::cubature::unit_square;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::convert::Infallible;
use std::f64::consts::PI;

/// Samples of a furnace.
const SAMPLES: u32 = 1 << 15;

fn glass(index: f64, roughness: f64, facets: FacetForm) -> AnyLobe {
    let clear = Transparent::clear(RefractiveIndex::Constant(index));
    let material = MaterialKind::Transparent(Transparent { roughness: roughness.into(), facets, ..clear }).into();
    let bsdf = BsdfBuilder::new(&WavelengthSets::bands(), false).bsdf(&material, Interreflection::Followed);
    bsdf.expect("a material").lobes().next().expect("a lobe").clone()
}

fn model(name: &str) -> FacetForm {
    FacetForm::Model(name.into())
}

fn context(degrees: f64, before: f64, behind: f64) -> ShadingContext<'static> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let side =
        InterfaceIndices { before: Channels::splat(before), behind: Channels::splat(behind), inside: before > behind };
    ShadingContext { view: DVec3::new(sin, 0.0, cos), wavelength_set: 0, indices: side, lane: 0, texture_values: &[] }
}

/// The light of an even sky on both sides that is reflected to a viewer, and that comes through: radiance over the square
/// of the index.
fn furnace(lobe: &AnyLobe, context: &ShadingContext) -> [f64; 2] {
    let gained = (context.indices.behind.0[0] / context.indices.before.0[0]).powi(2);
    let mut sums = [0.0; 2];
    for index in 0..SAMPLES {
        // The golden section of the cube.
        let [choice, x, y] = [0.549_700_477_901_970_3, 0.819_172_513_396_164_5, 0.671_043_606_703_789_3]
            .map(|ratio| (0.5 + ratio * f64::from(index)).fract());
        let Some(sample) = lobe.sample(context, choice, [x, y]) else { continue };
        let pdf = lobe.pdf(context, sample.light);
        if pdf > 0.0 {
            let weight = lobe.value(context, sample.light).0[0] * sample.light.z.abs() / pdf;
            if sample.light.z > 0.0 { sums[0] += weight } else { sums[1] += weight * gained }
        }
    }
    sums.map(|sum| sum / f64::from(SAMPLES))
}

/// The light of an even sky on both sides that comes to a viewer, by cubature over the directions.
fn integral(lobe: &AnyLobe, context: &ShadingContext) -> f64 {
    let gained = (context.indices.behind.0[0] / context.indices.before.0[0]).powi(2);
    let half = |below: f64| {
        let term = |[x, y]: [f64; 2]| {
            // One half of the directions is the mirror image of the other.
            let (sine, (sin, cos)) = ((1.0 - x).sqrt(), (PI * y).sin_cos());
            PI * lobe.value(context, DVec3::new(sine * cos, sine * sin, below * x.sqrt())).0[0]
        };
        unit_square(term, 1e-4, 100_000).value
    };
    half(1.0) + half(-1.0) * gained
}

#[test]
fn rough_glass_loses_no_light_from_either_side() {
    let cases: Vec<(f64, f64, FacetForm)> = [(1.1, 0.4), (1.5, 0.1), (1.5, 0.5), (1.5, 1.5), (3.0, 1.0)]
        .into_iter()
        .map(|(index, roughness)| (index, roughness, FacetForm::default()))
        .chain([(1.5, 0.6, model("Beckmann, all"))])
        .collect();
    let of = |(index, roughness, facets): &(f64, f64, FacetForm)| {
        let lobe = glass(*index, *roughness, facets.clone());
        for [before, behind] in [[1.0, *index], [*index, 1.0]] {
            for degrees in [20.0, 60.0, 89.0] {
                let all = integral(&lobe, &context(degrees, before, behind));
                assert!((all - 1.0).abs() < 1e-3, "{index} {roughness} from {before} at {degrees}: {all}");
            }
        }
    };
    cases.par_iter().for_each(of);
}

#[test]
fn smooth_glass_loses_no_light_from_either_side() {
    for index in [1.1, 1.5, 3.0] {
        let lobe = glass(index, 0.0, FacetForm::default());
        for [before, behind] in [[1.0, index], [index, 1.0]] {
            for degrees in [0.0, 20.0, 45.0, 60.0, 89.0] {
                let context = context(degrees, before, behind);
                let gained = (behind / before).powi(2);
                let sent = lobe.specular_samples(&context).into_iter().flatten();
                let all: f64 = sent.map(|sent| sent.weight.0[0] * if sent.light.z < 0.0 { gained } else { 1.0 }).sum();
                assert!((all - 1.0).abs() < 1e-12, "{index} from {before} at {degrees}: {all}");
            }
        }
    }
}

#[test]
fn what_is_lost_and_where_it_leaves_are_those_of_random_walks() {
    // Of 200,000 walks on a surface of GGX (Heitz, Hanika, d'Eon and Dachsbacher 2016), light from all around: roughness,
    // index; lost from outside and from inside; of that the part that goes through, from outside and from inside.
    for (roughness, index, lost, through) in [
        (0.3, 1.5, [0.0422, 0.1748], [0.924, 0.098]),
        (0.6, 1.1, [0.1422, 0.2613], [0.993, 0.449]),
        (1.0, 1.5, [0.2964, 0.5624], [0.987, 0.232]),
        (1.0, 2.5, [0.3536, 0.6063], [0.947, 0.090]),
    ] {
        let facets = RoughFacets::Slopes(SlopeDistribution::Ggx, DVec2::splat(roughness));
        let losses = InterfaceLosses::new(facets, true);
        losses.prepare([index]);
        let [outside, inside] = [losses.between(1.0, index), losses.between(index, 1.0)];
        for (found, expected) in [outside.mean(), inside.mean()].into_iter().zip(lost) {
            assert!((found - expected).abs() < 2.5e-3, "{roughness} {index}: {found} {expected}");
        }
        let found = [outside.part_through(&inside, index), inside.part_through(&outside, 1.0 / index)];
        for (found, expected) in found.into_iter().zip(through) {
            assert!((found - expected).abs() < 0.03, "{roughness} {index}: {found} {expected}");
        }
    }
}

#[test]
fn single_scattering_loses_what_is_known_and_never_gains() {
    for (name, roughness, expected) in [("GGX", 0.5, 0.753), ("Beckmann", 1.0, 0.543)] {
        let [reflected, through] = furnace(&glass(1.5, roughness, model(name)), &context(0.0, 1.5, 1.0));
        assert!((reflected + through - expected).abs() < 3e-3, "{name}: {reflected} {through}");
    }
}

#[test]
fn values_are_those_of_mitsuba_where_facets_send_nothing_on() {
    let lights = [[-0.5, 0.1, 0.8], [0.3, 0.3, 0.6], [-0.3, 0.1, -0.9], [-0.6, 0.0, -0.5]];
    // Of roughdielectric in Mitsuba 3.9 with alpha 0.3: from outside, and from inside.
    for (name, expected) in [
        (
            "GGX, separable",
            [[0.047311985, 0.0035212695, 2.4883295, 0.074348837], [0.071711028, 0.0035357048, 0.288108, 18.7968425]],
        ),
        (
            "Beckmann, separable",
            [[0.050191078, 0.0014573172, 3.7029844, 0.0], [0.076074899, 0.0014632915, 3.0033855e-9, 19.94261]],
        ),
    ] {
        let lobe = glass(1.5, 0.3, model(name));
        for ([before, behind], expected) in [[1.0, 1.5], [1.5, 1.0]].into_iter().zip(expected) {
            let view = DVec3::new(0.5, 0.0, 0.8).normalize();
            let context = ShadingContext { view, ..context(0.0, before, behind) };
            for (light, expected) in lights.into_iter().zip(expected) {
                let value = lobe.value(&context, DVec3::from_array(light).normalize()).0[0];
                assert!((value - expected).abs() < 2e-4 * expected + 1e-8, "{name} from {before} {light:?}: {value}");
            }
        }
    }
}

#[test]
fn facets_of_the_users_are_those_of_the_formula_they_follow() {
    let m = 0.4;
    let area = |angle: f64| Ok::<_, Infallible>((angle.cos().powi(2) + (angle.sin() / m).powi(2)).powi(-2));
    let table = glass(1.5, 0.0, FacetForm::Table(FacetTable::new("typed", area).expect("a table")));
    let known = glass(1.5, m, FacetForm::default());
    for [before, behind] in [[1.0, 1.5], [1.5, 1.0]] {
        let context = context(35.0, before, behind);
        for light in [[-0.5, 0.1, 0.8], [0.3, 0.3, 0.6], [-0.3, 0.1, -0.9], [-0.6, 0.0, -0.5]] {
            let light = DVec3::from_array(light).normalize();
            let [a, b] = [&table, &known].map(|lobe| lobe.value(&context, light).0[0]);
            assert!((a - b).abs() < 3e-3 * b.max(0.05), "from {before} {light}: {a} {b}");
        }
        let all = integral(&table, &context);
        assert!((all - 1.0).abs() < 3e-3, "from {before}: {all}");
    }
}

#[test]
fn glass_of_little_roughness_divides_light_as_smooth_glass_does() {
    for [before, behind] in [[1.0, 1.5], [1.5, 1.0]] {
        for degrees in [0.0, 30.0, 60.0] {
            let context = context(degrees, before, behind);
            let [reflected, _] = furnace(&glass(1.5, 1e-3, FacetForm::default()), &context);
            let smooth = super::dielectric::reflected(&context, context.view.z).0[0];
            assert!((reflected - smooth).abs() < 2e-3, "from {before} at {degrees}: {reflected} {smooth}");
        }
    }
}
