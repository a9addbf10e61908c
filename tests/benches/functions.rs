//! Function firings a second: chains of reals and of matrices, fan-out and fan-in, vector arithmetic. The firings and
//! each answer of a round are checked before any time counts.
//!
//! Times are seconds of the processor, where the system counts them, so that other work on the machine does not
//! count; else seconds of the wall. Pure Data runs the same chains beside it where it is installed; its own limit is
//! a depth of 1,000. `cargo bench -p tests --bench functions`

use protocol::{Value, command::Input};
use ps340::{
    functions::find,
    network::Network,
    port::{Effect, Literal, ObjectId},
};
use std::{
    process::{Command, Stdio},
    time::Instant,
};

/// Each case runs so often; the best time counts, since other work disturbs.
const REPEATS: usize = 15;
/// About so many firings in each run of a case.
const FIRINGS: u64 = 2_000_000;
/// Lengths of the chains.
const LENGTHS: [u32; 5] = [10, 100, 1_000, 10_000, 100_000];
/// Messages that are on their way at the same time.
const UNDER_WAY: u64 = 64;
/// The object at the end of each network: none, so that its messages come out as effects.
const END: ObjectId = ObjectId(0);

fn main() {
    // `cargo bench` passes `--bench`; without it one short round proves the answers.
    let (repeats, firings) = if std::env::args().any(|a| a == "--bench") { (REPEATS, FIRINGS) } else { (1, 200_000) };
    println!("{:<44} {:>16} {:>12}", "function network", "firings/s", "ns a firing");
    for (kind, target) in [(&REALS, 50e6), (&MATRICES, 20e6)] {
        let mut slowest = f64::INFINITY;
        for length in LENGTHS {
            for under_way in [1, UNDER_WAY] {
                let mut chain = Chain::new(kind, length);
                chain.prove(under_way);
                let messages = (firings / u64::from(length)).max(under_way);
                let rate = best(repeats, || chain.run(under_way, messages));
                row(&format!("chain of {length} {}, {under_way} under way", kind.name), rate);
                slowest = slowest.min(rate);
            }
        }
        println!("slowest chain of {}: {:.1} million/s (target {:.0})", kind.name, slowest / 1e6, target / 1e6);
    }
    let rate = best(repeats, || fan(1_000, firings / 2_001));
    row("fan-out to 1000 ADDC, fan-in to one", rate);
    let rate = best(repeats, || vectors(1_000, firings / 2_000));
    row("1000 pairs of MULC and ACCUMULATE, 3D vectors", rate);
    for length in [10, 900] {
        let name = format!("Pure Data, chain of {length} [+ 1]");
        match pure_data(length, (firings * 10 / u64::from(length)).max(1)) {
            Ok(rate) => row(&name, rate),
            Err(why) => println!("{name:<44} {why:>16}"),
        }
    }
}

fn row(name: &str, rate: f64) {
    println!("{name:<44} {rate:>16.0} {:>12.1}", 1e9 / rate);
}

/// The best rate of several runs, in firings a second.
fn best(repeats: usize, mut run: impl FnMut() -> (u64, f64)) -> f64 {
    (0..repeats).map(|_| run()).map(|(firings, seconds)| firings as f64 / seconds).fold(0.0, f64::max)
}

/// Measures seconds that this thread had the processor.
struct Stopwatch {
    processor: Option<f64>,
    wall: Instant,
}

impl Stopwatch {
    fn start() -> Stopwatch {
        Stopwatch { processor: Stopwatch::processor(), wall: Instant::now() }
    }

    fn seconds(&self) -> f64 {
        match (self.processor, Stopwatch::processor()) {
            (Some(start), Some(end)) if end > start => end - start,
            _ => self.wall.elapsed().as_secs_f64(),
        }
    }

    /// Seconds that this thread has had the processor, where the system counts them.
    #[cfg(unix)]
    fn processor() -> Option<f64> {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Some(time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9)
    }

    #[cfg(not(unix))]
    fn processor() -> Option<f64> {
        None
    }
}

fn define(network: &mut Network, id: u32, function: &str, constants: &[(u32, Literal)]) {
    let row = find(function).expect("the table has the function");
    network.define(ObjectId(id), row, None).expect("the function has no size");
    for (input, value) in constants {
        network.send(ObjectId(id), Input::Number(*input), value.value(), &mut Vec::new());
    }
}

fn connect(network: &mut Network, from: u32, to: u32) {
    network.connect(ObjectId(from), 1, ObjectId(to), Input::Number(1)).expect("both exist");
}

/// What runs through a chain.
struct Kind {
    name: &'static str,
    function: &'static str,
    /// What each function has at its constant input.
    constant: Literal,
    /// Message `i` at the start of the chain.
    start: fn(i: u64) -> Value,
    /// Message `i` at the end of a chain of so many functions.
    end: fn(i: u64, length: u32) -> Value,
}

const REALS: Kind = Kind {
    name: "ADDC, reals",
    function: "ADDC",
    constant: Literal::R(1.0),
    start: |i| Value::Real(i as f64),
    end: |i, length| Value::Real(i as f64 + f64::from(length)),
};

/// A quarter turn and a shear of the rest: integers, so that the products are exact.
const MATRICES: Kind = Kind {
    name: "MULC, 4x4 matrices",
    function: "MULC",
    constant: Literal::M4(STEP),
    start: |i| Literal::M4(first_matrix(i)).value(),
    end: |i, length| {
        // After n steps: n mod 4 quarter turns of the first two columns, and n times the fourth column in the third.
        let rows = first_matrix(i).map(|[x, y, z, w]| {
            let [x, y] = [[x, y], [-y, x], [-x, -y], [y, -x]][length as usize % 4];
            [x, y, z + f64::from(length) * w, w]
        });
        Literal::M4(rows).value()
    },
};

/// Each row (x, y, z, w) becomes (-y, x, z + w, w).
const STEP: [[f64; 4]; 4] = [[0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]];

fn first_matrix(i: u64) -> [[f64; 4]; 4] {
    let n = (i % 1_000) as f64;
    [[1.0, 2.0, n, 1.0], [n, 3.0, 4.0, 2.0], [5.0, n, 6.0, 3.0], [7.0, 8.0, 9.0, n]]
}

/// A chain of functions; messages leave it at [`END`].
struct Chain {
    kind: &'static Kind,
    length: u32,
    network: Network,
    effects: Vec<Effect>,
}

impl Chain {
    fn new(kind: &'static Kind, length: u32) -> Chain {
        let mut network = Network::new();
        for id in 1..=length {
            define(&mut network, id, kind.function, &[(2, kind.constant)]);
        }
        for id in 1..=length {
            connect(&mut network, id, if id == length { END.0 } else { id + 1 });
        }
        Chain { kind, length, network, effects: Vec::new() }
    }

    /// Sends so many messages at once and lets them all come out.
    fn batch(&mut self, first: u64, under_way: u64) -> u64 {
        self.effects.clear();
        for i in first..first + under_way {
            self.network.send(ObjectId(1), Input::Number(1), (self.kind.start)(i), &mut self.effects);
        }
        self.network.run(u64::MAX, &mut self.effects).firings
    }

    /// Checks every message of two batches, and the firings that they took.
    fn prove(&mut self, under_way: u64) {
        for batch in 0..2 {
            let first = batch * under_way;
            let firings = self.batch(first, under_way);
            assert_eq!(firings, under_way * u64::from(self.length), "each function fires once for each message");
            assert_eq!(self.effects.len() as u64, under_way);
            for (i, effect) in (first..).zip(&self.effects) {
                let Effect::Deliver { object: END, value, .. } = effect else { panic!("{effect:?}") };
                assert_eq!(*value, (self.kind.end)(i, self.length));
            }
        }
    }

    /// Firings and seconds of so many messages.
    fn run(&mut self, under_way: u64, messages: u64) -> (u64, f64) {
        let start = Stopwatch::start();
        let firings = (0..messages / under_way).map(|batch| self.batch(batch * under_way, under_way)).sum();
        let seconds = start.seconds();
        assert_eq!(firings, messages / under_way * under_way * u64::from(self.length));
        (firings, seconds)
    }
}

/// One message goes to many functions, whose results meet in an accumulator.
fn fan(width: u32, rounds: u64) -> (u64, f64) {
    let mut network = Network::new();
    let (source, sum) = (width + 1, width + 2);
    define(&mut network, source, "NOP", &[]);
    define(&mut network, sum, "ACCUMULATE", &[(2, Literal::I(0))]);
    connect(&mut network, sum, END.0);
    for id in 1..=width {
        define(&mut network, id, "ADDC", &[(2, Literal::I(1))]);
        connect(&mut network, source, id);
        connect(&mut network, id, sum);
    }
    let mut effects = Vec::new();
    let start = Stopwatch::start();
    let mut firings = 0;
    for round in 1..=rounds {
        effects.clear();
        network.send(ObjectId(source), Input::Number(1), Value::Integer(1), &mut effects);
        firings += network.run(u64::MAX, &mut effects).firings;
        let total = Value::Integer((round * u64::from(width) * 2) as i32);
        assert!(matches!(effects.last(), Some(Effect::Deliver { value, .. }) if *value == total));
    }
    (firings, start.seconds())
}

/// Many dials: a vector is scaled, and accumulated.
fn vectors(pairs: u32, rounds: u64) -> (u64, f64) {
    let mut network = Network::new();
    for pair in 0..pairs {
        let (scale, sum) = (2 * pair + 1, 2 * pair + 2);
        define(&mut network, scale, "MULC", &[(2, Literal::R(0.5))]);
        define(&mut network, sum, "ACCUMULATE", &[(2, Literal::V3([0.0; 3]))]);
        connect(&mut network, scale, sum);
        connect(&mut network, sum, END.0);
    }
    let mut effects = Vec::new();
    let start = Stopwatch::start();
    let mut firings = 0;
    for round in 1..=rounds {
        effects.clear();
        for pair in 0..pairs {
            let turn = Literal::V3([1.0, 2.0, -4.0]).value();
            network.send(ObjectId(2 * pair + 1), Input::Number(1), turn, &mut effects);
        }
        firings += network.run(u64::MAX, &mut effects).firings;
        let r = round as f64;
        let total = Literal::V3([0.5 * r, r, -2.0 * r]).value();
        assert!(effects.iter().all(|e| matches!(e, Effect::Deliver { value, .. } if *value == total)));
        assert_eq!(effects.len(), pairs as usize);
    }
    (firings, start.seconds())
}

/// The rate of the same chain in Pure Data, in messages a second.
fn pure_data(length: u32, messages: u64) -> Result<f64, String> {
    let patch = tempfile::Builder::new().suffix(".pd").tempfile().map_err(|e| e.to_string())?;
    std::fs::write(patch.path(), chain_patch(length, messages)).map_err(|e| e.to_string())?;
    let child =
        Command::new("pd").args(["-nogui", "-batch", "-stderr"]).arg(patch.path()).stdin(Stdio::null()).output();
    let output = child.map_err(|_| "not installed".to_owned())?;
    let text = String::from_utf8_lossy(&output.stderr);
    let number = |label: &str| -> Result<f64, String> {
        let line = text.lines().find_map(|line| line.strip_prefix(label)).ok_or("no answer")?;
        line.trim_matches([':', ' ']).parse().map_err(|_| "no answer".to_owned())
    };
    if number("answer")? != f64::from(length) {
        return Err("wrong answer".into());
    }
    Ok(messages as f64 * f64::from(length) / (number("milliseconds")? / 1e3))
}

/// A patch that sends zeros through a chain of `[+ 1]` and prints the last answer and the time.
fn chain_patch(length: u32, messages: u64) -> String {
    let mut patch = String::from("#N canvas 0 0 450 300 10;\n");
    let objects = [
        "obj 0 0 loadbang".to_owned(),
        "obj 0 0 t b b b b".to_owned(),
        "obj 0 0 cputime".to_owned(),
        format!("msg 0 0 {messages}"),
        "obj 0 0 until".to_owned(),
        "msg 0 0 0".to_owned(),
        "obj 0 0 f".to_owned(),
        "obj 0 0 print answer".to_owned(),
        "obj 0 0 print milliseconds".to_owned(),
        "msg 0 0 \\; pd quit".to_owned(),
    ];
    let first = objects.len() as u32;
    for object in objects {
        patch += &format!("#X {object};\n");
    }
    for _ in 0..length {
        patch += "#X obj 0 0 + 1;\n";
    }
    // Outlets of [t b b b b] fire from right to left: start the time, run, print the time, the answer, quit.
    let fixed = [(0, 0, 1, 0), (1, 3, 2, 0), (1, 2, 3, 0), (3, 0, 4, 0), (4, 0, 5, 0), (5, 0, first, 0), (1, 1, 2, 1)];
    let ends = [(2, 0, 8, 0), (first + length - 1, 0, 6, 1), (1, 0, 6, 0), (6, 0, 7, 0), (1, 0, 9, 0)];
    let links = (first..first + length - 1).map(|object| (object, 0, object + 1, 0));
    for (from, outlet, to, inlet) in fixed.into_iter().chain(ends).chain(links) {
        patch += &format!("#X connect {from} {outlet} {to} {inlet};\n");
    }
    patch
}
