//! The slopes that a direction sees of a Gaussian surface, from uniform numbers.

use libm::erfc;

/// Slopes beyond this, in units of the root mean square times root 2, are rarer than 1e-22.
const STEEPEST: f64 = 7.0;
/// Most rounds of the iteration; it needs three, seldom more than five.
const ROUNDS: usize = 60;
const INVERSE_ROOT_OF_PI: f64 = 0.564_189_583_547_756_3;

/// The slope x below which a part `uniform` of the slopes lie that a direction sees, weighted as it sees them.
///
/// Their density is (cos − x sin) exp(−x²) / √π for x below cot. With sine 0 it is the plain Gaussian.
///
/// - `cosine`, `sine`: of the direction, both 0 and more, squares adding up to 1. `uniform`: 0..1.
/// - Returns −7..=7.
pub(super) fn inverse_of_visible(cosine: f64, sine: f64, uniform: f64) -> f64 {
    let below = |x: f64, bell: f64| cosine * 0.5 * erfc(-x) + sine * 0.5 * bell;
    let bell = |x: f64| INVERSE_ROOT_OF_PI * (-x * x).exp();
    let top = if cosine >= STEEPEST * sine { STEEPEST } else { cosine / sine };
    let wanted = uniform * below(top, bell(top));
    let (mut low, mut high) = (-STEEPEST, top);
    // From straight above they are those of a Gaussian; from the horizon a part exp(-x²) of them is seen. Where the
    // slope is that of the direction itself nothing is seen, and no step leads away.
    let flat = 0.5 * INVERSE_ROOT_OF_PI * sine / (0.5 * INVERSE_ROOT_OF_PI * sine + cosine);
    let from_horizon = -(-uniform.max(f64::MIN_POSITIVE).ln()).max(0.0).sqrt();
    let begin = guess(uniform) * (1.0 - flat) + from_horizon * flat;
    let mut x = begin.min(top - 0.25 * (1.0 - uniform)).max(low);
    for _ in 0..ROUNDS {
        let here = bell(x);
        let excess = below(x, here) - wanted;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        // Halley's step: Newton's, and how the slope changes along it, by half at the most. Or half of the bracket
        // where the step leaves it.
        let seen = cosine - x * sine;
        let newton = excess / (seen * here);
        let change = (newton * (x + 0.5 * sine / seen)).max(-0.5);
        let step = x - newton / (1.0 + change);
        // The error after such a step is about its cube, after half a bracket as large as that.
        let (next, close) = if (low..=high).contains(&step) { (step, 1e-6) } else { (0.5 * (low + high), 1e-8) };
        if (next - x).abs() <= close {
            return next;
        }
        x = next;
    }
    x
}

/// A number whose error function is about 2 `uniform` − 1.
///
/// # Source
/// Winitzki 2008: an approximation to four parts in a thousand.
fn guess(uniform: f64) -> f64 {
    let y = (2.0 * uniform - 1.0).clamp(-1.0 + 1e-15, 1.0 - 1e-15);
    let logarithm = ((1.0 - y) * (1.0 + y)).ln();
    let half = 2.0 / (std::f64::consts::PI * 0.147) + 0.5 * logarithm;
    ((half * half - logarithm / 0.147).sqrt() - half).max(0.0).sqrt().copysign(y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::erf;

    #[test]
    fn the_inverse_returns_the_uniform_number_it_was_given() {
        for angle in [0.0, 0.3, 1.0, 1.5, 1.5699] {
            let (sine, cosine) = f64::sin_cos(angle);
            let below = |x: f64| cosine * 0.5 * (1.0 + erf(x)) + sine * 0.5 * INVERSE_ROOT_OF_PI * (-x * x).exp();
            let all = below(if sine > 0.0 { (cosine / sine).min(30.0) } else { 30.0 });
            for i in 1..200 {
                let uniform = f64::from(i) / 200.0;
                let x = inverse_of_visible(cosine, sine, uniform);
                assert!((below(x) / all - uniform).abs() < 1e-12, "{angle} {uniform}: {x}");
            }
        }
    }

    #[test]
    fn ends_of_the_range_are_finite() {
        for uniform in [0.0, 1e-300, f64::EPSILON, 1.0 - f64::EPSILON / 2.0, 1.0] {
            for (sine, cosine) in [(0.0, 1.0), (1.0, 0.0), (0.6, 0.8), (1.0, 1e-9)] {
                let x = inverse_of_visible(cosine, sine, uniform);
                assert!((-STEEPEST..=STEEPEST).contains(&x) && x * sine <= cosine, "{uniform} {sine}: {x}");
            }
        }
    }
}
