//! The front page holds what it says: it is short, and everything on it that can be run is run, in order, in one
//! folder.

use std::{fs, os::unix::fs::symlink, path::Path, time::Duration};
use tests::run;

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const LIMIT: Duration = Duration::from_secs(300);
const MOST_WORDS: usize = 900;

/// What is to be done, in the order of the page.
#[derive(Debug, PartialEq)]
enum Step {
    /// A script with its name.
    Script(String, String),
    /// A command line.
    Command(String),
}

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    fs::read_to_string(path).expect("there is a front page")
}

/// The blocks of the page, and the commands of its tables.
fn steps(page: &str) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        match line.strip_prefix("```") {
            Some(language) => {
                let block: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
                match language {
                    "js" => {
                        let name =
                            block[0].strip_prefix("// ").and_then(|rest| rest.split_once(':')).expect("a name").0;
                        steps.push(Step::Script(name.into(), block.join("\n")));
                    }
                    "sh" => steps.extend(block.iter().map(|line| Step::Command((*line).into()))),
                    other => panic!("nobody runs a block of '{other}'"),
                }
            }
            None => {
                let cells = line.split('|').filter_map(|cell| cell.trim().strip_prefix('`')?.strip_suffix('`'));
                let commands = cells.filter(|cell| cell.starts_with("peris ") || cell.starts_with("ps340 "));
                steps.extend(commands.map(|command| Step::Command(command.into())));
            }
        }
    }
    steps
}

#[test]
fn the_front_page_is_short_and_what_stands_there_works() {
    let page = page();
    let words = page.split_whitespace().count();
    assert!(words <= MOST_WORDS, "{words} words");
    let folder = tempfile::tempdir().expect("a folder");
    let programs = folder.path().join("programs");
    fs::create_dir(&programs).expect("made");
    for (name, program) in [("peris", PERIS), ("ps340", PS340)] {
        symlink(program, programs.join(name)).expect("linked");
    }
    let path = format!("{}:/usr/local/bin:/usr/bin:/bin", programs.display());
    let environment = [("PATH", path.as_str()), ("PERIS_PS340", PS340), ("DISPLAY", ""), ("WAYLAND_DISPLAY", "")];
    let mut ran = 0;
    for step in steps(&page) {
        match step {
            Step::Script(name, text) => fs::write(folder.path().join(name), text).expect("written"),
            // Whoever runs this test has built and tests; the path is set.
            Step::Command(command) if command.starts_with("cargo ") || command.starts_with("export ") => {}
            Step::Command(command) => {
                let ended = run("/bin/sh", &["-c", &command], &environment, folder.path(), LIMIT);
                assert_eq!(ended.code, Some(0), "{command}: {}{}", ended.out, ended.errors);
                ran += 1;
            }
        }
    }
    assert!(ran > 10, "only {ran} commands");
    // The command beside its picture of the window is one of them, without a window here.
    let ended = run("/bin/sh", &["-c", "peris show gear.rhai --headless"], &environment, folder.path(), LIMIT);
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
}

#[test]
fn every_link_of_the_documents_leads_to_a_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let documents = [
        "README.md",
        "host/docs/guide.md",
        "host/docs/gallery.md",
        "ps340/docs/guide.md",
        "ps340/COMPATIBILITY.md",
        "tests/FIGURES.md",
    ];
    for document in documents {
        let path = root.join(document);
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{document}: {error}"));
        let links = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
        let pictures = text.split("src=\"").skip(1).filter_map(|rest| rest.split_once('"'));
        for (target, _) in links.chain(pictures) {
            let target = target.split('#').next().unwrap_or_default();
            if !target.is_empty() && !target.starts_with("http") {
                let file = path.parent().expect("a folder").join(target);
                assert!(file.exists(), "{document}: {target} is not there");
            }
        }
    }
}
