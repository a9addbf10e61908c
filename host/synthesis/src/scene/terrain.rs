//! Terrain: a rectangle of ground whose heights are a fractal, eroded or not.

use super::erosion::Erosion;
use super::fractal_ground::FractalGround;
use super::shape_mesh::ShapeMesh;
use crate::mesh::Mesh;
use crate::procedural::terrain::{HeightField, HeightFunction, TerrainError, TerrainTriangles};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Most triangles of a terrain.
const MOST_TRIANGLES: usize = 1 << 22;
/// Ground around the origin: a height above y = 0 for each x and z of a rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terrain {
    /// What it is before erosion.
    pub fractal: FractalGround,
    /// By what it was eroded, if it was.
    pub erosion: Option<Box<Erosion>>,
    /// With a height, units of length, walls and a flat base at it close the ground to a solid.
    pub base: Option<f64>,
}

impl Terrain {
    /// The height as a function of x and z.
    ///
    /// # Errors
    /// [`TerrainError`] for numbers out of range, or too little memory for erosion.
    pub fn function(&self) -> Result<HeightFunction, TerrainError> {
        self.erosion.as_ref().map_or_else(|| self.fractal.function(), |erosion| erosion.heights(&self.fractal))
    }

    /// The heights over the rectangle.
    ///
    /// # Errors
    /// [`TerrainError`] for a number out of range.
    pub fn field(&self) -> Result<HeightField, TerrainError> {
        HeightField::new(&self.function()?, self.fractal.region())
    }

    /// Length of the diagonal of the rectangle.
    pub(super) fn extent(&self) -> f64 {
        DVec2::from(self.fractal.size).length()
    }

    /// Triangles above or below which the ground is by a chord at the most.
    ///
    /// # Errors
    /// [`TerrainError`] for a number out of range, too many triangles, a base above the ground.
    pub(super) fn tessellate(&self, chord: f64) -> Result<ShapeMesh, TerrainError> {
        // As coarse as may be is a flat square: no chord is coarser than the rectangle.
        let tolerance = chord.min(self.extent());
        let settings = TerrainTriangles { tolerance, footprint: 0.0, most_triangles: MOST_TRIANGLES, base: self.base };
        let mesh = self.field()?.triangles(self.fractal.region(), &settings)?;
        Ok(ShapeMesh { mesh, ..ShapeMesh::default() })
    }

    /// The largest difference in height, where it is measured, between the ground and triangles that stand for it.
    ///
    /// - `steps`: along the sides of a triangle.
    pub(super) fn chord_error(&self, mesh: &Mesh, steps: usize) -> Result<f64, TerrainError> {
        let field = self.field()?;
        let is_wall = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).y <= 0.0;
        let mut largest: f64 = 0.0;
        for triangle in &mesh.triangles {
            let corners = triangle.map(|vertex| mesh.vertices[vertex as usize]);
            if self.base.is_some() && is_wall(corners) {
                continue;
            }
            for k in 0..=steps {
                for l in 0..=steps - k {
                    let [u, v] = [k, l].map(|part| part as f64 / steps as f64);
                    let at = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
                    largest = largest.max((field.height(DVec2::new(at.x, at.z), 0.0) - at.y).abs());
                }
            }
        }
        Ok(largest)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fractal_ground::GroundKind;
    use super::*;
    use crate::procedural::terrain::{FractalKind, FractalParameters};

    fn terrain(kind: FractalKind) -> Terrain {
        let parameters = FractalParameters { octaves: 8.0, scale: 4.0, height: 1.5, ..FractalParameters::default() };
        let fractal = FractalGround { kind: GroundKind::Noise(kind), parameters, size: [10.0, 6.0], warp: 0.0 };
        Terrain { fractal, erosion: None, base: None }
    }

    #[test]
    fn triangles_keep_the_chord_and_cover_the_rectangle() {
        let mut warped = terrain(FractalKind::Fbm);
        warped.fractal.warp = 0.5;
        let solid = Terrain { base: Some(-9.0), ..terrain(FractalKind::Hybrid) };
        for ground in [terrain(FractalKind::Ridged), warped, solid] {
            let mesh = ground.tessellate(0.05).expect("sound").mesh;
            let found = ground.chord_error(&mesh, 4).expect("sound");
            assert!(found <= 0.05 && found > 0.01, "{found}");
            let bounds = mesh.bounds().expect("triangles");
            assert_eq!([bounds.min.x, bounds.max.x, bounds.min.z, bounds.max.z], [-5.0, 5.0, -3.0, 3.0]);
            assert!(ground.base.is_none_or(|_| mesh.signed_volume() > 300.0));
        }
    }

    #[test]
    fn a_warp_bends_what_is_there_and_0_does_not() {
        let at = DVec2::new(1.3, -0.4);
        let height = |warp: f64| {
            let mut ground = terrain(FractalKind::Fbm);
            ground.fractal.warp = warp;
            ground.field().expect("sound").height(at, 0.0)
        };
        assert!(height(0.0) != height(0.5) && (height(0.0) - height(1e-9)).abs() < 1e-7);
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let of = |size, warp| {
            let ground = terrain(FractalKind::Fbm);
            Terrain { fractal: FractalGround { size, warp, ..ground.fractal }, ..ground }
        };
        for wrong in [of([0.0, 1.0], 0.0), of([f64::NAN, 1.0], 0.0), of([1.0, 1.0], f64::NAN), of([1.0, 1.0], 1e300)] {
            assert!(wrong.tessellate(0.1).is_err(), "{wrong:?}");
        }
    }
}
