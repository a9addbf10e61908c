//! Rays through instances per second, and what an instance takes, beside Embree on the same placements and rays.
//!
//! Balls of 1,024 triangles, turned and scaled by chance, fill a cube or lie on a plane. Hits are counted on both sides
//! before the figures count. Ours and Embree's take turns; the figure is the median of the ratios. Embree's library comes
//! with the Python package `embreex`, and a C compiler makes the program that asks it. `INSTANCES` sets how many there
//! are (100,000), `TURNS` how often both take turns (5).

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use host::numeric::sampling::{RandomStream, cosine_hemisphere, sphere};
use host::octree::{Instance, InstanceOctree, Octree, OctreeSettings, PlacementForm, Prototype, Ray};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Rays of a set, or a few less.
const RAYS: usize = 200_000;
/// Columns of quadrangles of a ball, twice its rows.
const COLUMNS: u32 = 32;
/// Passes over each set; the median counts.
const PASSES: usize = 5;

/// Rays that are asked in the same way.
struct RaySet {
    name: &'static str,
    /// Whether any hit is enough.
    any: bool,
    rays: Vec<(Ray, f64)>,
}

/// Millions of rays a second, and how many hit.
#[derive(Clone, Copy)]
struct Rate {
    rate: f64,
    hits: usize,
}

fn main() {
    let number = |name: &str, otherwise: usize| {
        std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise).max(1)
    };
    let (count, turns) = (number("INSTANCES", 100_000), number("TURNS", 5));
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let embree = embree(folder.path());
    if let Err(reason) = &embree {
        println!("Embree: {reason}");
    }
    let (vertices, triangles) = ball();
    let octree = Arc::new(Octree::build(&vertices, &triangles, &OctreeSettings::default()).expect("few triangles"));
    for flat in [false, true] {
        for form in [PlacementForm::Similar, PlacementForm::Affine] {
            let start = processor_seconds();
            let instance = |number: usize| placed(number, count, flat);
            let prototypes = vec![Prototype::surface(Arc::clone(&octree), 0)];
            let tree = InstanceOctree::new(prototypes, form, count, instance).expect("sound placements");
            let built = processor_seconds() - start;
            let place = if flat { "on a plane" } else { "in a cube" };
            let bytes = tree.costs().bytes as f64 / count as f64;
            println!("{count} {place}, {form:?}: built in {built:.2} s of all threads, {bytes:.1} bytes each");
            let sets = sets(&tree, flat);
            let file = folder.path().join("instances");
            write(&file, &vertices, &triangles, &tree, &sets).expect("written");
            against(&tree, &sets, embree.as_deref().ok().map(|program| (program, &*file)), turns);
        }
    }
}

/// Takes the times of all sets, in turns with Embree.
fn against(tree: &InstanceOctree, sets: &[RaySet], embree: Option<(&Path, &Path)>, turns: usize) {
    for array in ["0", "1"] {
        let mut ratios = vec![Vec::new(); sets.len()];
        let mut rates = vec![Vec::new(); sets.len()];
        let mut costs = String::new();
        for _ in 0..turns {
            let ours: Vec<Rate> = sets.iter().map(|set| measured(tree, set)).collect();
            let theirs = embree.map(|(program, file)| asked(program, file, array));
            for (set, own) in ours.iter().enumerate() {
                rates[set].push(own.rate);
                let Some((told, theirs)) = &theirs else { continue };
                let other = theirs[set];
                let apart = own.hits.abs_diff(other.hits);
                assert!(apart * 1000 <= own.hits.max(1000), "{}: {} hits, {}", sets[set].name, own.hits, other.hits);
                ratios[set].push(own.rate / other.rate);
                costs.clone_from(told);
            }
        }
        let named = if array == "1" { "an array of instances" } else { "a geometry each" };
        if embree.is_some() {
            println!("  Embree, {named}: {costs}");
        }
        for (set, (rates, ratios)) in sets.iter().zip(rates.into_iter().zip(ratios)) {
            let beside = if ratios.is_empty() { String::new() } else { format!(", {:.2} of it", median(ratios)) };
            println!("    {:<8} {:.2} million a second{beside}", set.name, median(rates));
        }
        if embree.is_none() {
            break;
        }
    }
}

/// A ball of radius 1/2.
fn ball() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let rows = COLUMNS / 2;
    let point = |row: u32, column: u32| {
        let (polar, turn) = (PI * f64::from(row) / f64::from(rows), TAU * f64::from(column) / f64::from(COLUMNS));
        DVec3::new(polar.sin() * turn.cos(), polar.cos(), polar.sin() * turn.sin()) * 0.5
    };
    let vertices = (0..=rows).flat_map(|row| (0..COLUMNS).map(move |column| point(row, column))).collect();
    let corner = |row: u32, column: u32| row * COLUMNS + column % COLUMNS;
    let pair = |row: u32, column: u32| {
        let [a, b] = [corner(row, column), corner(row, column + 1)];
        let [c, d] = [corner(row + 1, column), corner(row + 1, column + 1)];
        [[a, c, b], [b, c, d]]
    };
    let triangles = (0..rows).flat_map(|row| (0..COLUMNS).flat_map(move |column| pair(row, column))).collect();
    (vertices, triangles)
}

/// A placement by chance, one for each unit of volume or area.
fn placed(number: usize, count: usize, flat: bool) -> Instance {
    let mut random = RandomStream::new(1, number as u64);
    let side = if flat { (count as f64).sqrt() } else { (count as f64).cbrt() };
    let rotation = DQuat::from_axis_angle(sphere(random.point()), random.uniform() * TAU);
    let scale = 0.5 + random.uniform() * 0.5;
    let height = if flat { 0.0 } else { random.uniform() };
    let translation = DVec3::new(random.uniform(), height, random.uniform()) * side;
    let placement = DAffine3 { matrix3: DMat3::from_quat(rotation) * scale, translation };
    Instance { prototype: 0, variation: 0, placement }
}

/// Rays of a camera, rays that leave what these hit, rays from there to the sun, and any.
fn sets(tree: &InstanceOctree, flat: bool) -> Vec<RaySet> {
    let (bounds, mut random) = (tree.bounds(), RandomStream::new(5, 9));
    let (size, middle) = (bounds.size(), bounds.center());
    let side = size.max_element();
    let eye = middle + if flat { DVec3::new(0.1, 0.15, 0.6) } else { DVec3::new(0.3, 0.4, 1.2) } * side;
    let ahead = (middle - eye).normalize();
    let right = ahead.cross(DVec3::Y).normalize();
    let up = right.cross(ahead);
    let columns = (RAYS as f64).sqrt() as usize;
    let across = |k: usize| 0.4 * ((k as f64 + 0.5) / columns as f64 * 2.0 - 1.0);
    let pixel = |k: usize| ahead + right * across(k % columns) + up * across(k / columns);
    let seen = (0..columns * columns).map(|k| (Ray { origin: eye, direction: pixel(k) }, f64::INFINITY));
    let primary: Vec<(Ray, f64)> = seen.collect();
    let (mut diffuse, mut shadow) = (Vec::new(), Vec::new());
    for (ray, _) in &primary {
        let Some(hit) = tree.closest(ray, 0.0, f64::INFINITY) else { continue };
        // A ball's normal points from its middle.
        let normal = (ray.at(hit.hit.t) - tree.placed(&hit.path).placement.translation).normalize();
        let origin = ray.at(hit.hit.t) + normal * (1e-2 + 1e-5 * side);
        diffuse.push((Ray { origin, direction: cosine_hemisphere(random.point(), normal) }, f64::INFINITY));
        shadow.push((Ray { origin, direction: DVec3::new(0.4, 0.8, 0.3) * (3.0 * side) }, 1.0));
    }
    let mut any = || {
        let origin = bounds.min + size * DVec3::new(random.uniform(), random.uniform(), random.uniform());
        (Ray { origin, direction: sphere(random.point()) }, f64::INFINITY)
    };
    let random: Vec<(Ray, f64)> = (0..RAYS).map(|_| any()).collect();
    let set = |name, any, rays| RaySet { name, any, rays };
    vec![
        set("primary", false, primary),
        set("diffuse", false, diffuse),
        set("shadow", true, shadow),
        set("random", false, random),
    ]
}

fn measured(tree: &InstanceOctree, set: &RaySet) -> Rate {
    let mut hits = 0;
    let pass = |hits: &mut usize| {
        let start = processor_seconds();
        let hit = |(ray, t_max): &&(Ray, f64)| match set.any {
            true => tree.occluded(ray, 0.0, *t_max),
            false => tree.closest(ray, 0.0, *t_max).is_some(),
        };
        *hits = set.rays.iter().filter(hit).count();
        processor_seconds() - start
    };
    let seconds = median((0..PASSES).map(|_| pass(&mut hits)).collect());
    Rate { rate: set.rays.len() as f64 / seconds / 1e6, hits }
}

/// Compiles the program that asks Embree.
///
/// # Errors
/// A line that says why there is none.
fn embree(folder: &Path) -> Result<PathBuf, String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let find = "import embreex, glob, os; print(glob.glob(os.path.dirname(embreex.__file__) + '.libs/libembree4*')[0])";
    let found = Command::new(python).args(["-c", find]).output().map_err(|error| error.to_string())?;
    let library = PathBuf::from(String::from_utf8_lossy(&found.stdout).trim());
    let beside = library.parent().filter(|_| found.status.success()).ok_or("embreex is not installed")?;
    let (source, program) = (folder.join("embree.c"), folder.join("embree"));
    std::fs::write(&source, include_str!("instances/embree.c")).map_err(|error| error.to_string())?;
    let compiled = Command::new("cc")
        .arg("-O2")
        .args([&source, &library])
        .arg("-o")
        .arg(&program)
        .arg(format!("-Wl,-rpath,{},--allow-shlib-undefined", beside.display()))
        .output()
        .map_err(|error| format!("cc: {error}"))?;
    match compiled.status.success() {
        true => Ok(program),
        false => Err(String::from_utf8_lossy(&compiled.stderr).lines().next().unwrap_or("cc failed").to_owned()),
    }
}

/// What Embree makes of a file: its costs in words, and the rates of all sets.
fn asked(program: &Path, file: &Path, array: &str) -> (String, Vec<Rate>) {
    let output = Command::new(program).arg(file).arg(array).output().expect("the program that was compiled");
    assert!(output.status.success(), "{}", output.status);
    let text = String::from_utf8_lossy(&output.stdout);
    let rows: Vec<Vec<f64>> =
        text.lines().map(|line| line.split(' ').filter_map(|word| word.parse().ok()).collect()).collect();
    let costs = format!("built in {:.2} s of one thread, {:.0} bytes each", rows[0][0], rows[0][1]);
    (costs, rows[1..].iter().map(|row| Rate { rate: row[0], hits: row[1] as usize }).collect())
}

fn write(
    file: &Path,
    vertices: &[DVec3],
    triangles: &[[u32; 3]],
    tree: &InstanceOctree,
    sets: &[RaySet],
) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(std::fs::File::create(file)?);
    let mut put = |numbers: &[f64]| numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()));
    put(&[vertices.len(), triangles.len(), tree.count(), sets.len()].map(|count| count as f64))?;
    sets.iter().try_for_each(|set| put(&[set.rays.len() as f64, f64::from(u8::from(set.any))]))?;
    vertices.iter().try_for_each(|vertex| put(&vertex.to_array()))?;
    triangles.iter().try_for_each(|triangle| put(&triangle.map(f64::from)))?;
    tree.stored_instances().try_for_each(|(_, instance)| put(&instance.placement.to_cols_array()))?;
    for (Ray { origin, direction }, t_max) in sets.iter().flat_map(|set| &set.rays) {
        put(&origin.to_array())?;
        put(&direction.to_array())?;
        put(&[t_max.min(1e30)])?;
    }
    out.flush()
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Processor time of all threads.
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
