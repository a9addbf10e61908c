//! The nodes of a glTF file that is written: one for each place of a mesh, or one for all of them.

use glam::{DAffine3, DMat3, DMat4, DQuat};
use serde_json::{Value, json};

use super::super::{Fault, FaultLocation, MeshPlace, MeshPlaces, MeshProblem, PlaceRow};
use super::nodes::INSTANCING;
use crate::memory;

/// So many places of a mesh or fewer are nodes, which every reader knows; more are rows of tables.
pub const MOST_NODES: usize = 10_000;
/// Axes this close to upright to each other are those of a rotation and a scale (cosine of the angle).
const UPRIGHT: f64 = 1e-6;
/// So often the axes of a map are turned to be upright; each time squares what is left.
const TURNS: usize = 12;
/// Bytes of a node while it is written.
const NODE_BYTES: u64 = 1500;

/// Takes tables of numbers.
pub trait Tables {
    /// Adds a table of N columns; returns the number of its accessor.
    fn table<const N: usize>(&mut self, rows: impl ExactSizeIterator<Item = [f32; N]>) -> usize;
}

/// Nodes in the making.
#[derive(Default)]
pub struct WrittenNodes {
    /// All of them.
    pub all: Vec<Value>,
    /// Those of the scene.
    pub roots: Vec<usize>,
    /// Whether one has its mesh by rows.
    pub uses_extension: bool,
}

impl WrittenNodes {
    /// Adds a node of the scene.
    pub fn push(&mut self, node: Value) {
        self.roots.push(self.all.len());
        self.all.push(node);
    }

    /// Adds meshes where they are.
    ///
    /// - `numbers`: for each mesh that number in the file; none of those that have no triangles.
    pub fn place(
        &mut self,
        tables: &mut impl Tables,
        places: &MeshPlaces,
        numbers: &[Option<usize>],
    ) -> Result<(), Fault> {
        let mut counts = vec![0; numbers.len()];
        for (place, MeshPlace { mesh, placement }) in places.iter().enumerate() {
            let count = counts.get_mut(mesh as usize).ok_or_else(|| {
                FaultLocation::Mesh.fault(MeshProblem::Index {
                    index: mesh.into(),
                    count: numbers.len(),
                    table: "meshes",
                })
            })?;
            *count += 1;
            if !DMat4::from(placement).is_finite() {
                return Err(FaultLocation::Mesh.fault(MeshProblem::Row { row: place, what: "a place is not finite" }));
            }
        }
        let is_many = |mesh: u32| counts[mesh as usize] > MOST_NODES;
        let nodes = (0..).zip(&counts).filter(|(mesh, _)| !is_many(*mesh)).map(|(_, count)| *count as u64).sum::<u64>();
        let rows = places.count() as u64 - nodes;
        memory::reserve(nodes * NODE_BYTES + rows * 3 * size_of::<PlaceRow>() as u64, || {
            format!("writing {} places", places.count())
        })
        .map_err(|excess| FaultLocation::Mesh.fault(excess.into()))?;
        let mut rows: Vec<Vec<PlaceRow>> = vec![Vec::new(); numbers.len()];
        for MeshPlace { mesh, placement } in places.iter() {
            let Some(number) = numbers[mesh as usize] else { continue };
            match row_of(&placement).filter(|_| is_many(mesh)) {
                Some(row) => rows[mesh as usize].push(row),
                None => self.put(number, &placement),
            }
        }
        for (rows, number) in rows.iter().zip(numbers).filter(|(rows, _)| !rows.is_empty()) {
            let attributes = json!({
                "TRANSLATION": tables.table(rows.iter().map(|row| row.translation)),
                "ROTATION": tables.table(rows.iter().map(|row| row.rotation)),
                "SCALE": tables.table(rows.iter().map(|row| row.scale)),
            });
            self.push(json!({ "mesh": number, "extensions": { INSTANCING: { "attributes": attributes } } }));
            self.uses_extension = true;
        }
        Ok(())
    }

    /// Adds a mesh at a place: matrices of nodes must be a rotation and a scale, and two of these make any other map.
    fn put(&mut self, mesh: usize, placement: &DAffine3) {
        let matrix = |placement: &DAffine3| json!(DMat4::from(*placement).to_cols_array());
        let inner = upright_axes(&placement.matrix3);
        if inner == DMat3::IDENTITY {
            return self.push(json!({ "mesh": mesh, "matrix": matrix(placement) }));
        }
        let outer = DAffine3 { matrix3: placement.matrix3 * inner, translation: placement.translation };
        let child = self.all.len() + 1;
        self.push(json!({ "matrix": matrix(&outer), "children": [child] }));
        self.all.push(json!({ "mesh": mesh, "matrix": matrix(&DAffine3::from_mat3(inner.transpose())) }));
    }
}

/// A placement as a row in single precision; none for one that is no rotation with a scale along its axes, or too large.
fn row_of(placement: &DAffine3) -> Option<PlaceRow> {
    let map = placement.matrix3;
    if upright_axes(&map) != DMat3::IDENTITY {
        return None;
    }
    let sign = if map.determinant() < 0.0 { -1.0 } else { 1.0 };
    let scale = [sign * map.x_axis.length(), map.y_axis.length(), map.z_axis.length()];
    let [x, y, z] = [map.x_axis / scale[0], map.y_axis / scale[1], map.z_axis / scale[2]];
    let rotation = DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize();
    let row = PlaceRow {
        translation: placement.translation.as_vec3().to_array(),
        rotation: rotation.as_quat().to_array(),
        scale: scale.map(|x| x as f32),
    };
    let is_kept = row.placement().is_finite() && row.scale.iter().all(|x| x.is_normal());
    is_kept.then_some(row)
}

/// A rotation before a map that makes the images of its axes upright to each other; none where they are so already.
///
/// # Source
/// Hestenes 1958: the one-sided method of Jacobi for singular values.
fn upright_axes(map: &DMat3) -> DMat3 {
    let mut rotation = DMat3::IDENTITY;
    for _ in 0..TURNS {
        let mut is_upright = true;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let image = *map * rotation;
            let (a, b) = (image.col(i), image.col(j));
            let (aa, bb, ab) = (a.length_squared(), b.length_squared(), a.dot(b));
            // Written so that what is not a number is upright.
            let is_skew = ab.abs() > UPRIGHT * (aa * bb).sqrt();
            if !is_skew {
                continue;
            }
            is_upright = false;
            let (sine, cosine) = (0.5 * (2.0 * ab).atan2(aa - bb)).sin_cos();
            let (p, q) = (rotation.col(i), rotation.col(j));
            *rotation.col_mut(i) = p * cosine + q * sine;
            *rotation.col_mut(j) = q * cosine - p * sine;
        }
        if is_upright {
            break;
        }
    }
    rotation
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn any_map_is_made_of_two_with_upright_axes() {
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.7, -1.0, 0.2), DVec3::new(0.1, 0.3, 3.0));
        for map in [shear, shear * 1e-9, shear.transpose() * 1e9, DMat3::from_diagonal(DVec3::new(1.0, 2.0, -3.0))] {
            let inner = upright_axes(&map);
            let outer = map * inner;
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b) = (outer.col(i), outer.col(j));
                assert!(a.dot(b).abs() <= 2.0 * UPRIGHT * a.length() * b.length());
            }
            assert!(
                (inner.determinant() - 1.0).abs() < 1e-12
                    && (inner * inner.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12)
            );
            assert_eq!(inner == DMat3::IDENTITY, row_of(&DAffine3::from_mat3(map)).is_some());
        }
    }

    #[test]
    fn rows_keep_mirrors_and_scales() {
        let rotation = DMat3::from_quat(DQuat::from_rotation_y(0.7));
        let matrix3 = rotation * DMat3::from_diagonal(DVec3::new(2.0, -3.0, 0.5));
        let placement = DAffine3 { matrix3, translation: DVec3::new(1.0, 2.0, 3.0) };
        let row = row_of(&placement).expect("upright axes");
        assert!(row.placement().abs_diff_eq(placement, 1e-6), "{row:?}");
        assert!(row_of(&DAffine3::from_scale(DVec3::splat(1e-60))).is_none());
    }
}
