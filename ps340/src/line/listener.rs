//! Listening sockets.

use super::Address;
use std::io;
use tokio::{
    io::{AsyncRead, AsyncWrite},
    net::{TcpListener, UnixListener, UnixStream},
};

/// Bytes of a socket, whatever its kind.
pub(super) trait Stream: AsyncRead + AsyncWrite + Send + Unpin {}
impl<T: AsyncRead + AsyncWrite + Send + Unpin> Stream for T {}

/// A listening socket.
#[derive(Debug)]
pub enum Listener {
    /// TCP.
    Tcp(TcpListener),
    /// Unix socket; the file is removed at the end.
    Unix(UnixListener, SocketFile),
}

/// Removes the file of a Unix socket when dropped.
#[derive(Debug)]
pub struct SocketFile(std::path::PathBuf);

impl Drop for SocketFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

impl Listener {
    /// Begins to listen; needs a tokio runtime.
    ///
    /// # Errors
    /// Those of the system, e.g. the address is in use.
    pub async fn bind(address: &Address) -> io::Result<Listener> {
        match address {
            Address::Tcp(at) => Ok(Listener::Tcp(TcpListener::bind(at.as_str()).await?)),
            Address::Unix(path) => {
                let bound = match UnixListener::bind(path) {
                    // A file that nobody listens at was left by a process that was killed.
                    Err(e) if e.kind() == io::ErrorKind::AddrInUse && UnixStream::connect(path).await.is_err() => {
                        std::fs::remove_file(path)?;
                        UnixListener::bind(path)
                    }
                    bound => bound,
                };
                Ok(Listener::Unix(bound?, SocketFile(path.clone())))
            }
        }
    }

    /// The address to connect to: port 0 has become a real port.
    pub fn address(&self) -> io::Result<Address> {
        match self {
            Listener::Tcp(listener) => Ok(Address::Tcp(listener.local_addr()?.to_string())),
            Listener::Unix(_, file) => Ok(Address::Unix(file.0.clone())),
        }
    }

    pub(super) async fn accept(&self) -> io::Result<(Box<dyn Stream>, String)> {
        match self {
            Listener::Tcp(listener) => {
                let (stream, peer) = listener.accept().await?;
                stream.set_nodelay(true)?;
                Ok((Box::new(stream), format!("tcp:{peer}")))
            }
            Listener::Unix(listener, file) => {
                let (stream, _) = listener.accept().await?;
                Ok((Box::new(stream), format!("unix:{}", file.0.display())))
            }
        }
    }
}
