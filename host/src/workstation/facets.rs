//! Objects of a scene as polygons that a PS 340 shades itself: POLYGON, ATTRIBUTES and ILLUMINATION.
//!
//! # Model
//! The machine knows neither distances of lights nor mirrors, and its colours are numbers of the frame buffer. A light
//! comes from where it stands, seen from the middle of the scene, with the irradiance there; a mirror counts as body
//! colour; linear values go through the exponent of a display. All ours.

use super::names::name;
use crate::{
    color::WavelengthSets,
    illumination::{Light, Material, RgbPower, light::LightSource, material::MaterialPreview},
    mesh::{EdgeSelection, Mesh, edges::EdgeTable},
};
use glam::DVec3;
use protocol::command::{Attributes, Illumination, Polygon, PolygonVertex, SurfaceColor};

/// From linear light to numbers of the frame buffer.
const DISPLAY_EXPONENT: f64 = 1.0 / 2.2;
/// The sum of all lights, as numbers of the frame buffer, is no more than this.
const MOST_LIGHT: f64 = 1.4;
/// Even a mirror reflects this share diffusely; its body would be black else.
const LEAST_DIFFUSE: f64 = 0.4;

/// A point or direction in the left-handed space of the workstation.
pub fn mirrored(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.y, -p.z)
}

/// The triangles of a mesh in scene coordinates, with the normals that it brings, for each group of them.
///
/// - `hard`: which edges are drawn in pictures without hidden lines; the others are soft.
/// - `group_of`: the group of each triangle; empty if all are of the first.
/// - `attributes`: for each group the name of its ATTRIBUTES.
///
/// # Errors
/// A corner is too far away for single precision.
pub fn polygons(
    mesh: &Mesh,
    hard: &EdgeSelection,
    group_of: &[u32],
    attributes: &[String],
) -> Result<Vec<Vec<Polygon>>, String> {
    let table = EdgeTable::of(mesh);
    let mut soft = vec![[true; 3]; mesh.triangles.len()];
    for place in table.select(mesh, hard).flat_map(|edge| table.uses(edge)) {
        soft[place.triangle as usize][usize::from(place.side)] = false;
    }
    let mut groups: Vec<Vec<Polygon>> = vec![Vec::new(); attributes.len()];
    for (triangle, soft) in soft.iter().enumerate() {
        let corners = mesh.corners(triangle).map(|corner| mirrored(corner).as_vec3().to_array());
        if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
            continue;
        }
        if let Some(far) = corners.iter().find(|corner| corner.iter().any(|c| !c.is_finite())) {
            return Err(format!("the corner {far:?} is too far away for the workstation"));
        }
        let normals =
            mesh.corner_normals.get(triangle).map(|normals| normals.map(|n| mirrored(n).as_vec3().to_array()));
        // Counter-clockwise from outside; the mirrored z makes it clockwise. The edge that ends at corner k is side k - 1.
        let vertex = |k: usize| PolygonVertex {
            soft: soft[(k + 2) % 3],
            position: corners[k],
            normal: normals.map(|normals| normals[k]),
            color: None,
        };
        let group = group_of.get(triangle).map_or(0, |group| *group as usize);
        let attributes = groups[group].is_empty().then(|| name(&attributes[group]));
        let vertices = (0..3).map(vertex).collect();
        groups[group].push(Polygon { attributes, outline: None, coplanar: false, vertices });
    }
    Ok(groups)
}

/// Flat polygons of any number of corners, which are seen from both sides.
///
/// - `attributes`: the name of the ATTRIBUTES of all.
///
/// # Errors
/// A corner is too far away for single precision.
pub(super) fn flat_polygons(outlines: &[Vec<DVec3>], attributes: &str) -> Result<Vec<Polygon>, String> {
    let mut polygons: Vec<Polygon> = Vec::new();
    for outline in outlines.iter().filter(|outline| outline.len() > 2) {
        let corners: Vec<[f32; 3]> = outline.iter().map(|corner| mirrored(*corner).as_vec3().to_array()).collect();
        if let Some(far) = corners.iter().find(|corner| corner.iter().any(|c| !c.is_finite())) {
            return Err(format!("the corner {far:?} is too far away for the workstation"));
        }
        let vertex = |position: [f32; 3]| PolygonVertex { soft: false, position, normal: None, color: None };
        let vertices = corners.into_iter().map(vertex).collect();
        let attributes = polygons.is_empty().then(|| name(attributes));
        polygons.push(Polygon { attributes, outline: None, coplanar: false, vertices });
    }
    Ok(polygons)
}

/// The color by which a material is known, linear light: its body's, or without one that of what it reflects.
pub fn main_color(material: &Material) -> RgbPower {
    main_color_of(material, None)
}

/// The color by which a material is known at an instance, linear light; the mean over all without a variation.
pub(super) fn main_color_of(material: &Material, variation: Option<u16>) -> RgbPower {
    let MaterialPreview { diffuse, specular, mirror, .. } = material.preview_of(variation);
    let body = diffuse + mirror;
    if body == RgbPower::ZERO { specular } else { body }
}

/// What a material looks like to the machine, from both sides.
pub fn attributes(material: &Material) -> Attributes {
    let sum = |bands: RgbPower| bands.max(DVec3::ZERO).element_sum();
    let MaterialPreview { diffuse, specular, exponent, mirror } = material.preview();
    let body = sum(diffuse);
    let share = body / (body + sum(specular) + sum(mirror)).max(f64::MIN_POSITIVE);
    let front = SurfaceColor {
        color: hue_saturation_intensity(main_color(material)),
        diffuse: share.clamp(LEAST_DIFFUSE, 1.0),
        specular: exponent.max(1.0).log2().round().min(10.0) as u8,
        opaque: 1.0,
    };
    Attributes { front, back: None }
}

/// The lights of a scene as they arrive at a point of it; the brightest is 1, unless all together are too bright.
pub fn illumination(lights: &[Light], at: DVec3) -> Vec<Illumination> {
    let bands = WavelengthSets::bands();
    // Of a light that has a size, the middle counts; the machine knows no light from all around.
    let beam = |light: &Light| {
        let source = LightSource::new(light, &bands);
        let beam = if source.is_sky() { None } else { source.sample_incident(at, None, [0.5; 2], 0) }?;
        let [red, green, blue, ..] = beam.irradiance.0;
        Some((beam.towards, RgbPower::new(red, green, blue)))
    };
    let beams: Vec<(DVec3, RgbPower)> = lights.iter().filter_map(beam).collect();
    let brightest = beams.iter().map(|(_, irradiance)| irradiance.max_element()).fold(0.0, f64::max);
    if brightest <= 0.0 || !brightest.is_finite() {
        return Vec::new();
    }
    let colors: Vec<[f64; 3]> =
        beams.iter().map(|(_, irradiance)| hue_saturation_intensity(*irradiance / brightest)).collect();
    let gain = (MOST_LIGHT / colors.iter().map(|[_, _, i]| i).sum::<f64>()).min(1.0);
    let lamp = |((towards, _), [hue, saturation, intensity]): (&(DVec3, RgbPower), [f64; 3])| Illumination {
        direction: -mirrored(*towards),
        color: [hue, saturation, intensity * gain],
        ambient: 1.0,
    };
    beams.iter().zip(colors).map(lamp).collect()
}

/// Hue in degrees (0 is blue), saturation and intensity, 0..=1, of linear light.
fn hue_saturation_intensity(linear: RgbPower) -> [f64; 3] {
    let color = linear.clamp(DVec3::ZERO, DVec3::ONE).powf(DISPLAY_EXPONENT);
    let [hue, saturation] = hue_saturation(color);
    [hue, saturation, color.max_element()]
}

/// Hue in degrees (0 is blue) and saturation of a colour.
pub fn hue_saturation(color: RgbPower) -> [f64; 2] {
    let (high, low) = (color.max_element(), color.min_element());
    if high <= 0.0 || high == low {
        return [0.0, 0.0];
    }
    let span = high - low;
    let sector = if high == color.x {
        (color.y - color.z) / span
    } else if high == color.y {
        2.0 + (color.z - color.x) / span
    } else {
        4.0 + (color.x - color.y) / span
    };
    [(sector * 60.0 + 120.0).rem_euclid(360.0), span / high]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;
    use crate::illumination::Paint;
    use crate::illumination::material::Classic;
    use crate::mesh;

    #[test]
    fn hues_start_at_blue() {
        let of = |r, g, b| hue_saturation(RgbPower::new(r, g, b));
        assert_eq!(of(0.0, 0.0, 1.0), [0.0, 1.0]);
        assert_eq!(of(1.0, 0.0, 0.0), [120.0, 1.0]);
        assert_eq!(of(0.5, 0.5, 0.0), [180.0, 1.0]);
        assert_eq!(of(0.0, 1.0, 0.0), [240.0, 1.0]);
        assert_eq!(of(0.4, 0.4, 0.4), [0.0, 0.0]);
        assert_eq!(of(1.0, 0.5, 0.5), [120.0, 0.5]);
    }

    #[test]
    #[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
    fn polygons_run_clockwise_from_outside_and_edges_within_a_plane_are_soft() {
        let square = Mesh {
            vertices: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 2.0)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [2, 2, 3]],
            corner_normals: vec![[DVec3::Z; 3]; 3],
            ..Mesh::default()
        };
        let polygons = polygons(&square, &EdgeSelection::creases(25.0), &[], &["PERIS_A1".into()]).unwrap().concat();
        assert_eq!(polygons.len(), 2, "a triangle without area is left out");
        assert_eq!(polygons.iter().filter(|polygon| polygon.attributes.is_some()).count(), 1);
        for polygon in &polygons {
            let [a, b, c] = [0, 1, 2].map(|k| DVec3::from(polygon.vertices[k].position.map(f64::from)));
            // Outside is towards the viewer, where z is less; clockwise from there in left-handed space.
            assert_eq!((b - a).cross(c - a).normalize(), DVec3::Z);
            assert!(polygon.vertices.iter().all(|v| v.position[2] == -2.0 && v.normal == Some([0.0, 0.0, -1.0])));
            let soft: Vec<[f32; 3]> = polygon.vertices.iter().filter(|v| v.soft).map(|v| v.position).collect();
            assert_eq!(soft.len(), 1);
            assert!(soft[0][0] == soft[0][1], "the diagonal ends at one of its corners");
        }
        let named = ["PERIS_A1".to_owned(), "PERIS_A1_2".to_owned()];
        let all = super::polygons(&square, &EdgeSelection::ALL, &[], &named[..1]).unwrap().concat();
        let groups = super::polygons(&square, &EdgeSelection::ALL, &[1, 0, 0], &named).unwrap();
        assert!(groups.iter().zip(&named).all(|(group, name)| {
            let attributes = group[0].attributes.as_ref();
            group.len() == 1 && attributes.is_some_and(|given| given.to_string() == *name)
        }));
        assert!(all.iter().flat_map(|polygon| &polygon.vertices).all(|vertex| !vertex.soft));
        let far = Mesh { vertices: vec![DVec3::splat(1e40), DVec3::X, DVec3::Y], triangles: vec![[0, 1, 2]], ..square };
        assert!(super::polygons(&far, &EdgeSelection::ALL, &[], &named).unwrap_err().contains("too far away"));
        assert_eq!(
            super::polygons(&mesh::bunny().expect("it ships"), &EdgeSelection::ALL, &[], &named).unwrap()[0].len(),
            69_666
        );
    }

    #[test]
    fn materials_and_lights_stay_within_the_ranges_of_the_machine() {
        let (black, white) = (Paint::grey(0.0), Paint::grey(1.0));
        let mirror = Classic { diffuse: black, mirror: white, exponent: 1e6.into(), ..Classic::default() };
        let seen = attributes(&mirror.into()).front;
        assert_eq!((seen.color, seen.diffuse, seen.specular), ([0.0, 0.0, 1.0], LEAST_DIFFUSE, 10));
        let matt = attributes(&Classic { diffuse: Paint::grey(0.5), ..Classic::default() }.into()).front;
        assert!((matt.color[2] - 0.5_f64.powf(1.0 / 2.2)).abs() < 1e-12 && matt.diffuse == 1.0);
        let at = DVec3::new(0.0, 1.0, 0.0);
        let lamp =
            Light::Point { at: at + DVec3::new(0.0, 0.0, 2.0), intensity: Color::Bands(RgbPower::new(4.0, 0.0, 0.0)) };
        let sun = Light::Directional { direction: DVec3::new(0.0, -3.0, 0.0), irradiance: Color::grey(1.0) };
        let [lamp, sun] = <[Illumination; 2]>::try_from(illumination(&[lamp, sun], at)).unwrap();
        assert_eq!((lamp.direction, &lamp.color[..2]), (DVec3::Z, &[120.0, 1.0][..]));
        assert_eq!((sun.direction, &sun.color[..2]), (DVec3::NEG_Y, &[0.0, 0.0][..]));
        assert!((lamp.color[2] - 0.7).abs() < 1e-12 && lamp.color[2] == sun.color[2], "two of 1 are more than 1.4");
        assert_eq!(illumination(&[], at), []);
    }
}
