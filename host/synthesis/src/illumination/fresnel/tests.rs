//! Facts about Fresnel's equations, and values computed with 50 digits.

use super::*;
use crate::color::shipped;
use glam::DVec3;

/// Index outside, index inside, cosine of incidence, reflectances perpendicular and parallel; by mpmath 1.3, 50 digits.
const DIELECTRICS: [[f64; 5]; 24] = [
    [1.0, 1.5, 1.0, 0.04, 0.04],
    [1.0, 1.5, 0.5548444274479993, 0.1478606312234595, 1.0880305492451494e-08],
    [1.0, 1.5, 0.0174524064372836, 0.9394721612950072, 0.8688977382653701],
    [1.0, 1.5, 1.7453292520723307e-06, 0.9999937557397343, 0.9999859504692329],
    [1.5, 1.0, 1.0, 0.04, 0.04],
    [1.5, 1.0, 0.5548444274479993, 1.0, 1.0],
    [1.5, 1.0, 0.0174524064372836, 1.0, 1.0],
    [1.5, 1.0, 1.7453292520723307e-06, 1.0, 1.0],
    [1.0, 1.000000001, 1.0, 2.5000004112018716e-19, 2.5000004112018716e-19],
    [1.0, 1.000000001, 0.5548444274479993, 2.637880781733723e-18, 3.8956986775272504e-19],
    [1.0, 1.000000001, 0.0174524064372836, 2.694734332656789e-12, 2.691452203188977e-12],
    [1.0, 1.000000001, 1.7453292520723307e-06, 0.8555015385336219, 0.855501538266319],
    [1.0, 0.999999999, 1.0, 2.4999998610903443e-19, 2.4999998610903443e-19],
    [1.0, 0.999999999, 0.5548444274479993, 2.637880225005465e-18, 3.8956979114666417e-19],
    [1.0, 0.999999999, 0.0174524064372836, 2.694769117898706e-12, 2.691486967601663e-12],
    [1.0, 0.999999999, 1.7453292520723307e-06, 1.0, 1.0],
    [1.0, 1000.0, 1.0, 0.99600798801598, 0.99600798801598],
    [1.0, 1000.0, 0.5548444274479993, 0.9977830822943444, 0.9928166908439963],
    [1.0, 1000.0, 0.0174524064372836, 0.9999301927759873, 0.7949739275131081],
    [1.0, 1000.0, 1.7453292520723307e-06, 0.9999999930186795, 0.9930429852681291],
    [1000.0, 1.0, 1.0, 0.99600798801598, 0.99600798801598],
    [1000.0, 1.0, 0.5548444274479993, 1.0, 1.0],
    [1000.0, 1.0, 0.0174524064372836, 1.0, 1.0],
    [1000.0, 1.0, 1.7453292520723307e-06, 1.0, 1.0],
];

/// n, k, cosine of incidence, reflectances perpendicular and parallel; by mpmath 1.3, 50 digits.
const CONDUCTORS: [[f64; 5]; 24] = [
    [0.3, 3.205, 1.0, 0.8996825370286385, 0.8996825370286385],
    [0.3, 3.205, 0.5548444274479993, 0.9447770522024079, 0.8420074601388507],
    [0.3, 3.205, 0.0174524064372836, 0.9982388753362473, 0.9785336209057679],
    [0.3, 3.205, 1.7453292520723307e-06, 0.9999998237256827, 0.9999978236891903],
    [0.05, 4.483, 1.0, 0.9905659438402901, 0.9905659438402901],
    [0.05, 4.483, 0.5548444274479993, 0.9948423322093412, 0.9839819367346302],
    [0.05, 4.483, 0.0174524064372836, 0.9998385504699434, 0.9964587673258369],
    [0.05, 4.483, 1.7453292520723307e-06, 0.9999999838530405, 0.9999996431594881],
    [1.366, 7.4052, 1.0, 0.9095887292160837, 0.9095887292160837],
    [1.366, 7.4052, 0.5548444274479993, 0.9490687322268438, 0.8458505306455381],
    [1.366, 7.4052, 0.0174524064372836, 0.9983612902382862, 0.9097065097938514],
    [1.366, 7.4052, 1.7453292520723307e-06, 0.9999998359867102, 0.9999903825960842],
    [0.999999999, 1e-09, 1.0, 4.999999863590345e-19, 4.999999863590345e-19],
    [0.999999999, 1e-09, 0.5548444274479993, 5.2757605992196314e-18, 7.791396043289016e-19],
    [0.999999999, 1e-09, 0.0174524064372836, 5.389538388136846e-12, 5.382974087357179e-12],
    [0.999999999, 1e-09, 1.7453292520723307e-06, 0.9509854056656735, 0.9509854055304795],
    [1000.0, 1000.0, 1.0, 0.9980019990000005, 0.9980019990000005],
    [1000.0, 1000.0, 0.5548444274479993, 0.9988909268707755, 0.9964018761289526],
    [1000.0, 1000.0, 0.0174524064372836, 0.9999650958050164, 0.8917810488511289],
    [1000.0, 1000.0, 1.7453292520723307e-06, 0.9999999965093423, 0.9930430081197417],
    [1.5, 1e-06, 1.0, 0.0400000000001536, 0.0400000000001536],
    [1.5, 1e-06, 0.5548444274479993, 0.14786063122388482, 1.0880339787457852e-08],
    [1.5, 1e-06, 0.0174524064372836, 0.9394721612951105, 0.8688977382654439],
    [1.5, 1e-06, 1.7453292520723307e-06, 0.9999937557397343, 0.9999859504692329],
];

/// Cosines from normal incidence to 89.9999 degrees.
fn cosines() -> impl Iterator<Item = f64> {
    (0..=90).map(|degrees| f64::from(degrees).min(89.9999).to_radians().cos())
}

/// Ratios of indices, extreme ones too.
const RATIOS: [f64; 9] = [1.5, 1.0 / 1.5, 2.42, 1.0 + 1e-9, 1.0 - 1e-9, 1.0 + 1e-15, 1e3, 1e-3, 1.0];

fn glass() -> Dielectric {
    Dielectric::new(1.0, 1.5).expect("an index")
}

fn near(found: Polarised, perpendicular: f64, parallel: f64, tolerance: f64) -> bool {
    (found.perpendicular / perpendicular - 1.0).abs() < tolerance && (found.parallel / parallel - 1.0).abs() < tolerance
}

#[test]
fn reflectances_agree_with_fifty_digits() {
    for [outside, inside, cosine, perpendicular, parallel] in DIELECTRICS {
        let interface = Dielectric::new(outside, inside).expect("an index");
        // Beside Brewster's angle the parallel part is 1e-8, with a conditioning of 1e4.
        assert!(near(interface.reflectance(cosine), perpendicular, parallel, 1e-11), "{outside} {inside} {cosine}");
    }
    for [n, k, cosine, perpendicular, parallel] in CONDUCTORS {
        let found = Conductor::new(1.0, n, k).expect("an index").reflectance(cosine);
        assert!(near(found, perpendicular, parallel, 1e-11), "{n} {k} {cosine}: {found:?}");
    }
}

#[test]
fn what_is_not_reflected_goes_through() {
    for ratio in RATIOS {
        let dielectric = Dielectric::new(1.0, ratio).expect("an index");
        for k in [0.0, 1e-9, 1.0, 1e3] {
            let conductor = Conductor::new(1.0, ratio, k).expect("an index");
            for cosine in cosines() {
                let parts = [
                    (dielectric.reflectance(cosine), dielectric.transmittance(cosine)),
                    (conductor.reflectance(cosine), conductor.absorptance(cosine)),
                ];
                for (r, t) in parts {
                    for part in [r.perpendicular, r.parallel, t.perpendicular, t.parallel] {
                        assert!((0.0..=1.0 + 1e-12).contains(&part), "{ratio} {k} {cosine}: {part}");
                    }
                    assert!((r.perpendicular + t.perpendicular - 1.0).abs() < 1e-12, "{ratio} {k} {cosine}");
                    assert!((r.parallel + t.parallel - 1.0).abs() < 1e-12, "{ratio} {k} {cosine}");
                }
            }
        }
    }
}

#[test]
fn a_conductor_that_does_not_absorb_is_a_dielectric() {
    for (ratio, cosine) in RATIOS.into_iter().flat_map(|ratio| cosines().map(move |cosine| (ratio, cosine))) {
        let one = Dielectric::new(1.0, ratio).expect("an index").reflectance(cosine);
        let other = Conductor::new(1.0, ratio, 0.0).expect("an index").reflectance(cosine);
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * one.perpendicular;
        assert!(
            close(one.perpendicular, other.perpendicular) && close(one.parallel, other.parallel),
            "{ratio} {cosine}"
        );
    }
}

#[test]
fn refraction_follows_snell_and_is_the_same_on_the_way_back() {
    for (ratio, cosine) in RATIOS.into_iter().flat_map(|ratio| cosines().map(move |cosine| (ratio, cosine))) {
        let interface = Dielectric::new(1.0, ratio).expect("an index");
        let sine = (1.0 - cosine * cosine).sqrt();
        let towards = DVec3::new(sine, cosine, 0.0);
        let Some(refracted) = interface.refracted(towards, DVec3::Y) else {
            assert!(sine > ratio - 1e-15 && interface.reflectance(cosine).mean() == 1.0);
            continue;
        };
        assert!((sine - ratio * -refracted.x).abs() < 1e-14 && refracted.y <= 0.0, "{ratio} {cosine}: {refracted}");
        assert!((refracted.length() - 1.0).abs() < 1e-15);
        let (forth, back) = (interface.transmittance(cosine), interface.inverted().transmittance(-refracted.y));
        // The cosine of a direction near the normal has no digits for its sine: at 1000 to 1 they are missed.
        let tolerance = if (0.1..10.0).contains(&ratio) { 1e-8 } else { 1e-2 };
        let differences = [forth.perpendicular - back.perpendicular, forth.parallel - back.parallel];
        assert!(differences.iter().all(|d| d.abs() < tolerance), "{ratio} {cosine}: {differences:?}");
        if let Some(again) = interface.inverted().refracted(-refracted, DVec3::Y)
            && -refracted.y > 1e-3
        {
            assert!((again + towards).length() < 1e-9, "{ratio} {cosine}: {again} {towards}");
        }
    }
}

#[test]
fn nothing_is_reflected_in_the_plane_of_incidence_at_brewsters_angle() {
    for ratio in [1.5, 1.0 / 1.5, 2.42] {
        let cosine = f64::atan(ratio).cos();
        let found = Dielectric::new(1.0, ratio).expect("an index").reflectance(cosine);
        assert!(found.parallel < 1e-30 && found.perpendicular > 0.1);
    }
}

#[test]
fn normal_incidence_and_the_critical_angle_have_their_closed_forms() {
    let square = |x: f64| x * x;
    assert!((glass().reflectance(1.0).mean() - square(0.5 / 2.5)).abs() < 1e-16);
    let inside = glass().inverted();
    let critical = f64::asin(1.0 / 1.5);
    assert_eq!(inside.reflectance((critical + 1e-6).cos()).mean(), 1.0);
    assert!(inside.reflectance((critical - 1e-6).cos()).mean() < 0.999);
    assert!(inside.refracted(DVec3::new(0.8, 0.6, 0.0), DVec3::Y).is_none());
}

#[test]
fn copper_reflects_red_more_than_blue() {
    let copper = shipped::metal("copper").expect("a metal");
    let at = |w| Conductor::of_metal(&copper, w).expect("an index").reflectance(1.0).mean();
    assert!(at(650.0) > 0.9 && at(450.0) < 0.6);
}

#[test]
fn impossible_indices_are_errors_and_odd_cosines_are_not() {
    for n in [0.0, -1.5, f64::NAN, f64::INFINITY, 1e7] {
        assert!(Dielectric::new(1.0, n).is_err() && Dielectric::new(n, 1.0).is_err());
    }
    assert!(Conductor::new(1.0, 0.0, 0.0).is_err() && Conductor::new(1.0, 1.0, -1.0).is_err());
    assert!(Conductor::new(1.0, 0.0, 3.0).is_ok_and(|mirror| (mirror.reflectance(0.5).mean() - 1.0).abs() < 1e-15));
    for cosine in [f64::NAN, -1.0, 2.0, f64::INFINITY] {
        assert!((0.0..=1.0).contains(&glass().reflectance(cosine).mean()));
    }
}
