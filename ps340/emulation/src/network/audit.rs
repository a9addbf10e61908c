//! The books of the network, counted anew: for tests and for people who doubt them.

use super::{Network, instance::Instance};
use crate::port::{MAX_QUEUE, ObjectId};
use protocol::Value;
use std::collections::BTreeSet;

impl Network {
    /// Counts anew what each instance waits for, who is ready, how many queues are in use and bytes of strings stored.
    ///
    /// # Errors
    /// What does not agree with the books that are kept while the network runs.
    pub fn audit(&self) -> Result<(), String> {
        let (mut string_bytes, mut queues, mut filled) = (0, 0, 0);
        let listed: Vec<ObjectId> = self.ready.iter().collect();
        let ready: BTreeSet<ObjectId> = listed.iter().copied().collect();
        agree(listed.len() == ready.len(), || "somebody stands twice in the list of those that are ready".into())?;
        for id in self.objects() {
            let Some(instance) = self.instance(id) else { continue };
            let ports = self.ports.get(instance.ports);
            let inputs = &ports[..usize::from(instance.inputs)];
            string_bytes += ports.iter().map(|port| port.string_bytes(&self.backlog)).sum::<usize>();
            queues += ports.iter().filter(|port| port.len(&self.backlog) > 1).count();
            filled += inputs.iter().filter(|port| !port.is_empty()).count();
            let mut fresh = Instance { row: instance.row, ..Instance::VACANT };
            fresh.count(inputs);
            let counted = |instance: &Instance| (instance.missing, instance.slack, instance.active, instance.strings);
            let (found, due) = (counted(instance), counted(&fresh));
            agree(found == due, || format!("{id:?}: missing, slack, active, strings are {found:?}, not {due:?}"))?;
            let waits = inputs.iter().any(|port| port.is_active() && !port.is_empty());
            agree(!instance.is_ready() || waits, || format!("{id:?} would fire without a message"))?;
            agree(instance.queued == ready.contains(&id), || format!("{id:?} does not know whether it is listed"))?;
            agree(!instance.is_ready() || instance.queued, || format!("{id:?} is ready and not listed"))?;
            let short = ports.iter().all(|port| port.len(&self.backlog) <= MAX_QUEUE);
            agree(short, || format!("{id:?} has a queue that is too long"))?;
            let finite = ports.iter().flat_map(|port| port.messages(&self.backlog)).all(Value::is_finite);
            agree(finite, || format!("{id:?} holds a number that is not finite"))?;
        }
        let kept = self.string_bytes;
        agree(kept == string_bytes, || format!("{string_bytes} bytes of strings wait, not {kept}"))?;
        let lent = self.backlog.capacity_in_use();
        agree((queues..=filled).contains(&lent), || format!("{lent} queues are lent, for {queues} to {filled} inputs"))
    }
}

fn agree(true_so: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if true_so { Ok(()) } else { Err(otherwise()) }
}
