//! A solution by radiosity on the workstation, with both processes: the host solves, the machine shades whatever view
//! its dials set.

use glam::DMat4;
use host::{
    picture::Picture,
    plan::Plan,
    render::{RenderOrder, Renderer, Watch, World, indirect::IndirectLight, radiosity::Radiosity, scan_line::ScanLine},
    scene::{Prepared, Projection, View},
    script,
    workstation::{Session, Timeouts},
};
use std::{fs, path::Path, sync::Arc, time::Duration};
use tests::{Machine, run};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const LIMIT: Duration = Duration::from_secs(300);
/// The raster screen, and the square in its middle that shows what the vector screen does.
const WIDTH: usize = 640;
const SIDE: usize = 480;
/// Dials that have stood still for 0.3 s, and the picture of some thousand polygons, take fewer frames.
const SETTLED: &str = "frames 120";

/// The Cornell box in large elements, as large as the square.
fn cornell() -> String {
    include_str!("../../host/scenes/cornell.rhai")
        .replace("image(512, 512)", "image(480, 480)")
        .replace("radiosity();", "radiosity(#{ error: 0.05, finest: 0.02 });")
}

/// The square of the raster screen, row by row from the top.
fn raster(machine: &mut Machine, folder: &Path) -> Vec<[u8; 3]> {
    let file = folder.join("raster.png");
    machine.operator_command(SETTLED);
    machine.operator_command(&format!("picture raster {}", file.display()));
    let image = image::open(file).unwrap().to_rgb8();
    let rows = image.pixels().map(|pixel| pixel.0).collect::<Vec<_>>();
    let left = (WIDTH - SIDE) / 2;
    rows.chunks_exact(WIDTH).flat_map(|row| row[left..left + SIDE].to_vec()).collect()
}

/// The mean of the differences of all bytes, and the part of the pixels that differ by more than 8.
fn difference(a: &[[u8; 3]], b: &[[u8; 3]]) -> (f64, f64) {
    assert_eq!(a.len(), b.len());
    let of = |(a, b): (&[u8; 3], &[u8; 3])| [0, 1, 2].map(|k| a[k].abs_diff(b[k]));
    let all: Vec<[u8; 3]> = a.iter().zip(b).map(of).collect();
    let mean = all.iter().flatten().map(|d| f64::from(*d)).sum::<f64>() / (3 * all.len()) as f64;
    let far = all.iter().filter(|d| d.iter().any(|d| *d > 8)).count();
    (mean, far as f64 / all.len() as f64)
}

/// What the host shows of its solution.
fn shown(solution: &Arc<Radiosity>, prepared: &Prepared, plan: &Plan, matrix: &DMat4) -> Vec<[u8; 3]> {
    let view = View::Projection(Projection::from_workstation(matrix, false));
    let world = World::new(prepared, plan).unwrap();
    let scan_line = ScanLine::showing(Arc::clone(solution) as Arc<dyn IndirectLight>, world, plan);
    let order = RenderOrder::of(&prepared.settings);
    let picture: Picture = scan_line.render(&view, &order, &Watch::NOBODY).unwrap().picture;
    picture.to_srgb8().as_chunks::<3>().0.to_vec()
}

#[test]
fn the_light_of_a_solution_is_seen_on_the_workstation_from_wherever_the_dials_turn_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("box.rhai"), cornell()).unwrap();
    let mut machine = Machine::start(PS340, &[]);
    let to = format!("tcp:{}", machine.line);
    let ended = run(PERIS, &["show", "box.rhai", "--radiosity", "--once", "--json", "--to", &to], &[], folder, LIMIT);
    assert_eq!(ended.code, Some(0), "{}{}", ended.out, ended.errors);
    let sent: serde_json::Value = serde_json::from_str(&ended.out).unwrap();
    let [elements, polygons] = ["elements", "polygons"].map(|key| sent["light"][key].as_u64().unwrap());
    assert!(polygons > 500 && polygons < elements, "{polygons} polygons for {elements} elements");

    let scene = script::evaluate(&cornell(), "box", Path::new(""), &script::Inputs::default()).unwrap().scene;
    let mut prepared = Prepared::new(&scene).unwrap();
    prepared.settings.light.interreflection.count();
    let plan = Plan::new(&prepared, &prepared.view());
    let world = World::new(&prepared, &plan).unwrap();
    let solution = Radiosity::new(&world, &plan, &prepared.settings.radiosity, None, &Watch::NOBODY).unwrap();
    let solution = Arc::new(solution);
    let mut session = Session::attach(&to.parse().unwrap(), Timeouts::default()).unwrap();
    let mut pictures = Vec::new();
    for turn in ["dial 8 0.1", "dial 2 0.08"] {
        machine.operator_command(turn);
        let picture = raster(&mut machine, folder);
        assert!(machine.operator_command("panel").contains("graphics on"), "the vectors are seen again");
        let expected = shown(&solution, &prepared, &plan, &session.view().unwrap());
        let (mean, far) = difference(&picture, &expected);
        println!("{turn}: mean difference {mean:.3} of 255, {:.2} % by more than 8", 100.0 * far);
        assert!(mean < 1.0 && far < 0.02, "{turn}: mean difference {mean}, {far} of the pixels by more than 8");
        pictures.push(picture);
    }
    let (mean, far) = difference(&pictures[0], &pictures[1]);
    assert!(mean > 5.0 && far > 0.2, "the turned picture is another: {mean}, {far}");
    // The left wall of the first picture is red, the right one green.
    let at = |x: usize, y: usize| pictures[0][y * SIDE + x].map(i32::from);
    let ([red, other, _], [another, green, _]) = (at(30, 240), at(450, 240));
    assert!(red > 3 * other && green > another + 20, "{:?} {:?}", at(30, 240), at(450, 240));
}
