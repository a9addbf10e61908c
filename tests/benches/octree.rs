//! The octree as a modeller uses it: building, putting in, taking out, reading again, the inside test.
//!
//! First proves that an edited octree has the codes of one that is built; then takes the times of the wall clock on all
//! threads, the least of five. The index, for rays that start at the top, is made on request.

use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use host::mesh::{Mesh, bunny};
use host::numeric::bounds::Bounds;
use host::octree::{Containment, Octree, OctreeSettings, TriangleBvh, Walk};

/// The least of so many times counts.
const TRIALS: usize = 5;

fn main() {
    println!("milliseconds, least of {TRIALS}\n");
    for divisions in [0, 1, 2] {
        let mesh = (0..divisions).fold(bunny().expect("it ships"), |mesh, _| mesh.subdivided_smoothly());
        edits(&mesh);
        whole(&mesh);
    }
}

/// A small object beside a large one: what it costs to put it in and to take it out again.
fn edits(large: &Mesh) {
    let bounds = large.bounds().expect("vertices");
    let small: Vec<DVec3> =
        bunny().expect("it ships").vertices.iter().map(|p| (*p - bounds.center()) * 0.1 + bounds.max * 0.9).collect();
    let triangles = bunny().expect("it ships").triangles.into_iter().step_by(7).collect();
    let small = Mesh { vertices: small, triangles, ..Mesh::default() };
    let frame = bounds.union(small.bounds().expect("vertices"));
    println!("{} triangles, and {} more", large.triangles.len(), small.triangles.len());
    let build = || built(frame, &[large, &small]);
    let mut octree = build();
    let codes = octree.codes().to_vec();
    let (mut putting, mut taking) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..TRIALS {
        taking = taking.min(milliseconds(|| octree.remove(1)));
        putting = putting.min(milliseconds(|| octree.insert(&small.vertices, &small.triangles)));
    }
    assert_eq!(octree.codes(), codes, "an edited octree is the one that is built");
    let (building, indexing) = (least(build), least(|| octree.clone().with_walk(Walk::Index)));
    println!("  dividing both {building:.2}, putting in {putting:.2}, taking out {taking:.2}; an index {indexing:.2}");
}

/// Building, sorting, writing, reading, and the inside test of one mesh.
fn whole(mesh: &Mesh) {
    let settings = OctreeSettings::default();
    let build = || Octree::build(&mesh.vertices, &mesh.triangles, &settings).expect("a sound mesh").divided();
    let octree = build();
    let bytes = octree.to_bytes().expect("written");
    let sorted = TriangleBvh::new(&mesh.vertices, &mesh.triangles);
    let sorting = least(|| TriangleBvh::new(&mesh.vertices, &mesh.triangles));
    let reading = least(|| Octree::from_bytes(&bytes).expect("read"));
    println!(
        "  building {:.2}, reading {:.2} MB {reading:.2}, sorting {sorting:.2}",
        least(build),
        bytes.len() as f64 / 1e6
    );
    let bounds = mesh.bounds().expect("vertices");
    let points: Vec<DVec3> = (0..20_000_u32)
        .map(|i| {
            let part = DVec3::new(0.819_172_513, 0.671_043_607, 0.549_700_478) * f64::from(i);
            bounds.min + bounds.size() * part.fract()
        })
        .collect();
    let corners = |triangle: u32| mesh.corners(triangle as usize);
    let count =
        |side: &dyn Fn(DVec3) -> Containment| points.iter().filter(|&&p| side(p) == Containment::Inside).count();
    let (by_octree, by_sorted) = (count(&|p| octree.containment(p)), count(&|p| sorted.containment(p, corners)));
    assert_eq!(by_octree, by_sorted, "both structures say the same");
    let thousand = points.len() as f64 / 1e3;
    println!(
        "  inside test, microseconds a point, one thread: octree {:.2}, sorted {:.2}; {by_octree} of {} points inside\n",
        least(|| count(&|p| octree.containment(p))) / thousand,
        least(|| count(&|p| sorted.containment(p, corners))) / thousand,
        points.len()
    );
}

fn built(frame: Bounds, meshes: &[&Mesh]) -> Octree {
    let mut octree = Octree::around(frame, &OctreeSettings::default()).expect("a sound box");
    for mesh in meshes {
        octree.insert(&mesh.vertices, &mesh.triangles).expect("a sound mesh");
    }
    octree
}

fn milliseconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64() * 1e3
}

fn least<T>(work: impl Fn() -> T) -> f64 {
    (0..TRIALS).map(|_| milliseconds(&work)).fold(f64::INFINITY, f64::min)
}
