//! The faces of all operands that may touch others, and what they have in common.

use super::contact::{CommonPoint, Contact, ConvexFace, PointKey};
use super::operand::Operands;
use super::quads::NONE;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

/// Faces that have a point in common, and what; triangles without an area have none.
pub fn contacts(faces: &CandidateFaces, pairs: &[[u32; 2]]) -> Vec<([u32; 2], Contact)> {
    let contact = |pair: &[u32; 2]| {
        let pair = pair.map(|triangle| faces.of_triangle[triangle as usize]);
        if pair.contains(&NONE) {
            return None;
        }
        let contact = Contact::of(&faces.faces[pair[0] as usize], &faces.faces[pair[1] as usize]);
        (!contact.points.is_empty()).then_some((pair, contact))
    };
    pairs.par_iter().with_min_len(256).filter_map(contact).collect()
}

/// Pairs of triangles whose faces have a point in common.
pub fn touching(operands: &Operands, faces: &CandidateFaces, contacts: &[([u32; 2], Contact)]) -> Vec<[u32; 2]> {
    let mut touching = Vec::with_capacity(contacts.len());
    for (pair, _) in contacts {
        let [one, two] = pair.map(|face| faces.triangles[face as usize]);
        touching.extend(operands.halves(one).flat_map(|a| operands.halves(two).map(move |b| [a, b])));
    }
    touching
}

/// Faces with names.
#[derive(Default)]
pub struct CandidateFaces {
    /// By name.
    pub faces: Vec<ConvexFace>,
    /// The lower triangle of each.
    pub triangles: Vec<u32>,
    /// Face by its lower triangle, or [`NONE`].
    of_triangle: Vec<u32>,
    /// Where the vertices are, by name.
    pub positions: FxHashMap<u32, DVec3>,
    /// The names by location.
    first_at: FxHashMap<[u64; 3], u32>,
    /// Names that several vertices share.
    pub ambiguous: FxHashSet<u32>,
}

impl CandidateFaces {
    /// Adds the faces with these lower triangles; their vertices have the names that the operands give them.
    pub fn add(&mut self, operands: &Operands, triangles: &[u32]) {
        self.of_triangle.resize(operands.triangle_count(), NONE);
        self.faces.reserve(triangles.len() / 8);
        for &triangle in triangles {
            if self.of_triangle[triangle as usize] == NONE
                && let Some(face) = operands.face(self.faces.len() as u32, triangle)
            {
                self.of_triangle[triangle as usize] = face.id;
                self.faces.push(face);
                self.triangles.push(triangle);
            }
        }
    }

    /// Gives vertices at the same place the same name, in the faces that touch and in what they have in common.
    pub fn name(&mut self, contacts: &mut [([u32; 2], Contact)]) {
        let mut is_named = vec![false; self.faces.len()];
        let mut names: FxHashMap<u32, u32> = FxHashMap::default();
        for &face in contacts.iter().flat_map(|(pair, _)| pair) {
            if !std::mem::replace(&mut is_named[face as usize], true) {
                names.extend(self.name_face(face as usize));
            }
        }
        if !names.is_empty() {
            contacts.par_iter_mut().with_min_len(256).for_each(|(_, contact)| contact.rename(&names));
        }
    }

    /// Gives the vertices of a face their names; returns those that changed, with the old name first.
    pub fn name_face(&mut self, face: usize) -> Vec<(u32, u32)> {
        let mut changed = Vec::new();
        let face = &mut self.faces[face];
        for k in 0..face.sides {
            let (vertex, place) = (face.vertices()[k], face.corners()[k]);
            let name = *self.first_at.entry(crate::mesh::bits(place)).or_insert(vertex);
            if name != vertex {
                self.ambiguous.insert(name);
                face.rename(k, name);
                changed.push((vertex, name));
            }
            self.positions.insert(name, place);
        }
        changed
    }

    /// All triangles around the vertices among some points.
    pub fn around<'a>(&self, operands: &Operands, points: impl Iterator<Item = &'a CommonPoint>) -> Vec<u32> {
        let place =
            |point: &CommonPoint| if let PointKey::Vertex(name) = point.key { self.positions.get(&name) } else { None };
        let places: FxHashSet<[u64; 3]> = points.filter_map(place).map(|place| crate::mesh::bits(*place)).collect();
        let is_at =
            |triangle: &u32| operands.corners(*triangle).1.iter().any(|c| places.contains(&crate::mesh::bits(*c)));
        (0..operands.triangle_count() as u32).filter(is_at).collect()
    }
}
