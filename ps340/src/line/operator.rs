//! Operator lines: one order a line, one reply a line.

use super::{Events, LineEvent, Listener};
use std::io::{BufRead, Write};
use tokio::{
    io::{AsyncBufReadExt, AsyncReadExt, AsyncWriteExt, BufReader},
    sync::oneshot,
};

/// Longest order, in bytes.
const MAX_ORDER: u64 = 64 << 10;

/// An order and the way back for its reply.
#[derive(Debug)]
pub struct OperatorLine {
    /// The line without its end.
    pub text: String,
    /// Takes the reply line, without its end.
    pub reply: oneshot::Sender<String>,
}

/// Takes operators in from a listener until the machine's thread is gone.
pub async fn serve_operators(listener: Listener, events: Events) {
    while !events.is_closed() {
        match listener.accept().await {
            Ok((stream, _)) => {
                tokio::spawn(serve(stream, events.clone()));
            }
            Err(error) => {
                tracing::warn!("an operator could not attach: {error}");
                tokio::time::sleep(std::time::Duration::from_millis(100)).await;
            }
        }
    }
}

async fn serve(stream: Box<dyn super::Stream>, events: Events) {
    let (read, mut write) = tokio::io::split(stream);
    let mut read = BufReader::new(read);
    loop {
        let mut line = Vec::new();
        match (&mut read).take(MAX_ORDER).read_until(b'\n', &mut line).await {
            Ok(0) | Err(_) => return,
            Ok(_) => {}
        }
        let (reply, answer) = oneshot::channel();
        let text = String::from_utf8_lossy(&line).trim().to_string();
        if text.is_empty() {
            continue;
        }
        if events.send(LineEvent::Operator(OperatorLine { text, reply })).await.is_err() {
            return;
        }
        let Ok(answer) = answer.await else { return };
        if write.write_all(format!("{answer}\n").as_bytes()).await.is_err() {
            return;
        }
    }
}

/// Takes orders from standard input, and replies on standard output. Blocks until the end of the input.
pub fn serve_stdio(events: &Events) {
    for line in std::io::stdin().lock().split(b'\n') {
        let Ok(line) = line else { break };
        let text = String::from_utf8_lossy(&line).trim().to_string();
        if text.is_empty() {
            continue;
        }
        let (reply, answer) = oneshot::channel();
        if events.blocking_send(LineEvent::Operator(OperatorLine { text, reply })).is_err() {
            return;
        }
        let Ok(answer) = answer.blocking_recv() else { return };
        let mut out = std::io::stdout().lock();
        if writeln!(out, "{answer}").and_then(|()| out.flush()).is_err() {
            break;
        }
    }
    let _ = events.blocking_send(LineEvent::OperatorGone);
}
