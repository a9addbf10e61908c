//! Text for standard output that nobody may be reading any more.

use super::{Exit, progress};
use crate::memory;
use serde_json::Value;
use std::{fmt::Arguments, io::Write};

/// Writes to standard output. When the reader has gone, as in `peris ... | head`, the program ends quietly.
pub(super) fn write(text: Arguments<'_>) {
    progress::clear();
    let mut out = std::io::stdout().lock();
    if out.write_fmt(text).and_then(|()| out.flush()).is_err() {
        std::process::exit(Exit::Done as i32);
    }
}

/// Writes what `--json` asks for: what a command found, one object or several, and the most memory that it held.
pub(super) fn report(mut known: Value) {
    let objects = match &mut known {
        Value::Array(several) => several.as_mut_slice(),
        one => std::slice::from_mut(one),
    };
    for object in objects.iter_mut().filter_map(Value::as_object_mut) {
        object.insert("peak_memory_bytes".into(), memory::peak().into());
    }
    write(format_args!("{known:#}\n"));
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
