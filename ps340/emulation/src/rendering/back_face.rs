//! Back-face removal: the edges of the polygons that show their front.

use super::{Facets, Segment};

/// The edges of the faces of a solid whose front is seen, each once. A surface shows both sides: all its edges.
pub fn back_face_removal(facets: &Facets) -> Vec<Segment> {
    let seen = facets.edges.iter().filter(|edge| !facets.solid || facets.faces_of(edge).any(|face| face.toward));
    let segments = seen.map(|edge| {
        let ends = edge.ends.map(|end| facets.points[end as usize].local).map(|p| p.truncate() / p.w);
        Segment { ends, color: facets.color_of(edge) }
    });
    segments.filter(|segment| segment.ends.iter().all(|end| end.is_finite())).collect()
}
