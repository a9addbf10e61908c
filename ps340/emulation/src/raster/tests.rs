//! The frame buffer against the rules of its module, pixel by pixel.

use super::*;

const RED: [u8; 3] = [255, 0, 0];
const BLUE: [u8; 3] = [0, 0, 255];

fn run(count: u16, color: [u8; 3]) -> Run {
    Run { count, color }
}

fn window(x_min: u16, y_min: u16, x_max: u16, y_max: u16) -> RasterCommand {
    RasterCommand::Window { x_min, y_min, x_max, y_max }
}

#[test]
fn a_new_screen_is_black_with_linear_tables() {
    let screen = FrameBuffer::new();
    assert!(screen.output().iter().all(|pixel| *pixel == [0; 3]));
    assert_eq!(screen.output().len(), 307_200);
}

#[test]
fn runs_go_right_then_up_inside_the_window_and_wrap_to_its_start() {
    let mut screen = FrameBuffer::new();
    screen.apply(&window(10, 20, 12, 21)).unwrap();
    screen.apply(&RasterCommand::Position { x: 11, y: 20 }).unwrap();
    // Two to the end of the line, three of the next line, then the first pixel of the window.
    screen.apply(&RasterCommand::Runs(vec![run(1, RED), run(4, BLUE), run(1, [1, 2, 3])])).unwrap();
    let line = |y| [9, 10, 11, 12, 13].map(|x| screen.pixel(x, y).unwrap());
    assert_eq!(line(20), [[0; 3], [1, 2, 3], RED, BLUE, [0; 3]]);
    assert_eq!(line(21), [[0; 3], BLUE, BLUE, BLUE, [0; 3]]);
    assert_eq!(line(22), [[0; 3]; 5]);
    // The next run goes on where the last one ended.
    screen.apply(&RasterCommand::Runs(vec![run(1, [9; 3])])).unwrap();
    assert_eq!(screen.pixel(11, 20), Some([9; 3]));
}

#[test]
fn runs_equal_a_pixel_by_pixel_walk_for_many_windows() {
    let mut seed = 7u32;
    let mut random = |below: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) % below
    };
    for _ in 0..200 {
        let (x, y) = (random(640), random(480));
        let (right, top) = (x + random((640 - x).min(9)), y + random((480 - y).min(9)));
        let mut screen = FrameBuffer::new();
        screen.apply(&window(x as u16, y as u16, right as u16, top as u16)).unwrap();
        let runs: Vec<Run> = (0..12).map(|_| run(1 + random(20) as u16, [random(256) as u8; 3])).collect();
        screen.apply(&RasterCommand::Runs(runs.clone())).unwrap();
        let mut expected = std::collections::HashMap::new();
        let columns = right - x + 1;
        let area = columns * (top - y + 1);
        let colors = runs.iter().flat_map(|run| (0..run.count).map(|_| run.color));
        for (index, color) in colors.enumerate() {
            let place = index as u32 % area;
            expected.insert((x + place % columns, y + place / columns), color);
        }
        for line in 0..480 {
            for column in 0..640 {
                let color = expected.get(&(column, line)).copied().unwrap_or([0; 3]);
                assert_eq!(screen.pixel(column, line), Some(color));
            }
        }
    }
}

#[test]
fn erase_fills_the_whole_screen_and_keeps_window_and_position() {
    let mut screen = FrameBuffer::new();
    screen.apply(&window(5, 5, 6, 6)).unwrap();
    screen.apply(&RasterCommand::Erase { color: BLUE }).unwrap();
    assert!(screen.output().iter().all(|pixel| *pixel == BLUE));
    screen.apply(&RasterCommand::Runs(vec![run(1, RED)])).unwrap();
    assert_eq!(screen.pixel(5, 5), Some(RED));
}

#[test]
fn the_picture_has_the_top_line_first_and_its_png_the_bytes_of_the_tables() {
    let mut screen = FrameBuffer::new();
    let runs = (0..640 * 480u32).map(|index| run(1, [index as u8, (index / 7) as u8, (index / 640) as u8])).collect();
    screen.apply(&RasterCommand::Runs(runs)).unwrap();
    let entries = (0..=255u8).map(|entry| LookupEntry { count: 1, color: [255 - entry, entry / 2, entry ^ 0x55] });
    screen.apply(&RasterCommand::LookupTable { index: 0, entries: entries.collect() }).unwrap();
    let png = image::load_from_memory(&screen.picture().to_png().unwrap()).unwrap().into_rgb8();
    assert_eq!(png.as_raw(), screen.output().as_flattened());
    for (x, y) in [(0, 0), (639, 479), (17, 300)] {
        let [red, green, blue] = screen.pixel(x, y).unwrap();
        assert_eq!(png.get_pixel(x, 479 - y).0, [255 - red, green / 2, blue ^ 0x55]);
    }
}

#[test]
fn entries_repeat_and_the_rest_of_the_table_stays() {
    let mut screen = FrameBuffer::new();
    let entries = vec![LookupEntry { count: 3, color: RED }, LookupEntry { count: 1, color: BLUE }];
    screen.apply(&RasterCommand::LookupTable { index: 252, entries }).unwrap();
    for (value, shown) in [(251, [251; 3]), (252, RED), (254, RED), (255, BLUE)] {
        screen.apply(&RasterCommand::Erase { color: [value; 3] }).unwrap();
        assert_eq!(screen.output()[0], shown, "entry {value}");
    }
}

#[test]
fn a_ramp_runs_from_0_to_255_over_its_entries_only() {
    let mut screen = FrameBuffer::new();
    screen.apply(&RasterCommand::LookupRamp { min: 100, max: 110 }).unwrap();
    let shown = |screen: &mut FrameBuffer, value: u8| {
        screen.apply(&RasterCommand::Erase { color: [value; 3] }).unwrap();
        screen.output()[0][1]
    };
    let values = [99, 100, 101, 105, 110, 111].map(|value| shown(&mut screen, value));
    assert_eq!(values, [99, 0, 26, 128, 255, 111]);
    screen.apply(&RasterCommand::LookupRamp { min: 7, max: 7 }).unwrap();
    assert_eq!(shown(&mut screen, 7), 255);
    screen.apply(&RasterCommand::LookupRamp { min: 0, max: 255 }).unwrap();
    assert_eq!(screen.tables, FrameBuffer::new().tables);
}

#[test]
fn errors_have_their_numbers_and_change_nothing() {
    let entry = |count| LookupEntry { count, color: RED };
    let table = |index, entries| RasterCommand::LookupTable { index, entries };
    let cases = [
        (RasterCommand::Position { x: 9, y: 20 }, 550),
        (RasterCommand::Position { x: 10, y: 41 }, 550),
        (table(1, vec![entry(255), entry(1)]), 552),
        (table(255, vec![entry(2)]), 552),
        (window(5, 0, 4, 9), 553),
        (window(0, 5, 9, 4), 553),
        (window(0, 0, 640, 9), 553),
        (window(0, 0, 9, 480), 553),
        (table(0, vec![]), 554),
        (RasterCommand::LookupRamp { min: 3, max: 2 }, 555),
        (RasterCommand::Runs(vec![]), 558),
    ];
    let mut screen = FrameBuffer::new();
    screen.apply(&window(10, 20, 30, 40)).unwrap();
    let before = screen.clone();
    for (command, number) in cases {
        let fault = screen.apply(&command).unwrap_err();
        assert_eq!(fault.number(), number, "{command:?}");
        assert!(!fault.is_warning() && !fault.to_string().is_empty());
        assert_eq!(screen, before, "{command:?}");
    }
}

#[test]
fn warnings_have_their_numbers_and_the_rest_is_done() {
    let mut screen = FrameBuffer::new();
    let fault = screen.apply(&RasterCommand::Runs(vec![run(0, RED), run(2, BLUE)])).unwrap_err();
    assert_eq!((fault.number(), fault.is_warning()), (31, true));
    assert_eq!([0, 1, 2].map(|x| screen.pixel(x, 0).unwrap()), [BLUE, BLUE, [0; 3]]);

    let entries = [(0, RED), (1, BLUE)].map(|(count, color)| LookupEntry { count, color }).to_vec();
    let fault = screen.apply(&RasterCommand::LookupTable { index: 0, entries }).unwrap_err();
    assert_eq!((fault.number(), fault.is_warning()), (33, true));
    assert_eq!(screen.output()[0], BLUE);
}

#[test]
fn pixels_beyond_the_screen_are_a_warning_and_are_dropped() {
    let mut screen = FrameBuffer::new();
    let mut runs = vec![run(61_440, RED); 5];
    screen.apply(&RasterCommand::Runs(runs.clone())).unwrap();
    runs.extend([run(1, BLUE), run(65_535, BLUE)]);
    let fault = screen.apply(&RasterCommand::Runs(runs)).unwrap_err();
    assert_eq!((fault.number(), fault.is_warning()), (30, true));
    assert!(screen.output().iter().all(|pixel| *pixel == RED));
    assert_eq!(screen.position, (0, 0));
}

#[test]
fn rectangles_are_painted_where_they_belong_and_cut_at_the_screen() {
    let mut screen = FrameBuffer::new();
    screen.apply(&window(3, 4, 5, 6)).unwrap();
    screen.paint(638, 479, 3, &[RED, BLUE, RED, BLUE, BLUE, BLUE]);
    assert_eq!([637, 638, 639].map(|x| screen.pixel(x, 479).unwrap()), [[0; 3], RED, BLUE]);
    assert_eq!(screen.output().iter().filter(|pixel| **pixel != [0; 3]).count(), 2);
    screen.paint(640, 0, 5, &[RED; 10]);
    screen.paint(0, 500, 5, &[RED; 10]);
    screen.paint(0, 0, 0, &[]);
    assert_eq!(screen.output().iter().filter(|pixel| **pixel != [0; 3]).count(), 2);
    assert_eq!(screen.position, (3, 4));
}
