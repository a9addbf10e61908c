//! Shaded renderings: wash, flat, Gouraud, Phong.
//!
//! # Model
//! Wash is the colour of the surface without light. Flat: one light for a face, of its normal and its middle. Gouraud:
//! the light at the corners, between them evenly in space (not on the screen). Phong: the normals of the corners evenly
//! in space, made of length 1, and the light of each. Depth cueing takes the light by 1 - cue d, d from 0 at the front
//! boundary to 1 at the back; then comes the exposure, and what is above 1 is 1.
//!
//! Colours that are given with the corners stand for that of the surface: wash and Phong take them evenly in space
//! between the corners, flat their mean, Gouraud lights each corner in its own.
//!
//! A side that shows its reverse is lit there. Places that no polygon covers have the colour of the background, and so
//! has the uncovered part of a pixel at an edge.

use super::{
    Facets, Image,
    facets::{Face, toward_eye},
    normals::corner_normals,
    project::project,
    scan::Scan,
    surface::{Surface, light, rgb},
};
use crate::{functions::devices::shading::ShadingEnvironment, port::Rendering};
use glam::{DMat3, DVec3, DVec4};

/// A shaded rendering in progress.
#[derive(Debug)]
pub struct Shading {
    scan: Scan,
    lit: Lit,
    background: [f64; 3],
    viewport: [u32; 4],
}

/// Facets under light.
#[derive(Debug)]
struct Lit {
    facets: Facets,
    kind: Rendering,
    /// Of each face for wash and flat, of each corner for Gouraud and for wash in colours of corners.
    colors: Vec<[f64; 3]>,
    /// Of each corner for Gouraud and Phong.
    normals: Vec<DVec3>,
    ambient: [f64; 3],
    exposure: f64,
    depth_cue: f64,
    highlights: bool,
}

impl Shading {
    /// Begins with facets.
    ///
    /// - `kind`: one of the shaded ones.
    pub fn new(kind: Rendering, facets: Facets, environment: &ShadingEnvironment) -> Shading {
        let projected = project(&facets, &[]);
        let [_, _, width, height] = environment.viewport.map(|pixels| pixels as usize);
        let scan = Scan::new(&projected, width, height, environment.samples());
        let mut lit = Lit {
            facets,
            kind,
            colors: Vec::new(),
            normals: Vec::new(),
            ambient: rgb(environment.ambient),
            exposure: environment.exposure,
            depth_cue: environment.depth_cue,
            highlights: environment.highlights,
        };
        lit.prepare();
        Shading { scan, lit, background: rgb(environment.background), viewport: environment.viewport }
    }

    /// Goes on for about so many units of work. Returns the image, once it is done.
    pub fn advance(&mut self, units: u64) -> Option<Image> {
        let Shading { scan, lit, background, viewport } = self;
        let sums = scan.advance(units, &|triangle, place| lit.color(triangle, place))?;
        let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
        let pixels = sums.into_iter().map(|[r, g, b, covered]| {
            let [br, bg, bb] = background.map(|part| part as f32 * (1.0 - covered));
            [byte(r + br), byte(g + bg), byte(b + bb)]
        });
        let [left, bottom, width, height] = *viewport;
        Some(Image { left, bottom, width, height, pixels: pixels.collect() })
    }
}

impl Lit {
    /// Computes what does not depend on the pixel.
    fn prepare(&mut self) {
        if matches!(self.kind, Rendering::Gouraud | Rendering::Phong) {
            self.normals = corner_normals(&self.facets);
        }
        let facets = &self.facets;
        let faces = facets.faces.iter();
        self.colors = match self.kind {
            Rendering::Wash if facets.is_colored => {
                corners(facets).map(|(corner, face)| self.corner_color(face, corner).into()).collect()
            }
            Rendering::Wash => faces.map(|face| self.surface(face).color).collect(),
            Rendering::Flat => faces.map(|face| self.flat(face)).collect(),
            Rendering::Gouraud => corners(facets)
                .map(|(corner, face)| {
                    let point = &facets.points[facets.corners[corner].point as usize];
                    self.light(face, self.normals[corner], point.eye, self.corner_color(face, corner))
                })
                .collect(),
            _ => Vec::new(),
        };
    }

    /// The side of a face that is seen.
    fn surface(&self, face: &Face) -> &Surface {
        &self.facets.surfaces[face.surfaces[usize::from(!face.toward)] as usize]
    }

    /// The colour of the side that is seen at a corner of a face.
    fn corner_color(&self, face: &Face, corner: usize) -> DVec3 {
        match self.facets.corners[corner].colors {
            Some(sides) => sides[usize::from(!face.toward)].map(f64::from).into(),
            None => self.surface(face).color.into(),
        }
    }

    /// The one light of a face, in the mean of the colours of its corners if they have some.
    fn flat(&self, face: &Face) -> [f64; 3] {
        let mut color = self.surface(face).color.into();
        if self.facets.is_colored {
            let sum: DVec3 = face.corners.clone().map(|corner| self.corner_color(face, corner)).sum();
            color = sum / face.corners.len() as f64;
        }
        self.light(face, face.normal, face.center, color)
    }

    /// The light of a position on a face.
    ///
    /// - `normal`: towards the front.
    /// - `color`: of the surface there.
    fn light(&self, face: &Face, normal: DVec3, place: DVec3, color: DVec3) -> [f64; 3] {
        let normal = if face.toward { normal } else { -normal };
        let eye = toward_eye(self.facets.views[face.view as usize].eye, place).normalize_or_zero();
        let surface = Surface { color: color.into(), ..*self.surface(face) };
        light(&surface, &self.facets.lights, normal, eye, self.ambient, self.highlights)
    }

    /// Red, green and blue of a triangle at a position on the vector screen.
    fn color(&self, triangle: u32, place: [f64; 2]) -> [f32; 3] {
        let facets = &self.facets;
        let triangle = &facets.triangles[triangle as usize];
        let face = &facets.faces[triangle.face as usize];
        let points = triangle.corners.map(|corner| &facets.points[facets.corners[corner as usize].point as usize]);
        let view = &facets.views[face.view as usize];
        let shares = shares(points.map(|p| p.clip), [view.horizontal, view.vertical], place);
        let mix = |of: [DVec3; 3]| of[0] * shares[0] + of[1] * shares[1] + of[2] * shares[2];
        let color = match self.kind {
            Rendering::Flat => self.colors[triangle.face as usize],
            Rendering::Wash if !facets.is_colored => self.colors[triangle.face as usize],
            Rendering::Wash | Rendering::Gouraud => {
                mix(triangle.corners.map(|corner| self.colors[corner as usize].into())).to_array()
            }
            _ => {
                let normal = mix(triangle.corners.map(|corner| self.normals[corner as usize]));
                let color = match facets.is_colored {
                    true => mix(triangle.corners.map(|corner| self.corner_color(face, corner as usize))),
                    false => self.surface(face).color.into(),
                };
                self.light(face, normal.normalize_or(face.normal), mix(points.map(|p| p.eye)), color)
            }
        };
        let sum = |part: fn(&DVec4) -> f64| (0..3).map(|k| part(&points[k].clip) * shares[k]).sum::<f64>();
        let depth = (sum(|clip| clip.z) / sum(|clip| clip.w)).clamp(0.0, 1.0);
        let depth = if depth.is_nan() { 0.0 } else { depth };
        let gain = self.exposure * (1.0 - self.depth_cue * depth);
        color.map(|part| (part * gain).clamp(0.0, 1.0) as f32)
    }
}

/// The corners of all faces, in their order.
fn corners(facets: &Facets) -> impl Iterator<Item = (usize, &Face)> {
    facets.faces.iter().flat_map(|face| face.corners.clone().map(move |corner| (corner, face)))
}

/// How much each corner of a triangle counts, in space, at a position on the vector screen; together 1.
///
/// - `clip`: the corners in clip space; they may lie behind the eye.
/// - `viewport`: left and right, bottom and top.
///
/// # Source
/// Olano and Greer 1997, Triangle scan conversion using 2D homogeneous coordinates.
fn shares(clip: [DVec4; 3], viewport: [[f64; 2]; 2], place: [f64; 2]) -> [f64; 3] {
    let inside = |[low, high]: [f64; 2], c: f64| 2.0 * (c - low) / (high - low) - 1.0;
    let ray = DVec3::new(inside(viewport[0], place[0]), inside(viewport[1], place[1]), 1.0);
    let [a, b, c] = clip.map(|p| DVec3::new(p.x, p.y, p.w));
    let [u, v, w] = [b.cross(c).dot(ray), c.cross(a).dot(ray), a.cross(b).dot(ray)];
    // The sign of the determinant makes the shares of a position inside positive.
    let sign = DMat3::from_cols(a, b, c).determinant().signum();
    let positive = [u, v, w].map(|share| (share * sign).max(0.0));
    let sum: f64 = positive.iter().sum();
    if sum > 0.0 && sum.is_finite() { positive.map(|share| share / sum) } else { [1.0 / 3.0; 3] }
}
