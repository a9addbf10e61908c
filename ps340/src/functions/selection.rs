//! Picking and transformed data: asked from the display structure, taken apart, and written as commands.

use super::{Example, Family, FunctionRow, Source, names::name, printing::decimal};
use crate::port::{
    Effect, Firing, KindSet,
    Literal::{B, I, S, T},
    PortSpec, Problem,
};
use glam::DMat4;
use protocol::{
    Name, Value,
    value::{MAX_STRING, VectorData},
};
use std::sync::Arc;

/// Significant digits of F:LIST. Four such numbers and their marks always fit the [`MAX_LINE`] of clients.
pub const DIGITS: usize = 11;

/// Most vectors in one message of transformed data. Ours.
pub const MAX_VECTORS: usize = 1 << 20;

/// Longest line that clients of the time read, in bytes. [S]
pub const MAX_LINE: usize = 80;

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "XFORMDATA",
        summary: "the accumulated matrix or the vectors at an XFORM node, at the next update",
        source: Source::confirmed("clients use <1>, <2> and the output; <3> to <5> are uncertain"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger"),
            PortSpec::constant(KindSet::STRING, "path of the XFORM node"),
            PortSpec::optional(KindSet::STRING, "name that gets the data as its definition"),
            PortSpec::optional(KindSet::INTEGER, "first vector, from 1"),
            PortSpec::optional(KindSet::INTEGER, "number of vectors"),
        ],
        outputs: &["transformed data"],
        behaviour: |f| {
            let node = name(f, 2)?;
            let whole = |input: u16| f.optional(input).map(|_| f.integer(input)).transpose();
            let vectors = [whole(4)?, whole(5)?];
            let destination = f.optional(3).map(|_| name(f, 3)).transpose()?;
            f.effect(Effect::RequestTransform { function: f.object(), node, destination, vectors });
            Ok(())
        },
        examples: &[Example::of(&[(2, S("1X")), (1, S(""))], &[]).faults(&[6])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PICK",
        summary: "what is drawn first inside the pick box",
        source: Source::confirmed(
            "clients trigger it with the place of the stylus and take the pick list; <3> and output 2 are uncertain",
        ),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger; a 2D vector is the centre of the pick box"),
            PortSpec::default(KindSet::BOOLEAN, B(false), "TRUE: the picked point too"),
            PortSpec::default(KindSet::INTEGER, I(1), "updates that are tried before nothing counts as hit"),
        ],
        outputs: &["pick list", "FALSE if nothing was hit"],
        behaviour: |f| {
            let at = f.vector2(1).ok();
            let coordinates = f.boolean(2)?;
            let frames = u32::try_from(f.integer(3)?).ok().filter(|n| *n > 0).ok_or(Problem::Range(3))?;
            f.effect(Effect::RequestPick { function: f.object(), at, coordinates, frames });
            Ok(())
        },
        examples: &[Example::of(&[(3, I(0)), (1, B(true))], &[]).faults(&[6])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PICKINFO",
        summary: "a pick list taken apart",
        source: Source::confirmed(
            "nine outputs, the second the identifiers; what the others give is remembered or ours",
        ),
        inputs: &[
            PortSpec::active(KindSet::PICK, "pick list"),
            PortSpec::constant(KindSet::INTEGER, "how many identifiers at most leave from output 2"),
        ],
        outputs: &[
            "index of the vector, character, label or polygon",
            "identifiers, nearest first, with commas",
            "picked point, 2D or 3D, if coordinates were picked",
            "its dimension",
            "whether coordinates were picked",
            "kind of data: 1 vectors, 2 curve, 3 characters, 4 labels, 5 polygons",
            "name of the data node, empty if it has none",
            "parameter of a curve, if coordinates were picked",
            "identifiers beyond <2>, if there are any",
        ],
        behaviour: pick_info,
        examples: &[Example::of(&[(2, I(1)), (1, B(true))], &[]).faults(&[5])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CONCATXDATA",
        summary: "the transformed vectors of n inputs joined",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::VECTORS, "transformed vectors")],
        outputs: &["transformed vectors"],
        family: Family::Inputs,
        behaviour: join_vectors,
        examples: &[Example::of(&[(1, I(1))], &[]).sized(2).faults(&[5])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LIST",
        summary: "transformed data as the text of a command, one message a line",
        source: Source::confirmed("a heading, then four rows after a byte that is skipped, the last ends with ';'"),
        inputs: &[PortSpec::active(KindSet::TRANSFORM, "transformed data")],
        outputs: &["lines"],
        behaviour: list,
        examples: &[Example::of(
            &[(1, T([[1.0, 0.0, 0.0, 0.0], [0.0, 0.5, -0.25, 0.0], [0.0, 0.0, 1.0, 0.0], [1e5, -3.0, 1e-9, 1.0]]))],
            &[
                (1, S("MATRIX_4X4")),
                (1, S(" 1,0,0,0")),
                (1, S(" 0,0.5,-0.25,0")),
                (1, S(" 0,0,1,0")),
                (1, S(" 100000,-3,1E-09,1;")),
            ],
        )],
        ..FunctionRow::PLAIN
    },
];

fn list(f: &mut Firing) -> Result<(), Problem> {
    let lines = match f.value(1) {
        Value::Transform(matrix) => lines(matrix).into(),
        Value::Vectors(data) => vector_lines(data),
        _ => return Err(Problem::Kind(1)),
    };
    lines.into_iter().try_for_each(|line| f.emit(1, Value::string(line)))
}

/// Vectors as the command VECTOR_LIST: a heading, then one line a vector, the last with a `;`.
pub fn vector_lines(data: &VectorData) -> Vec<String> {
    let mut lines = vec![format!("VECTOR_LIST ITEMIZED N={}", data.points.len())];
    lines.extend(data.points.iter().zip(&data.lines).map(|(point, line)| {
        let numbers = point.to_array().map(|number| decimal(number, DIGITS));
        format!("{} {}", if *line { 'L' } else { 'P' }, numbers.join(","))
    }));
    if let Some(last) = lines.last_mut() {
        last.push(';');
    }
    lines
}

/// Sends what is known of a pick from nine outputs; what is not known leaves nothing.
fn pick_info(f: &mut Firing) -> Result<(), Problem> {
    let Value::Pick(picked) = f.take(1) else { return Err(Problem::Kind(1)) };
    let depth = usize::try_from(f.integer(2)?).map_err(|_| Problem::Range(2))?;
    let join = |names: &[Name]| {
        let mut text = names.iter().map(Name::as_str).collect::<Vec<_>>().join(",");
        text.truncate(MAX_STRING);
        Value::string(text)
    };
    let (near, far) = picked.identifiers.split_at(depth.min(picked.identifiers.len()));
    f.emit(1, Value::Integer(picked.index))?;
    f.emit(2, join(near))?;
    if let Some(place) = picked.place {
        let point =
            if place.dimension == 2 { Value::Vector2(place.point.truncate()) } else { Value::Vector3(place.point) };
        f.emit(3, point)?;
        f.emit(4, Value::Integer(place.dimension.into()))?;
    }
    f.emit(5, Value::Boolean(picked.place.is_some()))?;
    f.emit(6, Value::Integer(picked.code))?;
    f.emit(7, Value::string(&picked.node))?;
    if let Some(parameter) = picked.place.and_then(|place| place.parameter) {
        f.emit(8, Value::Real(parameter))?;
    }
    if far.is_empty() { Ok(()) } else { f.emit(9, join(far)) }
}

/// Joins the vectors of all inputs.
fn join_vectors(f: &mut Firing) -> Result<(), Problem> {
    let mut joined = VectorData::default();
    for input in 1..=f.size() {
        let Value::Vectors(data) = f.value(input) else { return Err(Problem::Kind(input)) };
        if joined.points.len() + data.points.len() > MAX_VECTORS {
            return Err(Problem::TooLong);
        }
        joined.points.extend_from_slice(&data.points);
        joined.lines.extend_from_slice(&data.lines);
    }
    f.emit(1, Value::Vectors(Arc::new(joined)))
}

/// A matrix as the command MATRIX_4X4, in five lines.
///
/// # Source
/// Clients of the time read five messages, skip the first byte of each row and read four reals from it.
pub fn lines(matrix: &DMat4) -> [String; 5] {
    let row = |i: usize, end: &str| {
        let numbers = matrix.col(i).to_array().map(|number| decimal(number, DIGITS));
        format!(" {}{end}", numbers.join(","))
    };
    ["MATRIX_4X4".into(), row(0, ""), row(1, ""), row(2, ""), row(3, ";")]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_listed_matrix_reads_back_and_its_lines_are_short() {
        let mut numbers = [0.0; 16];
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = -(10_f64.powi(40 * (i as i32 % 13) - 250)) / 7.0;
        }
        let matrix = DMat4::from_cols_array(&numbers);
        let lines = lines(&matrix);
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
}
