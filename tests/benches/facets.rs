//! How long it takes to sample a direction by a facet that the viewer sees: Beckmann's beside GGX's, as renderers call
//! them. That normals have the means which their pdf tells is checked first.
//!
//! Times are seconds of the processor, where the system counts them, so that other work on the machine does not count;
//! else seconds of the wall. `cargo bench -p tests --bench facets`

use glam::{DVec2, DVec3};
use host::illumination::distribution::{Distribution, Microfacet, SlopeDistribution};
use host::numeric::sampling::r2_point;
use std::time::Instant;

/// Normals in a run, and runs, of which the shortest counts.
const NORMALS: u32 = 1_000_000;
const RUNS: usize = 7;
/// The greatest ratio of the two times.
const TARGET: f64 = 2.0;
fn slanted(cosine: f64) -> DVec3 {
    DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
}

/// Seconds of the processor that this thread has used.
fn seconds(since: Instant) -> f64 {
    let of_thread = || {
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        Some(text.split_whitespace().next()?.parse::<u64>().ok()? as f64 * 1e-9)
    };
    of_thread().unwrap_or_else(|| since.elapsed().as_secs_f64())
}

/// Whether normals that are drawn have the means that their pdf tells, found by normals of GGX's tails.
fn check(slopes: SlopeDistribution, roughness: f64, cosine: f64) {
    let (view, m) = (slanted(cosine), DVec2::splat(roughness));
    let of = |slopes, m| Microfacet::new(slopes, m).expect("a roughness");
    // Wider than what is checked, whichever it is.
    let (checked, wide) = (of(slopes, m), of(SlopeDistribution::Ggx, 1.2 * m));
    let (mut drawn, mut told, mut all) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for index in 0..NORMALS {
        let point = r2_point(index, [0.5, 0.5]);
        drawn += slopes.visible(view, m, point).unwrap_or(DVec3::Z);
        if let Some(normal) = SlopeDistribution::Ggx.visible(view, 1.2 * m, point) {
            let mirrored = normal * (2.0 * normal.dot(view)) - view;
            let weight = checked.pdf(view, mirrored) / wide.pdf(view, mirrored);
            told += normal * weight;
            all += weight;
        }
    }
    let count = f64::from(NORMALS);
    let error = (drawn / count - told / count).length();
    assert!(error < 1e-3 && (all / count - 1.0).abs() < 1e-3, "{slopes:?} {roughness} {cosine}: {error}, {all}");
}

/// Nanoseconds a direction, for viewers at all cosines.
fn time(slopes: SlopeDistribution, roughness: f64) -> f64 {
    let facets: Box<dyn Distribution> =
        Box::new(Microfacet::new(slopes, DVec2::splat(roughness)).expect("a roughness"));
    let directions: Vec<DVec3> = (0..256).map(|k| slanted((f64::from(k) + 0.5) / 256.0)).collect();
    let run = || {
        let start = Instant::now();
        let before = seconds(start);
        let mut sum = DVec3::ZERO;
        for index in 0..NORMALS {
            let view = directions[index as usize % directions.len()];
            sum += facets.sample(view, r2_point(index, [0.5, 0.5])).unwrap_or_default();
        }
        std::hint::black_box(sum);
        (seconds(start) - before) * 1e9 / f64::from(NORMALS)
    };
    (0..RUNS).map(|_| run()).fold(f64::INFINITY, f64::min)
}

fn main() {
    println!("{:<32} {:>12} {:>12} {:>8}", "a direction by a visible facet", "GGX", "Beckmann", "ratio");
    for roughness in [0.05, 0.3, 1.0] {
        let both = [SlopeDistribution::Ggx, SlopeDistribution::Beckmann];
        for (slopes, cosine) in both.into_iter().flat_map(|slopes| [0.1, 0.5, 0.9].map(|cosine| (slopes, cosine))) {
            check(slopes, roughness, cosine);
        }
        let [ggx, beckmann] = both.map(|slopes| time(slopes, roughness));
        let name = format!("roughness {roughness}");
        println!("{name:<32} {ggx:>9.1} ns {beckmann:>9.1} ns {:>8.2} [{TARGET}]", beckmann / ggx);
    }
}
