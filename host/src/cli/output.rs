//! Text for standard output, which nobody may be reading any more, and for standard error.
//!
//! Texts may come from a script or a file of somebody else: characters that would command the terminal are shown as
//! escapes.

use super::exit::Exit;
use super::progress;
use crate::memory;
use serde_json::Value;
use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};
use std::{borrow::Cow, fmt::Arguments, io, io::Write};

/// The lines of standard error that are not said again; none while lines may be.
static SAID: Mutex<Option<HashSet<String>>> = Mutex::new(None);

/// Writes to standard output. When the reader has gone, as in `peris ... | head`, the program ends quietly.
pub(super) fn write(text: Arguments<'_>) {
    progress::clear();
    let mut out = std::io::stdout().lock();
    if out.write_all(escaped(&text.to_string()).as_bytes()).and_then(|()| out.flush()).is_err() {
        std::process::exit(Exit::Done as i32);
    }
}

/// Writes bytes to standard output. When the reader has gone, the program ends quietly.
///
/// # Errors
/// [`io::Error`], as of a full disk.
pub(super) fn write_bytes(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(bytes).and_then(|()| out.flush());
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => std::process::exit(Exit::Done as i32),
        written => written,
    }
}

/// From now on, a line on standard error is not said again: of the frames of an animation, most would say the same.
pub(super) fn say_errors_once() {
    SAID.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_default();
}

/// Writes a line to standard error.
pub(super) fn write_error(text: &str) {
    let is_new = |said: &mut HashSet<String>| said.insert(text.to_owned());
    if !SAID.lock().unwrap_or_else(PoisonError::into_inner).as_mut().is_none_or(is_new) {
        return;
    }
    progress::clear();
    eprintln!("{}", escaped(text));
}

/// Says on standard error what is probably not meant.
pub(super) fn warn(text: &str) {
    write_error(&format!("warning: {text}"));
}

/// A text whose control characters are escapes, but for the ends of lines and tabulators.
fn escaped(text: &str) -> Cow<'_, str> {
    let is_control = |c: char| c.is_control() && c != '\n' && c != '\t';
    if !text.contains(is_control) {
        return text.into();
    }
    text.chars()
        .fold(String::with_capacity(text.len()), |mut shown, c| {
            if is_control(c) {
                shown.extend(c.escape_default())
            } else {
                shown.push(c)
            }
            shown
        })
        .into()
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

/// Writes an object as one line of JSON, for commands that tell of one thing after the other.
pub(super) fn report_line(known: &Value) {
    write(format_args!("{known}\n"));
}

/// How often what is told before is placed, for the end of an enumeration; nothing without instances.
pub(super) fn of_instances(count: usize) -> String {
    if count == 0 { String::new() } else { format!(", {count} instances") }
}

/// Writes a line to standard output.
macro_rules! say {
    ($($text:tt)*) => {
        $crate::cli::output::write(format_args!("{}\n", format_args!($($text)*)))
    };
}

/// Writes text to standard output without ending the line.
macro_rules! say_on {
    ($($text:tt)*) => {
        $crate::cli::output::write(format_args!($($text)*))
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_command_a_terminal_is_shown_as_an_escape() {
        assert_eq!(escaped("a\tb\nc ä"), "a\tb\nc ä");
        assert_eq!(escaped("\x1b[2J\u{9b}31m\r\x07"), "\\u{1b}[2J\\u{9b}31m\\r\\u{7}");
    }
}
