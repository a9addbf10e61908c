//! Filled holes of 3 to 64 sides: exact sides, common tangent planes, no cracks; and what is refused.

use std::f64::consts::TAU;

use super::super::shared_curves::SharedCurves;
use super::super::{Curved, Surface, Tolerance, joint, tessellate, tessellate_adaptively};
use super::*;
use crate::mesh::Mesh;
use crate::numeric::sampling::RandomStream;

/// The greatest angle between normals that counts as none, degrees: 1e-12 of a radian.
const NONE: f64 = 6e-11;

/// A dome with waves.
fn height(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.3 - 0.3 * (x * x + y * y) + 0.05 * (2.0 * x + y).sin())
}

/// Patches around a hole with uneven corners on a dome. Each has the side with the hole as its highest v.
fn ring(count: usize, seed: u64) -> Vec<BezierPatch> {
    let mut stream = RandomStream::new(95, seed);
    let step = 1e-5;
    let mut corner = |k: usize| {
        let angle = (k as f64 + 0.1 * (stream.uniform() - 0.5)) / count as f64 * TAU;
        // Uneven, but convex.
        let far = 1.0 + 0.3 * stream.uniform() / (count * count) as f64;
        let (x, y) = (angle.cos() * far, angle.sin() * far);
        let slope = [height(x + step, y) - height(x - step, y), height(x, y + step) - height(x, y - step)];
        (height(x, y), slope.map(|s| s / (2.0 * step)))
    };
    let corners: Vec<_> = (0..count).map(&mut corner).collect();
    (0..count)
        .map(|k| {
            let ends = [corners[k], corners[(k + 1) % count]];
            let way = ends[1].0 - ends[0].0;
            let in_plane = |slope: [DVec3; 2], d: DVec3| slope[0] * d.x + slope[1] * d.y;
            let outward = |turn: f64| DVec3::new(way.y, -way.x, 0.0) * (1.0 + 0.3 * turn);
            let curve = [
                ends[0].0,
                ends[0].0 + in_plane(ends[0].1, way * 1.1) / 3.0,
                ends[1].0 - in_plane(ends[1].1, way * 0.9) / 3.0,
                ends[1].0,
            ];
            let beyond = |at: DVec3, way: DVec3| at + way / 3.0;
            let inner = [
                beyond(curve[0], in_plane(ends[0].1, outward(stream.uniform()))),
                beyond(curve[1], outward(stream.uniform()) + DVec3::Z * 0.1),
                beyond(curve[2], outward(stream.uniform())),
                beyond(curve[3], in_plane(ends[1].1, outward(stream.uniform()))),
            ];
            let row = |i: usize| {
                let away = inner[i] - curve[i];
                [curve[i] + away * 3.0, curve[i] + away * 2.0, inner[i], curve[i]]
            };
            BezierPatch::new([row(0), row(1), row(2), row(3)])
        })
        .collect()
}

/// The patches of a bicubic B-spline net around a vertex of some valence, without those that touch it: for each sector
/// the one ahead of the first axis, whose lowest u is at the hole, and the one ahead of the second, whose lowest v is.
fn net(valence: usize) -> Vec<[BezierPatch; 2]> {
    // Multiples of 36 of a power of two: all divisions are exact, so that neighbours agree to the bit.
    let exact = |x: f64| (x * 65_536.0).round() * 36.0 / 65_536.0;
    let point = |sector: usize, i: usize, j: usize| {
        let turn = if i + j == 0 { 0.0 } else { j as f64 / (i + j) as f64 };
        let angle = (sector as f64 + turn) / valence as f64 * TAU;
        let radius = 0.35 * i.max(j) as f64;
        height(radius * angle.cos(), radius * angle.sin()).map(exact)
    };
    let bezier = |p: [DVec3; 4]| {
        let [a, b, c, d] = p;
        [(a + b * 4.0 + c) / 6.0, (b * 2.0 + c) / 3.0, (b + c * 2.0) / 3.0, (b + c * 4.0 + d) / 6.0]
    };
    let patch = |at: &dyn Fn(usize, usize) -> DVec3| {
        let rows = [0, 1, 2, 3].map(|a| bezier([0, 1, 2, 3].map(|b| at(a, b))));
        let columns = [0, 1, 2, 3].map(|b| bezier([0, 1, 2, 3].map(|a| rows[a][b])));
        BezierPatch::new([0, 1, 2, 3].map(|a| [0, 1, 2, 3].map(|b| columns[b][a])))
    };
    let pair = |k: usize| {
        let (next, last) = ((k + 1) % valence, (k + valence - 1) % valence);
        let first = |a: usize, b: usize| if b == 0 { point(last, 1, a) } else { point(k, a, b - 1) };
        let second = |a: usize, b: usize| if a == 0 { point(next, b, 1) } else { point(k, a - 1, b) };
        [patch(&first), patch(&second)]
    };
    (0..valence).map(pair).collect()
}

/// The sides of the hole in [`net`], with the patch of each; the first begins at an outer corner.
fn sides_of(net: &[[BezierPatch; 2]]) -> Vec<(BezierPatch, SurfaceSide)> {
    let around = net.iter().flat_map(|[a, b]| [(a.clone(), SurfaceSide::LowU), (b.clone(), SurfaceSide::LowV)]);
    let mut around: Vec<_> = around.collect();
    around.rotate_left(1);
    around
}

fn holes(around: &[(BezierPatch, SurfaceSide)]) -> Vec<HoleSide> {
    around.iter().map(|(patch, side)| HoleSide::of(patch, *side)).collect()
}

fn assert_smooth<A: Curved, B: Curved>(a: &A, b: &B, sides: [SurfaceSide; 2], what: &str) {
    let joint = joint(a, b, sides, 9);
    assert!(joint.gap < 1e-13 && joint.angle < NONE, "{what}: {joint:?}");
}

/// Whether a mesh is open in one loop of so many corners at least, and has no other open edge.
fn assert_open_only_around(mesh: &Mesh, rim: usize) {
    let report = mesh.edge_report();
    assert!(report.boundary >= rim && report.non_manifold == 0 && report.misoriented == 0, "{report:?}");
    assert_eq!(report.euler_characteristic(), 1);
}

#[test]
fn a_patch_of_any_number_of_sides_continues_what_is_around_it() {
    for count in (3..=9).chain([16, 64]) {
        let around = ring(count, count as u64);
        let sides: Vec<HoleSide> = around.iter().map(|patch| HoleSide::of(patch, SurfaceSide::HighV)).collect();
        let sectors = n_sided_patch(&sides).expect("the hole can be filled");
        assert_eq!(sectors.len(), count);
        for (k, sector) in sectors.iter().enumerate() {
            assert_smooth(&around[k], sector, [SurfaceSide::HighV, SurfaceSide::LowV], &format!("rim {k} of {count}"));
            let next = &sectors[(k + 1) % count];
            assert_smooth(sector, next, [SurfaceSide::HighU, SurfaceSide::LowU], &format!("sector {k} of {count}"));
            // The middle has one normal, whichever sector is asked.
            let normals = [0.0, 0.4, 1.0].map(|u| sector.normal(DVec2::new(u, 1.0)));
            assert!(normals.iter().all(|n| n.distance(sectors[0].normal(DVec2::Y)) < 1e-12 && n.z > 0.5));
        }
    }
}

#[test]
fn patches_around_a_vertex_of_any_valence_continue_a_b_spline() {
    for valence in (3..=9).chain([16, 64]) {
        let around = sides_of(&net(valence));
        let patches = patches_around_vertex(&holes(&around)).expect("the hole can be filled");
        assert_eq!(patches.len(), valence);
        for (k, patch) in patches.iter().enumerate() {
            let (own, before) = (&around[2 * k], &around[(2 * k + 2 * valence - 1) % (2 * valence)]);
            assert_smooth(&own.0, patch, [own.1, SurfaceSide::LowV], &format!("rim {k} of {valence}"));
            assert_smooth(&before.0, patch, [before.1, SurfaceSide::LowU], &format!("rim {k} of {valence}, before"));
            let next = &patches[(k + 1) % valence];
            assert_smooth(patch, next, [SurfaceSide::HighU, SurfaceSide::HighV], &format!("spoke {k} of {valence}"));
            assert!(patch.normal(DVec2::ONE).distance(patches[0].normal(DVec2::ONE)) < 1e-12);
        }
    }
}

#[test]
fn derivatives_are_those_of_the_points() {
    fn check<S: Curved>(surface: &S) {
        let step = 1e-4;
        for uv in [DVec2::new(0.3, 0.4), DVec2::new(0.8, 0.15), DVec2::new(0.5, 0.7)] {
            let at = |u: f64, v: f64| surface.point(uv + DVec2::new(u, v) * step);
            let [du, dv] = surface.derivatives(uv);
            let scale = du.length() + dv.length();
            assert!(((at(1.0, 0.0) - at(-1.0, 0.0)) / (2.0 * step)).distance(du) < 1e-5 * scale);
            assert!(((at(0.0, 1.0) - at(0.0, -1.0)) / (2.0 * step)).distance(dv) < 1e-5 * scale);
            let [uu, uv2, vv] = surface.second_derivatives(uv);
            let mixed = at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0);
            let square = step * step;
            assert!((mixed / (4.0 * square)).distance(uv2) < 1e-4 * scale, "{uv}");
            assert!(((at(1.0, 0.0) + at(-1.0, 0.0) - at(0.0, 0.0) * 2.0) / square).distance(uu) < 1e-4 * scale);
            assert!(((at(0.0, 1.0) + at(0.0, -1.0) - at(0.0, 0.0) * 2.0) / square).distance(vv) < 1e-4 * scale);
        }
    }
    let sides: Vec<HoleSide> = ring(5, 3).iter().map(|patch| HoleSide::of(patch, SurfaceSide::HighV)).collect();
    n_sided_patch(&sides).expect("filled").iter().for_each(check);
    patches_around_vertex(&holes(&sides_of(&net(5)))).expect("filled").iter().for_each(check);
}

#[test]
fn filled_holes_are_tessellated_without_cracks() {
    for count in [3, 5, 12] {
        let around = ring(count, 7);
        let sides: Vec<HoleSide> = around.iter().map(|patch| HoleSide::of(patch, SurfaceSide::HighV)).collect();
        let sectors = n_sided_patch(&sides).expect("filled");
        // The patches of a ring do not meet each other, so each has its own rim.
        let borders = SharedCurves::of(&sectors);
        assert_eq!(borders.sides.iter().filter(|sides| sides.iter().any(|side| side.is_point)).count(), count);
        for tolerance in [0.03, 0.003] {
            let tolerance = Tolerance::new(tolerance, 180.0);
            assert_open_only_around(&tessellate(&sectors, tolerance).expect("tessellated"), count);
            assert_open_only_around(&tessellate_adaptively(&sectors, tolerance).expect("tessellated"), count);
        }
    }
    for valence in [3, 5, 8] {
        let net = net(valence);
        let mut all: Vec<Box<dyn Surface>> = Vec::new();
        let patches = patches_around_vertex(&holes(&sides_of(&net))).expect("filled");
        all.extend(patches.into_iter().map(|patch| Box::new(patch) as Box<dyn Surface>));
        all.extend(net.into_iter().flatten().map(|patch| Box::new(patch) as Box<dyn Surface>));
        for tolerance in [1.0, 0.05] {
            let mesh = tessellate(&all, Tolerance::new(tolerance, 180.0)).expect("tessellated");
            assert_open_only_around(&mesh, 2 * valence);
        }
    }
}

#[test]
fn four_patches_around_a_vertex_are_near_the_b_spline_that_was_cut_out() {
    // Valence 4 is regular: there the net has patches of its own.
    let valence = 4;
    let around = sides_of(&net(valence));
    let patches = patches_around_vertex(&holes(&around)).expect("filled");
    let vertex = patches[0].point(DVec2::ONE);
    let top = height(0.0, 0.0) * 36.0;
    assert!(vertex.distance(top) < 0.05 * 36.0, "{vertex} {top}");
    assert!(patches[0].normal(DVec2::ONE).z > 0.9);
}

#[test]
fn what_cannot_be_filled_is_refused_with_the_place() {
    let around = ring(5, 1);
    let sides: Vec<HoleSide> = around.iter().map(|patch| HoleSide::of(patch, SurfaceSide::HighV)).collect();
    assert!(matches!(n_sided_patch(&sides[..2]), Err(HoleError::Count { count: 2, .. })));
    assert!(matches!(patches_around_vertex(&sides), Err(HoleError::Count { count: 5, .. })));
    assert!(matches!(n_sided_patch(&sides[..4]), Err(HoleError::Open { side: 0, .. })));
    let changed = |change: &dyn Fn(&mut Vec<HoleSide>)| {
        let mut sides = sides.clone();
        change(&mut sides);
        n_sided_patch(&sides).map(|_| ()).expect_err("refused")
    };
    assert_eq!(changed(&|sides| sides[3].across[1].y = f64::NAN), HoleError::NonFinite { side: 3 });
    assert_eq!(changed(&|sides| sides[2].across[0] += DVec3::Z * 0.1), HoleError::Corner { side: 2 });
    assert_eq!(changed(&|sides| sides[4].across[3] = DVec3::ZERO), HoleError::Corner { side: 0 });
    assert_eq!(changed(&|sides| sides[1].curve[1] = sides[1].curve[0]), HoleError::Corner { side: 1 });
    assert_eq!(changed(&|sides| sides[1].across.iter_mut().for_each(|a| *a = -*a)), HoleError::Folded { side: 1 });
    // The hole on the right.
    let reversed: Vec<HoleSide> = sides
        .iter()
        .rev()
        .map(|side| {
            let mut side = side.clone();
            side.curve.reverse();
            side.across.reverse();
            HoleSide { across: side.across.map(|a| -a), ..side }
        })
        .collect();
    assert!(matches!(n_sided_patch(&reversed), Err(HoleError::Folded { .. })));
    // All in one point.
    let point = HoleSide { curve: [DVec3::ONE; 4], across: [DVec3::X; 4] };
    assert!(n_sided_patch(&vec![point.clone(); 6]).is_err() && patches_around_vertex(&vec![point; 6]).is_err());
}
