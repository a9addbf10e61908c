//! Solids that know their exact surfaces, and what those say of them.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};

use super::mass::Moments;
use super::{ExactSolid, Mass, PrimitiveError};
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::surface::{Parallelogram, Surface, TessellationError, Tolerance, TransformedSurface, tessellate};

/// Each direction of a surface is divided so often for the integrals over it, with a rule of [`NODES`] points in each part.
const PARTS: usize = 6;
/// Points of the rule of Gauss and Legendre.
const NODES: usize = 14;

/// A flat face of a solid: triangles in one plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Its corners.
    pub corners: Vec<DVec3>,
    /// Triangles over the corners, counter-clockwise from outside. Corners that none of them uses do no harm.
    pub triangles: Vec<[u32; 3]>,
    /// The outward unit normal.
    normal: DVec3,
}

impl Face {
    /// A convex face; its corners are counter-clockwise from outside, three or more.
    pub fn convex(corners: Vec<DVec3>) -> Face {
        let triangles = (2..corners.len() as u32).map(|k| [0, k - 1, k]).collect();
        Face::new(corners, triangles)
    }

    /// A face of some triangles. Its normal is the mean of theirs.
    pub fn new(corners: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Face {
        let size = Bounds::of(corners.iter().copied()).diagonal();
        let at = |index: u32| corners[index as usize] / size;
        let area = |&[a, b, c]: &[u32; 3]| (at(b) - at(a)).cross(at(c) - at(a));
        let normal = triangles.iter().map(area).sum::<DVec3>().normalize_or_zero();
        Face { corners, triangles, normal }
    }

    /// The rectangle in its plane that its corners fill.
    pub fn plane(&self) -> Parallelogram {
        let [from, to] = self.triangles.first().map_or([0, 0], |t| [t[0], t[1]]).map(|k| self.corners[k as usize]);
        let along = (to - from - self.normal * (to - from).dot(self.normal)).normalize_or(DVec3::X);
        let across = self.normal.cross(along);
        let flat = |p: &DVec3| DVec2::new((*p - self.corners[0]).dot(along), (*p - self.corners[0]).dot(across));
        let (low, high) = self
            .corners
            .iter()
            .map(flat)
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let origin = self.corners[0] + along * low.x + across * low.y;
        Parallelogram::new(origin, along * (high.x - low.x), across * (high.y - low.y))
    }
}

/// What a body has, surfaces taken exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Area of the surface, square units.
    pub area: f64,
    /// Volume, centroid and inertia.
    pub mass: Mass,
}

/// A solid between exact surfaces that close, outside out.
pub struct Body {
    curved: Vec<Arc<dyn Surface>>,
    faces: Vec<Face>,
}

impl Body {
    /// The solid between surfaces and flat faces. Where they meet they agree bit by bit.
    pub fn new(curved: Vec<Arc<dyn Surface>>, faces: Vec<Face>) -> Body {
        Body { curved, faces }
    }

    /// Whether it has other than flat faces.
    pub fn is_curved(&self) -> bool {
        !self.curved.is_empty()
    }

    /// The body moved by an affine map that is not singular.
    pub fn transformed(self, placement: DAffine3) -> Body {
        let moved = |surface| Arc::new(TransformedSurface::new(surface, placement)) as Arc<dyn Surface>;
        let is_mirrored = placement.matrix3.determinant() < 0.0;
        let face = |face: Face| {
            let corners = face.corners.iter().map(|corner| placement.transform_point3(*corner)).collect();
            let turn = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
            Face::new(corners, face.triangles.into_iter().map(turn).collect())
        };
        Body { curved: self.curved.into_iter().map(moved).collect(), faces: self.faces.into_iter().map(face).collect() }
    }

    /// Its surfaces, in the order in which triangles name them.
    pub fn surfaces(&self) -> Vec<Arc<dyn Surface>> {
        let planes = self.faces.iter().map(|face| Arc::new(face.plane()) as Arc<dyn Surface>);
        self.curved.iter().cloned().chain(planes).collect()
    }

    /// A closed mesh with normals, parameters and surfaces; flat faces stay flat.
    ///
    /// # Errors
    /// [`TessellationError`] if the tolerance is not positive or too fine.
    pub fn tessellate(&self, tolerance: Tolerance) -> Result<Mesh, TessellationError> {
        let mut mesh = tessellate(&self.curved, tolerance)?;
        for (face, surface) in self.faces.iter().zip(self.curved.len() as u32..) {
            let plane = face.plane();
            let (normal, base) = (plane.normal(DVec2::ZERO), mesh.vertices.len() as u32);
            let uv: Vec<DVec2> = face.corners.iter().map(|p| plane.nearest(*p, DVec2::splat(0.5))).collect();
            mesh.vertices.extend(&face.corners);
            for triangle in &face.triangles {
                mesh.triangles.push(triangle.map(|corner| corner + base));
                mesh.corner_normals.push([normal; 3]);
                mesh.corner_parameters.push(triangle.map(|corner| uv[corner as usize]));
                mesh.surfaces.push(surface);
            }
        }
        Ok(mesh.welded())
    }

    /// The solid of its tessellation, with its surfaces.
    ///
    /// # Errors
    /// [`PrimitiveError`] if the tolerance is not positive or too fine, or triangles collapse.
    pub fn solid(self, tolerance: Tolerance) -> Result<ExactSolid, PrimitiveError> {
        let mesh = self.tessellate(tolerance)?;
        let surfaces = self.surfaces().into_iter().map(Some).collect();
        Ok(ExactSolid::new(mesh, surfaces)?)
    }

    /// The length of the diagonal of a box that holds it nearly, if it is curved; model units.
    pub fn curved_extent(&self) -> Option<f64> {
        const STEPS: usize = 8;
        let points = |surface: &dyn Surface| {
            let [low, high] = surface.domain();
            let part = |k: usize| DVec2::new((k % (STEPS + 1)) as f64, (k / (STEPS + 1)) as f64) / STEPS as f64;
            let all = (0..(STEPS + 1) * (STEPS + 1)).map(|k| surface.point(low + (high - low) * part(k)));
            Bounds::of(all)
        };
        let whole = self.curved.iter().map(|surface| points(surface)).fold(Bounds::EMPTY, Bounds::union);
        self.is_curved().then(|| whole.diagonal())
    }

    /// Area, volume, centroid and inertia of the exact surfaces, by Gauss and Legendre's rule on each.
    ///
    /// To rounding for flat faces, and to at least ten digits for surfaces that are smooth within themselves and whose
    /// radii of curvature are not much smaller than their sixth parts.
    pub fn measures(&self) -> Measures {
        let rule = gauss_legendre();
        let corners = self.faces.iter().flat_map(|face| face.corners.iter().copied());
        let [low, middle, high] = [0.0, 0.5, 1.0];
        let grid = [[low, low], [high, low], [low, high], [high, high], [middle, middle]].map(DVec2::from_array);
        let at = |surface: &dyn Surface| {
            let [low, high] = surface.domain();
            grid.map(|part| surface.point(low + (high - low) * part))
        };
        let bounds = Bounds::of(corners.chain(self.curved.iter().flat_map(|surface| at(surface))));
        if bounds.is_empty() {
            return Measures { area: 0.0, mass: Mass::ZERO };
        }
        let origin = bounds.center();
        let (mut moments, mut area) = (Moments::ZERO, 0.0);
        for surface in &self.curved {
            let [low, high] = surface.domain();
            let step = (high - low) / PARTS as f64;
            for (u, u_weight) in rule_over(&rule, low.x, step.x) {
                for (v, v_weight) in rule_over(&rule, low.y, step.y) {
                    let uv = DVec2::new(u, v);
                    let [du, dv] = surface.derivatives(uv);
                    let element = du.cross(dv) * (u_weight * v_weight);
                    area += element.length();
                    moments.add_element(surface.point(uv) - origin, element);
                }
            }
        }
        for face in &self.faces {
            for triangle in &face.triangles {
                let [a, b, c] = triangle.map(|corner| face.corners[corner as usize] - origin);
                area += (b - a).cross(c - a).length() * 0.5;
                moments.add_triangle([a, b, c]);
            }
        }
        Measures { area, mass: moments.mass(origin) }
    }
}

/// The points and weights of the rule in each of the parts of an interval.
fn rule_over(rule: &[[f64; 2]; NODES], low: f64, step: f64) -> impl Iterator<Item = (f64, f64)> {
    let part = move |k: usize| rule.iter().map(move |[x, w]| (low + step * (k as f64 + x), step * w));
    (0..PARTS).flat_map(part)
}

/// Points and weights of Gauss and Legendre's rule for 0..=1: the roots of Legendre's polynomial by Newton's method.
fn gauss_legendre() -> [[f64; 2]; NODES] {
    let n = NODES as f64;
    std::array::from_fn(|k| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut below, mut value) = (1.0, x);
            for degree in 2..=NODES {
                let d = degree as f64;
                (below, value) = (value, ((2.0 * d - 1.0) * x * value - (d - 1.0) * below) / d);
            }
            slope = n * (x * value - below) / (x * x - 1.0);
            x -= value / slope;
        }
        [0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope)]
    })
}
