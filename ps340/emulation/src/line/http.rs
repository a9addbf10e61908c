//! Request lines of HTTP: whoever sends one, such as a page in a browser, takes the machine for something else.
//!
//! CONNECT and DELETE begin commands of the machine and requests of HTTP alike. What distinguishes a request is the
//! whole line: `METHOD target HTTP/1.1`, which is no command.

/// Bytes of a line that may be a request line; longer ones are none.
const MAX_LINE: usize = 8192;

/// Whether a line, without its end, is a request: a word, a target, and a version of HTTP, one blank apart.
pub(super) fn is_request(line: &[u8]) -> bool {
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    let mut words = line.split(|byte| *byte == b' ');
    let (method, target, version, rest) = (words.next(), words.next(), words.next(), words.next());
    let is_method =
        |word: &[u8]| !word.is_empty() && word.iter().all(|byte| byte.is_ascii_alphabetic() || *byte == b'-');
    let is_version = |word: &[u8]| {
        let number = word.strip_prefix(b"HTTP/");
        number.is_some_and(|number| !number.is_empty() && number.iter().all(|b| b.is_ascii_digit() || *b == b'.'))
    };
    method.is_some_and(is_method)
        && target.is_some_and(|target| !target.is_empty())
        && version.is_some_and(is_version)
        && rest.is_none()
}

/// Whether what a line begins with is a method and the beginning of a path, which is no command.
fn begins_request(line: &[u8]) -> bool {
    let blank = line.iter().position(|byte| *byte == b' ');
    blank.is_some_and(|at| at >= 3 && line[..at].iter().all(u8::is_ascii_uppercase) && line.get(at + 1) == Some(&b'/'))
}

/// Looks for request lines in a stream, wherever that is cut.
///
/// A request begins what is sent on a connection. There, a line that can only become a request is held back until it
/// ends, so that nothing of its path is taken for a command.
#[derive(Debug, Default)]
pub(super) struct RequestDetector {
    /// The current line as far as it is there, up to [`MAX_LINE`] bytes and one more.
    line: Vec<u8>,
    /// Whether a line has ended that was not empty.
    has_begun: bool,
    /// The bytes of the current line that are held back.
    held: Vec<u8>,
}

impl RequestDetector {
    /// Takes the next bytes, and leaves those that may pass. Returns whether a request line ends in them; then the
    /// bytes of that line and all after it do not pass.
    pub(super) fn finds_request(&mut self, bytes: &mut Vec<u8>) -> bool {
        if !self.held.is_empty() {
            self.line.truncate(self.line.len() - self.held.len());
            let mut all = std::mem::take(&mut self.held);
            all.append(bytes);
            *bytes = all;
        }
        let mut begin = 0;
        while let Some(length) = memchr::memchr(b'\n', &bytes[begin..]) {
            self.grow(&bytes[begin..begin + length]);
            if self.line.len() <= MAX_LINE && is_request(&self.line) {
                bytes.truncate(begin);
                return true;
            }
            self.has_begun |= !self.line.trim_ascii().is_empty();
            self.line.clear();
            begin += length + 1;
        }
        self.grow(&bytes[begin..]);
        if !self.has_begun && self.line.len() <= MAX_LINE && begins_request(&self.line) {
            self.held = bytes.split_off(begin);
        }
        false
    }

    fn grow(&mut self, bytes: &[u8]) {
        let room = (MAX_LINE + 1).saturating_sub(self.line.len());
        self.line.extend_from_slice(&bytes[..bytes.len().min(room)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What passes of a stream that comes in pieces of some size, and whether a request ended it.
    fn passed_bytes(stream: &[u8], piece: usize) -> (Vec<u8>, bool) {
        let (mut watch, mut all) = (RequestDetector::default(), Vec::new());
        for piece in stream.chunks(piece) {
            let mut bytes = piece.to_vec();
            let found = watch.finds_request(&mut bytes);
            all.extend(bytes);
            if found {
                return (all, true);
            }
        }
        (all, false)
    }

    #[test]
    fn request_lines_are_told_from_commands() {
        for line in [
            "GET / HTTP/1.1",
            "POST /a;b HTTP/1.0\r",
            "CONNECT a:1 HTTP/1.1",
            "DELETE * HTTP/2.0",
            "M-SEARCH * HTTP/1.1",
        ] {
            assert!(is_request(line.as_bytes()), "{line}");
        }
        for line in [
            "",
            "GET",
            "GET /",
            "GET / HTTP/",
            "GET / HTTP/1.1 ",
            " GET / HTTP/1.1",
            "GET  HTTP/1.1",
            "CONNECT a<1>:<1>b;",
            "DELETE x;",
            "POST := F:NOP;",
            "SEND 'GET / HTTP/1.1' TO <1>X;",
            "{ GET / HTTP/1.1",
        ] {
            assert!(!is_request(line.as_bytes()), "{line}");
        }
    }

    #[test]
    fn commands_pass_at_any_cut_as_they_come() {
        let stream = b"CONNECT a<1>:<1>b;DELETE x;\nPOST := F:NOP; DELETE /\nHTTP/1.1\nCONNECT a<1>:<1>b;";
        for piece in 1..=stream.len() {
            assert_eq!(passed_bytes(stream, piece), (stream.to_vec(), false), "{piece}");
        }
        let mut watch = RequestDetector::default();
        for byte in b"CONNECT a<1>:<1>b;" {
            let mut bytes = vec![*byte];
            assert!(!watch.finds_request(&mut bytes) && bytes == [*byte], "it does not wait for the end of the line");
        }
    }

    #[test]
    fn nothing_of_a_request_that_begins_a_connection_passes() {
        for request in
            ["POST /;INITIALIZE; HTTP/1.1\r\nHost: a\r\n\r\nINITIALIZE;", "\r\nGET / HTTP/1.0\nINITIALIZE;\n"]
        {
            for piece in 1..=request.len() {
                let (bytes, found) = passed_bytes(request.as_bytes(), piece);
                // A method alone is the beginning of a command as well.
                let method = bytes.trim_ascii();
                let is_harmless = method.iter().all(u8::is_ascii_uppercase) && method.len() <= 4;
                assert!(found && is_harmless, "{request:?} in pieces of {piece}: {bytes:?}");
            }
        }
    }

    #[test]
    fn a_request_later_ends_the_stream_too() {
        let stream = b"A := F:NOP;\nGET / HTTP/1.1\nDELETE A;\n";
        for piece in 1..=stream.len() {
            let (bytes, found) = passed_bytes(stream, piece);
            assert!(found && bytes.starts_with(b"A := F:NOP;\n") && !bytes.ends_with(b"A;\n"), "{piece}");
        }
    }

    #[test]
    fn a_line_that_is_too_long_for_a_request_passes() {
        let mut stream = b"GET /".to_vec();
        stream.resize(3 * MAX_LINE, b'a');
        for piece in [1000, MAX_LINE, 3 * MAX_LINE] {
            assert_eq!(passed_bytes(&stream, piece), (stream.clone(), false));
        }
    }
}
