//! Text for standard output that nobody may be reading any more.

use super::{Exit, progress};
use std::{fmt::Arguments, io::Write};

/// Writes to standard output. When the reader has gone, as in `peris ... | head`, the program ends quietly.
pub(super) fn write(text: Arguments<'_>) {
    progress::clear();
    let mut out = std::io::stdout().lock();
    if out.write_fmt(text).and_then(|()| out.flush()).is_err() {
        std::process::exit(Exit::Done as i32);
    }
}

/// Writes a line to standard output.
macro_rules! say {
    ($($text:tt)*) => {
        $crate::cli::say::write(format_args!("{}\n", format_args!($($text)*)))
    };
}

/// Writes text to standard output without ending the line.
macro_rules! say_on {
    ($($text:tt)*) => {
        $crate::cli::say::write(format_args!($($text)*))
    };
}
