//! Operator lines: one order a line, one reply a line.

use super::{Events, LineEvent, Listener, listener::Stream};
use protocol::capture::MAX_ORDER;
use std::io::{BufRead, IsTerminal, Write};
use tokio::{
    io::{AsyncBufRead, AsyncBufReadExt, AsyncReadExt, AsyncWriteExt, BufReader},
    sync::oneshot,
};

/// The reply to an order that is longer.
const TOO_LONG: &str = "error an order has at most 65536 bytes\n";

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

async fn serve(stream: Box<dyn Stream>, events: Events) {
    let (read, mut write) = tokio::io::split(stream);
    let mut read = BufReader::new(read);
    loop {
        let mut line = Vec::new();
        match (&mut read).take(MAX_ORDER as u64).read_until(b'\n', &mut line).await {
            Ok(0) | Err(_) => return,
            Ok(n) if n == MAX_ORDER && !line.ends_with(b"\n") => {
                // The rest of the line is not another order.
                if skip_line(&mut read).await.is_err() || write.write_all(TOO_LONG.as_bytes()).await.is_err() {
                    return;
                }
                continue;
            }
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

/// Reads up to the end of the line.
async fn skip_line(read: &mut (impl AsyncBufRead + Unpin)) -> std::io::Result<()> {
    loop {
        let buffer = read.fill_buf().await?;
        let (length, end) = match buffer.iter().position(|b| *b == b'\n') {
            Some(at) => (at + 1, true),
            None => (buffer.len(), buffer.is_empty()),
        };
        read.consume(length);
        if end {
            return Ok(());
        }
    }
}

/// A reply with its line ends as line ends, for a person who reads it on a terminal.
fn for_people(reply: &str) -> String {
    let mut text = String::with_capacity(reply.len());
    let mut characters = reply.chars();
    while let Some(c) = characters.next() {
        match (c, if c == '\\' { characters.next() } else { None }) {
            ('\\', Some('n')) => text.push('\n'),
            ('\\', Some('r')) => {}
            ('\\', Some(other)) => text.push(other),
            _ => text.push(c),
        }
    }
    text
}

/// Takes orders from standard input, and replies on standard output; on a terminal, a reply has lines. Blocks until the
/// end of the input.
pub fn serve_stdio(events: &Events) {
    let people = std::io::stdout().is_terminal();
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
        let answer = if people { for_people(&answer) } else { answer };
        if writeln!(out, "{answer}").and_then(|()| out.flush()).is_err() {
            break;
        }
    }
    let _ = events.blocking_send(LineEvent::OperatorGone);
}

/// Takes orders from a window until that is closed. Blocks.
pub fn serve_window(orders: std::sync::mpsc::Receiver<OperatorLine>, events: &Events) {
    for order in orders {
        if events.blocking_send(LineEvent::Operator(order)).is_err() {
            return;
        }
    }
    let _ = events.blocking_send(LineEvent::OperatorGone);
}

#[cfg(test)]
mod tests {
    use super::for_people;

    #[test]
    fn people_read_lines() {
        assert_eq!(for_people(r"ok a\nb\\n\r"), "ok a\nb\\n");
        assert_eq!(for_people("ok\\"), "ok\\");
    }
}
