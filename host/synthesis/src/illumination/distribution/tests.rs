//! Facts about the whole family of distributions, and what each member must have to itself.

use super::measure::{check, emitted_share, light_at, received_share, reciprocity_residual};
use super::*;
use crate::numeric::sampling::{RandomStream, r2_point};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const ROUGHNESS: [f64; 6] = [1e-6, 1e-2, 0.1, 0.5, 1.0, 10.0];
const INCIDENCE: [f64; 5] = [0.0, 30.0, 60.0, 85.0, 89.9999];

fn light(degrees: f64) -> DVec3 {
    light_at(degrees.to_radians())
}

fn row(name: &str, roughness: f64) -> Box<dyn Distribution> {
    (FAMILY.iter().find(|row| row.name == name).expect("a known row").make)(roughness).expect("a distribution")
}

fn share(distribution: &dyn Distribution, degrees: f64) -> f64 {
    emitted_share(distribution, light(degrees), 1e-5, 20_000).value
}

/// The integral of a function of the viewer over the hemisphere by the midpoint rule, with no help of a sample.
fn hemisphere(steps: u32, mut f: impl FnMut(DVec3) -> f64) -> f64 {
    let (d_theta, d_phi) = (FRAC_PI_2 / f64::from(steps), TAU / f64::from(2 * steps));
    let mut sum = 0.0;
    for i in 0..steps {
        let (sin, cos) = ((f64::from(i) + 0.5) * d_theta).sin_cos();
        for j in 0..2 * steps {
            let (sin_phi, cos_phi) = ((f64::from(j) + 0.5) * d_phi).sin_cos();
            sum += f(DVec3::new(sin * cos_phi, sin * sin_phi, cos)) * sin;
        }
    }
    sum * d_theta * d_phi
}

#[test]
fn every_density_is_finite_and_not_negative_at_every_roughness() {
    for member in FAMILY {
        for roughness in [1e-6, 0.1, 10.0] {
            let made = (member.make)(roughness).expect("a distribution");
            check(made.as_ref(), 4000, 7).unwrap_or_else(|error| panic!("{roughness}: {error}"));
            assert_eq!(made.name().is_empty(), member.name.is_empty());
        }
    }
}

#[test]
fn a_sampled_integral_is_that_of_the_midpoint_rule() {
    for member in FAMILY {
        let made = (member.make)(0.5).expect("a distribution");
        for degrees in [0.0, 50.0] {
            let light = light(degrees);
            let plain = hemisphere(300, |view| made.density(light, view));
            let sampled = share(made.as_ref(), degrees);
            assert!((plain / sampled - 1.0).abs() < 1e-3, "{} {degrees}: {plain} {sampled}", member.name);
        }
    }
}

#[test]
fn samples_follow_their_pdf() {
    const COUNT: u32 = 40_000;
    // Rings and sectors of about the same projected area.
    let cell = |view: DVec3| {
        let ring = ((1.0 - view.z * view.z) * 6.0) as usize;
        let sector = (view.y.atan2(view.x).rem_euclid(TAU) / TAU * 8.0) as usize;
        ring.min(5) * 8 + sector.min(7)
    };
    for member in FAMILY {
        let made = (member.make)(0.5).expect("a distribution");
        let light = light(40.0);
        let mut expected = [0.0; 48];
        let steps = 240;
        hemisphere(steps, |view| {
            let area = FRAC_PI_2 / f64::from(steps) * PI / f64::from(steps) * (1.0 - view.z * view.z).sqrt();
            expected[cell(view)] += made.pdf(light, view) * area;
            0.0
        });
        let mut found = [0.0; 48];
        let mut stream = RandomStream::new(3, 0);
        for _ in 0..COUNT {
            if let Some(view) = made.sample(light, stream.point()) {
                assert!((view.length() - 1.0).abs() < 1e-9 && view.z > 0.0);
                found[cell(view)] += 1.0;
            }
        }
        let term = |(e, f): (&f64, &f64)| {
            let e = e * f64::from(COUNT);
            if e < 5.0 { (f - e).abs() / 5.0 } else { (f - e).powi(2) / e }
        };
        let chi: f64 = expected.iter().zip(&found).map(term).sum();
        // 48 degrees of freedom: the mean is 48, and 100 is exceeded once in a hundred thousand.
        assert!(chi < 100.0, "{}: {chi}", member.name);
    }
}

#[test]
fn samples_are_the_same_for_the_same_point() {
    for member in FAMILY {
        let made = (member.make)(0.2).expect("a distribution");
        for index in 0..50 {
            let point = r2_point(index, [0.25, 0.75]);
            assert_eq!(made.sample(light(30.0), point), made.sample(light(30.0), point));
        }
    }
}

#[test]
fn lambert_phong_and_blinn_are_normalised_at_normal_incidence() {
    for degrees in INCIDENCE {
        assert!((share(&Lambert, degrees) - 1.0).abs() < 1e-12);
    }
    for roughness in [1e-6, 0.1, 0.5, 1.0] {
        for name in ["Phong", "Blinn"] {
            let found = share(row(name, roughness).as_ref(), 0.0);
            assert!((found - 1.0).abs() < 1e-4, "{name} {roughness}: {found}");
        }
    }
}

#[test]
fn phongs_lobe_is_highest_in_the_mirror_direction_and_half_at_its_half_angle() {
    let phong = Phong::new(20.0).expect("an exponent");
    let (light, half) = (light(0.0), 0.5f64.powf(1.0 / 20.0).acos());
    assert!((phong.density(light, DVec3::Z) - 22.0 / TAU).abs() < 1e-12);
    let ratio = phong.density(light, light_at(half)) / half.cos() / phong.density(light, DVec3::Z);
    assert!((ratio - 0.5).abs() < 1e-12);
    assert_eq!(phong.density(light_at(1.0), light_at(1.3)), 0.0);
    assert!(Phong::new(f64::NAN).is_err() && Blinn::new(-1.0).is_err());
}

#[test]
fn smooth_facets_give_the_published_forms_their_known_excess() {
    // The change of the solid angle is forgotten: 4 (V·H), and with the division by N·L 4.
    for degrees in [0.0, 30.0, 60.0, 80.0] {
        let cosine = f64::cos(f64::to_radians(degrees));
        assert!((share(&CookTorrance::new(1e-4).expect("a roughness"), degrees) - 4.0).abs() < 1e-4);
        assert!((share(&ImprovedCookTorrance::new(1e-4).expect("a roughness"), degrees) - 4.0 * cosine).abs() < 1e-4);
        let exact = row("Beckmann", 1e-4);
        assert!((share(exact.as_ref(), degrees) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn formula_7_integrates_to_1_over_the_normals() {
    // ∫ D(α) dω_H with α from 0 to 90 degrees; D depends on the half vector alone.
    for roughness in [0.1, 0.5, 1.0] {
        let improved = ImprovedCookTorrance::new(roughness).expect("a roughness");
        let over_normals = hemisphere(400, |half| improved.density(half, half));
        assert!((over_normals - 1.0).abs() < 5e-4, "{roughness}: {over_normals}");
    }
}

#[test]
fn exact_forms_never_create_energy_and_are_reciprocal() {
    for (name, roughness) in
        ["Beckmann", "GGX", "anisotropic"].into_iter().flat_map(|name| ROUGHNESS.map(|roughness| (name, roughness)))
    {
        let made = row(name, roughness);
        assert!(reciprocity_residual(made.as_ref(), 1000, 5) < 1e-12, "{name} {roughness}");
        for degrees in INCIDENCE {
            let found = share(made.as_ref(), degrees);
            assert!(found > 0.0 && found < 1.0 + 1e-9, "{name} {roughness} {degrees}: {found}");
        }
    }
    assert!(reciprocity_residual(&ImprovedCookTorrance::new(0.3).expect("a roughness"), 1000, 5) > 0.1);
    assert!(reciprocity_residual(&CookTorrance::new(0.3).expect("a roughness"), 1000, 5) < 1e-12);
}

#[test]
fn ggx_at_normal_incidence_has_its_closed_form() {
    // Roughness 1: the integral over cosines c of the normals with c² > 1/2 gives 1 − ln 2.
    let found = share(row("GGX", 1.0).as_ref(), 0.0);
    assert!((found - (1.0 - 2f64.ln())).abs() < 1e-5, "{found}");
}

#[test]
fn compensated_forms_conserve_energy_to_a_ten_thousandth_and_never_create_it() {
    for (facets, roughness) in [SlopeDistribution::Beckmann, SlopeDistribution::Ggx]
        .into_iter()
        .flat_map(|f| [1e-6, 1e-2, 0.2, 1.0].map(|m| (f, m)))
    {
        let made = Compensated::new(facets, roughness).expect("a roughness");
        let first = Microfacet::new(facets, DVec2::splat(roughness)).expect("a roughness");
        for degrees in [0.0, 30.0, 60.0, 80.0, 89.0, 89.9, 89.9999] {
            let light = light(degrees);
            let once = emitted_share(&first, light, 3e-6, 120_000);
            let sum = once.value + made.lost(light.z);
            assert!(sum < 1.0 + 1e-5 && sum > 1.0 - 1e-4, "{facets:?} {roughness} {degrees}: {sum}");
        }
        // The second term emits what was lost: its integral by midpoints over the cosine.
        let cells = 20_000;
        let cosines = (0..cells).map(|i| (f64::from(i) + 0.5) / f64::from(cells));
        let again: f64 = cosines.map(|c| made.lost(c) * c * 2.0 / f64::from(cells)).sum();
        assert!((again - made.mean_lost()).abs() < 2e-6 + 1e-3 * again, "{facets:?} {roughness}");
        assert!(reciprocity_residual(&made, 1000, 5) < 1e-12);
    }
}

#[test]
fn a_function_of_ones_own_is_tabulated_with_a_stated_error() {
    let lobe = |light: DVec3, view: DVec3| 0.3 * view.z + mirrored(light).dot(view).max(0.0).powi(8) * view.z;
    let [coarse, fine] = [16, 48].map(|steps| Tabulated::new("my own", steps, lobe).expect("a table"));
    let [c, f] = [coarse.accuracy(), fine.accuracy()];
    assert!(f.rms < 0.01 && f.greatest < 0.05 && f.rms < 0.3 * c.rms, "{c:?} {f:?}");
    assert!(f.least_share > 0.9 && f.greatest_share < 2.0, "{f:?}");
    for degrees in [0.0, 30.0, 60.0, 88.0] {
        let found = share(&fine, degrees);
        assert!((found - 1.0).abs() < 2e-3, "{degrees}: {found}");
        let drawn = hemisphere(200, |view| fine.pdf(light(degrees), view));
        assert!((drawn - 1.0).abs() < 5e-3, "{degrees}: {drawn}");
    }
    check(&fine, 2000, 1).expect("a distribution");
}

#[test]
fn a_function_that_is_no_distribution_is_refused_with_its_directions() {
    let negative = Tabulated::new("sine", 8, |_, view| view.x);
    assert!(
        matches!(&negative, Err(DistributionError::Negative { view, value, .. }) if view.x == *value),
        "{negative:?}"
    );
    let infinite = Tabulated::new("pole", 8, |light, _| if light.z < 0.5 { f64::INFINITY } else { 1.0 });
    assert!(matches!(&infinite, Err(DistributionError::NotFinite { light, .. }) if light.z < 0.5));
    assert!(infinite.expect_err("infinite").to_string().starts_with("pole is not finite for light from ["));
    assert!(matches!(Tabulated::new("dark", 8, |_, _| 0.0), Err(DistributionError::Nothing { .. })));
    assert!(Tabulated::new("huge", 1000, |_, _| 1.0).is_err());
    for roughness in [0.0, -1.0, f64::NAN, 1e4] {
        assert!(FAMILY[1..].iter().all(|row| (row.make)(roughness).is_err()));
    }
}

#[test]
fn a_viewer_sees_of_what_is_not_reciprocal_more_than_is_emitted() {
    let make = |name: &str| {
        let row = FAMILY.iter().find(|row| row.name == name).expect("a member");
        (row.make)(0.8).expect("a roughness that it knows")
    };
    let both = |name: &str| {
        let (distribution, at) = (make(name), light_at(82f64.to_radians()));
        [emitted_share, received_share].map(|share| share(distribution.as_ref(), at, 1e-4, 100_000).value)
    };
    let [emitted, seen] = both("improved (7)");
    assert!((emitted - 0.911).abs() < 2e-3 && (seen - 4.40).abs() < 2e-2, "{emitted} and {seen}");
    for name in ["Lambert", "GGX", "Beckmann"] {
        let [emitted, seen] = both(name);
        assert!((emitted - seen).abs() < 2e-3, "{name}: {emitted} and {seen}");
    }
}
