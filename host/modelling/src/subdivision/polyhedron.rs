//! Polyhedral meshes of faces with any number of corners, and which sides meet.

use std::collections::HashSet;

use glam::DVec3;
use rayon::prelude::*;

use super::error::SubdivisionError;
use crate::mesh::Mesh;

/// No side at the other side: a border.
pub(super) const NONE: u32 = u32::MAX;

/// The most corners of faces that a polyhedron may have.
pub(super) const MOST_CORNERS: usize = 1 << 28;

/// The greatest coordinate: products of two stay finite.
const FARTHEST: f64 = 1e150;

/// A mesh of faces with any number of corners, closed or with borders.
///
/// Faces run counter-clockwise seen from outside. An edge belongs to one face or two; around a vertex there may be
/// several fans of faces.
///
/// Corners of all faces are numbered through; corner h also names the side from it to the next corner of its face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyhedron {
    /// Positions.
    pub(super) points: Vec<DVec3>,
    /// For each corner its vertex.
    pub(super) corners: Vec<u32>,
    /// For each face its first corner, and last the number of corners.
    pub(super) starts: Vec<u32>,
    /// For each corner the next one of its face.
    pub(super) next: Vec<u32>,
    /// For each side the one that runs along it the other way.
    pub(super) twins: Vec<u32>,
    /// For each side its sharpness; empty if all are smooth.
    pub(super) edge_sharpness: Vec<f64>,
    /// For each vertex its sharpness; empty if all are smooth.
    pub(super) vertex_sharpness: Vec<f64>,
    /// Whether every side has a twin and every vertex at least three faces.
    pub(super) is_plain: bool,
}

impl Polyhedron {
    /// A smooth polyhedron.
    ///
    /// - `faces`: the vertices of each, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// A position that is not finite or beyond 1e150, a face that is none, an edge of more than two faces, two faces that run the same
    /// way along an edge; each with its place.
    pub fn new<F: AsRef<[u32]>>(points: Vec<DVec3>, faces: &[F]) -> Result<Polyhedron, SubdivisionError> {
        let count: usize = faces.iter().map(|face| face.as_ref().len()).sum();
        if count > MOST_CORNERS || points.len() > MOST_CORNERS {
            return Err(SubdivisionError::TooLarge { corners: count.max(points.len()) });
        }
        if let Some(vertex) = points.iter().position(|point| !point.abs().cmple(DVec3::splat(FARTHEST)).all()) {
            return Err(SubdivisionError::NotFinite { vertex });
        }
        let mut corners = Vec::with_capacity(count);
        let mut starts = Vec::with_capacity(faces.len() + 1);
        for (index, face) in faces.iter().enumerate() {
            let face = face.as_ref();
            check_face(index, face, points.len())?;
            starts.push(corners.len() as u32);
            corners.extend_from_slice(face);
        }
        starts.push(count as u32);
        Polyhedron::linked(points, corners, starts)
    }

    /// The polyhedron of the triangles of a mesh; vertices at the same position count as one.
    ///
    /// # Errors
    /// A position that is not finite or beyond 1e150, a vertex that there is not, an edge of more than two triangles, two
    /// triangles that run the same way along an edge; each with its place.
    pub fn from_mesh(mesh: &Mesh) -> Result<Polyhedron, SubdivisionError> {
        let vertices = mesh.vertices.len();
        if let Some((face, triangle)) =
            mesh.triangles.iter().enumerate().find(|(_, t)| t.iter().any(|&v| v as usize >= vertices))
        {
            let vertex = triangle.iter().copied().find(|&v| v as usize >= vertices).unwrap_or_default();
            return Err(SubdivisionError::NoSuchVertex { face, vertex, vertices });
        }
        let same = mesh.first_of_each_position();
        let faces: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(|vertex| same[vertex as usize])).collect();
        Polyhedron::new(mesh.vertices.clone(), &faces)
    }

    /// Finds out which sides meet.
    pub(super) fn linked(
        points: Vec<DVec3>,
        corners: Vec<u32>,
        starts: Vec<u32>,
    ) -> Result<Polyhedron, SubdivisionError> {
        let mut next: Vec<u32> = (1..=corners.len() as u32).collect();
        for face in starts.windows(2) {
            next[face[1] as usize - 1] = face[0];
        }
        let twins = twins(points.len(), &corners, &next, &starts)?;
        let is_plain = is_plain(&next, &twins);
        let (edge_sharpness, vertex_sharpness) = (Vec::new(), Vec::new());
        Ok(Polyhedron { points, corners, starts, next, twins, edge_sharpness, vertex_sharpness, is_plain })
    }

    /// Makes an edge sharp.
    ///
    /// - `sharpness`: for so many steps the edge stays a crease, which halves its rounding with each of them; a fraction
    ///   holds it back in the step after; infinity for ever. Borders are creases for ever by themselves.
    ///
    /// # Errors
    /// No such edge, or a sharpness below zero.
    pub fn sharpen_edge(&mut self, ends: [u32; 2], sharpness: f64) -> Result<(), SubdivisionError> {
        self.sharpen_edges(&[ends], sharpness)
    }

    /// Makes some edges sharp at once.
    ///
    /// - `sharpness`: as of [`Polyhedron::sharpen_edge`].
    ///
    /// # Errors
    /// The first edge that there is not, or a sharpness below zero.
    pub fn sharpen_edges(&mut self, edges: &[[u32; 2]], sharpness: f64) -> Result<(), SubdivisionError> {
        check_sharpness(sharpness)?;
        let named = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let wanted: HashSet<[u32; 2]> = edges.iter().copied().map(named).collect();
        let edge = |h: usize| named([self.corners[h], self.corners[self.next[h] as usize]]);
        let sides: Vec<usize> =
            (0..self.corners.len()).into_par_iter().filter(|&h| wanted.contains(&edge(h))).collect();
        let found: HashSet<[u32; 2]> = sides.iter().map(|&h| edge(h)).collect();
        if let Some(&ends) = edges.iter().find(|ends| !found.contains(&named(**ends))) {
            return Err(SubdivisionError::NoSuchEdge { ends });
        }
        self.edge_sharpness.resize(self.corners.len(), 0.0);
        sides.into_iter().for_each(|side| self.edge_sharpness[side] = sharpness);
        Ok(())
    }

    /// Makes all edges sharp at which the planes of two faces meet at more than `degrees`.
    ///
    /// - `sharpness`: as of [`Polyhedron::sharpen_edge`].
    ///
    /// # Errors
    /// A sharpness below zero.
    pub fn sharpen_creases(&mut self, degrees: f64, sharpness: f64) -> Result<(), SubdivisionError> {
        check_sharpness(sharpness)?;
        let normals: Vec<DVec3> =
            (0..self.face_count()).map(|face| self.area_vector(face).normalize_or_zero()).collect();
        let face_of = self.face_of();
        let is_crease = |h: usize| {
            let twin = self.twins[h];
            let normal = |side: usize| normals[face_of[side] as usize];
            twin != NONE && normal(h).angle_between(normal(twin as usize)).to_degrees() > degrees
        };
        let creases: Vec<usize> = (0..self.corners.len()).into_par_iter().filter(|&h| is_crease(h)).collect();
        self.edge_sharpness.resize(self.corners.len(), 0.0);
        creases.into_iter().for_each(|side| self.edge_sharpness[side] = sharpness);
        Ok(())
    }

    /// Makes a vertex sharp: the surface comes to a point there.
    ///
    /// - `sharpness`: as of [`Polyhedron::sharpen_edge`].
    ///
    /// # Errors
    /// No such vertex, or a sharpness below zero.
    pub fn sharpen_vertex(&mut self, vertex: u32, sharpness: f64) -> Result<(), SubdivisionError> {
        check_sharpness(sharpness)?;
        if vertex as usize >= self.points.len() {
            return Err(SubdivisionError::Unknown { vertex, vertices: self.points.len() });
        }
        self.vertex_sharpness.resize(self.points.len(), 0.0);
        self.vertex_sharpness[vertex as usize] = sharpness;
        Ok(())
    }

    /// The positions of the vertices.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The number of faces.
    pub fn face_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The vertices of each face, counter-clockwise.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|face| &self.corners[face[0] as usize..face[1] as usize])
    }

    /// Whether each edge belongs to two faces.
    pub fn is_closed(&self) -> bool {
        !self.twins.contains(&NONE)
    }

    pub(super) fn is_smooth(&self) -> bool {
        let none = |sharpness: &[f64]| sharpness.iter().all(|&s| s == 0.0);
        self.is_plain && none(&self.edge_sharpness) && none(&self.vertex_sharpness)
    }

    /// The sharpness of a side, infinite for borders.
    pub(super) fn sharpness(&self, side: u32) -> f64 {
        if self.twins[side as usize] == NONE {
            return f64::INFINITY;
        }
        self.edge_sharpness.get(side as usize).copied().unwrap_or(0.0)
    }

    /// The positions of the corners of a face.
    pub(super) fn face_points(&self, face: usize) -> impl Iterator<Item = DVec3> {
        let corners = &self.corners[self.starts[face] as usize..self.starts[face + 1] as usize];
        corners.iter().map(|&corner| self.points[corner as usize])
    }

    /// For each corner its face.
    pub(super) fn face_of(&self) -> Vec<u32> {
        let mut face_of = vec![0; self.corners.len()];
        for (face, ends) in self.starts.windows(2).enumerate() {
            face_of[ends[0] as usize..ends[1] as usize].fill(face as u32);
        }
        face_of
    }

    /// For each corner the one before it in its face.
    pub(super) fn last(&self) -> Vec<u32> {
        let mut last = vec![0; self.corners.len()];
        self.next.iter().enumerate().for_each(|(corner, &next)| last[next as usize] = corner as u32);
        last
    }

    fn area_vector(&self, face: usize) -> DVec3 {
        let points: Vec<DVec3> = self.face_points(face).collect();
        points.windows(2).map(|edge| (edge[0] - points[0]).cross(edge[1] - points[0])).sum()
    }
}

fn check_sharpness(sharpness: f64) -> Result<(), SubdivisionError> {
    if sharpness >= 0.0 { Ok(()) } else { Err(SubdivisionError::Sharpness { sharpness }) }
}

fn check_face(index: usize, face: &[u32], vertices: usize) -> Result<(), SubdivisionError> {
    if face.len() < 3 {
        return Err(SubdivisionError::TooFewCorners { face: index, corners: face.len() });
    }
    let mut previous = face[face.len() - 1];
    for &vertex in face {
        if vertex as usize >= vertices {
            return Err(SubdivisionError::NoSuchVertex { face: index, vertex, vertices });
        }
        if vertex == previous {
            return Err(SubdivisionError::RepeatedVertex { face: index, vertex });
        }
        previous = vertex;
    }
    Ok(())
}

/// For each side its twin. Sides are collected at the lower of their ends and sorted there by the other end.
fn twins(vertices: usize, corners: &[u32], next: &[u32], starts: &[u32]) -> Result<Vec<u32>, SubdivisionError> {
    let ends = |h: u32| {
        let (a, b) = (corners[h as usize], corners[next[h as usize] as usize]);
        [a.min(b), a.max(b)]
    };
    let mut first = vec![0_u32; vertices + 1];
    (0..corners.len() as u32).for_each(|h| first[ends(h)[0] as usize + 1] += 1);
    for vertex in 0..vertices {
        first[vertex + 1] += first[vertex];
    }
    let mut fill = first.clone();
    let mut sides = vec![(0_u32, 0_u32); corners.len()];
    for h in 0..corners.len() as u32 {
        let [low, high] = ends(h);
        sides[fill[low as usize] as usize] = (high, h);
        fill[low as usize] += 1;
    }
    let mut twins = vec![NONE; corners.len()];
    for (low, range) in first.windows(2).enumerate() {
        let at_vertex = &mut sides[range[0] as usize..range[1] as usize];
        at_vertex.sort_unstable();
        for edge in at_vertex.chunk_by(|a, b| a.0 == b.0) {
            let face = |h: u32| starts.partition_point(|&start| start <= h) - 1;
            match *edge {
                [_] => {}
                [(_, g), (_, h)] if corners[g as usize] != corners[h as usize] => {
                    (twins[g as usize], twins[h as usize]) = (h, g);
                }
                [(high, g), (_, h)] => {
                    return Err(SubdivisionError::Orientation { ends: [low as u32, high], faces: [face(g), face(h)] });
                }
                [(high, g), (_, h), ..] => {
                    let (ends, faces) = ([low as u32, high], [face(g), face(h)]);
                    return Err(SubdivisionError::CrowdedEdge { ends, count: edge.len(), faces });
                }
                [] => {}
            }
        }
    }
    Ok(twins)
}

/// Whether every side has a twin and no vertex has only two faces.
fn is_plain(next: &[u32], twins: &[u32]) -> bool {
    // Two steps around a vertex lead back to the start where there are two faces.
    let around = |h: u32| next[twins[h as usize] as usize];
    !twins.contains(&NONE) && (0..twins.len() as u32).into_par_iter().all(|h| around(around(h)) != h)
}
