//! The beam against closed forms, conservation laws and an independent integration.

use super::{
    bins::Bins,
    light::Writing,
    tile::{PLANE, TILE_HEIGHT, TILE_WIDTH},
    track::{Scratch, Track},
    *,
};
use crate::traversal::Stroke;
use processes::widest;

const WHITE: [f32; 3] = [1.0; 3];

fn stroke(start: [f32; 2], end: [f32; 2], intensity: [f32; 2]) -> Stroke {
    Stroke { start, end, intensity, color: WHITE }
}

fn beam(size: u32) -> Beam {
    Beam::new(size, size)
}

/// The light of every pixel, red, green and blue.
fn pixels(light: &ScreenLight) -> Vec<f32> {
    let places = (0..light.height()).flat_map(|y| (0..light.width()).map(move |x| (x, y)));
    places.flat_map(|(x, y)| light.at(x, y).unwrap()).collect()
}

/// A fixed sequence of numbers 0..1.
fn numbers(mut seed: u64) -> impl FnMut() -> f32 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// Strokes of every length, direction and position, in colours.
pub(super) fn jumble(count: usize) -> Vec<Stroke> {
    let mut next = numbers(5);
    let place = |next: &mut dyn FnMut() -> f32| [next() * 2.4 - 1.2, next() * 2.4 - 1.2];
    (0..count)
        .map(|index| {
            let (start, mut end) = (place(&mut next), place(&mut next));
            let shrink = [1.0, 0.1, 0.01, 0.001, 0.0][index % 5];
            end = [0, 1].map(|axis| start[axis] + shrink * (end[axis] - start[axis]));
            Stroke { start, end, intensity: [next(), next()], color: [next(), next(), next()] }
        })
        .collect()
}

/// The largest difference of two screens, over the largest light.
pub(super) fn difference(one: &ScreenLight, other: &ScreenLight) -> f64 {
    let (one, other) = (pixels(one), pixels(other));
    let peak = one.iter().fold(0.0f32, |peak, light| peak.max(*light));
    let pairs = one.iter().zip(&other);
    pairs.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max) / f64::from(peak)
}

#[test]
fn total_light_is_length_times_mean_intensity_at_any_angle_length_size_and_place() {
    let mut next = numbers(1);
    for size in [64, 333, 1024] {
        for case in 0..120 {
            let angle = case as f32 * 0.2618 + if case % 3 == 0 { 0.0 } else { next() };
            let length = [0.9, 0.11, 0.02, 0.004, 0.0004][case % 5];
            let start = [next() * 0.8 - 0.4, next() * 0.8 - 0.4];
            let end = [start[0] + length * angle.cos() * 0.5, start[1] + length * angle.sin() * 0.5];
            let intensity = [next(), next()];
            let sum = draw(&beam(size), &[stroke(start, end, intensity)]).total()[1];
            let (dx, dy) = (f64::from(end[0]) - f64::from(start[0]), f64::from(end[1]) - f64::from(start[1]));
            let expected = dx.hypot(dy) * f64::from(intensity[0] + intensity[1]) / 2.0;
            assert!(
                (sum / expected - 1.0).abs() < 1e-4,
                "size {size}, length {length}, angle {angle}: {sum} {expected}"
            );
        }
    }
}

#[test]
fn a_dot_has_the_light_of_its_dwelling_wherever_it_lies() {
    let mut next = numbers(2);
    for size in [100, 1024] {
        for _ in 0..100 {
            let place = [next() * 1.6 - 0.8, next() * 1.6 - 0.8];
            let sum = draw(&beam(size), &[stroke(place, place, [0.5, 0.5])]).total()[0];
            assert!((sum / (0.5 * f64::from(beam(size).dot_length)) - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn every_pixel_equals_a_numerical_integration_of_the_moving_spot() {
    let mut next = numbers(3);
    for length in [0.0007f32, 0.003, 0.009, 0.013, 0.016, 0.05] {
        for _ in 0..6 {
            let angle = f64::from(next()) * 6.3;
            let start = [next() * 0.01, next() * 0.01];
            let end = [start[0] + length * angle.cos() as f32, start[1] + length * angle.sin() as f32];
            let intensity = [next(), next()];
            let beam = Beam { spot_radius: 0.004, ..beam(512) };
            let light = draw(&beam, &[stroke(start, end, intensity)]);
            let (spot, parts) = (0.004, 2000);
            for (x, y) in (240..272).step_by(3).flat_map(|x| (240..272).step_by(3).map(move |y| (x, y))) {
                let center = [(f64::from(x) + 0.5) / 256.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / 256.0];
                let mut sum = 0.0;
                let span = [0, 1].map(|axis| f64::from(end[axis]) - f64::from(start[axis]));
                for part in 0..parts {
                    let t = (f64::from(part) + 0.5) / f64::from(parts);
                    let place = [0, 1].map(|axis| f64::from(start[axis]) + t * span[axis]);
                    let square = (center[0] - place[0]).powi(2) + (center[1] - place[1]).powi(2);
                    let current = f64::from(intensity[0]) * (1.0 - t) + f64::from(intensity[1]) * t;
                    sum += current * (-square / (2.0 * spot * spot)).exp();
                }
                let exact =
                    sum * span[0].hypot(span[1]) / f64::from(parts) / (2.0 * std::f64::consts::PI).sqrt() / spot;
                let drawn = f64::from(light.at(x, y).unwrap()[0]);
                // The cut of the spot is worth exp(-4.5^2 / 2) = 4e-5 of a line's peak.
                assert!((drawn - exact).abs() < 5e-5, "length {length}, pixel {x} {y}: {drawn} for {exact}");
            }
        }
    }
}

#[test]
fn the_light_of_a_short_stroke_over_its_length_tends_to_that_of_a_dot() {
    let beam = Beam { dot_length: 1.0, ..beam(256) };
    let place = [0.013, -0.027];
    let dot = draw(&beam, &[stroke(place, place, [0.7, 0.7])]);
    let mut last = f64::MAX;
    for halving in 7..14 {
        let length = 0.5f32.powi(halving);
        let half = [length * 0.3, length * 0.4];
        let ends = [[place[0] - half[0], place[1] - half[1]], [place[0] + half[0], place[1] + half[1]]];
        let line = draw(&beam, &[Stroke { color: [1.0 / length; 3], ..stroke(ends[0], ends[1], [0.7, 0.7]) }]);
        let error = difference(&dot, &line);
        // Quadratic in the length, until it meets the rounding of the ends.
        assert!(error < last * 0.3 || error < 1e-4, "length {length}: {error}");
        last = error;
    }
    assert!(last < 1e-4);
}

#[test]
fn a_stroke_cut_in_pieces_gives_the_same_light() {
    // Every cut is a number of few bits, so that the pieces lie exactly on the stroke.
    for (start, end) in [([-0.5, -0.25], [0.5, 0.75]), ([-0.5, 0.25], [0.5, 0.25]), ([0.25, -0.75], [0.0, 0.25])] {
        for pieces in [2, 8, 64, 512, 4096] {
            let at = |piece: usize| {
                let t = piece as f32 / pieces as f32;
                ([0, 1].map(|axis| start[axis] + t * (end[axis] - start[axis])), 0.25 + 0.5 * t)
            };
            let cut: Vec<Stroke> = (0..pieces)
                .map(|piece| {
                    let ((from, dim), (to, bright)) = (at(piece), at(piece + 1));
                    stroke(from, to, [dim, bright])
                })
                .collect();
            let whole = draw(&beam(512), &[stroke(start, end, [0.25, 0.75])]);
            let parts = draw(&beam(512), &cut);
            let total = parts.total()[0] / whole.total()[0] - 1.0;
            assert!(total.abs() < 1e-6, "{pieces} pieces: total {total}");
            let worst = difference(&whole, &parts);
            assert!(worst < 1e-6 * 4.0, "{pieces} pieces: pixel {worst}");
        }
    }
}

#[test]
fn a_stroke_drawn_twice_is_twice_as_bright() {
    for stroke in jumble(40) {
        let once = draw(&beam(200), &[stroke]);
        let twice = draw(&beam(200), &[Stroke { color: stroke.color.map(|part| part / 2.0), ..stroke }; 2]);
        assert!(once.total()[0] == 0.0 || difference(&once, &twice) < 2e-7);
    }
}

#[test]
fn direction_does_not_matter() {
    for stroke in jumble(40) {
        let [first, last] = stroke.intensity;
        let back = Stroke { start: stroke.end, end: stroke.start, intensity: [last, first], ..stroke };
        let (there, back) = (draw(&beam(200), &[stroke]), draw(&beam(200), &[back]));
        assert!(there.total()[0] == 0.0 || difference(&there, &back) < 3e-6);
    }
}

#[test]
fn the_light_is_the_same_for_any_number_of_threads() {
    let strokes = jumble(3000);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| draw(&beam(300), &strokes))
    };
    let one = with(1);
    assert!(one.total()[0] > 0.0);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn wide_and_plain_instructions_give_the_same_bits() {
    let strokes = jumble(500);
    let optics = beam(150).optics();
    let mut wide = beam(150).dark(3);
    let mut bins = Bins::default();
    wide.write(&mut bins, &strokes);
    assert!(wide.total()[0] > 0.0);
    for way in 0..widest::ways::<Writing>().len() {
        let mut light = beam(150).dark(3);
        let columns = light.columns();
        for (index, tile) in light.tiles.iter_mut().enumerate() {
            let corner = [index % columns * TILE_WIDTH, index / columns * TILE_HEIGHT];
            widest::ways()[way](Writing { optics: &optics, guns: 3, corner, bins: &bins, index, tile });
        }
        assert_eq!(wide, light);
    }
}

#[test]
fn every_tile_knows_all_strokes_that_reach_it() {
    // The same strokes without the help of the bins: one picture for each, added up.
    let strokes = jumble(60);
    let all = draw(&beam(400), &strokes);
    let mut sum = vec![0.0; 400 * 400 * 3];
    for stroke in &strokes {
        let wide = Beam::new(400, 400).optics();
        let mut light = beam(400).dark(3);
        let columns = light.columns();
        for (index, tile) in light.tiles.iter_mut().enumerate() {
            let corner = [index % columns * TILE_WIDTH, index / columns * TILE_HEIGHT];
            tile.planes.resize(3 * PLANE, 0.0);
            tile.lit = true;
            if let Some(track) = Track::new(&wide, stroke, corner) {
                let mut room = Scratch::new();
                track.find(&mut room);
                track.write(&room, &mut tile.planes);
            }
        }
        pixels(&light).iter().zip(&mut sum).for_each(|(light, sum)| *sum += light);
    }
    let worst = pixels(&all).iter().zip(&sum).fold(0.0f32, |worst, (a, b)| worst.max((a - b).abs()));
    assert!(worst < 1e-5, "{worst}");
}

#[test]
fn the_centre_of_a_long_line_has_light_1() {
    // 511 rows: the middle of row 255 is y = 0.
    let across = stroke([-0.9, 0.0], [0.9, 0.0], [1.0, 1.0]);
    let light = draw(&beam(511), &[across]);
    assert!((light.at(255, 255).unwrap()[0] - 1.0).abs() < 1e-5);
    assert_eq!(light.at(255, 240), Some([0.0; 3]));
}

#[test]
fn an_intensity_ramp_is_linear_along_the_stroke() {
    let light = draw(&beam(511), &[stroke([-0.8, 0.0], [0.8, 0.0], [0.0, 1.0])]);
    for x in (60..450).step_by(13) {
        let place = (f64::from(x) + 0.5) / 255.5 - 1.0;
        let drawn = f64::from(light.at(x, 255).unwrap()[0]);
        assert!((drawn - (place + 0.8) / 1.6).abs() < 2e-5, "column {x}: {drawn}");
    }
}

#[test]
fn the_upper_left_corner_is_minus_one_one() {
    let corner = [-0.99, 0.99];
    let light = draw(&beam(100), &[stroke(corner, corner, [1.0, 1.0])]);
    assert!(light.at(0, 0) > light.at(1, 0) && light.at(0, 0) > light.at(0, 1));
    assert_eq!(light.at(99, 0), Some([0.0; 3]));
    assert_eq!((light.at(100, 0), light.at(0, 100)), (None, None));
}

#[test]
fn strokes_that_leave_the_screen_are_cut_at_its_edge() {
    // Between two picture edges, and from far outside to far outside through the centre.
    let far = draw(&beam(128), &[stroke([-1e5, 0.25], [1e5, 0.25], [1.0, 1.0])]);
    assert!((far.total()[0] / 2.0 - 1.0).abs() < 1e-4);
    let outside = draw(&beam(128), &[stroke([-3.0, 2.0], [3.0, 2.0], [1.0, 1.0])]);
    assert_eq!(outside.total(), [0.0; 3]);
}

#[test]
fn strokes_that_are_not_finite_are_left_out_and_nothing_becomes_nan() {
    let good = stroke([-0.5, -0.5], [0.5, 0.25], [0.3, 1.0]);
    let mut strokes = vec![good];
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        strokes.push(Stroke { start: [bad, 0.0], ..good });
        strokes.push(Stroke { end: [0.0, bad], ..good });
    }
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        strokes.push(Stroke { intensity: [1.0, bad], ..good });
        strokes.push(Stroke { color: [bad, 0.0, 0.0], ..good });
    }
    assert_eq!(draw(&beam(64), &strokes), draw(&beam(64), &[good]));

    let tiny = stroke([0.1, 0.1], [0.1 + f32::EPSILON, 0.1], [0.0, 1.0]);
    let denormal = stroke([0.0, 0.0], [f32::from_bits(1), 0.0], [1.0, 1.0]);
    let negative = stroke([0.0, 0.0], [0.5, 0.0], [-1.0, -0.5]);
    let light = draw(&beam(64), &[tiny, denormal, negative]);
    assert!(pixels(&light).iter().all(|value| value.is_finite() && *value >= 0.0));
}

#[test]
fn settings_out_of_range_are_brought_into_it() {
    let line = [stroke([-0.5, 0.1], [0.5, 0.1], [1.0, 1.0]), stroke([0.0, 0.0], [0.0, 0.0], [1.0, 1.0])];
    for odd in [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0] {
        let beam = Beam { spot_radius: odd, dot_length: odd, blur: odd, ..Beam::new(0, 0) };
        assert_eq!((draw(&beam, &line).width(), draw(&beam, &line).height()), (1, 1));
        let beam = Beam { width: 99, height: 99, ..beam };
        let total = draw(&beam, &line).total()[0];
        assert!((total - 1.0).abs() < 1e-4, "the dot is dark, the line is not: {total}");
        let flat = Beam { contrast: odd, ..Beam::new(9, 9) };
        assert!(draw(&flat, &line).total()[0].is_finite());
    }
    let blurred = Beam { spot_radius: f32::INFINITY, blur: f32::INFINITY, ..beam(99) };
    assert!(draw(&blurred, &line).total()[0].is_finite());
}

#[test]
fn the_square_screen_lies_in_the_middle_of_any_picture() {
    let cross = [stroke([-1.0, 0.5], [1.0, 0.5], [1.0; 2]), stroke([0.0, -0.5], [0.0, 0.5], [0.5; 2])];
    let square = draw(&beam(120), &cross);
    for (width, height, left, top) in [(300, 120, 90, 0), (120, 200, 0, 40), (121, 120, 0, 0)] {
        let light = draw(&Beam::new(width, height), &cross);
        if (width + height) % 2 == 0 {
            for (x, y) in [(60, 30), (59, 30), (60, 60), (61, 70), (5, 31), (0, 30)] {
                let (here, there) = (square.at(x, y).unwrap()[0], light.at(x + left, y + top).unwrap()[0]);
                assert!((here - there).abs() < 1e-5, "{width} {height}: {x} {y}");
            }
        }
        // The ends of the long stroke lie on the edge, which may cut half of their glow off.
        assert!((light.total()[0] / 2.5 - 1.0).abs() < 1e-2, "{width} {height}");
    }
}

#[test]
fn light_beside_the_square_screen_is_drawn_as_far_as_the_picture_goes() {
    let light = draw(&Beam::new(300, 100), &[stroke([-9.0, 0.01], [9.0, 0.01], [1.0; 2])]);
    for x in [0, 150, 299] {
        assert!(light.at(x, 49).unwrap()[0] > 0.5, "{x}");
    }
}

#[test]
fn focus_keeps_the_light_and_spreads_it() {
    let line = [stroke([-0.5, 0.2], [0.5, -0.3], [1.0, 0.5])];
    let sharp = draw(&beam(700), &line);
    let blurred = draw(&Beam { blur: 6.0, ..beam(700) }, &line);
    assert!((sharp.total()[0] / blurred.total()[0] - 1.0).abs() < 1e-4);
    let peak = |light: &ScreenLight| pixels(light).into_iter().fold(0.0, f32::max);
    assert!(peak(&blurred) < 0.25 * peak(&sharp), "{} {}", peak(&blurred), peak(&sharp));
    let sum = |light: &ScreenLight| pixels(light).into_iter().map(f64::from).sum::<f64>();
    assert!((sum(&sharp) / sum(&blurred) - 1.0).abs() < 1e-4);
}

#[test]
fn contrast_keeps_the_full_intensity_and_moves_the_others() {
    let at = |contrast, intensity| {
        let beam = Beam { contrast, ..beam(101) };
        draw(&beam, &[stroke([-0.9, 0.0], [0.9, 0.0], [intensity; 2])]).at(50, 50).unwrap()[0]
    };
    for (contrast, intensity, expected) in
        [(1.0, 0.3, 0.3), (0.0, 0.3, 1.0), (0.5, 0.5, 0.75), (2.0, 0.75, 0.5), (2.0, 0.4, 0.0), (2.0, 1.0, 1.0)]
    {
        let light = at(contrast, intensity);
        assert!((light - expected).abs() < 1e-5, "{contrast} {intensity}: {light}");
    }
    // A ramp from dark to full: the first half is cut off, the second is linear.
    let ramp = stroke([-0.8, 0.0], [0.8, 0.0], [0.0, 1.0]);
    let light = draw(&Beam { contrast: 2.0, ..beam(511) }, &[ramp]);
    assert!((light.total()[0] - 0.4).abs() < 1e-4, "{:?}", light.total());
    assert!((light.at(357, 255).unwrap()[0] - 0.5).abs() < 5e-3);
}

#[test]
fn extremes_of_size_length_intensity_and_number_stay_finite() {
    let long = [1e9, 1e9];
    let strokes = [
        stroke([-1e9, -1e9], long, [1.0; 2]),
        stroke([0.0, 0.0], long, [0.0, 500.0]),
        stroke([0.3, 0.3], [0.3, 0.3], [500.0; 2]),
        stroke([0.3, 0.3], [0.3, 0.3], [0.0; 2]),
        stroke([-0.5, 0.1], [0.7, 0.1], [f32::MAX; 2]),
    ];
    for (width, height) in [(1, 1), (1, 300), (300, 1), (2, 3), (127, 33), (7680, 4320), (8192, 1)] {
        let light = draw(&Beam::new(width, height), &strokes);
        assert_eq!((light.width(), light.height()), (width, height));
        let lit = light.tiles.iter().filter(|tile| tile.lit);
        assert!(lit.flat_map(|tile| &tile.planes).all(|light| light.is_finite() && *light >= 0.0), "{width} {height}");
    }
    // The diagonal through the screen is the diagonal of the picture.
    let light = draw(&beam(500), &strokes[..1]);
    assert!((light.total()[0] / 8.0_f64.sqrt() - 1.0).abs() < 1e-2, "{:?}", light.total());
    for place in [10, 250, 490] {
        assert!((light.at(place, 499 - place).unwrap()[0] - 1.0).abs() < 1e-2, "{place}");
    }
}

#[test]
fn a_million_strokes_on_one_point_add_up() {
    let dot = stroke([0.1, 0.1], [0.1, 0.1], [1.0; 2]);
    let one = draw(&beam(40), &[dot]).total()[0];
    let many = draw(&beam(40), &vec![dot; 1_000_000]).total()[0];
    // Single precision loses a little where a million is added one by one.
    assert!((many / one / 1e6 - 1.0).abs() < 0.02, "{}", many / one);
}

#[test]
fn memory_grows_with_the_light_and_not_with_the_picture() {
    let light = draw(&Beam::new(8192, 8192), &[stroke([0.0, 0.0], [0.01, 0.0], [1.0; 2])]);
    let lit = light.tiles.iter().filter(|tile| !tile.planes.is_empty()).count();
    assert!(lit <= 16, "{lit}");
    assert!(light.lit_pixels() > 1000 && light.lit_pixels() < 20_000, "{}", light.lit_pixels());
}
