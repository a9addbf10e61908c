//! Frames and moving pictures of `peris animate`, as a user asks for them.

use image::AnimationDecoder;
use image::codecs::png::PngDecoder;
use rustix::process::Signal;
use serde_json::Value;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tests::{Ended, TIMEOUT, run, send_signal, wait};

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const LIMIT: Duration = Duration::from_secs(120);

/// A ball that crosses the picture and becomes brighter, which a meter would see.
const SCENE: &str = r#"
    image(24, 16); samples(2);
    ground(20).material(#{ diffuse: 0.5 });
    sphere(1).translate(4 * time() - 2, 1, 0).material(#{ diffuse: [0.2 + 0.5 * time(), 0.2, 0.1] });
    directional_light(#{ direction: [0.6, -1, -0.5], irradiance: 1 + 9 * time() });
    ambient(0.1);
    camera(#{ from: [0, 3, 9], at: [0, 0.8, 0], field_of_view: 28 });
"#;

/// Runs `peris animate` on a script of a folder, with options divided by blanks.
fn animate(script: &str, options: &str, folder: &Path) -> Ended {
    let arguments: Vec<&str> = ["animate", script].into_iter().chain(options.split(' ')).collect();
    run(PERIS, &arguments, &[], folder, LIMIT)
}

/// Runs it to a good end.
fn done(options: &str, folder: &Path) -> Ended {
    let ended = animate("a.rhai", options, folder);
    assert_eq!(ended.code, Some(0), "{options}: {}", ended.errors);
    ended
}

/// A folder with the scene.
fn folder_with(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.rhai"), scene).unwrap();
    folder
}

/// The bytes of all files of a folder, by their names.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    let mut all: Vec<_> = entries.map(|path| (name(&path), fs::read(&path).unwrap())).collect();
    all.sort();
    all
}

/// The pixels of a frame.
fn pixels(path: &Path) -> image::RgbImage {
    image::open(path).unwrap().to_rgb8()
}

#[test]
fn a_frame_alone_is_that_of_the_sequence_on_any_number_of_threads() {
    let folder = folder_with(SCENE);
    let folder = folder.path();
    done("--frames 0..4 --rate 4 -o all --format exr,png --threads 2", folder);
    done("--frames 2 --rate 4 -o one --format png,exr --threads 1", folder);
    let (all, one) = (files(&folder.join("all")), files(&folder.join("one")));
    let names: Vec<&str> = one.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["frame-0002.exr", "frame-0002.png"]);
    assert!(all.len() == 8 && one.iter().all(|file| all.contains(file)));
    assert!(all[1].1 != all[3].1 && all[3].1 != all[5].1, "the frames differ");
    // The exposure is that of the time 0, where there is a tenth of the light.
    let told = animate("a.rhai", "--frames 0..2 --rate 1 -o json --json", folder).out;
    let lines: Vec<Value> = told.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!([&lines[0]["exposure"], &lines[0]["origin"]], [&lines[1]["exposure"], &Value::from("rendered")]);
    let own = run(PERIS, &["render", "a.rhai", "--time", "1", "--json"], &[], folder, LIMIT).out;
    let own: Value = serde_json::from_str(&own).unwrap();
    assert!(own["exposure"].as_f64().unwrap() < lines[1]["exposure"].as_f64().unwrap() - 1.0, "{own}");
    let fixed = animate("a.rhai", "--frames 1 --rate 1 -o json --json --exposure 1.5", folder).out;
    assert_eq!(serde_json::from_str::<Value>(&fixed).unwrap()["exposure"], 1.5);
}

#[test]
fn an_interrupted_run_goes_on_to_the_same_bytes() {
    let folder = folder_with(SCENE);
    let folder = folder.path();
    let options = "--frames 0..12 --rate 12 --samples 40";
    done(&format!("{options} -o whole"), folder);
    let arguments: Vec<String> = format!("animate a.rhai {options} -o part").split(' ').map(str::to_owned).collect();
    let mut child = Command::new(PERIS)
        .args(&arguments)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let end = Instant::now() + TIMEOUT;
    while !folder.join("part/frame-0001.png").exists() {
        assert!(Instant::now() < end, "there is no second frame");
        std::thread::sleep(Duration::from_millis(1));
    }
    send_signal(&child, Signal::INT);
    let code = wait(&mut child);
    let errors = std::io::read_to_string(child.stderr.take().unwrap()).unwrap();
    assert!(code == Some(130) && errors.contains("of 12 frames are there; the same command goes on"), "{errors}");
    let (whole, part) = (files(&folder.join("whole")), files(&folder.join("part")));
    assert!((2..12).contains(&part.len()) && part.iter().all(|file| whole.contains(file)), "{} files", part.len());
    let written = |name: &str| folder.join("part").join(name).metadata().unwrap().modified().unwrap();
    let first = written("frame-0000.png");
    let told = done(&format!("{options} -o part"), folder).out;
    assert!(told.contains(&format!("{} rendered", 12 - part.len())), "{told}");
    assert!(files(&folder.join("part")) == whole && written("frame-0000.png") == first);
}

#[test]
fn frames_of_other_scenes_and_options_are_made_anew_and_foreign_files_refused() {
    let folder = folder_with(SCENE);
    let folder = folder.path();
    let told = |options: &str| done(&format!("--rate 4 -o d {options}"), folder).out;
    assert!(told("--frames 0..2").contains("2 rendered"));
    assert!(told("--frames 0..3").contains("1 rendered, 0 copied, 2 were there"));
    assert!(told("--frames 0..3 --seed 5").contains("3 rendered"));
    // Spaces change nothing, and another ball in the last frame only that.
    fs::write(folder.join("a.rhai"), format!("{SCENE} if time() > 0.4 {{ sphere(0.3); }}")).unwrap();
    assert!(told("--frames 0..3 --seed 5").contains("1 rendered, 0 copied, 2 were there"));
    let last = fs::read(folder.join("d/frame-0002.png")).unwrap();
    fs::write(folder.join("d/frame-0001.png"), "mine").unwrap();
    fs::write(folder.join("d/other.txt"), "mine").unwrap();
    let refused = animate("a.rhai", "--rate 4 -o d --frames 0..3 --seed 6", folder);
    let errors = refused.errors;
    assert!(refused.code == Some(2) && errors.contains("frame-0001.png is no frame"), "{errors}");
    assert!(fs::read(folder.join("d/frame-0002.png")).unwrap() == last, "nothing is written");
    assert!(told("--frames 0..3 --seed 5 --overwrite").contains("1 rendered, 0 copied, 2 were there"));
    for (options, word) in [
        ("--frames 0..3 -o d --movie d/frame-0007.png", "another one"),
        ("--frames 0..3 -o d --movie d/a.gif", ".apng"),
        ("--frames 0..3 -o d --format exr --y4m", "--format png,exr"),
        ("--frames 3..3 -o d", "no frame"),
        ("--frames 0..3 -o d --rate 0", "no rate"),
        ("--frames 0..3 -o d --time 1", "--time"),
        ("--frames 0..3 -o d --renderer scan-line --denoise", "has no --denoise"),
    ] {
        let ended = animate("a.rhai", options, folder);
        assert!(ended.code == Some(2) && ended.errors.contains(word), "{options}: {}", ended.errors);
    }
}

#[test]
fn a_scene_that_stands_still_is_rendered_once() {
    let folder = folder_with(&SCENE.replace("time()", "0.5"));
    let ended = done("--frames 0..3 -o d", folder.path());
    assert!(ended.out.contains("1 rendered, 2 copied"), "{}", ended.out);
    assert_eq!(ended.errors.matches("does not depend on the time").count(), 1, "{}", ended.errors);
    let all = files(&folder.path().join("d"));
    assert!(all.len() == 3 && all.iter().all(|(_, bytes)| *bytes == all[0].1));
}

#[test]
fn a_stream_for_encoders_holds_the_frames_and_nothing_else() {
    let folder = folder_with(SCENE);
    let folder = folder.path();
    done("--frames 1..2 --rate 30000/1001 -o d", folder);
    // One frame is there already, and two are not.
    let output = Command::new(PERIS)
        .args("animate a.rhai --frames 0..3 --rate 30000/1001 -o d --y4m".split(' '))
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let head = b"YUV4MPEG2 W24 H16 F30000:1001 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    let frames = output.stdout.strip_prefix(head).expect("the head");
    const PLANE: usize = 24 * 16;
    let frames: Vec<&[u8]> =
        frames.chunks(6 + 3 * PLANE).map(|frame| frame.strip_prefix(b"FRAME\n").unwrap()).collect();
    assert!(frames.len() == 3 && frames.iter().all(|frame| frame.len() == 3 * PLANE));
    for (number, frame) in frames.iter().enumerate() {
        let shown = pixels(&folder.join(format!("d/frame-000{number}.png")));
        for (at, pixel) in shown.pixels().enumerate() {
            // By the coefficients of the recommendation, rounded to four digits there.
            let [r, g, b] = pixel.0.map(|band| f64::from(band) / 255.0);
            let luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            let expected = [
                16.0 + 219.0 * luma,
                128.0 + 224.0 * (-0.1146 * r - 0.3854 * g + 0.5 * b),
                128.0 + 224.0 * (0.5 * r - 0.4542 * g - 0.0458 * b),
            ];
            for (plane, expected) in expected.into_iter().enumerate() {
                let found = f64::from(frame[plane * PLANE + at]);
                assert!((found - expected).abs() < 1.0, "frame {number}, plane {plane}, {at}: {found} {expected}");
            }
        }
    }
}

#[test]
fn a_reader_that_goes_ends_a_stream_quietly() {
    let folder = folder_with(SCENE);
    let mut child = Command::new(PERIS)
        .args("animate a.rhai --frames 0..3 -o d --y4m".split(' '))
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let code = wait(&mut child);
    let errors = std::io::read_to_string(child.stderr.take().unwrap()).unwrap();
    assert!(code == Some(0) && errors.is_empty(), "{code:?} {errors}");
}

#[test]
fn a_moving_picture_shows_the_frames_for_as_long_as_the_rate_says() {
    let folder = folder_with(SCENE);
    let folder = folder.path();
    done("--frames 3..7 --rate 23.976 -o d --movie d/a.apng", folder);
    let file = BufReader::new(File::open(folder.join("d/a.apng")).unwrap());
    let frames = PngDecoder::new(file).unwrap().apng().unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 4);
    for (frame, number) in frames.iter().zip(3..) {
        let (milliseconds, parts) = frame.delay().numer_denom_ms();
        assert_eq!(2997 * u64::from(milliseconds), 125_000 * u64::from(parts), "frame {number}");
        let shown = image::DynamicImage::ImageRgba8(frame.buffer().clone()).to_rgb8();
        assert!(shown == pixels(&folder.join(format!("d/frame-000{number}.png"))), "frame {number}");
    }
    // Frames that grow make no moving picture, and stay.
    fs::write(folder.join("a.rhai"), SCENE.replace("image(24, 16)", "image(24, if time() > 0.03 { 17 } else { 16 })"))
        .unwrap();
    let ended = animate("a.rhai", "--frames 0..2 -o e --movie e/a.png", folder);
    assert!(ended.code == Some(1) && ended.errors.contains("24 x 17"), "{}", ended.errors);
    assert_eq!(files(&folder.join("e")).len(), 2);
}
