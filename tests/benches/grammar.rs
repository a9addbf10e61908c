//! Modules that L-systems derive in a second, and modules that a turtle obeys, beside an interpreter in Python.
//!
//! A module counts once for each step that writes it. Grammars are those of "The Algorithmic Beauty of Plants" with
//! more steps than their pictures, and a few more. Before the figures count, strings are compared with numbers that are
//! known in closed form, with those of two threads, and, where a grammar has neither parameters nor contexts, with the
//! strings of the Python program, which replaces letters by `str.translate`. Figures are medians of `PASSES` passes,
//! 5: of one thread by seconds of the processor, so that other work on the machine does not count; of two by the wall.
//! `cargo bench -p tests --bench grammar`

use host::procedural::grammar::{ABOP_FIGURES, EmptyEnvironment, LSystem, ModuleString, Specimen};
use std::time::Instant;

/// Millions of modules a second that are required without parameters and contexts, and with them.
const PLAIN: f64 = 10.0;
const OTHER: f64 = 2.0;
/// Segments with two side branches each along which a signal runs.
const SEGMENTS: usize = 6500;

/// What a grammar has that takes time.
#[derive(Clone, Copy, PartialEq)]
enum Class {
    Plain,
    Chance,
    Parametric,
    Context,
}

/// A module and how many there are after so many steps.
type Known = (&'static str, fn(u32) -> usize);

/// A grammar that is measured.
struct Row {
    name: &'static str,
    class: Class,
    /// Of the shorter and of the longer derivation.
    steps: [u32; 2],
    known: Option<Known>,
}

const fn row(name: &'static str, class: Class, steps: [u32; 2]) -> Row {
    Row { name, class, steps, known: None }
}

const fn counted(row: Row, module: &'static str, count: fn(u32) -> usize) -> Row {
    Row { known: Some((module, count)), ..row }
}

const ROWS: [Row; 14] = [
    counted(row("hilbert", Class::Plain, [9, 11]), "F", |n| 4_usize.pow(n) - 1),
    counted(row("dragon", Class::Plain, [18, 21]), "Fl", |n| 1 << (n - 1)),
    counted(row("koch_island", Class::Plain, [5, 7]), "F", |n| 4 * 8_usize.pow(n)),
    counted(row("branching_f", Class::Plain, [8, 10]), "X", |n| 4_usize.pow(n)),
    row("branching_by_chance", Class::Chance, [8, 10]),
    counted(row("ternary", Class::Parametric, [10, 12]), "A", |n| 3_usize.pow(n)),
    row("row_of_trees", Class::Parametric, [14, 18]),
    counted(row("monopodial", Class::Parametric, [16, 19]), "A", |_| 1),
    row("capsella", Class::Parametric, [200, 400]),
    row("shoots_by_chance", Class::Parametric, [28, 33]),
    counted(row("signal_far", Class::Context, [100, 200]), "b", |_| 2),
    row("hogeweg_hesper_a", Class::Context, [40, 52]),
    row("mycelis", Class::Context, [45, 90]),
    row("anabaena", Class::Context, [300, 430]),
];

/// The text of a grammar.
fn text(name: &str) -> String {
    match name {
        "signal_far" => format!("#ignore: + -\naxiom: b{}\nb < a -> b\nb -> a", "[+a]a[-a]a".repeat(SEGMENTS)),
        "shoots_by_chance" => "axiom: A(1)\nA(l) -> F(l)[+(ran(60))A(l*0.9)]/(137.5)A(l*0.8) : 0.6\n\
            A(l) -> F(nran(l,0.1))A(l*0.9) : 0.4"
            .to_owned(),
        _ => ABOP_FIGURES.iter().find(|figure| figure.name == name).expect("a figure").grammar.to_owned(),
    }
}

fn derive(specimen: &Specimen, steps: u32) -> ModuleString {
    specimen.derive(Some(steps), &EmptyEnvironment).expect("a string")
}

/// Modules that all steps write.
fn written(specimen: &Specimen, steps: u32) -> usize {
    (1..=steps).map(|step| derive(specimen, step).len()).sum()
}

/// Seconds of the processor that this thread has used.
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn main() {
    let passes = std::env::var("PASSES").ok().and_then(|text| text.parse().ok()).unwrap_or(5_usize).max(1);
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let (one, two) = (pool(1), pool(2));
    if let Err(reason) = python("F", &[], 0) {
        println!("python3: {reason}");
    }
    println!("millions of modules a second, [required]; growth is the power of the modules by which time grows");
    println!(
        "{:<20} {:>5} {:>9} {:>12} {:>7} {:>7} {:>9} {:>7}",
        "grammar", "steps", "modules", "derived", "growth", "two", "drawn", "Python"
    );
    let of_processor = |work: &dyn Fn()| {
        let pass = |_| {
            let start = processor_seconds();
            work();
            processor_seconds() - start
        };
        median((0..passes).map(pass).collect())
    };
    for row in &ROWS {
        let system = LSystem::parse(&text(row.name)).expect("a grammar");
        let specimen = Specimen::new(&system, 1, &[]).expect("a specimen");
        let [few, steps] = row.steps;
        let modules = two.install(|| [written(&specimen, few), written(&specimen, steps)]);
        let string = two.install(|| derive(&specimen, steps));
        assert!(one.install(|| derive(&specimen, steps)) == string, "{}: threads differ", row.name);
        if let Some((module, count)) = row.known {
            assert_eq!(string.count(module), count(steps), "{}", row.name);
        }
        let python = compared(row, &string, modules[1]);
        let [short, long] = [few, steps].map(|steps| one.install(|| of_processor(&|| drop(derive(&specimen, steps)))));
        let wall = |_| {
            let start = Instant::now();
            two.install(|| drop(derive(&specimen, steps)));
            start.elapsed().as_secs_f64()
        };
        let wall = median((0..passes).map(wall).collect());
        let drawn = of_processor(&|| drop(specimen.draw(&string).expect("a drawing")));
        let rate = |seconds: f64| modules[1] as f64 / seconds / 1e6;
        let growth = (long / short).ln() / (modules[1] as f64 / modules[0] as f64).ln();
        let required = if row.class == Class::Plain { PLAIN } else { OTHER };
        println!(
            "{:<20} {steps:>5} {:>9} {:>7.1} {:>4} {growth:>7.2} {:>7.1} {:>9.1} {:>7}",
            row.name,
            string.len(),
            rate(long),
            format!("[{required}]"),
            rate(wall),
            string.len() as f64 / drawn / 1e6,
            python.map_or("-".to_owned(), |seconds| format!("{:.2}", rate(seconds)))
        );
    }
}

/// Compares a string without parameters with that of the Python program; gives the seconds that the program took, where
/// there is one.
fn compared(row: &Row, string: &ModuleString, written: usize) -> Option<f64> {
    if row.class != Class::Plain {
        return None;
    }
    // Names of two letters stand as one letter there.
    let short = |text: &str| text.replace("Fl", "l").replace("Fr", "r");
    let text = text(row.name);
    let derivation = text.split("interpretation:").next().unwrap_or_default();
    let statements = || derivation.lines().filter(|line| !line.starts_with('#'));
    let axiom = statements().find_map(|line| line.strip_prefix("axiom: ")).expect("an axiom");
    let rules: Vec<(String, String)> = statements()
        .filter_map(|line| line.split_once(" -> "))
        .map(|(letter, successor)| (short(letter), short(successor)))
        .collect();
    let (all, length, hash, seconds) = python(&short(axiom), &rules, row.steps[1]).ok()?;
    let letters: String = short(&string.to_string());
    let own = u64::from(crc32fast::hash(letters.as_bytes()));
    assert_eq!((all, length, hash), (written as u64, string.len() as u64, own), "{}", row.name);
    Some(seconds)
}

/// Derives a string of letters in Python; gives the letters that all steps wrote, the letters of the last, their CRC-32
/// and the seconds of the processor that the steps took.
///
/// # Errors
/// A line that says why there is none.
fn python(axiom: &str, rules: &[(String, String)], steps: u32) -> Result<(u64, u64, u64, f64), String> {
    let program = "import sys, time, zlib\n\
        axiom, steps, rules = sys.argv[1], int(sys.argv[2]), sys.argv[3:]\n\
        table = str.maketrans(dict(zip(rules[::2], rules[1::2])))\n\
        start, written = time.process_time(), 0\n\
        for step in range(steps):\n    axiom = axiom.translate(table)\n    written += len(axiom)\n\
        seconds = time.process_time() - start\n\
        print(written, len(axiom), zlib.crc32(axiom.encode()), seconds)";
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut command = std::process::Command::new(python);
    command.args(["-c", program, axiom, &steps.to_string()]);
    command.args(rules.iter().flat_map(|(letter, successor)| [letter, successor]));
    let output = command.output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let whole = |word: usize| text.split_whitespace().nth(word).and_then(|word| word.parse().ok());
    let seconds = text.split_whitespace().nth(3).and_then(|word| word.parse().ok());
    let found = whole(0).zip(whole(1)).zip(whole(2)).zip(seconds);
    let (((written, length), hash), seconds) = found.ok_or_else(|| format!("{}", output.status))?;
    Ok((written, length, hash, seconds))
}
