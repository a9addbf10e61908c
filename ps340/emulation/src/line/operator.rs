//! Operator lines: one operator command a line, one reply a line.

use super::{
    Events, LineEvent, Listener, Token,
    connection_slots::{ConnectionSlot, ConnectionSlots, Presence},
    http::is_request,
    listener::SocketStream,
};
use protocol::capture::MAX_OPERATOR_COMMAND;
use std::{
    io::{BufRead, IsTerminal, Write},
    time::Duration,
};
use tokio::{
    io::{AsyncBufRead, AsyncBufReadExt, AsyncReadExt, AsyncWriteExt, BufReader},
    sync::oneshot,
    time::timeout,
};

/// Operators that may be attached at once.
const MAX_OPERATORS: usize = 16;

/// The reply to an operator command of more than [`MAX_OPERATOR_COMMAND`] bytes.
const TOO_LONG: &str = "error an order has at most 65536 bytes\n";

/// How long an operator may take to send the token.
const TOKEN_TIME: Duration = Duration::from_secs(30);
/// The reply to one who does not know the token.
const NO_TOKEN: &[u8] =
    b"error the first line must be 'token TOKEN', with what the machine said behind 'ready token'\n";

/// An operator command and the channel for its reply.
#[derive(Debug)]
pub struct OperatorLine {
    /// The line without its end.
    pub text: String,
    /// Takes the reply.
    pub reply: oneshot::Sender<Reply>,
    /// Whether it comes from a file that is played, and from nobody who is there.
    pub is_replayed: bool,
}

/// The reply to an operator command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    /// The line, without its end.
    pub text: String,
    /// Whether this and later replies of the line are for people, with line ends as they are; none for as before.
    pub lines: Option<bool>,
}

impl From<String> for Reply {
    fn from(text: String) -> Reply {
        Reply { text, lines: None }
    }
}

/// Takes operators in from a listener until the machine's thread is gone. One who has given no operator command yet,
/// nor sent the token, gives way to another.
///
/// - `token`: what they must send before their first operator command, if anything.
pub async fn serve_operators(listener: Listener, token: Option<Token>, events: Events) {
    let full = format!("error {MAX_OPERATORS} operators are attached; come again when one has left\n");
    let mut places = ConnectionSlots::new(MAX_OPERATORS, &full);
    while !events.is_closed() {
        match listener.accept().await {
            Ok((stream, peer)) => {
                if let Some((stream, place)) = places.admit(stream, &peer).await {
                    tokio::spawn(serve(stream, peer, token.clone(), place, events.clone()));
                }
            }
            Err(error) => {
                tracing::warn!("an operator could not attach: {error}");
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}

async fn serve(
    stream: Box<dyn SocketStream>,
    peer: String,
    token: Option<Token>,
    place: ConnectionSlot,
    events: Events,
) {
    tokio::select! {
        () = place.presence.is_evicted() => {
            tracing::warn!("operator {peer} was dropped: it gave no order, and its place was wanted");
        }
        () = obey(stream, &peer, token, &place.presence, events) => {}
    }
}

/// Takes one operator command after the other, until the operator leaves or the machine ends.
async fn obey(
    stream: Box<dyn SocketStream>,
    peer: &str,
    mut token: Option<Token>,
    presence: &Presence,
    events: Events,
) {
    let (read, mut write) = tokio::io::split(stream);
    let mut read = BufReader::new(read);
    let mut people = false;
    loop {
        let mut line = Vec::new();
        let mut order = (&mut read).take(MAX_OPERATOR_COMMAND as u64);
        let reading = order.read_until(b'\n', &mut line);
        let read_bytes = match &token {
            Some(_) => timeout(TOKEN_TIME, reading).await.unwrap_or_else(|late| Err(late.into())),
            None => reading.await,
        };
        match read_bytes {
            Ok(0) | Err(_) => return,
            Ok(n) if n == MAX_OPERATOR_COMMAND && !line.ends_with(b"\n") => {
                // The rest of the line is not another operator command.
                if skip_line(&mut read).await.is_err() || write.write_all(TOO_LONG.as_bytes()).await.is_err() {
                    return;
                }
                continue;
            }
            Ok(_) => {}
        }
        if is_request(line.strip_suffix(b"\n").unwrap_or(&line)) {
            return tracing::warn!("operator {peer} was dropped: it speaks HTTP, as a page in a browser does");
        }
        let (reply, answer) = oneshot::channel();
        let text = String::from_utf8_lossy(&line).trim().to_string();
        if text.is_empty() {
            continue;
        }
        if let Some(token) = token.take() {
            let known = token.matches(&text);
            if write.write_all(if known { b"ok\n" } else { NO_TOKEN }).await.is_err() || !known {
                return tracing::warn!("operator {peer} was dropped: it does not know the token");
            }
            presence.note_sent();
            continue;
        }
        presence.note_sent();
        if events.send(LineEvent::Operator(OperatorLine { text, reply, is_replayed: false })).await.is_err() {
            return;
        }
        let Ok(answer) = answer.await else { return };
        people = answer.lines.unwrap_or(people);
        let text = if people { for_people(&answer.text) } else { answer.text };
        if write.write_all(format!("{text}\n").as_bytes()).await.is_err() {
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

/// Takes operator commands from standard input, and replies on standard output; on a terminal, a reply has lines.
/// Blocks until the end of the input.
pub fn serve_stdio(events: &Events) {
    let mut people = std::io::stdout().is_terminal();
    for line in std::io::stdin().lock().split(b'\n') {
        let Ok(line) = line else { break };
        let text = String::from_utf8_lossy(&line).trim().to_string();
        if text.is_empty() {
            continue;
        }
        let (reply, answer) = oneshot::channel();
        if events.blocking_send(LineEvent::Operator(OperatorLine { text, reply, is_replayed: false })).is_err() {
            return;
        }
        let Ok(answer) = answer.blocking_recv() else { return };
        let mut out = std::io::stdout().lock();
        people = answer.lines.unwrap_or(people);
        let text = if people { for_people(&answer.text) } else { answer.text };
        if writeln!(out, "{text}").and_then(|()| out.flush()).is_err() {
            break;
        }
    }
    let _ = events.blocking_send(LineEvent::OperatorGone);
}

/// Takes operator commands from a window until that is closed. Blocks.
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
    use super::*;

    /// Answers every operator command with two lines; `lines on` and `lines off` as the machine does.
    async fn answer(mut orders: tokio::sync::mpsc::Receiver<LineEvent>) {
        while let Some(LineEvent::Operator(order)) = orders.recv().await {
            let lines = match order.text.as_str() {
                "lines on" => Some(true),
                "lines off" => Some(false),
                _ => None,
            };
            let _ = order.reply.send(Reply { text: r"ok a\nb".into(), lines });
        }
    }

    #[test]
    fn an_operator_may_ask_for_replies_with_line_ends() {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        let said = runtime.block_on(async {
            let (near, far) = tokio::io::duplex(1024);
            let (events, orders) = tokio::sync::mpsc::channel(4);
            tokio::spawn(answer(orders));
            tokio::spawn(serve(Box::new(far), "pipe".into(), None, test_slot().await, events));
            let (mut read, mut write) = tokio::io::split(near);
            write.write_all(b"top\nlines on\ntop\nlines off\ntop\n").await.unwrap();
            let mut said = vec![0; 38];
            read.read_exact(&mut said).await.unwrap();
            String::from_utf8(said).unwrap()
        });
        assert_eq!(said, "ok a\\nb\nok a\nb\nok a\nb\nok a\\nb\nok a\\nb\n");
    }

    async fn test_slot() -> ConnectionSlot {
        let (stream, _) = tokio::io::duplex(1);
        ConnectionSlots::new(1, "").admit(Box::new(stream), "pipe").await.expect("there is room").1
    }

    /// What an operator line answers to a text before it closes; what reaches the machine.
    fn replies_to(text: &str, token: Option<Token>) -> (String, Vec<String>) {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let (mut near, far) = tokio::io::duplex(1024);
            let (events, mut inbox) = tokio::sync::mpsc::channel(4);
            tokio::spawn(serve(Box::new(far), "pipe".into(), token, test_slot().await, events));
            near.write_all(text.as_bytes()).await.unwrap();
            near.shutdown().await.unwrap();
            let mut orders = Vec::new();
            while let Some(LineEvent::Operator(order)) = inbox.recv().await {
                orders.push(order.text);
                let _ = order.reply.send(Reply::from("ok".to_string()));
            }
            let mut said = String::new();
            near.read_to_string(&mut said).await.unwrap();
            (said, orders)
        })
    }

    #[test]
    fn a_request_of_http_ends_the_line_before_its_body() {
        let (said, orders) = replies_to("panel\r\nPOST / HTTP/1.1\r\n\r\npicture vector a.png\r\n", None);
        assert_eq!((said.as_str(), orders), ("ok\n", vec!["panel".to_string()]));
    }

    #[test]
    fn the_token_comes_before_the_first_order() {
        let token = Token::begin().unwrap();
        let text = token.unannounced().unwrap().to_string();
        let (said, orders) = replies_to(&format!("token {text}\npanel\n"), Some(token.clone()));
        assert_eq!((said.as_str(), orders), ("ok\nok\n", vec!["panel".to_string()]));
        for wrong in ["panel\npanel\n", "token 1234\npanel\n"] {
            let (said, orders) = replies_to(wrong, Some(token.clone()));
            assert!(said.starts_with("error the first line must be") && said.lines().count() == 1, "{said}");
            assert!(orders.is_empty());
        }
    }

    #[test]
    fn people_read_lines() {
        assert_eq!(for_people(r"ok a\nb\\n\r"), "ok a\nb\\n");
        assert_eq!(for_people("ok\\"), "ok\\");
    }
}
