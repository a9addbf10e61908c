//! Functions of the scene language that make curves and sculptured surfaces, trim, join and fill them, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::CallResult;
use super::kinds::{
    Contours, CurveKind, Flag, Integer, Loops, NumberKind, Numbers, ObjectKind, Objects, PointsKind, RowsOfNumbers,
    SidesKind, Spline, Word,
};
use super::parameter::{Defaulted, Optional, optional, required, with_default};
use super::sculpting::{array, on_curve};
use super::shared::{OBJECT, TOLERANCE};
use super::spline::{ControlMeaning, SIDES};
use crate::scene::{Sculpture, Shape, SurfaceSheet};
use crate::surface::{Smoothness, SplineSurface, SurfaceSide, car_body, revolved};
use glam::DVec2;
use rhai::Dynamic;

const CLOSED: Defaulted<Flag, bool> = with_default(Flag, false, "whether the last point is followed by the first");
const CLAMPED: Defaulted<Flag, bool> =
    with_default(Flag, true, "whether an open one passes through its first and last point");
const WEIGHTS: Optional<RowsOfNumbers> = optional(RowsOfNumbers, "1 for all", "as many as points, each above 0");
const FRACTION: NumberKind = NumberKind(0.0, 1.0);
const USUAL: &str = "b_spline(), of a lower degree for less than four points";
const SIDE: Word<SurfaceSide> = Word(&SIDES);
const SMOOTHNESS: Word<Smoothness> = Word(&[("G0", Smoothness::G0), ("G1", Smoothness::G1), ("G2", Smoothness::G2)]);

/// The functions that make curves and surfaces.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        bezier()
        "Says that control points are those of one Bezier curve, of a degree below their number."
        "let arch = curve([[0, 0, 0], [0, 2, 0], [2, 2, 0]], bezier(), [1, 0.7071067811865476, 1]);"
        |_| Ok(Dynamic::from(ControlMeaning::Bezier))
    },
    function! {
        b_spline(
            degree: with_default(Integer(1usize, 32), 3, "its degree"),
            closed: CLOSED,
            clamped: CLAMPED,
            knots: optional(
                Numbers,
                "equal spans",
                "rising numbers: degree and 1 more than points; closed, those of one period with its end",
            ),
        )
        "Says that control points are those of a B-spline, uniform or over knots."
        "let ring = curve([[1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 0, -1]], b_spline(#{ degree: 2, closed: true }));"
        |_| {
            let knots = knots.unwrap_or_default();
            Ok(Dynamic::from(ControlMeaning::BSpline { degree, is_closed: closed, is_clamped: clamped, knots }))
        }
    },
    function! {
        beta_spline(
            bias: with_default(NumberKind(1e-9, 1e9), 1.0, "above 1 the curve leans towards what comes later"),
            tension: with_default(NumberKind(0.0, 1e12), 0.0, "the more, the nearer to the control points"),
            closed: CLOSED,
            clamped: CLAMPED,
        )
        "Says that control points are those of a Beta-spline: one bias and one tension for all joints."
        "let tight = curve([[0, 0, 0], [1, 2, 0], [3, 2, 0], [4, 0, 0]], beta_spline(1, 12));"
        |_| {
            let [bias, tension, intervals] = [bias, tension, 1.0].map(|one| vec![one]);
            Ok(Dynamic::from(ControlMeaning::Bbb { bias, tension, intervals, is_closed: closed, is_clamped: clamped }))
        }
    },
    function! {
        bbb_spline(
            bias: with_default(Numbers, 1.0, "one for each control point, or one for all"),
            tension: with_default(Numbers, 0.0, "one for each control point, or one for all"),
            intervals: with_default(
                Numbers,
                1.0,
                "before and after each control point, 0 or more: one more than points, if closed as many; or one for all",
            ),
            closed: CLOSED,
            clamped: CLAMPED,
        )
        "Says that control points are those of a BBB-spline: a bias and a tension for each joint, an interval for each span; with equal ones a Beta-spline, with bias 1 and tension 0 a cubic B-spline, with pairs of zero intervals Bezier curves."
        "let bent = curve([[0, 0, 0], [1, 2, 0], [2, 2, 0], [3, 2, 0], [4, 0, 0]], bbb_spline(#{ tension: [0, 0, 30, 0, 0] }));"
        |_| Ok(Dynamic::from(ControlMeaning::Bbb { bias, tension, intervals, is_closed: closed, is_clamped: clamped }))
    },
    function! {
        curve(
            points: required(PointsKind, "control points [x, y, z]"),
            kind: optional(Spline, USUAL, "what they mean"),
            weights: WEIGHTS,
        )
        "Makes a curve of control points; it is no object, but a path for what goes along it."
        "let pipe = sweep([[-0.1, -0.1], [0.1, -0.1], [0, 0.1]], curve([[0, 0, 0], [0, 1, 0], [1, 1, 1]], bezier()));"
        |_| {
            let spline = kind.unwrap_or_else(|| ControlMeaning::usual(points.len()));
            let curve = spline.curve(&points, &weights.unwrap_or_default().concat()).map_err(|error| error.to_string())?;
            Ok(Dynamic::from(curve))
        }
    },
    function! {
        curve_at(
            curve: required(CurveKind, "the curve"),
            at: required(FRACTION, "the part of its parameters, from 0 to 1"),
        )
        "Returns #{ point, direction } of a curve, each [x, y, z]."
        "let middle = curve_at(curve([[0, 0, 0], [1, 2, 0], [2, 0, 0]], bezier()), 0.5).point;"
        |_| Ok(on_curve(&curve.curve(false)?, at))
    },
    function! {
        surface(
            points: required(
                Contours,
                "rows of control points [x, y, z]; u goes from row to row, v along them",
            ),
            u: optional(Spline, USUAL, "what the rows mean"),
            v: optional(Spline, USUAL, "what the points of a row mean"),
            weights: WEIGHTS,
            tolerance: TOLERANCE,
        )
        "Adds a surface over a mesh of control points: Bezier, B-spline, Beta-spline or BBB-spline in each direction, polynomial or rational. Its outside is where u turns to v like a right-handed screw."
        "let sheet = surface([[[0, 0, 0], [0, 0, 2]], [[1, 1, 0], [1, 2, 2]], [[2, 0, 0], [2, 0, 2]]], bezier(), bezier());"
        |builder| {
            let basis = |given: Option<ControlMeaning>, count: usize| {
                given.unwrap_or_else(|| ControlMeaning::usual(count)).basis(count)
            };
            let surface = basis(u, points.len()).and_then(|u| {
                let v = basis(v, points.first().map_or(0, Vec::len))?;
                SplineSurface::new(u, v, &points, &weights.unwrap_or_default())
            });
            add(builder, surface.map_err(|error| error.to_string())?, tolerance)
        }
    },
    function! {
        revolved(profile: required(CurveKind, "the curve"), tolerance: TOLERANCE)
        "Adds the surface of a curve in the plane of x and y revolved about the y axis, exactly, as a rational surface: u goes round, v is along the curve; outside is on the right of a curve that goes up."
        "let bowl = revolved(curve([[0, 0, 0], [2, 0, 0], [2, 1, 0]], bezier()));"
        |builder| {
            let surface = revolved(&profile.curve(false)?).map_err(|error| error.to_string())?;
            add(builder, surface, tolerance)
        }
    },
    function! {
        car_body(tolerance: TOLERANCE)
        "Adds the body of a car, 4.5 long, and returns its three surfaces: front, cabin and boot. They are joined with a common tangent plane, G1, and with a common curvature, G2; below the body is open."
        "let parts = car_body(); print(parts[0].continuity(parts[1]));"
        |builder| {
            let parts = car_body().map_err(|error| error.to_string())?;
            let parts = parts.map(|part| add(builder, part, tolerance));
            Ok(Dynamic::from_array(parts.into_iter().collect::<Result<_, _>>()?))
        }
    },
    function! {
        control_points(object: OBJECT)
        "Returns the control points of a surface as rows of [x, y, z], placed as it is."
        "let net = revolved([[1, 0, 0], [2, 1, 0], [1, 2, 0]]).control_points();"
        |builder| {
            let surface = builder.spline_surface(object)?;
            let rows = surface.control().chunks(surface.counts()[1]);
            let row = |row: &[crate::curve::ControlPoint]| row.iter().map(|control| array(control.point)).collect();
            Ok(Dynamic::from_array(rows.map(|r| Dynamic::from_array(row(r))).collect()))
        }
    },
    function! {
        surface_at(
            object: OBJECT,
            u: required(FRACTION, "the part of its first parameter, from 0 to 1"),
            v: required(FRACTION, "the part of its second parameter, from 0 to 1"),
        )
        "Returns #{ point, normal } of a surface, each [x, y, z], placed as it is."
        "let top = revolved([[1, 0, 0], [2, 1, 0], [1, 2, 0]]).surface_at(0.5, 1).point;"
        |builder| builder.surface_at(object, DVec2::new(u, v))
    },
    function! {
        trim(
            object: OBJECT,
            loops: required(Loops, "parts of the parameters u and v, from 0 to 1, as x and y"),
            holes: with_default(Flag, false, "whether what they surround is cut out"),
        )
        "Cuts a surface along closed loops in its parameters: keeps what an odd number of them surrounds, or cuts that out."
        "revolved([[1, 0, 0], [2, 1, 0], [1, 2, 0]]).trim([[0.2, 0.2], [0.4, 0.2], [0.3, 0.8]], true);"
        |builder| builder.trim(object, &loops, holes)
    },
    function! {
        join(
            object: OBJECT,
            other: required(ObjectKind, "the surface that is changed, a spline of the same kind along the side"),
            side: with_default(SIDE, SurfaceSide::HighU, "the side of this surface"),
            other_side: with_default(SIDE, SurfaceSide::LowU, "the side of the other"),
            smoothness: with_default(SMOOTHNESS, Smoothness::G1, "a common curve, tangent plane or curvature"),
        )
        "Changes another surface near one side so that it continues this one, and returns what holds there then: #{ gap, angle, curvature_difference, curvature }, lengths in scene units, the angle in degrees."
        "let p = [[[0, 0, 0], [0, 0, 1]], [[1, 1, 0], [1, 1, 1]], [[2, 0, 0], [2, 0, 1]]]; let a = surface(p, bezier(), bezier()); let b = surface(p, bezier(), bezier()).translate(2.1, 0, 0); print(a.join(b, #{ smoothness: \"G2\" }));"
        |builder| builder.join([object, other], [side, other_side], smoothness)
    },
    function! {
        continuity(object: OBJECT, others: optional(Objects, "none", "further surfaces"))
        "Returns what holds along every side that patches of some surfaces share: a list of #{ surfaces, gap, angle, curvature_difference, curvature }; `peris continuity` prints it for a whole scene."
        "let parts = car_body(); let worst = 0.0; for joint in parts[1].continuity(parts[2]) { if joint.angle > worst { worst = joint.angle; } }"
        |builder| builder.continuity([object].into_iter().chain(others.unwrap_or_default()))
    },
    function! {
        fill(
            sides: required(SidesKind, "the surfaces around the hole, each with its side there"),
            around_vertex: with_default(Flag, false, "whether four-sided patches fill it, two sides to each"),
            tolerance: TOLERANCE,
        )
        "Adds a surface that fills a hole between other surfaces with common tangent planes: one patch with as many sides, or four-sided patches around a vertex. The sides must be bicubic at most and not rational."
        "let c = [[-1, -1], [-1, 1], [1, 1], [1, -1]]; let sides = []; for k in 0..4 { let a = c[k]; let b = c[(k + 1) % 4]; let rim = [[[2 * a[0], 0, 2 * a[1]], [a[0], 0, a[1]]], [[2 * b[0], 0, 2 * b[1]], [b[0], 0, b[1]]]]; sides.push([surface(rim, bezier(), bezier()), \"high v\"]); } let lid = fill(sides);"
        |builder| builder.fill(&sides, around_vertex, tolerance)
    },
    function! {
        sculptured(
            surfaces: required(Objects, "the surfaces, outside out; they are no objects of their own any more"),
            closed: with_default(Flag, true, "whether they must close"),
        )
        "Makes one object of several surfaces that agree to the bit where they meet: a solid if they close."
        "let body = sculptured(car_body(), false);"
        |builder| builder.sculptured(&surfaces, closed).map(Dynamic::from)
    },
];

fn add(builder: &mut Builder, surface: SplineSurface, tolerance: Option<f64>) -> CallResult {
    let sculpture = Sculpture::of(SurfaceSheet::Spline { surface: Box::new(surface), loops: Vec::new() });
    builder.add(Shape::Sculpture(Box::new(sculpture)), tolerance).map(Dynamic::from)
}
