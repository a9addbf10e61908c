//! Operators and functions of formulas: one row each.

use super::error::ArithmeticProblem::{self, DivisionByZero, NotFinite};
use crate::numeric::sampling::mix;
use std::f64::consts::TAU;

/// The random numbers of one module in one step: a function of their key and of how many were drawn before.
#[derive(Clone, Debug)]
pub(super) struct ModuleRandom {
    key: u64,
    drawn: u64,
}

impl ModuleRandom {
    /// The numbers of a key; unrelated for different keys.
    pub fn new(key: u64) -> ModuleRandom {
        ModuleRandom { key, drawn: 0 }
    }

    /// A number, uniform in 0..1, 1 excluded.
    pub fn uniform(&mut self) -> f64 {
        self.drawn += 1;
        (mix(self.key ^ mix(self.drawn)) >> 11) as f64 * 2f64.powi(-53)
    }
}

/// An operator or function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MathFunction {
    Negate,
    Not,
    Truth,
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
    Power,
    Less,
    AtMost,
    Greater,
    AtLeast,
    Equal,
    Differs,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    Log,
    Sqrt,
    Abs,
    Sign,
    Floor,
    Ceil,
    Trunc,
    Round,
    Min,
    Max,
    Pow,
    Ran,
    Nran,
}

use MathFunction::{
    Abs, Acos, Add, Asin, AtLeast, AtMost, Atan, Atan2, Ceil, Cos, Differs, Divide, Equal, Exp, Floor, Greater, Less,
    Log, Max, Min, Modulo, Multiply, Negate, Not, Nran, Pow, Power, Ran, Round, Sign, Sin, Sqrt, Subtract, Tan, Trunc,
    Truth,
};

/// Functions that are called by name.
pub(super) const FUNCTIONS: [(&str, MathFunction); 21] = [
    ("sin", Sin),
    ("cos", Cos),
    ("tan", Tan),
    ("asin", Asin),
    ("acos", Acos),
    ("atan", Atan),
    ("atan2", Atan2),
    ("exp", Exp),
    ("log", Log),
    ("sqrt", Sqrt),
    ("abs", Abs),
    ("sign", Sign),
    ("floor", Floor),
    ("ceil", Ceil),
    ("trunc", Trunc),
    ("round", Round),
    ("min", Min),
    ("max", Max),
    ("pow", Pow),
    ("ran", Ran),
    ("nran", Nran),
];

/// Operators between two operands, with how strongly they bind: the longer sign stands before the one that it begins
/// with.
pub(super) const OPERATORS: [(&str, u8, MathFunction); 15] = [
    ("==", 3, Equal),
    ("!=", 3, Differs),
    ("<=", 4, AtMost),
    (">=", 4, AtLeast),
    ("≤", 4, AtMost),
    ("≥", 4, AtLeast),
    ("<", 4, Less),
    (">", 4, Greater),
    ("=", 3, Equal),
    ("+", 5, Add),
    ("-", 5, Subtract),
    ("*", 6, Multiply),
    ("/", 6, Divide),
    ("%", 6, Modulo),
    ("^", 8, Power),
];

impl MathFunction {
    /// How many operands it takes.
    pub fn arity(self) -> usize {
        match self {
            Negate | Not | Truth | Sin | Cos | Tan | Asin | Acos | Atan | Exp | Log | Sqrt | Abs | Sign | Floor
            | Ceil | Trunc | Round | Ran => 1,
            _ => 2,
        }
    }

    /// Whether its value follows from its operands.
    pub fn is_pure(self) -> bool {
        !matches!(self, Ran | Nran)
    }

    /// How it is written.
    pub fn name(self) -> &'static str {
        let named = FUNCTIONS.iter().find(|(_, function)| *function == self).map(|(name, _)| *name);
        let sign = || OPERATORS.iter().find(|(_, _, function)| *function == self).map(|(sign, ..)| *sign);
        named.or_else(sign).unwrap_or("-")
    }

    /// The value of operands; truth is 1, untruth 0, and all that is not 0 is true. Angles are degrees.
    ///
    /// - `b`: 0 for one operand.
    ///
    /// # Errors
    /// A value that is not finite.
    #[inline]
    pub fn apply(self, a: f64, b: f64, random: &mut ModuleRandom) -> Result<f64, ArithmeticProblem> {
        let truth = |holds: bool| Ok(f64::from(u8::from(holds)));
        let value = match self {
            Less => return truth(a < b),
            AtMost => return truth(a <= b),
            Greater => return truth(a > b),
            AtLeast => return truth(a >= b),
            Equal => return truth(a == b),
            Differs => return truth(a != b),
            Not => return truth(a == 0.0),
            Truth => return truth(a != 0.0),
            Divide | Modulo if b == 0.0 => return Err(DivisionByZero),
            Add => a + b,
            Subtract => a - b,
            Multiply => a * b,
            Divide => a / b,
            Negate => -a,
            Modulo => a % b,
            Power | Pow => a.powf(b),
            Sin => sin_cos_degrees(a).0,
            Cos => sin_cos_degrees(a).1,
            Tan => a.to_radians().tan(),
            Asin => a.asin().to_degrees(),
            Acos => a.acos().to_degrees(),
            Atan => a.atan().to_degrees(),
            Atan2 => a.atan2(b).to_degrees(),
            Exp => a.exp(),
            Log => a.ln(),
            Sqrt => a.sqrt(),
            Abs => a.abs(),
            Sign if a == 0.0 => 0.0,
            Sign => a.signum(),
            Floor => a.floor(),
            Ceil => a.ceil(),
            Trunc => a.trunc(),
            Round => a.round(),
            Min => a.min(b),
            Max => a.max(b),
            Ran => a * random.uniform(),
            Nran => a + b * normal(random),
        };
        if value.is_finite() { Ok(value) } else { Err(NotFinite(self.name())) }
    }
}

/// A number of the normal distribution of mean 0 and deviation 1.
///
/// # Source
/// Box and Muller 1958.
fn normal(random: &mut ModuleRandom) -> f64 {
    let [first, second] = [random.uniform(), random.uniform()];
    (-2.0 * (1.0 - first).ln()).sqrt() * (TAU * second).cos()
}

/// Sine and cosine of an angle in degrees, exact for multiples of 90 and for the halves at 30 and 60: so curves that
/// turn by such angles close.
pub(super) fn sin_cos_degrees(angle: f64) -> (f64, f64) {
    let turned = angle % 360.0;
    let quarters = (turned / 90.0).round();
    let rest = turned - 90.0 * quarters;
    let (sin, cos) = match rest {
        0.0 => (0.0, 1.0),
        30.0 => (0.5, 0.75_f64.sqrt()),
        -30.0 => (-0.5, 0.75_f64.sqrt()),
        rest => rest.to_radians().sin_cos(),
    };
    match (quarters as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_of_thirty_degrees_are_exact_and_others_as_the_library_has_them() {
        for (angle, expected) in [(0.0, (0.0, 1.0)), (90.0, (1.0, 0.0)), (-180.0, (0.0, -1.0)), (630.0, (-1.0, 0.0))] {
            assert_eq!(sin_cos_degrees(angle), expected, "{angle}");
        }
        assert_eq!([30.0, 150.0, -30.0, 210.0].map(|angle| sin_cos_degrees(angle).0), [0.5, 0.5, -0.5, -0.5]);
        assert_eq!([60.0, 120.0, -60.0, 300.0].map(|angle| sin_cos_degrees(angle).1), [0.5, -0.5, 0.5, 0.5]);
        for angle in (-800..800).map(|step| f64::from(step) * 1.37) {
            let (sin, cos) = angle.to_radians().sin_cos();
            let found = sin_cos_degrees(angle);
            assert!((found.0 - sin).abs() < 1e-14 && (found.1 - cos).abs() < 1e-14, "{angle}");
        }
    }

    #[test]
    fn random_numbers_have_the_moments_of_their_distributions() {
        const COUNT: u32 = 40_000;
        let mut random = ModuleRandom::new(3);
        let mean = |draw: &mut dyn FnMut() -> f64| (0..COUNT).map(|_| draw()).sum::<f64>() / f64::from(COUNT);
        let uniform = mean(&mut || Ran.apply(4.0, 0.0, &mut random).expect("finite"));
        assert!((uniform - 2.0).abs() < 0.03, "{uniform}");
        let square = mean(&mut || (Nran.apply(5.0, 2.0, &mut random).expect("finite") - 5.0).powi(2));
        assert!((square - 4.0).abs() < 0.15, "{square}");
    }
}
