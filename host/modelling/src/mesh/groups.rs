//! Names of the surfaces of a mesh: the groups of files.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Mesh;

/// A mesh and what its surfaces are called.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Grouped {
    /// The mesh; its `surfaces` are numbers of groups.
    pub mesh: Mesh,
    /// What the surfaces are called, by their numbers. There may be fewer names than surfaces.
    pub names: Vec<String>,
    /// The materials of the surfaces, by their numbers; none where that is not known. There may be fewer than surfaces.
    pub materials: Vec<Option<MetallicRoughness>>,
}

/// A metallic-roughness material, in the terms of glTF.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MetallicRoughness {
    /// Reflected fraction of red, green and blue, linear, each 0..=1.
    pub base: DVec3,
    /// How far it is a metal, 0..=1.
    pub metallic: f64,
    /// The root of the spread of the slopes of its facets, 0..=1; 1 is matt.
    pub roughness: f64,
}

impl From<Mesh> for Grouped {
    fn from(mesh: Mesh) -> Grouped {
        Grouped { mesh, ..Grouped::default() }
    }
}

/// Whether a mesh falls into groups that a file should tell.
pub(super) fn has_groups(mesh: &Mesh, names: &[String]) -> bool {
    let first = mesh.surfaces.first();
    !mesh.surfaces.is_empty() && (!names.is_empty() || mesh.surfaces.iter().any(|surface| Some(surface) != first))
}

/// What a surface is called, on one line.
pub(super) fn name_of(names: &[String], surface: u32) -> String {
    match names.get(surface as usize).filter(|name| !name.trim().is_empty()) {
        Some(name) => name.split_whitespace().collect::<Vec<_>>().join(" "),
        None => format!("surface {surface}"),
    }
}

/// The group of each triangle while a file is read: groups by name, in order of their first triangle.
#[derive(Default)]
pub(super) struct Groups {
    names: Vec<String>,
    materials: Vec<Option<MetallicRoughness>>,
    number_of: std::collections::HashMap<String, u32>,
    of_triangles: Vec<u32>,
}

impl Groups {
    /// Notes that the triangles from the last noted one up to `count` are of the group `name`, which has that material
    /// if it is new.
    pub fn extend(&mut self, name: &str, look: Option<MetallicRoughness>, count: usize) {
        if count <= self.of_triangles.len() {
            return;
        }
        let number = self.number_of.get(name).copied().unwrap_or_else(|| {
            self.number_of.insert(name.to_owned(), self.names.len() as u32);
            self.names.push(name.to_owned());
            self.materials.push(look);
            self.names.len() as u32 - 1
        });
        self.of_triangles.resize(count, number);
    }

    /// Puts the groups on a mesh; one group without a name is none.
    pub fn on(self, mut mesh: Mesh) -> Grouped {
        if self.names.iter().all(String::is_empty) && self.materials.iter().all(Option::is_none) {
            return Grouped::from(mesh);
        }
        mesh.surfaces = self.of_triangles;
        Grouped { mesh, names: self.names, materials: self.materials }
    }
}
