//! Pictures against those that another renderer made of the same scenes: its values are kept in `peers/mitsuba.json`,
//! which `peers/mitsuba_check.py` renews where that renderer is installed.

use host::color::srgb::LUMINANCE;
use host::picture::Picture;
use host::plan::Plan;
use host::render::radiosity::Radiosity;
use host::render::scan_line::ScanLine;
use host::render::{Film, RenderOrder, Renderer, Watch, World, ray_tracer};
use host::scene::Prepared;
use host::script::{Inputs, ParameterAssignment, load_file};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

/// Blocks along each side of a picture of which the other renderer's means are kept.
const BLOCKS: usize = 8;
/// Most standard errors of both that the mean of a block may be off; there are 128 blocks.
const MOST: f64 = 5.0;
/// Luminance below which errors count as if it was this.
const DARK: f64 = 1e-3;

fn luminance(block: &Value) -> f64 {
    (0..3).map(|band| LUMINANCE[band] * block[band].as_f64().expect("a number")).sum()
}

#[test]
fn means_of_blocks_are_those_of_mitsuba_within_the_errors_of_both() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers");
    let text = std::fs::read_to_string(folder.join("mitsuba.json")).expect("the values");
    let kept: Value = serde_json::from_str(&text).expect("JSON");
    let cases = kept["cases"].as_object().expect("cases");
    assert!(cases.len() >= 2);
    for (name, case) in cases {
        let told = case["told"].as_object().expect("what the script is told");
        let mut definitions: Vec<ParameterAssignment> = told
            .iter()
            .map(|(name, value)| ParameterAssignment {
                name: name.clone(),
                value: value.as_str().expect("text").to_owned(),
            })
            .collect();
        definitions.push(ParameterAssignment { name: "count".into(), value: "64".into() });
        let script = folder.join(case["script"].as_str().expect("a script"));
        let inputs = Inputs { definitions, ..Inputs::default() };
        let scene = load_file(&script, &inputs).unwrap_or_else(|error| panic!("{error}")).scene;
        let prepared = Prepared::new(&scene).expect("a scene");
        let view = prepared.view();
        let plan = Plan::new(&prepared, &view);
        let tracer = ray_tracer(&prepared, &plan).expect("a tracer");
        let film = tracer.render(&view, &RenderOrder::of(&prepared.settings), &Watch::NOBODY).expect("a picture").film;
        let (columns, rows) = (film.width() as usize / BLOCKS, film.height() as usize / BLOCKS);
        let mut squares = 0.0;
        for block in 0..BLOCKS * BLOCKS {
            let (x, y) = (block % BLOCKS, block / BLOCKS);
            let pixels = (0..columns * rows).map(|pixel| {
                let (row, column) = (y * rows + pixel / columns, x * columns + pixel % columns);
                &film.tallies()[row * film.width() as usize + column]
            });
            let count = (columns * rows) as f64;
            let ours = pixels.clone().map(|tally| tally.mean().dot(LUMINANCE)).sum::<f64>() / count;
            let own = pixels.map(|tally| tally.variance()).sum::<f64>() / (count * count);
            let theirs = luminance(&case["blocks"][y][x]);
            // The bands err together: at the most as their sum.
            let error = (own + luminance(&case["errors"][y][x]).powi(2)).sqrt().max(DARK * 1e-3);
            let off = (ours - theirs) / error;
            squares += off * off;
            assert!(off.abs() < MOST, "{name}: block {x}, {y} is {ours}, not {theirs}: {off:.1} standard errors");
        }
        let mean = squares / (BLOCKS * BLOCKS) as f64;
        assert!(mean < 1.6, "{name}: blocks are off by {:.2} standard errors", mean.sqrt());
    }
}

/// How far off the mean of a picture by radiosity may be, and the mean of any of its regions, as a part of it or of a
/// fifth of the mean of all if that is more.
const WHOLE: f64 = 0.005;
const REGION: f64 = 0.03;
/// Where the mean is more, the lamp is in sight; regions above, below and beside do not count, either.
const LAMP: f64 = 1.0;

#[test]
fn the_cornell_box_by_radiosity_is_that_of_mitsuba_within_half_a_percent_and_each_region_within_three() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(folder.join("peers/radiosity.json")).expect("the values");
    let kept: Value = serde_json::from_str(&text).expect("JSON");
    let theirs: Vec<Vec<[f64; 3]>> = serde_json::from_value(kept["regions"].clone()).expect("regions");
    let mut scene = load_file(&folder.join("../host/scenes/cornell.rhai"), &Inputs::default()).expect("the box").scene;
    (scene.settings.image.width, scene.settings.image.height) = (128, 128);
    // Edges within a region are not to be told by chance.
    scene.settings.image.samples = 64;
    scene.settings.light.interreflection.count();
    let prepared = Prepared::new(&scene).expect("a scene");
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let world = World::new(&prepared, &plan).expect("a world");
    let solution = Radiosity::new(&world, &plan, &prepared.settings.radiosity, None, &Watch::NOBODY);
    let solution = solution.expect("a solution");
    let scan_line = ScanLine::showing(Arc::new(solution), world, &plan);
    let picture =
        scan_line.render(&view, &RenderOrder::of(&prepared.settings), &Watch::NOBODY).expect("a picture").picture;
    let side = 128 / theirs.len();
    let mean_of = |bands: &[f64; 3]| bands.iter().sum::<f64>() / 3.0;
    let ours = |x: usize, y: usize| {
        let pixels = (0..side * side).map(|i| picture.pixels()[(y * side + i / side) * 128 + x * side + i % side]);
        pixels.map(|pixel| mean_of(&pixel.radiance.map(f64::from))).sum::<f64>() / (side * side) as f64
    };
    let all = theirs.iter().flatten().map(mean_of).sum::<f64>() / theirs.len().pow(2) as f64;
    let at_lamp = |x: usize, y: usize| {
        let near = [(x, y), (x + 1, y), (x.wrapping_sub(1), y), (x, y + 1), (x, y.wrapping_sub(1))];
        near.into_iter().any(|(x, y)| theirs.get(y).and_then(|row| row.get(x)).is_some_and(|m| mean_of(m) >= LAMP))
    };
    let mut sums = [0.0; 2];
    for (y, row) in theirs.iter().enumerate() {
        for (x, theirs) in row.iter().map(mean_of).enumerate().filter(|(x, _)| !at_lamp(*x, y)) {
            let ours = ours(x, y);
            sums = [sums[0] + ours, sums[1] + theirs];
            let off = (ours - theirs) / theirs.max(0.2 * all);
            assert!(off.abs() < REGION, "region {x}, {y} is {ours}, not {theirs}: {:.1} % off", 100.0 * off);
        }
    }
    let off = sums[0] / sums[1] - 1.0;
    assert!(off.abs() < WHOLE, "the mean is {:.2} % off", 100.0 * off);
}

/// A room with an opening, by ray tracing with radiosity.
struct Room {
    name: &'static str,
    /// How far off the mean of the picture may be beside three standard errors of the other renderer's.
    mean: f64,
    /// The root of the mean square of its parts, of which chance in the other renderer's is most in small windows.
    parts: f64,
    /// How many pixels may be off; none where so little light is found in the other renderer that a pixel tells nothing.
    pixels: Option<usize>,
}

const ROOMS: [Room; 18] = [
    Room { name: "sky 0.6", mean: 0.005, parts: 0.008, pixels: Some(0) },
    Room { name: "sky 0.05", mean: 0.005, parts: 0.03, pixels: Some(6) },
    Room { name: "sky 0.2", mean: 0.005, parts: 0.008, pixels: Some(0) },
    Room { name: "sky 2", mean: 0.005, parts: 0.006, pixels: Some(0) },
    Room { name: "sun 0.05", mean: 0.005, parts: 0.025, pixels: Some(0) },
    Room { name: "sun 0.2", mean: 0.005, parts: 0.01, pixels: Some(0) },
    Room { name: "sun 0.6", mean: 0.005, parts: 0.01, pixels: Some(0) },
    Room { name: "sun 2", mean: 0.005, parts: 0.007, pixels: Some(0) },
    Room { name: "lamp 0.05", mean: 0.005, parts: 0.1, pixels: None },
    Room { name: "lamp 0.2", mean: 0.005, parts: 0.03, pixels: Some(1) },
    Room { name: "lamp 0.6", mean: 0.005, parts: 0.01, pixels: Some(0) },
    Room { name: "lamp 2", mean: 0.005, parts: 0.006, pixels: Some(0) },
    Room { name: "spot 0.05", mean: 0.005, parts: 0.2, pixels: None },
    Room { name: "spot 0.2", mean: 0.005, parts: 0.025, pixels: Some(0) },
    Room { name: "spot 0.6", mean: 0.005, parts: 0.012, pixels: Some(0) },
    Room { name: "spot 2", mean: 0.005, parts: 0.007, pixels: Some(0) },
    Room { name: "pane 0.6", mean: 0.005, parts: 0.007, pixels: Some(0) },
    Room { name: "lantern 0", mean: 0.005, parts: 0.006, pixels: Some(0) },
];

/// A pixel may be off by this part of the mean of it and those beside it, and three standard errors.
const PIXEL: f64 = 0.05;

/// The pixels of a film, by row and column, that are off, and by which part.
///
/// - `pictures`: means and standard errors in rows from `first` on.
fn pixels_off(film: &Film, pictures: &Picture, first: u32, left_out: &[usize]) -> Vec<(u32, u32, f64)> {
    let (width, height) = (film.width(), film.height());
    let is_counted = |row: u32, column: u32| !left_out.contains(&((row * width + column) as usize));
    let theirs = |row: u32, column: u32| pictures.get(column, first + row).expect("a pixel").radiance.map(f64::from);
    let off = |(row, column): (u32, u32)| {
        let rows = row.saturating_sub(1)..(row + 2).min(height);
        let around =
            rows.flat_map(|row| (column.saturating_sub(1)..(column + 2).min(width)).map(move |column| (row, column)));
        let counted: Vec<(u32, u32)> = around.filter(|(row, column)| is_counted(*row, *column)).collect();
        let near = counted.iter().map(|(row, column)| theirs(*row, *column)[0]).sum::<f64>() / counted.len() as f64;
        let tally = &film.tallies()[(row * width + column) as usize];
        let [mean, error, _] = theirs(row, column);
        let off = tally.mean().y - mean;
        (off.abs() > PIXEL * near + 3.0 * (error * error + tally.variance()).sqrt()).then(|| (row, column, off / near))
    };
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    pixels.filter(|(row, column)| is_counted(*row, *column)).filter_map(off).collect()
}

#[test]
fn rooms_with_openings_by_radiosity_are_as_bright_as_mitsuba_tells() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers");
    let text = std::fs::read_to_string(folder.join("rooms.json")).expect("the values");
    let kept: Value = serde_json::from_str(&text).expect("JSON");
    let pictures = Picture::read_finite(&folder.join("rooms.exr")).expect("pictures");
    let rooms = if std::env::var_os("PERIS_LONG").is_some() { ROOMS.len() } else { 1 };
    let mut problems: Vec<String> = Vec::new();
    for Room { name, mean, parts, pixels } in &ROOMS[..rooms] {
        let room = &kept["rooms"][name];
        let (kind, width) = name.split_once(' ').expect("two words");
        let definition = |name: &str, value: &str| ParameterAssignment { name: name.into(), value: value.into() };
        let mut definitions = vec![definition("kind", kind)];
        if width != "0" {
            definitions.push(definition("width", width));
        }
        let inputs = Inputs { definitions, ..Inputs::default() };
        let mut scene = load_file(&folder.join("rooms.rhai"), &inputs).unwrap_or_else(|error| panic!("{error}")).scene;
        // Of lamps through small windows, 64 samples of a pixel tell too little.
        scene.settings.image.samples = if rooms > 1 { 1024 } else { scene.settings.image.samples };
        let prepared = Prepared::new(&scene).expect("a scene");
        let view = prepared.view();
        let plan = Plan::new(&prepared, &view);
        let tracer = ray_tracer(&prepared, &plan).expect("a tracer");
        let film = tracer.render(&view, &RenderOrder::of(&prepared.settings), &Watch::NOBODY).expect("a picture").film;
        let left_out: Vec<usize> = serde_json::from_value(room["left_out"].clone()).expect("pixels");
        let first = kept["rooms"].as_object().expect("rooms").keys().position(|room| room == name).expect("a room");
        let pixels_off = pixels_off(&film, &pictures, first as u32 * film.height(), &left_out);
        if pixels.is_some_and(|most| pixels_off.len() > most) {
            problems.push(format!("{name}: pixels are off: {pixels_off:?}"));
        }
        let theirs: Vec<Vec<f64>> = serde_json::from_value(room["parts"].clone()).expect("parts");
        let (rows, columns) = (film.height() as usize / theirs.len(), film.width() as usize / theirs[0].len());
        let mut ours: Vec<Vec<f64>> = theirs.iter().map(|row| vec![0.0; row.len()]).collect();
        for (pixel, tally) in film.tallies().iter().enumerate().filter(|(pixel, _)| !left_out.contains(pixel)) {
            let (row, column) = (pixel / film.width() as usize, pixel % film.width() as usize);
            ours[row / rows][column / columns] += tally.mean().y;
        }
        let number = |key: &str| room[key].as_f64().expect("a number");
        let off = ours.iter().flatten().sum::<f64>() / number("whole") - 1.0;
        let sure = mean + 3.0 * number("error") / number("whole");
        if off.abs() >= sure {
            problems.push(format!("{name}: the mean is {:.2} % off", 100.0 * off));
        }
        let pairs = ours.iter().flatten().zip(theirs.iter().flatten()).filter(|(_, theirs)| **theirs > 0.0);
        let squares: Vec<f64> = pairs.map(|(ours, theirs)| (ours / theirs - 1.0).powi(2)).collect();
        let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        if rms >= *parts {
            problems.push(format!("{name}: parts are off by {:.2} %", 100.0 * rms));
        }
    }
    assert!(problems.is_empty(), "{problems:?}");
}
