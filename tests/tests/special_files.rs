//! Devices, pipes and folders in the place of files: refused at once, by name, before anything is read or written.

use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tests::TIMEOUT;

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");

/// Runs a program that must not wait for what never comes.
fn run(program: &str, folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let end = Instant::now() + TIMEOUT;
    while child.try_wait().expect("it runs").is_none() {
        if Instant::now() > end {
            let _ = child.kill();
            panic!("{arguments:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().expect("it ended")
}

#[test]
fn what_is_no_ordinary_file_is_refused_wherever_one_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for ending in ["rhai", "stl", "obj", "ply", "glb", "cmesh", "octree", "png", "exr", "txt", "json", "ies"] {
        symlink("/dev/zero", folder.join(format!("zero.{ending}"))).expect("a link");
        let pipe = folder.join(format!("pipe.{ending}"));
        rustix::fs::mknodat(rustix::fs::CWD, pipe, rustix::fs::FileType::Fifo, 0o600.into(), 0).expect("a pipe");
    }
    for name in ["zero", "pipe"] {
        let script = format!("luminaire(#{{ at: [0, 3, 0], file: \"{name}.ies\" }}); sphere(1);");
        std::fs::write(folder.join(format!("{name}-lit.rhai")), script).expect("written");
        let file = |ending: &str| format!("{name}.{ending}");
        let mut commands: Vec<Vec<String>> = vec![
            vec!["render".into(), file("rhai"), "-o".into(), "a.png".into()],
            ["render", &format!("{name}-lit.rhai"), "-o", "a.png", "--allow", "/dev"].map(str::to_owned).to_vec(),
            vec!["octree".into(), file("octree")],
            vec!["diff".into(), file("png"), file("exr")],
            vec!["compose".into(), file("exr"), "over".into(), file("exr"), "-o".into(), "a.png".into()],
            vec!["db".into(), "add".into(), "a.redb".into(), file("txt")],
            vec!["db".into(), "add".into(), "a.redb".into(), file("json")],
        ];
        for ending in ["stl", "obj", "ply", "glb", "cmesh", "octree"] {
            commands.push(vec!["render".into(), file(ending), "-o".into(), "a.png".into()]);
        }
        for ending in ["stl", "obj", "ply", "glb", "cmesh"] {
            commands.push(vec!["check".into(), file(ending)]);
        }
        for command in commands {
            let arguments: Vec<&str> = command.iter().map(String::as_str).collect();
            let output = run(PERIS, folder, &arguments);
            let said = String::from_utf8_lossy(&output.stderr);
            let is_named = said.contains("device, pipe or socket") && said.contains(&format!("{name}."));
            assert!(!output.status.success() && is_named, "{arguments:?}: {said}");
        }
    }
    assert!(!folder.join("a.png").exists() && !folder.join("a.redb").exists());
}

#[test]
fn what_is_no_ordinary_file_is_refused_wherever_one_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    symlink("/dev/null", folder.join("null.png")).expect("a link");
    symlink("/dev/null", folder.join("null.stl")).expect("a link");
    symlink("/dev/null", folder.join("null.redb")).expect("a link");
    std::fs::create_dir(folder.join("folder.png")).expect("made");
    let refused = |program: &str, arguments: &[&str], expected: &str| {
        let output = run(program, folder, arguments);
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(said.contains("writing ") && said.contains(expected), "{arguments:?}: {said}");
    };
    let device = "device, pipe or socket";
    refused(PERIS, &["render", "teapot", "-o", "null.png"], device);
    refused(PERIS, &["render", "teapot", "-o", "folder.png"], "this is a folder");
    refused(PERIS, &["render", "teapot", "--resume", "null.png", "-o", "a.png"], device);
    refused(PERIS, &["tessellate", "teapot", "-o", "null.stl"], device);
    refused(PERIS, &["db", "add", "null.redb", "a.txt"], device);
    std::fs::write(folder.join("a.play"), "@ picture vector null.png\n@ graph network folder.png\n").expect("written");
    refused(PS340, &["play", "a.play", "--keep-going", "--orders"], "this is a link, and stays as it is");
    refused(PS340, &["play", "a.play", "--keep-going", "--orders"], "this is a folder");
    refused(PS340, &["play", "--example", "helix", "--picture", "folder.png"], "this is a folder");
    refused(PS340, &["play", "--example", "helix", "--transcript", "null.png"], device);
    let is_device =
        std::os::unix::fs::FileTypeExt::is_char_device(&std::fs::metadata("/dev/null").expect("there").file_type());
    assert!(is_device && !folder.join("a.png").exists());
}

#[test]
fn a_script_of_somebody_else_reads_below_its_folder_and_commands_no_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let [own, other] = ["scenes", "other"].map(|name| folder.path().join(name));
    std::fs::create_dir(&own).and_then(|()| std::fs::create_dir(&other)).expect("made");
    std::fs::write(other.join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    symlink(other.join("a.obj"), own.join("link.obj")).expect("a link");
    for outside in ["../other/a.obj", "link.obj"] {
        std::fs::write(own.join("a.rhai"), format!("mesh(\"{outside}\");")).expect("written");
        let refused = run(PERIS, &own, &["plan", "a.rhai"]);
        let said = String::from_utf8_lossy(&refused.stderr);
        assert!(!refused.status.success() && said.contains("a.rhai:1:1") && said.contains("--allow"), "{said}");
        assert!(run(PERIS, &own, &["plan", "a.rhai", "--allow", "../other"]).status.success());
    }
    let print = ("print(\"a\\x1b]0;b\\x07\"); sphere(1);", "\\u{1b}]0;b\\u{7}");
    let name = ("mesh(\"\\x1b[2Jnone.obj\");", "\\u{1b}[2Jnone.obj");
    for (script, shown) in [print, name] {
        std::fs::write(own.join("a.rhai"), script).expect("written");
        let Output { stdout, stderr, .. } = run(PERIS, &own, &["plan", "a.rhai"]);
        let said = String::from_utf8_lossy(&stderr);
        assert!(said.contains(shown), "{said}");
        assert!(![stdout, stderr].concat().contains(&0x1b));
    }
}
