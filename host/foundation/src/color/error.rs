//! Errors of spectra and colours.

/// A reason for which there is no spectrum or no colour.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ColorError {
    /// A spectrum needs two samples and more.
    #[error("a spectrum of {0} samples: it needs two and more")]
    TooFew(usize),
    /// A wavelength is not positive, or not greater than the one before.
    #[error("sample {index}: the wavelength {wavelength} nm is not positive, or not above the one before")]
    Wavelength {
        /// Index of the sample, from 0.
        index: usize,
        /// Its wavelength, nm.
        wavelength: f64,
    },
    /// A value is not a number.
    #[error("the value at {wavelength} nm is not finite")]
    NotFinite {
        /// The wavelength, nm.
        wavelength: f64,
    },
    /// No spectrum is known for this temperature.
    #[error("a temperature of {kelvin} K: it must lie between {least} and {most} K")]
    Temperature {
        /// The temperature, K.
        kelvin: f64,
        /// The lowest, K.
        least: f64,
        /// The highest, K.
        most: f64,
    },
    /// A formula does not hold at this wavelength.
    #[error("{name}: no index is known at {wavelength} nm, only from {from} to {to} nm")]
    OutOfRange {
        /// The name of the formula.
        name: String,
        /// The wavelength, nm.
        wavelength: f64,
        /// The shortest, nm.
        from: f64,
        /// The longest, nm.
        to: f64,
    },
    /// A formula that is none.
    #[error("{name}: its coefficients are not finite, or hold nowhere")]
    Formula {
        /// The name of the formula.
        name: String,
    },
    /// A colour is not three finite numbers.
    #[error("the colour {0} is not finite")]
    Color(glam::DVec3),
    /// Nothing of this name ships with the program.
    #[error("no {kind} is called \"{name}\"; {advice}")]
    Unknown {
        /// The kind of what was looked for.
        kind: &'static str,
        /// Its name.
        name: String,
        /// Names that it may have meant, or the names that there are.
        advice: String,
    },
    /// A line of a table cannot be read.
    #[error("line {line}: {problem}")]
    Line {
        /// The number of the line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
}
