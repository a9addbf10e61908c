//! Tubes around strokes, and spheres, as triangles.

use super::plant_drawing::{CrossSection, DrawnSphere, StrokeNode};
use crate::mesh::Mesh;
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Fewest and most sides of a tube.
const SIDES: [usize; 2] = [3, 256];
/// Fewest sides of a wave of a lobed outline.
const SIDES_OF_LOBE: f64 = 8.0;
/// Cosine of the sharpest bend at which a tube is mitred; at sharper ones it ends and another begins.
const SHARPEST: f64 = -0.5;
/// Cosine of the sharpest bend over which the shading of a tube is smooth.
const SMOOTH: f64 = 0.8;
/// Part of the detail that the sides of a tube take; its dome, of twice as many bands as sides in a quarter, takes the
/// rest.
const SIDES_PART: f64 = 0.8;
/// Least radius of a tube in parts of its largest: so that no triangle has two equal corners.
const LEAST: f64 = 1e-3;

/// Sides of a regular polygon whose sides stay within a distance of its circumscribed circle.
///
/// r (1 - cos(pi / n)) <= detail
fn sides(radius: f64, detail: f64) -> usize {
    let [least, most] = SIDES;
    if detail >= radius {
        return least;
    }
    ((PI / (1.0 - detail / radius).acos()).ceil() as usize).clamp(least, most)
}

/// A run of a stroke without sharp bends.
pub(super) struct Tube {
    nodes: Vec<StrokeNode>,
    section: CrossSection,
    /// Rings of the dome at its end, its tip not counted.
    dome_rings: usize,
    /// Unit vectors from node to node.
    directions: Vec<DVec3>,
    sides: usize,
}

/// The tubes of a stroke; none for one without width. Nodes at the place of the node before are left out.
///
/// - `section`: round or lobed.
pub(super) fn tubes(nodes: &[StrokeNode], section: CrossSection, detail: f64) -> Vec<Tube> {
    let largest = nodes.iter().map(|node| node.radius).fold(0.0, f64::max);
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec::new();
    }
    let round = sides(largest, SIDES_PART * detail);
    let (sides, section) = match section {
        CrossSection::Lobed { count, depth } if largest * depth > detail => {
            (round.max((SIDES_OF_LOBE * count).ceil() as usize).min(SIDES[1]), section)
        }
        // Waves that nobody sees are left out.
        _ => (round, CrossSection::Round),
    };
    let mut tubes: Vec<Tube> = Vec::new();
    let mut last: Option<StrokeNode> = None;
    for node in nodes {
        let node = StrokeNode { radius: node.radius.max(LEAST * largest), ..*node };
        let Some(before) = last else {
            last = Some(node);
            continue;
        };
        let Some(direction) = (node.position - before.position).try_normalize() else { continue };
        last = Some(node);
        match tubes.last_mut() {
            Some(tube) if tube.directions.last().is_some_and(|last| last.dot(direction) > SHARPEST) => {
                tube.nodes.push(node);
                tube.directions.push(direction);
            }
            _ => tubes.push(Tube {
                nodes: vec![before, node],
                directions: vec![direction],
                section,
                dome_rings: 0,
                sides,
            }),
        }
    }
    for tube in &mut tubes {
        // A dome that is lower than what may be left out is a cone.
        if tube.nodes.last().is_some_and(|node| node.radius > detail) {
            tube.dome_rings = sides.div_ceil(2) - 1;
        }
    }
    tubes
}

/// A ring of a tube: the middle, and what lies around it.
struct Ring {
    /// Positions, and the unit vectors that stand on the axis before and after it.
    points: Vec<DVec3>,
    radial: Vec<[DVec3; 2]>,
}

impl Tube {
    /// How many triangles it has.
    pub fn triangles(&self) -> usize {
        let segments = self.directions.len() + self.dome_rings;
        self.sides * (2 * segments + 1) + self.sides - 2
    }

    /// How many vertices it has.
    pub fn vertices(&self) -> usize {
        self.sides * (self.nodes.len() + self.dome_rings) + 1
    }

    /// The outline at an angle, and how it changes with the angle: in parts of the radius of a node.
    fn wave(&self, angle: f64) -> [f64; 2] {
        match self.section {
            CrossSection::Lobed { count, depth } => {
                let (sin, cos) = (count * angle).sin_cos();
                [1.0 + depth * sin, depth * count * cos]
            }
            _ => [1.0, 0.0],
        }
    }

    /// The rings at the nodes. Each lies in the plane that halves the bend; axes across are carried along without
    /// twist.
    fn rings(&self) -> Vec<Ring> {
        let mut across = self.directions[0].any_orthonormal_vector();
        let mut rings = Vec::with_capacity(self.nodes.len());
        for (number, node) in self.nodes.iter().enumerate() {
            let before = self.directions[number.saturating_sub(1)];
            let after = self.directions[number.min(self.directions.len() - 1)];
            let turn = DQuat::from_rotation_arc(before, after);
            let mitre = (before + after).normalize_or(before);
            let binormal = before.cross(across);
            let mut ring = Ring { points: Vec::new(), radial: Vec::new() };
            for side in 0..self.sides {
                let angle = TAU * side as f64 / self.sides as f64;
                let (sin, cos) = angle.sin_cos();
                let radial = across * cos + binormal * sin;
                let shift = before * (radial.dot(mitre) / before.dot(mitre));
                let [size, slope] = self.wave(angle);
                ring.points.push(node.position + (radial - shift) * (node.radius * size));
                // The outline r(a) has the normal r radial - r' tangent.
                let tangent = binormal * cos - across * sin;
                let normal = (radial * size - tangent * slope).normalize();
                ring.radial.push([normal, turn * normal]);
            }
            let turned = turn * across;
            across = (turned - after * turned.dot(after)).normalize_or(after.any_orthonormal_vector());
            rings.push(ring);
        }
        rings
    }

    /// Unit normals at the sides of a segment's ring, for the segment before or after it.
    fn normals(&self, ring: &Ring, node: usize, segment: usize) -> Vec<DVec3> {
        let leaning = |segment: usize, radial: DVec3| {
            let [from, to] = [self.nodes[segment], self.nodes[segment + 1]];
            let slope = (to.radius - from.radius) / from.position.distance(to.position);
            (radial - self.directions[segment] * slope).normalize()
        };
        // The other segment at the node, if there is one and the bend is smooth.
        let other = if segment < node { node } else { node.wrapping_sub(1) };
        let own = usize::from(segment >= node);
        let smooth = self.directions.get(other).filter(|other| other.dot(self.directions[segment]) > SMOOTH);
        let normal = |radial: &[DVec3; 2]| {
            let normal = leaning(segment, radial[own]);
            match smooth {
                Some(_) => (normal + leaning(other, radial[1 - own])).normalize(),
                None => normal,
            }
        };
        ring.radial.iter().map(normal).collect()
    }

    /// Appends its triangles: sides from node to node, a flat end at the first node, a dome at the last. Parameters are
    /// the part of the way around and the length from the first node.
    pub fn append_to(&self, mesh: &mut Mesh) {
        let rings = self.rings();
        let first = mesh.vertices.len() as u32;
        rings.iter().for_each(|ring| mesh.vertices.extend(&ring.points));
        let at = |ring: usize, side: usize| first + (ring * self.sides + side % self.sides) as u32;
        let mut length = 0.0;
        for segment in 0..self.directions.len() {
            let end = length + self.nodes[segment].position.distance(self.nodes[segment + 1].position);
            let normals = [segment, segment + 1].map(|node| self.normals(&rings[node], node, segment));
            let colour = self.nodes[segment + 1].colour;
            self.band(mesh, colour, [segment, segment + 1], [length, end], &normals, &at);
            length = end;
        }
        let colour = self.nodes[0].colour;
        for side in 1..self.sides - 1 {
            let corners = [at(0, 0), at(0, side + 1), at(0, side)];
            let parameters = [0, side + 1, side].map(|side| DVec2::new(side as f64 / self.sides as f64, 0.0));
            push(mesh, corners, [-self.directions[0]; 3], parameters, colour);
        }
        self.append_dome(mesh, &rings[self.nodes.len() - 1], length, &at);
    }

    /// Appends the sides between two rings.
    fn band(
        &self,
        mesh: &mut Mesh,
        colour: u32,
        rings: [usize; 2],
        lengths: [f64; 2],
        normals: &[Vec<DVec3>; 2],
        at: &impl Fn(usize, usize) -> u32,
    ) {
        for side in 0..self.sides {
            // Corners by ring and side.
            for corners in [[(0, 0), (0, 1), (1, 1)], [(0, 0), (1, 1), (1, 0)]] {
                let places = corners.map(|(ring, next)| at(rings[ring], side + next));
                let normal = corners.map(|(ring, next)| normals[ring][(side + next) % self.sides]);
                let around = |next: usize| (side + next) as f64 / self.sides as f64;
                let parameters = corners.map(|(ring, next)| DVec2::new(around(next), lengths[ring]));
                push(mesh, places, normal, parameters, colour);
            }
        }
    }

    /// Appends half a sphere at the last ring.
    fn append_dome(&self, mesh: &mut Mesh, ring: &Ring, length: f64, at: &impl Fn(usize, usize) -> u32) {
        let last = self.nodes.len() - 1;
        let (StrokeNode { position, radius, colour }, direction) = (self.nodes[last], self.directions[last - 1]);
        let count = self.dome_rings + 1;
        let normals_at = |step: usize| -> Vec<DVec3> {
            let (sin, cos) = (FRAC_PI_2 * step as f64 / count as f64).sin_cos();
            ring.radial.iter().map(|[_, radial]| *radial * cos + direction * sin).collect()
        };
        let length_at = |step: usize| length + radius * FRAC_PI_2 * step as f64 / count as f64;
        for step in 1..count {
            let normals = [normals_at(step - 1), normals_at(step)];
            mesh.vertices.extend(normals[1].iter().map(|normal| position + *normal * radius));
            let lengths = [length_at(step - 1), length_at(step)];
            self.band(mesh, colour, [last + step - 1, last + step], lengths, &normals, at);
        }
        let tip = mesh.vertices.len() as u32;
        mesh.vertices.push(position + direction * radius);
        let normals = normals_at(count - 1);
        for side in 0..self.sides {
            let corners = [at(last + count - 1, side), at(last + count - 1, side + 1), tip];
            let normal = [normals[side], normals[(side + 1) % self.sides], direction];
            let around = |side: f64| side / self.sides as f64;
            let side = side as f64;
            let low = length_at(count - 1);
            let parameters = [
                DVec2::new(around(side), low),
                DVec2::new(around(side + 1.0), low),
                DVec2::new(around(side + 0.5), length_at(count)),
            ];
            push(mesh, corners, normal, parameters, colour);
        }
    }
}

/// Appends a triangle.
pub(in crate::procedural) fn push(
    mesh: &mut Mesh,
    corners: [u32; 3],
    normals: [DVec3; 3],
    parameters: [DVec2; 3],
    colour: u32,
) {
    mesh.triangles.push(corners);
    mesh.corner_normals.push(normals);
    mesh.corner_parameters.push(parameters);
    mesh.surfaces.push(colour);
}

/// Sides of a sphere around its equator: along and across, each takes half of the detail.
fn sphere_sides(sphere: &DrawnSphere, detail: f64) -> usize {
    sides(sphere.radius, 0.5 * detail)
}

/// How many triangles a sphere has; as many vertices are enough for it.
pub(super) fn sphere_triangles(sphere: &DrawnSphere, detail: f64) -> usize {
    let sides = sphere_sides(sphere, detail);
    2 * sides * (sphere_bands(sides) - 1)
}

fn sphere_bands(sides: usize) -> usize {
    sides.div_ceil(2).max(2)
}

/// Appends a sphere: meridians meet in the poles on z. Parameters are the parts of the way around and from pole to
/// pole.
pub(super) fn append_sphere(mesh: &mut Mesh, sphere: &DrawnSphere, detail: f64) {
    let sides = sphere_sides(sphere, detail);
    let bands = sphere_bands(sides);
    let first = mesh.vertices.len() as u32;
    let normal = |band: usize, side: f64| {
        let (sin, cos) = (PI * band as f64 / bands as f64).sin_cos();
        let (across, along) = (TAU * side / sides as f64).sin_cos();
        DVec3::new(sin * along, sin * across, -cos)
    };
    mesh.vertices.push(sphere.centre - DVec3::Z * sphere.radius);
    for band in 1..bands {
        mesh.vertices.extend((0..sides).map(|side| sphere.centre + normal(band, side as f64) * sphere.radius));
    }
    mesh.vertices.push(sphere.centre + DVec3::Z * sphere.radius);
    let at = |band: usize, side: usize| match band {
        0 => first,
        band if band == bands => first + 1 + ((bands - 1) * sides) as u32,
        band => first + 1 + ((band - 1) * sides + side % sides) as u32,
    };
    for band in 0..bands {
        for side in 0..sides {
            let whole = [[(0, 0), (0, 1), (1, 1)], [(0, 0), (1, 1), (1, 0)]];
            // At a pole one of the two has two equal corners.
            let kept = &whole[usize::from(band == 0)..if band + 1 == bands { 1 } else { 2 }];
            for corners in kept {
                let places = corners.map(|(up, next)| at(band + up, side + next));
                let middle = |up: usize, next: usize| {
                    let is_pole = band + up == 0 || band + up == bands;
                    if is_pole { side as f64 + 0.5 } else { (side + next) as f64 }
                };
                let normals = corners.map(|(up, next)| normal(band + up, middle(up, next)));
                let parameters = corners
                    .map(|(up, next)| DVec2::new(middle(up, next) / sides as f64, (band + up) as f64 / bands as f64));
                push(mesh, places, normals, parameters, sphere.colour);
            }
        }
    }
}
