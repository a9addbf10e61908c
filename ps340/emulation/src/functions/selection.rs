//! Transformed data and colour: asked from a node of the structure, joined, and written as commands.

use super::{Family, FunctionExample, FunctionRow, Source, printing::decimal};
use crate::port::{
    Effect, Firing, KindSet,
    Literal::{I, R, S, T, Vectors},
    PortSpec, Problem,
};
use glam::DMat4;
use protocol::{
    Name, Value,
    value::{TransformedVectors, VectorEnd},
};
use std::sync::Arc;

/// Significant digits of F:LIST. Four such numbers and their marks always fit the [`MAX_LINE`] of clients.
pub const DIGITS: usize = 11;

/// Longest line that clients of the time read, in bytes. Confirmed.
pub const MAX_LINE: usize = 80;

/// Most vectors in one piece of transformed data. Ours.
pub const MAX_VECTORS: usize = 1 << 18;

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "XFORMDATA",
        summary: "the accumulated matrix at an XFORM MATRIX node, or the vectors below an XFORM VECTOR node, at the next \
                  update",
        source: Source::confirmed(
            "clients use <1>, <2> and the output; the meaning of <3> to <5> is uncertain, and that <4> and <5> only \
             count for vectors is ours",
        ),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger"),
            PortSpec::constant(KindSet::STRING, "path of the XFORM node"),
            PortSpec::optional(KindSet::STRING, "name that becomes an object with the data; blank for none"),
            PortSpec::optional(KindSet::INTEGER, "number of the first vector, 1 at first"),
            PortSpec::optional(KindSet::INTEGER, "how many vectors, all at first"),
        ],
        outputs: &["transformed data"],
        behaviour: request,
        examples: &[
            FunctionExample::of(&[(2, S("R001.MXFORM1")), (1, I(0))], &[]),
            FunctionExample::of(&[(2, S("1X")), (1, S(""))], &[]).faults(&[6]),
            FunctionExample::of(&[(2, S("X")), (3, S("*")), (1, I(1))], &[]).faults(&[6]),
            FunctionExample::of(&[(2, S("X")), (4, I(0)), (1, I(1)), (4, I(1)), (5, I(-1)), (1, I(1))], &[])
                .faults(&[6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LIST",
        summary: "transformed data as the text of a command, one message a line",
        source: Source::confirmed(
            "a heading, then four rows after a byte that is skipped, the last ends with ';'; the form for vectors is \
             remembered",
        ),
        inputs: &[PortSpec::active(KindSet::TRANSFORM, "transformed data")],
        outputs: &["lines"],
        behaviour: |f| {
            let lines = lines(f.value(1)).ok_or(Problem::Kind(1))?;
            lines.into_iter().try_for_each(|line| f.emit(1, Value::string(line)))
        },
        examples: &[
            FunctionExample::of(
                &[(1, T([[1.0, 0.0, 0.0, 0.0], [0.0, 0.5, -0.25, 0.0], [0.0, 0.0, 1.0, 0.0], [1e5, -3.0, 1e-9, 1.0]]))],
                &[
                    (1, S("MATRIX_4X4")),
                    (1, S(" 1,0,0,0")),
                    (1, S(" 0,0.5,-0.25,0")),
                    (1, S(" 0,0,1,0")),
                    (1, S(" 100000,-3,1E-09,1;")),
                ],
            ),
            FunctionExample::of(
                &[(1, Vectors(&[(false, [0.0; 3]), (true, [1.0, -0.5, 1e-9])])), (1, Vectors(&[]))],
                &[
                    (1, S("VECTOR_LIST ITEMIZED N=2")),
                    (1, S("P 0,0,0")),
                    (1, S("L 1,-0.5,1E-09;")),
                    (1, S("VECTOR_LIST ITEMIZED N=0;")),
                ],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CONCATXDATA",
        summary: "n transformed vectors as one list",
        source: Source::manual("vectors only; a matrix is a fault. More than 262144 vectors are a fault: ours"),
        inputs: &[PortSpec::active(KindSet::VECTORS, "vectors")],
        outputs: &["the vectors in order"],
        family: Family::Inputs,
        behaviour: concatenate,
        examples: &[
            FunctionExample::of(
                &[(2, Vectors(&[(false, [2.0; 3]), (true, [3.0; 3])])), (1, Vectors(&[(false, [1.0; 3])]))],
                &[(1, Vectors(&[(false, [1.0; 3]), (false, [2.0; 3]), (true, [3.0; 3])]))],
            )
            .sized(2),
            FunctionExample::of(
                &[(1, T([[1.0; 4]; 4])), (1, Vectors(&[])), (2, Vectors(&[(false, [1.0; 3])]))],
                &[(1, Vectors(&[(false, [1.0; 3])]))],
            )
            .sized(2)
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "COLOR",
        summary: "hue and saturation for the inputs <1> and <2> of SET COLOR",
        source: Source::uncertain("the hue wraps at 360 degrees, the saturation is limited: ours"),
        inputs: &[
            PortSpec::active(KindSet::NUMBER, "hue, degrees, 0 is blue"),
            PortSpec::default(KindSet::NUMBER, R(1.0), "saturation, 0 white to 1 pure"),
        ],
        outputs: &["hue, 0 to 360", "saturation, 0 to 1"],
        behaviour: |f| {
            let (hue, saturation) = (f.number(1)?.rem_euclid(360.0), f.number(2)?.clamp(0.0, 1.0));
            f.emit(1, Value::Real(hue))?;
            f.emit(2, Value::Real(saturation))
        },
        examples: &[
            FunctionExample::of(&[(1, I(120))], &[(1, R(120.0)), (2, R(1.0))]),
            FunctionExample::of(
                &[(2, I(3)), (1, R(-30.0)), (2, R(-1.0)), (1, R(360.0))],
                &[(1, R(330.0)), (2, R(1.0)), (1, R(0.0)), (2, R(0.0))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
];

fn request(f: &mut Firing) -> Result<(), Problem> {
    let name = |f: &Firing, input: u16| Name::new(f.string(input)?.trim_ascii()).map_err(|_| Problem::Range(input));
    let node = name(f, 2)?;
    let given = match f.optional(3) {
        Some(_) => !f.string(3)?.trim_ascii().is_empty(),
        None => false,
    };
    let destination = if given { Some(name(f, 3)?) } else { None };
    let first = match f.optional(4) {
        Some(_) => u32::try_from(f.integer(4)?).ok().filter(|first| *first > 0).ok_or(Problem::Range(4))?,
        None => 1,
    };
    let count = match f.optional(5) {
        Some(_) => u32::try_from(f.integer(5)?).map_err(|_| Problem::Range(5))?,
        None => u32::MAX,
    };
    f.effect(Effect::RequestTransform { function: f.object(), node, destination, first, count });
    Ok(())
}

fn concatenate(f: &mut Firing) -> Result<(), Problem> {
    let mut ends: Vec<VectorEnd> = Vec::new();
    for input in 1..=f.size() {
        let Value::Vectors(vectors) = f.value(input) else { return Err(Problem::Kind(input)) };
        if ends.len() + vectors.ends.len() > MAX_VECTORS {
            return Err(Problem::TooLong);
        }
        ends.extend_from_slice(&vectors.ends);
    }
    f.emit(1, Value::Vectors(Arc::new(TransformedVectors { ends })))
}

/// Transformed data as the text of a command, line by line; none for other values.
///
/// After `name := ` the joined lines make an object with the data.
pub fn lines(data: &Value) -> Option<Vec<String>> {
    match data {
        Value::Transform(matrix) => Some(matrix_lines(matrix).into()),
        Value::Vectors(vectors) => Some(vector_lines(vectors)),
        _ => None,
    }
}

/// A matrix as the command MATRIX_4X4, in five lines.
///
/// # Source
/// Clients of the time read five messages, skip the first byte of each row and read four reals from it.
fn matrix_lines(matrix: &DMat4) -> [String; 5] {
    let row = |i: usize, end: &str| {
        let numbers = matrix.col(i).to_array().map(|number| decimal(number, DIGITS));
        format!(" {}{end}", numbers.join(","))
    };
    ["MATRIX_4X4".into(), row(0, ""), row(1, ""), row(2, ""), row(3, ";")]
}

/// Vectors as the command VECTOR_LIST, a heading and a line for each vector.
fn vector_lines(vectors: &TransformedVectors) -> Vec<String> {
    let mut lines = vec![format!("VECTOR_LIST ITEMIZED N={}", vectors.ends.len())];
    lines.extend(vectors.ends.iter().map(|end| {
        let numbers = end.point.to_array().map(|number| decimal(number, DIGITS));
        format!("{} {}", if end.line { 'L' } else { 'P' }, numbers.join(","))
    }));
    if let Some(last) = lines.last_mut() {
        last.push(';');
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use protocol::command::CommandReader;

    #[test]
    fn a_listed_matrix_reads_back_and_its_lines_are_short() {
        let mut numbers = [0.0; 16];
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = -(10_f64.powi(40 * (i as i32 % 13) - 250)) / 7.0;
        }
        let matrix = DMat4::from_cols_array(&numbers);
        let lines = matrix_lines(&matrix);
        assert!(lines.iter().all(|line| line.len() <= MAX_LINE), "{lines:?}");
        let text = lines[1..].concat();
        let back: Vec<f64> = text
            .trim_end_matches(';')
            .split([',', ' '])
            .filter(|t| !t.is_empty())
            .map(|t| t.parse().unwrap())
            .collect();
        assert_eq!(back.len(), 16);
        for (a, b) in back.iter().zip(numbers) {
            assert!((a - b).abs() <= 1e-10 * b.abs(), "{a} {b}");
        }
    }

    #[test]
    fn listed_data_after_a_name_is_a_command() {
        let far = DVec3::splat(-1.234_567_890_123e-100);
        let vectors = (0..5).map(|i| VectorEnd { line: i % 2 == 1, point: far * f64::from(i) }).collect();
        let vectors = Value::Vectors(Arc::new(TransformedVectors { ends: vectors }));
        for data in [vectors, Value::Transform(Box::new(DMat4::from_scale(far)))] {
            let lines = lines(&data).unwrap();
            assert!(lines.iter().all(|line| line.len() <= MAX_LINE), "{lines:?}");
            let mut reader = CommandReader::default();
            reader.push(format!("A := {}", lines.join(" ")).as_bytes());
            assert!(reader.next().unwrap().is_ok(), "{lines:?}");
        }
        assert_eq!(lines(&Value::Integer(1)), None);
    }
}
