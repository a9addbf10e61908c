//! Reporting: messages to the hosts, and the machine's own numbered messages.

use super::Machine;
use crate::{
    interpreter::{Class, Message},
    port::{LineId, ObjectId},
};
use protocol::{
    Value,
    wire::{MessageForm, MessageWriter},
};

impl Machine {
    /// A message to the host goes to every host that asked for none of its own, and that of an instance of one line to
    /// this line alone; a `binary` one goes without an end of line.
    pub(super) fn send_to_host(&mut self, object: ObjectId, message: &[u8], binary: bool) {
        self.counters.messages_out += 1;
        self.to_host.push(message);
        if self.memory.line_of(object).is_none() {
            self.lines.mailboxes.values_mut().for_each(|mailbox| mailbox.push(message));
        }
        for (line, writer) in self.recipients(object) {
            let mut bytes = Vec::new();
            let written = if binary && writer.form() == MessageForm::Text {
                bytes.extend_from_slice(message);
                true
            } else {
                writer.write(message, &mut bytes).is_ok()
            };
            if written {
                self.outputs.push(line, bytes);
            }
        }
    }

    /// The lines with a writer to which an instance of the host line sends.
    pub(super) fn recipients(&self, object: ObjectId) -> Vec<(LineId, MessageWriter)> {
        self.lines.recipients(self.memory.line_of(object).map(|(line, _)| line))
    }

    /// Obeys the body of a packet on the route of messages from a host.
    ///
    /// # Errors
    /// The reason why it is not obeyed.
    pub(super) fn request_form(&mut self, line: LineId, body: &[u8]) -> Result<(), Message> {
        // A line without a writer has only one form.
        if !self.lines.writers.contains_key(&line) {
            return Ok(());
        }
        let unknown = || Message::Line("a packet on the route of messages asks for no form".into());
        let form = MessageForm::requested(body).ok_or_else(unknown)?;
        if form == MessageForm::Own {
            self.memory.open_line(line)?;
        } else {
            self.memory.close_line(line);
        }
        self.lines.writers.entry(line).or_default().set_form(form);
        self.lines.report_to(line);
        Ok(())
    }

    /// Logs a message of the machine and gives it to ERROR, WARNING or INFORMATION, or to the line whose command it is
    /// about, if that asked for messages of its own. Of a name that is not known, the one that was probably meant is
    /// added, as long as it is no flood of messages.
    pub(super) fn report(&mut self, message: Message) {
        let unknown = message.unknown().filter(|_| self.reports.are_few());
        let text = match unknown.and_then(|name| self.memory.meant(&name)) {
            Some(meant) => format!("{message}; did you mean {meant}?"),
            None => message.to_string(),
        };
        let instance = match message.class() {
            Class::Error => "ERROR",
            Class::Warning => "WARNING",
            Class::Information => "INFORMATION",
        };
        self.counters.messages += 1;
        if self.reports.are_few() {
            tracing::info!("{text}");
        }
        if self.reports.log_text(&text) {
            self.show_message(&text);
        }
        if let Some(line) = self.lines.reporting_to {
            let mut bytes = Vec::new();
            let written = self.lines.writers.get(&line).map(|writer| writer.write_report(&text, &mut bytes));
            if written.is_some_and(|written| written.is_ok()) {
                self.outputs.push(line, bytes);
            }
        } else if self.reports.admits_one() {
            self.emit(vec![(instance, 1, Value::string(&text))]);
        }
    }

    /// Reports how many messages were too many for the log and for ERROR and WARNING since the latest frame.
    pub(super) fn account_for_reports(&mut self) {
        let (rest, unheard) = self.reports.begin_frame();
        if rest > 0 {
            tracing::warn!("{rest} more messages in one frame; {unheard} of them did not reach ERROR and WARNING");
        }
    }
}
