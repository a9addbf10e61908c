//! The main job with both processes: what is shown, set with dials, read back, rendered and shown again.

use glam::{DMat4, DVec3};
use host::{
    picture::Picture,
    picture::display::DisplayTransform,
    production::{Production, difference, view_of_dials},
    render::{RenderOrder, Watch},
    script,
    workstation::{Drawing, DrawnEdges, Session, Timeouts},
};
use std::{collections::BTreeMap, fs, path::Path, time::Duration};
use tests::{Ended, Machine, run};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const LIMIT: Duration = Duration::from_secs(300);

/// A teapot alone, so that it has a silhouette.
const SCENE: &str = r#"
    image(512, 512);
    samples(4);
    teapot().rotate("y", 20);
    directional_light(#{ direction: [0, 0, -1], irradiance: 1 });
    camera(#{ from: [0, 4, 14], at: [0, 1.5, 0], field_of_view: 34 });
"#;

fn peris(arguments: &[&str], folder: &Path) -> Ended {
    run(PERIS, arguments, &[("PERIS_PS340", PS340)], folder, LIMIT)
}

fn begin(machine: &Machine, scene: &host::scene::Scene, drawing: &Drawing) -> Production {
    let line = format!("tcp:{}", machine.line).parse().unwrap();
    Production::begin(scene, Session::attach(&line, Timeouts::default()).unwrap(), drawing).unwrap()
}

/// All pictures of a folder.
fn pictures(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let pictures = entries.filter(|p| p.extension().is_some_and(|e| e == "png" || e == "exr"));
    pictures.map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), fs::read(p).unwrap())).collect()
}

#[test]
fn the_demo_leaves_its_files_and_makes_the_same_bytes_with_one_thread_and_with_two() {
    let folder = tempfile::tempdir().unwrap();
    let mut made = Vec::new();
    for threads in ["1", "2"] {
        let ended = peris(&["demo", "--quick", "--samples", "2", "--threads", threads, "-o", threads], folder.path());
        assert_eq!(ended.code, Some(0), "{}{}", ended.out, ended.errors);
        assert!(ended.out.contains("workstation: process") && ended.out.contains("host: process"), "{}", ended.out);
        let contents = fs::read_to_string(folder.path().join(threads).join("CONTENTS.txt")).unwrap();
        for name in ["vector-before.png", "vector-after.png", "raytraced.png", "raytraced.exr", "raster.png"] {
            assert!(contents.contains(name), "{contents}");
        }
        made.push(pictures(&folder.path().join(threads)));
    }
    assert_eq!(made[0].len(), 5);
    assert!(made[0] == made[1], "the pictures differ");
    assert!(made[0]["vector-before.png"] != made[0]["vector-after.png"]);
    let raster = image::load_from_memory(&made[0]["raster.png"]).unwrap().to_rgb8();
    let traced = image::load_from_memory(&made[0]["raytraced.png"]).unwrap().to_rgb8();
    assert_eq!(raster.dimensions(), (640, 480));
    assert!(raster == traced, "the raster screen shows the image to the byte");
}

#[test]
fn a_study_leaves_table_and_plot() {
    let folder = tempfile::tempdir().unwrap();
    let ended = peris(
        &["study", "render", "teapot", "--knob", "samples", "--width", "32", "--samples", "16", "--settings", "3"],
        folder.path(),
    );
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    for name in ["teapot-render.csv", "teapot-render-samples.svg", "teapot-render-samples.png"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
}

#[test]
fn the_view_that_dials_set_reads_back_as_its_closed_form() {
    let scene = script::evaluate(SCENE, "silhouette", Path::new(""), &script::Inputs::default()).unwrap().scene;
    let mut machine = Machine::start(PS340, &[]);
    let mut production = begin(&machine, &scene, &Drawing::default());
    let turns = [0.13, -0.37, 0.05, 0.4, 0.02, -0.01, 0.03];
    for (dial, turn) in (1..).zip(turns) {
        machine.operator_command(&format!("dial {dial} {turn}"));
    }
    machine.operator_command("idle");
    let matrix = production.view().unwrap();
    let expected = view_of_dials(production.initial(), &turns).unwrap();
    let off = difference(&matrix, &expected);
    assert!(off < 1e-6, "off by {off}: {matrix:?} is not {expected:?}");
    let before = view_of_dials(production.initial(), &[0.0; 7]).unwrap();
    assert!(difference(&matrix, &before) > 0.1, "the dials did something");
    production.reset().unwrap();
    machine.operator_command("idle");
    assert!(difference(&production.view().unwrap(), &before) < 1e-6, "the reset undoes it");
}

#[test]
fn a_scene_that_is_shown_as_facets_is_rendered_by_the_machine_itself() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pot.rhai"), SCENE).unwrap();
    let mut machine = Machine::start(PS340, &[]);
    let to = format!("tcp:{}", machine.line);
    let ended = peris(&["show", "pot.rhai", "--once", "--facets", "--tolerance", "0.01", "--to", &to], folder.path());
    assert_eq!(ended.code, Some(0), "{}{}", ended.out, ended.errors);
    let strokes = |machine: &mut Machine| {
        let file = folder.path().join("strokes.txt");
        machine.operator_command(&format!("picture vector {}", file.display()));
        fs::read_to_string(file).unwrap().lines().count()
    };
    let mut host = machine.attach();
    host.send("ENDED := F:PRINT; CONNECT PERIS.SHADE<1>:<1>ENDED; CONNECT ENDED<1>:<1>HOST_MESSAGE;");
    host.synchronize();
    let all = strokes(&mut machine);
    host.send("SEND FIX(4) TO <1>PERIS.SHADE;");
    assert_eq!(host.message(), "TRUE", "hidden lines are removed");
    let seen = strokes(&mut machine);
    assert!(seen > 100 && seen < all * 3 / 4, "{seen} of {all} strokes are seen");
    host.send("SEND FIX(8) TO <1>PERIS.SHADE;");
    assert_eq!(host.message(), "TRUE", "the polygons are shaded");
    let file = folder.path().join("shaded.png");
    machine.operator_command(&format!("picture raster {}", file.display()));
    let image = image::open(file).unwrap().to_rgb8();
    let lit = image.pixels().filter(|pixel| pixel.0.iter().any(|byte| *byte > 60)).count();
    assert!((20_000..200_000).contains(&lit), "{lit} of 307,200 pixels are lit");
}

#[test]
fn a_scene_that_is_converted_to_commands_plays_on_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pot.rhai"), SCENE).unwrap();
    let ended = peris(&["convert", "pot.rhai", "pot.ps300", "--tolerance", "0.01"], folder.path());
    assert_eq!(ended.code, Some(0), "{}{}", ended.out, ended.errors);
    let steps = "ENDED := F:PRINT; CONNECT PERIS.SHADE<1>:<1>ENDED; CONNECT ENDED<1>:<1>HOST_MESSAGE;\n\
                 SEND FIX(7) TO <1>PERIS.SHADE;\n@ expect 'TRUE' within 6000\n";
    fs::write(folder.path().join("steps.play"), steps).unwrap();
    let played = run(PS340, &["play", "pot.ps300", "steps.play"], &[], folder.path(), LIMIT);
    assert_eq!(played.code, Some(0), "{}{}", played.out, played.errors);
    let simpler = peris(&["convert", "pot.rhai", "pot.stl", "--triangles", "500"], folder.path());
    assert_eq!(simpler.code, Some(0), "{}{}", simpler.out, simpler.errors);
    assert!(simpler.out.contains(" 500 triangles"), "{}", simpler.out);
    let refused = peris(&["convert", "pot.rhai", "pot.ps300", "--triangles", "500"], folder.path());
    assert!(refused.code == Some(2) && refused.errors.contains("--triangles is for a mesh"), "{}", refused.errors);
}

/// What a picture covers: pixels above a threshold, with gaps of up to `gap` pixels closed.
struct Mask {
    size: usize,
    on: Vec<bool>,
}

impl Mask {
    fn spread(&self, radius: isize, value: bool) -> Mask {
        let at = |x: isize, y: isize| {
            let inside = (0..self.size as isize).contains(&x) && (0..self.size as isize).contains(&y);
            inside && self.on[y as usize * self.size + x as usize]
        };
        let pixel = |i: usize| {
            let (x, y) = ((i % self.size) as isize, (i / self.size) as isize);
            let disk = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| (dx, dy)));
            let mut disk = disk.filter(|(dx, dy)| dx * dx + dy * dy <= radius * radius);
            if disk.any(|(dx, dy)| at(x + dx, y + dy) == value) { value } else { !value }
        };
        Mask { size: self.size, on: (0..self.on.len()).map(pixel).collect() }
    }

    fn closed(&self, gap: isize) -> Mask {
        self.spread(gap, true).spread(gap, false)
    }

    fn area(&self) -> usize {
        self.on.iter().filter(|p| **p).count()
    }

    /// How many pixels of this mask are not in the other.
    fn outside(&self, other: &Mask) -> usize {
        self.on.iter().zip(&other.on).filter(|(mine, theirs)| **mine && !**theirs).count()
    }

    fn disagreement(&self, other: &Mask) -> f64 {
        let differ = self.on.iter().zip(&other.on).filter(|(a, b)| a != b).count();
        differ as f64 / self.area() as f64
    }
}

#[test]
fn a_wide_picture_is_the_middle_band_of_the_vector_screen() {
    let wide = SCENE.replace("512, 512", "200, 100");
    let wide = script::evaluate(&wide, "wide", Path::new(""), &script::Inputs::default()).unwrap().scene;
    let square = script::evaluate(SCENE, "square", Path::new(""), &script::Inputs::default()).unwrap().scene;
    let machine = Machine::start(PS340, &[]);
    let mut matrices = [&wide, &square].map(|scene| {
        let mut production = begin(&machine, scene, &Drawing::default());
        production.view().unwrap()
    });
    // Twice as wide as high: the screen shows twice as much, at half the size.
    matrices[0] = DMat4::from_scale(DVec3::new(2.0, 2.0, 1.0)) * matrices[0];
    assert!(difference(&matrices[0], &matrices[1]) < 1e-9, "{matrices:?}");
}

#[test]
fn the_render_of_the_view_has_the_silhouette_of_the_vector_screen() {
    let folder = tempfile::tempdir().unwrap();
    let scene = script::evaluate(SCENE, "silhouette", Path::new(""), &script::Inputs::default()).unwrap().scene;
    let mut machine = Machine::start(PS340, &[]);
    let drawing = Drawing { lines: DrawnEdges::All, tolerance: 1.0 / 4000.0, ..Drawing::default() };
    let mut production = begin(&machine, &scene, &drawing);
    let size = 512;
    let vector = |machine: &mut Machine, name: &str| {
        let file = folder.path().join(name);
        machine.operator_command("idle");
        machine.operator_command(&format!("picture vector {} {size}", file.display()));
        let image = image::open(file).unwrap().to_luma8();
        Mask { size, on: image.pixels().map(|p| p.0[0] > 128).collect() }.closed(6)
    };
    let render = |production: &Production, matrix: &DMat4| {
        let order = RenderOrder::of(&scene.settings);
        let picture: Picture =
            production.render(matrix, &order, &DisplayTransform::LINEAR, &Watch::NOBODY).unwrap().rendering.picture;
        Mask { size, on: picture.coverage8().iter().map(|c| *c > 127).collect() }
    };
    let unturned = vector(&mut machine, "unturned.png");
    machine.operator_command("dial 1 0.15");
    machine.operator_command("dial 2 0.4");
    machine.operator_command("dial 5 0.05");
    let turned = vector(&mut machine, "turned.png");
    let matrix = production.view().unwrap();
    let rendered = render(&production, &matrix);
    assert!(rendered.area() > size * size / 10, "{} pixels", rendered.area());
    // The beam's outline lies about a pixel farther out than that of the surface.
    let off = rendered.disagreement(&turned);
    assert!(off < 0.05, "the silhouettes differ in {off} of the area");
    // Closing the gaps between vectors also fills the sharpest corners between handle and pot, a few pixels.
    let allowed = rendered.area() / 1000;
    assert!(rendered.outside(&turned.spread(1, true)) <= allowed, "the surface shows where no vector is");
    assert!(turned.outside(&rendered.spread(3, true)) <= allowed, "a vector shows where no surface is");
    let wrong = rendered.disagreement(&unturned);
    assert!(wrong > 0.15, "the comparison would not see a wrong view: {wrong}");
}

#[test]
fn killing_the_workstation_leaves_the_host_with_a_clear_message() {
    let folder = tempfile::tempdir().unwrap();
    let mut machine = Machine::start(PS340, &[]);
    let line = format!("tcp:{}", machine.line);
    let path = folder.path().to_path_buf();
    let shown = std::thread::spawn(move || peris(&["show", "teapot", "--to", &line], &path));
    while !machine.reply("show PERIS.MATRIX").starts_with("ok") {
        std::thread::sleep(Duration::from_millis(20));
    }
    machine.kill();
    let ended = shown.join().unwrap();
    assert_eq!(ended.code, Some(4), "{}", ended.errors);
    assert!(ended.errors.contains("the workstation closed the line"), "{}", ended.errors);
}

#[test]
fn keys_of_the_workstation_make_the_host_render_tell_the_view_and_end() {
    let folder = tempfile::tempdir().unwrap();
    let script = SCENE.replace("512, 512", "64, 48");
    fs::write(folder.path().join("small.rhai"), &script).unwrap();
    let mut machine = Machine::start(PS340, &[]);
    let line = format!("tcp:{}", machine.line);
    let path = folder.path().to_path_buf();
    let arguments = ["show", "small.rhai", "--camera", "camera.txt", "--to"];
    let shown = std::thread::spawn(move || peris(&[&arguments[..], &[&line]].concat(), &path));
    while !machine.operator_command("panel").contains("key 1: RENDER") {
        std::thread::sleep(Duration::from_millis(20));
    }
    for order in ["dial 1 0.1", "dial 2 -0.2", "dial 3 0.05", "dial 4 -0.2", "dial 5 0.1", "dial 7 -0.2"] {
        machine.operator_command(order);
    }
    let file = folder.path().join("raster.png");
    let lit = |machine: &mut Machine| {
        machine.operator_command(&format!("picture raster {}", file.display()));
        image::open(&file).unwrap().to_luma8().pixels().any(|p| p.0[0] > 60)
    };
    assert!(!lit(&mut machine));
    machine.operator_command("key 1");
    let end = std::time::Instant::now() + tests::TIMEOUT;
    while !lit(&mut machine) {
        assert!(std::time::Instant::now() < end, "nothing appears on the raster screen");
        std::thread::sleep(Duration::from_millis(20));
    }
    machine.operator_command("key 3");
    while !folder.path().join("camera.txt").exists() {
        assert!(std::time::Instant::now() < end, "nobody tells the view");
        std::thread::sleep(Duration::from_millis(20));
    }
    machine.operator_command("dial 2 0.2");
    machine.operator_command("key 12");
    let ended = shown.join().unwrap();
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    assert!(machine.runs(), "the workstation outlives its host");
    // The view that was rendered was reported first, then, in the end, the one that was set after it.
    let told: Vec<&str> = ended.out.lines().filter(|line| line.starts_with("camera(")).collect();
    assert!(told.len() == 2 && told[0] != told[1], "{}{}", ended.out, ended.errors);
    assert_eq!(fs::read_to_string(folder.path().join("camera.txt")).unwrap().trim_end(), told[1]);
    let own = script.lines().find(|line| line.trim_start().starts_with("camera(")).unwrap();
    fs::write(folder.path().join("again.rhai"), script.replace(own, told[0])).unwrap();
    let ended = peris(&["render", "again.rhai", "-o", "again.png"], folder.path());
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    let [raster, again] = [file, folder.path().join("again.png")].map(|file| image::open(file).unwrap().to_rgb8());
    // The raster screen is larger than the picture, which is in its upper left corner or its middle.
    let covered = |picture: &image::RgbImage| picture.pixels().filter(|pixel| pixel.0.iter().any(|c| *c > 8)).count();
    let (one, two) = (covered(&raster), covered(&again));
    assert!(two > 150 && one.abs_diff(two) <= two / 100, "{one} and {two} pixels of {:?}", raster.dimensions());
    let sum = |picture: &image::RgbImage| picture.pixels().map(|pixel| u64::from(pixel.0[1])).sum::<u64>();
    assert!(sum(&raster).abs_diff(sum(&again)) < sum(&again) / 50);
}

#[test]
fn a_scene_is_shown_without_a_window_where_none_is_wanted_or_none_can_be() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.rhai"), SCENE).unwrap();
    // Nothing serves this display.
    let environment = [("PERIS_PS340", PS340), ("DISPLAY", ":5790"), ("WAYLAND_DISPLAY", "")];
    for (arguments, warns) in [(&["show", "small.rhai", "--headless"][..], false), (&["show", "small.rhai"], true)] {
        let ended = run(PERIS, arguments, &environment, folder.path(), LIMIT);
        assert_eq!((ended.code, ended.errors.contains("without a window")), (Some(0), warns), "{}", ended.errors);
        let camera = ended.out.lines().last().unwrap();
        assert!(camera.starts_with("camera(#{ from: [0, 4, 14], at: [0, ") && camera.contains("field_of_view: 34 "));
    }
}

#[test]
fn what_goes_wrong_has_its_exit_code_and_its_place() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.rhai"), "sphere(1);\nsphere(-2);\n").unwrap();
    let ended = peris(&["render", "bad.rhai"], folder.path());
    assert_eq!(ended.code, Some(3));
    assert!(ended.errors.contains("bad.rhai") && ended.errors.contains('2'), "{}", ended.errors);
    let ended = peris(&["show", "teapot", "--to", "tcp:127.0.0.1:1"], folder.path());
    assert_eq!(ended.code, Some(4));
    assert!(ended.errors.contains("tcp:127.0.0.1:1"), "{}", ended.errors);
    assert_eq!(peris(&["show", "teapot", "--to", "nowhere"], folder.path()).code, Some(2));
    assert_eq!(peris(&["paint"], folder.path()).code, Some(2));
    let environment = [("PERIS_PS340", "/nonexistent/ps340")];
    let ended = run(PERIS, &["demo"], &environment, folder.path(), LIMIT);
    assert_eq!(ended.code, Some(4));
    assert!(ended.errors.contains("/nonexistent/ps340"), "{}", ended.errors);
}
