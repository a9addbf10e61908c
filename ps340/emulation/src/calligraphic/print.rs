//! Strokes on paper and as text.

use crate::hue::hue_saturation;
use crate::traversal::Stroke;
use protocol::raster::srgb_from_linear;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Steps of ink from paper to the full colour.
const INKS: u8 = 16;
/// Width and height of the drawing, in its own units.
const PAPER: f32 = 1000.0;
/// Width of a line, in the same units: a fifth of a millimetre where the drawing is 20 cm wide.
const LINE: f32 = 1.0;

/// The strokes as text: their number, then on each line x and y of start and end, the intensities there, red, green
/// and blue; the first `most` of them.
pub fn text(strokes: &[Stroke], most: usize) -> String {
    let shown = &strokes[..strokes.len().min(most)];
    let mut text = format!("{} strokes", shown.len());
    for stroke in shown {
        let numbers = stroke.start.iter().chain(&stroke.end).chain(&stroke.intensity).chain(&stroke.color);
        text.push('\n');
        text.push_str(&numbers.map(f32::to_string).collect::<Vec<_>>().join(" "));
    }
    text
}

/// The strokes as a drawing for print (SVG 1.1): lines of one width on white paper.
///
/// The intensity chooses one of a few inks from the paper's white to the full colour, so that lines of any intensity
/// are opaque and their joints are as even as their middles; a stroke whose intensity changes is cut at every step.
/// The white part of a colour prints black. Weak strokes lie below strong ones. What is not finite or leaves the
/// screen is left out.
pub fn svg(strokes: &[Stroke]) -> String {
    let mut inks: BTreeMap<(u8, [u8; 3]), Path> = BTreeMap::new();
    for stroke in strokes {
        let places = [stroke.start, stroke.end];
        let finite = stroke.intensity.iter().chain(&stroke.color).all(|part| part.is_finite());
        if !finite || places.iter().flatten().any(|place| !(-1.0..=1.0).contains(place)) {
            continue;
        }
        for (from, to, ink) in steps(stroke.intensity) {
            let at = |part: f32| [0, 1].map(|axis| places[0][axis] + part * (places[1][axis] - places[0][axis]));
            let color = printed(stroke.color, f32::from(ink) / f32::from(INKS));
            inks.entry((ink, color)).or_default().line(at(from), at(to));
        }
    }
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200mm\" height=\"200mm\" viewBox=\"0 0 {PAPER} {PAPER}\">\n\
         <rect width=\"{PAPER}\" height=\"{PAPER}\" fill=\"#fff\"/>\n\
         <g fill=\"none\" stroke-width=\"{LINE}\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
    );
    for ((_, [red, green, blue]), path) in inks {
        let _ = writeln!(svg, "<path stroke=\"#{red:02x}{green:02x}{blue:02x}\" d=\"{}\"/>", path.data);
    }
    svg + "</g>\n</svg>\n"
}

/// The parts of a stroke that have one ink each, from and to 0..=1; none that is the paper's.
fn steps([first, last]: [f32; 2]) -> Vec<(f32, f32, u8)> {
    let inks = f32::from(INKS);
    let [first, last] = [first, last].map(|intensity| intensity.clamp(0.0, 1.0) * inks);
    // Where the rounded intensity changes: at half steps.
    let mut cuts = vec![0.0];
    if first != last {
        let cut = |step: u8| (f32::from(step) + 0.5 - first) / (last - first);
        let mut inside: Vec<f32> = (0..INKS).map(cut).filter(|part| *part > 0.0 && *part < 1.0).collect();
        inside.sort_by(f32::total_cmp);
        cuts.extend(inside);
    }
    cuts.push(1.0);
    let parts = cuts.windows(2).map(|ends| {
        let middle = first + (last - first) * (ends[0] + ends[1]) / 2.0;
        (ends[0], ends[1], middle.round() as u8)
    });
    parts.filter(|part| part.2 > 0).collect()
}

/// The ink of a colour, 0..=255, at a strength 0..=1.
fn printed(color: [f32; 3], strength: f32) -> [u8; 3] {
    let [_, saturation] = hue_saturation(color);
    let strongest = color.into_iter().fold(0.0, f32::max);
    let pure = color.map(|part| if strongest > 0.0 { (part / strongest - (1.0 - saturation)).max(0.0) } else { 0.0 });
    // What the eye sees as even steps are those of the encoded bytes.
    pure.map(|part| (255.0 + strength * (f32::from(srgb_from_linear(part)) - 255.0)).round() as u8)
}

/// The data of a path.
#[derive(Default)]
struct Path {
    data: String,
    end: Option<[f32; 2]>,
}

impl Path {
    /// Adds a line, which goes on where the last one ended if it can.
    fn line(&mut self, from: [f32; 2], to: [f32; 2]) {
        let place = |[x, y]: [f32; 2]| [(x + 1.0) / 2.0 * PAPER, (1.0 - y) / 2.0 * PAPER];
        let ([x, y], [to_x, to_y]) = (place(from), place(to));
        if self.end != Some(from) {
            let _ = write!(self.data, "M{x:.2} {y:.2}");
        }
        let _ = write!(self.data, "L{to_x:.2} {to_y:.2}");
        self.end = Some(to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stroke(start: [f32; 2], end: [f32; 2], intensity: [f32; 2], color: [f32; 3]) -> Stroke {
        Stroke { start, end, intensity, color }
    }

    #[test]
    fn text_lists_the_numbers_of_each_stroke() {
        let one = stroke([0.0, 0.5], [1.0, -1.0], [0.25, 1.0], [1.0, 0.0, 0.0]);
        assert_eq!(text(&[one, one], 1), "1 strokes\n0 0.5 1 -1 0.25 1 1 0 0");
        assert_eq!(text(&[], 9), "0 strokes");
    }

    #[test]
    fn connected_strokes_of_one_ink_are_one_path_and_white_prints_black() {
        let white = |start, end| stroke(start, end, [1.0; 2], [1.0; 3]);
        let svg = svg(&[white([-1.0, 1.0], [0.0, 1.0]), white([0.0, 1.0], [0.0, 0.0]), white([1.0, 1.0], [1.0, 1.0])]);
        assert!(
            svg.contains(
                "<path stroke=\"#000000\" d=\"M0.00 0.00L500.00 0.00L500.00 500.00M1000.00 0.00L1000.00 0.00\"/>"
            ),
            "{svg}"
        );
    }

    #[test]
    fn pure_colours_print_as_they_are_and_weak_ones_lighter_and_below() {
        let red = [1.0, 0.0, 0.0];
        let svg = svg(&[stroke([0.0; 2], [1.0, 0.0], [1.0; 2], red), stroke([0.0; 2], [0.0, 1.0], [0.5; 2], red)]);
        let (weak, strong) = (svg.find("#ff8080").unwrap(), svg.find("#ff0000").unwrap());
        assert!(weak < strong, "{svg}");
        assert_eq!(printed([1.0, 0.5, 0.5], 1.0), [188, 0, 0]);
    }

    #[test]
    fn a_ramp_is_cut_at_every_ink_and_the_parts_meet() {
        let parts = steps([0.0, 1.0]);
        assert_eq!(parts.len(), 16);
        assert!(parts.windows(2).all(|pair| pair[0].1 == pair[1].0 && pair[0].2 + 1 == pair[1].2), "{parts:?}");
        assert_eq!(steps([0.5, 0.5]), [(0.0, 1.0, 8)]);
        assert_eq!(steps([0.0, 0.0]), []);
        assert_eq!(steps([500.0, 500.0]), [(0.0, 1.0, 16)]);
    }

    #[test]
    fn what_is_not_finite_or_not_on_the_screen_is_left_out() {
        let bad = [f32::NAN, f32::INFINITY, 1e9];
        let strokes = bad.map(|bad| stroke([0.0; 2], [bad, 0.0], [1.0; 2], [1.0; 3]));
        assert!(!svg(&strokes).contains("<path"));
        assert!(!svg(&[stroke([0.0; 2], [1.0; 2], [f32::NAN; 2], [1.0; 3])]).contains("<path"));
    }
}
