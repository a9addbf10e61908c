//! SETUP CNESS: inputs become constants or queues while the network runs.

use super::Network;
use crate::{
    functions::Rule,
    port::{Cause, Fault, ObjectId, Role},
};
use protocol::command::Input;

impl Network {
    /// Makes an input of a function a constant or a queue.
    ///
    /// - `constant`: TRUE makes it a constant, with the message that came last, if one waits; the others go. FALSE
    ///   makes it a queue, with the constant, a default included, as its first message.
    ///
    /// A function waits for a first value of an input made constant, unless it could do without one as it was
    /// instanced, or fires on any input. One whose inputs are all constant never fires. What a function accumulates
    /// in a constant input it does not accumulate in a queue. Instancing anew gives the inputs of the table again.
    ///
    /// # Errors
    /// A fault if the object is no function or has no such input; nothing changes then.
    ///
    /// # Source
    /// The command is remembered; what becomes of messages that wait is ours.
    pub fn setup_cness(&mut self, id: ObjectId, input: Input, constant: bool) -> Result<(), Fault> {
        let Some((row, instance)) = self.function(id).zip(self.instances.get_mut(id.index())) else {
            return Err(Fault { function: "", cause: Cause::NotAFunction });
        };
        let Some(place) = instance.input(input) else {
            return Err(Fault { function: row.name, cause: Cause::NoSuchInput(input) });
        };
        let ports = &mut self.ports.get_mut(instance.ports)[..usize::from(instance.inputs)];
        let port = &mut ports[place];
        if port.is_active() != constant {
            return Ok(());
        }
        if constant {
            let role = row.input_of_size(instance.size, place as u16 + 1).map(|spec| spec.role);
            let required = match role {
                Some(Role::Active) => row.rule == Rule::All,
                Some(Role::Constant) => true,
                _ => false,
            };
            self.string_bytes -= port.string_bytes(&self.backlog);
            port.make_constant(required, &mut self.backlog);
            self.string_bytes += port.string_bytes(&self.backlog);
        } else {
            port.make_active();
        }
        instance.count(ports);
        self.queue_if_ready(id);
        Ok(())
    }
}
