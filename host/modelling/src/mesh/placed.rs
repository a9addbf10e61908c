//! Meshes of a file that are stored once and placed many times.

use super::Grouped;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Most meshes that are stored once; further ones are copied to where they stand.
pub const MOST_REPEATED: usize = u16::MAX as usize;
/// A map flattens if the volume of a unit cube becomes this part of the cube of its longest edge.
const FLAT: f64 = 1e-9;

/// What a file holds: triangles that stand where they are, and meshes that are placed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlacedMeshes {
    /// The triangles of meshes that are placed once, and of copies that a placement flattens, in coordinates of the file.
    pub alone: Grouped,
    /// The other meshes, each in coordinates of its own; at most [`MOST_REPEATED`].
    pub repeated: Vec<RepeatedMesh>,
    /// Where these are.
    pub places: MeshPlaces,
}

/// A mesh that is placed more than once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RepeatedMesh {
    /// What it is called; empty if it has no name.
    pub name: String,
    /// The mesh, in its own coordinates.
    pub grouped: Grouped,
}

/// A mesh at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPlace {
    /// Number of the mesh.
    pub mesh: u32,
    /// From its coordinates to those of the file; not flat.
    pub placement: DAffine3,
}

/// Translation, rotation and scale in single precision, applied from right to left: 40 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceRow {
    /// Position of the origin.
    pub translation: [f32; 3],
    /// A quaternion x, y, z, w of any length but 0.
    pub rotation: [f32; 4],
    /// Factors along the axes.
    pub scale: [f32; 3],
}

/// Where meshes are placed: maps one by one, each in 104 bytes, and batches of rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshPlaces {
    single: Vec<MeshPlace>,
    batches: Vec<PlaceBatch>,
}

/// Places of one mesh below one map.
#[derive(Clone, Debug, PartialEq)]
struct PlaceBatch {
    /// Of all places, the number of its first.
    first: usize,
    mesh: u32,
    to_file: DAffine3,
    rows: Vec<PlaceRow>,
}

impl PlaceRow {
    /// The row that does nothing.
    pub const IDENTITY: PlaceRow = PlaceRow { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };

    /// The map.
    pub fn placement(&self) -> DAffine3 {
        let vector = |of: [f32; 3]| DVec3::from_array(of.map(f64::from));
        let rotation = DQuat::from_array(self.rotation.map(f64::from));
        let unit = rotation * (1.0 / rotation.length());
        DAffine3::from_scale_rotation_translation(vector(self.scale), unit, vector(self.translation))
    }
}

impl MeshPlaces {
    /// Adds a place; it comes before all rows.
    pub fn push(&mut self, place: MeshPlace) {
        self.single.push(place);
        self.batches.iter_mut().for_each(|batch| batch.first += 1);
    }

    /// Adds the places of a mesh by rows below a map.
    pub fn extend(&mut self, mesh: u32, to_file: DAffine3, rows: Vec<PlaceRow>) {
        let first = self.count();
        self.batches.push(PlaceBatch { first, mesh, to_file, rows });
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.batches.last().map_or(self.single.len(), |batch| batch.first + batch.rows.len())
    }

    /// A place by its number.
    ///
    /// # Panics
    /// If there is none of this number.
    pub fn place(&self, number: usize) -> MeshPlace {
        if let Some(place) = self.single.get(number) {
            return *place;
        }
        let PlaceBatch { first, mesh, to_file, rows } =
            &self.batches[self.batches.partition_point(|batch| batch.first <= number) - 1];
        MeshPlace { mesh: *mesh, placement: *to_file * rows[number - first].placement() }
    }

    /// The places below one more map.
    pub fn within(mut self, outer: &DAffine3) -> MeshPlaces {
        self.single.iter_mut().for_each(|place| place.placement = *outer * place.placement);
        self.batches.iter_mut().for_each(|batch| batch.to_file = *outer * batch.to_file);
        self
    }

    /// All places.
    pub fn iter(&self) -> impl Iterator<Item = MeshPlace> + '_ {
        (0..self.count()).map(|number| self.place(number))
    }
}

/// Whether a map leaves nothing of a volume, or so little that its inverse would be of no use.
pub(super) fn is_flat(map: &DMat3) -> bool {
    let longest = map.x_axis.length().max(map.y_axis.length()).max(map.z_axis.length());
    // Divided first, so that no product is too small or too large; what is not a number is flat.
    let [x, y, z] = [map.x_axis, map.y_axis, map.z_axis].map(|axis| axis / longest);
    let is_solid = x.dot(y.cross(z)).abs() > FLAT;
    !is_solid
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_singles_first_and_then_by_batch() {
        let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
        let row = |x: f32| PlaceRow { translation: [x, 0.0, 0.0], ..PlaceRow::IDENTITY };
        let mut places = MeshPlaces::default();
        places.extend(1, at(10.0), vec![row(1.0), row(2.0)]);
        places.push(MeshPlace { mesh: 0, placement: at(5.0) });
        places.extend(2, at(20.0), Vec::new());
        places.extend(3, DAffine3::from_scale(DVec3::splat(2.0)), vec![row(4.0)]);
        let found: Vec<(u32, f64)> = places.iter().map(|place| (place.mesh, place.placement.translation.x)).collect();
        assert_eq!(found, [(0, 5.0), (1, 11.0), (1, 12.0), (3, 8.0)]);
    }

    #[test]
    fn a_map_is_flat_whatever_its_size() {
        for scale in [1e-150, 1.0, 1e150] {
            assert!(!is_flat(&(DMat3::from_diagonal(DVec3::new(1.0, -1e-4, 1e-4)) * scale)));
            assert!(is_flat(&(DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)) * scale)));
        }
        assert!(is_flat(&DMat3::ZERO) && is_flat(&DMat3::from_diagonal(DVec3::splat(f64::NAN))));
    }
}
