//! A solution by radiosity as polygons with colours at their corners, which the machine fills with what lies between them.
//!
//! # Model
//! The machine mixes numbers of its frame buffer, so that colours are those of sRGB. Of hue, saturation and intensity so
//! many digits are sent that red, green and blue are off by less than a quarter of a step of eight bits.

use super::{
    WorkstationError,
    facets::{hue_saturation, mirrored},
    network::send,
};
use crate::{
    color::srgb,
    render::tiles::{ColorTile, Tiling},
};
use glam::DVec3;
use protocol::{
    Value,
    command::{Command, CornerColor, Object, Polygon, PolygonVertex},
};

/// Steps of hue in a degree, and of saturation and intensity in 1.
const HUE_STEPS: f64 = 20.0;
const STEPS: f64 = 2000.0;
/// Polygons in one node.
const POLYGONS: usize = 10_000;

/// The polygons of all tiles, in nodes of a size that travels well.
///
/// # Errors
/// [`WorkstationError::Scene`]: a corner is too far away for single precision.
pub fn polygons(tiling: &Tiling) -> Result<Vec<Object>, WorkstationError> {
    let polygons: Vec<Polygon> = tiling.tiles.iter().map(polygon).collect::<Result<_, _>>()?;
    Ok(polygons.chunks(POLYGONS).map(|part| Object::Polygons(part.to_vec())).collect())
}

fn polygon(tile: &ColorTile) -> Result<Polygon, WorkstationError> {
    let vertex = |(corner, [front, back]): (&DVec3, &[DVec3; 2])| {
        let position = mirrored(*corner).as_vec3();
        if !position.is_finite() {
            return Err(WorkstationError::Scene(format!("the corner {corner} is too far away for the workstation")));
        }
        let (front, back) = (hue_saturation_intensity(*front), hue_saturation_intensity(*back));
        let color = CornerColor { front, back: Some(back).filter(|back| *back != front) };
        Ok(PolygonVertex { soft: true, position: position.to_array(), normal: None, color: Some(color) })
    };
    // On the screen both spaces look alike: what ran counter-clockwise about the outside does so still.
    let vertices = tile.corners.iter().zip(&tile.colors).rev().map(vertex).collect::<Result<_, _>>()?;
    Ok(Polygon { attributes: None, outline: None, coplanar: false, vertices })
}

/// Hue in degrees (0 is blue), saturation and intensity, 0..=1, of numbers of the frame buffer, 0..=1; rounded.
pub fn hue_saturation_intensity(color: DVec3) -> [f32; 3] {
    let [hue, saturation] = hue_saturation(color);
    let round = |value: f64, steps: f64| ((value * steps).round() / steps) as f32;
    [round(hue, HUE_STEPS), round(saturation, STEPS), round(color.max_element(), STEPS)]
}

/// What pictures of tiles need: their colours as they are, before the background of the scene.
///
/// - `background`: linear radiance.
pub fn settings(background: DVec3) -> Vec<Command> {
    let background = hue_saturation_intensity(srgb::encoded(background)).map(f64::from);
    let set = |value: Value, input: u32| send(value, input, "SHADINGENVIRONMENT");
    vec![
        set(Value::Vector3(background.into()), 2),
        set(Value::Real(1.0), 4),
        set(Value::Real(0.0), 6),
        // The whole screen is washed.
        set(Value::Integer(2), 7),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red, green and blue of the machine's hue circle: 0 blue, 120 red, 240 green.
    fn rgb([hue, saturation, intensity]: [f32; 3]) -> DVec3 {
        let part = |center: f64| {
            let away = (f64::from(hue) - center + 180.0).rem_euclid(360.0) - 180.0;
            f64::from(intensity) * (1.0 - f64::from(saturation) * ((away.abs() - 60.0) / 60.0).clamp(0.0, 1.0))
        };
        DVec3::new(part(120.0), part(240.0), part(360.0))
    }

    #[test]
    fn every_colour_comes_back_within_a_quarter_of_a_step_and_the_corners_of_the_cube_exactly() {
        for corner in 0..8 {
            let color = DVec3::from([0, 1, 2].map(|bit| f64::from(corner >> bit & 1)));
            assert_eq!(rgb(hue_saturation_intensity(color)), color);
        }
        let steps = 37;
        let mut worst: f64 = 0.0;
        for k in 0..steps * steps * steps {
            let color =
                DVec3::from([1, steps, steps * steps].map(|by| f64::from(k / by % steps) / f64::from(steps - 1)));
            worst = worst.max((rgb(hue_saturation_intensity(color)) - color).abs().max_element());
        }
        assert!(worst * 255.0 < 0.25, "{}", worst * 255.0);
    }

    #[test]
    fn tiles_become_polygons_that_run_clockwise_with_the_reverse_where_it_differs() {
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::new(0.0, 1.0, 3.0)];
        let (red, green) = (DVec3::X, DVec3::Y);
        let tile = ColorTile { corners, colors: vec![[red, red], [red, green], [green, DVec3::ZERO]] };
        let found = polygon(&tile).unwrap();
        let positions: Vec<[f32; 3]> = found.vertices.iter().map(|vertex| vertex.position).collect();
        assert_eq!(positions, [[0.0, 1.0, -3.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        let (red, green) = ([120.0, 1.0, 1.0], [240.0, 1.0, 1.0]);
        let colors: Vec<CornerColor> = found.vertices.iter().filter_map(|vertex| vertex.color).collect();
        let expected = [(green, Some([0.0; 3])), (red, Some(green)), (red, None)];
        assert_eq!(colors, expected.map(|(front, back)| CornerColor { front, back }));
        let far = ColorTile { corners: vec![DVec3::splat(1e40), DVec3::X, DVec3::Y], ..tile };
        assert!(polygon(&far).unwrap_err().to_string().contains("too far away"));
    }
}
