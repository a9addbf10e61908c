//! Where the corners of a face go in one step, and in the limit.

use std::f64::consts::TAU;

use glam::DVec3;

/// How much a sharpness below 1 pins what would be cut: half as much as is cut elsewhere as it comes near 1, where a
/// step of sharp rules gives the same. From 1 on, all is pinned.
pub(super) fn pinning(sharpness: f64) -> f64 {
    if sharpness >= 1.0 { 1.0 } else { 1.0 - (-sharpness).exp2() }
}

/// How far a corner and its neighbours are pinned along the sides between them; zero everywhere on smooth faces.
///
/// A value of 1 at the beginning or end of a side pins that end: the curve along the side begins there, as a B-spline
/// with a double knot at its end does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pinning {
    /// Here, along the side to the next corner.
    pub here_forward: f64,
    /// At the next corner, along the side from here.
    pub there_forward: f64,
    /// Here, along the side to the corner before.
    pub here_backward: f64,
    /// At the corner before, along the side to here.
    pub there_backward: f64,
}

impl Pinning {
    /// Nowhere.
    pub const NOT: Pinning = Pinning { here_forward: 0.0, there_forward: 0.0, here_backward: 0.0, there_backward: 0.0 };

    /// How a corner is pinned by the sides and corners around it.
    ///
    /// Along a side, an end is pinned by the other side of the face there. Along a crease only the vertex pins, so that
    /// the faces at both sides agree.
    ///
    /// - `sides`: sharpness of the second side before the corner, of the one before it, of the one behind it, and of
    ///   the next.
    /// - `vertices`: how much the corner before, this one and the next one are pinned.
    pub fn by(sides: [f64; 4], vertices: [f64; 3]) -> Pinning {
        let [before_last, last, here, next] = sides;
        let along = |side: f64, vertex: f64, other: f64| {
            // Between two sides that are nearly creases the corner is nearly cut: half as much is pinned.
            if side >= 1.0 { vertex } else { vertex.max(pinning(other) * (1.0 - 0.5 * side)) }
        };
        Pinning {
            here_forward: along(here, vertices[1], last),
            there_forward: along(here, vertices[2], next),
            here_backward: along(last, vertices[1], here),
            there_backward: along(last, vertices[0], before_last),
        }
    }
}

/// The new corners of a smooth face.
///
/// v_i' = v_i / 4 + 3 g / 4 + (cos(i t) C + sin(i t) S) / 2n, with g the centroid, C and S the sums of cos(j t) v_j and
/// sin(j t) v_j, t = 2 pi / n. All weights are positive and their sum is 1.
///
/// # Source
/// Doo and Sabin 1978: (n + 5) / 4n for the corner itself and (3 + 2 cos((i - j) t)) / 4n for the others.
pub(super) fn step(corners: &[DVec3], new: &mut [DVec3]) {
    match *corners {
        [a, b, c] => {
            let sum = (a + b + c) / 6.0;
            [a, b, c].into_iter().zip(new).for_each(|(corner, new)| *new = corner * 0.5 + sum);
        }
        [a, b, c, d] => {
            let (ac, bd) = (a + c, b + d);
            // 9, 3, 1 and 3 sixteenths.
            let sum = (ac + 3.0 * bd) * 0.0625;
            let other = (3.0 * ac + bd) * 0.0625;
            new.copy_from_slice(&[a * 0.5 + sum, b * 0.5 + other, c * 0.5 + sum, d * 0.5 + other]);
        }
        _ => {
            let count = corners.len() as f64;
            let center = corners.iter().sum::<DVec3>() / count;
            let [cosine, sine] = waves(corners);
            for (k, (corner, new)) in corners.iter().zip(new).enumerate() {
                let (s, c) = (TAU * k as f64 / count).sin_cos();
                *new = *corner * 0.25 + center * 0.75 + (cosine * c + sine * s) * (0.5 / count);
            }
        }
    }
}

/// The sums of cos(j t) v_j and sin(j t) v_j over the corners, t = 2 pi / n: they span the tangent plane of the limit
/// surface in the middle of a smooth face.
pub(super) fn waves(corners: &[DVec3]) -> [DVec3; 2] {
    match *corners {
        [a, b, c] => [a - (b + c) * 0.5, (b - c) * (0.5 * 3.0_f64.sqrt())],
        [a, b, c, d] => [a - c, b - d],
        [] => [DVec3::ZERO; 2],
        // Relative to one of them: far from the origin the sums would lose digits.
        [origin, ..] => corners.iter().enumerate().fold([DVec3::ZERO; 2], |[cosine, sine], (k, corner)| {
            let (s, c) = (TAU * k as f64 / corners.len() as f64).sin_cos();
            [cosine + (*corner - origin) * c, sine + (*corner - origin) * s]
        }),
    }
}

/// The new position of corner `index` of a face that is pinned at some of its sides.
///
/// On a face of four corners this is the product of two rules for curves; on others it is its like with the centroid,
/// and goes over into the smooth rule as nothing is pinned. All weights are positive and their sum is 1.
///
/// - `smooth`: the new position by [`step`].
pub(super) fn held(corners: &[DVec3], index: usize, held: Pinning, smooth: DVec3) -> DVec3 {
    if held == Pinning::NOT {
        return smooth;
    }
    let count = corners.len();
    // What is pinned more gets what the other end loses.
    let fraction = |here: f64, there: f64| (1.0 - here) * (1.0 + (there - here).max(0.0)) * 0.25;
    let forward = fraction(held.here_forward, held.there_forward);
    let backward = fraction(held.here_backward, held.there_backward);
    let here = corners[index];
    let next = corners[(index + 1) % count];
    let last = corners[(index + count - 1) % count];
    let center = corners.iter().sum::<DVec3>() / count as f64;
    let (f, b) = (2.0 * forward, 2.0 * backward);
    let bent = here * ((1.0 - f) * (1.0 - b))
        + (here + next) * (0.5 * f * (1.0 - b))
        + (here + last) * (0.5 * b * (1.0 - f))
        + center * (f * b);
    if count == 4 {
        return bent;
    }
    let free = (1.0 - held.here_forward)
        * (1.0 - held.there_forward)
        * (1.0 - held.here_backward)
        * (1.0 - held.there_backward);
    bent.lerp(smooth, free)
}
