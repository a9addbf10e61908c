//! Printing: values as text that a program of the time can read.
//!
//! Numbers are readable by a FORTRAN list-directed READ: no leading blank, no comma inside, `E` before an exponent.
//! A real has at most nine significant digits, trailing zeros left out: as many as the machine's own
//! single-precision format needs to be read back exactly.

use super::{FunctionExample, FunctionRow, Source};
use crate::port::{
    KindSet,
    Literal::{B, I, Label, M2, M3, M4, M43, Pick, R, S, T, V2, V3, V4, Vectors},
    PickLiteral, PortSpec, Problem,
};
use protocol::{Value, value::MAX_STRING};

/// Significant digits of a real in F:PRINT.
pub const DIGITS: usize = 9;

const PICKED: PickLiteral = PickLiteral {
    index: 3,
    identifiers: &["I00F", "GROUP"],
    node: "WORLD.DATA",
    type_code: 1,
    point: None,
    parameter: None,
};

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[FunctionRow {
    name: "PRINT",
    summary: "the value as text",
    source: Source::confirmed(
        "integers without a leading blank, V before a vector; digits, matrices, pick lists, labels are ours",
    ),
    inputs: &[
        PortSpec::active(KindSet::ANY, "value"),
        PortSpec::default(KindSet::BOOLEAN, B(false), "TRUE: reals with an exponent"),
    ],
    outputs: &["string"],
    behaviour: |f| {
        let text = print(f.value(1), f.boolean(2)?);
        if text.len() > MAX_STRING {
            return Err(Problem::TooLong);
        }
        f.emit(1, Value::String(text.into()))
    },
    examples: &[
        FunctionExample::of(&[(1, I(1)), (1, I(-20)), (1, R(20.0))], &[(1, S("1")), (1, S("-20")), (1, S("20"))]),
        FunctionExample::of(&[(1, V2([0.25, -0.125]))], &[(1, S("V 0.25,-0.125"))]),
        FunctionExample::of(&[(1, V3([1e-7, 1e9, -0.0]))], &[(1, S("V 1E-07,1E+09,0"))]),
        FunctionExample::of(&[(1, S("I001")), (1, B(true))], &[(1, S("I001")), (1, S("TRUE"))]),
        FunctionExample::of(&[(2, B(true)), (1, R(-0.15)), (1, I(3))], &[(1, S("-1.5E-01")), (1, S("3"))]),
        FunctionExample::of(&[(1, M2([[1.0, 0.0], [0.5, 2.0]]))], &[(1, S("M 1,0 0.5,2"))]),
        FunctionExample::of(
            &[
                (1, V4([1.0, 2.0, 3.0, 0.5])),
                (1, M3([[1.0; 3]; 3])),
                (1, M43([[1.0; 3], [2.0; 3], [3.0; 3], [4.0; 3]])),
            ],
            &[(1, S("V 1,2,3,0.5")), (1, S("M 1,1,1 1,1,1 1,1,1")), (1, S("M 1,1,1 2,2,2 3,3,3 4,4,4"))],
        ),
        FunctionExample::of(
            &[(1, M4([[0.5; 4]; 4])), (1, T([[2.0; 4]; 4]))],
            &[
                (1, S("M 0.5,0.5,0.5,0.5 0.5,0.5,0.5,0.5 0.5,0.5,0.5,0.5 0.5,0.5,0.5,0.5")),
                (1, S("M 2,2,2,2 2,2,2,2 2,2,2,2 2,2,2,2")),
            ],
        ),
        FunctionExample::of(
            &[(1, Pick(PICKED)), (1, Label([1.0, 2.0, 0.0], "A", true))],
            &[(1, S("3 I00F,GROUP WORLD.DATA")), (1, S("V 1,2,0 TRUE A"))],
        ),
        FunctionExample::of(
            &[(1, Vectors(&[(false, [0.0; 3]), (true, [1.0, 0.0, 0.5])]))],
            &[(1, S("VECTOR_LIST ITEMIZED N=2 P 0,0,0 L 1,0,0.5"))],
        ),
        FunctionExample::of(
            &[(2, B(true)), (1, V2([10.0, 0.0])), (1, S("TEXT"))],
            &[(1, S("V 1E+01,0E+00")), (1, S("TEXT"))],
        ),
    ],
    ..FunctionRow::PLAIN
}];

/// The text of a value.
///
/// - `exponential`: reals as `-1.5E-01` instead of `-0.15`.
pub fn print(value: &Value, exponential: bool) -> Vec<u8> {
    let real = |number: f64| if exponential { scientific(number, DIGITS) } else { decimal(number, DIGITS) };
    let list = |numbers: &[f64]| numbers.iter().map(|&n| real(n)).collect::<Vec<_>>().join(",");
    let rows = |rows: &[&[f64]]| format!("M {}", rows.iter().map(|row| list(row)).collect::<Vec<_>>().join(" "));
    match value {
        Value::Boolean(b) => if *b { "TRUE" } else { "FALSE" }.into(),
        Value::Integer(i) => i.to_string().into(),
        Value::Real(r) => real(*r).into(),
        Value::String(text) => text.to_vec(),
        Value::Vector2(v) => format!("V {}", list(&v.to_array())).into(),
        Value::Vector3(v) => format!("V {}", list(&v.to_array())).into(),
        Value::Vector4(v) => format!("V {}", list(&v.to_array())).into(),
        Value::Matrix2(m) => rows(&m.to_cols_array_2d().each_ref().map(|row| &row[..])).into(),
        Value::Matrix3(m) => rows(&m.to_cols_array_2d().each_ref().map(|row| &row[..])).into(),
        Value::Matrix4x3(m) => rows(&m.to_cols_array_2d().each_ref().map(|row| &row[..3])).into(),
        Value::Matrix4(m) | Value::Transform(m) => rows(&m.to_cols_array_2d().each_ref().map(|row| &row[..])).into(),
        Value::Pick(pick) => pick.to_string().into(),
        Value::Label(label) => {
            let on = if label.on { "TRUE" } else { "FALSE" };
            let mut text = format!("V {} {on} ", list(&label.position.to_array())).into_bytes();
            text.extend_from_slice(&label.text);
            text
        }
        Value::Vectors(vectors) => {
            let mut text = format!("VECTOR_LIST ITEMIZED N={}", vectors.ends.len());
            for end in &vectors.ends {
                text.push_str(if end.line { " L " } else { " P " });
                text.push_str(&list(&end.point.to_array()));
            }
            text.into()
        }
    }
}

/// A real without an exponent where it is short so, such as `-0.125` or `100000`, else as [`scientific`].
///
/// - `number`: finite.
/// - `digits`: significant digits, at least 1; trailing zeros are left out.
pub fn decimal(number: f64, digits: usize) -> String {
    let (negative, mantissa, exponent) = parts(number, digits);
    if !(-5..digits as i32).contains(&exponent) {
        return scientific(number, digits);
    }
    let mut text = String::from(if negative { "-" } else { "" });
    if exponent < 0 {
        text.push_str("0.");
        text.extend(std::iter::repeat_n('0', (-exponent - 1) as usize));
        text.push_str(&mantissa);
        return text;
    }
    let whole = exponent as usize + 1;
    if mantissa.len() <= whole {
        text.push_str(&mantissa);
        text.extend(std::iter::repeat_n('0', whole - mantissa.len()));
    } else {
        text.push_str(&mantissa[..whole]);
        text.push('.');
        text.push_str(&mantissa[whole..]);
    }
    text
}

/// A real with an exponent of at least two digits, such as `-1.5E-01`.
///
/// - `number`: finite.
/// - `digits`: significant digits, at least 1; trailing zeros are left out.
pub fn scientific(number: f64, digits: usize) -> String {
    let (negative, mantissa, exponent) = parts(number, digits);
    let sign = if negative { "-" } else { "" };
    let point = if mantissa.len() > 1 { "." } else { "" };
    let exponent_sign = if exponent < 0 { '-' } else { '+' };
    format!("{sign}{}{point}{}E{exponent_sign}{:02}", &mantissa[..1], &mantissa[1..], exponent.abs())
}

/// Sign, significant digits without trailing zeros, and the power of ten of the first digit.
fn parts(number: f64, digits: usize) -> (bool, String, i32) {
    let text = format!("{:.*e}", digits.max(1) - 1, number.abs());
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let significant: String = mantissa.chars().filter(|c| *c != '.').collect();
    let significant = significant.trim_end_matches('0');
    if significant.is_empty() {
        return (false, "0".into(), 0);
    }
    (number < 0.0, significant.into(), exponent.parse().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_reals_read_back_to_nine_digits_at_any_scale() {
        let mut number = 1.234_567_891_234e-300;
        while number < 1e300 {
            for signed in [number, -number] {
                for text in [decimal(signed, DIGITS), scientific(signed, DIGITS)] {
                    let back: f64 = text.parse().unwrap();
                    assert!((back - signed).abs() <= 5e-9 * signed.abs(), "{text}");
                    assert!(text.len() <= 16 && !text.contains(',') && !text.starts_with(' '), "{text}");
                }
            }
            number *= 7.3;
        }
    }

    #[test]
    fn round_numbers_are_short() {
        for (number, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1e5, "100000"),
            (123456789.0, "123456789"),
            (1234567890.0, "1.23456789E+09"),
            (0.1 + 0.2, "0.3"),
            (-0.00001, "-0.00001"),
            (0.000001, "1E-06"),
            (999_999_999.9, "1E+09"),
        ] {
            assert_eq!(decimal(number, DIGITS), text);
        }
        assert_eq!(scientific(0.0, DIGITS), "0E+00");
    }

    #[test]
    fn the_locator_message_fits_forty_bytes() {
        let worst = print(&V2([-1.234_567_89e-105, -1.234_567_89e-105]).value(), true);
        assert!(worst.len() < 40, "{}", worst.len());
    }
}
