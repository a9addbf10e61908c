//! Facts about denoising, by films whose noise is known.

use super::halves::halves;
use super::*;
use crate::render::PixelSample;
use crate::render::features::PixelFeatures;
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const NEVER: &(dyn Fn() -> bool + Sync) = &|| false;

/// The truth of a pixel: its radiance, albedo and normal.
type Truth<'a> = &'a dyn Fn(f64, f64) -> (DVec3, DVec3, DVec3);

/// A film of some samples a pixel, whose radiance is that of the truth times a number of mean 1 and a deviation.
fn film([width, height]: [u32; 2], samples: u32, deviation: f64, truth: Truth<'_>, seed: u64) -> Film {
    let mut film = Film::new(width, height).expect("small").with_features();
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    for (y, mut row) in film.rows_mut().into_iter().enumerate() {
        for x in 0..width as usize {
            for _ in 0..samples {
                let at = [x, y].map(|at| at as f64 + random.random::<f64>());
                let (radiance, albedo, normal) = truth(at[0], at[1]);
                let factor = 1.0 + deviation * 12f64.sqrt() * (random.random::<f64>() - 0.5);
                let sample = PixelSample {
                    radiance: radiance * factor,
                    covered: true,
                    first: Some((5.0, normal, [0, 0])),
                    albedo,
                    normal,
                    ..PixelSample::default()
                };
                row.add(x, &sample, &Default::default());
            }
        }
    }
    film
}

fn denoise(film: &Film) -> Picture {
    denoised(film, NEVER).expect("a picture").expect("not cancelled")
}

/// Root mean squared difference of the first band from a truth in the middle of each pixel, without a margin.
fn rmse(picture: &Picture, margin: u32, truth: Truth<'_>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for y in margin..picture.height() - margin {
        for x in margin..picture.width() - margin {
            let found = f64::from(picture.get(x, y).expect("inside").radiance[0]);
            sum += (found - truth(f64::from(x) + 0.5, f64::from(y) + 0.5).0.x).powi(2);
            count += 1.0;
        }
    }
    f64::sqrt(sum / count)
}

#[test]
fn an_even_wall_keeps_its_mean_and_loses_most_of_its_noise_however_bright_it_is() {
    let wall: Truth<'_> = &|_, _| (DVec3::new(0.5, 0.4, 0.3), DVec3::splat(0.5), DVec3::Z);
    for scale in [1e-6, 1.0, 1e6] {
        let film = film([64, 48], 4, 0.5, &|x, y| (wall(x, y).0 * scale, wall(x, y).1, wall(x, y).2), 1);
        let (noisy, quiet) = (film.picture().expect("small"), denoise(&film));
        let errors =
            [&noisy, &quiet].map(|picture| rmse(picture, 0, &|x, y| (wall(x, y).0 * scale, DVec3::ONE, DVec3::Z)));
        assert!(errors[1] < 0.4 * errors[0], "{errors:?} at {scale}");
        let mean = |picture: &Picture| picture.pixels().iter().map(|p| f64::from(p.radiance[0])).sum::<f64>();
        assert!((mean(&quiet) / mean(&noisy) - 1.0).abs() < 5e-3);
    }
}

#[test]
fn edges_and_gradients_that_features_tell_stay() {
    // Stripes of two albedos under light that falls off, and a corner between two walls.
    let scene: Truth<'_> = &|x, y| {
        let albedo = if ((x / 3.0) as u32).is_multiple_of(2) { 0.8 } else { 0.2 };
        let (light, normal) = if y < 30.0 { (0.2 + x / 80.0, DVec3::Z) } else { (1.5, DVec3::Y) };
        (DVec3::splat(albedo * light), DVec3::splat(albedo), normal)
    };
    let film = film([80, 60], 8, 0.5, scene, 2);
    let errors = [film.picture().expect("small"), denoise(&film)].map(|picture| rmse(&picture, 2, scene));
    assert!(errors[1] < 0.5 * errors[0], "{errors:?}");
}

#[test]
fn a_picture_without_noise_stays_as_it_is() {
    let sharp: Truth<'_> = &|x, y| {
        let value = if ((x.floor() + y.floor()) as u32).is_multiple_of(2) { 1.0 } else { 0.1 };
        (DVec3::splat(value), DVec3::splat(0.5), DVec3::Z)
    };
    let film = film([40, 40], 4, 0.0, sharp, 3);
    assert_eq!(denoise(&film), film.picture().expect("small"));
}

#[test]
fn a_shadow_that_no_feature_tells_is_not_blurred_away() {
    let shadow: Truth<'_> = &|x, _| (DVec3::splat(if x < 32.0 { 0.1 } else { 1.0 }), DVec3::splat(0.5), DVec3::Z);
    let film = film([64, 40], 16, 0.3, shadow, 4);
    let quiet = denoise(&film);
    let errors = [&film.picture().expect("small"), &quiet].map(|picture| rmse(picture, 0, shadow));
    assert!(errors[1] < 0.5 * errors[0], "{errors:?}");
    let beside = |x: u32| (0..40).map(|y| quiet.get(x, y).expect("inside").radiance[0]).sum::<f32>() / 40.0;
    assert!(beside(31) < 0.15 && beside(32) > 0.9, "{} {}", beside(31), beside(32));
}

#[test]
fn the_result_is_the_same_for_any_number_of_threads() {
    let wall: Truth<'_> = &|x, y| (DVec3::splat(0.5 + 0.3 * (x * 0.3).sin() * (y * 0.2).cos()), DVec3::ONE, DVec3::Z);
    let film = film([100, 70], 4, 0.4, wall, 5);
    let with = |threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(|| denoise(&film))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn odd_films_are_denoised_without_harm() {
    let wall: Truth<'_> = &|_, _| (DVec3::splat(0.5), DVec3::ONE, DVec3::Z);
    for size in [[1, 1], [1, 40], [200, 1], [17, 33]] {
        for samples in [1, 2, 3] {
            assert!(denoise(&film(size, samples, 0.5, wall, 6)).is_finite(), "{size:?} {samples}");
        }
    }
    let nothing = |_, _| (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    assert!(denoise(&film([20, 20], 4, 0.0, &nothing, 7)).pixels().iter().all(|pixel| pixel.radiance == [0.0; 3]));
    let empty = Film::new(9, 9).expect("small").with_features();
    assert_eq!(denoise(&empty), empty.picture().expect("small"));
    // A single sample that is a million times as bright as the others, and infinities, which samples may hold.
    for value in [1e6, 1e30, f64::INFINITY, f64::NAN] {
        let mut film = film([40, 40], 4, 0.2, wall, 8);
        let bright = PixelSample { radiance: DVec3::splat(value), ..PixelSample::default() };
        film.rows_mut()[20].add(20, &bright, &Default::default());
        let quiet = denoise(&film);
        assert!(quiet.is_finite(), "{value}");
        let far = quiet.get(35, 5).expect("inside").radiance[0];
        assert!(value == 1e30 || (far - 0.5).abs() < 0.1, "{far}");
    }
}

#[test]
fn pixels_of_one_sample_darken_none_beside_them() {
    // As where time ran out in the second pass: the left half has one sample a pixel, the right one eight.
    let wall: Truth<'_> = &|_, _| (DVec3::splat(0.5), DVec3::ONE, DVec3::Z);
    let mut film = film([64, 40], 1, 0.3, wall, 10);
    let more = self::film([64, 40], 8, 0.3, wall, 11);
    for y in 0..40 {
        for x in 32..64 {
            film.tallies_mut()[y * 64 + x] = more.tallies()[y * 64 + x];
            film.features_mut()[y * 64 + x] = more.features()[y * 64 + x];
        }
    }
    let quiet = denoise(&film);
    for columns in [0..32, 32..40, 40..64] {
        let width = columns.len() as f32;
        let sum: f32 = columns
            .flat_map(|x| (0..40).map(move |y| (x, y)))
            .map(|(x, y)| quiet.get(x, y).expect("inside").radiance[0])
            .sum();
        let mean = sum / (40.0 * width);
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
    }
}

#[test]
fn a_cancelled_one_gives_nothing() {
    let film = film([70, 40], 2, 0.2, &|_, _| (DVec3::ONE, DVec3::ONE, DVec3::Z), 9);
    assert!(denoised(&film, &|| true).expect("no error").is_none());
}

#[test]
fn halves_of_samples_are_what_the_film_holds() {
    let mut film = Film::new(1, 1).expect("small").with_features();
    for (number, [early, late]) in [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [4.0, 1.0]].into_iter().enumerate()
    {
        let value = f64::from(1u32 << number);
        film.rows_mut()[0].add(
            0,
            &PixelSample { radiance: DVec3::splat(value), ..PixelSample::default() },
            &Default::default(),
        );
        let count = number as u32 + 1;
        assert_eq!(halves(count), [early, late], "{count}");
        let PixelFeatures { early: sum, .. } = film.features()[0];
        // The sum of the first n powers of two is one less than the next.
        assert_eq!(sum[0], (1u32 << early as u32) as f32 - 1.0, "{count}");
    }
}

#[test]
fn one_bright_sample_leaves_no_trace_and_what_is_bright_in_both_halves_stays() {
    let lamp = |x: f64, y: f64| (20.0..23.0).contains(&x) && (20.0..23.0).contains(&y);
    let wall: Truth<'_> = &|x, y| (DVec3::splat(if lamp(x, y) { 50.0 } else { 0.5 }), DVec3::splat(0.5), DVec3::Z);
    let mut film = film([48, 40], 15, 0.3, wall, 3);
    let bright =
        PixelSample { radiance: DVec3::splat(5e3), covered: true, albedo: DVec3::splat(0.5), ..PixelSample::default() };
    for (x, y) in [(8, 9), (35, 30), (47, 0)] {
        film.rows_mut()[y].add(x, &bright, &Default::default());
    }
    let picture = denoise(&film);
    for y in 0..40 {
        for x in 0..48 {
            let found = f64::from(picture.get(x, y).expect("inside").radiance[0]);
            let truth = wall(f64::from(x) + 0.5, f64::from(y) + 0.5).0.x;
            assert!((found / truth - 1.0).abs() < 0.35, "{found} at {x}, {y}");
        }
    }
}

#[test]
fn edges_that_samples_hit_by_chance_are_left_and_noise_on_them_is_filtered() {
    // Discs: what a pixel at an edge is depends on where its samples lie, and no other pixel tells.
    let discs: Truth<'_> = &|x, y| {
        let far = |at: f64| at.rem_euclid(20.0) - 10.0;
        let (is_inside, kind) = (far(x).hypot(far(y)) < 7.3, ((x / 20.0).floor() + 3.0 * (y / 20.0).floor()) % 7.0);
        let value = if is_inside { 0.1 + 0.1 * kind } else { 0.9 };
        (DVec3::splat(value), DVec3::splat(value), DVec3::Z)
    };
    let wall: Truth<'_> = &|_, _| (DVec3::splat(0.5), DVec3::splat(0.5), DVec3::Z);
    for (truth, noise, is_left) in [(discs, 0.0, true), (wall, 0.4, false)] {
        let film = film([160, 120], 4, noise, truth, 12);
        assert_eq!(denoise(&film) == film.picture().expect("small"), is_left);
    }
}
