//! Databases in use: a writer that is killed, several processes at once, scripts that use what is stored.

use std::{
    path::Path,
    process::{Child, Command, Output, Stdio},
    time::{Duration, Instant},
};
use tests::TIMEOUT;

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");

fn peris(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(PERIS).args(arguments).current_dir(folder).output().expect("the program starts")
}

/// The standard output of a command that succeeds.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = peris(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

/// Exit code and standard error of a command that fails.
fn failed(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = peris(folder, arguments);
    assert!(!output.status.success(), "{arguments:?} succeeds");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).expect("the file is written");
}

const WALNUT: &str = "{\"name\": \"walnut\", \"source\": \"ours\", \"terms\": \"free\", \"material\":
    {\"body\": {\"coated\": {\"diffuse\": {\"plain\": {\"bands\": [0.2, 0.1, 0.05]}}, \"index\": 1.5, \"roughness\": 0.1}},
    \"emission\": {\"bands\": [0, 0, 0]}}}";

/// A child that is killed when the test fails.
struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A mesh file that takes a while to store.
fn large_mesh(side: usize) -> String {
    let mut text = String::new();
    for index in 0..side * side {
        text.push_str(&format!("v {} {} {}\n", index % side, index / side, (index * 7919 % 1000) as f64 / 997.0));
    }
    for y in 0..side - 1 {
        for x in 1..side {
            let corner = y * side + x;
            text.push_str(&format!("f {} {} {}\n", corner, corner + 1, corner + side));
        }
    }
    text
}

#[test]
fn a_writer_that_is_killed_loses_nothing_that_was_committed() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write(folder, "walnut.json", WALNUT);
    write(folder, "large.obj", &large_mesh(300));
    done(folder, &["db", "add", "a.redb", "walnut.json"]);
    let start = Instant::now();
    done(folder, &["db", "add", "b.redb", "large.obj"]);
    let whole = start.elapsed();
    let mut names = vec!["walnut".to_owned()];
    for round in 0..12_u32 {
        let name = format!("large {round}");
        let arguments = ["db", "add", "a.redb", "large.obj", "--name", &name];
        let mut child = Command::new(PERIS);
        child.args(arguments).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = Killed(child.spawn().expect("the program starts"));
        // At another time each round, from the beginning to after the end.
        std::thread::sleep(whole.mul_f64(f64::from(round) / 10.0));
        let _ = child.0.kill();
        let ended = child.0.wait().expect("it ends");
        let listed = done(folder, &["db", "list", "a.redb", "--kind", "geometry"]);
        if ended.success() || listed.contains(&format!("{name} ")) {
            names.push(name);
        }
        let checked = done(folder, &["db", "check", "a.redb"]);
        assert_eq!(checked, format!("a.redb: {} records are whole, 0 are not\n", names.len()), "round {round}");
        assert!(names[1..].iter().all(|name| listed.contains(name.as_str())), "round {round}: {listed}");
        assert!(done(folder, &["db", "show", "a.redb", "walnut"]).contains("\"roughness\": 0.1"));
    }
    assert!(names.len() > 1, "no writer was quick enough");
}

#[test]
fn a_first_writer_that_is_killed_leaves_no_database_or_one_that_can_be_used() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write(folder, "walnut.json", WALNUT);
    let start = Instant::now();
    done(folder, &["db", "add", "first.redb", "walnut.json"]);
    let whole = start.elapsed();
    let (mut none, mut whole_ones) = (0, 0);
    for round in 0..40_u32 {
        let name = format!("{round}.redb");
        if round % 4 == 0 {
            // An empty file is as good as none.
            write(folder, &name, "");
        }
        let mut child = Command::new(PERIS);
        child.args(["db", "add", &name, "walnut.json"]).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = Killed(child.spawn().expect("the program starts"));
        std::thread::sleep(whole.mul_f64(f64::from(round) / 36.0));
        let _ = child.0.kill();
        let _ = child.0.wait();
        let path = folder.join(&name);
        if path.metadata().is_ok_and(|found| found.len() > 0) {
            whole_ones += 1;
            done(folder, &["db", "check", &name]);
        } else {
            none += 1;
        }
        done(folder, &["db", "add", &name, "walnut.json", "--replace"]);
        assert!(done(folder, &["db", "show", &name, "walnut"]).contains("\"roughness\": 0.1"), "round {round}");
        std::fs::remove_file(path).expect("removed");
    }
    let left = std::fs::read_dir(folder).expect("a folder").count();
    assert_eq!(left, 2, "something is left");
    assert!(none > 3 && whole_ones > 3, "{none} without a database, {whole_ones} with one");
}

#[test]
fn a_writer_without_room_or_memory_leaves_the_database_as_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write(folder, "walnut.json", WALNUT);
    write(folder, "large.obj", &large_mesh(200));
    done(folder, &["db", "add", "a.redb", "walnut.json"]);
    let before = std::fs::read(folder.join("a.redb")).expect("there");
    let mut refused = 0;
    // Blocks of 512 bytes that a file may have, and KiB of memory that the process may have.
    let limits = [("-f", 64), ("-f", 3200), ("-f", 4000), ("-v", 60_000), ("-v", 120_000), ("-v", 180_000)];
    for (limit, most) in limits {
        write(folder, "a.redb", "");
        std::fs::write(folder.join("a.redb"), &before).expect("written");
        let script = format!("ulimit {limit} {most}; exec \"$0\" db add a.redb large.obj");
        let output = Command::new("sh").args(["-c", &script, PERIS]).current_dir(folder).output().expect("a shell");
        let checked = done(folder, &["db", "check", "a.redb"]);
        let records = if output.status.success() { 2 } else { 1 };
        refused += usize::from(!output.status.success());
        assert_eq!(checked, format!("a.redb: {records} records are whole, 0 are not\n"), "{script}");
    }
    assert!(refused > 1, "{refused}");
}

#[test]
fn many_read_and_write_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write(folder, "walnut.json", WALNUT);
    done(folder, &["db", "add", "a.redb", "walnut.json"]);
    let start = |arguments: &[&str]| {
        let mut child = Command::new(PERIS);
        child.args(arguments).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped());
        Killed(child.spawn().expect("the program starts"))
    };
    let mut children: Vec<Killed> = Vec::new();
    for number in 0..6 {
        children.push(start(&["db", "add", "a.redb", "walnut.json", "--name", &format!("walnut {number}")]));
        children.push(start(&["db", "show", "a.redb", "walnut"]));
    }
    let end = Instant::now() + TIMEOUT;
    for child in &mut children {
        while child.0.try_wait().expect("it runs").is_none() {
            assert!(Instant::now() < end, "a process does not end");
            std::thread::sleep(Duration::from_millis(10));
        }
        assert!(child.0.wait().expect("it ended").success());
    }
    assert!(done(folder, &["db", "check", "a.redb"]).starts_with("a.redb: 7 records are whole"));
}

#[test]
fn what_is_exported_can_be_added_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done(folder, &["db", "export", "shipped", "bunny", "bunny.obj"]);
    done(folder, &["db", "export", "shipped", "cobalt_blue", "blue.txt"]);
    done(folder, &["db", "export", "shipped", "copper", "--kind", "material", "copper.json"]);
    for file in ["bunny.obj", "blue.txt", "copper.json"] {
        done(folder, &["db", "add", "a.redb", file]);
    }
    let (_, errors) = failed(folder, &["db", "add", "a.redb", "blue.txt"]);
    assert!(errors.contains("there is a spectrum \"cobalt_blue\" already; --replace lets it give way"), "{errors}");
    done(folder, &["db", "add", "a.redb", "blue.txt", "--replace"]);
    for (name, file, again) in
        [("bunny", "bunny.obj", "b.obj"), ("cobalt_blue", "blue.txt", "b.txt"), ("copper", "copper.json", "b.json")]
    {
        done(folder, &["db", "export", "a.redb", name, again]);
        let read = |name: &str| std::fs::read(folder.join(name)).expect("a file");
        assert!(read(file) == read(again), "{name}");
    }
    done(folder, &["db", "remove", "a.redb", "bunny"]);
    let (code, errors) = failed(folder, &["db", "show", "a.redb", "bunny"]);
    assert_eq!(code, Some(2));
    assert!(errors.contains("no record is called \"bunny\"; there are cobalt_blue, copper"), "{errors}");
    assert!(done(folder, &["db", "list"]).contains("terms: CC0 1.0, public domain."));
}

#[test]
fn a_script_uses_what_is_stored() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write(folder, "walnut.json", WALNUT);
    write(folder, "oak.txt", "nm old_oak\n400 0.05\n500 0.1\n600 0.2\n700 0.3\n");
    let lamp =
        "{\"name\": \"lamp\", \"light\": {\"point\": {\"at\": [0, 9, 3], \"intensity\": {\"bands\": [90, 90, 90]}}}}";
    write(folder, "lamp.json", lamp);
    write(folder, "tile.obj", "v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n");
    for file in ["walnut.json", "oak.txt", "lamp.json", "tile.obj"] {
        done(folder, &["db", "add", "a.redb", file]);
    }
    let scene = "use_database(\"a.redb\"); stored_light(\"lamp\"); ground(9).material(#{ diffuse: \"old_oak\" });
        sphere(1).translate(0, 1, 0).stored(\"walnut\").name(\"ball\"); stored_mesh(\"tile\").material(#{ diffuse: \"cedar\" });
        box(1).stored(\"gold\").translate(2, 0.5, 0);";
    write(folder, "scene.rhai", scene);
    done(folder, &["render", "scene.rhai", "--width", "32", "--samples", "1", "-o", "a.png"]);
    done(folder, &["db", "add", "b.redb", "scene.rhai"]);
    assert!(done(folder, &["db", "list", "b.redb", "--kind", "material"]).contains("ball"));
    for (script, problem) in [
        ("sphere(1).stored(\"teak\");", "no material is called \"teak\"; there are copper, gold,"),
        (
            "sphere(1).material(#{ diffuse: \"teak\" });",
            "diffuse: no reflectance is called \"teak\"; there are dark_skin,",
        ),
        ("use_database(\"none.redb\");", "none.redb: No such file"),
        ("stored_light(\"lamp\");", "no light is called \"lamp\"; there are none"),
    ] {
        write(folder, "wrong.rhai", script);
        let (code, errors) = failed(folder, &["render", "wrong.rhai", "-o", "a.png"]);
        assert!(code == Some(3) && errors.contains(problem) && errors.contains("wrong.rhai:1:"), "{errors}");
    }
}

#[test]
fn a_script_lays_a_stored_picture_on_a_surface() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    // A picture of one grey, rendered: the ambient light on a half reflecting floor.
    write(
        folder,
        "grey.rhai",
        "image(4, 4); ground(9).material(0.5); ambient(1); camera(#{ from: [0, 9, 0.1], at: [0, 0, 0] });",
    );
    done(folder, &["render", "grey.rhai", "-o", "grey.exr"]);
    done(folder, &["db", "add", "a.redb", "grey.exr"]);
    std::fs::remove_file(folder.join("grey.exr")).expect("removed");
    let script = "use_database(\"a.redb\"); image(4, 4); ground(9).material(picture(\"grey\")); ambient(1); camera(#{ from: [0, 9, 0.1], at: [0, 0, 0] });";
    write(folder, "b.rhai", script);
    let told = done(folder, &["render", "b.rhai", "--pixel", "2,2", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    assert!((told["radiance"][0].as_f64().expect("a number") - 0.5).abs() < 1e-4, "{told}");
    write(folder, "c.rhai", &script.replace("\"grey\"", "\"none\""));
    let (code, errors) = failed(folder, &["render", "c.rhai", "--pixel", "2,2"]);
    assert!(code == Some(3) && errors.contains("none"), "{errors}");
}
