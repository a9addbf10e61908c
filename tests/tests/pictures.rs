//! Commands that make, explain, compare and combine pictures, as a user gives them.

use host::picture::Picture;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::time::Duration;
use tests::{Ended, run};

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const LIMIT: Duration = Duration::from_secs(300);

/// A ball over a floor, and another before it that the parameter leaves out.
const SCENE: &str = r#"
    image(48, 32); samples(16);
    if parameter("floor", true) { ground(20).material(#{ diffuse: 0.5 }); }
    if parameter("ball", true) { sphere(1).translate(0, 1, 0).metal("copper", 0.3); }
    rectangle_light(#{ corner: [-1, 5, -1], across: [2, 0, 0], up: [0, 0, 2], power: 80 });
    ambient(0.1);
    camera(#{ from: [0, 3, 9], at: [0, 0.8, 0], field_of_view: 28 });
"#;

fn peris(arguments: &[&str], folder: &Path) -> Ended {
    let ended = run(PERIS, arguments, &[], folder, LIMIT);
    assert!(ended.code.is_some(), "{arguments:?} did not end by itself");
    ended
}

fn json(arguments: &[&str], folder: &Path) -> Value {
    let ended = peris(arguments, folder);
    serde_json::from_str(&ended.out).unwrap_or_else(|error| panic!("{arguments:?}: {error}\n{}", ended.out))
}

#[test]
fn a_pixel_is_explained_as_it_is_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    let told = json(&["render", "a.rhai", "--pixel", "24,14", "--explain", "--json"], folder);
    let samples = told["samples"].as_array().unwrap();
    assert_eq!(samples.len(), 4);
    assert_eq!(samples[0]["wavelengths"].as_array().unwrap().len(), 8, "copper needs spectra");
    let notes = samples[0]["notes"].as_array().unwrap();
    assert!(notes.iter().any(|note| note["what"].as_str().unwrap().starts_with("hits sphere, metal material")));
    let ended = peris(&["render", "a.rhai", "--pixel", "48,0"], folder);
    assert!(ended.code == Some(2) && ended.errors.contains("outside the picture"), "{}", ended.errors);
}

#[test]
fn stages_are_timed_and_blocks_lie_within_the_time_of_their_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    let told = json(&["render", "a.rhai", "--json", "-o", "a.png", "--profile", "a.json"], folder);
    let depth = |name: &str| {
        told["stages"].as_array().unwrap().iter().find(|stage| stage["name"] == name).unwrap()["depth"].clone()
    };
    assert_eq!(
        ["preparing", "building the octree", "rendering", "writing"].map(|name| depth(name).as_u64().unwrap()),
        [0, 1, 2, 0]
    );
    let profile: Value = serde_json::from_slice(&fs::read(folder.join("a.json")).unwrap()).unwrap();
    let spans = |name: &str| -> Vec<[f64; 2]> {
        let events = profile["traceEvents"].as_array().unwrap().iter().filter(|event| event["name"] == name);
        events.map(|event| [&event["ts"], &event["dur"]].map(|number| number.as_f64().unwrap())).collect()
    };
    // One pass of a sample, one up to 8, one up to 16; and those of the meter.
    let (renderings, blocks) = (spans("rendering"), spans("block"));
    assert!(renderings.len() == 2 && blocks.len() >= 3 * 2 * 3, "{profile}");
    let is_within = |[begin, length]: &[f64; 2]| {
        renderings.iter().any(|[first, whole]| first <= begin && begin + length <= first + whole)
    };
    assert!(blocks.iter().all(is_within), "{profile}");
    let table = peris(&["plan", "a.rhai", "--seconds"], folder).out;
    let octree = table.lines().find(|line| line.contains(" octree ")).unwrap();
    assert!(octree.split_whitespace().any(|word| word.contains('.') && word.parse::<f64>().is_ok()), "{table}");
    let ended = peris(&["plan", "a.rhai", "--profile", "none/a.json"], folder);
    assert!(ended.code == Some(1) && ended.errors.contains("none"), "{}", ended.errors);
}

#[test]
fn a_scene_without_light_comes_out_neither_black_nor_blown() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let own = "sphere(1); directional_light(#{ direction: [0, -1, 0] });";
    for (script, is_lit) in [
        ("sphere(1);", true),
        ("box(2, 1, 1).translate(1e4, 0, 0);", true),
        ("sphere(1e-4).metal(\"copper\");", true),
        ("ground(50); cylinder(1, 2).translate(0, 1, 0);", true),
        ("box(8, 3, 8); sphere(1); camera(#{ from: [1, 0, 3.5], at: [0, 0, 0] });", true),
        (own, false),
    ] {
        fs::write(folder.join("a.rhai"), format!("image(48, 36); {script}")).unwrap();
        let ended = peris(&["render", "a.rhai", "-o", "a.exr", "--samples", "8"], folder);
        assert_eq!((ended.code, ended.errors.contains("no light of its own")), (Some(0), is_lit), "{}", ended.errors);
        let picture = Picture::read(&folder.join("a.exr")).unwrap();
        let brightest = picture.pixels().iter().map(|pixel| pixel.radiance.into_iter().fold(0.0, f32::max));
        let part = |is: fn(f32) -> bool| brightest.clone().filter(|v| is(*v)).count() as f64 / (48.0 * 36.0);
        let (clipped, black) = (part(|v| v > 1.0), part(|v| v < 1.0 / 255.0));
        assert!(!is_lit || clipped < 0.01 && black < 0.01, "{script}: {clipped} {black}");
    }
}

#[test]
fn a_picture_of_parts_is_that_of_the_whole_where_they_throw_no_light_on_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // In ambient light only, nothing that is apart in the picture touches anything else.
    let script = SCENE
        .replace("rectangle_light", "if false { } // rectangle_light")
        .replace("metal(\"copper\", 0.3)", "material(#{})");
    fs::write(folder.join("a.rhai"), script).unwrap();
    for (name, given) in [("whole", "ball=true"), ("ball", "floor=false"), ("floor", "ball=false")] {
        let file = format!("{name}.exr");
        let ended = peris(&["render", "a.rhai", "-o", &file, "--layers", "--matte", "-D", given], folder);
        assert_eq!(ended.code, Some(0), "{}", ended.errors);
    }
    let ended = peris(&["compose", "ball.exr", "over", "floor.exr", "-o", "both.exr", "--depth"], folder);
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    let apart = json(&["diff", "both.exr", "whole.exr", "--json"], folder);
    assert!(apart["rmse"].as_f64().unwrap() < 0.01, "{apart}");
    let same = peris(&["diff", "whole.exr", "whole.exr", "--tolerance", "1e-12"], folder);
    let other = peris(&["diff", "whole.exr", "floor.exr", "--tolerance", "1e-3"], folder);
    assert_eq!((same.code, other.code), (Some(0), Some(1)), "{}", other.out);
}

#[test]
fn a_rendering_ends_at_an_error_or_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    let rough = json(&["render", "a.rhai", "--samples", "1024", "--error", "0.2", "--json"], folder);
    let counts = |report: &Value| [0, 1].map(|k| report["samples"][k].as_u64().unwrap());
    let [least, most] = counts(&rough);
    assert!(least < most && most <= 1024, "some pixels need more samples than others: {least} to {most}");
    let brief = json(&["render", "a.rhai", "--samples", "65536", "--seconds", "0.5", "--json"], folder);
    assert!(counts(&brief)[0] < 65536 && brief["complete"] == true);
}

#[test]
fn a_rendering_that_goes_on_from_a_file_is_as_if_it_had_never_ended() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    for (samples, output, state) in
        [("3", "few.exr", "a.state"), ("8", "more.exr", "a.state"), ("8", "once.exr", "b.state")]
    {
        let ended = peris(&["render", "a.rhai", "--samples", samples, "-o", output, "--resume", state], folder);
        assert_eq!(ended.code, Some(0), "{}", ended.errors);
    }
    assert_eq!(fs::read(folder.join("more.exr")).unwrap(), fs::read(folder.join("once.exr")).unwrap());
    assert_eq!(fs::read(folder.join("a.state")).unwrap(), fs::read(folder.join("b.state")).unwrap());
    let other = peris(&["render", "a.rhai", "--samples", "8", "--seed", "7", "--resume", "a.state"], folder);
    assert!(other.code == Some(2) && other.errors.contains("the state of other work"), "{}", other.errors);
    fs::write(folder.join("a.state"), "something else").unwrap();
    let none = peris(&["render", "a.rhai", "--resume", "a.state"], folder);
    assert!(none.code == Some(1) && none.errors.contains("a.state"), "{}", none.errors);
}

#[test]
fn several_views_share_caught_light_which_a_database_keeps_for_the_next_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let script = SCENE.replace("metal(\"copper\", 0.3)", "glass(#{})").replace("samples(16)", "samples(4)");
    fs::write(folder.join("a.rhai"), script).unwrap();
    let common = ["render", "a.rhai", "--renderer", "two-way", "--json"];
    let told = json(&[&common[..], &["--views", "3", "--turn", "20", "--light", "a.redb"]].concat(), folder);
    let told = told.as_array().unwrap();
    let files: Vec<&str> = told.iter().map(|view| view["files"][0].as_str().unwrap()).collect();
    assert_eq!(files, ["a-1.png", "a-2.png", "a-3.png"]);
    let pictures: Vec<Vec<u8>> = files.iter().map(|file| fs::read(folder.join(file)).unwrap()).collect();
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    let again = json(&[&common[..], &["--light", "a.redb", "-o", "b.png"]].concat(), folder);
    let of = |key: &str| again["caught_light"][key].as_u64().unwrap();
    assert!(2 * of("before") > of("ways"), "{again}");
    assert_eq!(fs::read(folder.join("b.png")).unwrap(), pictures[0]);
    let listed = peris(&["db", "list", "a.redb", "--kind", "caught-light"], folder);
    assert!(listed.out.contains(" photons of "), "{}", listed.out);
    let wrong = peris(&["render", "a.rhai", "--renderer", "scan-line", "--light", "a.redb"], folder);
    assert_eq!(wrong.code, Some(2), "{}", wrong.errors);
}

#[test]
fn a_denoised_picture_is_nearer_to_that_of_many_samples_and_can_be_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let script = SCENE.replace("image(48, 32)", "image(144, 96); light_samples(1)");
    let script = script
        .replace("[-1, 5, -1], across: [2, 0, 0], up: [0, 0, 2]", "[-3, 5, -3], across: [6, 0, 0], up: [0, 0, 6]");
    fs::write(folder.join("a.rhai"), script).unwrap();
    let render = |rest: &str| {
        let arguments: Vec<&str> = "render a.rhai --exposure 0".split(' ').chain(rest.split(' ')).collect();
        let ended = peris(&arguments, folder);
        assert_eq!(ended.code, Some(0), "{rest}: {}", ended.errors);
    };
    render("--samples 256 --seed 9 -o many.exr");
    render("--samples 4 -o few.exr");
    render("--samples 4 --denoise -o a.exr");
    let error = |picture: &str| {
        json(&["diff", picture, "many.exr", "--json"], folder)["relative_mse"].as_f64().expect("a number")
    };
    let (few, denoised) = (error("few.exr"), error("a.exr"));
    assert!(denoised < 0.5 * few, "{denoised} of {few}");
    render("--samples 2 --denoise -o b.exr --resume b.state --threads 1");
    render("--samples 4 --denoise -o b.exr --resume b.state");
    assert!(fs::read(folder.join("a.exr")).unwrap() == fs::read(folder.join("b.exr")).unwrap());
    render("--samples 4 --denoise --layers -o c.exr");
    let layers = fs::read(folder.join("c.exr")).unwrap();
    assert!(
        ["albedo.R", "direct.R", "Denoiser"]
            .iter()
            .all(|name| { layers.windows(name.len()).any(|bytes| bytes == name.as_bytes()) })
    );
    render("--samples 4 -o d.exr --resume d.state");
    for (rest, word) in [
        ("--samples 8 --denoise --resume d.state", "begun without --denoise"),
        ("--samples 1 --denoise", "2 samples"),
        ("--renderer scan-line --denoise", "has no --denoise"),
    ] {
        let ended = peris(&["render", "a.rhai"].into_iter().chain(rest.split(' ')).collect::<Vec<_>>(), folder);
        assert!(ended.code == Some(2) && ended.errors.contains(word), "{rest}: {}", ended.errors);
    }
}
