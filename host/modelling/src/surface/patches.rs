//! Text files of bicubic Bezier patches over shared control points.

use std::ops::Range;

use glam::DVec3;

use super::BezierPatch;

/// The most control points of a file.
const MAX_POINTS: usize = 1 << 20;

/// Named groups of patches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchSet {
    /// The patches in the order of the file.
    pub patches: Vec<BezierPatch>,
    /// The groups: name, and which patches.
    pub parts: Vec<(String, Range<usize>)>,
}

/// A fault in a file of patches.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct PatchError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub problem: PatchProblem,
}

/// What can be wrong in a file of patches.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PatchProblem {
    /// Neither "vertices", "part", "patch" nor the line of a point.
    #[error("expected {expected}, found `{found}`")]
    Expected {
        /// What may stand here.
        expected: &'static str,
        /// What stands here.
        found: String,
    },
    /// A coordinate that is infinite or not a number.
    #[error("`{0}` is not a finite number")]
    Number(String),
    /// An index that no control point has.
    #[error("index {index} is outside 1..={count}")]
    Index {
        /// The index.
        index: String,
        /// Control points of the file.
        count: usize,
    },
    /// More control points than PERIS is built for.
    #[error("{0} control points, the limit is {MAX_POINTS}")]
    TooMany(usize),
    /// The text ends before all announced control points.
    #[error("ends after {found} of {announced} control points")]
    Ends {
        /// Points found.
        found: usize,
        /// Points announced.
        announced: usize,
    },
}

impl PatchSet {
    /// Understands the text: "vertices N" and N lines "x y z"; "part NAME"; "patch" and 16 indices from 1, row by row.
    /// "#" begins a comment.
    ///
    /// # Errors
    /// The first line that is wrong.
    pub fn parse(text: &str) -> Result<PatchSet, PatchError> {
        let mut set = PatchSet::default();
        let mut points: Vec<DVec3> = Vec::new();
        let mut announced = 0;
        let mut line = 0;
        for (index, full) in text.lines().enumerate() {
            line = index + 1;
            let content = full.split('#').next().unwrap_or_default().trim();
            if !content.is_empty() {
                set.line(content, &mut points, &mut announced).map_err(|problem| PatchError { line, problem })?;
            }
        }
        if points.len() < announced {
            return Err(PatchError { line, problem: PatchProblem::Ends { found: points.len(), announced } });
        }
        Ok(set)
    }

    fn line(&mut self, content: &str, points: &mut Vec<DVec3>, announced: &mut usize) -> Result<(), PatchProblem> {
        let expected = |expected| PatchProblem::Expected { expected, found: content.chars().take(60).collect() };
        let words: Vec<&str> = content.split_ascii_whitespace().collect();
        match words[..] {
            [x, y, z] if points.len() < *announced => points.push(DVec3::new(number(x)?, number(y)?, number(z)?)),
            _ if points.len() < *announced => return Err(expected("a control point: x y z")),
            ["vertices", count] => {
                let count: usize = count.parse().map_err(|_| expected("vertices COUNT"))?;
                *announced += count;
                if count > MAX_POINTS || *announced > MAX_POINTS {
                    return Err(PatchProblem::TooMany(count));
                }
            }
            ["part", name] => self.parts.push((name.to_owned(), self.patches.len()..self.patches.len())),
            ["patch", ref indices @ ..] if indices.len() == 16 => {
                let mut control = [[DVec3::ZERO; 4]; 4];
                for (k, word) in indices.iter().enumerate() {
                    let index = word.parse::<usize>().ok().and_then(|index| index.checked_sub(1));
                    let point = index.and_then(|index| points.get(index));
                    let outside = || PatchProblem::Index { index: (*word).to_owned(), count: points.len() };
                    control[k / 4][k % 4] = *point.ok_or_else(outside)?;
                }
                self.patches.push(BezierPatch::new(control));
                if let Some((_, range)) = self.parts.last_mut() {
                    range.end = self.patches.len();
                }
            }
            _ => return Err(expected("vertices COUNT, part NAME, or patch and 16 indices")),
        }
        Ok(())
    }
}

fn number(word: &str) -> Result<f64, PatchProblem> {
    let value = word.parse().ok().filter(|value: &f64| value.is_finite());
    value.ok_or_else(|| PatchProblem::Number(word.chars().take(60).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_name_their_line() {
        let fault = |text: &str| PatchSet::parse(text).unwrap_err().to_string();
        assert_eq!(fault("vertices 2 # two\n0 0 0\n"), "line 2: ends after 1 of 2 control points");
        assert_eq!(fault("vertices 1\n0 nan 0\n"), "line 2: `nan` is not a finite number");
        assert_eq!(fault("vertices 1\n0 0\n"), "line 2: expected a control point: x y z, found `0 0`");
        assert_eq!(
            fault("vertices 1\n0 0 0\n\npatch 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 2"),
            "line 4: index 2 is outside 1..=1"
        );
        assert_eq!(
            fault("vertices 1\n0 0 0\npatch 0 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1"),
            "line 3: index 0 is outside 1..=1"
        );
        assert_eq!(
            fault("patch 1 2"),
            "line 1: expected vertices COUNT, part NAME, or patch and 16 indices, found `patch 1 2`"
        );
        assert_eq!(fault("vertices 99999999"), "line 1: 99999999 control points, the limit is 1048576");
        assert!(fault("vertices 99999999999999999999").starts_with("line 1: expected vertices COUNT"));
    }
}
