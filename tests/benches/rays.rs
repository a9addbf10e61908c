//! Rays per second: the octree, its two walks, and others on the same rays in the same run.
//!
//! First proves that the hits agree, then takes the times: processor seconds of one thread, median of five passes that
//! alternate between the rivals. `RAYS_SIDE` sets the width of the picture (512); `RAYS_MESHES` names mesh files,
//! separated by colons, to measure beside the teapot and the bunny.

#[path = "rays/crates.rs"]
mod crates;
#[path = "rays/rivals.rs"]
mod rivals;
#[path = "rays/sets.rs"]
mod sets;
#[path = "rays/shapes.rs"]
mod shapes;

use std::hint::black_box;
use std::time::{Duration, Instant};

use crates::{Binary, Parry};
use host::octree::{Octree, OctreeSettings, Walk};
use rayon::prelude::*;
use rivals::Hierarchy;
use sets::RaySet;
use shapes::Shape;

/// Passes over each set; the median counts.
const PASSES: usize = 5;

/// Seconds that a pass takes at least where threads are compared, so that their start is no part of it.
const LONG_ENOUGH: f64 = 0.1;

/// One ray in so many goes to those that are slow: the walk from cell to cell, `bvh` and `parry3d`.
const STRIDE: usize = 8;

fn main() {
    let side = std::env::var("RAYS_SIDE").ok().and_then(|text| text.parse().ok()).unwrap_or(512_usize).max(16);
    let mut list = vec![shapes::pot(0.001), shapes::rabbit(0)];
    for path in std::env::var("RAYS_MESHES").unwrap_or_default().split(':').filter(|path| !path.is_empty()) {
        match shapes::file(path) {
            Ok(shape) => list.push(shape),
            Err(error) => println!("{path}: {error}"),
        }
    }
    list.push(shapes::rabbit(2));
    println!("Mrays/s, one thread except `all`; {} rays a set\n", side * side);
    list.iter().for_each(|shape| report(shape, side));
    growth(side);
}

/// Everything about one mesh.
fn report(shape: &Shape, side: usize) {
    let (octree, built) = build(shape);
    let bytes = octree.bytes();
    let leading = octree.clone().with_walk(Walk::LeadingDirection);
    let rivals = [Hierarchy::build(shape, false), Hierarchy::build(shape, true)];
    let (plain, parry) = (Binary::build(shape), Parry::build(shape));
    let sets = sets::sets(shape, &octree, side);
    let embree = rivals::embree(shape, &sets);
    let statistics = leading.statistics();
    println!("{}", shape.name);
    if let Err(reason) = &embree {
        println!("  Embree: {reason}");
    }
    let with_mesh = size_of_val(shape.vertices.as_slice()) + size_of_val(shape.triangles.as_slice());
    println!(
        "  build, one thread, and memory, ours with the mesh: octree {}; obvhs BVH2 {}, CWBVH {}; bvh {:.3?}, parry3d {:.3?}, Embree {}",
        cost(built, bytes, shape),
        cost(rivals[0].build, rivals[0].bytes(), shape),
        cost(rivals[1].build, rivals[1].bytes(), shape),
        plain.build,
        parry.build,
        embree.as_ref().map_or("-".to_owned(), |embree| format!("{:.3?}", embree.build)),
    );
    println!(
        "  terminal nodes, where they are asked for: {}, {:.2} references a triangle, {} B/triangle",
        statistics.leaves,
        statistics.references as f64 / statistics.triangles.max(1) as f64,
        (statistics.linear_bytes - with_mesh) / shape.triangles.len().max(1),
    );
    println!(
        "           octree     all leading    BVH2   CWBVH     bvh   parry  Embree | octree to the better obvhs, bvh, parry, Embree; all to one | cells, triangles, differ"
    );
    for (index, set) in sets.iter().enumerate() {
        let singles = Hierarchy::prepare(set);
        let (plains, parries) = (Binary::prepare(set, &singles), Parry::prepare(set));
        let differ = disagreements(&octree, &leading, &rivals[0], set, &singles);
        let count = set.rays.len();
        let rival = |hierarchy: &Hierarchy| {
            let hit = |&&ray: &&_| if set.any { hierarchy.occluded(ray) } else { hierarchy.closest(ray).is_some() };
            singles.iter().filter(hit).count()
        };
        let few = count.div_ceil(STRIDE);
        let [fast, slow, binary, wide, bvh, parry] = rates(
            [count, few, count, count, few, few],
            [
                &|| hits(&octree, set, 1),
                &|| hits(&leading, set, STRIDE),
                &|| rival(&rivals[0]),
                &|| rival(&rivals[1]),
                &|| plains.iter().step_by(STRIDE).filter(|ray| plain.hits(ray, set.any)).count(),
                &|| parries.iter().step_by(STRIDE).filter(|ray| parry.hits(ray, set.t_max)).count(),
            ],
        );
        let (all, to_one) = all_threads(&octree, set);
        let other = embree.as_ref().map_or(f64::NAN, |embree| embree.rates[index]);
        let (cells, triangles) = work(&octree, set);
        println!(
            "  {:8} {fast:7.2} {all:7.2} {slow:7.2} {binary:7.2} {wide:7.2} {bvh:7.2} {parry:7.2} {other:7.2} | {:.2}, {:.1}, {:.1}, {:.2}; {to_one:.2} | {cells:.1}, {triangles:.1}, {differ}",
            set.name,
            fast / binary.max(wide),
            fast / bvh,
            fast / parry,
            fast / other,
        );
    }
    println!();
}

/// How the cost of a ray grows with the number of triangles.
fn growth(side: usize) {
    println!(
        "growth: primary and random rays of the teapot\n  triangles   build     Mrays/s primary  random   cells a ray"
    );
    for chord in [0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001] {
        let shape = shapes::pot(chord);
        let (octree, built) = build(&shape);
        let sets = sets::sets(&shape, &octree, side.min(256));
        let count = sets[0].rays.len();
        let [primary, random] = rates([count; 2], [&|| hits(&octree, &sets[0], 1), &|| hits(&octree, &sets[3], 1)]);
        let (cells, _) = work(&octree, &sets[3]);
        println!("  {:9}  {built:8.3?}  {primary:15.2} {random:7.2}  {cells:12.1}", shape.triangles.len());
    }
}

/// The octree, and the processor time of building it on one thread.
fn build(shape: &Shape) -> (Octree, Duration) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| {
        let start = processor_seconds();
        let octree =
            Octree::build(&shape.vertices, &shape.triangles, &OctreeSettings::default()).expect("a sound mesh");
        (octree, Duration::from_secs_f64(processor_seconds() - start))
    })
}

fn cost(time: Duration, bytes: usize, shape: &Shape) -> String {
    format!("{time:.3?} {:.0} B/triangle", bytes as f64 / shape.triangles.len().max(1) as f64)
}

fn hit(octree: &Octree, ray: &host::octree::Ray, set: &RaySet) -> bool {
    if set.any { octree.occluded(ray, 0.0, set.t_max) } else { octree.closest(ray, 0.0, set.t_max).is_some() }
}

fn hits(octree: &Octree, set: &RaySet, stride: usize) -> usize {
    set.rays.iter().step_by(stride).filter(|ray| hit(octree, ray, set)).count()
}

/// Rays for which the octree and the binary hierarchy name different triangles; the two walks must not differ at all.
fn disagreements(
    octree: &Octree,
    leading: &Octree,
    rival: &Hierarchy,
    set: &RaySet,
    singles: &[obvhs::ray::Ray],
) -> usize {
    let differs = |(index, (ray, single)): (usize, (&host::octree::Ray, &obvhs::ray::Ray))| {
        let ours = octree.closest(ray, 0.0, set.t_max);
        if index % STRIDE == 0 {
            assert_eq!(ours, leading.closest(ray, 0.0, set.t_max), "the walks disagree on {ray:?}");
        }
        ours.map(|hit| hit.triangle) != rival.closest(*single).map(|hit| hit.1)
    };
    let differ = set.rays.iter().zip(singles).enumerate().filter(|&pair| differs(pair)).count();
    assert!(differ * 1000 <= set.rays.len(), "{differ} of {} {} rays differ", set.rays.len(), set.name);
    differ
}

/// Nodes visited and triangles tested per ray.
fn work(octree: &Octree, set: &RaySet) -> (f64, f64) {
    let (mut cells, mut triangles) = (0, 0);
    for ray in &set.rays {
        let (_, count) = octree.closest_counted(ray, 0.0, set.t_max);
        cells += count.cells;
        triangles += count.triangles;
    }
    let rays = set.rays.len().max(1) as f64;
    (cells as f64 / rays, triangles as f64 / rays)
}

/// Millions of rays per second of several rivals, which take turns.
fn rates<const N: usize>(rays: [usize; N], rivals: [&dyn Fn() -> usize; N]) -> [f64; N] {
    let mut seconds = [const { Vec::new() }; N];
    for _ in 0..PASSES {
        for (rival, seconds) in rivals.iter().zip(&mut seconds) {
            let start = processor_seconds();
            black_box(rival());
            seconds.push(processor_seconds() - start);
        }
    }
    std::array::from_fn(|i| {
        seconds[i].sort_by(f64::total_cmp);
        rays[i] as f64 / seconds[i][PASSES / 2].max(1e-9) / 1e6
    })
}

/// Millions of rays per second of all threads, and that over what one thread of as many jobs does by the same clock,
/// that on the wall.
fn all_threads(octree: &Octree, set: &RaySet) -> (f64, f64) {
    let pools = [1, 0].map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads"));
    let pass = || set.rays.par_iter().with_min_len(1024).filter(|ray| hit(octree, ray, set)).count();
    let took = |pool: &rayon::ThreadPool, times: usize| {
        let start = Instant::now();
        (0..times).for_each(|_| _ = black_box(pool.install(pass)));
        start.elapsed().as_secs_f64() / times as f64
    };
    let times = (LONG_ENOUGH / took(&pools[1], 1).max(1e-6)).ceil() as usize;
    let mut seconds = [const { Vec::new() }; 2];
    for _ in 0..PASSES {
        pools.iter().zip(&mut seconds).for_each(|(pool, seconds)| seconds.push(took(pool, times)));
    }
    let [one, all] = seconds.map(|mut seconds| {
        seconds.sort_by(f64::total_cmp);
        seconds[PASSES / 2]
    });
    (set.rays.len() as f64 / all / 1e6, one / all)
}

/// Processor time of this thread.
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
