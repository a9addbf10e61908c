//! A camera as the line of a script that asks for it.

use crate::scene::Camera;
use glam::DVec3;

/// Significant digits of numbers: the picture of a million pixels is the same within one of them.
const DIGITS: usize = 7;

/// The call of `camera()` that makes a camera, as a line of a script without its end.
///
/// A lens is left out.
pub fn camera_call(camera: &Camera) -> String {
    let Camera { from, at, up, field_of_view, near, far, lens: _, parallel, motion: _ } = camera;
    let mut entries =
        vec![format!("from: {}", point(*from)), format!("at: {}", point(*at)), format!("up: {}", point(*up))];
    match parallel {
        Some(parallel) => {
            entries.push(format!("height: {}", number(parallel.height)));
            if parallel.oblique.length() > 1e-9 {
                let [right, up] = parallel.oblique.to_array().map(number);
                entries.push(format!("oblique: [[{right}, {up}]]"));
            }
        }
        None => entries.push(format!("field_of_view: {}", number(*field_of_view))),
    }
    if *near > 0.0 {
        entries.push(format!("near: {}", number(*near)));
    }
    entries.extend(far.map(|far| format!("far: {}", number(far))));
    format!("camera(#{{ {} }});", entries.join(", "))
}

fn point(point: DVec3) -> String {
    // What is nothing beside the rest is rounding.
    let size = point.abs().max_element();
    let [x, y, z] = point.to_array().map(|value| if value.abs() < 1e-9 * size { "0".into() } else { number(value) });
    format!("[{x}, {y}, {z}]")
}

/// A number of few digits, without an exponent where it is not needed.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    let plain = format!("{rounded}");
    if plain.len() > 2 * DIGITS { format!("{rounded:e}") } else { plain }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Parallel;
    use crate::script::{Inputs, evaluate};
    use glam::DVec2;
    use std::path::Path;

    #[test]
    fn the_line_of_a_camera_makes_that_camera() {
        let plain = Camera {
            from: DVec3::new(3.25, -2e-7, 7e8),
            at: DVec3::new(0.5, 1.0, -1234.567),
            up: DVec3::Y,
            field_of_view: 34.5,
            near: 0.0,
            far: None,
            lens: None,
            parallel: None,
            motion: None,
        };
        let parallel = |oblique| Camera { parallel: Some(Parallel { height: 2.5, oblique }), ..plain };
        let cameras = [
            plain,
            Camera { near: 0.25, far: Some(1e12), ..plain },
            parallel(DVec2::ZERO),
            parallel(DVec2::new(-0.5, 0.25)),
        ];
        for camera in cameras {
            let line = camera_call(&camera);
            let text = format!("sphere(1);\n{line}");
            let found = evaluate(&text, "a.rhai", Path::new(""), &Inputs::default()).expect(&line).scene.camera;
            let found = found.expect("a camera");
            assert!(found.from.distance(camera.from) <= 1e-6 * camera.from.length(), "{line}");
            assert_eq!((found.near, found.far, found.parallel), (camera.near, camera.far, camera.parallel), "{line}");
            assert!(camera.parallel.is_some() || found.field_of_view == camera.field_of_view);
        }
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!([number(1e-20), number(12.0), number(-1.0 / 3.0)], ["1e-20", "12", "-0.3333333"]);
    }
}
