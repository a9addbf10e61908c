//! Who does what a case asks of a person at the machine.

use super::compare::glob_matches;
use protocol::address::Address;
use std::{
    io::{self, BufRead, BufReader, Read, Write},
    net::TcpStream,
    os::unix::net::UnixStream,
    time::Duration,
};

/// How long the operator line may take to answer.
const REPLY_TIMEOUT: Duration = Duration::from_secs(60);

/// The environment variable with the token of an emulator whose operator line is TCP.
const TOKEN_VARIABLE: &str = "PS340_TOKEN";

/// The reason why an operator command was not carried out.
#[derive(Debug, thiserror::Error)]
pub enum OperatorFault {
    /// The machine refused.
    #[error("the order was refused: {0}")]
    Refused(String),
    /// This operator cannot do it: the case is skipped.
    #[error("{0}")]
    Beyond(&'static str),
    /// The operator line failed.
    #[error("the operator line failed: {0}")]
    Line(#[from] io::Error),
}

/// Someone at the machine.
pub trait Operator {
    /// Does something; returns what is to be seen.
    ///
    /// # Errors
    /// [`OperatorFault`].
    fn give(&mut self, order: &str) -> Result<String, OperatorFault>;

    /// Whether what was seen is like a pattern.
    fn confirm(&mut self, reply: &str, glob: &str) -> bool;

    /// Whether the operator command `frames N` makes time pass; if not, it passes by itself.
    fn drives_time(&self) -> bool;
}

/// The operator line of an emulator: one operator command a line, one reply a line.
pub struct OperatorLine {
    reader: BufReader<Box<dyn Read + Send>>,
    writer: Box<dyn Write + Send>,
}

impl std::fmt::Debug for OperatorLine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OperatorLine").finish_non_exhaustive()
    }
}

impl OperatorLine {
    /// Connects, and sends the token of the environment variable `PS340_TOKEN`, if there is one.
    ///
    /// # Errors
    /// Those of the system.
    pub fn connect(address: &Address) -> io::Result<OperatorLine> {
        let mut line = OperatorLine::open(address)?;
        if let Ok(token) = std::env::var(TOKEN_VARIABLE) {
            line.give(&format!("token {token}")).map_err(io::Error::other)?;
        }
        Ok(line)
    }

    fn open(address: &Address) -> io::Result<OperatorLine> {
        let (reader, writer): (Box<dyn Read + Send>, Box<dyn Write + Send>) = match address {
            Address::Tcp(at) => {
                let stream = TcpStream::connect(at.as_str())?;
                stream.set_nodelay(true)?;
                stream.set_read_timeout(Some(REPLY_TIMEOUT))?;
                (Box::new(stream.try_clone()?), Box::new(stream))
            }
            Address::Unix(path) => {
                let stream = UnixStream::connect(path)?;
                stream.set_read_timeout(Some(REPLY_TIMEOUT))?;
                (Box::new(stream.try_clone()?), Box::new(stream))
            }
        };
        Ok(OperatorLine { reader: BufReader::new(reader), writer })
    }
}

impl Operator for OperatorLine {
    fn give(&mut self, order: &str) -> Result<String, OperatorFault> {
        self.writer.write_all(format!("{order}\n").as_bytes())?;
        let mut line = String::new();
        if self.reader.read_line(&mut line)? == 0 {
            return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
        }
        understood(line.trim_end_matches(['\r', '\n']))
    }

    fn confirm(&mut self, reply: &str, glob: &str) -> bool {
        glob_matches(glob, reply)
    }

    fn drives_time(&self) -> bool {
        true
    }
}

/// What a reply line says.
///
/// # Errors
/// [`OperatorFault::Refused`] if it is no `ok`.
pub fn understood(reply: &str) -> Result<String, OperatorFault> {
    match reply.strip_prefix("ok") {
        Some(text) if text.is_empty() || text.starts_with(' ') => Ok(unescaped(text.trim_start())),
        _ => Err(OperatorFault::Refused(reply.into())),
    }
}

/// Line ends and backslashes of a reply.
fn unescaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut characters = text.chars();
    while let Some(c) = characters.next() {
        match c {
            '\\' => match characters.next() {
                Some('n') => out.push('\n'),
                Some('r') => out.push('\r'),
                Some(other) => out.push(other),
                None => {}
            },
            c => out.push(c),
        }
    }
    out
}

/// A person who reads on the terminal what to do, and is asked what is to be seen.
#[derive(Debug, Default)]
pub struct Person;

impl Operator for Person {
    fn give(&mut self, order: &str) -> Result<String, OperatorFault> {
        let answer = ask(&format!("Please do: {order}\nThen press RETURN (or s RETURN to skip the case): "))?;
        if answer.trim() == "s" { Err(OperatorFault::Beyond("skipped by the person")) } else { Ok(String::new()) }
    }

    fn confirm(&mut self, _: &str, glob: &str) -> bool {
        ask(&format!("Is something like '{glob}' to be seen? (y or n) ")).is_ok_and(|a| a.trim().starts_with('y'))
    }

    fn drives_time(&self) -> bool {
        false
    }
}

fn ask(question: &str) -> io::Result<String> {
    let mut out = io::stderr().lock();
    out.write_all(question.as_bytes())?;
    out.flush()?;
    let mut answer = String::new();
    if io::stdin().lock().read_line(&mut answer)? == 0 {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(answer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replies_are_read_back() {
        assert_eq!(understood("ok a\\nb\\\\n").unwrap(), "a\nb\\n");
        assert_eq!(understood("ok").unwrap(), "");
        assert!(matches!(understood("error no"), Err(OperatorFault::Refused(_))));
    }
}
