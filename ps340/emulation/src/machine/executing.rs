//! Carrying out commands and raster records that were read, with what they cause.

use super::Machine;
use crate::interpreter::{Interpreter, Message};
use protocol::{
    Value,
    command::{Command, CommandError, Spanned},
    raster,
};

impl Machine {
    /// Carries out a command that was read, or reports why it could not be. Returns whether it was one.
    pub(super) fn execute_read(
        &mut self,
        interpreter: &mut Interpreter,
        read: Result<Spanned<Command>, CommandError>,
    ) -> bool {
        match read {
            Ok(read) => {
                read.warnings.into_iter().for_each(|warning| self.report(Message::LeftOut(warning)));
                self.execute(interpreter, read.command);
                true
            }
            Err(error) => {
                self.report(Message::Syntax(error));
                false
            }
        }
    }

    /// Carries out a command and what it causes.
    ///
    /// What it sends into the network is carried out before the next one, as long as the share of this step lasts;
    /// after that the queues fill, and what is too much for them is counted and reported.
    pub(super) fn execute(&mut self, interpreter: &mut Interpreter, command: Command) {
        self.counters.commands += 1;
        let rested = self.network_idle;
        self.memory.set_speaker(self.lines.reporting_to);
        interpreter.execute(command, &mut self.memory, &mut self.reports.pending);
        self.memory.set_speaker(None);
        self.network_idle = false;
        self.carry_effects();
        self.settle_after(rested);
    }

    /// A message from an initial instance of the host line, or from that of the line whose commands are carried out,
    /// and what it causes.
    pub(super) fn emit_from_line(&mut self, instance: &str, value: Value) {
        let rested = self.network_idle;
        self.memory.set_speaker(self.lines.reporting_to);
        let object = self.memory.objects.find(instance).map(|id| self.memory.resolve(id));
        self.memory.set_speaker(None);
        if let Some(object) = object {
            self.memory.network.note_emission(object);
            self.memory.network.emit(object, 1, value, &mut self.memory.effects);
        }
        self.network_idle = false;
        self.carry_effects();
        self.settle_after(rested);
    }

    /// Lets the network work. What functions report while they work goes to the line whose commands are carried
    /// out only if the network had come to rest before: otherwise nobody knows whose doing it is.
    fn settle_after(&mut self, rested: bool) {
        let speaking = self.lines.reporting_to.filter(|_| rested);
        let speaking = std::mem::replace(&mut self.lines.reporting_to, speaking);
        self.settle();
        self.lines.reporting_to = speaking;
    }
}

/// Carries out raster records; returns how many.
pub(super) fn raster_records(payload: &[u8], machine: &mut Machine) -> usize {
    let mut completed = 0;
    for read in raster::decode(payload) {
        match read {
            Ok(command) => {
                if let Err(fault) = machine.frame_buffer.apply(&command) {
                    machine.report(Message::Raster(fault));
                }
                completed += 1;
            }
            Err(error) => machine.report(Message::Line(error.to_string())),
        }
    }
    completed
}
