//! Subdivision of the bunny beside OpenSubdiv on the same mesh, where its library and a C++ compiler are installed.
//!
//! First proves the result: it is closed, of the right genus and size, and within the box of the input. Then the best
//! of several runs counts: processor seconds of one thread, or seconds of the wall for all threads. Two steps make as
//! many vertices and faces as two levels of Catmull-Clark. `cargo bench -p tests --bench subdivision`

use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use host::mesh::{Mesh, bunny};
use host::subdivision::Polyhedron;

/// Runs of each case; the best counts.
const RUNS: usize = 7;

fn main() {
    let mesh = bunny().expect("it ships");
    // `cargo bench` passes `--bench`; without it one step proves the result.
    let (runs, steps) = if std::env::args().any(|argument| argument == "--bench") { (RUNS, 2) } else { (1, 1) };
    prove(&mesh, steps);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread can be started");
    println!("{:<44} {:>9} {:>9} {:>9}   vertices, faces", "seconds", "topology", "rest", "total");
    for steps in 1..=steps {
        let (linking, _) = one.install(|| best(runs, || Polyhedron::from_mesh(&mesh)));
        let start = Polyhedron::from_mesh(&mesh).expect("the bunny is sound");
        for (name, pool) in [("one thread", Some(&one)), ("all threads", None)] {
            let run = || best(runs, || start.subdivided(steps));
            let (time, result) = pool.map_or_else(run, |pool| pool.install(run));
            let result = result.expect("the result is not too large");
            let name = format!("ours, {steps} steps, {name}");
            row(&name, linking, time, result.points().len(), result.face_count());
            let limit = || best(runs, || result.limit().expect("nothing is sharp"));
            let (time, limit) = pool.map_or_else(limit, |pool| pool.install(limit));
            println!("{:<44} {:>9} {:>9.4}", format!("  its {} limit triangles", limit.triangles.len()), "", time);
        }
    }
    for tolerance in [0.01, 0.001] {
        let start = Polyhedron::from_mesh(&mesh).expect("the bunny is sound");
        let (time, result) = one.install(|| best(1, || start.tessellated(tolerance)));
        let count = result.expect("the tolerance can be met").triangles.len();
        println!("{:<44} {:>9} {time:>9.4}", format!("ours, within {tolerance}, {count} triangles"), "");
    }
    match opensubdiv(&mesh, steps) {
        Ok(text) => text.lines().for_each(print_rival),
        Err(why) => println!("OpenSubdiv: {why}"),
    }
}

fn row(name: &str, topology: f64, rest: f64, vertices: usize, faces: usize) {
    println!("{name:<44} {topology:>9.4} {rest:>9.4} {:>9.4}   {vertices}, {faces}", topology + rest);
}

fn print_rival(line: &str) {
    let fields: Vec<&str> = line.split(' ').collect();
    if let [name, topology, rest, vertices, faces] = fields[..] {
        let number = |text: &str| text.parse().unwrap_or(f64::NAN);
        let count = |text: &str| text.parse().unwrap_or(0);
        row(&format!("OpenSubdiv, {name}"), number(topology), number(rest), count(vertices), count(faces));
    }
}

fn prove(mesh: &Mesh, steps: usize) {
    let start = Polyhedron::from_mesh(mesh).expect("the bunny is sound");
    let result = start.subdivided(steps).expect("the result is not too large");
    let sides = 3 * mesh.triangles.len() * 4_usize.pow(steps as u32 - 1);
    assert!(result.is_closed());
    assert_eq!(result.points().len(), sides);
    assert_eq!(result.points().len() + result.face_count(), 2 * sides + 2, "Euler's number is not 2");
    let limit = result.limit().expect("nothing is sharp");
    assert!(limit.is_closed());
    let [inner, outer] = [limit.bounds(), mesh.bounds()].map(|bounds| bounds.expect("there are vertices"));
    assert!(inner.min.cmpge(outer.min).all() && inner.max.cmple(outer.max).all());
    let ratio = limit.signed_volume() / mesh.signed_volume();
    assert!((0.99..1.0).contains(&ratio), "the volume changes by {ratio}");
}

/// The best time of several runs, and the last result.
fn best<T>(runs: usize, mut run: impl FnMut() -> T) -> (f64, T) {
    let mut time = f64::INFINITY;
    let mut result = None;
    for _ in 0..runs {
        drop(result.take());
        let start = Stopwatch::start();
        result = Some(black_box(run()));
        time = time.min(start.seconds());
    }
    (time, result.expect("there is a run"))
}

/// Measures seconds that this thread had the processor, where it has no others to help it.
struct Stopwatch {
    processor: f64,
    wall: Instant,
}

impl Stopwatch {
    fn start() -> Stopwatch {
        Stopwatch { processor: processor_seconds(), wall: Instant::now() }
    }

    fn seconds(&self) -> f64 {
        let is_alone = rayon::current_thread_index().is_some() && rayon::current_num_threads() == 1;
        if is_alone { processor_seconds() - self.processor } else { self.wall.elapsed().as_secs_f64() }
    }
}

/// Seconds that this thread has had the processor.
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// What OpenSubdiv's program prints.
fn opensubdiv(mesh: &Mesh, levels: usize) -> Result<String, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let [program, data] = ["program", "mesh"].map(|name| folder.path().join(name));
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/subdivision/opensubdiv.cpp");
    let compiled = Command::new("c++").args(["-O3", "-o"]).arg(&program).arg(source).arg("-losdCPU").output();
    if !compiled.map_err(|error| format!("no C++ compiler: {error}"))?.status.success() {
        return Err("not installed".to_owned());
    }
    let numbers = [mesh.vertices.len() as f64, mesh.triangles.len() as f64].into_iter();
    let numbers = numbers.chain(mesh.vertices.iter().flat_map(|vertex| vertex.to_array()));
    let numbers = numbers.chain(mesh.triangles.iter().flatten().map(|&corner| f64::from(corner)));
    let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    std::fs::write(&data, bytes).map_err(|error| error.to_string())?;
    let output = Command::new(&program).arg(&data).arg(levels.to_string()).output();
    Ok(String::from_utf8_lossy(&output.map_err(|error| error.to_string())?.stdout).into_owned())
}
