//! Whether polygons are the boundary of a solid.

use super::{Facets, RenderingFault};

/// Checks that every edge is traversed once in each direction.
///
/// # Errors
/// [`RenderingFault::NotSolid`] names the edges that are not.
pub fn check(facets: &Facets) -> Result<(), RenderingFault> {
    let mut wrong = facets.edges.iter().filter(|edge| edge.uses != [1, 1]);
    let Some(first) = wrong.next() else { return Ok(()) };
    let first = first.ends.map(|end| facets.points[end as usize].local).map(|p| p.truncate() / p.w);
    Err(RenderingFault::NotSolid { edges: 1 + wrong.count(), first })
}
