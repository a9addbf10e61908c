//! Addresses of all lines of the workstation, with their conditions: `pty:,speed=9600,flow=xonxoff`.

use super::{Address, AddressError};
use std::{fmt, path::PathBuf, str::FromStr};

/// Slowest line, in bits a second.
const MIN_SPEED: u32 = 50;
/// Fastest line with a speed of its own, in bits a second.
const MAX_SPEED: u32 = 1_000_000_000;
/// Speed of a serial device that is not given, in bits a second.
const DEFAULT_BAUD: u32 = 9600;

/// A line of the workstation: where hosts attach, and how it behaves.
///
/// ```
/// use protocol::address::{Endpoint, LineAddress};
/// let line: LineAddress = "pty:,speed=9600,flow=xonxoff".parse().unwrap();
/// assert_eq!((line.endpoint, line.conditions.speed), (Endpoint::Pty(None), Some(9600)));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineAddress {
    /// Where it is.
    pub endpoint: Endpoint,
    /// How it behaves.
    pub conditions: Conditions,
}

/// Where a line is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// `tcp:HOST:PORT` or `unix:PATH`: hosts connect.
    Socket(Address),
    /// `parallel:HOST:PORT`: hosts connect to the parallel interface over TCP.
    Parallel(String),
    /// `pty:`: a pseudo-terminal that the workstation opens. With a path: where it is.
    Pty(Option<PathBuf>),
    /// `serial:DEVICE[,BAUD[,8N1]]`.
    Serial(Serial),
    /// `stdio:`: the standard streams of the process.
    Stdio,
    /// `file:PATH`: plays a file, captured or plain, as a host would send it.
    File {
        /// The file.
        path: PathBuf,
        /// `pace=captured`: at the times of the capture, instead of as fast as it goes.
        timed: bool,
    },
}

/// A serial device and its settings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Serial {
    /// The device.
    pub device: PathBuf,
    /// Bits a second.
    pub baud: u32,
    /// 7 or 8.
    pub data_bits: u8,
    /// The bit after the data.
    pub parity: Parity,
    /// 1 or 2.
    pub stop_bits: u8,
}

/// The parity bit of a serial line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// `N`: there is none.
    None,
    /// `E`: the number of ones is even with it.
    Even,
    /// `O`: the number of ones is odd with it.
    Odd,
}

impl Parity {
    const LETTERS: [(Parity, char); 3] = [(Parity::None, 'N'), (Parity::Even, 'E'), (Parity::Odd, 'O')];
}

/// How a line behaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Conditions {
    /// `speed=N`: bits a second in each direction, ten bits a byte; none for as fast as it goes.
    pub speed: Option<u32>,
    /// `flow=xonxoff`: both sides stop and start each other with XOFF and XON, which are no data then.
    pub flow: bool,
    /// `bits=7`: the highest bit of each byte is lost, in both directions.
    pub seven_bits: bool,
}

/// A text that is no address of a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LineAddressError {
    /// No known kind, or nothing after it.
    #[error(
        "'{0}' is no line; give tcp:HOST:PORT, unix:PATH, pty:, serial:DEVICE[,BAUD[,8N1]], stdio:, file:PATH or \
         parallel:HOST:PORT"
    )]
    NoLine(String),
    /// A part that is missing or cannot be.
    #[error("'{part}' in '{address}': give {expected}")]
    Part {
        /// The address as it was given.
        address: String,
        /// What is wrong in it.
        part: String,
        /// What should stand there.
        expected: &'static str,
    },
    /// An option with a value that it cannot have.
    #[error("'{option}' of a line: give {expected}")]
    Value {
        /// The option as it was given.
        option: String,
        /// What it can be.
        expected: &'static str,
    },
    /// An option that the line does not have.
    #[error("'{option}' is no option of {kind}:")]
    NotFor {
        /// The option as it was given.
        option: String,
        /// The kind of line.
        kind: String,
    },
}

/// The options, each with the values that it can have.
const OPTIONS: [(&str, &str); 4] = [
    ("speed", "speed=BITS_A_SECOND from 50 to 1000000000, or speed=unlimited"),
    ("flow", "flow=xonxoff or flow=none"),
    ("bits", "bits=7 or bits=8"),
    ("pace", "pace=captured or pace=unlimited"),
];

impl FromStr for LineAddress {
    type Err = LineAddressError;

    fn from_str(text: &str) -> Result<LineAddress, LineAddressError> {
        let none = || LineAddressError::NoLine(text.to_string());
        // Options stand at the end, so that a path may hold commas.
        let (mut address, mut options) = (text, Vec::new());
        while let Some((before, option)) = address.rsplit_once(',')
            && let Some((key, value)) = option.split_once('=')
            && let Some((_, expected)) = OPTIONS.iter().find(|row| row.0 == key)
        {
            address = before;
            options.push((option, key, value, *expected));
        }
        let (kind, rest) = address.split_once(':').ok_or_else(none)?;
        let part = |(part, expected): (&str, _)| LineAddressError::Part {
            address: text.to_string(),
            part: part.to_string(),
            expected,
        };
        let socket = |error| match error {
            AddressError::Part { part: wrong, expected, .. } => part((&wrong, expected)),
            AddressError::NoAddress(_) => none(),
        };
        let mut place = match (kind, rest) {
            ("tcp" | "unix", _) => Endpoint::Socket(address.parse().map_err(socket)?),
            ("parallel", at) => match format!("tcp:{at}").parse().map_err(socket)? {
                Address::Tcp(at) => Endpoint::Parallel(at),
                Address::Unix(_) => return Err(none()),
            },
            ("pty", path) => Endpoint::Pty((!path.is_empty()).then(|| path.into())),
            ("serial", device) => Endpoint::Serial(serial(device).map_err(part)?),
            ("stdio", "") => Endpoint::Stdio,
            ("stdio", rest) => return Err(part((rest, "nothing behind 'stdio:'"))),
            ("file", "") => return Err(part((text, "the path of a file"))),
            ("file", path) => Endpoint::File { path: path.into(), timed: false },
            _ => return Err(none()),
        };
        let mut conditions = Conditions::default();
        for (option, key, value, expected) in options.into_iter().rev() {
            let wrong = || LineAddressError::Value { option: option.to_string(), expected };
            match (key, value, &mut place) {
                ("pace", "captured" | "unlimited", Endpoint::File { timed, .. }) => *timed = value == "captured",
                ("pace", _, Endpoint::File { .. }) => return Err(wrong()),
                ("speed" | "flow" | "bits", _, Endpoint::Parallel(_)) | ("pace", _, _) => {
                    return Err(LineAddressError::NotFor { option: option.to_string(), kind: kind.to_string() });
                }
                ("speed", "unlimited", _) => conditions.speed = None,
                ("speed", number, _) => {
                    let speed = number.parse().ok().filter(|speed| (MIN_SPEED..=MAX_SPEED).contains(speed));
                    conditions.speed = Some(speed.ok_or_else(wrong)?);
                }
                ("flow", "xonxoff" | "none", _) => conditions.flow = value == "xonxoff",
                ("bits", "7" | "8", _) => conditions.seven_bits = value == "7",
                _ => return Err(wrong()),
            }
        }
        Ok(LineAddress { endpoint: place, conditions })
    }
}

/// `DEVICE[,BAUD[,8N1]]`. An error is the part that is wrong, and what it should be.
fn serial(text: &str) -> Result<Serial, (&str, &'static str)> {
    const FRAME: &str =
        "8N1 or the like: 7 or 8 data bits, parity N (none), E (even) or O (odd), 1 or 2 stop bits; it stands last";
    let mut parts = text.splitn(3, ',');
    let device = parts.next().unwrap_or_default();
    if device.is_empty() {
        return Err((text, "a device before the speed, such as serial:/dev/ttyS0"));
    }
    let baud = match parts.next() {
        Some(baud) => {
            let read = baud.parse().ok().filter(|baud| (MIN_SPEED..=MAX_SPEED).contains(baud));
            read.ok_or((baud, "the speed in bits a second, 50 to 1000000000, such as 9600"))?
        }
        None => DEFAULT_BAUD,
    };
    let frame = parts.next().unwrap_or("8N1");
    let characters: Vec<char> = frame.chars().collect();
    let &[data_bits @ ('7' | '8'), parity, stop_bits @ ('1' | '2')] = characters.as_slice() else {
        return Err((frame, FRAME));
    };
    let parity = Parity::LETTERS.iter().find(|row| row.1 == parity.to_ascii_uppercase()).ok_or((frame, FRAME))?.0;
    let digit = |c: char| c as u8 - b'0';
    Ok(Serial { device: device.into(), baud, data_bits: digit(data_bits), parity, stop_bits: digit(stop_bits) })
}

impl fmt::Display for LineAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.endpoint)?;
        let Conditions { speed, flow, seven_bits } = self.conditions;
        if let Some(speed) = speed {
            write!(f, ",speed={speed}")?;
        }
        if flow {
            f.write_str(",flow=xonxoff")?;
        }
        if seven_bits { f.write_str(",bits=7") } else { Ok(()) }
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Endpoint::Socket(address) => write!(f, "{address}"),
            Endpoint::Parallel(at) => write!(f, "parallel:{at}"),
            Endpoint::Pty(path) => write!(f, "pty:{}", path.as_deref().unwrap_or("".as_ref()).display()),
            Endpoint::Serial(Serial { device, baud, data_bits, parity, stop_bits }) => {
                let letter = Parity::LETTERS.iter().find(|row| row.0 == *parity).map_or('N', |row| row.1);
                write!(f, "serial:{},{baud},{data_bits}{letter}{stop_bits}", device.display())
            }
            Endpoint::Stdio => f.write_str("stdio:"),
            Endpoint::File { path, timed } => {
                write!(f, "file:{}{}", path.display(), if *timed { ",pace=captured" } else { "" })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_lines_read_back() {
        for text in [
            "tcp:127.0.0.1:3400",
            "unix:/tmp/a,b",
            "unix:/tmp/a=b,speed=300",
            "pty:",
            "pty:/dev/pts/3,speed=9600,flow=xonxoff,bits=7",
            "serial:/dev/ttyS0,19200,7E2",
            "serial:/dev/ttyS0,9600,8O1,flow=xonxoff",
            "stdio:",
            "file:a,b.cap,pace=captured",
            "file:x,speed=1000000",
            "parallel:[::1]:0",
        ] {
            assert_eq!(text.parse::<LineAddress>().map(|line| line.to_string()), Ok(text.to_string()));
        }
        let serial: LineAddress = "serial:/dev/ttyS0".parse().unwrap();
        assert_eq!(serial.to_string(), "serial:/dev/ttyS0,9600,8N1");
        let plain: LineAddress = "pty:,speed=unlimited,flow=none,bits=8".parse().unwrap();
        assert_eq!(plain.to_string(), "pty:");
    }

    #[test]
    fn what_is_no_line_is_told() {
        for text in ["", "x", "udp:a:1"] {
            let error = text.parse::<LineAddress>();
            assert_eq!(error, Err(LineAddressError::NoLine(text.into())), "{text}");
        }
        for (text, wrong, allowed) in [
            ("serial:", "", "a device"),
            ("serial:a,b", "b", "50 to 1000000000"),
            ("serial:a,9600,9N1", "9N1", "7 or 8 data bits"),
            ("serial:a,9600,8N1,x", "8N1,x", "it stands last"),
            ("serial:a,9600,8X1,speed=300", "8X1", "parity N"),
            ("stdio:x", "x", "nothing"),
            ("file:", "file:", "path"),
            ("tcp:a:70000", "70000", "a port from 0 to 65535"),
            ("parallel:a", "a", "HOST:PORT"),
        ] {
            let error = text.parse::<LineAddress>().unwrap_err();
            assert!(matches!(&error, LineAddressError::Part { part, .. } if part == wrong), "{text}: {error}");
            assert!(error.to_string().contains(allowed), "{error}");
        }
        for option in ["speed=0", "speed=fast", "flow=rts", "bits=9"] {
            let error = format!("pty:,{option}").parse::<LineAddress>();
            assert!(matches!(error, Err(LineAddressError::Value { option: told, .. }) if told == option));
        }
        for text in ["parallel:a:1,speed=300", "pty:,pace=captured"] {
            assert!(matches!(text.parse::<LineAddress>(), Err(LineAddressError::NotFor { .. })), "{text}");
        }
        assert!(matches!("file:a,pace=slow".parse::<LineAddress>(), Err(LineAddressError::Value { .. })));
    }
}
