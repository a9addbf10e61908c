//! Tables of spectra as text: a head of comments, names of the columns, and one line for each wavelength.
//!
//! ```text
//! # What it is.
//! #
//! # Source: who measured it, where it was published.
//! # Terms: under which it may be passed on.
//! nm walnut oak
//! 400 0.031 0.082
//! 410 0.033 0.091
//! ```

use super::{ColorError, Extrapolation, Spectrum};

/// Lines of numbers under a line of names; lines that begin with `#` are comments.
///
/// - Returns the names and, for each line, its first word and the numbers after it.
///
/// # Errors
/// [`ColorError::Line`] with the place.
fn rows(text: &str) -> Result<(Vec<&str>, Vec<TableRow<'_>>), ColorError> {
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
        rows.push(TableRow { line, first, numbers });
    }
    Ok((names, rows))
}

/// A line of a table.
pub(super) struct TableRow<'a> {
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
pub(super) fn named_rows(text: &str) -> Result<Vec<TableRow<'_>>, ColorError> {
    rows(text).map(|(_, rows)| rows)
}

/// The origin of figures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// A description of the figures.
    pub what: String,
    /// Who measured them, where they were published.
    pub source: String,
    /// Under which terms they may be passed on.
    pub terms: String,
}

/// The origin that the head of a table tells; empty, where it tells nothing.
pub fn origin(text: &str) -> Origin {
    let mut origin = Origin::default();
    let (mut unused, mut place) = (String::new(), 0);
    for line in text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim) {
        let keys = ["Source:", "Terms:", "Samples:"];
        let key = keys.iter().position(|key| line.starts_with(key));
        place = key.map_or(place, |key| key + 1);
        let line = key.map_or(line, |key| line[keys[key].len()..].trim());
        let part = match place {
            0 => &mut origin.what,
            1 => &mut origin.source,
            2 => &mut origin.terms,
            _ => &mut unused,
        };
        if !line.is_empty() {
            part.push_str(if part.is_empty() { "" } else { " " });
            part.push_str(line);
        }
    }
    origin
}

/// The names of the spectra of a table.
pub(super) fn names(text: &str) -> Vec<&str> {
    rows(text).map(|(names, _)| names).unwrap_or_default()
}

/// The spectra of a table whose first column holds wavelengths, nm; each with its name.
///
/// # Errors
/// [`ColorError::Line`] with the place, or another [`ColorError`] if the numbers are no spectra.
pub fn spectra(text: &str, beyond: Extrapolation) -> Result<Vec<(&str, Spectrum)>, ColorError> {
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
    if let Some(twice) = names.iter().enumerate().find(|(index, name)| names[..*index].contains(name)) {
        return Err(ColorError::Line { line: 0, problem: format!("two columns are called \"{}\"", twice.1) });
    }
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

/// A table as text, which [`spectra`] reads to the last bit; none if the spectra are not over the same wavelengths.
///
/// - `spectra`: each with its name; what is white space in a name becomes an underscore.
pub fn print(origin: &Origin, spectra: &[(&str, &Spectrum)]) -> Option<String> {
    let wavelengths: Vec<f64> = spectra.first()?.1.samples().map(|(wavelength, _)| wavelength).collect();
    let is_same = |spectrum: &Spectrum| spectrum.samples().map(|(w, _)| w).eq(wavelengths.iter().copied());
    if !spectra.iter().all(|(_, spectrum)| is_same(spectrum)) {
        return None;
    }
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut text = String::new();
    for (key, value) in [("", &origin.what), ("Source: ", &origin.source), ("Terms: ", &origin.terms)] {
        if !value.trim().is_empty() {
            text.push_str(&format!("# {key}{}\n", one_line(value)));
        }
    }
    text.push_str("nm");
    for (name, _) in spectra {
        text.push_str(&format!(" {}", name.split_whitespace().collect::<Vec<_>>().join("_")));
    }
    let columns: Vec<Vec<f64>> = spectra.iter().map(|(_, s)| s.samples().map(|(_, value)| value).collect()).collect();
    for (row, wavelength) in wavelengths.iter().enumerate() {
        text.push_str(&format!("\n{wavelength}"));
        columns.iter().for_each(|column| text.push_str(&format!(" {}", column[row])));
    }
    Some(text + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_become_spectra() {
        let found = spectra("# head\nnm a b\n400 1 2\n410 3 4\n", Extrapolation::Held).expect("two spectra");
        assert_eq!(found.iter().map(|(name, s)| (*name, s.at(405.0))).collect::<Vec<_>>(), [("a", 2.0), ("b", 3.0)]);
    }

    #[test]
    fn a_wrong_line_is_named() {
        let line = |text: &str| match spectra(text, Extrapolation::Held) {
            Err(ColorError::Line { line, .. }) => line,
            other => panic!("{other:?}"),
        };
        assert_eq!(line("nm a\n400 1\n410 x\n"), 3);
        assert_eq!(line("nm a\n400 1 2\n"), 2);
        assert_eq!(line("# only\nnm a\nlong 1\n"), 3);
        assert_eq!(line(""), 0);
    }

    #[test]
    fn the_head_tells_where_the_figures_come_from() {
        let text =
            "# What it\n# is.\n#\n# Source: who,\n# where.\n# Terms: free.\n# Samples: a: b.\nnm a\n400 1\n410 2\n";
        let origin = origin(text);
        assert_eq!([&*origin.what, &*origin.source, &*origin.terms], ["What it is.", "who, where.", "free."]);
        assert_eq!(super::origin("nm a\n# Source: none\n"), Origin::default());
    }

    #[test]
    fn a_printed_table_is_read_to_the_last_bit() {
        let wave = |f: f64| (0..40).map(|i| (f * f64::from(i)).sin() / 3.0).collect::<Vec<f64>>();
        let one = Spectrum::regular(380.0, 10.0, wave(0.1), Extrapolation::Held).expect("a spectrum");
        let two = Spectrum::regular(380.0, 10.0, wave(0.7), Extrapolation::Held).expect("a spectrum");
        let origin = Origin { what: "waves".into(), source: "a\nsine".into(), terms: "free".into() };
        let text = print(&origin, &[("one", &one), ("number two", &two)]).expect("the same wavelengths");
        assert_eq!(spectra(&text, Extrapolation::Held).expect("a table"), [("one", one.clone()), ("number_two", two)]);
        assert_eq!(super::origin(&text), Origin { source: "a sine".into(), ..origin.clone() });
        assert_eq!(print(&origin, &[("one", &one), ("d65", &super::super::shipped::D65)]), None);
    }

    #[test]
    fn two_columns_of_a_name_are_refused() {
        assert!(spectra("nm a a\n400 1 2\n410 3 4\n", Extrapolation::Held).is_err());
    }
}
