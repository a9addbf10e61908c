//! Shaded images of polygons with colours at their corners.

use super::images::{at, grey, lambert};
use super::*;
use protocol::command::CornerColor;

const BLACK: [f32; 3] = [0.0, 0.0, 0.0];
const WHITE: [f32; 3] = [0.0, 0.0, 1.0];
const RED: [f32; 3] = [120.0, 1.0, 1.0];
const GREEN: [f32; 3] = [240.0, 1.0, 1.0];
const BLUE: [f32; 3] = [0.0, 1.0, 1.0];

/// Gives the corners of a polygon hue, saturation and intensity, one after the other and again.
fn colored(mut polygon: Polygon, colors: &[[f32; 3]]) -> Polygon {
    for (vertex, front) in polygon.vertices.iter_mut().zip(colors.iter().cycle()) {
        vertex.color = Some(CornerColor { front: *front, back: None });
    }
    polygon
}

/// A square in the plane of the screen whose front is seen.
fn square() -> Polygon {
    polygon(&[[-0.5, -0.5, 0.0], [-0.5, 0.5, 0.0], [0.5, 0.5, 0.0], [0.5, -0.5, 0.0]])
}

/// Hue, saturation and intensity of numbers of the frame buffer.
fn hue_saturation_intensity([red, green, blue]: [u8; 3]) -> [f32; 3] {
    let [r, g, b] = [red, green, blue].map(f64::from);
    let (high, low) = (r.max(g).max(b), r.min(g).min(b));
    let turn = match high {
        _ if high == low => 0.0,
        _ if high == r => 120.0 + 60.0 * (g - b) / (high - low),
        _ if high == g => 240.0 + 60.0 * (b - r) / (high - low),
        _ => 60.0 * (r - g) / (high - low),
    };
    [turn as f32, if high > 0.0 { ((high - low) / high) as f32 } else { 0.0 }, (high / 255.0) as f32]
}

#[test]
fn every_colour_of_the_frame_buffer_can_be_given_to_a_corner() {
    let steps = [0, 1, 2, 51, 100, 127, 128, 200, 254, 255];
    for red in steps {
        for green in steps {
            let squares: Vec<Polygon> = (0..10)
                .map(|k| {
                    let x = k as f32 * 0.2 - 1.0;
                    let strip = polygon(&[[x, -1.0, 0.0], [x, 1.0, 0.0], [x + 0.2, 1.0, 0.0], [x + 0.2, -1.0, 0.0]]);
                    colored(strip, &[hue_saturation_intensity([red, green, steps[k]])])
                })
                .collect();
            let image =
                Scene::new(squares).image(Rendering::Wash, &ShadingEnvironment { viewport: [0, 0, 20, 2], ..plain() });
            for (k, blue) in steps.into_iter().enumerate() {
                assert_eq!(image.pixels[2 * k], [red, green, blue]);
            }
        }
    }
}

#[test]
fn wash_takes_the_colours_as_they_are_evenly_between_the_corners() {
    let image = Scene::new(vec![colored(square(), &[BLACK, BLACK, WHITE, WHITE])]).image(Rendering::Wash, &plain());
    for column in 0..240 {
        let part = (f64::from(column) + 0.5) / 240.0;
        assert_eq!(image.pixels[200 * 480 + 120 + column as usize], grey(part), "{column}");
    }
    let triangle = polygon(&[[-0.5, -0.5, 0.0], [0.0, 0.7, 0.0], [0.5, -0.5, 0.0]]);
    let image = Scene::new(vec![colored(triangle, &[RED, GREEN, BLUE])]).image(Rendering::Wash, &plain());
    let third = at(&image, 0.0, -0.1);
    assert!(third.iter().all(|part| part.abs_diff(85) <= 1), "{third:?}");
    assert!(
        image.pixels.iter().all(|p| *p == [0; 3] || p.iter().map(|c| u32::from(*c)).sum::<u32>().abs_diff(255) < 2)
    );
}

#[test]
fn colours_are_even_in_space_not_on_the_screen_also_where_the_eye_cuts_the_polygon() {
    // From before the eye, or behind it, to z = 3; where z is in the middle, the colour is.
    for near in [1.0_f32, -2.0] {
        let strip = polygon(&[[-0.3, -0.5, near], [-0.3, -0.5, 3.0], [0.3, -0.5, 3.0], [0.3, -0.5, near]]);
        let strip = colored(strip, &[BLACK, WHITE, WHITE, BLACK]);
        let image = Scene::new(vec![strip]).above(perspective()).image(Rendering::Wash, &plain());
        for z in [1.5, 2.0, 2.5] {
            let y = -0.5 / z / 30_f64.to_radians().tan();
            let got = at(&image, 0.0, y)[0];
            let expected = grey((z - f64::from(near)) / (3.0 - f64::from(near)))[0];
            assert!(got.abs_diff(expected) <= 2, "{near} {z}: {got} {expected}");
        }
    }
}

#[test]
fn flat_takes_the_mean_gouraud_each_corner_and_phong_each_place_as_the_colour_of_the_surface() {
    let mut square = colored(square(), &[BLACK, RED, RED, BLACK]);
    for vertex in &mut square.vertices {
        vertex.normal = Some([1.0, 0.0, -1.0]);
    }
    let dull = ShadingEnvironment { highlights: false, ..plain() };
    let image = |kind| Scene::new(vec![square.clone()]).image(kind, &dull);
    let flat = image(Rendering::Flat);
    let mean = grey(lambert(1.0) / 2.0)[0];
    assert!([at(&flat, 0.0, 0.4), at(&flat, 0.0, -0.4)] == [[mean, 0, 0]; 2]);
    let smooth = lambert(0.5_f64.sqrt());
    for kind in [Rendering::Gouraud, Rendering::Phong] {
        let image = image(kind);
        for line in [130, 240, 350] {
            let part = (f64::from(line) + 0.5 - 120.0) / 240.0;
            let [red, green, blue] = image.pixels[line as usize * 480 + 240];
            let expected = grey(smooth * part)[0];
            assert!(red.abs_diff(expected) <= 1 && (green, blue) == (0, 0), "{kind:?} {line}: {red} {expected}");
        }
    }
}

#[test]
fn the_reverse_has_its_own_colour_if_one_was_given() {
    let mut turned = square();
    turned.vertices.reverse();
    for (polygon, expected) in [(square(), [255, 0, 0]), (turned, [0, 255, 0])] {
        let mut both = colored(polygon.clone(), &[RED]);
        for vertex in &mut both.vertices {
            vertex.color = Some(CornerColor { front: RED, back: Some(GREEN) });
        }
        assert_eq!(at(&Scene::new(vec![both]).image(Rendering::Wash, &plain()), 0.0, 0.0), expected);
        let one = colored(polygon, &[RED]);
        assert_eq!(at(&Scene::new(vec![one]).image(Rendering::Wash, &plain()), 0.0, 0.0), [255, 0, 0]);
    }
}

#[test]
fn polygons_with_and_without_colours_stand_side_by_side() {
    let left = polygon(&[[-1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]);
    let right = polygon(&[[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 0.0]]);
    let scene = Scene::new(vec![colored(left, &[BLUE]), right]);
    let image = scene.image(Rendering::Wash, &plain());
    assert_eq!((at(&image, -0.5, 0.0), at(&image, 0.5, 0.0)), ([0, 0, 255], [255; 3]));
    let lines = scene.lines(Rendering::HiddenLine);
    assert!(
        lines.len() == 7 && lines.iter().all(|line| line.color == lines[0].color),
        "lines are not colored by corners"
    );
}
