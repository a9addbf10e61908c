//! The outline of a smooth surface, smooth itself: where the normals, not the triangles, turn away from the viewer.

use super::Mesh;
use super::edges::{EdgeSelection, EdgeTable, Viewer};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Lines through triangles, whose ends are points of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SmoothOutline {
    /// The points; all lie on edges of the mesh.
    pub(super) points: Vec<DVec3>,
    /// Pairs of points, and the triangle that each line goes through.
    pub(super) lines: Vec<([u32; 2], u32)>,
}

impl EdgeTable {
    /// Outlines within smooth parts.
    pub(super) fn smooth_outline(&self, mesh: &Mesh, selection: &EdgeSelection) -> SmoothOutline {
        selection.outline.map_or_else(SmoothOutline::default, |eye| smooth_outline(self, mesh, eye))
    }
}

/// The lines in which normals are at right angles to the direction to the viewer, linear between the corners of each
/// triangle.
///
/// Where triangles are joined smoothly they continue each other.
///
/// # Source
/// Hertzmann and Zorin 2000, illustrating smooth surfaces.
fn smooth_outline(table: &EdgeTable, mesh: &Mesh, eye: Viewer) -> SmoothOutline {
    let mut contour = SmoothOutline::default();
    let mut known: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    for (triangle, normals) in mesh.corner_normals.iter().enumerate() {
        if table.is_collapsed(mesh, triangle) {
            continue;
        }
        let corners = mesh.corners(triangle);
        let Some(face) = mesh.face_normal(triangle) else { continue };
        let facing: [f64; 3] = std::array::from_fn(|k| {
            let normal = if normals[k] == DVec3::ZERO { face } else { normals[k] };
            normal.dot(match eye {
                Viewer::Point(eye) => eye - corners[k],
                Viewer::Direction(eye) => eye,
            })
        });
        let ids = mesh.triangles[triangle].map(|vertex| table.same[vertex as usize]);
        let mut ends = [None; 2];
        for k in 0..3 {
            let (a, b) = (k, (k + 1) % 3);
            if (facing[a] < 0.0) == (facing[b] < 0.0) {
                continue;
            }
            // The same point from either triangle.
            let (low, high) = if ids[a] < ids[b] { (a, b) } else { (b, a) };
            let point = *known.entry([ids[low], ids[high]]).or_insert_with(|| {
                let part = facing[low] / (facing[low] - facing[high]);
                contour.points.push(corners[low].lerp(corners[high], part));
                contour.points.len() as u32 - 1
            });
            if ends[0].is_none() { ends[0] = Some(point) } else { ends[1] = Some(point) }
        }
        if let [Some(from), Some(to)] = ends
            && contour.points[from as usize] != contour.points[to as usize]
        {
            contour.lines.push(([from, to], triangle as u32));
        }
    }
    contour
}

#[cfg(test)]
mod tests {
    use super::super::polylines;
    use super::super::samples;
    use super::*;

    #[test]
    fn the_outline_of_a_ball_with_normals_is_one_smooth_circle() {
        let mut mesh = samples::ball(64, 32);
        mesh.corner_normals = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(DVec3::normalize)).collect();
        let towards = DVec3::new(0.3, 0.5, 0.8).normalize();
        for (eye, height) in [(Viewer::Direction(towards), 0.0), (Viewer::Point(towards * 4.0), 0.25)] {
            let selection = EdgeSelection { outline: Some(eye), ..EdgeSelection::creases(180.0) };
            let runs = polylines(&mesh, &selection);
            assert_eq!(runs.starts.len(), 1);
            assert_eq!(runs.points.first(), runs.points.last());
            // Triangles follow the ball within 0.005; their edges alone would stray by 0.1.
            assert!(runs.points.iter().all(|p| (p.dot(towards) - height).abs() < 0.005));
            let turns = runs.points.windows(3).map(|p| (p[1] - p[0]).angle_between(p[2] - p[1]));
            assert!(turns.fold(0.0, f64::max) < 0.5, "no zigzag");
        }
    }

    /// A cylinder about y, radius 1, height 2, with the normals of its three surfaces.
    fn cylinder(steps: u32) -> Mesh {
        let mut mesh = Mesh::default();
        let rim = |k: u32, y: f64| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k % steps) / f64::from(steps)).sin_cos();
            DVec3::new(sin, y, cos)
        };
        let mut push = |corners: [DVec3; 3], normals: [DVec3; 3]| {
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(corners);
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.corner_normals.push(normals);
        };
        let outwards = |p: DVec3| DVec3::new(p.x, 0.0, p.z);
        for k in 0..steps {
            let [a, b, c, d] = [rim(k, -1.0), rim(k + 1, -1.0), rim(k + 1, 1.0), rim(k, 1.0)];
            push([a, b, c], [a, b, c].map(outwards));
            push([a, c, d], [a, c, d].map(outwards));
            push([d, c, DVec3::Y], [DVec3::Y; 3]);
            push([b, a, DVec3::NEG_Y], [DVec3::NEG_Y; 3]);
        }
        mesh
    }

    #[test]
    fn the_outline_of_a_cylinder_goes_along_its_side_and_its_sharp_edges() {
        let selection = |eye| EdgeSelection { outline: Some(eye), boundary: false, ..EdgeSelection::creases(180.0) };
        let length = |eye| {
            let runs = polylines(&cylinder(200), &selection(eye));
            runs.runs().flat_map(|run| run.windows(2)).map(|pair| pair[0].distance(pair[1])).sum::<f64>()
        };
        // From above the upper rim; from aside two lines of 2 and a half of each rim.
        let above = length(Viewer::Point(DVec3::Y * 9.0));
        assert!((above - std::f64::consts::TAU).abs() < 0.01, "{above}");
        let aside = length(Viewer::Direction(DVec3::new(0.3, 0.0, 0.9)));
        assert!((aside - 4.0 - std::f64::consts::TAU).abs() < 0.05, "{aside}");
    }
}
