//! Arithmetic: sums, products, quotients and roundings of numbers, vectors and matrices.
//!
//! Typing: two integers give an integer, which wraps; an integer and a real give a real; vectors and matrices of
//! equal size add; a number scales anything; a row vector times a matrix is the transformed vector; a matrix times
//! a matrix is their product in row-vector order. Anything else is a fault.

use super::algebra::{difference, product, quotient, sum};
use super::{FunctionExample, FunctionRow, QueuePosition, Source};
use crate::{
    matrices::sine_and_cosine,
    port::{
        Firing, KindSet,
        Literal::{I, M2, M3, M43, R, V2, V3, V4},
        PortSpec, Problem,
    },
};
use glam::{DMat4, DVec4};
use protocol::{Value, value::is_finite};

/// What adds: numbers, vectors, square matrices.
const ADDEND: KindSet = KindSet::NUMBER.or(KindSet::VECTOR).or(KindSet::SQUARE);
/// What multiplies: that and the 4x3 matrices of F:LOOKAT.
const FACTOR: KindSet = ADDEND.or(KindSet::MATRIX);

/// Two active inputs, or the first or second a constant.
const fn pair(kinds: KindSet, constant: u16, words: [&'static str; 2]) -> [PortSpec; 2] {
    [
        if constant == 1 { PortSpec::constant(kinds, words[0]) } else { PortSpec::active(kinds, words[0]) },
        if constant == 2 { PortSpec::constant(kinds, words[1]) } else { PortSpec::active(kinds, words[1]) },
    ]
}

const TERMS: [&str; 2] = ["first term", "second term"];
const DIFFERENCE: [&str; 2] = ["minuend", "subtrahend"];
const FACTORS: [&str; 2] = ["first factor", "second factor"];
const QUOTIENT: [&str; 2] = ["dividend", "divisor"];

const SUM_NOTE: Source = Source::manual("4x3 matrices do not add");
const USED_NOTE: Source = Source::confirmed("clients use it with integers and FIX(1)");
const DIVISION_NOTE: Source = Source::manual("division of integers truncates; by 0 is a fault without output");

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "ADD",
        summary: "sum of two numbers, vectors or matrices",
        source: SUM_NOTE,
        inputs: &pair(ADDEND, 0, TERMS),
        outputs: &["sum"],
        behaviour: add,
        in_place: Some(add_in_place),
        examples: &[
            FunctionExample::of(&[(1, I(2)), (2, I(3))], &[(1, I(5))]),
            FunctionExample::of(&[(1, I(i32::MAX)), (2, I(1))], &[(1, I(i32::MIN))]),
            FunctionExample::of(&[(1, I(2)), (2, R(0.5))], &[(1, R(2.5))]),
            FunctionExample::of(&[(1, V3([1.0, 2.0, 3.0])), (2, V3([1.0, 0.0, -3.0]))], &[(1, V3([2.0, 2.0, 0.0]))]),
            FunctionExample::of(
                &[(1, M2([[1.0, 2.0], [3.0, 4.0]])), (2, M2([[1.0; 2]; 2]))],
                &[(1, M2([[2.0, 3.0], [4.0, 5.0]]))],
            ),
            FunctionExample::of(
                &[(1, V2([1.0, 2.0])), (2, V3([1.0, 0.0, 0.0])), (2, V2([1.0, 1.0]))],
                &[(1, V2([2.0, 3.0]))],
            )
            .faults(&[5]),
            FunctionExample::of(&[(1, R(1.7e308)), (2, R(1.7e308))], &[]).faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ADDC",
        summary: "sum with a constant",
        source: USED_NOTE,
        inputs: &pair(ADDEND, 2, TERMS),
        outputs: &["sum"],
        behaviour: add,
        in_place: Some(add_in_place),
        examples: &[
            FunctionExample::of(&[(2, I(1)), (1, I(0)), (1, I(8))], &[(1, I(1)), (1, I(9))]),
            FunctionExample::of(&[(2, I(1)), (1, V2([1.0, 1.0])), (1, I(1))], &[(1, I(2))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SUB",
        summary: "difference of two numbers, vectors or matrices",
        source: SUM_NOTE,
        inputs: &pair(ADDEND, 0, DIFFERENCE),
        outputs: &["<1> - <2>"],
        behaviour: subtract,
        in_place: Some(subtract_in_place),
        examples: &[
            FunctionExample::of(&[(1, I(2)), (2, I(3))], &[(1, I(-1))]),
            FunctionExample::of(&[(1, I(i32::MIN)), (2, I(1))], &[(1, I(i32::MAX))]),
            FunctionExample::of(&[(1, V2([1.0, 2.0])), (2, V2([3.0, 1.0]))], &[(1, V2([-2.0, 1.0]))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SUBC",
        summary: "difference from a constant subtrahend",
        source: USED_NOTE,
        inputs: &pair(ADDEND, 2, DIFFERENCE),
        outputs: &["<1> - <2>"],
        behaviour: subtract,
        in_place: Some(subtract_in_place),
        examples: &[
            FunctionExample::of(&[(2, I(1)), (1, I(2))], &[(1, I(1))]),
            FunctionExample::of(&[(2, I(1)), (1, V2([1.0, 1.0])), (1, R(0.5))], &[(1, R(-0.5))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CSUB",
        summary: "difference from a constant minuend",
        source: Source::manual(""),
        inputs: &pair(ADDEND, 1, DIFFERENCE),
        outputs: &["<1> - <2>"],
        behaviour: subtract,
        in_place: Some(subtract_in_place),
        examples: &[
            FunctionExample::of(&[(1, R(1.0)), (2, I(2))], &[(1, R(-1.0))]),
            FunctionExample::of(
                &[(1, V2([1.0, 1.0])), (2, V2([0.0, 2.0])), (2, V3([0.0; 3]))],
                &[(1, V2([1.0, -1.0]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MUL",
        summary: "product in row-vector order: a number with anything, a vector with a matrix, two matrices",
        source: Source::manual(
            "a 3D vector with a 4x3 matrix is a point: it is moved too; a 4x3 matrix has no multiples",
        ),
        inputs: &pair(FACTOR, 0, FACTORS),
        outputs: &["<1> times <2>"],
        behaviour: multiply,
        in_place: Some(multiply_in_place),
        examples: &[
            FunctionExample::of(&[(1, I(-3)), (2, I(4))], &[(1, I(-12))]),
            FunctionExample::of(&[(1, R(2.0)), (2, V3([1.0, 2.0, 3.0]))], &[(1, V3([2.0, 4.0, 6.0]))]),
            FunctionExample::of(&[(1, V2([1.0, 10.0])), (2, M2([[1.0, 2.0], [3.0, 4.0]]))], &[(1, V2([31.0, 42.0]))]),
            FunctionExample::of(
                &[(1, M2([[1.0, 2.0], [3.0, 4.0]])), (2, M2([[0.0, 1.0], [1.0, 0.0]]))],
                &[(1, M2([[2.0, 1.0], [4.0, 3.0]]))],
            ),
            FunctionExample::of(
                &[
                    (1, V3([1.0, 1.0, 1.0])),
                    (2, M43([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0], [5.0, 6.0, 7.0]])),
                ],
                &[(1, V3([6.0, 8.0, 8.0]))],
            ),
            FunctionExample::of(
                &[(1, M2([[1.0, 2.0], [3.0, 4.0]])), (2, M3([[1.0; 3]; 3])), (2, I(2))],
                &[(1, M2([[2.0, 4.0], [6.0, 8.0]]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MULC",
        summary: "product with a constant second factor; the usual scaler of a dial",
        source: Source::confirmed("clients scale a dial with it"),
        inputs: &pair(FACTOR, 2, FACTORS),
        outputs: &["<1> times <2>"],
        behaviour: multiply,
        in_place: Some(multiply_in_place),
        examples: &[
            FunctionExample::of(&[(2, R(4.0)), (1, R(0.25))], &[(1, R(1.0))]),
            FunctionExample::of(
                &[(2, I(3)), (1, I(2)), (1, V3([1.0, 0.0, -1.0]))],
                &[(1, I(6)), (1, V3([3.0, 0.0, -3.0]))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CMUL",
        summary: "product with a constant first factor",
        source: Source::manual("the order matters for matrices"),
        inputs: &pair(FACTOR, 1, FACTORS),
        outputs: &["<1> times <2>"],
        behaviour: multiply,
        in_place: Some(multiply_in_place),
        examples: &[
            FunctionExample::of(
                &[(1, M2([[1.0, 2.0], [3.0, 4.0]])), (2, M2([[0.0, 1.0], [1.0, 0.0]]))],
                &[(1, M2([[2.0, 1.0], [4.0, 3.0]]))],
            ),
            FunctionExample::of(&[(1, R(0.5)), (2, I(3)), (2, V2([2.0, 4.0]))], &[(1, R(1.5)), (1, V2([1.0, 2.0]))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DIV",
        summary: "quotient of numbers, or of a vector or matrix and a number",
        source: DIVISION_NOTE,
        inputs: &[PortSpec::active(ADDEND, "dividend"), PortSpec::active(KindSet::NUMBER, "divisor")],
        outputs: &["<1> / <2>"],
        behaviour: divide,
        examples: &[
            FunctionExample::of(&[(1, I(-7)), (2, I(2))], &[(1, I(-3))]),
            FunctionExample::of(&[(1, I(i32::MIN)), (2, I(-1))], &[(1, I(i32::MIN))]),
            FunctionExample::of(&[(1, I(7)), (2, R(2.0))], &[(1, R(3.5))]),
            FunctionExample::of(&[(1, V4([2.0, 4.0, 6.0, 8.0])), (2, I(2))], &[(1, V4([1.0, 2.0, 3.0, 4.0]))]),
            FunctionExample::of(&[(1, I(1)), (2, I(0)), (1, R(1.0)), (2, R(0.0)), (1, I(4)), (2, I(2))], &[(1, I(2))])
                .faults(&[7, 7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DIVC",
        summary: "quotient with a constant divisor",
        source: DIVISION_NOTE,
        inputs: &[PortSpec::active(ADDEND, QUOTIENT[0]), PortSpec::constant(KindSet::NUMBER, QUOTIENT[1])],
        outputs: &["<1> / <2>"],
        behaviour: divide,
        examples: &[
            FunctionExample::of(&[(2, I(4)), (1, M3([[4.0; 3]; 3]))], &[(1, M3([[1.0; 3]; 3]))]),
            FunctionExample::of(&[(2, I(0)), (1, I(1)), (2, I(-2)), (1, I(7))], &[(1, I(-3))]).faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CDIV",
        summary: "quotient with a constant dividend",
        source: DIVISION_NOTE,
        inputs: &[PortSpec::constant(ADDEND, QUOTIENT[0]), PortSpec::active(KindSet::NUMBER, QUOTIENT[1])],
        outputs: &["<1> / <2>"],
        behaviour: divide,
        examples: &[
            FunctionExample::of(&[(1, R(1.0)), (2, R(8.0)), (2, I(0)), (2, I(2))], &[(1, R(0.125)), (1, R(0.5))])
                .faults(&[7]),
            FunctionExample::of(&[(1, I(7)), (2, I(2)), (2, R(2.0))], &[(1, I(3)), (1, R(3.5))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MOD",
        summary: "remainder of a division of integers",
        source: Source::manual("the sign follows the dividend: ours"),
        inputs: &pair(KindSet::INTEGER, 0, QUOTIENT),
        outputs: &["remainder"],
        behaviour: modulo,
        examples: &[
            FunctionExample::of(&[(1, I(-7)), (2, I(3))], &[(1, I(-1))]),
            FunctionExample::of(&[(1, I(7)), (2, I(0))], &[]).faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MODC",
        summary: "remainder of a division by a constant integer",
        source: Source::manual("the sign follows the dividend: ours"),
        inputs: &pair(KindSet::INTEGER, 2, QUOTIENT),
        outputs: &["remainder"],
        behaviour: modulo,
        examples: &[
            FunctionExample::of(&[(2, I(3)), (1, I(8))], &[(1, I(2))]),
            FunctionExample::of(&[(2, I(0)), (1, I(8)), (2, I(-3)), (1, I(8)), (1, R(8.0))], &[(1, I(2))])
                .faults(&[7, 5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SQROOT",
        summary: "square root",
        source: Source::manual("a negative number is a fault"),
        inputs: &[PortSpec::active(KindSet::NUMBER, "not negative")],
        outputs: &["root, a real"],
        behaviour: |f| {
            let root = f.number(1)?.sqrt();
            f.emit(1, Value::Real(root))
        },
        examples: &[
            FunctionExample::of(&[(1, I(16)), (1, R(-1.0)), (1, R(0.25))], &[(1, R(4.0)), (1, R(0.5))]).faults(&[7]),
            FunctionExample::of(&[(1, R(0.0)), (1, V2([1.0, 1.0]))], &[(1, R(0.0))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SINCOS",
        summary: "sine and cosine of an angle",
        source: Source::manual("exact at multiples of 90 degrees"),
        inputs: &[PortSpec::active(KindSet::NUMBER, "degrees")],
        outputs: &["sine", "cosine"],
        behaviour: |f| {
            let (sine, cosine) = sine_and_cosine(f.number(1)?);
            f.emit(1, Value::Real(sine))?;
            f.emit(2, Value::Real(cosine))
        },
        examples: &[
            FunctionExample::of(&[(1, R(90.0))], &[(1, R(1.0)), (2, R(0.0))]),
            FunctionExample::of(&[(1, I(-720))], &[(1, R(0.0)), (2, R(1.0))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ROUND",
        summary: "nearest integer",
        source: Source::manual("halves go away from zero: ours"),
        inputs: &[PortSpec::active(KindSet::NUMBER, "number")],
        outputs: &["integer"],
        behaviour: |f| to_integer(f, f64::round),
        examples: &[
            FunctionExample::of(&[(1, R(2.5)), (1, R(-2.5)), (1, R(3e9))], &[(1, I(3)), (1, I(-3))]).faults(&[6]),
            FunctionExample::of(&[(1, I(7)), (1, R(-0.4))], &[(1, I(7)), (1, I(0))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FIX",
        summary: "integer part, towards zero",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::NUMBER, "number")],
        outputs: &["integer"],
        behaviour: |f| to_integer(f, f64::trunc),
        examples: &[
            FunctionExample::of(&[(1, R(2.9)), (1, R(-2.9))], &[(1, I(2)), (1, I(-2))]),
            FunctionExample::of(&[(1, R(-2147483648.5)), (1, R(2147483648.0))], &[(1, I(i32::MIN))]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CEILING",
        summary: "smallest integer that is not less",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::NUMBER, "number")],
        outputs: &["integer"],
        behaviour: |f| to_integer(f, f64::ceil),
        examples: &[
            FunctionExample::of(&[(1, R(2.1)), (1, R(-2.9))], &[(1, I(3)), (1, I(-2))]),
            FunctionExample::of(&[(1, R(-0.5)), (1, I(4)), (1, R(2147483647.5))], &[(1, I(0)), (1, I(4))]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FLOAT",
        summary: "integer as a real",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::NUMBER, "number")],
        outputs: &["real"],
        behaviour: |f| {
            let real = f.number(1)?;
            f.emit(1, Value::Real(real))
        },
        examples: &[
            FunctionExample::of(&[(1, I(-3))], &[(1, R(-3.0))]),
            FunctionExample::of(&[(1, R(0.5)), (1, I(i32::MIN))], &[(1, R(0.5)), (1, R(-2147483648.0))]),
        ],
        ..FunctionRow::PLAIN
    },
];

fn add_in_place(message: &mut Value, constant: &Value, _: QueuePosition) -> bool {
    real_in_place(message, constant, |m, c| m + c)
}

fn subtract_in_place(message: &mut Value, constant: &Value, queue_position: QueuePosition) -> bool {
    real_in_place(message, constant, |m, c| if queue_position == QueuePosition::MessageFirst { m - c } else { c - m })
}

fn multiply_in_place(message: &mut Value, constant: &Value, queue_position: QueuePosition) -> bool {
    if let (Value::Matrix4(message), Value::Matrix4(constant)) = (&mut *message, constant) {
        let product = match queue_position {
            QueuePosition::MessageFirst => matrix_product(message, constant),
            QueuePosition::ConstantFirst => matrix_product(constant, message),
        };
        let finite = is_finite(&product);
        if finite {
            **message = product;
        }
        return finite;
    }
    real_in_place(message, constant, |m, c| m * c)
}

/// The product of glam's `b * a`, to the bit, without a call.
#[inline(always)]
fn matrix_product(a: &DMat4, b: &DMat4) -> DMat4 {
    let column = |v: DVec4| b.x_axis * v.x + b.y_axis * v.y + b.z_axis * v.z + b.w_axis * v.w;
    DMat4::from_cols(column(a.x_axis), column(a.y_axis), column(a.z_axis), column(a.w_axis))
}

/// Works out a real from two reals.
#[inline(always)]
fn real_in_place(message: &mut Value, constant: &Value, result: impl FnOnce(f64, f64) -> f64) -> bool {
    let (Value::Real(message), Value::Real(constant)) = (message, constant) else { return false };
    let result = result(*message, *constant);
    if result.is_finite() {
        *message = result;
    }
    result.is_finite()
}

fn add(f: &mut Firing) -> Result<(), Problem> {
    match f.reals() {
        Some((a, b)) => f.emit_real(1, a + b),
        None => add_any(f),
    }
}

#[inline(never)]
fn add_any(f: &mut Firing) -> Result<(), Problem> {
    match &mut sum(f.value(1), f.value(2)) {
        Some(sum) => f.emit_from(1, sum),
        None => Err(Problem::Mismatch),
    }
}

fn subtract(f: &mut Firing) -> Result<(), Problem> {
    match f.reals() {
        Some((a, b)) => f.emit_real(1, a - b),
        None => subtract_any(f),
    }
}

#[inline(never)]
fn subtract_any(f: &mut Firing) -> Result<(), Problem> {
    match &mut difference(f.value(1), f.value(2)) {
        Some(difference) => f.emit_from(1, difference),
        None => Err(Problem::Mismatch),
    }
}

fn multiply(f: &mut Firing) -> Result<(), Problem> {
    match f.reals() {
        Some((a, b)) => f.emit_real(1, a * b),
        None => multiply_any(f),
    }
}

#[inline(never)]
fn multiply_any(f: &mut Firing) -> Result<(), Problem> {
    // A matrix that leaves its queue takes the product into its own memory.
    if let Value::Matrix4(second) = f.value(2) {
        let second = **second;
        if let Some(first) = f.matrix4_mut(1) {
            *first = second * *first;
            return f.pass(1, 1);
        }
    }
    match &mut product(f.value(1), f.value(2)) {
        Some(product) => f.emit_from(1, product),
        None => Err(Problem::Mismatch),
    }
}

fn divide(f: &mut Firing) -> Result<(), Problem> {
    let quotient = match (f.value(1), f.value(2)) {
        (Value::Integer(_), Value::Integer(0)) => return Err(Problem::DivisionByZero),
        (Value::Integer(a), Value::Integer(b)) => Value::Integer(a.wrapping_div(*b)),
        (a, b) => {
            let divisor = b.number().ok_or(Problem::Kind(2))?;
            if divisor == 0.0 {
                return Err(Problem::DivisionByZero);
            }
            quotient(a, divisor).ok_or(Problem::Mismatch)?
        }
    };
    f.emit(1, quotient)
}

fn modulo(f: &mut Firing) -> Result<(), Problem> {
    let (dividend, divisor) = (f.integer(1)?, f.integer(2)?);
    if divisor == 0 {
        return Err(Problem::DivisionByZero);
    }
    f.emit(1, Value::Integer(dividend.wrapping_rem(divisor)))
}

fn to_integer(f: &mut Firing, rounding: fn(f64) -> f64) -> Result<(), Problem> {
    let rounded = rounding(f.number(1)?);
    if rounded < f64::from(i32::MIN) || rounded > f64::from(i32::MAX) {
        return Err(Problem::Range(1));
    }
    f.emit(1, Value::Integer(rounded as i32))
}
