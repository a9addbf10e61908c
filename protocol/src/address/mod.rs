//! Addresses of lines: sockets, which both sides can name, and all lines of the workstation.

mod line;

pub use line::{Conditions, Endpoint, LineAddress, LineAddressError, Parity, Serial};

use std::{fmt, path::PathBuf, str::FromStr};

/// Where a line is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// `HOST:PORT`; port 0 takes a free one.
    Tcp(String),
    /// The path of a Unix socket.
    Unix(PathBuf),
}

/// A text that is no address.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AddressError {
    /// No known kind.
    #[error("'{0}' is no address; give tcp:HOST:PORT or unix:PATH")]
    NoAddress(String),
    /// A part that is missing or cannot be.
    #[error("'{part}' in '{address}': give {expected}")]
    Part {
        /// The whole text.
        address: String,
        /// What is wrong in it.
        part: String,
        /// What should stand there.
        expected: &'static str,
    },
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Address, AddressError> {
        let error = || AddressError::NoAddress(text.to_string());
        let (kind, rest) = text.split_once(':').ok_or_else(error)?;
        let wrong = |part: &str, expected| {
            Err(AddressError::Part { address: text.to_string(), part: part.to_string(), expected })
        };
        match (kind, rest.rsplit_once(':')) {
            ("tcp", None) => wrong(rest, "HOST:PORT, such as 127.0.0.1:3400"),
            ("tcp", Some(("", _))) => wrong(rest, "a host before the port, such as 127.0.0.1"),
            ("tcp", Some((_, port))) if port.parse::<u16>().is_err() => {
                wrong(port, "a port from 0 to 65535; 0 takes a free one")
            }
            ("tcp", Some(_)) => Ok(Address::Tcp(rest.to_string())),
            ("unix", _) if rest.is_empty() => wrong(text, "the path of a socket"),
            ("unix", _) => Ok(Address::Unix(rest.into())),
            _ => Err(error()),
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Address::Tcp(at) => write!(f, "tcp:{at}"),
            Address::Unix(path) => write!(f, "unix:{}", path.display()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_read_back() {
        for text in ["tcp:127.0.0.1:3400", "tcp:[::1]:0", "unix:/tmp/a:b"] {
            assert_eq!(text.parse::<Address>().unwrap().to_string(), text);
        }
        for text in ["", "tcp", "tcp:x", "tcp::1", "tcp:a:70000", "unix:", "udp:a:1"] {
            assert!(text.parse::<Address>().is_err(), "{text}");
        }
    }

    #[test]
    fn the_part_that_is_wrong_is_told() {
        for (text, told) in [
            ("tcp:a:70000", "'70000' in 'tcp:a:70000': give a port from 0 to 65535; 0 takes a free one"),
            ("tcp:x", "'x' in 'tcp:x': give HOST:PORT, such as 127.0.0.1:3400"),
            ("tcp::1", "':1' in 'tcp::1': give a host before the port, such as 127.0.0.1"),
            ("udp:a:1", "'udp:a:1' is no address; give tcp:HOST:PORT or unix:PATH"),
        ] {
            assert_eq!(text.parse::<Address>().unwrap_err().to_string(), told);
        }
    }
}
