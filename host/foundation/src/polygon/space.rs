//! Polygons on a plane in space.

use glam::{DVec2, DVec3};

use super::{PolygonError, Triangulation, TriangulationKind, triangulate};

/// Divides a plane polygon in space into triangles, as [`triangulate`] does.
///
/// The polygon is seen along the axis to which its plane is most nearly square: the coordinates are taken as they are,
/// so that corners on one line stay on it exactly. Corners off the plane move along that axis only.
///
/// - `contours`: corners of each, any unit. The first contour of the greatest area gives the normal.
/// - Returns triangles that run counter-clockwise where that contour does.
///
/// # Errors
/// Those of [`triangulate`].
///
/// # Source
/// The normal after Newell, in Sutherland, Sproull and Schumacker 1974.
pub fn triangulate_in_space<C: AsRef<[DVec3]>>(
    contours: &[C],
    shape: TriangulationKind,
) -> Result<Triangulation, PolygonError> {
    let corners = || contours.iter().flat_map(|contour| contour.as_ref());
    let greatest = corners().fold(0.0, |greatest: f64, corner| greatest.max(corner.abs().max_element()));
    let longest = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
    let vectors = contours.iter().map(|contour| area_vector(contour.as_ref(), greatest));
    let normal = vectors.fold(DVec3::ZERO, longest);
    let size = normal.abs();
    let [along, u, v] = if size.x >= size.y.max(size.z) {
        [0, 1, 2]
    } else if size.y >= size.z {
        [1, 2, 0]
    } else {
        [2, 0, 1]
    };
    let [u, v] = if normal[along] < 0.0 { [v, u] } else { [u, v] };
    let flat: Vec<Vec<DVec2>> =
        contours.iter().map(|contour| contour.as_ref().iter().map(|p| DVec2::new(p[u], p[v])).collect()).collect();
    triangulate(&flat, shape)
}

/// The normal of a contour, as long as its area in units of `unit` squared.
fn area_vector(corners: &[DVec3], unit: f64) -> DVec3 {
    let Some(&first) = corners.first() else { return DVec3::ZERO };
    let from_first = |corner: DVec3| corner / unit - first / unit;
    corners.windows(2).map(|edge| from_first(edge[0]).cross(from_first(edge[1]))).sum::<DVec3>() * 0.5
}
