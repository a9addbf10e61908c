//! Procedural models as a user renders them: what is kept of them never shows, and what cannot be made is told.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::time::Duration;
use tests::{Ended, run};

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const LIMIT: Duration = Duration::from_secs(120);

/// Stones from near to far, each with pebbles on it where these are seen.
const STONES: &str = r#"
    image(90, 40); samples(2);
    fn stone(p) {
        let body = ellipsoid(p.size, 0.5 * p.size, 0.8 * p.size).material([0.4, 0.38, 0.35]);
        if p.detail < 0.03 {
            let pebble = sphere(0.06 * p.size).material(varied([0.1, 0.1, 0.1], [0.7, 0.6, 0.5]));
            scatter(pebble, body, #{ count: 60, seed: p.seed, height: [0, 1] });
        }
    }
    let stone = procedural(Fn("stone"), #{ bounds: [[-1, -0.6, -1], [1, 0.6, 1]], vary: #{ size: [0.7, 0.2] } });
    scatter(stone, ground(60), #{ count: 700, upright: 1, scale: [0.5, 1] });
    directional_light(#{ direction: [-1, -2, -1.5], irradiance: 3 });
    ambient(0.3);
    camera(#{ from: [0, 3, 14], at: [0, 0, 0], field_of_view: 30 });
"#;

fn render(scene: &str, options: &str, folder: &Path) -> Ended {
    fs::write(folder.join("a.rhai"), scene).expect("a folder");
    let arguments: Vec<&str> = ["render", "a.rhai", "--exposure", "0"].into_iter().chain(options.split(' ')).collect();
    run(PERIS, &arguments, &[], folder, LIMIT)
}

#[test]
fn pictures_are_the_same_to_the_byte_whatever_the_cache_takes() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = |options: &str| {
        let ended = render(STONES, &format!("--json -o a.exr {options}"), folder.path());
        assert_eq!(ended.code, Some(0), "{options}: {}", ended.errors);
        let told: Value = serde_json::from_str(&ended.out).expect("one object");
        let details = told["details"].clone();
        let count = |name: &str| details[name].as_u64().unwrap_or_else(|| panic!("{name} of {told}"));
        let pixels = fs::read(folder.path().join("a.exr")).expect("a picture");
        (pixels, ["made", "kept", "bytes"].map(count))
    };
    let (whole, [made, kept, bytes]) = picture("--threads 1");
    assert!(made == kept && made > 100, "{made} {kept}");
    let eighth = format!("{}", bytes / 8);
    for most in ["8M", "64M", &eighth, "0"] {
        for threads in [1, 2] {
            let (pixels, [again, _, held]) = picture(&format!("--detail-memory {most} --threads {threads}"));
            assert!(pixels == whole, "{most}, {threads} threads");
            let is_little = most == "0" || most == eighth;
            assert_eq!(again > made, is_little, "{most}");
            assert!(!is_little || held < bytes / 4, "{most}: {held} of {bytes}");
        }
    }
}

#[test]
fn a_model_that_fails_in_the_midst_of_a_picture_is_told_with_its_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = [
        ("if p.seed % 5 == 3 { throw \"no such stone\"; }", "a.rhai:4:", "no such stone"),
        ("if p.seed % 5 == 3 { loop { } }", "a.rhai:", "20000000 steps"),
        ("sphere(if p.seed > 100 { 9 } else { 0.2 });", "", "out of the box of its model"),
    ];
    for (line, place, words) in cases {
        let scene = STONES.replace("fn stone(p) {", &format!("fn stone(p) {{\n{line}"));
        let ended = render(&scene, "-o b.png", folder.path());
        assert!(ended.code != Some(0), "{line}");
        assert!(
            ended.errors.contains(place) && ended.errors.to_lowercase().contains(words),
            "{line}: {}",
            ended.errors
        );
        assert!(!folder.path().join("b.png").exists(), "{line}");
    }
}

#[test]
fn every_renderer_draws_what_models_make_or_says_why_not() {
    let folder = tempfile::tempdir().expect("a folder");
    for renderer in ["ray-tracing", "two-way", "scan-line", "radiosity"] {
        let options = format!("--renderer {renderer} --samples 1 --width 40 --json -o c.png");
        let few = STONES.replace("count: 700", "count: 12");
        let ended = render(&few, &options, folder.path());
        assert_eq!(ended.code, Some(0), "{renderer}: {}", ended.errors);
    }
}
