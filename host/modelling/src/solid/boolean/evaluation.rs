//! Evaluates expressions: on a lattice where that must be, freed of self-intersections where rounding made the result
//! cross itself.

use super::collapse::{all_new, collapse};
use super::expression::Expression;
use super::lattice::Lattice;
use super::operand::{Operand, Operands};
use super::overlaps::overlapping;
use super::quads::quad_partners;
use super::result::{CornerTables, Outcome};
use super::simple::{Resolution, resolve, without_self_intersections};
use super::single_evaluation::{Evaluation, evaluate_once};
use crate::mesh::Mesh;
use crate::octree::TriangleBvh;
use crate::solid::SolidError;
use rayon::prelude::*;

/// Evaluates an expression over meshes that bound solids simply.
///
/// # Errors
/// [`SolidError::SelfIntersecting`].
pub fn evaluate(solids: Vec<Operand<'_>>, expression: &Expression) -> Result<Outcome, SolidError> {
    match Lattice::of(solids.iter().map(|solid| solid.mesh)) {
        Some(lattice) => lattice.evaluate(&solids, expression),
        None => evaluate_on_lattice(solids, expression),
    }
}

/// Evaluates an expression over meshes with coordinates that predicates can be exact with.
fn evaluate_on_lattice(solids: Vec<Operand<'_>>, expression: &Expression) -> Result<Outcome, SolidError> {
    let operands = Operands::new(solids, true);
    let Evaluation { outcome, new: made, self_intersects: must_settle, .. } = evaluate_once(&operands, expression);
    let (mut outcome, made) = if must_settle {
        let outcome = without_self_intersections(outcome)?;
        let made = all_new(&operands, &outcome);
        (outcome, made)
    } else {
        (outcome, made)
    };
    collapse(&operands, &mut outcome, &made);
    Ok(outcome)
}

impl Lattice {
    /// The surface of a solid on the lattice, with the triangles of the solid that its triangles are part of.
    fn laid(&self, mesh: &Mesh) -> Result<(Mesh, Vec<u32>), SolidError> {
        let mut laid = Outcome { mesh: mesh.clone(), ..Outcome::default() };
        laid.sources = (0..mesh.triangles.len() as u32).map(|triangle| [0, triangle]).collect();
        if self.lay(&mut laid.mesh) {
            laid.clean();
            let Resolution { mut outcome, is_same, .. } = resolve(&laid.mesh, &overlapping(&laid.mesh))?;
            if !is_same {
                outcome.sources.iter_mut().for_each(|source| *source = laid.sources[source[1] as usize]);
                laid = outcome;
            }
        }
        Ok((laid.mesh, laid.sources.into_iter().map(|[_, triangle]| triangle).collect()))
    }

    /// Evaluates an expression over solids that are put on the lattice.
    ///
    /// # Errors
    /// [`SolidError::SelfIntersecting`].
    pub fn evaluate(&self, solids: &[Operand<'_>], expression: &Expression) -> Result<Outcome, SolidError> {
        let back = |error: SolidError| error.brought_back(self);
        let laid = solids.par_iter().map(|solid| self.laid(solid.mesh).map_err(back));
        let laid: Vec<(Mesh, Vec<u32>)> = laid.collect::<Result<_, _>>()?;
        let filed =
            laid.par_iter().map(|(mesh, _)| (TriangleBvh::new(&mesh.vertices, &mesh.triangles), quad_partners(mesh)));
        let filed: Vec<(TriangleBvh, Vec<u32>)> = filed.collect();
        let operands = laid.iter().zip(&filed).map(|((mesh, _), (sorted, partners))| Operand {
            mesh,
            sorted,
            quad_partners: partners,
            overlaps: &[],
        });
        let mut outcome = evaluate_on_lattice(operands.collect(), expression).map_err(back)?;
        let source = |[operand, triangle]: [u32; 2]| [operand, laid[operand as usize].1[triangle as usize]];
        outcome.sources.iter_mut().for_each(|of| *of = source(*of));
        let meshes: Vec<&Mesh> = solids.iter().map(|solid| solid.mesh).collect();
        CornerTables::of(&meshes).name_surfaces(&mut outcome, &meshes);
        self.bring_back(&mut outcome.mesh);
        Ok(outcome)
    }
}
