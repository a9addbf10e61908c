//! The slopes that a direction sees of a Gaussian surface, from uniform numbers.
//!
//! Error function and exponential are read from a table with Taylor's series between its places, and the iteration
//! begins with a guess from another table, so that one round is enough.

use libm::erfc;
use std::sync::LazyLock;

/// Slopes beyond this, in units of the root mean square times root 2, are rarer than 1e-22.
const STEEPEST: f64 = 7.0;
/// Places of the table of the Gaussian in a unit of the slope.
const PLACES: f64 = 256.0;
/// Intervals of the table of guesses, along each side.
const GUESSES: usize = 128;
/// Intervals of the table of slopes of the Gaussian itself, and how many at each end are too coarse.
const SLOPES: usize = 512;
const RARE: usize = 16;
/// Most rounds of the iteration; it needs one, seldom more than three.
const ROUNDS: usize = 60;
/// A step of the fourth order by so much has an error of a thousandth of a billionth, and one of the fifth order by as
/// much as the second: about these powers of them.
const CLOSE: f64 = 3e-4;
const CLOSE_OF_FIFTH: f64 = 2.6e-3;
const INVERSE_ROOT_OF_PI: f64 = 0.564_189_583_547_756_3;

/// The tables.
struct Tables {
    /// The part Φ of the slopes below places x from −7 to 7, their density g there, and the integral x Φ + g / 2 of Φ.
    gaussian: Vec<[f64; 3]>,
    /// Slopes to begin with: of each direction, by its flatness, those at even steps of a stretched uniform number.
    guesses: Vec<[f32; GUESSES + 1]>,
    /// The slopes of the Gaussian itself at even steps of the stretched number, and their change in a step.
    slopes: Vec<[f64; 2]>,
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    let places = (2.0 * STEEPEST * PLACES) as usize;
    let at = |place: usize| {
        let x = place as f64 / PLACES - STEEPEST;
        let [below, bell] = [0.5 * erfc(-x), INVERSE_ROOT_OF_PI * (-x * x).exp()];
        [below, bell, x * below + 0.5 * bell]
    };
    let mut tables = Tables { gaussian: (0..=places).map(at).collect(), guesses: Vec::new(), slopes: Vec::new() };
    let of_direction = |row: usize| {
        let flat = row as f64 / GUESSES as f64;
        let (sine, cosine) = (flat, (1.0 - flat) * 0.5 * INVERSE_ROOT_OF_PI);
        let length = sine.hypot(cosine);
        std::array::from_fn(|place| {
            let q = (place as f64 / GUESSES as f64).clamp(0.1 / GUESSES as f64, 1.0 - 0.1 / GUESSES as f64);
            let uniform = unstretched(q);
            tables.inverse(cosine / length, sine / length, uniform, 0.0) as f32
        })
    };
    let guesses = (0..=GUESSES).map(of_direction).collect();
    tables.guesses = guesses;
    let slope = |place: usize| {
        let q = (place as f64 / SLOPES as f64).clamp(0.1 / SLOPES as f64, 1.0 - 0.1 / SLOPES as f64);
        let x = tables.inverse(1.0, 0.0, unstretched(q), 0.0);
        let [_, bell] = tables.gaussian(x);
        [x, 4.0 * q.min(1.0 - q) / (bell * SLOPES as f64)]
    };
    let slopes = (0..=SLOPES).map(slope).collect();
    tables.slopes = slopes;
    tables
});

/// The uniform number of a stretched one.
fn unstretched(q: f64) -> f64 {
    if q < 0.5 { 2.0 * q * q } else { 1.0 - 2.0 * (1.0 - q) * (1.0 - q) }
}

/// A uniform number, stretched at both ends, where slopes change fast.
#[inline(always)]
fn stretched(uniform: f64) -> f64 {
    let edge = (0.5 * uniform.min(1.0 - uniform).max(0.0)).sqrt();
    if uniform < 0.5 { edge } else { 1.0 - edge }
}

/// The whole number that is nearest to a number of 0 and more below 2³¹, twice.
///
/// Added to 2⁵², a number loses what is behind its point; its last bits are then the whole number. A cast would first ask
/// whether the number has any place among whole ones.
#[inline(always)]
fn nearest(x: f64) -> (f64, usize) {
    const SHIFT: f64 = 4_503_599_627_370_496.0;
    let shifted = x + SHIFT;
    (shifted - SHIFT, (shifted.to_bits() & 0x7fff_ffff) as usize)
}

impl Tables {
    /// The place of a slope in the table of the Gaussian: its slope, and what is there.
    #[inline(always)]
    fn place(&self, x: f64) -> (f64, [f64; 3]) {
        let (place, index) = nearest((x + STEEPEST) * PLACES);
        (place * (1.0 / PLACES) - STEEPEST, self.gaussian[index.min(self.gaussian.len() - 1)])
    }

    #[inline(always)]
    fn gaussian(&self, x: f64) -> [f64; 2] {
        let (at, [below, bell, _]) = self.place(x);
        let d = x - at;
        let square = at * at;
        // The derivatives of the density are Hermite's polynomials times it.
        let part = 1.0 - d * (at - d * ((2.0 / 3.0) * square - 1.0 / 3.0 - d * at * (square * (1.0 / 3.0) - 0.5)));
        let t = -d * (2.0 * at + d);
        let fall = 1.0 + t * (1.0 + t * (1.0 / 2.0 + t * (1.0 / 6.0 + t * (1.0 / 24.0 + t * (1.0 / 120.0)))));
        [below + bell * d * part, bell * fall]
    }

    /// The slope to begin with.
    ///
    /// - `flat`: how flat the direction is, 0 straight above, 1 at the horizon.
    #[inline(always)]
    fn guess(&self, flat: f64, uniform: f64) -> f64 {
        let steps = GUESSES as f64;
        let (row, column) = (flat * steps, stretched(uniform) * steps);
        let [(first, i), (left, j)] = [row, column].map(|place| nearest((place - 0.5).clamp(0.0, steps - 1.0)));
        let (x, y) = (row - first, column - left);
        let between = |line: &[f32; GUESSES + 1]| {
            let [a, b] = [line[j], line[j + 1]].map(f64::from);
            a + (b - a) * y
        };
        let (a, b) = (between(&self.guesses[i]), between(&self.guesses[i + 1]));
        a + (b - a) * x
    }

    /// The steepest slope that a direction sees, and what it sees of all.
    #[inline(always)]
    fn top(&self, cosine: f64, sine: f64) -> (f64, f64) {
        if cosine >= STEEPEST * sine {
            return (STEEPEST, cosine);
        }
        let top = cosine * sine.recip();
        let (at, [below, bell, integral]) = self.place(top);
        let d = top - at;
        let bent = 0.5 - d * (at * (1.0 / 3.0) - d * (at * at * (1.0 / 6.0) - 1.0 / 12.0));
        (top, sine * (integral + d * (below + bell * d * bent)))
    }

    /// The result of [`inverse_of_visible`], by one step of the fifth order from the place of the table that is nearest to
    /// a guess; by more steps where that is too far.
    #[inline(always)]
    fn inverse_near(&self, cosine: f64, sine: f64, uniform: f64, guess: f64) -> f64 {
        let (top, all) = self.top(cosine, sine);
        let (x, [below, bell, _]) = self.place(guess.min(top));
        let seen = cosine - x * sine;
        let over = (seen * bell).recip();
        let newton = (cosine * below + 0.5 * sine * bell - uniform * all) * over;
        let bend = sine * bell * over;
        // Derivatives over the first, by Hermite's polynomials.
        let square = x * x;
        let second = -2.0 * x - bend;
        let third = 4.0 * square - 2.0 + 4.0 * x * bend;
        let fourth = x * (12.0 - 8.0 * square) - bend * (12.0 * square - 6.0);
        let cube = 0.5 * second * second - third * (1.0 / 6.0);
        let quartic = second * (0.625 * second * second - third * (5.0 / 12.0)) + fourth * (1.0 / 24.0);
        let step = newton * (1.0 + newton * (0.5 * second + newton * (cube + newton * quartic)));
        let next = x - step;
        if step.abs() * (1.0 + bend.abs()) <= 2.0 * CLOSE_OF_FIFTH && step.abs() <= CLOSE_OF_FIFTH && next <= top {
            return next;
        }
        self.inverse(cosine, sine, uniform, guess)
    }

    /// The result of [`inverse_of_visible`], from any first guess.
    #[inline(never)]
    fn inverse(&self, cosine: f64, sine: f64, uniform: f64, guess: f64) -> f64 {
        let half = 0.5 * sine;
        let (top, all) = self.top(cosine, sine);
        let wanted = uniform * all;
        let (mut low, mut high) = (-STEEPEST, top);
        // Where the slope is that of the direction itself nothing is seen, and no step leads away.
        let mut x = guess.min(top - 0.25 * (1.0 - uniform)).max(low);
        for _ in 0..ROUNDS {
            let [below, bell] = self.gaussian(x);
            let excess = cosine * below + half * bell - wanted;
            // Chebyshev's step of the fourth order: Newton's, and what the second and third derivatives change.
            let seen = cosine - x * sine;
            let over = (seen * bell).recip();
            let newton = excess * over;
            let bend = sine * bell * over;
            let second = -2.0 * x - bend;
            let third = 4.0 * x * (x + bend) - 2.0;
            let step = newton * (1.0 + newton * (0.5 * second + newton * (0.5 * second * second - third / 6.0)));
            let next = x - step;
            if step.abs() <= CLOSE && next <= top {
                return next;
            }
            if excess > 0.0 {
                high = x;
            } else {
                low = x;
            }
            // Half of the bracket where the step leaves it.
            x = if (low..=high).contains(&next) { next } else { 0.5 * (low + high) };
            if high - low < 1e-8 {
                return x;
            }
        }
        x
    }
}

/// The part of a Gaussian's slopes below one, and their density there: erfc(−x) / 2 and exp(−x²) / √π, to 1e-13.
///
/// - `x`: any number; beyond ±7 the end of the table is meant.
#[inline]
pub(super) fn gaussian(x: f64) -> [f64; 2] {
    TABLES.gaussian(x.clamp(-STEEPEST, STEEPEST))
}

/// The slope x below which a part `uniform` of the slopes lie that a direction sees, weighted as it sees them.
///
/// Their density is (cos − x sin) exp(−x²) / √π for x below cot. With sine 0 it is the plain Gaussian.
///
/// - `cosine`, `sine`: of the direction, both 0 and more, of any scale. `uniform`: 0..1.
/// - Returns −7..=7.
#[inline]
pub(super) fn inverse_of_visible(cosine: f64, sine: f64, uniform: f64) -> f64 {
    let tables: &Tables = &TABLES;
    let part = sine * (0.5 * INVERSE_ROOT_OF_PI);
    tables.inverse_near(cosine, sine, uniform, tables.guess(part / (part + cosine), uniform))
}

/// The slope below which a part `uniform` of all slopes lie.
///
/// - `uniform`: 0..1.
/// - Returns −7..=7.
#[inline]
pub(super) fn inverse_of_gaussian(uniform: f64) -> f64 {
    let tables: &Tables = &TABLES;
    let column = stretched(uniform) * SLOPES as f64;
    let (first, place) = nearest((column - 0.5).max(0.0));
    if !(RARE..SLOPES - RARE).contains(&place) {
        return tables.inverse(1.0, 0.0, uniform, tables.guess(0.0, uniform));
    }
    // Hermite's cubic.
    let y = column - first;
    let [[a, of_a], [b, of_b]] = [tables.slopes[place], tables.slopes[place + 1]];
    let rise = b - a;
    a + y * (of_a + y * (3.0 * rise - 2.0 * of_a - of_b + y * (of_a + of_b - 2.0 * rise)))
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

    #[test]
    fn the_table_of_the_gaussian_holds_thirteen_digits() {
        for i in -9_000..=9_000 {
            let x = f64::from(i) * 7.123e-4;
            let [below, bell] = gaussian(x);
            assert!((below - 0.5 * erfc(-x)).abs() < 1e-13, "{x}: {below}");
            assert!((bell - INVERSE_ROOT_OF_PI * (-x * x).exp()).abs() < 1e-13, "{x}: {bell}");
        }
    }

    #[test]
    fn slopes_of_the_gaussian_are_those_of_their_uniform_number() {
        for i in 1..20_000 {
            let uniform = f64::from(i) / 20_000.0;
            let error = (0.5 * erfc(-inverse_of_gaussian(uniform)) - uniform).abs();
            assert!(error < 1e-6 * uniform.min(1.0 - uniform), "{uniform}: {error}");
        }
        for uniform in [0.0, 1e-300, 1.0 - f64::EPSILON / 2.0, 1.0] {
            assert!((-STEEPEST..=STEEPEST).contains(&inverse_of_gaussian(uniform)), "{uniform}");
        }
    }
}
