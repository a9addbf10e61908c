//! Functions of the scene language that make curves and sculptured surfaces, trim, join and fill them, one row each.

use super::argument::Bound;
use super::builder::{Builder, value};
use super::function::Function;
use super::handle::Done;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, OBJECT, Parameter, TOLERANCE, parameter};
use super::sculpting::{array, on_curve};
use super::spline::{ControlMeaning, SIDES};
use crate::scene::{Sculpture, Shape, Sheet};
use crate::surface::{Smoothness, SplineSurface, car_body, revolved};
use rhai::Dynamic;

const CLOSED: Parameter =
    parameter("closed", Kind::Flag, Is("false"), "whether the last point is followed by the first");
const CLAMPED: Parameter =
    parameter("clamped", Kind::Flag, Is("true"), "whether an open one passes through its first and last point");
const WEIGHTS: Parameter = parameter("weights", Kind::Numbers, Is("1 for all"), "as many as points, each above 0");
const FRACTION: Kind = Kind::Number(0.0, 1.0);
/// Names of [`SIDES`], as a kind.
const SIDE: Kind = Kind::Word(&["low u", "high u", "low v", "high v"]);
const SMOOTHNESS: [(&str, Smoothness); 3] = [("G0", Smoothness::G0), ("G1", Smoothness::G1), ("G2", Smoothness::G2)];

/// The functions that make curves and surfaces.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "bezier",
        summary: "Says that control points are those of one Bezier curve, of a degree below their number.",
        parameters: &[],
        example: "let arch = curve([[0, 0, 0], [0, 2, 0], [2, 2, 0]], bezier(), [1, 0.7071067811865476, 1]);",
        action: |_, _| Ok(Dynamic::from(ControlMeaning::Bezier)),
    },
    Function {
        name: "b_spline",
        summary: "Says that control points are those of a B-spline, uniform or over knots.",
        parameters: &[
            parameter("degree", Kind::Integer(1, 32), Is("3"), "its degree"),
            CLOSED,
            CLAMPED,
            parameter(
                "knots",
                Kind::Numbers,
                Is("equal spans"),
                "rising numbers: degree and 1 more than points; closed, those of one period with its end",
            ),
        ],
        example: "let ring = curve([[1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 0, -1]], b_spline(#{ degree: 2, closed: true }));",
        action: |_, bound| {
            let flag = |name, default| bound.flag(name).unwrap_or(default);
            let degree = bound.integer("degree").and_then(|degree| usize::try_from(degree).ok()).unwrap_or(3);
            let knots = bound.numbers("knots").unwrap_or_default().concat();
            let (is_closed, is_clamped) = (flag("closed", false), flag("clamped", true));
            Ok(Dynamic::from(ControlMeaning::BSpline { degree, is_closed, is_clamped, knots }))
        },
    },
    Function {
        name: "beta_spline",
        summary: "Says that control points are those of a Beta-spline: one bias and one tension for all joints.",
        parameters: &[
            parameter("bias", Kind::Number(1e-9, 1e9), Is("1"), "above 1 the curve leans towards what comes later"),
            parameter("tension", Kind::Number(0.0, 1e12), Is("0"), "the more, the nearer to the control points"),
            CLOSED,
            CLAMPED,
        ],
        example: "let tight = curve([[0, 0, 0], [1, 2, 0], [3, 2, 0], [4, 0, 0]], beta_spline(1, 12));",
        action: |_, bound| Ok(Dynamic::from(bbb(bound))),
    },
    Function {
        name: "bbb_spline",
        summary: "Says that control points are those of a BBB-spline: a bias and a tension for each joint, an interval for each span; with equal ones a Beta-spline, with bias 1 and tension 0 a cubic B-spline, with pairs of zero intervals Bezier curves.",
        parameters: &[
            parameter("bias", Kind::Numbers, Is("1"), "one for each control point, or one for all"),
            parameter("tension", Kind::Numbers, Is("0"), "one for each control point, or one for all"),
            parameter(
                "intervals",
                Kind::Numbers,
                Is("1"),
                "before and after each control point, 0 or more: one more than points, if closed as many; or one for all",
            ),
            CLOSED,
            CLAMPED,
        ],
        example: "let bent = curve([[0, 0, 0], [1, 2, 0], [2, 2, 0], [3, 2, 0], [4, 0, 0]], bbb_spline(#{ tension: [0, 0, 30, 0, 0] }));",
        action: |_, bound| Ok(Dynamic::from(bbb(bound))),
    },
    Function {
        name: "curve",
        summary: "Makes a curve of control points; it is no object, but a path for what goes along it.",
        parameters: &[
            parameter("points", Kind::Points, Required, "control points [x, y, z]"),
            parameter(
                "kind",
                Kind::Spline,
                Is("b_spline(), of a lower degree for less than four points"),
                "what they mean",
            ),
            WEIGHTS,
        ],
        example: "let pipe = sweep([[-0.1, -0.1], [0.1, -0.1], [0, 0.1]], curve([[0, 0, 0], [0, 1, 0], [1, 1, 1]], bezier()));",
        action: |_, bound| {
            let (points, weights) = (bound.contours("points").concat(), bound.numbers("weights").unwrap_or_default());
            let spline = bound.spline("kind").unwrap_or_else(|| ControlMeaning::usual(points.len()));
            let curve = spline.curve(&points, &weights.concat()).map_err(|error| error.to_string())?;
            Ok(Dynamic::from(curve))
        },
    },
    Function {
        name: "curve_at",
        summary: "Returns #{ point, direction } of a curve, each [x, y, z].",
        parameters: &[
            parameter("curve", Kind::Curve, Required, "the curve"),
            parameter("at", FRACTION, Required, "the part of its parameters, from 0 to 1"),
        ],
        example: "let middle = curve_at(curve([[0, 0, 0], [1, 2, 0], [2, 0, 0]], bezier()), 0.5).point;",
        action: |_, bound| {
            let curve = bound.curve("curve", false)?.ok_or("curve is missing")?;
            Ok(on_curve(&curve, bound.number("at").unwrap_or(0.0)))
        },
    },
    Function {
        name: "surface",
        summary: "Adds a surface over a mesh of control points: Bezier, B-spline, Beta-spline or BBB-spline in each direction, polynomial or rational. Its outside is where u turns to v like a right-handed screw.",
        parameters: &[
            parameter(
                "points",
                Kind::Contours,
                Required,
                "rows of control points [x, y, z]; u goes from row to row, v along them",
            ),
            parameter(
                "u",
                Kind::Spline,
                Is("b_spline(), of a lower degree for less than four points"),
                "what the rows mean",
            ),
            parameter(
                "v",
                Kind::Spline,
                Is("b_spline(), of a lower degree for less than four points"),
                "what the points of a row mean",
            ),
            WEIGHTS,
            TOLERANCE,
        ],
        example: "let sheet = surface([[[0, 0, 0], [0, 0, 2]], [[1, 1, 0], [1, 2, 2]], [[2, 0, 0], [2, 0, 2]]], bezier(), bezier());",
        action: add_surface,
    },
    Function {
        name: "revolved",
        summary: "Adds the surface of a curve in the plane of x and y that turned about the y axis, exactly, as a rational surface: u turns, v is along the curve; outside is on the right of a curve that goes up.",
        parameters: &[parameter("profile", Kind::Curve, Required, "the curve"), TOLERANCE],
        example: "let bowl = revolved(curve([[0, 0, 0], [2, 0, 0], [2, 1, 0]], bezier()));",
        action: |builder, bound| {
            let profile = bound.curve("profile", false)?.ok_or("profile is missing")?;
            add(builder, bound, revolved(&profile).map_err(|error| error.to_string())?)
        },
    },
    Function {
        name: "car_body",
        summary: "Adds the body of a car, 4.5 long, and returns its three surfaces: front, cabin and boot. They are joined with a common tangent plane, G1, and with a common curvature, G2; below the body is open.",
        parameters: &[TOLERANCE],
        example: "let parts = car_body(); print(parts[0].continuity(parts[1]));",
        action: |builder, bound| {
            let parts = car_body().map_err(|error| error.to_string())?;
            let parts = parts.map(|part| add(builder, bound, part));
            Ok(Dynamic::from_array(parts.into_iter().collect::<Result<_, _>>()?))
        },
    },
    Function {
        name: "control_points",
        summary: "Returns the control points of a surface as rows of [x, y, z], placed as it is.",
        parameters: &[OBJECT],
        example: "let net = revolved([[1, 0, 0], [2, 1, 0], [1, 2, 0]]).control_points();",
        action: |builder, bound| {
            let surface = builder.spline_surface(bound.object("object"))?;
            let rows = surface.control().chunks(surface.counts()[1]);
            let row = |row: &[crate::curve::ControlPoint]| row.iter().map(|control| array(control.point)).collect();
            Ok(Dynamic::from_array(rows.map(|r| Dynamic::from_array(row(r))).collect()))
        },
    },
    Function {
        name: "surface_at",
        summary: "Returns #{ point, normal } of a surface, each [x, y, z], placed as it is.",
        parameters: &[
            OBJECT,
            parameter("u", FRACTION, Required, "the part of its first parameter, from 0 to 1"),
            parameter("v", FRACTION, Required, "the part of its second parameter, from 0 to 1"),
        ],
        example: "let top = revolved([[1, 0, 0], [2, 1, 0], [1, 2, 0]]).surface_at(0.5, 1).point;",
        action: |builder, bound| {
            let at = ["u", "v"].map(|name| bound.number(name).unwrap_or(0.0));
            builder.surface_at(bound.object("object"), at.into())
        },
    },
    Function {
        name: "trim",
        summary: "Cuts a surface along closed loops in its parameters: keeps what an odd number of them surrounds, or cuts that out.",
        parameters: &[
            OBJECT,
            parameter("loops", Kind::Loops, Required, "parts of the parameters u and v, from 0 to 1, as x and y"),
            parameter("holes", Kind::Flag, Is("false"), "whether what they surround is cut out"),
        ],
        example: "revolved([[1, 0, 0], [2, 1, 0], [1, 2, 0]]).trim([[0.2, 0.2], [0.4, 0.2], [0.3, 0.8]], true);",
        action: |builder, bound| {
            let holes = bound.flag("holes").unwrap_or(false);
            builder.trim(bound.object("object"), &bound.loops("loops").unwrap_or_default(), holes)
        },
    },
    Function {
        name: "join",
        summary: "Changes another surface near one side so that it continues this one, and returns what holds there then: #{ gap, angle, curvature_difference, curvature }, lengths in scene units, the angle in degrees.",
        parameters: &[
            OBJECT,
            parameter(
                "other",
                Kind::Object,
                Required,
                "the surface that is changed, a spline of the same kind along the side",
            ),
            parameter("side", SIDE, Is("\"high u\""), "the side of this surface"),
            parameter("other_side", SIDE, Is("\"low u\""), "the side of the other"),
            parameter(
                "smoothness",
                Kind::Word(&["G0", "G1", "G2"]),
                Is("\"G1\""),
                "a common curve, tangent plane or curvature",
            ),
        ],
        example: "let p = [[[0, 0, 0], [0, 0, 1]], [[1, 1, 0], [1, 1, 1]], [[2, 0, 0], [2, 0, 1]]]; let a = surface(p, bezier(), bezier()); let b = surface(p, bezier(), bezier()).translate(2.1, 0, 0); print(a.join(b, #{ smoothness: \"G2\" }));",
        action: |builder, bound| {
            let named = |name, default: &str| {
                let word = bound.text(name).unwrap_or(default);
                SIDES.iter().find(|(known, _)| *known == word).map(|(_, side)| *side)
            };
            let sides = [named("side", "high u"), named("other_side", "low u")];
            let word = bound.text("smoothness").unwrap_or("G1");
            let smoothness = SMOOTHNESS.iter().find(|(known, _)| *known == word).map(|(_, smoothness)| *smoothness);
            let ([Some(one), Some(two)], Some(smoothness)) = (sides, smoothness) else {
                return Err("there is no such side".into());
            };
            builder.join([bound.object("object"), bound.object("other")], [one, two], smoothness)
        },
    },
    Function {
        name: "continuity",
        summary: "Returns what holds along every side that patches of some surfaces share: a list of #{ surfaces, gap, angle, curvature_difference, curvature }; `peris continuity` prints it for a whole scene.",
        parameters: &[OBJECT, parameter("others", Kind::Objects, Is("none"), "further surfaces")],
        example: "let parts = car_body(); let worst = 0.0; for joint in parts[1].continuity(parts[2]) { if joint.angle > worst { worst = joint.angle; } }",
        action: |builder, bound| {
            let others = bound.objects("others").unwrap_or_default();
            builder.continuity(bound.object("object").into_iter().chain(others))
        },
    },
    Function {
        name: "fill",
        summary: "Adds a surface that fills a hole between other surfaces with common tangent planes: one patch with as many sides, or four-sided patches around a vertex. The sides must be bicubic at most and not rational.",
        parameters: &[
            parameter("sides", Kind::Sides, Required, "the surfaces around the hole, each with its side there"),
            parameter(
                "around_vertex",
                Kind::Flag,
                Is("false"),
                "whether four-sided patches fill it, two sides to each",
            ),
            TOLERANCE,
        ],
        example: "let c = [[-1, -1], [-1, 1], [1, 1], [1, -1]]; let sides = []; for k in 0..4 { let a = c[k]; let b = c[(k + 1) % 4]; let rim = [[[2 * a[0], 0, 2 * a[1]], [a[0], 0, a[1]]], [[2 * b[0], 0, 2 * b[1]], [b[0], 0, b[1]]]]; sides.push([surface(rim, bezier(), bezier()), \"high v\"]); } let lid = fill(sides);",
        action: |builder, bound| {
            let around_vertex = bound.flag("around_vertex").unwrap_or(false);
            builder.fill(&bound.sides("sides").unwrap_or_default(), around_vertex, bound.number("tolerance"))
        },
    },
    Function {
        name: "sculptured",
        summary: "Makes one object of several surfaces that agree to the bit where they meet: a solid if they close.",
        parameters: &[
            parameter(
                "surfaces",
                Kind::Objects,
                Required,
                "the surfaces, outside out; they are no objects of their own any more",
            ),
            parameter("closed", Kind::Flag, Is("true"), "whether they must close"),
        ],
        example: "let body = sculptured(car_body(), false);",
        action: |builder, bound| {
            let closed = bound.flag("closed").unwrap_or(true);
            let whole = builder.sculptured(&bound.objects("surfaces").unwrap_or_default(), closed)?;
            Ok(value(Some(whole)))
        },
    },
];

/// A Beta-spline or BBB-spline.
fn bbb(bound: &Bound) -> ControlMeaning {
    let list = |name: &str, default: f64| {
        let one = bound.number(name).map(|one| vec![one]);
        one.or_else(|| bound.numbers(name).map(|rows| rows.concat())).unwrap_or_else(|| vec![default])
    };
    let (is_closed, is_clamped) = (bound.flag("closed").unwrap_or(false), bound.flag("clamped").unwrap_or(true));
    let [bias, tension, intervals] = [("bias", 1.0), ("tension", 0.0), ("intervals", 1.0)].map(|(n, d)| list(n, d));
    ControlMeaning::Bbb { bias, tension, intervals, is_closed, is_clamped }
}

fn add(builder: &mut Builder, bound: &Bound, surface: SplineSurface) -> Done {
    let sculpture = Sculpture::of(Sheet::Spline { surface: Box::new(surface), loops: Vec::new() });
    builder.add(Shape::Sculpture(Box::new(sculpture)), bound.number("tolerance")).map(Dynamic::from)
}

fn add_surface(builder: &mut Builder, bound: &Bound) -> Done {
    let rows = bound.contours("points");
    let kind =
        |name: &str, count: usize| bound.spline(name).unwrap_or_else(|| ControlMeaning::usual(count)).basis(count);
    let weights = bound.numbers("weights").unwrap_or_default();
    let surface = kind("u", rows.len()).and_then(|u| {
        let v = kind("v", rows.first().map_or(0, Vec::len))?;
        SplineSurface::new(u, v, &rows, &weights)
    });
    add(builder, bound, surface.map_err(|error| error.to_string())?)
}
