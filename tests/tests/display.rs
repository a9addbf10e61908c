//! How pictures are shown: exposure, tone, what files record, and reconstruction filters, as a user meets them.

use host::picture::Picture;
use host::picture::display::DisplayTransform;
use host::plan::Plan;
use host::render::Watch;
use host::render::metering::Meter;
use host::render::ray_tracer;
use host::scene::{Prepared, View};
use host::script::{self, Inputs};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::time::Duration;
use tests::{Ended, run};

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const LIMIT: Duration = Duration::from_secs(300);

/// A ball under a sky and a sun, a lamp in sight, and how much light there is of all.
const SCENE: &str = r#"
    let light = parameter("light", 1.0);
    image(64, 48); samples(4);
    sphere(1).material(#{ diffuse: [0.6, 0.2, 0.1] }).translate(0, 1, 0);
    ground(20).material(#{ diffuse: 0.4 });
    sky(#{ radiance: 0.5 * light });
    directional_light(#{ direction: [-1, -2, -1.5], irradiance: 3 * light });
    rectangle_light(#{ corner: [2, 2, -2], across: [1, 0, 0], up: [0, 1, 0], radiance: 20 * light });
    camera(#{ from: [0, 3, 9], at: [0, 1, 0] });
"#;

fn peris(arguments: &[&str], folder: &Path) -> Ended {
    let ended = run(PERIS, arguments, &[], folder, LIMIT);
    assert!(ended.code.is_some(), "{arguments:?} did not end by itself");
    ended
}

/// The report of a rendering that ends well.
fn rendered(arguments: &[&str], folder: &Path) -> Value {
    let ended = peris(&[&["render", "a.rhai", "--json"], arguments].concat(), folder);
    assert_eq!(ended.code, Some(0), "{arguments:?}: {}", ended.errors);
    serde_json::from_str(&ended.out).unwrap_or_else(|error| panic!("{arguments:?}: {error}\n{}", ended.out))
}

#[test]
fn the_same_scene_with_other_light_gives_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    let codes = |light: &str| {
        let stops = rendered(&["-D", &format!("light={light}"), "-o", "a.png"], folder)["exposure"].as_f64().unwrap();
        (stops, Picture::read(&folder.join("a.png")).unwrap().to_srgb8())
    };
    let (stops, one) = codes("1.0");
    for light in ["0.01", "100.0"] {
        let (other, shown) = codes(light);
        assert!((other + light.parse::<f64>().unwrap().log2() - stops).abs() < 1e-9, "{light}");
        assert!(one.iter().zip(&shown).all(|(a, b)| a.abs_diff(*b) <= 1), "{light}");
    }
    assert!(one.iter().filter(|code| **code == 255).count() * 100 < one.len());
}

#[test]
fn the_scene_alone_decides_about_the_exposure() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    let stops = |more: &[&str]| rendered(&[&["-o", "a.png"], more].concat(), folder)["exposure"].as_f64().unwrap();
    let whole = stops(&[]);
    for more in [
        &["--width", "20"][..],
        &["--width", "30", "--height", "30"],
        &["--samples", "1"],
        &["--seed", "9"],
        &["--threads", "1"],
        &["--filter", "mitchell"],
        &["-o", "a.exr"],
    ] {
        assert_eq!(stops(more), whole, "{more:?}");
    }
    assert!((stops(&["--exposure", "auto+1.5"]) - whole - 1.5).abs() < 1e-12);
    assert_eq!(stops(&["--exposure", "-2"]), -2.0);
    // Several views are exposed as the one of the scene.
    let turn = |views: &str| {
        let told = rendered(&["-o", "a.png", "--width", "8", "--samples", "1", "--views", views], folder);
        let stops: Vec<f64> = told.as_array().unwrap().iter().map(|view| view["exposure"].as_f64().unwrap()).collect();
        assert!(stops.iter().all(|one| *one == stops[0]));
        stops[0]
    };
    assert_eq!([turn("3"), turn("5")], [whole; 2]);
}

#[test]
fn a_turn_of_single_pictures_is_exposed_steadily() {
    // About a box nearby, whose dark and light faces come into view, a degree at a time.
    let near = "image(64, 48); box(2, 1, 1).material(#{ diffuse: [0.8, 0.1, 0.1] }); ambient(0.1); \
                ground(9).translate(0, -0.5, 0); point_light(#{ at: [3, 4, 5], intensity: 50 }); \
                camera(#{ from: [4, 2, 5] });";
    for (text, degrees) in [(SCENE, 4), (near, 1)] {
        let scene = script::evaluate(text, "a", Path::new(""), &Inputs::default()).unwrap().scene;
        let prepared = Prepared::new(&scene).unwrap();
        let turned = |step: i32| View::Camera(prepared.camera.turned(f64::from(step * degrees).to_radians()));
        let views: Vec<View> = (0..=90).map(turned).collect();
        let plan = Plan::of_views(&prepared, &views, false);
        let tracer = ray_tracer(&prepared, &plan).unwrap();
        let meter = Meter::new(&scene.settings, &DisplayTransform::default(), None);
        let stops: Vec<f64> =
            views.iter().map(|view| meter.stops(&tracer, &prepared, &[*view], &Watch::NOBODY).unwrap()).collect();
        let jump = stops.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(jump < 0.1, "{jump} stops");
    }
}

#[test]
fn radiance_and_mattes_stay_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    rendered(&["-o", "a.exr", "-o", "linear.png", "--exposure", "0", "--tone", "linear"], folder);
    rendered(&["-o", "b.exr", "-o", "shown.png", "--white", "A", "--bloom", "1"], folder);
    rendered(&["-o", "matte.exr", "-o", "matte.png", "--matte"], folder);
    let read = |name: &str| Picture::read(&folder.join(name)).unwrap();
    assert_eq!(read("a.exr"), read("b.exr"));
    assert_ne!(read("linear.png"), read("shown.png"));
    for (exr, png) in [("a.exr", "linear.png"), ("matte.exr", "matte.png")] {
        assert_eq!(read(exr).to_srgb8(), read(png).to_srgb8(), "{png}");
    }
    // A script may ask for the same, and the command line has the last word.
    fs::write(folder.join("a.rhai"), format!("{SCENE} exposure(0); tone(\"linear\");")).unwrap();
    rendered(&["-o", "asked.png"], folder);
    assert_eq!(read("asked.png"), read("linear.png"));
    let ended = peris(&["convert", "a.exr", "b.png", "--exposure", "auto", "--tone", "filmic"], folder);
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    assert_ne!(read("b.png"), read("linear.png"));
    for wrong in [&["convert", "a.exr", "b.exr", "--tone", "filmic"][..], &["render", "a.rhai", "--white", "moon"]] {
        assert_eq!(peris(wrong, folder).code, Some(2), "{wrong:?}");
    }
}

#[test]
fn what_is_clipped_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), "image(20, 10); samples(1); sky(#{ radiance: 3 }); camera(#{ from: [0, 0, 5] });")
        .unwrap();
    let told = |more: &[&str]| peris(&[&["render", "a.rhai", "-o", "a.png"], more].concat(), folder).errors;
    assert!(told(&["--exposure", "0", "--tone", "linear"]).contains("100.0% of the pixels are brighter than white"));
    for more in [&["--exposure", "0"][..], &["--tone", "linear"], &["--exposure", "0", "--tone", "reinhard"]] {
        assert!(!told(more).contains("brighter than white"), "{more:?}");
    }
}

#[test]
fn files_tell_how_they_were_made_and_are_the_same_in_every_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("a.rhai"), SCENE).unwrap();
    for (number, threads) in [("1", "1"), ("2", "2")] {
        let names = [format!("{number}.png"), format!("{number}.exr"), format!("{number}-layers.exr")];
        rendered(&["-o", &names[0], "-o", &names[1], "--threads", threads], folder);
        rendered(&["-o", &names[2], "--layers", "--threads", threads], folder);
    }
    for kind in [".png", ".exr", "-layers.exr"] {
        let [one, two] = ["1", "2"].map(|number| fs::read(folder.join(format!("{number}{kind}"))).unwrap());
        assert!(one == two, "{kind} differs");
        let text = String::from_utf8_lossy(&one);
        for part in ["PERIS ", "ray-tracing", "4 to 4", "filmic", " stops", "standard error"] {
            assert!(text.contains(part), "{kind}: {part}");
        }
    }
    let png = fs::read(folder.join("1.png")).unwrap();
    assert!(png.windows(4).any(|chunk| chunk == b"sRGB"));
}

#[test]
fn filters_spread_an_edge_as_their_integrals_say() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // The left half of the picture is covered up to the edge between two pixels.
    let script = "image(16, 8); samples(1024); box(8, 8, 1).translate(-4, 0, 0); ambient(1); \
                  camera(#{ from: [0, 0, 9], height: 8 });";
    fs::write(folder.join("a.rhai"), script).unwrap();
    type Curve = fn(f64) -> f64;
    let gaussian: Curve = |x| (-2.0 * x * x).exp() - (-4.5f64).exp();
    let harris: Curve = |x| {
        let angle = std::f64::consts::TAU * (x / 3.0 + 0.5);
        0.35875 - 0.48829 * angle.cos() + 0.14128 * (2.0 * angle).cos() - 0.01168 * (3.0 * angle).cos()
    };
    let mitchell: Curve = |x| match x.abs() {
        x if x < 1.0 => (21.0 * x * x * x - 36.0 * x * x + 16.0) / 18.0,
        x => (-7.0 * x * x * x + 36.0 * x * x - 60.0 * x + 32.0) / 18.0,
    };
    for (filter, radius, curve) in [
        ("box", 0.5, (|_| 1.0) as Curve),
        ("gaussian", 1.5, gaussian),
        ("blackman-harris", 1.5, harris),
        ("mitchell", 2.0, mitchell),
    ] {
        rendered(&["-o", "a.exr", "--filter", filter], folder);
        let picture = Picture::read(&folder.join("a.exr")).unwrap();
        let integral = |from: f64, to: f64| {
            let steps = 4000;
            let x = |i: i32| from + (to - from) * (f64::from(i) + 0.5) / f64::from(steps);
            (0..steps).map(|i| curve(x(i))).sum::<f64>() * (to - from) / f64::from(steps)
        };
        for column in 4..12 {
            let middle = f64::from(column) + 0.5;
            // What lies left of the edge, at 8.
            let end = (8.0 - middle).clamp(-radius, radius);
            let expected = integral(-radius, end) / integral(-radius, radius);
            let rows = (2..6).map(|row| f64::from(picture.get(column, row).unwrap().coverage));
            let found = rows.sum::<f64>() / 4.0;
            assert!((found - expected).abs() < 0.01, "{filter} {column}: {found} {expected}");
        }
    }
}
