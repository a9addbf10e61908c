//! Dashes against closed forms and invariants.

use super::{MAX_DASHES, PatternFault, dashed};
use proptest::prelude::*;
use protocol::command::{Fourth, Pattern, VectorClass, VectorList};

fn list(class: VectorClass, points: &[[f32; 4]]) -> VectorList {
    let points = points.to_vec();
    VectorList {
        block_normalized: true,
        class,
        dimension: 3,
        estimate: Some(3),
        fourth: Fourth::Intensity,
        internal_units: false,
        points,
        lines: Vec::new(),
    }
}

fn connected(points: &[[f32; 2]]) -> VectorList {
    list(VectorClass::Connected, &points.iter().map(|[x, y]| [*x, *y, 0.0, 1.0]).collect::<Vec<_>>())
}

fn pattern(segments: &[f64], length: f64) -> Pattern {
    Pattern { segments: segments.to_vec(), around_corners: false, matched: false, length }
}

/// The dashes of a list as pairs of x.
fn spans(list: &VectorList) -> Vec<[f32; 2]> {
    assert_eq!(list.points.len(), list.lines.len());
    (1..list.points.len())
        .filter(|index| list.is_line(*index))
        .map(|index| [list.points[index - 1][0], list.points[index][0]])
        .collect()
}

/// Total length of what a list draws.
fn drawn(list: &VectorList) -> f64 {
    let distance = |a: [f32; 4], b: [f32; 4]| (0..3).map(|k| f64::from(a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
    (1..list.points.len()).filter(|i| list.is_line(*i)).map(|i| distance(list.points[i - 1], list.points[i])).sum()
}

fn make(list: &VectorList, pattern: &Pattern) -> VectorList {
    dashed(list, pattern).expect("a pattern")
}

#[test]
fn dash_and_gap_alternate_along_a_line() {
    let dashes = make(&connected(&[[0.0, 0.0], [10.0, 0.0]]), &pattern(&[3.0, 1.0], 4.0));
    assert_eq!(spans(&dashes), [[0.0, 3.0], [4.0, 7.0], [8.0, 10.0]]);
    assert_eq!(dashes.lines, [false, true, false, true, false, true]);
    assert_eq!((dashes.class, dashes.dimension, dashes.block_normalized), (VectorClass::Itemized, 3, true));
}

#[test]
fn a_pattern_that_divides_the_line_ends_with_it() {
    for count in 1..=40_u8 {
        for length in [0.1, 0.04, 0.2, 0.4, 0.3, 1.0 / 3.0, 0.7] {
            for start in [0.0_f32, -1.0, 0.35] {
                let end = start + (f64::from(count) * length) as f32;
                let dashes = make(&connected(&[[start, 0.5], [end, 0.5]]), &pattern(&[1.0, 1.0], length));
                let spans = spans(&dashes);
                assert_eq!(spans.len(), usize::from(count), "{count} times {length} from {start}: {spans:?}");
                assert!(spans.iter().all(|[from, to]| f64::from(to - from) > 0.4 * length), "{spans:?}");
            }
        }
    }
}

#[test]
fn entries_are_relative_to_the_length_of_a_repetition() {
    let line = connected(&[[0.0, 0.0], [8.0, 0.0]]);
    assert_eq!(make(&line, &pattern(&[6.0, 2.0, 1.0, 2.0], 5.5)), make(&line, &pattern(&[12.0, 4.0, 2.0, 4.0], 5.5)));
    assert_eq!(spans(&make(&line, &pattern(&[1e308, 1e308], 8.0))), [[0.0, 4.0]]);
}

#[test]
fn an_odd_number_of_entries_joins_the_last_dash_with_the_next_first() {
    let dashes = make(&connected(&[[0.0, 0.0], [9.0, 0.0]]), &pattern(&[1.0, 2.0, 1.0], 4.0));
    assert_eq!(spans(&dashes), [[0.0, 1.0], [3.0, 5.0], [7.0, 9.0]]);
}

#[test]
fn the_drawn_length_has_the_ratio_of_the_entries() {
    let line = list(VectorClass::Connected, &[[1.0, 2.0, 3.0, 1.0], [3.0, 5.0, 9.0, 1.0]]);
    for (entries, part) in
        [(vec![1.0, 3.0], 0.25), (vec![6.0, 2.0, 1.0, 2.0], 7.0 / 11.0), (vec![1.0, 1.0, 3.0, 1.0], 4.0 / 6.0)]
    {
        // 7 long: 7, 70 and 7000 repetitions.
        for length in [1.0, 0.1, 0.001] {
            let total = drawn(&make(&line, &pattern(&entries, length)));
            assert!((total - 7.0 * part).abs() < 2e-3, "{entries:?} {length}: {total}");
        }
    }
}

#[test]
fn each_line_begins_with_a_dash_unless_the_pattern_goes_around_corners() {
    let corner = connected(&[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0]]);
    let mut pattern = pattern(&[2.0, 2.0], 4.0);
    let restarted = make(&corner, &pattern);
    assert_eq!(restarted.points, [[0.0, 0.0], [2.0, 0.0], [3.0, 0.0], [3.0, 2.0]].map(|[x, y]| [x, y, 0.0, 1.0]));
    pattern.around_corners = true;
    let around = make(&corner, &pattern);
    assert_eq!(around.points, [[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [3.0, 3.0]].map(|[x, y]| [x, y, 0.0, 1.0]));
    pattern.segments = vec![3.5, 0.5];
    let bent = make(&corner, &pattern);
    let expected = [[0.0, 0.0], [3.0, 0.0], [3.0, 0.5], [3.0, 1.0], [3.0, 3.0]];
    assert_eq!(bent.points, expected.map(|[x, y]| [x, y, 0.0, 1.0]));
    assert_eq!(bent.lines, [false, true, true, false, true]);
}

#[test]
fn a_move_starts_the_pattern_anew() {
    let mut moves =
        list(VectorClass::Itemized, &[[0.0; 4], [3.0, 0.0, 0.0, 0.0], [10.0, 0.0, 0.0, 0.0], [13.0, 0.0, 0.0, 0.0]]);
    moves.lines = vec![false, true, false, true];
    let pattern = Pattern { around_corners: true, ..pattern(&[1.0, 1.0], 4.0) };
    assert_eq!(spans(&make(&moves, &pattern)), [[0.0, 2.0], [10.0, 12.0]]);
    moves.class = VectorClass::Separate;
    assert_eq!(spans(&make(&moves, &pattern)), [[0.0, 2.0], [10.0, 12.0]]);
}

#[test]
fn matched_lines_end_with_a_whole_repetition() {
    let mut matched = Pattern { matched: true, ..pattern(&[3.0, 1.0], 4.0) };
    // 10 is 2.5 repetitions of 4, so 3 of 10/3 (a half goes up); 1 is one, shrunk.
    let ten = spans(&make(&connected(&[[0.0, 0.0], [10.0, 0.0]]), &matched));
    assert_eq!((ten.len(), ten[0], ten[2][1]), (3, [0.0, 2.5], (10.0_f64 - 10.0 / 12.0) as f32));
    assert_eq!(spans(&make(&connected(&[[0.0, 0.0], [1.0, 0.0]]), &matched)), [[0.0, 0.75]]);
    // With a dash at its end the pattern reaches the end of every line exactly.
    matched.segments = vec![1.0, 1.0, 1.0];
    for end in 1..200_u16 {
        let end = f32::from(end) * 0.37;
        let spans = spans(&make(&connected(&[[0.1, 0.0], [0.1 + end, 0.0]]), &matched));
        assert_eq!((spans[0][0], spans[spans.len() - 1][1]), (0.1, 0.1 + end));
        assert!(spans.iter().all(|span| span[1] - span[0] > 0.1 * end.min(4.0)), "a sliver in {spans:?}");
    }
}

#[test]
fn matched_around_corners_divides_the_whole_polyline() {
    let square = connected(&[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 0.0]]);
    let pattern = Pattern { matched: true, around_corners: true, ..pattern(&[1.0, 1.0], 2.5) };
    // 12 / 2.5 is nearest to 5 repetitions of 2.4.
    let dashes = make(&square, &pattern);
    assert_eq!(dashes.lines.iter().filter(|line| !**line).count(), 5);
    assert!((drawn(&dashes) - 6.0).abs() < 1e-6);
    assert_eq!(dashes.points.last().map(|point| point[1] > 1.0), Some(true), "the last gap, 1.2, is before the end");
}

#[test]
fn intensities_run_on_from_dash_to_dash() {
    let fading = list(VectorClass::Connected, &[[0.0, 0.0, 0.0, 1.0], [8.0, 0.0, 0.0, 0.0]]);
    for point in make(&fading, &pattern(&[1.0, 1.0], 2.0)).points {
        assert_eq!(point[3], 1.0 - point[0] / 8.0);
    }
}

#[test]
fn lines_of_no_length_are_dots_where_the_pattern_draws() {
    let still = connected(&[[1.0, 1.0], [1.0, 1.0]]);
    assert_eq!(make(&still, &pattern(&[1.0, 1.0], 2.0)).points, still.points);
    assert_eq!(make(&still, &pattern(&[0.0, 1.0], 2.0)).points, Vec::<[f32; 4]>::new());
    let middle = connected(&[[0.0, 0.0], [1.5, 0.0], [1.5, 0.0], [2.5, 0.0]]);
    let around = Pattern { around_corners: true, ..pattern(&[1.0, 1.0], 2.0) };
    assert_eq!(spans(&make(&middle, &around)), [[0.0, 1.0], [2.0, 2.5]]);
}

#[test]
fn entries_of_no_length_draw_dots() {
    let dots = make(&connected(&[[0.0, 0.0], [3.0, 0.0]]), &pattern(&[0.0, 1.0], 1.0));
    assert_eq!(spans(&dots), [[0.0; 2], [1.0; 2], [2.0; 2]]);
}

#[test]
fn dots_and_patterns_without_gaps_leave_the_list_as_it_is() {
    let dots = list(VectorClass::Dots, &[[0.0; 4], [1.0; 4]]);
    assert_eq!(make(&dots, &pattern(&[1.0, 1.0], 0.1)), dots);
    let line = connected(&[[0.0, 0.0], [3.0, 0.0]]);
    assert_eq!(make(&line, &pattern(&[1.0], 1e-30)), line);
    assert_eq!(make(&line, &pattern(&[1.0, 0.0, 2.0], 1e-30)), line);
    let none = list(VectorClass::Connected, &[]);
    assert_eq!(make(&none, &pattern(&[1.0, 1.0], 1.0)).points, Vec::<[f32; 4]>::new());
}

#[test]
fn patterns_without_meaning_are_refused_with_their_place() {
    let line = connected(&[[0.0, 0.0], [3.0, 0.0]]);
    let fault = |segments: &[f64], length: f64| dashed(&line, &pattern(segments, length)).expect_err("a fault");
    assert_eq!(fault(&[], 1.0), PatternFault::Segments(0));
    assert_eq!(fault(&[1.0; 33], 1.0), PatternFault::Segments(33));
    assert_eq!(fault(&[1.0, -1.0], 1.0), PatternFault::Segment(2));
    assert!(matches!(fault(&[f64::NAN], 1.0), PatternFault::Segment(1)));
    assert_eq!(fault(&[0.0, 0.0], 1.0), PatternFault::Empty);
    assert_eq!(fault(&[1.0], 0.0), PatternFault::Length(0.0));
    assert_eq!(fault(&[1.0], f64::INFINITY), PatternFault::Length(f64::INFINITY));
    let infinite = connected(&[[0.0, 0.0], [f32::INFINITY, 0.0]]);
    assert_eq!(dashed(&infinite, &pattern(&[1.0, 1.0], 1.0)), Err(PatternFault::NotFinite(2)));
}

#[test]
fn a_huge_line_with_a_tiny_pattern_is_refused() {
    let huge = connected(&[[-3e38, 0.0], [3e38, 0.0]]);
    for (segments, length) in [(&[1.0, 1.0][..], 1e-300), (&[1.0, 1e-200], 1e30), (&[0.0, 1.0], 1.0)] {
        for matched in [false, true] {
            let pattern = Pattern { matched, ..pattern(segments, length) };
            assert_eq!(dashed(&huge, &pattern), Err(PatternFault::TooManyDashes), "{pattern:?}");
        }
    }
    let most = connected(&[[0.0, 0.0], [MAX_DASHES as f32, 0.0]]);
    assert_eq!(spans(&make(&most, &pattern(&[1.0, 1.0], 1.0))).len(), MAX_DASHES);
    assert_eq!(dashed(&most, &pattern(&[1.0, 1.0], 0.999)), Err(PatternFault::TooManyDashes));
}

#[test]
fn the_size_of_a_list_does_not_matter() {
    for scale in [1e-35_f32, 1e37] {
        let dashes =
            make(&connected(&[[0.0, 0.0], [10.0 * scale, 0.0]]), &pattern(&[3.0, 1.0], 4.0 * f64::from(scale)));
        let x: Vec<f32> = dashes.points.iter().map(|point| point[0] / scale).collect();
        let expected = [0.0, 3.0, 4.0, 7.0, 8.0, 10.0];
        assert!(x.len() == 6 && x.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{x:?}");
    }
}

proptest! {
    /// Around corners, a line cut into pieces has the dashes of the whole line.
    #[test]
    fn a_split_line_has_the_dashes_of_the_whole(
        cuts in prop::collection::vec(0.01_f32..10.0, 0..6),
        segments in prop::collection::vec(0.5..4.0, 2..7),
        length in 0.3..12.0,
        matched in any::<bool>(),
    ) {
        let pattern = Pattern { around_corners: true, matched, ..pattern(&segments, length) };
        let mut x = [vec![0.0], cuts, vec![10.0]].concat();
        x.sort_by(f32::total_cmp);
        let whole = spans(&make(&connected(&[[0.0, 0.0], [10.0, 0.0]]), &pattern));
        let split = make(&connected(&x.iter().map(|x| [*x, 0.0]).collect::<Vec<_>>()), &pattern);
        // Dashes that run over a cut are joined lines: taken together by their moves.
        let mut joined: Vec<[f32; 2]> = Vec::new();
        for (point, line) in split.points.iter().zip(&split.lines) {
            match joined.last_mut() {
                Some(span) if *line => span[1] = point[0],
                _ => joined.push([point[0]; 2]),
            }
        }
        // A dash that ends within a rounding of the end of the line may be there or not.
        let seen = |spans: Vec<[f32; 2]>| -> Vec<[f32; 2]> { spans.into_iter().filter(|s| s[1] - s[0] > 1e-5).collect() };
        let (whole, joined) = (seen(whole), seen(joined));
        prop_assert_eq!(whole.len(), joined.len(), "{:?} {:?}", whole, joined);
        for (a, b) in whole.iter().zip(&joined) {
            prop_assert!((a[0] - b[0]).abs() < 2e-5 && (a[1] - b[1]).abs() < 2e-5, "{:?} {:?}", a, b);
        }
    }
}
