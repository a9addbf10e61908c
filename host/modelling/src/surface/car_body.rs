//! The body of a car: three spline surfaces, joined with a common tangent plane and with a common curvature.

use glam::DVec3;

use super::{JoinError, Smoothness, SplineSurface, SurfaceSide, joined};
use crate::curve::Basis;

/// A cross-section through control points: place along the car, half the width, height of the belt line, half the width of
/// hood or roof, and height at the middle, metres.
type Section = [f64; 5];

/// The lower edge of the body above the road, metres.
const SILL: f64 = 0.22;

/// From the bumper to the windscreen.
const FRONT: [Section; 8] = [
    [-2.25, 0.680, SILL, 0.640, SILL],
    [-2.25, 0.720, 0.340, 0.670, 0.360],
    [-2.245, 0.770, 0.500, 0.720, 0.530],
    [-2.16, 0.830, 0.640, 0.740, 0.680],
    [-1.75, 0.870, 0.740, 0.750, 0.790],
    [-1.30, 0.885, 0.800, 0.750, 0.855],
    [-0.95, 0.895, 0.845, 0.750, 0.900],
    [-0.75, 0.900, 0.865, 0.750, 0.920],
];

/// Windscreen, roof and rear window. The first two sections only tell where it begins and how fast.
const CABIN: [Section; 11] = [
    [-0.75, 0.900, 0.865, 0.750, 0.920],
    [-0.60, 0.900, 0.880, 0.740, 0.955],
    [-0.42, 0.900, 0.890, 0.700, 1.120],
    [-0.10, 0.900, 0.900, 0.635, 1.360],
    [0.25, 0.900, 0.905, 0.610, 1.440],
    [0.70, 0.900, 0.915, 0.600, 1.450],
    [1.10, 0.900, 0.920, 0.610, 1.360],
    [1.42, 0.900, 0.925, 0.660, 1.130],
    [1.62, 0.895, 0.925, 0.710, 1.000],
    [1.78, 0.890, 0.925, 0.730, 0.965],
    [1.90, 0.885, 0.920, 0.735, 0.955],
];

/// The boot lid and the rear. The first three sections only tell where it begins and how fast.
const BOOT: [Section; 7] = [
    [1.90, 0.885, 0.920, 0.735, 0.955],
    [2.00, 0.880, 0.915, 0.735, 0.950],
    [2.12, 0.875, 0.910, 0.735, 0.945],
    [2.25, 0.850, 0.850, 0.730, 0.885],
    [2.275, 0.800, 0.600, 0.720, 0.630],
    [2.28, 0.720, 0.360, 0.680, 0.380],
    [2.28, 0.700, SILL, 0.660, SILL],
];

/// The body of a saloon: front with hood, cabin, boot; metres. The car drives towards -x, y is up, and it stands over
/// y = 0; outside out. It is open below, where its border lies in a plane and nothing else does.
///
/// Each surface has a continuous curvature in itself. At the windscreen line hood and cabin have a common tangent plane, at
/// the edge of the boot lid cabin and boot have a common curvature.
///
/// # Errors
/// [`JoinError`] if the data did not fit, which a test excludes.
///
/// # Source
/// Ours: no particular car.
pub fn car_body() -> Result<[SplineSurface; 3], JoinError> {
    let across = [SurfaceSide::HighU, SurfaceSide::LowU];
    let [front, cabin] = joined(&skin(&FRONT)?, &skin(&CABIN)?, across, Smoothness::G1)?;
    let [cabin, boot] = joined(&cabin, &skin(&BOOT)?, across, Smoothness::G2)?;
    Ok([front, cabin, boot])
}

/// The cubic surface over sections: u runs to the rear, v from the right sill over the top to the left.
fn skin(sections: &[Section]) -> Result<SplineSurface, JoinError> {
    let net: Vec<Vec<DVec3>> = sections.iter().map(row).collect();
    let basis = |count: usize| Basis::clamped(3, count);
    Ok(SplineSurface::new(basis(net.len())?, basis(net[0].len())?, &net, &[])?)
}

/// The control points of a section, from one sill to the other. One without height is a straight line.
fn row(&[x, width, belt, top_width, top]: &Section) -> Vec<DVec3> {
    if top <= SILL {
        return (0..=14).map(|k| DVec3::new(x, SILL, 0.9 * width * (1.0 - f64::from(k) / 7.0))).collect();
    }
    // Above the belt line sides lean in where there are windows, and are rounded where there is a lid.
    let (shoulder, edge) = if top - belt > 0.2 { (0.45, 0.25) } else { (1.0, 0.2) };
    let half = [
        [0.9 * width, SILL],
        [width, SILL + 0.06],
        [1.04 * width, SILL + 0.5 * (belt - SILL)],
        [width, belt],
        [top_width + 0.45 * (width - top_width) * shoulder, belt + 0.25 * (top - belt) + 0.01],
        [top_width, top - edge * (top - belt)],
        [0.62 * top_width, top],
    ];
    let side = |sign: f64| half.map(|[z, y]| DVec3::new(x, y.min(top), z * sign));
    let mut points = side(1.0).to_vec();
    points.push(DVec3::new(x, top + 0.012, 0.0));
    points.extend(side(-1.0).into_iter().rev());
    points
}

#[cfg(test)]
mod tests {
    use super::super::{Surface, TensorPatch, Tolerance, continuity, joint, tessellate_adaptively};
    use super::*;
    use glam::DVec2;

    #[test]
    fn the_parts_meet_as_smoothly_as_they_were_joined() {
        let [front, cabin, boot] = car_body().expect("the data fit");
        let across = [SurfaceSide::HighU, SurfaceSide::LowU];
        let windscreen = joint(&front, &cabin, across, 65);
        assert!(windscreen.gap == 0.0 && windscreen.angle < 1e-10, "{windscreen:?}");
        assert!(windscreen.curvature_difference > 0.1, "a tangent plane, but not a curvature: {windscreen:?}");
        let lid = joint(&cabin, &boot, across, 65);
        assert!(lid.gap == 0.0 && lid.angle < 1e-10 && lid.curvature_difference < 1e-9, "{lid:?}");
        for part in [front, cabin, boot] {
            for joint in continuity(part.patches(), 9) {
                assert!(joint.gap == 0.0 && joint.angle < 1e-9 && joint.curvature_difference < 1e-6, "{joint:?}");
            }
        }
    }

    #[test]
    fn the_body_is_one_open_sheet_of_the_size_of_a_car() {
        let patches: Vec<TensorPatch> =
            car_body().expect("the data fit").iter().flat_map(|part| part.patches().to_vec()).collect();
        let mesh = tessellate_adaptively(&patches, Tolerance::new(0.002, 20.0)).expect("tessellated");
        let report = mesh.edge_report();
        assert!(
            report.non_manifold == 0 && report.misoriented == 0 && report.euler_characteristic() == 1,
            "{report:?}"
        );
        let size = mesh.bounds().expect("vertices").size();
        assert!((4.3..4.6).contains(&size.x) && (1.1..1.3).contains(&size.y) && (1.7..1.9).contains(&size.z), "{size}");
        // Outside out: up at the top of the roof, to the side at the doors.
        let cabin = &car_body().expect("the data fit")[1];
        let [low, high] = cabin.domain();
        let at = |u: f64, v: f64| cabin.normal(low + (high - low) * DVec2::new(u, v));
        assert!(at(0.5, 0.5).y > 0.9 && at(0.5, 0.1).z > 0.5 && at(0.5, 0.9).z < -0.5);
    }
}
