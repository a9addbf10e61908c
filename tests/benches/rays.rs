//! Rays per second: the octree, its two walks, and others on the same rays in the same run.

#[path = "rays/rivals.rs"]
mod rivals;
#[path = "rays/sets.rs"]
mod sets;
#[path = "rays/shapes.rs"]
mod shapes;

use std::hint::black_box;
use std::time::Instant;

use host::octree::{Octree, Settings, Walk};
use rayon::prelude::*;
use rivals::Hierarchy;
use sets::RaySet;
use shapes::Shape;

/// Passes over each set; the median counts.
const PASSES: usize = 5;

fn main() {
    let side = std::env::var("RAYS_SIDE").ok().and_then(|s| s.parse().ok()).unwrap_or(512);
    let large = std::env::var("RAYS_LARGE").is_ok();
    let mut list = vec![shapes::torus(70_000.0), shapes::bumpy(6)];
    if large {
        list.push(shapes::bumpy(8));
    }
    for shape in list {
        report(&shape, side);
    }
}

fn report(shape: &Shape, side: usize) {
    let start = Instant::now();
    let octree = Octree::build(&shape.vertices, &shape.triangles, &settings()).expect("a good mesh");
    let built = start.elapsed();
    let s = octree.statistics();
    println!(
        "{}: octree {built:.3?} {:.0} B/tri leaves {} refs {:.2} hist {:?}",
        shape.name,
        s.bytes_per_triangle,
        s.leaves,
        s.references as f64 / s.triangles as f64,
        s.depth_histogram
    );
    let leading =
        Octree::build(&shape.vertices, &shape.triangles, &Settings { walk: Walk::LeadingDirection, ..settings() })
            .expect("a good mesh");
    let bvh2 = Hierarchy::build(shape, false);
    let cwbvh = Hierarchy::build(shape, true);
    println!(
        "bvh2 {:.3?} {} B/tri, cwbvh {:.3?} {} B/tri",
        bvh2.build,
        bvh2.bytes() / shape.triangles.len(),
        cwbvh.build,
        cwbvh.bytes() / shape.triangles.len()
    );
    for set in sets::sets(shape, &octree, side) {
        let singles = Hierarchy::prepare(&set);
        let mut differ = 0;
        let mut cells = 0;
        let mut tris = 0;
        for (ray, single) in set.rays.iter().zip(&singles) {
            let (ours, c) = octree.closest_counted(ray, 0.0, set.t_max);
            cells += c.cells;
            tris += c.triangles;
            let theirs = bvh2.closest(*single);
            differ += usize::from(ours.map(|h| h.triangle) != theirs.map(|h| h.1));
        }
        let n = set.rays.len();
        let fast = rate(n, || run(&octree, &set, 1));
        let lead = if std::env::var("LEAD").is_ok() { rate(n / 16, || run(&leading, &set, 16)) } else { 0.0 };
        let hier = |h: &Hierarchy| {
            rate(n, || {
                singles.iter().filter(|&&r| if set.any { h.occluded(r) } else { h.closest(r).is_some() }).count()
            })
        };
        let b2 = hier(&bvh2);
        let cw = hier(&cwbvh);
        let all = rate(n, || set.rays.par_iter().filter(|r| hit(&octree, r, &set)).count());
        println!(
            "{:8} octree {fast:6.2} leading {lead:6.2} bvh2 {b2:6.2} cwbvh {cw:6.2} all {all:6.2} ratio {:.2} differ {differ} cells {:.1} tris {:.1}",
            set.name,
            fast / b2.max(cw),
            cells as f64 / n as f64,
            tris as f64 / n as f64
        );
    }
}

#[inline]
fn hit(octree: &Octree, ray: &host::octree::Ray, set: &RaySet) -> bool {
    if set.any { octree.occluded(ray, 0.0, set.t_max) } else { octree.closest(ray, 0.0, set.t_max).is_some() }
}

fn run(octree: &Octree, set: &RaySet, step: usize) -> usize {
    set.rays.iter().step_by(step).filter(|ray| hit(octree, ray, set)).count()
}

fn settings() -> Settings {
    Settings {
        leaf_triangles: std::env::var("LEAF").ok().and_then(|s| s.parse().ok()).unwrap_or(16),
        ..Settings::default()
    }
}
/// CPU seconds of this thread
fn cpu() -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|s| s.split(' ').next()?.parse::<f64>().ok())
        .unwrap_or(0.0)
        * 1e-9
}
/// Millions of rays per second.
fn rate(rays: usize, mut pass: impl FnMut() -> usize) -> f64 {
    let mut seconds: Vec<f64> = (0..PASSES)
        .map(|_| {
            let start = cpu();
            black_box(pass());
            cpu() - start
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    rays as f64 / seconds[0] / 1e6
}
