//! The Utah teapot.

use std::sync::LazyLock;

use glam::DVec3;

use super::{BezierPatch, PatchSet};

static TEAPOT: LazyLock<PatchSet> = LazyLock::new(|| {
    let set = PatchSet::parse(include_str!("../../../data/teapot.bpt"))
        .expect("the embedded teapot is well formed; a test reads it");
    let upright = |point: DVec3| DVec3::new(point.x, point.z, -point.y);
    // The original order of u and v has the outside inside.
    let patches = set.patches.iter().map(|p| BezierPatch::new(p.control().map(|row| row.map(upright))).transposed());
    PatchSet { patches: patches.collect(), parts: set.parts }
});

/// The 32 patches of the Utah teapot: y up, spout towards +x, resting on y = 0, 3.15 high and 6.525 long, outside out.
///
/// # Source
/// See `data/teapot.bpt`, whose z axis becomes the y axis here by a quarter turn about x.
pub fn teapot() -> Vec<BezierPatch> {
    TEAPOT.patches.clone()
}

/// The parts of the teapot in the order of their patches: name and number of patches.
pub fn teapot_parts() -> Vec<(String, usize)> {
    TEAPOT.parts.iter().map(|(name, range)| (name.clone(), range.len())).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::DVec2;

    use super::super::{Surface, Tolerance, tessellate};
    use super::*;
    use crate::numeric::bounds::Bounds;

    #[test]
    fn the_data_has_the_known_parts_and_bounds() {
        let parts = [("rim", 4), ("body", 8), ("handle", 4), ("spout", 4), ("lid", 8), ("bottom", 4)];
        assert_eq!(teapot_parts(), parts.map(|(name, count)| (name.to_owned(), count)));
        let points = teapot().into_iter().flat_map(|patch| patch.control().concat());
        let bounds = Bounds::of(points);
        assert_eq!(bounds.min, DVec3::new(-3.0, 0.0, -2.0));
        assert_eq!(bounds.max, DVec3::new(3.525, 3.15, 2.0));
    }

    #[test]
    fn inner_sides_are_shared_exactly_and_six_loops_are_open() {
        let mut uses: HashMap<[[u64; 3]; 4], usize> = HashMap::new();
        let mut points = 0;
        for patch in teapot() {
            let c = patch.control();
            let column = |j: usize| [c[0][j], c[1][j], c[2][j], c[3][j]];
            for side in [c[0], c[3], column(0), column(3)] {
                if side.iter().all(|point| *point == side[0]) {
                    points += 1;
                    continue;
                }
                let key = side.map(crate::mesh::bits);
                let turned = [key[3], key[2], key[1], key[0]];
                *uses.entry(key.min(turned)).or_default() += 1;
            }
        }
        assert_eq!(points, 8);
        assert_eq!(uses.values().filter(|&&count| count == 2).count(), 52);
        // Rim and lid have loops of four sides, the ends of handle and spout of two.
        assert_eq!(uses.values().filter(|&&count| count == 1).count(), 2 * 4 + 4 * 2);
        assert_eq!(uses.len(), 52 + 16);
    }

    #[test]
    fn normals_point_out_of_body_lid_bottom_handle_and_spout() {
        let mesh = tessellate(&teapot(), Tolerance::new(0.01, 10.0)).unwrap();
        let first =
            |part: &str| teapot_parts().iter().take_while(|(name, _)| name != part).map(|(_, n)| n).sum::<usize>();
        for (part, count) in teapot_parts() {
            let range = first(&part)..first(&part) + count;
            let mut piece = mesh.clone();
            let is_inside = |triangle: &usize| range.contains(&(mesh.surfaces[*triangle] as usize));
            piece.triangles = (0..mesh.triangles.len()).filter(is_inside).map(|t| mesh.triangles[t]).collect();
            piece.corner_normals.clear();
            piece.corner_parameters.clear();
            piece.surfaces.clear();
            let volume = piece.with_holes_filled().signed_volume();
            // The rim alone encloses a thin ring whose fans cancel; it is oriented with the body by its shared sides.
            assert!(part == "rim" || volume > 0.1, "{part}: {volume}");
        }
        assert_eq!(mesh.edge_report().misoriented, 0);
    }

    #[test]
    fn the_tip_of_the_lid_looks_up_and_the_centre_of_the_bottom_down() {
        let patches = teapot();
        for patch in &patches[20..24] {
            assert!((patch.normal(DVec2::new(0.3, 0.0)) - DVec3::Y).length() < 1e-14);
        }
        for patch in &patches[28..32] {
            assert!((patch.normal(DVec2::new(0.7, 0.0)) - DVec3::NEG_Y).length() < 1e-14);
        }
    }

    #[test]
    fn its_six_open_loops_can_be_filled() {
        let pot = tessellate(&teapot(), Tolerance::new(0.02, 20.0)).unwrap();
        let closed = pot.with_holes_filled();
        assert!(closed.is_closed());
        assert_eq!(closed.vertices.len() - pot.vertices.len(), 6);
        // Body, lid, handle and spout: four closed pieces, but the handle touches the body in one vertex.
        assert_eq!(closed.edge_report().euler_characteristic(), 8 - 1);
    }
}
