//! What objects are called in messages, and which name was probably meant.

use super::MassMemory;
use crate::{functions, port::ObjectId};
use protocol::command::spelling::nearest;
use std::ops::Bound;

/// Names that are compared with one that is not known.
const COMPARED: usize = 4096;
/// Shortest last part of a name for which another is proposed; shorter ones are all alike.
const SHORTEST: usize = 3;
/// Structures in structures that a title looks through for one with a name.
const DEPTH: usize = 64;

impl MassMemory {
    /// What to call an object in messages: its name, or what it is and where, or of which host line.
    pub fn title(&self, id: ObjectId) -> String {
        if self.objects.has_name(id) {
            return self.objects.name(id).to_owned();
        }
        if let Some((line, shared)) = self.line_of(id) {
            return format!("{} of line {}", self.objects.name(shared), line.0);
        }
        let what = match (self.network.function(id), self.structures.node(id)) {
            (Some(row), _) => format!("F:{}", row.name),
            (None, Some(node)) => node.word().into(),
            (None, None) => return "nothing".into(),
        };
        let mut home = self.structures.home(id);
        for _ in 0..DEPTH {
            match home {
                Some(outer) if self.objects.has_name(outer) => {
                    return format!("a {what} inside {}", self.objects.name(outer));
                }
                Some(outer) => home = self.structures.home(outer),
                None => break,
            }
        }
        format!("a {what} without a name")
    }

    /// The name that was probably meant by one that nothing defines: the same name inside a structure, or the nearest.
    ///
    /// - `name`: a name, or `F:` and the name of a function.
    pub fn meant(&self, name: &str) -> Option<String> {
        if let Some(function) = name.strip_prefix("F:") {
            return nearest(function, functions::all().map(|row| row.name)).map(|meant| format!("F:{meant}"));
        }
        // A slip in the first letter is rare, so those with the same one come first.
        let same_letter = (Bound::Included(name.get(..1)?), Bound::Unbounded);
        let names = self.objects.names(same_letter).chain(self.objects.names((Bound::Unbounded, Bound::Unbounded)));
        let defined = |known: &&str| self.objects.find(known).is_some_and(|id| self.is_defined(id));
        let known: Vec<&str> = names.take(COMPARED).filter(defined).collect();
        let inside = |known: &&&str| known.strip_suffix(name).is_some_and(|outer| outer.ends_with('.'));
        if let Some(inner) = known.iter().find(inside) {
            return Some((*inner).to_owned());
        }
        // T1 and T2 are two names and no slip.
        let letters = |text: &str| text.chars().filter(|c| !c.is_ascii_digit()).collect::<String>();
        let own = letters(name);
        let others = known.into_iter().filter(|known| letters(known) != own);
        let short = name.rsplit('.').next().is_some_and(|last| last.len() < SHORTEST);
        Some(nearest(name, others)?.to_owned()).filter(|_| !short)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::{Member, Node, Operation};
    use protocol::Name;

    fn memory(names: &[&str]) -> MassMemory {
        let mut memory = MassMemory::default();
        for name in names {
            memory.define_node(&Name::new(name).unwrap(), Node::Nil).unwrap();
        }
        memory
    }

    #[test]
    fn the_nearest_name_is_meant_but_no_other_number() {
        let mut memory = memory(&["CUBE", "ROBOT.ARM", "T1", "AB", "WHEEL17"]);
        memory.object(&Name::new("CUEBS").unwrap()).unwrap();
        for (name, meant) in [
            ("CUEB", Some("CUBE")),
            ("ARM", Some("ROBOT.ARM")),
            ("T2", None),
            ("WHEEL18", None),
            ("AC", None),
            ("ROBOT.ARN", Some("ROBOT.ARM")),
            ("ROBOT.X", None),
            ("F:ADDD", Some("F:ADD")),
            ("PICTURE", None),
        ] {
            assert_eq!(memory.meant(name).as_deref(), meant, "{name}");
        }
    }

    #[test]
    fn an_object_without_a_name_is_called_by_what_it_is_and_where() {
        let mut memory = memory(&["A"]);
        let lone = memory.add_anonymous(Node::Nil).unwrap();
        let color = Node::operate(Operation::Color { hue: 0.0, saturation: 1.0 }, None);
        let color = memory.add_anonymous(color).unwrap();
        let inner = memory.add_anonymous(Node::Group(vec![Member::Named(color)])).unwrap();
        let robot = Name::new("ROBOT").unwrap();
        memory.define_node(&robot, Node::Group(vec![Member::Named(inner)])).unwrap();
        assert_eq!(memory.title(color), "a SET COLOR inside ROBOT");
        assert_eq!(memory.title(lone), "a NIL without a name");
        assert_eq!(memory.title(memory.objects.find("A").unwrap()), "A");
        let id = memory.objects.forget("A").unwrap();
        assert_eq!(memory.title(id), "a NIL without a name");
    }
}
