//! Transformed data: asked from a node of the structure, and written as commands.

use super::{Example, FunctionRow, Source, printing::decimal};
use crate::port::{
    Effect, Firing, KindSet,
    Literal::{S, T},
    PortSpec, Problem,
};
use glam::DMat4;
use protocol::{Name, Value};

/// Significant digits of F:LIST. Four such numbers and their marks always fit the [`MAX_LINE`] of clients.
pub const DIGITS: usize = 11;

/// Longest line that clients of the time read, in bytes. [S]
pub const MAX_LINE: usize = 80;

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "XFORMDATA",
        summary: "the accumulated matrix at an XFORM node, at the next update",
        source: Source::confirmed("clients use <1>, <2> and the output; <3> to <5>, for vector lists, are kept unused"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger"),
            PortSpec::constant(KindSet::STRING, "path of the XFORM node"),
            PortSpec::optional(KindSet::STRING, "name of the destination"),
            PortSpec::optional(KindSet::INTEGER, "first index"),
            PortSpec::optional(KindSet::INTEGER, "count"),
        ],
        outputs: &["transformed data"],
        behaviour: |f| {
            let node = Name::new(f.string(2)?.trim_ascii()).map_err(|_| Problem::Range(2))?;
            f.effect(Effect::RequestTransform { function: f.object(), node });
            Ok(())
        },
        examples: &[Example::of(&[(2, S("1X")), (1, S(""))], &[]).faults(&[6])],
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
    let Value::Transform(matrix) = f.value(1) else { return Err(Problem::Kind(1)) };
    for line in lines(matrix) {
        f.emit(1, Value::string(line))?;
    }
    Ok(())
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
