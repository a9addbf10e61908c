//! Tables of spectra as text: a head of comments, names of the columns, and one line for each wavelength.

use super::{Beyond, ColorError, Spectrum};

/// Lines of numbers under a line of names; lines that begin with `#` are comments.
///
/// - Returns the names and, for each line, its first word and the numbers after it.
///
/// # Errors
/// [`ColorError::Line`] with the place.
fn rows(text: &str) -> Result<(Vec<&str>, Vec<Row<'_>>), ColorError> {
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    let mut lines = lines.filter(|(_, line)| !line.starts_with('#') && !line.trim().is_empty());
    let problem = |line, problem: String| ColorError::Line { line, problem };
    let (_, names) = lines.next().ok_or_else(|| problem(0, "there are no names of columns".into()))?;
    let names: Vec<&str> = names.split_whitespace().skip(1).collect();
    let mut rows = Vec::new();
    for (line, text) in lines {
        let mut words = text.split_whitespace();
        let first = words.next().unwrap_or_default();
        let numbers: Result<Vec<f64>, _> = words.map(str::parse).collect();
        let numbers = numbers.map_err(|error| problem(line, error.to_string()))?;
        if numbers.len() != names.len() {
            return Err(problem(line, format!("{} numbers under {} names", numbers.len(), names.len())));
        }
        rows.push(Row { line, first, numbers });
    }
    Ok((names, rows))
}

/// A line of a table.
pub(super) struct Row<'a> {
    line: usize,
    /// The first word.
    pub(super) first: &'a str,
    /// The numbers after it.
    pub(super) numbers: Vec<f64>,
}

/// The lines of a table whose first column holds names.
///
/// # Errors
/// [`ColorError::Line`] with the place.
pub(super) fn named_rows(text: &str) -> Result<Vec<Row<'_>>, ColorError> {
    rows(text).map(|(_, rows)| rows)
}

/// The names of the spectra of a table.
pub(super) fn names(text: &str) -> Vec<&str> {
    rows(text).map(|(names, _)| names).unwrap_or_default()
}

/// The spectra of a table whose first column holds wavelengths, nm; each with its name.
///
/// # Errors
/// [`ColorError::Line`] with the place, or another [`ColorError`] if the numbers are no spectra.
pub(super) fn spectra(text: &str, beyond: Beyond) -> Result<Vec<(&str, Spectrum)>, ColorError> {
    let (names, rows) = rows(text)?;
    let mut wavelengths = Vec::new();
    for row in &rows {
        let wavelength: Result<f64, _> = row.first.parse();
        wavelengths.push(wavelength.map_err(|_| ColorError::Line {
            line: row.line,
            problem: format!("\"{}\" is no wavelength", row.first),
        })?);
    }
    let step = wavelengths.get(1).zip(wavelengths.first()).map_or(0.0, |(second, first)| second - first);
    let is_regular = wavelengths.windows(2).all(|pair| pair[1] - pair[0] == step);
    let column = |(index, name)| {
        let values: Vec<f64> = rows.iter().map(|row| row.numbers[index]).collect();
        let spectrum = if is_regular && wavelengths.len() > 1 {
            Spectrum::regular(wavelengths[0], step, values, beyond)?
        } else {
            let samples: Vec<(f64, f64)> = wavelengths.iter().copied().zip(values).collect();
            Spectrum::irregular(&samples, beyond)?
        };
        Ok((name, spectrum))
    };
    names.into_iter().enumerate().map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_become_spectra() {
        let found = spectra("# head\nnm a b\n400 1 2\n410 3 4\n", Beyond::Held).expect("two spectra");
        assert_eq!(found.iter().map(|(name, s)| (*name, s.at(405.0))).collect::<Vec<_>>(), [("a", 2.0), ("b", 3.0)]);
    }

    #[test]
    fn a_wrong_line_is_named() {
        let line = |text: &str| match spectra(text, Beyond::Held) {
            Err(ColorError::Line { line, .. }) => line,
            other => panic!("{other:?}"),
        };
        assert_eq!(line("nm a\n400 1\n410 x\n"), 3);
        assert_eq!(line("nm a\n400 1 2\n"), 2);
        assert_eq!(line("# only\nnm a\nlong 1\n"), 3);
        assert_eq!(line(""), 0);
    }
}
