//! How fast text vector lists are read, MB/s on one core: the parser alone, and the reader with its stream in pieces.

use protocol::command::{Command, CommandReader, Object, parse};
use std::{fmt::Write, time::Instant};

/// Vectors in a list: about a megabyte.
const COUNT: usize = 40_000;

/// Bytes that arrive at once.
const PIECE: usize = 64 << 10;

/// A list whose vectors `row` writes from three numbers between -1 and 1.
fn list(options: &str, row: impl Fn(&mut String, usize, [f64; 3])) -> String {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut text = format!("V := VECTOR_LIST {options} N={COUNT}");
    for index in 0..COUNT {
        text.push('\n');
        row(&mut text, index, [random(), random(), random()]);
    }
    text + ";"
}

/// The shortest of many short runs, seconds, so that other programs on the machine do not count.
fn best(mut work: impl FnMut() -> Command) -> f64 {
    let run = |work: &mut dyn FnMut() -> Command| {
        let start = Instant::now();
        let command = work();
        let seconds = start.elapsed().as_secs_f64();
        let Command::Define { object: Object::VectorList(list), .. } = command else {
            panic!("a vector list was expected");
        };
        assert_eq!(list.points.len(), COUNT);
        seconds
    };
    (0..60).map(|_| run(&mut work)).fold(f64::INFINITY, f64::min)
}

fn main() {
    let rows = [
        (
            "itemized 3D, 4 digits",
            list("ITEMIZED", |text, i, [x, y, z]| {
                let _ = write!(text, "{} {x:.4},{y:.4},{z:.4}", if i % 5 == 0 { 'P' } else { 'L' });
            }),
        ),
        (
            "itemized 3D, 7 digits",
            list("ITEMIZED", |text, i, [x, y, z]| {
                let _ = write!(text, "{} {x:.7},{y:.7},{z:.7}", if i % 5 == 0 { 'P' } else { 'L' });
            }),
        ),
        (
            "itemized 3D, exponents",
            list("ITEMIZED", |text, i, [x, y, z]| {
                let _ = write!(text, "{} {x:.6E} {y:.6E} {z:.6E}", if i % 5 == 0 { 'P' } else { 'L' });
            }),
        ),
        (
            "connected 2D, 3 digits",
            list("", |text, _, [x, y, _]| {
                let _ = write!(text, "{x:.3},{y:.3}");
            }),
        ),
        (
            "separate 3D, intensities",
            list("SEPARATE", |text, _, [x, y, z]| {
                let _ = write!(text, "{x:.3},{y:.3},{z:.3} I={:.2}", z.abs());
            }),
        ),
        (
            "colour, whole numbers",
            list("COLOR ITEMIZED", |text, _, [x, y, z]| {
                let _ = write!(text, "L{:.0},{:.0} H={:.0}", 1e3 * x, 1e3 * y, 360.0 * z.abs());
            }),
        ),
    ];
    println!("{:26} {:>8} {:>8}", "list", "parse", "reader");
    for (name, text) in &rows {
        let megabytes = text.len() as f64 / 1e6;
        let whole = best(|| parse(text.as_bytes()).expect("the list is good"));
        let pieces = best(|| {
            let mut reader = CommandReader::default();
            let mut commands = Vec::new();
            for piece in text.as_bytes().chunks(PIECE) {
                reader.push(piece);
                commands.extend(&mut reader);
            }
            commands.remove(0).expect("the list is good").command
        });
        println!("{name:26} {:8.0} {:8.0}", megabytes / whole, megabytes / pieces);
    }
}
