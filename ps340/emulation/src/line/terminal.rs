//! Terminals: pseudo-terminals that the machine opens, and serial devices.

use protocol::address::{Parity, Serial};
use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    fs::{Mode, OFlags, open},
    io::Errno,
    pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt},
    termios::{ControlModes, InputModes, OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr},
};
use std::{
    ffi::OsStr,
    io,
    os::{
        fd::{AsFd, OwnedFd},
        unix::ffi::OsStrExt,
    },
    path::PathBuf,
    pin::Pin,
    task::{Context, Poll},
};
use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    net::unix::pipe,
};

/// A terminal that is open, as a stream of bytes.
#[derive(Debug)]
pub(super) struct TerminalStream {
    // To the system a terminal that does not wait is read and written as a pipe is.
    read: pipe::Receiver,
    write: pipe::Sender,
}

impl TerminalStream {
    /// Takes a terminal that was opened without waiting; needs a tokio runtime.
    pub(super) fn new(terminal: OwnedFd) -> io::Result<TerminalStream> {
        let read = pipe::Receiver::from_owned_fd_unchecked(terminal.try_clone()?)?;
        Ok(TerminalStream { read, write: pipe::Sender::from_owned_fd_unchecked(terminal)? })
    }
}

impl AsyncRead for TerminalStream {
    fn poll_read(mut self: Pin<&mut Self>, cx: &mut Context<'_>, buffer: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        match Pin::new(&mut self.read).poll_read(cx, buffer) {
            // The other side of a pseudo-terminal has been closed: the end.
            Poll::Ready(Err(error)) if Errno::from_io_error(&error) == Some(Errno::IO) => Poll::Ready(Ok(())),
            result => result,
        }
    }
}

impl AsyncWrite for TerminalStream {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.write).poll_write(cx, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.write).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.write).poll_shutdown(cx)
    }
}

/// A pseudo-terminal: the machine holds one side, hosts open the other by its path.
#[derive(Debug)]
pub struct PseudoTerminal {
    master: OwnedFd,
    path: PathBuf,
}

impl PseudoTerminal {
    /// Opens a pseudo-terminal in raw mode: no echo, no lines, all eight bits.
    ///
    /// # Errors
    /// Those of the system.
    pub fn open() -> io::Result<PseudoTerminal> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
        rustix::io::fcntl_setfd(&master, rustix::io::FdFlags::CLOEXEC)?;
        rustix::fs::fcntl_setfl(&master, OFlags::NONBLOCK)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        let path = PathBuf::from(OsStr::from_bytes(ptsname(&master, Vec::new())?.as_bytes()));
        // The settings stay when nobody has the other side open. From this closing on the system reports whether it is.
        let slave = open(&path, OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC, Mode::empty())?;
        let mut settings = tcgetattr(&slave)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings)?;
        Ok(PseudoTerminal { master, path })
    }

    /// Where hosts find it.
    pub fn path(&self) -> &std::path::Path {
        &self.path
    }

    /// Whether a host has the other side open, or left bytes there.
    pub(super) fn is_open(&self) -> io::Result<bool> {
        let mut polled = [PollFd::new(&self.master, PollFlags::IN)];
        poll(&mut polled, Some(&Timespec { tv_sec: 0, tv_nsec: 0 }))?;
        let found = polled[0].revents();
        Ok(found.contains(PollFlags::IN) || !found.contains(PollFlags::HUP))
    }

    /// Drops what was sent to a host that closed its side before it read it.
    pub(super) fn forget_output(&self) {
        if let Err(error) = tcflush(&self.master, QueueSelector::OFlush) {
            tracing::debug!("{}: {error}", self.path.display());
        }
    }

    /// The machine's side as a stream, until the host closes its side.
    pub(super) fn stream(&self) -> io::Result<TerminalStream> {
        TerminalStream::new(self.master.try_clone()?)
    }
}

/// Opens a serial device with its settings, raw, without waiting for a carrier.
///
/// # Errors
/// Those of the system, e.g. a speed that the device does not have.
pub fn open_serial(serial: &Serial) -> io::Result<OwnedFd> {
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let device = open(&serial.device, flags, Mode::empty())?;
    let mut settings = tcgetattr(&device)?;
    settings.make_raw();
    settings.set_speed(serial.baud)?;
    let modes = &mut settings.control_modes;
    modes.remove(ControlModes::CSIZE | ControlModes::PARENB | ControlModes::PARODD | ControlModes::CSTOPB);
    modes.insert(ControlModes::CLOCAL | ControlModes::CREAD);
    modes.insert(if serial.data_bits == 7 { ControlModes::CS7 } else { ControlModes::CS8 });
    if serial.stop_bits == 2 {
        modes.insert(ControlModes::CSTOPB);
    }
    match serial.parity {
        Parity::None => {}
        Parity::Even => modes.insert(ControlModes::PARENB),
        Parity::Odd => modes.insert(ControlModes::PARENB | ControlModes::PARODD),
    }
    if serial.parity != Parity::None {
        // A byte with wrong parity is dropped.
        settings.input_modes.insert(InputModes::INPCK | InputModes::IGNPAR);
    }
    tcsetattr(&device, OptionalActions::Now, &settings)?;
    // What came before the settings were right is noise.
    tcflush(device.as_fd(), QueueSelector::IFlush)?;
    Ok(device)
}
