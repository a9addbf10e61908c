//! Listening sockets.

use super::Address;
use std::{
    fs::Permissions,
    io,
    os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt},
    path::{Path, PathBuf},
    time::Duration,
};
use tokio::{
    io::{AsyncRead, AsyncWrite},
    net::{TcpListener, UnixListener, UnixStream},
    time::timeout,
};

/// How long a process that listens at a path may take to answer before it counts as one that does not end.
const ANSWER_TIME: Duration = Duration::from_secs(2);

/// Bytes of a socket, whatever its kind.
pub(super) trait SocketStream: AsyncRead + AsyncWrite + Send + Unpin {}
impl<T: AsyncRead + AsyncWrite + Send + Unpin> SocketStream for T {}

/// Who may come to a listening socket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllowedPeers {
    /// Whoever reaches it.
    All,
    /// At a Unix socket only the user who runs the machine, and the administrator.
    Owner,
}

/// A listening socket.
#[derive(Debug)]
pub enum Listener {
    /// TCP.
    Tcp(TcpListener),
    /// Unix socket; the file is removed at the end.
    Unix(UnixListener, SocketFile, AllowedPeers),
}

/// Removes the file of a Unix socket when dropped, unless another file has its name by then.
#[derive(Debug)]
pub struct SocketFile {
    path: PathBuf,
    /// The file: device and number; none if the system does not report them.
    identity: Option<(u64, u64)>,
}

impl SocketFile {
    fn new(path: &Path) -> SocketFile {
        SocketFile { path: path.into(), identity: identity(path) }
    }
}

impl Drop for SocketFile {
    fn drop(&mut self) {
        if identity(&self.path) == self.identity {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

fn identity(path: &Path) -> Option<(u64, u64)> {
    std::fs::symlink_metadata(path).ok().map(|found| (found.dev(), found.ino()))
}

/// Begins to listen at a path. A socket that nobody answers was left by a process that was killed, and gives way.
///
/// # Errors
/// Those of the system, or what else is there.
async fn bind_unix(path: &Path) -> io::Result<UnixListener> {
    let in_use = |text: &str| Err(io::Error::new(io::ErrorKind::AddrInUse, text));
    match UnixListener::bind(path) {
        Err(error) if error.kind() == io::ErrorKind::AddrInUse => {}
        bound => return bound,
    }
    if !std::fs::symlink_metadata(path)?.file_type().is_socket() {
        return in_use("a file that is no socket has this name, and stays");
    }
    match timeout(ANSWER_TIME, UnixStream::connect(path)).await {
        Ok(Err(error)) if error.kind() == io::ErrorKind::ConnectionRefused => {
            std::fs::remove_file(path)?;
            UnixListener::bind(path)
        }
        _ => in_use("another process listens there"),
    }
}

impl Listener {
    /// Begins to listen; needs a tokio runtime.
    ///
    /// # Errors
    /// Those of the system, e.g. the address is in use.
    pub async fn bind(address: &Address, allowed: AllowedPeers) -> io::Result<Listener> {
        match address {
            Address::Tcp(at) => Ok(Listener::Tcp(TcpListener::bind(at.as_str()).await?)),
            Address::Unix(path) => {
                let bound = bind_unix(path).await?;
                let file = SocketFile::new(path);
                if allowed == AllowedPeers::Owner {
                    std::fs::set_permissions(path, Permissions::from_mode(0o600))?;
                }
                Ok(Listener::Unix(bound, file, allowed))
            }
        }
    }

    /// The address to connect to: port 0 has become a real port.
    pub fn address(&self) -> io::Result<Address> {
        match self {
            Listener::Tcp(listener) => Ok(Address::Tcp(listener.local_addr()?.to_string())),
            Listener::Unix(_, file, _) => Ok(Address::Unix(file.path.clone())),
        }
    }

    /// Whether other computers may reach it.
    pub fn is_public(&self) -> bool {
        match self {
            Listener::Tcp(listener) => listener.local_addr().is_ok_and(|address| !address.ip().is_loopback()),
            Listener::Unix(..) => false,
        }
    }

    pub(super) async fn accept(&self) -> io::Result<(Box<dyn SocketStream>, String)> {
        match self {
            Listener::Tcp(listener) => {
                let (stream, peer) = listener.accept().await?;
                stream.set_nodelay(true)?;
                Ok((Box::new(stream), format!("tcp:{peer}")))
            }
            Listener::Unix(listener, file, visitors) => {
                let (stream, _) = listener.accept().await?;
                // Before the file had its permissions, others may have come.
                let visitor = stream.peer_cred()?.uid();
                if *visitors == AllowedPeers::Owner && visitor != 0 && visitor != rustix::process::geteuid().as_raw() {
                    let text = format!("user {visitor} is not the one who runs the machine");
                    return Err(io::Error::new(io::ErrorKind::PermissionDenied, text));
                }
                Ok((Box::new(stream), format!("unix:{}", file.path.display())))
            }
        }
    }
}
