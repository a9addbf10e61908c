//! How many strokes a second the display draws, from strokes to the bytes of the pixels: on the processor, and on the
//! best graphics processor that there is, which may be software.
//!
//! Each picture is checked before it is timed: the light is that of the strokes, the bytes are there, and those of both
//! processors agree within one. A drawer of plain smooth lines (Wu 1991: two pixels a step, no spot, no ramp, no
//! energy, colour added to bytes) runs beside them.
//! `THREADS=1` in the environment lets everything run on one thread; otherwise as many as there are processors. With
//! the word `target` as argument only the row of the target is measured.

use ps340::{
    calligraphic::{self, Beam, Controls, Display, Drawer, Gpu},
    traversal::Stroke,
};
use std::{sync::Arc, time::Instant};

/// Runs of each measurement.
const RUNS: usize = 9;
/// Seconds after which no further run begins.
const TIME_LIMIT: u64 = 3;

/// Strokes of `pixels` pixels in a picture of `size`, at places and angles that fill the screen, in several colours.
fn strokes(count: usize, pixels: f32, size: u32) -> Vec<Stroke> {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1 << 24) as f32
    };
    let length = pixels * 2.0 / size as f32;
    let stroke = |index: usize| {
        let (x, y, angle) = (1.6 * random() - 0.8, 1.6 * random() - 0.8, std::f32::consts::TAU * random());
        let color = ps340::hue::rgb((index / 100 * 30) as f32, 0.8);
        let end = [x + length * angle.cos(), y + length * angle.sin()];
        Stroke { start: [x, y], end, intensity: [0.5 + 0.5 * random(), 0.5], color }
    };
    (0..count).map(stroke).collect()
}

/// The shortest of several runs, seconds; fewer if they take long.
fn best(mut work: impl FnMut()) -> f64 {
    let begin = Instant::now();
    let mut shortest = f64::INFINITY;
    for run in 0..RUNS {
        if run > 1 && begin.elapsed().as_secs() >= TIME_LIMIT {
            break;
        }
        let start = Instant::now();
        work();
        shortest = shortest.min(start.elapsed().as_secs_f64());
    }
    shortest
}

/// Adds smooth lines of one pixel's width to bytes (X. Wu 1991), on one thread.
fn wu(strokes: &[Stroke], size: u32, rgba: &mut [u8]) {
    let half = size as f32 / 2.0;
    for stroke in strokes {
        let [mut start, mut end] = [stroke.start, stroke.end].map(|[x, y]| [(x + 1.0) * half, (1.0 - y) * half]);
        let steep = (end[1] - start[1]).abs() > (end[0] - start[0]).abs();
        if steep {
            (start, end) = ([start[1], start[0]], [end[1], end[0]]);
        }
        if start[0] > end[0] {
            (start, end) = (end, start);
        }
        let slope = (end[1] - start[1]) / (end[0] - start[0]).max(1e-9);
        let color = stroke.color.map(|part| part * stroke.intensity[0] * 255.0);
        let mut across = start[1];
        for along in start[0] as u32..=end[0] as u32 {
            let part = across.fract();
            for (side, part) in [(0, 1.0 - part), (1, part)] {
                let (x, y) = if steep { (across as u32 + side, along) } else { (along, across as u32 + side) };
                if x < size && y < size {
                    let place = 4 * (y * size + x) as usize;
                    for (byte, color) in rgba[place..place + 3].iter_mut().zip(color) {
                        *byte = byte.saturating_add((color * part) as u8);
                    }
                }
            }
            across += slope;
        }
    }
}

/// What is seen of the same strokes by the processor and by another, which may differ by one in each byte.
fn check(strokes: &[Stroke], size: u32, drawer: &Drawer) {
    let light = calligraphic::draw(&Beam::new(size, size), strokes);
    let length = |s: &Stroke| f64::from(s.end[0] - s.start[0]).hypot(f64::from(s.end[1] - s.start[1]));
    let expected: f64 = strokes.iter().map(|s| length(s) * f64::from(s.intensity[0] + s.intensity[1]) / 2.0).sum();
    // At full value the strongest of the three channels has all the light, and only one of them may.
    let strongest = light.total().into_iter().fold(0.0, f64::max);
    assert!(strongest > 0.3 * expected && strongest < 1.001 * expected, "{strongest} {expected}");
    let [exact, drawn] = [&Drawer::Processor, drawer].map(|drawer| {
        let mut display = Display::drawn_by(drawer.clone(), Controls::default(), [size, size]);
        display.show(strokes, 0, 0);
        display
    });
    assert!(exact.frame().chunks_exact(4).filter(|pixel| pixel[..3] != [0; 3]).count() as u64 > light.lit_pixels() / 3);
    let worst = exact.frame().iter().zip(drawn.frame()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(1), "{size}: {worst:?} between the processor and {drawer}");
}

/// Strokes a second and the time of a frame, from strokes to bytes; and that of a picture that stands still.
fn row(strokes: &[Stroke], pixels: f32, size: u32, drawer: &Drawer) {
    check(strokes, size, drawer);
    let mut display = Display::drawn_by(drawer.clone(), Controls::default(), [size, size]);
    let mut version = 0;
    let frame = best(|| {
        version += 1;
        display.show(strokes, version, version);
    });
    let lit = display.light().lit_pixels();
    let still = best(|| (0..1000).for_each(|ahead| display.show(strokes, version, version + ahead)));
    let count = strokes.len();
    println!(
        "{count:>9} of {pixels:>3} px at {size}: {:8.2} ms a frame, {:6.3} M/s, {:7.1} ns a lit pixel ({lit}), \
         unchanged {:.3} us",
        frame * 1e3,
        count as f64 / frame / 1e6,
        frame / lit as f64 * 1e9,
        still * 1e3,
    );
}

/// A row of the table for the peer, which draws the strokes as Wu does.
fn wu_row(strokes: &[Stroke], pixels: f32, size: u32) {
    let mut rgba = vec![0; 4 * (size * size) as usize];
    let time = best(|| {
        rgba.fill(0);
        wu(strokes, size, &mut rgba);
    });
    let count = strokes.len();
    println!("{count:>9} of {pixels:>3} px at {size}: {:8.2} ms, {:6.3} M/s", time * 1e3, count as f64 / time / 1e6);
}

/// Every number and length of strokes in every size.
fn each(mut row: impl FnMut(&[Stroke], f32, u32)) {
    for size in [1024, 2048] {
        for pixels in [10.0, 100.0] {
            for count in [10, 1_000, 10_000, 100_000, 1_000_000] {
                row(&strokes(count, pixels, size), pixels, size);
            }
        }
    }
}

fn main() {
    let threads = std::env::var("THREADS").ok().and_then(|word| word.parse().ok()).unwrap_or(0);
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() else { return };
    println!("strokes to light to bytes, {} threads, the shortest of {RUNS} runs", pool.current_num_threads());
    pool.install(|| {
        if !std::env::args().any(|word| word == "target") {
            every_row();
        }
        println!(
            "\nthe target: 100,000 strokes of ten pixels in a frame of 30 Hz, 33.3 ms, by the processor; even intensity"
        );
        let even = strokes(100_000, 10.0, 1024).into_iter().map(|s| Stroke { intensity: [s.intensity[0]; 2], ..s });
        row(&even.collect::<Vec<_>>(), 10.0, 1024, &Drawer::Processor);
    });
}

/// Every number, length and size, by every drawer and by the peer.
fn every_row() {
    let mut drawers = vec![Drawer::Processor];
    match Gpu::open(true) {
        Ok(gpu) => drawers.push(Drawer::Gpu(Arc::new(gpu))),
        Err(error) => println!("no graphics processor: {error}"),
    }
    for drawer in &drawers {
        println!("\ndrawn by {drawer}");
        each(|strokes, pixels, size| row(strokes, pixels, size, drawer));
    }
    println!("\nsmooth lines by Wu, one thread");
    each(wu_row);
}
