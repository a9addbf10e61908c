//! Tests of attributes, conditions and the data that is drawn piece by piece.

use super::*;
use crate::{hue, structure::Labels};
use protocol::command::{
    CharacterOrientation, Comparison, FontCharacter, Fourth, LabelText, Polygon, PolygonVertex, Rate, VectorClass,
};
use std::collections::BTreeMap;

fn point() -> Node {
    list(VectorClass::Dots, &[[0.0; 3]])
}

fn group(members: Vec<Member>) -> (Structures, ObjectId) {
    let mut structures = Structures::default();
    let id = ObjectId::new(0);
    structures.define(id, Node::Group(members));
    structures.display(id);
    (structures, id)
}

fn to(operation: Operation, below: ObjectId) -> Member {
    Member::Unnamed(Node::operate(operation, Some(below)))
}

fn count(structures: &Structures) -> usize {
    update(structures, 0, &Requests::default()).strokes.len()
}

#[test]
fn a_condition_without_a_target_guards_everything_after_it() {
    let bit = |on| Operation::ConditionalBit { bit: 14, on };
    let guard = Operation::IfBit { bit: 14, on: true };
    assert_eq!(draw(std::slice::from_ref(&guard), point()).len(), 0, "bits are off at first");
    assert_eq!(draw(&[bit(true), guard.clone()], point()).len(), 1);
    assert_eq!(draw(&[bit(true), bit(false), guard.clone()], point()).len(), 0);
    let members = vec![Member::Unnamed(point()), operate(guard), Member::Unnamed(point()), operate(bit(true))];
    assert_eq!(count(&group(members).0), 1);
}

#[test]
fn a_condition_with_a_target_spares_what_follows() {
    let [small, large] = [ObjectId::new(1), ObjectId::new(2)];
    let (mut structures, _) = group(vec![
        to(Operation::IfBit { bit: 1, on: true }, small),
        to(Operation::IfBit { bit: 1, on: false }, large),
    ]);
    structures.define(small, point());
    structures.define(large, list(VectorClass::Dots, &[[0.0; 3], [0.1; 3]]));
    assert_eq!(count(&structures), 2);
}

#[test]
fn levels_of_detail_compare_and_stay_in_range() {
    let level = |n| Operation::LevelOfDetail(n);
    for (comparison, shown) in [
        (Comparison::Less, [true, false, false]),
        (Comparison::Equal, [false, true, false]),
        (Comparison::LessEqual, [true, true, false]),
        (Comparison::Greater, [false, false, true]),
        (Comparison::NotEqual, [true, false, true]),
        (Comparison::GreaterEqual, [false, true, true]),
    ] {
        for (n, shown) in [4, 5, 6].into_iter().zip(shown) {
            let guard = Operation::IfLevel { comparison, level: 5 };
            assert_eq!(draw(&[level(n), guard], point()).len(), usize::from(shown), "{n} {comparison:?} 5");
        }
    }
    let equal = |level| Operation::IfLevel { comparison: Comparison::Equal, level };
    let change = Operation::ChangeLevelOfDetail;
    assert_eq!(draw(&[change(-1), equal(0)], point()).len(), 1);
    assert_eq!(draw(&[level(32767), change(1), equal(32767)], point()).len(), 1);
    assert_eq!(draw(&[level(7), change(1), change(1), equal(9)], point()).len(), 1);
}

#[test]
fn a_rate_shows_and_hides_and_says_when() {
    let rate = Rate { on: 20, off: 10, initial: true, delay: 0 };
    let (structures, _) = group(vec![
        operate(Operation::Rate { rate, since: 3 }),
        operate(Operation::IfPhase(true)),
        Member::Unnamed(point()),
    ]);
    for frame in 3..100 {
        let update = update(&structures, frame, &Requests::default());
        assert_eq!(update.strokes.len(), usize::from((frame - 3) % 30 < 20), "{frame}");
        let place = (frame - 3) % 30;
        assert_eq!(update.next_change, Some(frame - place + if place < 20 { 20 } else { 30 }));
    }
}

#[test]
fn blinking_data_is_hidden_every_other_phase() {
    let (structures, _) =
        group(vec![operate(Operation::BlinkRate(5)), operate(Operation::Blinking(true)), Member::Unnamed(point())]);
    let seen: Vec<usize> =
        [0, 4, 5, 9, 10].map(|frame| update(&structures, frame, &Requests::default()).strokes.len()).to_vec();
    assert_eq!(seen, [1, 1, 0, 0, 1]);
    assert_eq!(update(&structures, 7, &Requests::default()).next_change, Some(10));
}

#[test]
fn a_picture_without_rates_never_changes_by_itself() {
    assert_eq!(update(&group(vec![Member::Unnamed(point())]).0, 0, &Requests::default()).next_change, None);
}

#[test]
fn screens_draw_what_is_theirs() {
    let displays = |scopes, on| operate(Operation::Displays { scopes, on });
    let (structures, _) = group(vec![
        Member::Unnamed(point()),
        displays(0b1111, false),
        Member::Unnamed(point()),
        displays(0b0010, true),
        Member::Unnamed(point()),
        displays(0b0001, true),
        Member::Unnamed(point()),
    ]);
    let update = update(&structures, 0, &Requests::default());
    assert_eq!([0, 1, 2, 9].map(|screen| update.on_screen(screen).count()), [2, 3, 1, 0]);
}

#[test]
fn contrast_scales_the_intensity() {
    let strokes = draw(&[Operation::Contrast(0.25)], point());
    assert!((strokes[0].intensity[0] - 0.25).abs() < 1e-6);
}

#[test]
fn a_named_operate_node_that_is_referred_to_applies_to_what_follows_it() {
    let [outer, node, home, inner] = [0, 1, 2, 3].map(ObjectId::new);
    let mut structures = Structures::default();
    let shift = Operation::Translate(DVec3::new(0.5, 0.0, 0.0));
    structures.define(node, Node::operate(shift, None));
    structures.define(inner, Node::Group(vec![Member::Named(node), Member::Unnamed(point())]));
    structures.define(home, Node::Group(vec![Member::Unnamed(point()), Member::Named(inner)]));
    structures.define(outer, Node::Instance(vec![node]));
    structures.display(outer);
    let strokes = update(&structures, 0, &Requests::default()).strokes;
    assert_eq!(strokes.len(), 1);
    near(strokes[0].start, [0.5, 0.0]);
}

#[test]
fn blended_lines_run_through_the_hues_between() {
    let mut blended = list(VectorClass::Connected, &[[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]);
    if let Node::Vectors(vectors) = &mut blended {
        vectors.list.fourth = Fourth::Hue;
        vectors.list.points[0][3] = 120.0;
        vectors.list.points[1][3] = 240.0;
    }
    let plain = draw(&[], blended.clone());
    assert_eq!(plain.len(), 1, "one colour without SET COLOR BLENDING");
    assert_eq!(plain[0].intensity, [1.0; 2]);
    let strokes = draw(&[Operation::ColorBlending(1.0)], blended);
    assert_eq!(strokes.len(), 20);
    assert!(strokes.windows(2).all(|w| w[0].end == w[1].start));
    let middle = strokes[10].color;
    let yellow = hue::rgb(183.0, 1.0);
    assert!(middle.iter().zip(yellow).all(|(a, b)| (a - b).abs() < 1e-3), "{middle:?}");
}

#[test]
fn polygons_are_drawn_as_closed_outlines_in_their_hue() {
    let vertex = |x, y| PolygonVertex { soft: true, position: [x, y, 0.0], normal: None, color: None };
    let square = |outline| Polygon {
        attributes: None,
        outline,
        coplanar: false,
        vertices: vec![vertex(0.0, 0.0), vertex(0.0, 0.5), vertex(0.5, 0.5), vertex(0.5, 0.0)],
    };
    let polygons = vec![square(None), square(Some(120.0)), square(None)];
    let node = Node::Polygons(Box::new(crate::structure::Polygons { attributes: vec![None; 3], polygons }));
    let strokes = draw(&[], node);
    assert_eq!(strokes.len(), 12);
    assert_eq!(strokes[0].start, strokes[3].end);
    assert_eq!(strokes[0].color, [1.0; 3]);
    assert!(strokes[4..].iter().all(|s| s.color == hue::rgb(120.0, 1.0)), "the hue holds for the polygons after it");
}

#[test]
fn labels_share_a_step_and_may_be_hidden() {
    let label = |y| LabelText { position: DVec3::new(0.0, y, 0.0), text: (*b"H").into() };
    let block = |shown| Labels { labels: vec![(label(0.0), true), (label(0.5), shown)], step: DVec2::X };
    let small = [Operation::Character(glam::DMat2::from_diagonal(DVec2::splat(0.1)))];
    let both = draw(&small, Node::Labels(Box::new(block(true))));
    let one = draw(&small, Node::Labels(Box::new(block(false))));
    assert_eq!(both.len(), 2 * one.len());
    assert_eq!(both[..one.len()], one);
}

#[test]
fn a_font_of_the_user_draws_its_own_characters_and_nothing_else() {
    let font = ObjectId::new(1);
    let points = vec![([0.0, 0.0], false), ([1.0, 1.0], true), ([0.0, 1.0], false), ([1.0, 0.0], true)];
    let cross = FontCharacter { code: b'x', estimate: None, points };
    let text = Characters { position: DVec3::ZERO, step: DVec2::X, text: (*b"xyx").into() };
    let (mut structures, _) = group(vec![
        operate(Operation::TextSize(0.1)),
        operate(Operation::Font(Some(font))),
        Member::Unnamed(Node::Characters(Box::new(text))),
    ]);
    assert_eq!(count(&structures), 0, "a font that is not there");
    structures.define(font, Node::Font(Box::new(BTreeMap::from([(b'x', cross)]))));
    let strokes = update(&structures, 0, &Requests::default()).strokes;
    assert_eq!(strokes.len(), 4);
    near(strokes[2].start, [0.2, 0.0]);
    near(strokes[3].end, [0.3, 0.0]);
}

#[test]
fn screen_oriented_text_does_not_turn() {
    let text = |operations: &[Operation], orientation| {
        let characters = Characters { position: DVec3::new(0.2, 0.0, 0.0), step: DVec2::X, text: (*b"H").into() };
        let mut all = vec![Operation::Orientation(orientation), Operation::TextSize(0.2)];
        all.extend_from_slice(operations);
        draw(&all, Node::Characters(Box::new(characters)))
    };
    let turned = [Operation::Linear(matrices::rotation(Axis::Z, 90.0))];
    let doubled = [Operation::Linear(DMat3::from_diagonal(DVec3::splat(2.0)))];
    let shape = |strokes: &[Stroke]| -> Vec<[f32; 2]> {
        strokes.iter().map(|s| [s.end[0] - s.start[0], s.end[1] - s.start[1]]).collect()
    };
    let straight = shape(&text(&[], CharacterOrientation::Screen));
    for (a, b) in straight.iter().zip(shape(&text(&turned, CharacterOrientation::Screen))) {
        near(*a, b);
    }
    for (a, b) in straight.iter().zip(shape(&text(&doubled, CharacterOrientation::Screen))) {
        near([2.0 * a[0], 2.0 * a[1]], b);
    }
    let fixed = shape(&text(&[], CharacterOrientation::ScreenFixed));
    for (a, b) in fixed.iter().zip(shape(&text(&doubled, CharacterOrientation::ScreenFixed))) {
        near(*a, b);
    }
    let world = text(&turned, CharacterOrientation::World);
    let screen = text(&turned, CharacterOrientation::Screen);
    assert_ne!(shape(&world), shape(&screen));
    // Both begin at the same corner of the cell: the H has a stroke along its left side.
    let dim = [Operation::Intensity { on: true, range: [0.1, 0.1] }];
    assert!(text(&dim, CharacterOrientation::ScreenFixed).iter().all(|s| s.intensity == [1.0; 2]));
}

#[test]
fn structures_a_thousand_levels_deep_are_drawn_and_deeper_than_the_limit_are_reported() {
    for (levels, fault) in [(1000, None), (MAX_DEPTH + 5, Some(UpdateFault::TooDeep))] {
        let mut structures = Structures::default();
        structures.define(ObjectId::new(0), point());
        for level in 1..=levels {
            structures.define(ObjectId::new(level), Node::Instance(vec![ObjectId::new(level - 1)]));
        }
        structures.display(ObjectId::new(levels));
        let update = update(&structures, 0, &Requests::default());
        assert_eq!((update.strokes.len(), update.fault), (usize::from(fault.is_none()), fault));
    }
}

#[test]
fn a_cycle_is_drawn_once_and_named() {
    let [a, b] = [ObjectId::new(0), ObjectId::new(1)];
    let mut structures = Structures::default();
    let again = to(Operation::Translate(DVec3::new(0.1, 0.0, 0.0)), a);
    structures.define(a, Node::Instance(vec![b, b]));
    structures.define(b, Node::Group(vec![Member::Unnamed(point()), again]));
    structures.display(a);
    let update = update(&structures, 0, &Requests::default());
    assert_eq!(update.fault, Some(UpdateFault::ContainsItself(a)));
    assert_eq!(update.strokes.len(), 2);
}

#[test]
fn what_is_switched_off_costs_no_vectors() {
    let many: Vec<[f32; 3]> = vec![[0.1; 3]; 50_000];
    let guard = operate(Operation::IfBit { bit: 0, on: true });
    let (structures, _) = group(vec![guard, Member::Unnamed(list(VectorClass::Connected, &many))]);
    let update = update(&structures, 0, &Requests::default());
    assert_eq!((update.vectors, update.visits), (0, 2));
}
