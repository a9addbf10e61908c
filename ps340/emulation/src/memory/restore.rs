//! INITIALIZE, and what exists from the start besides functions: structures that a user may redefine, and arcs.

use super::{INITIAL_WORKING_STORAGE, MassMemory, Refusal};
use crate::{
    port::{Effect, ObjectId},
    structure::Node,
};
use protocol::{Name, command::Input};

impl MassMemory {
    /// Makes an initial structure, which exists from the start. The user may redefine it.
    ///
    /// # Errors
    /// [`Refusal`], if the name is none.
    pub fn define_initial_node(&mut self, name: &str, node: Node) -> Result<(), Refusal> {
        let name = Name::new(name).map_err(|_| Refusal::Full)?;
        let id = self.define_node(&name, node.clone())?;
        self.initial.nodes.push((id, node));
        Ok(())
    }

    /// Makes an arc between initial objects, which INITIALIZE restores; nothing if one of them does not exist.
    pub fn connect_initial(&mut self, from: &str, output: u16, to: &str, input: Input) {
        if let (Some(from), Some(to)) = (self.objects.find(from), self.objects.find(to)) {
            self.initial.arcs.push((from, output, to, input));
            self.restore_arcs();
        }
    }

    /// Gives an initial structure the definition that it had at the start. Returns false if the object is none.
    pub fn restore(&mut self, id: ObjectId) -> bool {
        let Some((_, node)) = self.initial.nodes.iter().find(|(initial, _)| *initial == id) else { return false };
        let node = node.clone();
        self.replace(id, |structures| (structures.define(id, node), Vec::new()));
        true
    }

    /// Gives all initial structures the definitions that they had at the start.
    pub fn restore_structures(&mut self) {
        let ids: Vec<ObjectId> = self.initial.nodes.iter().map(|(id, _)| *id).collect();
        for id in ids {
            self.restore(id);
        }
    }

    /// INITIALIZE CONNECTIONS: only the arcs that exist from the start are left.
    pub fn restore_arcs(&mut self) {
        self.network.retain_arcs(|_, _, _| false);
        for (from, output, to, input) in &self.initial.arcs {
            // An arc whose ends were made something else in configure mode stays away.
            let _ = self.network.connect(*from, *output, *to, *input);
        }
    }

    /// INITIALIZE: user objects, all connections, the display list and the working storage that was asked for go,
    /// initial structures are restored.
    pub fn initialize(&mut self) {
        self.restore_structures();
        for id in self.objects.users() {
            self.network.undefine(id);
            self.structures.undefine(id);
        }
        self.insertions.clear();
        self.effects.push(Effect::ForgetRequests);
        self.objects.clear_user();
        self.restore_line_instances();
        self.system.working_storage = INITIAL_WORKING_STORAGE;
        self.structures.clear_displayed();
        self.restore_arcs();
    }
}
