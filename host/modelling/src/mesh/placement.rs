//! Moving, joining and tidying meshes.

use glam::{DAffine3, DMat3, DVec3};

use super::Mesh;

impl Mesh {
    /// The mesh moved by `placement`. A reflection reverses the triangles, so that outside stays outside.
    pub fn transformed(&self, placement: &DAffine3) -> Mesh {
        let mut mesh = self.clone();
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = placement.transform_point3(*vertex));
        let normals = normal_matrix(placement.matrix3);
        for corners in &mut mesh.corner_normals {
            *corners = corners.map(|normal| (normals * normal).normalize_or_zero());
        }
        if placement.matrix3.determinant() < 0.0 {
            mesh.reverse_corners();
        }
        mesh
    }

    /// The mesh inside out: triangles and normals reversed.
    pub fn reversed(mut self) -> Mesh {
        self.reverse_corners();
        for corners in &mut self.corner_normals {
            *corners = corners.map(|normal| -normal);
        }
        self
    }

    /// Adds the vertices and triangles of `other`. A table per corner survives only if both meshes have it, or one of
    /// them has no triangles; surface indices of `other` are raised by `surface_offset`.
    pub fn append(&mut self, other: &Mesh, surface_offset: u32) {
        let (here, there) = (self.triangles.len(), other.triangles.len());
        let vertex_offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + vertex_offset)));
        join(&mut self.corner_normals, &other.corner_normals, here, there);
        join(&mut self.corner_parameters, &other.corner_parameters, here, there);
        let raised: Vec<u32> = other.surfaces.iter().map(|surface| surface + surface_offset).collect();
        join(&mut self.surfaces, &raised, here, there);
    }

    /// The mesh with one vertex for each position (same bits), in order of first use; unused vertices are dropped.
    pub fn welded(&self) -> Mesh {
        const UNUSED: u32 = u32::MAX;
        let same = self.first_of_each_position();
        let mut new_index = vec![UNUSED; self.vertices.len()];
        let mut vertices = Vec::new();
        let mut renumber = |vertex: u32| {
            let first = same[vertex as usize] as usize;
            if new_index[first] == UNUSED {
                new_index[first] = vertices.len() as u32;
                vertices.push(self.vertices[first]);
            }
            new_index[first]
        };
        let triangles = self.triangles.iter().map(|triangle| triangle.map(&mut renumber)).collect();
        Mesh { vertices, triangles, ..self.clone() }
    }

    fn reverse_corners(&mut self) {
        self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        self.corner_normals.iter_mut().for_each(|corners| corners.swap(1, 2));
        self.corner_parameters.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
}

/// The matrix that carries normals where `matrix` carries points, up to length, for singular matrices too.
///
/// The cofactor matrix, whose columns are cross products of the columns of `matrix`, with the sign of the determinant.
pub fn normal_matrix(matrix: DMat3) -> DMat3 {
    let [x, y, z]: [DVec3; 3] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if matrix.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}

/// Appends a table per triangle, or drops it where one side lacks it.
fn join<T: Clone>(table: &mut Vec<T>, more: &[T], here: usize, there: usize) {
    if table.len() == here && more.len() == there {
        table.extend_from_slice(more);
    } else {
        table.clear();
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DVec3};

    use super::super::samples::tetrahedron;

    #[test]
    fn a_reflection_keeps_the_outside_outside() {
        let mirror = DAffine3::from_scale(DVec3::new(-1.0, 2.0, 1.0));
        let mesh = tetrahedron();
        let image = mesh.transformed(&mirror);
        assert!((image.signed_volume() - 2.0 * mesh.signed_volume()).abs() < 1e-15);
    }

    #[test]
    fn normals_stay_perpendicular_under_shear() {
        let mesh = tetrahedron();
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.7, -1.0, 0.2), DVec3::new(0.1, 0.3, 3.0));
        let before = mesh.face_normal(0).unwrap();
        let image = mesh.transformed(&DAffine3::from_mat3(shear));
        let after = (super::normal_matrix(shear) * before).normalize();
        assert!((after - image.face_normal(0).unwrap()).length() < 1e-14);
    }

    #[test]
    fn a_mesh_appended_to_nothing_is_the_mesh() {
        let mut sum = super::Mesh::default();
        sum.append(&tetrahedron(), 0);
        assert_eq!(sum, tetrahedron());
        sum.append(&tetrahedron(), 0);
        assert_eq!(sum.welded().vertices.len(), 4);
        assert_eq!(sum.welded().triangles.len(), 8);
    }
}
