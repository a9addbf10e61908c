//! Primitives against the formulas of the book.

use super::*;
use crate::curve::Curve;
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::solid::{Body, Expression, Measures, Solid};
use std::sync::Arc;

use crate::surface::{Surface, Tolerance, TwistAndTaper, rational_sphere, teapot};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Volume, area (not for all), middle along y, moments of inertia about y and about x through the centroid.
struct Book {
    name: &'static str,
    body: Body,
    volume: f64,
    area: Option<f64>,
    middle: f64,
    about: Option<[f64; 2]>,
}

fn book(name: &'static str, body: Result<Body, PrimitiveError>, volume: f64, middle: f64) -> Book {
    Book { name, body: body.unwrap(), volume, area: None, middle, about: None }
}

impl Book {
    fn area(self, area: f64) -> Book {
        Book { area: Some(area), ..self }
    }

    fn about(self, y: f64, x: f64) -> Book {
        Book { about: Some([y * self.volume, x * self.volume]), ..self }
    }
}

/// The area of a parabola y = k x^2 revolved about y, from 0 to r.
fn paraboloid_area(k: f64, r: f64) -> f64 {
    PI / (6.0 * k * k) * ((1.0 + 4.0 * k * k * r * r).powf(1.5) - 1.0)
}

fn pages() -> Vec<Book> {
    let (r, h, t) = (1.3_f64, 2.1_f64, 0.4_f64);
    let slant = ((r - t) * (r - t) + h * h).sqrt();
    let waisted = |w: f64| PI * h * (2.0 * w * w + r * r) / 3.0;
    let square = [DVec2::new(1.0, 0.0), DVec2::new(2.0, 0.0), DVec2::new(2.0, 1.0), DVec2::new(1.0, 1.0)];
    let hole = [DVec2::new(1.25, 0.25), DVec2::new(1.75, 0.25), DVec2::new(1.75, 0.75), DVec2::new(1.25, 0.75)];
    let quarter = (PI / 8.0).tan();
    let half = [[1.0, 0.0, quarter], [1.5, -0.5, quarter], [2.0, 0.0, 0.0]].map(DVec3::from_array);
    let third = (h * h + (r / 2.0).powi(2)).sqrt();
    vec![
        book("block", block(DVec3::new(1.0, 2.0, 3.0)), 6.0, 0.0).area(22.0).about(10.0 / 12.0, 13.0 / 12.0),
        book("wedge", wedge(DVec3::new(2.0, 1.0, 3.0), 0.0), 3.0, -1.0 / 6.0).area(2.0 + 6.0 + 3.0 + 3.0 * 5f64.sqrt()),
        book("pyramid", pyramid(3, r, h), h * r * r * 0.75 * 3f64.sqrt() / 3.0, -h / 4.0)
            .area(r * r * 0.75 * 3f64.sqrt() + 1.5 * r * 3f64.sqrt() * third),
        book("sphere", sphere(r), 4.0 / 3.0 * PI * r.powi(3), 0.0)
            .area(4.0 * PI * r * r)
            .about(0.4 * r * r, 0.4 * r * r),
        book("ellipsoid", ellipsoid(DVec3::new(1.0, 2.0, 1.0)), 8.0 / 3.0 * PI, 0.0)
            .area(TAU * (1.0 + 2.0 / 0.75f64.sqrt() * 0.75f64.sqrt().asin()))
            .about(0.4, 1.0),
        book("cylinder", cylinder(r, h), PI * r * r * h, 0.0)
            .area(TAU * r * (r + h))
            .about(r * r / 2.0, (3.0 * r * r + h * h) / 12.0),
        book("cone", frustum(r, 0.0, h), PI * r * r * h / 3.0, -h / 4.0)
            .area(PI * r * (r + r.hypot(h)))
            .about(0.3 * r * r, 0.15 * r * r + 0.0375 * h * h),
        book("frustum", frustum(r, t, h), PI * h / 3.0 * (r * r + r * t + t * t), {
            h * ((r * r + 2.0 * r * t + 3.0 * t * t) / (4.0 * (r * r + r * t + t * t)) - 0.5)
        })
        .area(PI * (r * r + t * t + (r + t) * slant)),
        book("paraboloid", paraboloid(r, h), PI * r * r * h / 2.0, h / 2.0 - 2.0 * h / 3.0)
            .area(PI * r * r + paraboloid_area(h / r / r, r))
            .about(r * r / 3.0, r * r / 6.0 + h * h / 18.0),
        book("hyperboloid", hyperboloid_of_one_sheet(t, r, h), waisted(t), 0.0),
        book(
            "bowls",
            hyperboloid_of_two_sheets(0.5, r, h),
            {
                // Two caps of the height d over the half gap g: PI a^2 d^2 (3 g + d) / (3 g^2).
                let (g, d) = (0.25, h / 2.0 - 0.25);
                let a = r / ((h / 0.5).powi(2) - 1.0).sqrt();
                2.0 * PI * a * a * d * d * (3.0 * g + d) / (3.0 * g * g)
            },
            0.0,
        ),
        book("torus", torus(r, t), 2.0 * PI * PI * r * t * t, 0.0)
            .area(4.0 * PI * PI * r * t)
            .about(r * r + 0.75 * t * t, 0.5 * r * r + 0.625 * t * t),
        book("prism", prism(&[&square, &hole], [0.0, 2.0]), 1.5, 0.5).area(1.5 + 12.0),
        book("square ring", revolved_polygon(&[&square, &hole], 1.0), TAU * 1.5 * 0.75, 0.5).area(TAU * 1.5 * 6.0),
        book("part of it", revolved_polygon(&[&square, &hole], 0.3), 0.3 * TAU * 1.5 * 0.75, 0.5)
            .area(0.3 * TAU * 1.5 * 6.0 + 1.5),
        book("half ring", revolution(&half), TAU * PI / 8.0 * (1.5), -2.0 / 3.0 / PI)
            .area(TAU * 1.5 * (PI / 2.0 + 1.0)),
    ]
}

#[test]
fn exact_measures_are_those_of_the_book() {
    for page in pages() {
        let Measures { area, mass } = page.body.measures();
        let close = |what: &str, found: f64, expected: f64, size: f64| {
            assert!((found - expected).abs() < 1e-12 * size, "{} {what}: {found} {expected}", page.name);
        };
        close("volume", mass.volume, page.volume, page.volume);
        page.area.into_iter().for_each(|expected| close("area", area, expected, expected));
        close("middle", mass.centroid.y, page.middle, 3.0);
        if let Some([about_y, about_x]) = page.about {
            close("inertia about y", mass.inertia.y_axis.y, about_y, about_y);
            close("inertia about x", mass.inertia.x_axis.x, about_x, about_x);
        }
    }
}

fn solid(body: &Body, chord: f64) -> Solid {
    let mesh = body.tessellate(Tolerance::new(chord, 30.0)).unwrap();
    let report = mesh.edge_report();
    assert!(report.is_closed() && report.collapsed + report.degenerate == 0, "{report:?}");
    Solid::new(mesh).unwrap()
}

#[test]
fn meshes_are_closed_and_converge_to_the_exact_measures_with_the_square_of_the_width() {
    for page in pages() {
        let exact = page.body.measures();
        let gaps = [2e-3, 5e-4].map(|chord| {
            let solid = solid(&page.body, chord);
            let (mass, area) = (solid.mass(), solid.mesh().area());
            assert!((mass.volume - exact.mass.volume).abs() <= chord * exact.area, "{}", page.name);
            let inertia = (mass.inertia - exact.mass.inertia).col(1).length();
            [mass.volume - exact.mass.volume, area - exact.area, inertia].map(f64::abs)
        });
        for (coarse, fine) in gaps[0].into_iter().zip(gaps[1]) {
            let ratio = coarse / fine;
            assert!(coarse < 1e-12 || (2.5..6.5).contains(&ratio), "{}: {gaps:?}", page.name);
        }
    }
}

/// Whether points, normals and parameters at the corners are those of the surfaces.
fn check_corners(name: &str, mesh: &Mesh, surfaces: &[Arc<dyn Surface>], size: f64) {
    for triangle in 0..mesh.triangles.len() {
        let surface = &surfaces[mesh.surfaces[triangle] as usize];
        for corner in 0..3 {
            let (uv, normal) = (mesh.corner_parameters[triangle][corner], mesh.corner_normals[triangle][corner]);
            let gap = surface.point(uv).distance(mesh.corners(triangle)[corner]);
            assert!(gap < 1e-14 * size, "{name}: {gap}");
            assert!((surface.normal(uv) - normal).length() < 1e-14, "{name}");
        }
        let face = mesh.face_normal(triangle).unwrap();
        assert!(mesh.corner_normals[triangle].iter().all(|normal| normal.dot(face) > 0.5), "{name} {triangle}");
    }
}

#[test]
fn corners_have_the_points_and_normals_of_their_surfaces() {
    for page in pages() {
        let mesh = page.body.tessellate(Tolerance::new(0.01, 30.0)).unwrap();
        check_corners(page.name, &mesh, &page.body.surfaces(), 4.0);
    }
}

#[test]
fn flat_faces_are_flat_to_the_bit() {
    let mesh = frustum(1.0 / 3.0, 0.1, 0.7).unwrap().tessellate(Tolerance::new(0.001, 30.0)).unwrap();
    for (triangle, surface) in mesh.surfaces.iter().enumerate() {
        let normal = [DVec3::NEG_Y, DVec3::ZERO, DVec3::Y][*surface as usize];
        assert!(*surface == 1 || mesh.corners(triangle).iter().all(|corner| corner.y == normal.y * 0.35));
        assert!(*surface == 1 || mesh.corner_normals[triangle] == [normal; 3]);
    }
}

#[test]
fn extreme_measures_give_closed_solids_of_the_right_volume() {
    let cone = |a: f64, b: f64, h: f64| PI * h / 3.0 * (a * a + a * b + b * b);
    let mut cases = Vec::new();
    for ratio in [1e-6, 1e-3, 1e3, 1e6] {
        cases.push((cylinder(ratio, 1.0), PI * ratio * ratio));
        cases.push((frustum(1.0, ratio, 2.0), cone(1.0, ratio, 2.0)));
        cases.push((ellipsoid(DVec3::new(1.0, ratio, 2.0)), 8.0 / 3.0 * PI * ratio));
        cases.push((paraboloid(1.0, ratio), PI / 2.0 * ratio));
        cases.push((torus(1.0 + ratio, 1.0), 2.0 * PI * PI * (1.0 + ratio)));
        cases.push((hyperboloid_of_one_sheet(1.0, 1.0 + ratio, 1.0), PI / 3.0 * (2.0 + (1.0 + ratio) * (1.0 + ratio))));
        cases.push((sphere(ratio * 1e6), 4.0 / 3.0 * PI * (ratio * 1e6).powi(3)));
    }
    for (case, (body, volume)) in cases.into_iter().enumerate() {
        let body = body.unwrap();
        let found = body.measures().mass.volume;
        assert!((found / volume - 1.0).abs() < 1e-9, "{case}: {found} {volume}");
        let size = Bounds::of(body.tessellate(Tolerance::new(1e30, 30.0)).unwrap().vertices).diagonal();
        let solid = solid(&body, 1e-3 * size);
        assert!((solid.mass().volume - volume).abs() < 1e-3 * size * body.measures().area, "{case}");
    }
}

#[test]
fn profiles_may_be_smooth_run_either_way_and_are_refused_with_the_place_if_they_bound_nothing() {
    let vase = [[0.0, 0.0], [1.0, 0.0], [0.2, 1.0], [0.8, 2.0]].map(DVec2::from_array);
    let body = smooth_revolution(&vase).unwrap();
    assert!(solid(&body, 1e-3).mass().volume > 0.5);
    let mut other = vase;
    other.reverse();
    let other = smooth_revolution(&other).unwrap().measures();
    assert!((other.mass.volume - body.measures().mass.volume).abs() < 1e-13 && other.mass.volume > 0.0);
    let error = |points: &[[f64; 3]]| {
        revolution(&points.iter().map(|p| DVec3::from_array(*p)).collect::<Vec<_>>()).err().unwrap().to_string()
    };
    assert_eq!(
        error(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [-0.5, 1.0, 0.0]]),
        "the profile goes through the axis at [-0.5, 1], behind point 2"
    );
    assert_eq!(
        error(&[[1.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]]),
        "the profile meets itself between points 0 and 1 and between points 2 and 3"
    );
    assert!(error(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]).contains("no area"));
    assert!(error(&[[1.0, 0.0, 0.0], [1.5, f64::NAN, 0.0], [3.0, 0.0, 0.0]]).starts_with("point 1 is"));
    assert!(revolved_polygon(&[vase], 1.5).is_err());
}

fn square(size: f64) -> Vec<DVec2> {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| DVec2::new(x, y) * (size * 0.5)).to_vec()
}

#[test]
fn sweeps_have_the_volume_of_pappus_whatever_the_curve_and_the_twist() {
    let control = [[0.0, 0.0, 0.0], [0.0, 3.0, 1.0], [4.0, 4.0, 2.0], [6.0, 0.0, 5.0], [3.0, -2.0, 6.0]];
    let control = control.map(DVec3::from_array);
    let curve = path(&control, false).unwrap();
    let length: f64 = (0..20_000)
        .map(|k| curve.point(2.0 * f64::from(k) / 2e4).distance(curve.point(2.0 * f64::from(k + 1) / 2e4)))
        .sum();
    let contours = [square(0.5), square(0.3)];
    for turns in [0.0, 0.25, -1.0] {
        let body = sweep(&contours, curve.clone(), TwistAndTaper { twist_turns: turns, scale: 1.0 }).unwrap();
        let exact = body.measures().mass.volume;
        assert!((exact / (0.16 * length) - 1.0).abs() < 1e-7, "{turns}: {exact} {}", 0.16 * length);
        let mesh = solid(&body, 2e-3).mass().volume;
        assert!((mesh / exact - 1.0).abs() < 0.02, "{turns}: {mesh} {exact}");
    }
    // Straight and to a point: a pyramid.
    let body = sweep(
        &[square(2.0)],
        path(&[DVec3::ZERO, DVec3::Y * 3.0], false).unwrap(),
        TwistAndTaper { twist_turns: 0.0, scale: 0.0 },
    );
    assert!((body.unwrap().measures().mass.volume - 4.0).abs() < 1e-13);
}

#[test]
fn closed_sweeps_come_back_to_where_they_began() {
    let control: Vec<DVec3> = (0..7)
        .map(|k| {
            let (sine, cosine) = (f64::from(k) / 7.0 * TAU).sin_cos();
            DVec3::new(4.0 * cosine, 4.0 * sine, (2.0 * f64::from(k) / 7.0 * TAU).sin())
        })
        .collect();
    for turns in [0.0, 2.0] {
        let body =
            sweep(&[square(0.5)], path(&control, true).unwrap(), TwistAndTaper { twist_turns: turns, scale: 1.0 })
                .unwrap();
        let solid = solid(&body, 0.02);
        assert_eq!(solid.mesh().edge_report().euler_characteristic(), 0);
    }
    let twist_and_taper = TwistAndTaper { twist_turns: 0.3, scale: 1.0 };
    assert!(sweep(&[square(0.5)], path(&control, true).unwrap(), twist_and_taper).is_err());
}

#[test]
fn sweeps_that_fold_are_refused_with_the_place() {
    let bent = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0)];
    let words = |size: f64, scale: f64| {
        let twist_and_taper = TwistAndTaper { twist_turns: 0.0, scale };
        sweep(&[square(size)], path(&bent, false).unwrap(), twist_and_taper).err().map(|error| error.to_string())
    };
    assert_eq!(words(0.5, 1.0), None);
    assert!(words(2.0, 1.0).unwrap().starts_with("the path bends with the radius"), "{:?}", words(2.0, 1.0));
    assert_eq!(words(0.5, -0.5).unwrap(), "taper -0.5 is not 0 to 1e6");
    assert!(path(&[DVec3::ZERO], false).is_err());
    // Control points that coincide at an end do no harm.
    let slow = path(&[DVec3::ZERO, DVec3::ZERO, DVec3::Y, DVec3::Y * 3.0], false).unwrap();
    let body = sweep(&[square(0.2)], slow, TwistAndTaper { twist_turns: 0.1, scale: 1.0 }).unwrap();
    let slow = solid(&body, 1e-3);
    assert!(slow.mesh().corner_normals.as_flattened().iter().all(|normal| (normal.length() - 1.0).abs() < 1e-12));
    let still = path(&[DVec3::ONE, DVec3::ONE], false).unwrap();
    assert!(sweep(&[square(1.0)], still, TwistAndTaper { twist_turns: 0.0, scale: 1.0 }).is_err());
}

#[test]
fn bad_measures_are_refused_in_words() {
    let words = |body: Result<Body, PrimitiveError>| body.err().unwrap().to_string();
    assert_eq!(words(cylinder(-1.0, 1.0)), "radius -1 is not a length above 0");
    assert_eq!(words(cylinder(1.0, f64::NAN)), "height NaN is not a length above 0");
    assert_eq!(words(sphere(f64::INFINITY)), "radius inf is not within 1e-60 to 1e60");
    assert_eq!(words(torus(1.0, 2.0)), "ring 1 is not greater than the tube 2");
    assert_eq!(words(hyperboloid_of_one_sheet(1.0, 1.0, 1.0)), "radius 1 is not greater than the waist 1");
    assert_eq!(words(hyperboloid_of_two_sheets(2.0, 1.0, 1.0)), "height 1 is not greater than the gap 2");
    assert_eq!(words(frustum(0.0, 0.0, 1.0)), "the greater radius 0 is not a length above 0");
    assert_eq!(words(pyramid(2, 1.0, 1.0)), "2 sides are not within 3 to 1048576");
    assert!(words(prism(&[[DVec2::ZERO, DVec2::X, DVec2::X * 2.0]], [0.0, 1.0])).contains("no area"));
}

#[test]
fn a_half_space_covers_what_it_is_combined_with() {
    let ball = solid(&sphere(1.0).unwrap(), 1e-3);
    for (normal, at) in [(DVec3::Y, DVec3::new(9.0, 0.25, -7.0)), (DVec3::new(1.0, 2.0, -0.5), DVec3::X * 0.1)] {
        let bounds = Bounds::of(ball.mesh().vertices.iter().copied());
        let half = solid(&half_space(normal, at, &bounds).unwrap(), 1.0);
        let behind = ball.intersection(&half).unwrap().mass().volume;
        let height = at.dot(normal.normalize());
        let cap = PI * (1.0 + height).powi(2) * (2.0 - height) / 3.0;
        assert!((behind - cap).abs() < 0.01, "{behind} {cap}");
        let (cut, _) =
            Solid::evaluate(&[&ball, &half], &Expression::difference(Expression::Operand(0), Expression::Operand(1)))
                .unwrap();
        assert!((behind + cut.mass().volume - ball.mass().volume).abs() < 1e-13);
    }
    assert!(half_space(DVec3::ZERO, DVec3::ZERO, &Bounds::EMPTY).is_err());
}

#[test]
fn patches_that_close_are_a_solid_and_others_name_their_open_edges() {
    let patches = rational_sphere(2.0).unwrap().patches().to_vec();
    let body = sculptured(patches).unwrap();
    assert!((body.measures().mass.volume / (32.0 / 3.0 * PI) - 1.0).abs() < 1e-12);
    assert!((body.measures().area / (16.0 * PI) - 1.0).abs() < 1e-12);
    let error = sculptured(teapot()).err().unwrap().to_string();
    assert!(error.contains("edges are not closed"), "{error}");
}
