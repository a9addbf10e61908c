//! The reply to an operator command.

/// The reply line for a result: `ok`, `ok TEXT` or `error TEXT`, without the line end.
pub fn reply(result: &Result<String, String>) -> String {
    let (word, text) = match result {
        Ok(text) => ("ok", text),
        Err(text) => ("error", text),
    };
    let escaped = text.replace('\\', "\\\\").replace('\r', "\\r").replace('\n', "\\n");
    if escaped.is_empty() { word.to_string() } else { format!("{word} {escaped}") }
}
