//! Polyhedra that stand for smooth surfaces: corners, faces, and what of them is sharp.

use crate::numeric::bounds::Bounds;
use crate::subdivision::{Polyhedron, SubdivisionError};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A polyhedral mesh, of which the shape is the limit of corner cutting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cage {
    /// Positions of the vertices.
    pub points: Vec<DVec3>,
    /// The vertices of each face, counter-clockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// What is sharp; later ones hold over those before.
    pub sharpenings: Vec<Sharpening>,
}

/// Makes parts of a polyhedron sharp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sharpening {
    /// The edges or vertices that become sharp.
    pub of: Sharp,
    /// For so many steps they stay sharp; without a number for ever.
    pub steps: Option<f64>,
}

/// Parts of a polyhedron that can be sharp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sharp {
    /// Edges, by their two vertices.
    Edges(Vec<[u32; 2]>),
    /// Vertices.
    Vertices(Vec<u32>),
    /// All edges at which the planes of two faces meet at more than this angle, degrees.
    Creases(f64),
}

impl Cage {
    /// The polyhedron with all that is sharp.
    ///
    /// # Errors
    /// [`SubdivisionError`] with the face, edge or vertex that is wrong.
    pub fn polyhedron(&self) -> Result<Polyhedron, SubdivisionError> {
        let mut polyhedron = Polyhedron::new(self.points.clone(), &self.faces)?;
        for Sharpening { of, steps } in &self.sharpenings {
            let sharpness = steps.unwrap_or(f64::INFINITY);
            match of {
                Sharp::Edges(edges) => edges.iter().try_for_each(|ends| polyhedron.sharpen_edge(*ends, sharpness))?,
                Sharp::Vertices(vertices) => {
                    vertices.iter().try_for_each(|vertex| polyhedron.sharpen_vertex(*vertex, sharpness))?;
                }
                Sharp::Creases(degrees) => polyhedron.sharpen_creases(*degrees, sharpness)?,
            }
        }
        Ok(polyhedron)
    }

    /// The length of the diagonal of a box around the vertices.
    pub fn extent(&self) -> f64 {
        Bounds::of(self.points.iter().copied()).diagonal()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(sharpenings: Vec<Sharpening>) -> Cage {
        let points = (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Cage { points: points.collect(), faces: faces.map(Vec::from).to_vec(), sharpenings }
    }

    fn volume(sharpenings: Vec<Sharpening>) -> f64 {
        cube(sharpenings).polyhedron().unwrap().tessellated(1e-4).unwrap().signed_volume()
    }

    #[test]
    fn the_sharper_a_cube_the_more_of_it_is_left() {
        let creases = |steps| vec![Sharpening { of: Sharp::Creases(30.0), steps }];
        let volumes = [vec![], creases(Some(0.25)), creases(Some(0.5)), creases(Some(0.75)), creases(None)].map(volume);
        assert!(volumes.windows(2).all(|pair| pair[0] < pair[1] - 0.01), "{volumes:?}");
        assert!((volumes[4] - 1.0).abs() < 1e-9, "sharp for ever it stays a cube: {volumes:?}");
        let last = volume([creases(None), creases(Some(0.0))].concat());
        assert!((last - volumes[0]).abs() < 1e-12, "the last holds");
    }

    #[test]
    fn what_is_not_there_is_named() {
        let problem = |of| cube(vec![Sharpening { of, steps: None }]).polyhedron().unwrap_err().to_string();
        assert_eq!(problem(Sharp::Edges(vec![[0, 7]])), "there is no edge from vertex 0 to vertex 7");
        assert_eq!(problem(Sharp::Vertices(vec![8])), "there is no vertex 8, only 8");
    }
}
