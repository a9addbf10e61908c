//! How many vectors a second the emulator transforms, clips and draws. Each figure's result is checked first.

use glam::{DMat4, DVec4};
use protocol::command::{Fourth, VectorClass, VectorList};
use ps340::{
    calligraphic::{self, Beam},
    machine::{Input, Machine, Settings},
    matrices,
    port::ObjectId,
    structure::{Member, Node, Operation, State, Structures},
    traversal::{self, Clipper, Requests, Stroke, Update},
};
use std::time::Instant;

/// Vectors of `length` (screen units) at places and angles that fill the screen.
fn vectors(count: usize, length: f32) -> Vec<[f32; 4]> {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1 << 24) as f32
    };
    let mut points = Vec::with_capacity(2 * count);
    for _ in 0..count {
        let (x, y, z, angle) = (1.8 * random() - 0.9, 1.8 * random() - 0.9, random(), std::f32::consts::TAU * random());
        points.push([x, y, z, 1.0]);
        points.push([x + length * angle.cos(), y + length * angle.sin(), z, 1.0]);
    }
    points
}

/// The shortest of several runs, seconds.
fn best(mut work: impl FnMut()) -> f64 {
    let run = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..7).map(|_| run(&mut work)).fold(f64::INFINITY, f64::min)
}

fn rows(count: usize) {
    let points = vectors(count, 0.02);
    let view = matrices::window([-1.0, 1.0], [-1.0, 1.0], [0.0, 1.0]).unwrap_or(DMat4::IDENTITY);
    let mut clip: Vec<DVec4> = Vec::with_capacity(points.len());
    let transform = best(|| {
        clip.clear();
        Clipper::transform(&view, &points, &mut clip);
    });
    for (p, c) in points.iter().zip(&clip) {
        assert!((f64::from(p[0]) - c.x).abs() < 1e-12 && (f64::from(p[2]) - c.z).abs() < 1e-12 && c.w == 1.0);
    }
    let clipper = Clipper::new(&State::default());
    let mut strokes: Vec<Stroke> = Vec::with_capacity(count);
    let clipping = best(|| {
        strokes.clear();
        strokes.extend(clip.chunks_exact(2).filter_map(|ends| clipper.line(ends[0], ends[1], [1.0; 2])));
    });
    assert_eq!(strokes.len(), count, "all lie on the screen");
    // The light of all strokes is their length times their intensity.
    let beam = Beam::new(1024, 1024);
    let threads = rayon_threads();
    let mut total = 0.0;
    let drawing = best(|| total = calligraphic::draw(&beam, &strokes).total()[0]);
    let one = calligraphic::draw(&beam, &strokes[..1]).total()[0];
    let mean = |s: &Stroke| f64::from(s.intensity[0] + s.intensity[1]) / 2.0;
    let length = |s: &Stroke| f64::from(s.end[0] - s.start[0]).hypot(f64::from(s.end[1] - s.start[1]));
    let expected: f64 = strokes.iter().map(|s| mean(s) * length(s)).sum::<f64>();
    let first = mean(&strokes[0]) * length(&strokes[0]);
    let error = (total / one) / (expected / first) - 1.0;
    assert!(error.abs() < 2e-3, "the light is off by {error}");
    let million = |seconds: f64| count as f64 / seconds / 1e6;
    println!(
        "{count:>10} vectors of 10 pixels: transform {:6.1} M/s, clip {:6.1} M/s (one thread), draw {:6.2} M/s ({threads} threads)",
        million(transform),
        million(clipping),
        million(drawing),
    );
}

fn rayon_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn node(points: &[[f32; 4]]) -> Node {
    let list = VectorList {
        block_normalized: false,
        fourth: Fourth::Intensity,
        internal_units: false,
        class: VectorClass::Separate,
        dimension: 3,
        estimate: None,
        points: points.to_vec(),
        lines: Vec::new(),
    };
    Node::Vectors(Box::new(list.into()))
}

fn operate(operation: Operation) -> Member {
    Member::Unnamed(Node::operate(operation, None))
}

/// A display of `count` vectors in lists of `length`, in perspective; the same number below a condition that is off.
fn displayed(count: usize, length: usize, hidden: bool) -> Structures {
    let points = vectors(length, 0.02);
    let mut structures = Structures::default();
    let [root, list] = [ObjectId::new(0), ObjectId::new(1)];
    structures.define(list, node(&points));
    let view = matrices::field_of_view(60.0, [0.5, 4.0]).unwrap_or(DMat4::IDENTITY);
    let back = Operation::Translate(glam::DVec3::new(0.0, 0.0, 2.0));
    let mut members = vec![operate(Operation::Projective(view)), operate(back)];
    let instances = count / length;
    members.extend((0..instances).map(|_| Member::Included(list)));
    if hidden {
        members.push(operate(Operation::IfBit { bit: 0, on: true }));
        members.extend((0..instances).map(|_| Member::Included(list)));
    }
    structures.define(root, Node::Group(members));
    structures.display(root);
    structures
}

/// Whole updates: the walk over the structure, transformation, clipping, projection; on one thread.
fn updates() {
    println!("whole updates in perspective: walk, transform, clip, project; one thread");
    let Ok(one) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
    for (count, length) in [(10_000, 100), (100_000, 100), (1_000_000, 100), (100_000, 100_000), (1_000_000, 1_000_000)]
    {
        let mut seconds = [0.0; 2];
        for (hidden, seconds) in [false, true].into_iter().zip(&mut seconds) {
            let structures = displayed(count, length, hidden);
            let mut update = Update::default();
            *seconds = one.install(|| {
                best(|| {
                    let room = std::mem::take(&mut update.strokes);
                    update = traversal::update_into(
                        &structures,
                        0,
                        &Requests::default(),
                        room,
                        traversal::MAX_STORED_VECTORS,
                    );
                })
            });
            assert_eq!(update.strokes.len(), count, "all are seen");
        }
        println!(
            "{count:>10} vectors in lists of {length:>9}: {:6.1} M/s; with as many more behind a condition that is off {:6.1} M/s",
            count as f64 / seconds[0] / 1e6,
            count as f64 / seconds[1] / 1e6,
        );
    }
}

/// What a frame costs while nothing changes.
fn still() {
    for count in [1_000, 1_000_000] {
        let mut machine = Machine::new(Settings::default());
        let line = ps340::line::LineId(1);
        let coordinates: Vec<String> =
            vectors(count, 0.02).iter().map(|p| format!("{:.6},{:.6},{:.6}", p[0], p[1], p[2])).collect();
        let text = format!("A := VECTOR_LIST SEPARATE_LINES {}; DISPLAY A;", coordinates.join(" "));
        machine.step([Input::Attach(line), Input::Bytes(line, text.into_bytes())], 0);
        machine.next_frame();
        let updates = machine.counters().updates;
        const FRAMES: u32 = 10_000;
        let seconds = best(|| (0..FRAMES).for_each(|_| machine.next_frame()));
        assert_eq!(machine.counters().updates, updates, "the picture was made again");
        assert_eq!(machine.latest_update().strokes.len(), count);
        println!(
            "{count:>10} vectors that stand still: {:6.2} microseconds a frame",
            seconds / f64::from(FRAMES) * 1e6
        );
    }
}

fn main() {
    updates();
    still();
    println!("vectors of the emulator, 1024 x 1024 pixels");
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        rows(count);
    }
}
