//! Triangulations are proved: all triangles positive, their common boundary the polygon, their area its area.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::numeric::predicates::{in_circle, turn};
use crate::numeric::sampling::RandomStream;

type Contour = Vec<DVec2>;

/// Twice the signed area, exact for whole coordinates.
fn twice_area(corners: &[DVec2]) -> f64 {
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    ends.map(|(a, b)| (*a - corners[0]).perp_dot(*b - corners[0])).sum()
}

/// Triangulates and proves: every triangle turns counter-clockwise; every edge is used once each way, or once in all,
/// and these latter are `edges` edges on the contours; the areas add up to `area`, the polygon's, to rounding.
fn proved(contours: &[Contour], area: f64, edges: usize, shape: TriangulationKind) -> Triangulation {
    let result = triangulate(contours, shape).unwrap();
    let corners: Vec<DVec2> = contours.concat();
    let at = |corner: u32| corners[corner as usize];
    let mut sides = HashSet::new();
    let mut sum = 0.0;
    for triangle in &result.triangles {
        let [a, b, c] = triangle.map(at);
        assert!(turn(a, b, c) > 0.0, "{triangle:?} is not counter-clockwise");
        sum += (b - a).perp_dot(c - a) * 0.5;
        for k in 0..3 {
            assert!(sides.insert([triangle[k], triangle[(k + 1) % 3]]), "{triangle:?} shares a side");
        }
    }
    assert!((sum - area).abs() <= 1e-9 * area, "area {sum} is not {area}");
    let border: Vec<_> = sides.iter().filter(|[a, b]| !sides.contains(&[*b, *a])).collect();
    assert_eq!(border.len(), edges, "edges of one triangle");
    let mut on_contours = HashSet::new();
    let mut first = 0;
    let bits = |p: DVec2| [p.x.to_bits(), p.y.to_bits()];
    for contour in contours {
        for k in 0..contour.len() {
            on_contours.insert([bits(contour[k]), bits(contour[(k + 1) % contour.len()])]);
        }
        first += contour.len();
    }
    assert_eq!(first, corners.len());
    if result.dropped == 0 {
        let is_edge = |[a, b]: &&[u32; 2]| {
            let [a, b] = [bits(at(*a)), bits(at(*b))];
            on_contours.contains(&[a, b]) || on_contours.contains(&[b, a])
        };
        // Edges that another contour touches are divided; no more than those are strange.
        let strange = border.iter().filter(|edge| !is_edge(edge)).count();
        assert!(strange <= 2 * edges.saturating_sub(corners.len()), "{strange} edges are not of the polygon");
    }
    result
}

/// A polygon whose contours do not touch, without useless corners, and with `holes` holes.
fn plain(contours: &[Contour], area: f64, holes: usize) -> Triangulation {
    let corners = contours.iter().map(Vec::len).sum::<usize>();
    for shape in [TriangulationKind::Delaunay, TriangulationKind::Any] {
        let result = proved(contours, area, corners, shape);
        assert_eq!(result.triangles.len(), corners + 2 * holes - 2 * (contours.len() - holes));
        assert_eq!(result.dropped, 0);
        if shape == TriangulationKind::Delaunay {
            assert_delaunay(contours, &result.triangles);
        }
    }
    triangulate(contours, TriangulationKind::Any).unwrap()
}

fn assert_delaunay(contours: &[Contour], triangles: &[[u32; 3]]) {
    let corners = contours.concat();
    let mut apexes = HashMap::new();
    for &[a, b, c] in triangles {
        apexes.extend([([a, b], c), ([b, c], a), ([c, a], b)]);
    }
    for (&[a, b], &c) in &apexes {
        if let Some(&d) = apexes.get(&[b, a]) {
            let [a, b, c, d] = [a, b, c, d].map(|corner| corners[corner as usize]);
            assert!(in_circle(a, b, c, d) <= 0.0, "the edge {a} {b} wants to be flipped");
        }
    }
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Contour {
    [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(i, j)| DVec2::new(x + i * width, y + j * height)).to_vec()
}

fn contour(points: &[(f64, f64)]) -> Contour {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn star(corners: usize, seed: u64) -> Contour {
    let mut random = RandomStream::new(seed, 0);
    let arm = |k| DVec2::from_angle(TAU * f64::from(k) / corners as f64) * (0.1 + 0.9 * random.uniform());
    (0..corners as u32).map(arm).collect()
}

fn circle(center: DVec2, radius: f64, corners: u32) -> Contour {
    (0..corners).map(|k| center + DVec2::from_angle(TAU * f64::from(k) / f64::from(corners)) * radius).collect()
}

fn area_of(contours: &[Contour]) -> f64 {
    // The first is outside, the others are holes.
    let areas = contours.iter().map(|contour| twice_area(contour).abs() * 0.5);
    areas.enumerate().map(|(k, area)| if k == 0 { area } else { -area }).sum()
}

fn check_simple(contour: Contour) {
    let area = area_of(std::slice::from_ref(&contour));
    let backwards: Contour = contour.iter().rev().copied().collect();
    let forwards = plain(&[contour], area, 0);
    assert_eq!(plain(&[backwards], area, 0).triangles.len(), forwards.triangles.len());
}

#[test]
fn a_triangle_is_itself_and_no_contours_are_nothing() {
    let triangle = contour(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]);
    let mut found = plain(&[triangle], 0.5, 0).triangles[0];
    found.sort();
    assert_eq!(found, [0, 1, 2]);
    assert_eq!(triangulate::<Contour>(&[], TriangulationKind::Any).unwrap(), Triangulation::default());
}

#[test]
fn stars_spirals_and_combs_have_two_triangles_less_than_corners() {
    for (corners, seed) in [(3, 1), (4, 2), (5, 3), (17, 4), (100, 5), (1000, 6), (10_000, 7)] {
        check_simple(star(corners, seed));
    }
    let arm = |k: u32, width: f64| DVec2::from_angle(f64::from(k) * 0.1) * (f64::from(k) * 0.01 + width);
    let mut spiral: Contour = (1..2000).map(|k| arm(k, 0.3)).collect();
    spiral.extend((1..2000).rev().map(|k| arm(k, 0.0)));
    check_simple(spiral);
    for tall in [false, true] {
        let mut comb = contour(&[(0.0, -1.0), (2001.0, -1.0)]);
        comb.extend((0..2000).rev().map(|k| DVec2::new(f64::from(k) + 0.5 * f64::from(k % 2), f64::from(k % 2 * 100))));
        check_simple(if tall { comb.iter().map(|p| DVec2::new(p.y, p.x)).collect() } else { comb });
    }
}

#[test]
fn plates_have_two_triangles_more_for_each_hole() {
    let mut contours = vec![rectangle(0.0, 0.0, 30.0, 30.0)];
    for k in 0..900 {
        contours.push(circle(DVec2::new(f64::from(k % 30) + 0.5, f64::from(k / 30) + 0.5), 0.4, 3 + k % 30));
    }
    plain(&contours, area_of(&contours), 900);
}

#[test]
fn islands_in_holes_and_separate_outlines_are_found_by_counting() {
    let nested: Vec<Contour> = (0..6)
        .map(|k| rectangle(f64::from(k), f64::from(k), f64::from(20 - 2 * k), f64::from(12 - 2 * k) - 0.5))
        .collect();
    let area: f64 =
        nested.iter().enumerate().map(|(k, c)| twice_area(c) * 0.5 * if k % 2 == 0 { 1.0 } else { -1.0 }).sum();
    plain(&nested, area, 3);
    let apart = [rectangle(0.0, 0.0, 1.0, 1.0), rectangle(5.0, 0.5, 1.0, 1.0)];
    assert_eq!(plain(&apart, 2.0, 0).triangles.len(), 4);
}

#[test]
fn corners_that_touch_save_two_triangles() {
    let square = rectangle(0.0, 0.0, 4.0, 4.0);
    let touching_corner = contour(&[(0.0, 0.0), (2.0, 1.0), (1.0, 2.0)]);
    let result = proved(&[square.clone(), touching_corner], 16.0 - 1.5, 7, TriangulationKind::Any);
    assert_eq!(result.triangles.len(), 7 + 2 - 2 - 2);
    // Two holes that touch each other save two; a ring of three of them cuts an island off: once more as many.
    let first = contour(&[(1.0, 1.0), (2.0, 2.0), (1.0, 3.0)]);
    let second = contour(&[(2.0, 2.0), (3.0, 1.0), (3.0, 3.0)]);
    let result = proved(&[square, first, second], 16.0 - 2.0, 10, TriangulationKind::Delaunay);
    assert_eq!(result.triangles.len(), 10 + 4 - 2 - 2);
    // Chess fields: many outlines that touch in all corners.
    let fields: Vec<Contour> = (0..64)
        .filter(|k| (k % 8 + k / 8) % 2 == 0)
        .map(|k| rectangle(f64::from(k % 8), f64::from(k / 8), 1.0, 1.0))
        .collect();
    assert_eq!(proved(&fields, 32.0, 128, TriangulationKind::Any).triangles.len(), 64);
}

#[test]
fn a_contour_may_touch_itself() {
    // A bow tie whose middle is a corner of both ways, and a hole reached by a contour that pinches itself.
    let bow = contour(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (2.0, 2.0), (1.0, 1.0), (0.0, 2.0)]);
    assert_eq!(proved(&[bow], 2.0, 6, TriangulationKind::Any).triangles.len(), 2);
    let pinched =
        contour(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 2.0), (3.0, 1.0), (1.0, 1.0), (2.0, 2.0), (0.0, 4.0)]);
    proved(&[pinched], 12.0 - 1.0, 8, TriangulationKind::Any);
}

#[test]
fn a_corner_that_touches_an_edge_divides_it() {
    let square = rectangle(0.0, 0.0, 4.0, 4.0);
    for hole in [
        [(0.0, 2.0), (2.0, 1.0), (2.0, 3.0)],
        [(2.0, 4.0), (1.0, 2.0), (3.0, 2.0)],
        [(4.0, 2.0), (2.0, 1.0), (2.0, 3.0)],
    ] {
        let result = proved(&[square.clone(), contour(&hole)], 14.0, 8, TriangulationKind::Any);
        assert_eq!(result.triangles.len(), 8 + 2 - 2 - 2);
    }
    // Touched at the side by an outline that lies outside.
    let result = proved(&[square, contour(&[(4.0, 2.0), (6.0, 1.0), (6.0, 3.0)])], 18.0, 8, TriangulationKind::Any);
    assert_eq!(result.triangles.len(), 3 + 1);
}

#[test]
fn a_thousand_holes_may_meet_in_one_point() {
    let mut contours = vec![circle(DVec2::ZERO, 10.0, 8)];
    for k in 0..1000_u32 {
        let angle = |t: f64| DVec2::from_angle(TAU * (f64::from(k) + t) / 1000.0);
        contours.push(vec![DVec2::ZERO, angle(0.2) * 5.0, angle(0.6) * 7.0]);
    }
    let result = proved(&contours, area_of(&contours), 3008, TriangulationKind::Any);
    assert_eq!(result.triangles.len(), 3008 + 2000 - 2 - 2 * 999);
}

#[test]
fn useless_corners_are_dropped() {
    let square = contour(&[
        (0.0, 0.0),
        (0.0, 0.0),
        (1.0, 0.0),
        (1.5, 0.0),
        (2.0, 0.0),
        (2.0, 1.0),
        (2.0, 2.0),
        (1.0, 2.0),
        (0.0, 2.0),
        (0.0, 0.5),
        (0.0, 0.0),
    ]);
    let result = proved(&[square], 4.0, 4, TriangulationKind::Any);
    assert_eq!((result.triangles.len(), result.dropped), (2, 7));
}

#[test]
fn nearly_straight_corners_are_kept_and_covered() {
    for wiggle in [1e-12, 1e-15, 1e-18, 1e-30, 1e-100] {
        let mut strip: Contour = (0..200).map(|k| DVec2::new(f64::from(k), wiggle * f64::from(k * k % 7))).collect();
        strip.extend((0..200).rev().map(|k| DVec2::new(f64::from(k), wiggle * (f64::from(k * k % 5) + 8.0))));
        let corners: Vec<DVec2> = strip.clone();
        let result = triangulate(&[strip], TriangulationKind::Delaunay).unwrap();
        assert_eq!(result.triangles.len(), 400 - result.dropped - 2);
        assert!(result.triangles.iter().all(|t| {
            let [a, b, c] = t.map(|corner| corners[corner as usize] * DVec2::new(1.0, 1.0 / wiggle));
            turn(a, b, c) > -1e-9
        }));
    }
    let thin = contour(&[(0.0, 0.0), (1.0, 1.0), (1.0 + f64::EPSILON, 1.0), (0.5, 0.5 - 1e-16)]);
    check_simple(thin);
}

#[test]
fn size_and_distance_do_not_matter() {
    let shape = star(500, 9);
    let expected = triangulate(&[&shape], TriangulationKind::Delaunay).unwrap();
    for exponent in [-1000, -500, 500, 1000] {
        let scaled: Contour = shape.iter().map(|p| *p * 2.0_f64.powi(exponent)).collect();
        assert_eq!(triangulate(&[scaled], TriangulationKind::Delaunay).unwrap(), expected);
    }
    check_simple(shape.iter().map(|p| (*p * 4096.0).round() + 1e12).collect::<Vec<_>>());
    let subnormal = contour(&[(0.0, 0.0), (5e-324, 0.0), (0.0, 5e-324)]);
    assert_eq!(triangulate(&[subnormal], TriangulationKind::Any).unwrap().triangles.len(), 1);
    let huge = contour(&[(-f64::MAX, 0.0), (f64::MAX, -f64::MAX), (0.0, f64::MAX)]);
    assert_eq!(triangulate(&[huge], TriangulationKind::Delaunay).unwrap().triangles.len(), 1);
    let mixed = |size: f64, tiny: f64| contour(&[(0.0, 0.0), (size, 0.0), (size, tiny), (tiny, tiny), (0.0, size)]);
    assert_eq!(triangulate(&[mixed(1e20, 1e-100)], TriangulationKind::Delaunay).unwrap().triangles.len(), 3);
    // Too small beside the greatest to be told from zero.
    let error = triangulate(&[mixed(1e300, 1e-300)], TriangulationKind::Delaunay).unwrap_err();
    assert_eq!(error, PolygonError::Overlap { first: edge(0, 0), second: edge(0, 1) });
}

fn edge(contour: usize, corner: usize) -> PolygonEdge {
    PolygonEdge { contour, corner }
}

#[test]
fn bad_polygons_are_refused_with_the_place() {
    let refused = |contours: &[Contour]| triangulate(contours, TriangulationKind::Any).unwrap_err();
    let square = rectangle(0.0, 0.0, 4.0, 4.0);
    let bow = contour(&[(1.0, 1.0), (3.0, 3.0), (3.0, 1.0), (1.0, 3.0)]);
    assert_eq!(refused(&[square.clone(), bow]), PolygonError::Crossing { first: edge(1, 0), second: edge(1, 2) });
    let across = contour(&[(3.0, 1.0), (5.0, 2.0), (3.0, 3.0)]);
    let error = refused(&[square.clone(), across]);
    assert!(
        matches!(error, PolygonError::Crossing { first, second } if first == edge(0, 1) && second.contour == 1),
        "{error}"
    );
    let along = contour(&[(1.0, 0.0), (2.0, 0.0), (2.0, 1.0)]);
    assert_eq!(refused(&[square.clone(), along]), PolygonError::Overlap { first: edge(0, 0), second: edge(1, 0) });
    assert!(matches!(refused(&[square.clone(), square.clone()]), PolygonError::Overlap { .. }));
    let spike = contour(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
    assert_eq!(refused(&[spike]), PolygonError::Overlap { first: edge(0, 0), second: edge(0, 1) });
    let line = contour(&[(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)]);
    assert_eq!(refused(&[square.clone(), line]), PolygonError::NoArea { contour: 1 });
    let two = contour(&[(0.0, 0.0), (1.0, 1.0), (1.0, 1.0)]);
    assert_eq!(refused(&[square.clone(), two]), PolygonError::TooFewCorners { contour: 1, corners: 2 });
    assert_eq!(refused(&[vec![]]), PolygonError::TooFewCorners { contour: 0, corners: 0 });
    let mut bad = square.clone();
    bad[2].y = f64::NAN;
    assert_eq!(refused(&[square, bad]), PolygonError::NotFinite { contour: 1, corner: 2 });
}

/// Whether two edges share a point that is not an end of both, by brute force.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let opposite = |x: f64, y: f64| x < 0.0 && y > 0.0 || x > 0.0 && y < 0.0;
    opposite(turn(a, b, c), turn(a, b, d)) && opposite(turn(c, d, a), turn(c, d, b))
}

#[test]
fn a_reported_crossing_is_one_and_none_is_missed() {
    let mut random = RandomStream::new(11, 0);
    let mut counts = [0; 2];
    for round in 0..3000 {
        let corners = 3 + round % 12;
        let random_contour: Contour = (0..corners).map(|_| DVec2::from_array(random.point())).collect();
        let ends = |k: usize| [random_contour[k], random_contour[(k + 1) % corners]];
        let any = (0..corners).any(|i| (0..i).any(|j| cross(ends(i), ends(j))));
        counts[usize::from(any)] += 1;
        match triangulate(&[&random_contour], TriangulationKind::Any) {
            Ok(_) => assert!(!any, "a crossing was missed: {random_contour:?}"),
            Err(PolygonError::Crossing { first, second }) => assert!(cross(ends(first.corner), ends(second.corner))),
            Err(error) => panic!("{error}"),
        }
    }
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

#[test]
fn whole_coordinates_give_right_areas_or_a_refusal() {
    // Few places: touching, overlapping and crossing in all ways.
    let mut random = RandomStream::new(12, 0);
    let mut accepted = 0;
    for round in 0..20_000 {
        let contours: Vec<Contour> = (0..1 + round % 3)
            .map(|_| (0..3 + round % 5).map(|_| DVec2::new(random.below(6) as f64, random.below(6) as f64)).collect())
            .collect();
        if let Ok(result) = triangulate(&contours, TriangulationKind::Delaunay) {
            accepted += 1;
            let corners = contours.concat();
            let mut boundary: HashMap<[[i64; 2]; 2], i32> = HashMap::new();
            let key = |p: DVec2| [p.x as i64, p.y as i64];
            for triangle in &result.triangles {
                let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
                assert!(turn(a, b, c) > 0.0);
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    *boundary.entry([key(from), key(to)]).or_default() += 1;
                }
            }
            // Every point of a fine grid off all lines: covered once if inside, by counting crossings, else not at all.
            for k in 0..100 {
                let point = DVec2::new(f64::from(k % 10) * 0.6 + 0.31415, f64::from(k / 10) * 0.6 + 0.1618);
                let inside = contours.iter().map(|contour| crossings(contour, point)).sum::<usize>() % 2;
                let covering = result.triangles.iter().filter(|t| {
                    let t = t.map(|corner| corners[corner as usize]);
                    (0..3).all(|k| turn(t[k], t[(k + 1) % 3], point) > 0.0)
                });
                assert_eq!(covering.count(), inside, "{contours:?} at {point}");
            }
            assert!(boundary.values().all(|&count| count == 1));
        }
    }
    assert!(accepted > 1000, "{accepted}");
}

/// How many edges a ray to the right crosses.
fn crossings(contour: &[DVec2], point: DVec2) -> usize {
    let ends = contour.iter().zip(contour.iter().cycle().skip(1));
    ends.filter(|(a, b)| (a.y > point.y) != (b.y > point.y) && (turn(**a, **b, point) > 0.0) == (b.y > a.y)).count()
}

#[test]
fn a_polygon_in_space_keeps_the_side_of_its_normal() {
    let flat = [rectangle(0.0, 0.0, 4.0, 4.0), rectangle(1.0, 1.0, 1.0, 1.0).into_iter().rev().collect()];
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    for k in 0..6 {
        let (u, v) = (axes[k % 3], axes[(k + 1 + k / 3) % 3] + axes[(k + 2 - k / 3) % 3] * 0.25);
        let place = |p: &DVec2| DVec3::splat(7.0) + u * p.x + v * p.y;
        let placed: Vec<Vec<DVec3>> = flat.iter().map(|contour| contour.iter().map(place).collect()).collect();
        let result = triangulate_in_space(&placed, TriangulationKind::Delaunay).unwrap();
        assert_eq!(result.triangles.len(), 8);
        let corners = placed.concat();
        for triangle in result.triangles {
            let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
            assert!((b - a).cross(c - a).dot(u.cross(v)) > 0.0);
        }
    }
}

proptest! {
    #[test]
    fn stars_with_holes_are_tiled(arms in 3_usize..60, holes in 0_usize..8, seed in any::<u64>()) {
        // Star-shaped holes on a row inside of the circle that the arms leave free.
        let mut contours = vec![star(arms, seed).into_iter().map(|p| p * 10.0 + p.normalize() * 100.0).collect::<Contour>()];
        for hole in 0..holes {
            let center = DVec2::new(hole as f64 * 6.0 - 21.0, 0.0);
            contours.push(star(3 + (seed as usize + hole) % 9, seed ^ hole as u64).into_iter().map(|p| center + p * 2.5).collect());
        }
        // A polygon of few arms does not reach around all holes.
        prop_assume!(arms > 5);
        plain(&contours, area_of(&contours), holes);
    }
}
