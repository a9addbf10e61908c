//! What fifty million vectors on the screen cost a person and a host: how soon operator commands are answered while
//! more arrive, how long a picture takes, and what memory stays after INITIALIZE.
//!
//! Lists of 10,000 vectors, as clients make them, each with strokes of 10 pixels.
//! `cargo bench -p tests --bench crowd -- 10` takes ten million.

use std::{
    fmt::Write as _,
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};
use tests::{Host, Machine};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
/// Vectors of a list.
const LIST: usize = 10_000;
/// Operator commands that are timed.
const ORDERS: usize = 1_000;

/// The vectors of a list: a walk of short steps, by a rule.
fn vectors() -> String {
    let (mut text, mut place, mut state) = (String::new(), [0.0_f64; 2], 12_345_u32);
    for _ in 0..LIST {
        for axis in &mut place {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *axis = (*axis + 0.04 * (f64::from(state >> 8) / f64::from(1 << 24) - 0.5)).clamp(-0.95, 0.95);
        }
        let _ = write!(text, "{:.3},{:.3} ", place[0], place[1]);
    }
    text
}

/// Waits until the machine has carried out all that the host sent.
fn wait_for(host: &mut Host) {
    host.send("SEND 'CARRIED OUT' TO <1>HOST_MESSAGE;");
    while host.message() != "CARRIED OUT" {}
}

fn main() {
    let millions = std::env::args().skip(1).find_map(|argument| argument.parse::<usize>().ok()).unwrap_or(50);
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("crowd.png");
    let mut machine = Machine::start(PS340, &[]);
    let before = machine.resident_megabytes();
    let mut host = machine.attach();
    let vectors = vectors();
    let list = |number: usize| format!("V{number} := VECTOR_LIST {vectors};DISPLAY V{number};");
    let lists = millions * 1_000_000 / LIST;
    let start = Instant::now();
    (0..lists).for_each(|number| host.send(list(number)));
    wait_for(&mut host);
    println!("{millions} million vectors arrive in {:.1} s", start.elapsed().as_secs_f64());
    let counters = machine.operator_command("counters");
    assert!(counters.contains(&format!("vectors={} ", lists * LIST)), "{counters}");
    println!("memory: {:.0} MB", machine.resident_megabytes());

    let stop = AtomicBool::new(false);
    let mut times = std::thread::scope(|scope| {
        let sender = scope.spawn(|| {
            for number in (0..10).cycle().take_while(|_| !stop.load(Ordering::Relaxed)) {
                host.send(list(lists + number));
            }
        });
        let orders =
            ["panel", "dial 1 0.01", "counters", "button 1", "show V1", "puck move 0.1 0.1", "terminal", "log"];
        let times: Vec<Duration> = (orders.iter().cycle().take(ORDERS))
            .map(|order| {
                let start = Instant::now();
                machine.operator_command(order);
                start.elapsed()
            })
            .collect();
        stop.store(true, Ordering::Relaxed);
        sender.join().expect("the host sends");
        times
    });
    times.sort();
    let milliseconds = |time: Duration| 1e3 * time.as_secs_f64();
    println!(
        "{ORDERS} orders while more arrive: median {:.1} ms, worst {:.1} ms",
        milliseconds(times[ORDERS / 2]),
        milliseconds(times[ORDERS - 1]),
    );
    wait_for(&mut host);
    let start = Instant::now();
    let reply = machine.operator_command(&format!("picture vector {}", picture.display()));
    let seconds = start.elapsed().as_secs_f64();
    let pixels = image::open(&picture).expect("a picture").into_rgb8();
    let bright = pixels.pixels().filter(|pixel| pixel[1] > 200).count();
    assert!(reply.ends_with("1024x1024") && bright > 1_000, "{reply}, {bright} pixels");
    println!("picture vector: {seconds:.1} s");
    host.send("INITIALIZE;");
    wait_for(&mut host);
    std::thread::sleep(Duration::from_millis(500));
    println!("memory at the start {before:.0} MB, after INITIALIZE {:.0} MB", machine.resident_megabytes());
}
