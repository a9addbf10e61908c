//! The mirror of a machine.

use super::{traffic::MAX_TRAFFIC, *};
use crate::machine::{Input, Settings};
use std::sync::atomic::{AtomicUsize, Ordering};

const LINE: LineId = LineId(1);

/// A machine that received something, and a mirror with the number of times that it woke somebody.
fn machine(commands: &str) -> (Machine, Mirror, Arc<AtomicUsize>) {
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE), Input::Bytes(LINE, commands.into())], 0);
    let woken = Arc::new(AtomicUsize::new(0));
    let counted = woken.clone();
    let mirror = Mirror::new(Drawer::Processor, move || {
        counted.fetch_add(1, Ordering::Relaxed);
    });
    (machine, mirror, woken)
}

fn frame(machine: &mut Machine, mirror: &Mirror) {
    machine.next_frame();
    mirror.renew(machine, ["here"].into_iter());
}

#[test]
fn a_picture_that_stands_still_is_shared_and_wakes_nobody() {
    let (mut machine, mirror, woken) = machine("A := VECTOR_LIST ITEMIZED N=2 P 0,0 L 1,0; DISPLAY A;");
    for _ in 0..2 * READ_FRAMES {
        frame(&mut machine, &mirror);
    }
    let (before, calls) = (mirror.shown(), woken.load(Ordering::Relaxed));
    assert_eq!(before.scene.strokes.len(), 1);
    for _ in 0..5 * READ_FRAMES {
        frame(&mut machine, &mirror);
    }
    let now = mirror.shown();
    assert!(Arc::ptr_eq(&now.scene.strokes, &before.scene.strokes) && Arc::ptr_eq(&now.raster, &before.raster));
    assert_eq!(woken.load(Ordering::Relaxed), calls);
    assert_eq!((now.frame, now.hosts.as_slice()), (7 * READ_FRAMES, &["here".to_string()][..]));
}

#[test]
fn a_new_picture_is_copied_at_its_frame() {
    let (mut machine, mirror, woken) = machine("A := VECTOR_LIST ITEMIZED N=2 P 0,0 L 1,0; DISPLAY A;");
    frame(&mut machine, &mirror);
    let (before, calls) = (mirror.shown(), woken.load(Ordering::Relaxed));
    machine.step([Input::Bytes(LINE, b"REMOVE A;".to_vec())], 0);
    frame(&mut machine, &mirror);
    assert!(mirror.shown().scene.strokes.is_empty() && mirror.shown().scene.version != before.scene.version);
    assert_eq!(before.scene.strokes.len(), 1, "a copy stays as it was");
    assert_eq!(woken.load(Ordering::Relaxed), calls + 1);
}

#[test]
fn only_what_is_asked_for_is_copied() {
    let text = "A := F:ADDC; CONNECT A<1>:<1>B; B := F:PRINT; SEND 2 TO <2>A; \
                R := ROTATE IN X 90 THEN V; V := VECTOR_LIST ITEMIZED N=2 P 0,0 L 1,0; DISPLAY R;";
    let (mut machine, mirror, _) = machine(text);
    frame(&mut machine, &mirror);
    mirror.pass(LINE, true, b"A", &machine);
    let shown = mirror.shown();
    assert!(shown.network.is_empty() && shown.structure.is_empty() && shown.traffic.is_empty());
    assert_eq!(shown.refresh, None);
    mirror.request(&MirrorRequest {
        network: Some("A".into()),
        structure: true,
        traffic: true,
        log: true,
        refresh: true,
    });
    mirror.pass(LINE, true, b"SEND 1 TO <1>A;", &machine);
    machine.step([Input::Bytes(LINE, b"SEND 1 TO <1>A;".to_vec())], 0);
    for _ in 0..READ_FRAMES {
        frame(&mut machine, &mirror);
    }
    let shown = mirror.shown();
    let a = shown.network.iter().find(|function| function.name == "A").expect("it is asked for");
    assert_eq!((a.name.as_str(), a.function, a.inputs[1].first.as_str()), ("A", "ADDC", "2"));
    assert_eq!(a.arcs, [ArcShown { output: 1, to: "<1>B".into() }]);
    assert!(shown.network.iter().all(|f| f.name.contains('A')));
    let levels: Vec<usize> = shown.structure.iter().map(|node| node.level).collect();
    assert_eq!(levels, [0, 1]);
    assert!(shown.structure[1].text.starts_with("V := VECTOR_LIST"));
    assert_eq!(&*shown.traffic[0].bytes, b"SEND 1 TO <1>A;");
    assert!(shown.traffic[0].from_host);
    machine.step([Input::Bytes(LINE, b"SEND 1 TO <1>A;".to_vec())], 0);
    for _ in 0..READ_FRAMES {
        frame(&mut machine, &mirror);
    }
    let firings = mirror.shown().network.iter().find(|function| function.name == "A").map(|a| a.activity.firings);
    assert_eq!(firings, Some(1));
    assert!(mirror.shown().refresh.is_some_and(|refresh| refresh.frames == 1 && refresh.micros > 1.0));
}

#[test]
fn what_passes_is_bounded() {
    let mut traffic = Traffic::default();
    for _ in 0..10 {
        traffic.record(0, LINE, true, &[b'x'; MAX_TRAFFIC / 4]);
    }
    assert_eq!(traffic.entries().count(), 4);
    for _ in 0..100_000 {
        traffic.record(0, LINE, true, b"y");
    }
    assert!(traffic.entries().count() <= MAX_TRAFFIC / 16);
    traffic.record(0, LINE, false, &[b'z'; 2 * MAX_TRAFFIC]);
    assert_eq!(traffic.entries().map(|p| p.bytes.len()).sum::<usize>(), MAX_TRAFFIC);
}

#[test]
fn a_structure_that_contains_itself_has_a_finite_tree() {
    let (machine, ..) = machine("A := INSTANCE OF B; B := INSTANCE OF A; DISPLAY A;");
    let tree = structure::tree(&machine);
    assert_eq!(tree.len(), 3);
    assert!(tree[2].text.ends_with("(again)"));
}
