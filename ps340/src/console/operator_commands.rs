//! Operator commands from the window to the machine.

use crate::line::{OperatorLine, Reply};
use std::sync::mpsc;
use tokio::sync::oneshot;

/// Operator commands that wait for their reply at most; more than a person gives.
const MAX_WAITING: usize = 1024;

/// Gives operator commands to the machine, and takes its replies.
pub struct OperatorCommands {
    sender: mpsc::Sender<OperatorLine>,
    waiting: Vec<(String, oneshot::Receiver<Reply>)>,
    /// The latest reply that reports an error, with its operator command.
    pub failure: Option<String>,
}

impl OperatorCommands {
    /// Operator commands that go to the other end of `sender`.
    pub fn new(sender: mpsc::Sender<OperatorLine>) -> OperatorCommands {
        OperatorCommands { sender, waiting: Vec::new(), failure: None }
    }

    /// Gives an operator command, a line of the operator's language. A machine that has ended takes none.
    pub fn give(&mut self, order: impl Into<String>) {
        let text = order.into();
        let (reply, answer) = oneshot::channel();
        let sent = self.sender.send(OperatorLine { text: text.clone(), reply, is_replayed: false });
        if sent.is_ok() && self.waiting.len() < MAX_WAITING {
            self.waiting.push((text, answer));
        }
    }

    /// Takes the replies that have come.
    pub fn take_replies(&mut self) {
        let failure = &mut self.failure;
        self.waiting.retain_mut(|(order, answer)| match answer.try_recv() {
            Ok(reply) => {
                if let Some(reason) = reply.text.strip_prefix("error") {
                    *failure = Some(format!("{order}:{reason}"));
                }
                false
            }
            Err(oneshot::error::TryRecvError::Empty) => true,
            Err(oneshot::error::TryRecvError::Closed) => false,
        });
    }
}
