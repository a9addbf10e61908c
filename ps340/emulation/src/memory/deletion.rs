//! DELETE: definitions and names go, and what referred to the objects refers to nothing.
//!
//! # Source
//! As remembered, DELETE sets the definition of a name to null and forgets the name: references elsewhere are to null,
//! also after the name was defined again. A client of the time draws in this way. It deletes the segments of a frame,
//! defines others with the same names, and includes these in an instance that still refers to the ones of all frames
//! before.
//!
//! # Cost
//! A deletion takes time in proportion to the arcs of the network. References are cleared when half of all objects have
//! been deleted, so that this takes a constant time a deletion.

use super::MassMemory;
use crate::port::ObjectId;
use std::collections::HashSet;

/// Deleted objects that are kept in any case before the references to them are cleared.
const RETAINED_CAPACITY: usize = 1024;

impl MassMemory {
    /// Takes definitions and names away, those of the nodes that were named inside them too, and the arcs to and from
    /// them. Objects of the system keep their names.
    pub fn delete(&mut self, ids: Vec<ObjectId>) {
        let gone: HashSet<ObjectId> = self.undefine_all(ids).into_iter().collect();
        for id in &gone {
            if !self.objects.is_system(*id) {
                self.structures.remove(*id);
                self.objects.delete(*id);
                self.network.forget(*id);
            }
        }
        self.network.retain_arcs(|_, _, to| !gone.contains(&to.object));
        if self.objects.deleted() > RETAINED_CAPACITY.max(self.objects.len() / 2) {
            self.reuse_deleted();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::{Member, Node, Operation};
    use protocol::Name;

    fn name(text: &str) -> Name {
        Name::new(text).unwrap()
    }

    #[test]
    fn references_to_what_was_deleted_are_bounded_and_numbers_come_back() {
        let mut memory = MassMemory::default();
        let frame = memory.define_node(&name("FRAME"), Node::Instance(Vec::new())).unwrap();
        let mut largest = (0, 0);
        for cycle in 0..10_000 {
            let segment = memory.define_node(&name("T"), Node::Nil).unwrap();
            memory.structures.include(segment, frame);
            memory.delete(vec![segment]);
            let Some(Node::Instance(members)) = memory.structures.node(frame) else { panic!("it is an instance") };
            largest = (members.len().max(largest.0), segment.index().max(largest.1));
            memory.structures.audit().unwrap_or_else(|text| panic!("{cycle}: {text}"));
        }
        assert!(largest.0 <= RETAINED_CAPACITY + 1 && largest.1 <= 2 * RETAINED_CAPACITY, "{largest:?}");
    }

    #[test]
    fn what_needs_a_descendant_keeps_one_that_is_nothing() {
        let mut memory = MassMemory::default();
        let data = memory.define_node(&name("V"), Node::Nil).unwrap();
        let operation = Operation::Color { hue: 0.0, saturation: 1.0 };
        let color = Node::operate(operation.clone(), Some(data));
        let group = Node::Group(vec![Member::Unnamed(color), Member::Included(data)]);
        let id = memory.define_node(&name("S"), group).unwrap();
        memory.delete(vec![data]);
        memory.reuse_deleted();
        let color = Node::operate(operation, Some(ObjectId::NOTHING));
        assert_eq!(memory.structures.node(id), Some(&Node::Group(vec![Member::Unnamed(color)])));
        assert!(memory.structures.node(ObjectId::NOTHING).is_none());
        assert_eq!(memory.title(ObjectId::NOTHING), "nothing");
    }
}
