//! Facts of patterns, paints and reliefs.

use super::*;
use std::f64::consts::TAU;

fn pattern(motif: Motif, laying: TextureMapping) -> Pattern {
    Pattern { motif, laying, paints: vec![Paint::grey(0.0), Paint::grey(1.0)] }
}

fn solid() -> TextureMapping {
    TextureMapping { solid: true, ..TextureMapping::default() }
}

/// A footprint on the plane z = 0 whose parameters are its coordinates, of another instance at each x of a unit.
fn on_plane(at: DVec2, width: f64) -> TextureFootprint {
    let side = |way: DVec2| FootprintSide { scene: way.extend(0.0), uv: way, own: way.extend(0.0) };
    let sides = [side(DVec2::X * width), side(DVec2::Y * width)];
    let variation = (at.x.rem_euclid(1.0) * 65_536.0) as u16;
    TextureFootprint { uv: at, own: at.extend(0.0), sides, along: [DVec3::X, DVec3::Y], variation }
}

fn points(count: u32) -> impl Iterator<Item = DVec2> {
    (0..count).map(|i| DVec2::new(f64::from(i) * 0.754_877, f64::from(i) * 0.569_84) % 23.0)
}

#[test]
fn every_pattern_of_paints_is_tried() {
    let tried: Vec<&str> = Motif::TRIED.iter().map(Motif::word).collect();
    assert_eq!(tried, Motif::WORDS.iter().copied().filter(|word| *word != "image").collect::<Vec<_>>());
}

#[test]
fn parts_are_fractions_that_add_up_to_one() {
    for motif in Motif::TRIED {
        let pattern = pattern(motif.clone(), solid());
        for at in points(2_000) {
            for width in [0.0, 1e-3, 0.3, 1.0, 50.0, 1e300] {
                let [a, b, c] = pattern.parts(&on_plane(at, width));
                assert!((0.0..=1.0).contains(&b) && (a + b - 1.0).abs() < 1e-12 && c == 0.0, "{:?}", pattern.motif);
            }
        }
    }
}

#[test]
fn the_mean_over_many_periods_is_the_mean_of_the_pattern() {
    for motif in Motif::TRIED {
        let mean = motif.mean()[1];
        let pattern = pattern(motif.clone(), solid());
        let fine = points(40_000).map(|at| pattern.parts(&on_plane(at, 0.0))[1]).sum::<f64>() / 40_000.0;
        let coarse = pattern.parts(&on_plane(DVec2::new(3.5, 0.2), 1e4))[1];
        assert!((fine - mean).abs() < 0.03, "{:?} {fine} {mean}", pattern.motif);
        assert!((coarse - mean).abs() < 0.01, "{:?} {coarse} {mean}", pattern.motif);
    }
}

#[test]
fn the_mean_of_a_checker_is_exact() {
    let checker =
        pattern(Motif::Checker, TextureMapping { size: DVec3::new(0.5, 0.25, 1.0), ..TextureMapping::default() });
    for at in points(50) {
        let width = 0.07;
        let steps = 400;
        let mut sum = 0.0;
        for i in 0..steps {
            for j in 0..steps {
                let aside = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) / f64::from(steps) - 0.5;
                sum += checker.parts(&TextureFootprint::point(at + aside * width, DVec3::ZERO))[1];
            }
        }
        let found = checker.parts(&on_plane(at, width))[1];
        assert!((found - sum / f64::from(steps * steps)).abs() < 5e-3, "{at}");
    }
}

#[test]
fn a_pattern_lies_where_it_is_laid() {
    let laying = TextureMapping {
        size: DVec3::splat(2.0),
        at: DVec3::new(0.3, 0.1, 0.0),
        up: DVec3::X,
        ..TextureMapping::default()
    };
    let image = Image::new("quarters".into(), 64, 64, |x, y| DVec3::new(f64::from(x / 32), f64::from(y / 32), 0.0));
    let pattern = Pattern { motif: Motif::Image { image }, laying, paints: Vec::new() };
    // The image stands with its upper edge towards +u: what is to its right is towards -v.
    let at = |uv: DVec2| pattern.parts(&TextureFootprint::point(uv, DVec3::ZERO));
    let begin = DVec2::new(0.3, 0.1);
    assert_eq!(at(begin + DVec2::new(0.5, -0.5)), [0.0, 1.0, 0.0], "lower left quarter");
    assert_eq!(at(begin + DVec2::new(1.5, -0.5)), [0.0, 0.0, 0.0], "upper left quarter");
    assert_eq!(at(begin + DVec2::new(0.5, -1.5)), [1.0, 1.0, 0.0], "lower right quarter");
}

#[test]
fn a_solid_pattern_knows_no_parameters() {
    let paint = |laying| Paint::Pattern(Box::new(pattern(Motif::Checker, laying)));
    assert!(!paint(solid()).needs_parameters() && paint(TextureMapping::default()).needs_parameters());
    let inner = paint(TextureMapping::default());
    let outer = Pattern { paints: vec![inner, Paint::grey(0.5)], ..pattern(Motif::Checker, solid()) };
    assert!(Paint::Pattern(Box::new(outer)).needs_parameters());
}

#[test]
fn bumps_tilt_the_normal_by_their_slope() {
    // A wave of known slope: marble without turbulence is (1 + sin(2 pi x))/2.
    let motif = Motif::Marble { turbulence: 0.0, sharpness: 1.0 };
    for laying in [solid(), TextureMapping::default()] {
        let relief = Relief::Bumps { pattern: pattern(motif.clone(), laying), height: 0.1 };
        for at in points(100) {
            let slope = 0.1 * 0.5 * TAU * (TAU * at.x).cos();
            let expected = DVec3::new(-slope, 0.0, 1.0).normalize();
            let found = relief.normal(&on_plane(at, 1e-3), DVec3::Z);
            assert!((found - expected).length() < 1e-4, "{at} {found} {expected}");
        }
        // So far away that it is flat; and without any extent, too.
        assert!((relief.normal(&on_plane(DVec2::ONE, 100.0), DVec3::Z) - DVec3::Z).length() < 1e-3);
        assert_eq!(relief.normal(&TextureFootprint::point(DVec2::ONE, DVec3::ONE), DVec3::Z), DVec3::Z);
    }
}

#[test]
fn an_image_of_normals_tilts_along_the_parameters() {
    let image = Image::new("tilted".into(), 1, 1, |_, _| DVec3::new(0.8, 0.5, 0.9));
    let relief = Relief::Normals { image, laying: TextureMapping::default() };
    let found = relief.normal(&on_plane(DVec2::splat(0.2), 0.1), DVec3::Z);
    assert!((found - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-4, "{found}");
}

#[test]
fn impossible_textures_are_refused_in_words() {
    let wrong = |motif: Motif, laying: TextureMapping| pattern(motif, laying).check().map_err(|e| e.to_string());
    let small = TextureMapping { size: DVec3::new(1.0, 0.0, 1.0), ..TextureMapping::default() };
    assert_eq!(wrong(Motif::Checker, small).unwrap_err(), "size 0 of a pattern is not above 0 and finite");
    assert!(wrong(Motif::Noise { octaves: 17 }, solid()).is_err());
    assert!(wrong(Motif::Marble { turbulence: -1.0, sharpness: 1.0 }, solid()).is_err());
    assert!(wrong(Motif::Wood { turbulence: 0.1, grain: f64::NAN }, solid()).is_err());
    assert!(
        wrong(Motif::Checker, TextureMapping { up: DVec3::Z, ..TextureMapping::default() }).is_err(),
        "up is not on the surface"
    );
    let mut paint = Paint::grey(0.5);
    for _ in 0..=MAX_NESTING {
        paint = Paint::Pattern(Box::new(Pattern {
            paints: vec![paint, Paint::grey(0.1)],
            ..pattern(Motif::Checker, solid())
        }));
    }
    assert_eq!(paint.check(), Err(TextureError::Nesting));
}

#[test]
fn the_mean_color_of_patterns_of_patterns_is_that_of_their_parts() {
    let grey = |a, b| Pattern { paints: vec![Paint::grey(a), Paint::grey(b)], ..pattern(Motif::Checker, solid()) };
    let inner = Paint::Pattern(Box::new(grey(0.2, 0.4)));
    let outer = Pattern { paints: vec![inner, Paint::grey(0.7)], ..grey(0.0, 0.0) };
    assert!((Paint::Pattern(Box::new(outer)).mean_bands() - DVec3::splat(0.5)).length() < 1e-12);
}
