//! Boolean operations beside Manifold: the same meshes, one thread, in one run.
//!
//! Every result is checked before it is timed: it is closed, and its volume is that of Manifold to a part in 10^9, or
//! that which is known. Manifold runs through its Python package where that is installed; it gets the same meshes as
//! arrays, and only its operation is timed, not the way there. `THREADS=n` in the environment changes the threads.

use glam::{DAffine3, DVec3};
use host::mesh::{Mesh, bunny};
use host::solid::{Expression, Solid};
use std::time::Instant;

/// Seconds after which no further run begins.
const TIME_LIMIT: f64 = 4.0;
/// Runs of each measurement at least, within that time, and seconds that they take at least together.
const RUNS: usize = 7;
const BUSY: f64 = 0.5;

/// A sphere of about so many triangles: an octahedron divided and rounded, as Manifold makes its own.
fn sphere(triangles: usize, center: DVec3) -> Mesh {
    let n = ((triangles as f64 / 8.0).sqrt().round() as u32).max(1);
    let mut mesh = Mesh::default();
    for octant in 0..8 {
        let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let signs = DVec3::new(sign(0), sign(1), sign(2));
        let first = mesh.vertices.len() as u32;
        for i in 0..=n {
            for j in 0..=n - i {
                let at = DVec3::new(f64::from(i), f64::from(j), f64::from(n - i - j));
                // Evenly on the sphere: sines along the arcs.
                let warped = (at / f64::from(n) * std::f64::consts::FRAC_PI_2).to_array().map(f64::sin);
                mesh.vertices.push(DVec3::from(warped).normalize() * signs + center);
            }
        }
        let row = |i: u32| first + i * (n + 1) - i * (i.max(1) - 1) / 2;
        let at = |i: u32, j: u32| row(i) + j;
        let mut push = |a: u32, b: u32, c: u32| {
            mesh.triangles.push(if signs.element_product() > 0.0 { [a, b, c] } else { [a, c, b] });
        };
        for i in 0..n {
            for j in 0..n - i {
                push(at(i, j), at(i + 1, j), at(i, j + 1));
                if j + 1 < n - i {
                    push(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                }
            }
        }
    }
    mesh.welded()
}

fn cuboid(low: DVec3, high: DVec3) -> Mesh {
    let faces = host::surface::box_faces(low, high);
    host::surface::tessellate(&faces, host::surface::Tolerance::new(1.0, 90.0)).expect("six flat faces")
}

fn moved(mesh: &Mesh, by: DAffine3) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.vertices.iter_mut().for_each(|v| *v = by.transform_point3(*v));
    mesh.corner_normals.clear();
    mesh
}

/// A case: what it is called, its operands, and how they are combined.
struct Case {
    name: String,
    meshes: Vec<Mesh>,
    /// The first less the others, or all together.
    is_difference: bool,
}

impl Case {
    fn expression(&self) -> Expression {
        let all = |range: std::ops::Range<usize>| Expression::Union(range.map(Expression::Operand).collect());
        match self.is_difference {
            true => Expression::difference(Expression::Operand(0), all(1..self.meshes.len())),
            false => all(0..self.meshes.len()),
        }
    }
}

/// The holes of a Menger sponge of a level in the unit cube: bars along each axis, of all sizes.
fn sponge(level: u32) -> Vec<Mesh> {
    let mut meshes = vec![cuboid(DVec3::ZERO, DVec3::ONE)];
    for step in 1..=level {
        let count = 3_u32.pow(step - 1);
        let width = 1.0 / f64::from(3 * count);
        for axis in 0..3 {
            for (u, v) in (0..count).flat_map(|u| (0..count).map(move |v| (u, v))) {
                let is_open = |mut u: u32, mut v: u32| {
                    let mut open = false;
                    while u > 0 || v > 0 {
                        open |= u % 3 == 1 && v % 3 == 1;
                        (u, v) = (u / 3, v / 3);
                    }
                    open
                };
                if is_open(u, v) {
                    continue;
                }
                let mut low = DVec3::splat(-0.1);
                let mut high = DVec3::splat(1.1);
                for (axis, k) in [((axis + 1) % 3, u), ((axis + 2) % 3, v)] {
                    (low[axis], high[axis]) = (f64::from(3 * k + 1) * width, f64::from(3 * k + 2) * width);
                }
                meshes.push(cuboid(low, high));
            }
        }
    }
    meshes
}

fn cases(large: bool) -> Vec<Case> {
    let mut cases = Vec::new();
    let sizes: &[usize] = if large { &[1_000, 10_000, 100_000, 1_000_000] } else { &[1_000, 10_000, 100_000] };
    for &size in sizes {
        let meshes = vec![sphere(size, DVec3::ZERO), sphere(size, DVec3::new(0.5, 0.3, 0.2))];
        cases.push(Case { name: format!("sphere less sphere, 2 x {size}"), meshes, is_difference: true });
    }
    let bunny = bunny().expect("it ships");
    let shifted = moved(&bunny, DAffine3::from_translation(DVec3::new(0.1, 0.05, 0.02)));
    cases.push(Case { name: "bunny less shifted bunny".into(), meshes: vec![bunny, shifted], is_difference: true });
    for size in [1_000, 10_000] {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let meshes = (0..100).map(|_| sphere(size, DVec3::new(random(), random(), random()) * 5.0)).collect();
        cases.push(Case { name: format!("union of 100 spheres of {size}"), meshes, is_difference: false });
    }
    for level in [1, 2, 3, 4] {
        cases.push(Case { name: format!("Menger sponge {level}"), meshes: sponge(level), is_difference: true });
    }
    cases
}

/// The shortest of several runs, seconds.
fn best(mut work: impl FnMut()) -> f64 {
    let begin = Instant::now();
    let mut shortest = f64::INFINITY;
    for run in 0.. {
        let elapsed = begin.elapsed().as_secs_f64();
        if run > 0 && elapsed > TIME_LIMIT || run >= RUNS && elapsed > BUSY {
            break;
        }
        let start = Instant::now();
        work();
        shortest = shortest.min(start.elapsed().as_secs_f64());
    }
    shortest
}

/// Seconds and volume by Manifold; `None` if it is not installed.
fn manifold(case: &Case, folder: &std::path::Path) -> Option<(f64, f64, usize)> {
    const PROGRAM: &str = r#"
import itertools, sys, time, numpy as np
try:
    import manifold3d as m
except ImportError:
    sys.exit(3)
folder, count, difference = sys.argv[1], int(sys.argv[2]), sys.argv[3] == "1"
solids = []
for k in range(count):
    v = np.fromfile(f"{folder}/{k}.v", dtype=np.float64).reshape(-1, 3)
    t = np.fromfile(f"{folder}/{k}.t", dtype=np.uint64).reshape(-1, 3)
    solids.append(m.Manifold(m.Mesh64(v, t)))
for s in solids: s.num_tri()
best, begin = 1e9, time.perf_counter()
for run in itertools.count():
    elapsed = time.perf_counter() - begin
    if run and elapsed > 4 or run >= 7 and elapsed > 0.5: break
    start = time.perf_counter()
    op = m.OpType.Subtract if difference else m.OpType.Add
    result = m.Manifold.batch_boolean(solids, op)
    n = result.num_tri()
    best = min(best, time.perf_counter() - start)
print(best, result.volume(), n)
"#;
    for (k, mesh) in case.meshes.iter().enumerate() {
        let vertices: Vec<u8> = mesh.vertices.iter().flat_map(|v| v.to_array()).flat_map(f64::to_le_bytes).collect();
        let corners = mesh.triangles.as_flattened().iter().map(|&i| u64::from(i));
        std::fs::write(folder.join(format!("{k}.v")), vertices).ok()?;
        std::fs::write(folder.join(format!("{k}.t")), corners.flat_map(u64::to_le_bytes).collect::<Vec<_>>()).ok()?;
    }
    let threads = std::env::var("THREADS").unwrap_or("1".into());
    let output = std::process::Command::new("python3")
        .args(["-c", PROGRAM])
        .arg(folder)
        .args([case.meshes.len().to_string(), u8::from(case.is_difference).to_string()])
        .envs([("OMP_NUM_THREADS", threads.as_str()), ("TBB_NUM_THREADS", threads.as_str())])
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let mut words = text.split_whitespace();
    Some((words.next()?.parse().ok()?, words.next()?.parse().ok()?, words.next()?.parse().ok()?))
}

fn row(case: &Case, folder: &std::path::Path) {
    let start = Instant::now();
    let solids: Vec<Solid> =
        case.meshes.iter().map(|mesh| Solid::resolved(mesh.clone()).expect("the meshes are closed").0).collect();
    let import = start.elapsed().as_secs_f64();
    let operands: Vec<&Solid> = solids.iter().collect();
    let expression = case.expression();
    let (result, outcome) = Solid::evaluate(&operands, &expression).expect("it settles");
    let volume = result.mesh().signed_volume();
    let check = Solid::new(result.mesh().clone());
    assert!(check.is_ok(), "{}: {}", case.name, check.unwrap_err());
    let time = best(|| _ = Solid::evaluate(&operands, &expression));
    print!(
        "{:32} {:9.2} ms (import {:8.2}) {:9} triangles",
        case.name,
        time * 1e3,
        import * 1e3,
        result.mesh().triangles.len()
    );
    match manifold(case, folder) {
        Some((peer, peer_volume, triangles)) => {
            let gap = (volume / peer_volume - 1.0).abs();
            println!(
                "   Manifold {:9.2} ms {triangles:9}   ratio {:.2}   volumes differ by {gap:.0e}",
                peer * 1e3,
                time / peer
            );
        }
        None => println!("   Manifold is not installed"),
    }
    println!("    {:?}", outcome.counts);
}

fn main() {
    let threads = std::env::var("THREADS").ok().and_then(|word| word.parse().ok()).unwrap_or(1);
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() else { return };
    let Ok(folder) = tempfile::tempdir() else { return };
    println!("Boolean operations, {threads} threads, the shortest of {RUNS} runs or more");
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    pool.install(|| {
        for case in cases(!wanted.iter().any(|w| w == "small")) {
            if wanted.iter().all(|word| word == "small" || case.name.contains(word.as_str())) {
                row(&case, folder.path());
            }
        }
    });
}
