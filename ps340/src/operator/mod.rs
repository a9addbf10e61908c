//! What a person at the machine does, as a text protocol: one order a line, one reply a line.
//!
//! A reply begins with `ok` or `error`. Line ends inside a reply are written `\n`.

mod graph;
mod inspect;
mod order;
mod perform;
mod sight;

pub use graph::{Language, Subject, title};
pub use inspect::{Inspection, brief};
pub use order::{Order, OrderError, OrderRow, Screen, parse, rows, unescape};
pub use perform::{Outcome, Wait, perform};
pub use sight::SightOrder;

/// The reply line for a result: `ok`, `ok TEXT` or `error TEXT`, without the line end.
pub fn reply(result: &Result<String, String>) -> String {
    let (word, text) = match result {
        Ok(text) => ("ok", text),
        Err(text) => ("error", text),
    };
    let escaped = text.replace('\\', "\\\\").replace('\r', "\\r").replace('\n', "\\n");
    if escaped.is_empty() { word.to_string() } else { format!("{word} {escaped}") }
}

#[cfg(test)]
mod tests;
