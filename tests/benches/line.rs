//! How many vectors a second arrive over a socket as text and as binary commands, beside the raw socket.

use protocol::command::{Command, Object, VectorClass, VectorList, print};
use ps340::{
    line::LineId,
    machine::{Input, Machine, Settings},
};
use std::{
    io::{Read, Write},
    net::{TcpListener, TcpStream},
    time::Instant,
};

const LINE: LineId = LineId(1);
const READ_BYTES: usize = 256 << 10;
const RUNS: usize = 21;

fn list(count: usize) -> Command {
    let points = (0..count).map(|i| [(i % 1000) as f32 / 999.0, (i / 1000) as f32 / 1e4, 0.125, 1.0]).collect();
    let lines = (0..count).map(|i| i % 7 != 0).collect();
    let list = VectorList {
        block_normalized: false,
        fourth: protocol::command::Fourth::Intensity,
        internal_units: false,
        class: VectorClass::Itemized,
        dimension: 3,
        estimate: u32::try_from(count).ok(),
        points,
        lines,
    };
    Command::Define { name: protocol::Name::new("D").ok(), object: Object::VectorList(list) }
}

/// Sends bytes through a loopback socket; `take` gets what arrives. Returns the seconds until all is taken.
fn through_socket(bytes: &[u8], mut take: impl FnMut(Vec<u8>)) -> f64 {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address");
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut stream = TcpStream::connect(address).expect("a line");
            stream.write_all(bytes).expect("bytes are taken");
        });
        let (mut stream, _) = listener.accept().expect("a host");
        let start = Instant::now();
        loop {
            let mut buffer = vec![0; READ_BYTES];
            let n = stream.read(&mut buffer).expect("bytes arrive");
            if n == 0 {
                return start.elapsed().as_secs_f64();
            }
            buffer.truncate(n);
            take(buffer);
        }
    })
}

/// The best of several sendings to one machine, as in a session.
fn machine_time(bytes: &[u8], count: usize) -> f64 {
    let mut best = f64::INFINITY;
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    for _ in 0..RUNS {
        let seconds = through_socket(bytes, |bytes| {
            machine.step([Input::Bytes(LINE, bytes)], 0);
        });
        let described = machine.describe("D").unwrap_or_default();
        assert!(described.ends_with(&format!("{count} vectors")), "{described} {:?}", machine.log().last());
        best = best.min(seconds);
    }
    best
}

fn main() {
    // `cargo bench -p tests --bench line -- binary` measures one form alone.
    let only = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    println!("vectors over a loopback socket into the machine (itemized, 3D, best of {RUNS})");
    for count in [10_000, 100_000, 1_000_000] {
        let command = list(count);
        let mut text = Vec::new();
        print(&command, &mut text);
        let mut binary = Vec::new();
        protocol::wire::write_commands([&command], &mut binary).expect("the list has a binary form");
        for (form, bytes) in [("text", &text), ("binary", &binary)] {
            if only.as_ref().is_some_and(|only| only != form) {
                continue;
            }
            let raw = (0..RUNS).map(|_| through_socket(bytes, drop)).fold(f64::INFINITY, f64::min);
            let taken = machine_time(bytes, count);
            println!(
                "{count:>10} {form:>7}: {:8.2} M vectors/s, {:7.0} MB/s; raw socket {:7.0} MB/s; ratio {:.2}",
                count as f64 / taken / 1e6,
                bytes.len() as f64 / taken / 1e6,
                bytes.len() as f64 / raw / 1e6,
                raw / taken,
            );
        }
    }
}
