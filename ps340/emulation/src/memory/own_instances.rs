//! Instances that one host line has for itself.
//!
//! HOST_MESSAGE, HOST_MESSAGEB, HOSTOUT and CHANNEL3 to CHANNEL7 exist once, for all lines. A line that asks for
//! messages of its own has each of them once more, without a name: in its commands the names denote these. So a program
//! need not be written in another way, and what its networks send reaches nobody else. Ours.

use super::{MassMemory, Refusal, line_instances::LineInstance};
use crate::{
    functions::devices::{InitialInstance, of_line},
    port::{LineId, ObjectId},
};
use std::collections::HashSet;

impl MassMemory {
    /// Gives a line instances of its own; nothing if it has them.
    ///
    /// # Errors
    /// [`Refusal::Full`]; the line then has none.
    pub fn open_line(&mut self, line: LineId) -> Result<(), Refusal> {
        if self.line_instances.lines.contains_key(&line) {
            return Ok(());
        }
        self.line_instances.lines.insert(line, Vec::new());
        let made = of_line().try_for_each(|initial| self.instance_of_line(line, &initial));
        if made.is_err() {
            self.close_line(line);
        }
        made
    }

    fn instance_of_line(&mut self, line: LineId, initial: &InitialInstance) -> Result<(), Refusal> {
        let Some(shared) = self.objects.find(&initial.name) else { return Ok(()) };
        let own = self.objects.anonymous().map_err(|_| Refusal::Full)?;
        self.line_instances.lines.entry(line).or_default().push(LineInstance { shared, own });
        // The rows and sizes are those of the initial instances, which were made in the same way.
        self.network.define(own, initial.function, initial.device).map_err(|_| Refusal::Full)
    }

    /// Takes the instances of a line away, with the arcs to and from them; nothing if it has none.
    pub fn close_line(&mut self, line: LineId) {
        let Some(instances) = self.line_instances.lines.remove(&line) else { return };
        let gone: HashSet<ObjectId> = instances.iter().map(|instance| instance.own).collect();
        gone.iter().for_each(|id| self.network.forget(*id));
        self.network.retain_arcs(|_, _, to| !gone.contains(&to.object));
        gone.iter().for_each(|id| self.objects.release(*id));
    }

    /// Whose command is carried out from now on; none for one that a function interprets.
    pub fn set_speaker(&mut self, line: Option<LineId>) {
        self.line_instances.speaker = line;
    }

    /// The line to which an instance belongs, and the initial instance in whose place it stands; none if it is no
    /// instance of one line.
    pub fn line_of(&self, id: ObjectId) -> Option<(LineId, ObjectId)> {
        self.line_instances.lines.iter().find_map(|(line, instances)| {
            let instance = instances.iter().find(|instance| instance.own == id)?;
            Some((*line, instance.shared))
        })
    }

    /// Makes the instances of all lines anew, after everything but the system has gone.
    pub(super) fn restore_line_instances(&mut self) {
        let lines: Vec<LineId> = std::mem::take(&mut self.line_instances.lines).into_keys().collect();
        for line in lines {
            let made = self.open_line(line);
            debug_assert!(made.is_ok(), "nothing else is there");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{Name, command::Input};

    /// A memory with the initial instances of the host line, and two lines that have their own.
    fn memory() -> MassMemory {
        let mut memory = MassMemory::default();
        for initial in of_line() {
            memory.define_initial(&initial).unwrap();
        }
        memory.objects.seal_system();
        memory.open_line(LineId(1)).unwrap();
        memory.open_line(LineId(2)).unwrap();
        memory
    }

    fn targets(memory: &mut MassMemory, name: &str) -> [ObjectId; 3] {
        [None, Some(LineId(1)), Some(LineId(2))].map(|line| {
            memory.set_speaker(line);
            memory.target(&Name::new(name).unwrap()).unwrap()
        })
    }

    #[test]
    fn a_name_denotes_the_instance_of_the_line_that_speaks() {
        let mut memory = memory();
        for initial in of_line() {
            let [shared, one, two] = targets(&mut memory, &initial.name);
            assert_eq!(memory.objects.name(shared), initial.name);
            assert_eq!(memory.line_of(shared), None);
            assert_eq!(memory.line_of(one), Some((LineId(1), shared)));
            assert_eq!(memory.line_of(two), Some((LineId(2), shared)));
            assert_eq!(memory.title(two), format!("{} of line 2", initial.name));
        }
    }

    #[test]
    fn the_instances_of_a_line_outlive_initialize_and_not_the_line() {
        let mut memory = memory();
        memory.define_function(&Name::new("A").unwrap(), &Name::new("NOP").unwrap(), None).unwrap();
        memory.initialize();
        let [_, one, two] = targets(&mut memory, "HOST_MESSAGE");
        assert_eq!(memory.line_of(one).map(|(line, _)| line), Some(LineId(1)));
        let a = memory.define_function(&Name::new("A").unwrap(), &Name::new("NOP").unwrap(), None).unwrap();
        memory.network.connect(a, 1, one, Input::Number(1)).unwrap();
        memory.network.connect(a, 1, two, Input::Number(1)).unwrap();
        let before = memory.objects.len();
        memory.close_line(LineId(1));
        assert_eq!(memory.objects.len(), before - of_line().count());
        let left: Vec<ObjectId> = memory.network.arcs(a).map(|(_, to)| to.object).collect();
        assert_eq!(left, [two]);
        memory.network.audit().unwrap();
        memory.open_line(LineId(1)).unwrap();
        assert_eq!(memory.objects.len(), before);
    }
}
