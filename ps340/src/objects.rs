//! Names and the objects that they stand for. A name may be used before it is defined.

use crate::port::ObjectId;
use protocol::Name;
use std::{collections::BTreeMap, ops::Bound};

/// How many objects there may be; ours, so that a hostile host cannot fill the memory with names.
pub const MAX_OBJECTS: usize = 1 << 22;

/// No more objects: [`MAX_OBJECTS`] are in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there are {MAX_OBJECTS} objects already")]
pub struct TooManyObjects;

/// The table of names.
#[derive(Debug, Default)]
pub struct Objects {
    ids: BTreeMap<Name, ObjectId>,
    /// The name of each object; none if it was forgotten.
    names: Vec<Option<Name>>,
    system: usize,
}

impl Objects {
    /// The object of a name, which is made if the name is new.
    ///
    /// # Errors
    /// [`TooManyObjects`].
    pub fn object(&mut self, name: &Name) -> Result<ObjectId, TooManyObjects> {
        if let Some(id) = self.ids.get(name) {
            return Ok(*id);
        }
        if self.names.len() >= MAX_OBJECTS {
            return Err(TooManyObjects);
        }
        let id = ObjectId::new(self.names.len());
        self.names.push(Some(name.clone()));
        self.ids.insert(name.clone(), id);
        Ok(id)
    }

    /// The object of a name, if the name is known.
    pub fn find(&self, name: &str) -> Option<ObjectId> {
        self.ids.get(name).copied()
    }

    /// The name of an object; `?` for one that was forgotten.
    pub fn name(&self, id: ObjectId) -> &str {
        self.names.get(id.index()).and_then(Option::as_ref).map_or("?", Name::as_str)
    }

    /// All objects so far belong to the system: INITIALIZE and wildcards spare them.
    pub fn seal_system(&mut self) {
        self.system = self.names.len();
    }

    /// Whether an object belongs to the system.
    pub fn is_system(&self, id: ObjectId) -> bool {
        id.index() < self.system
    }

    /// Takes the name from an object; what refers to the object keeps it. Its number is used again after
    /// [`clear_user`](Self::clear_user) only.
    pub fn forget(&mut self, name: &str) -> Option<ObjectId> {
        let id = self.ids.remove(name)?;
        self.names[id.index()] = None;
        Some(id)
    }

    /// The user's objects whose names begin with `prefix`, by name.
    pub fn user_objects(&self, prefix: &str) -> Vec<ObjectId> {
        let from = self.ids.range::<str, _>((Bound::Included(prefix), Bound::Unbounded));
        let matching = from.take_while(|(name, _)| name.as_str().starts_with(prefix));
        matching.map(|(_, id)| *id).filter(|id| !self.is_system(*id)).collect()
    }

    /// Gives up all user objects; their numbers are used again.
    pub fn clear_user(&mut self) -> impl Iterator<Item = ObjectId> + use<> {
        let system = self.system;
        self.ids.retain(|_, id| id.index() < system);
        let end = self.names.len();
        self.names.truncate(system);
        (system..end).map(ObjectId::new)
    }

    /// How many objects there are, the system's included.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(text: &str) -> Name {
        Name::new(text).unwrap()
    }

    #[test]
    fn a_name_keeps_its_object_until_it_is_forgotten() {
        let mut objects = Objects::default();
        let a = objects.object(&name("A")).unwrap();
        assert_eq!(objects.object(&name("a")).unwrap(), a);
        assert_eq!(objects.forget("A"), Some(a));
        assert_eq!(objects.name(a), "?");
        assert_ne!(objects.object(&name("A")).unwrap(), a);
    }

    #[test]
    fn wildcards_and_initialize_spare_the_system() {
        let mut objects = Objects::default();
        let tablet = objects.object(&name("TABLETIN")).unwrap();
        objects.seal_system();
        let t1 = objects.object(&name("T1")).unwrap();
        assert_eq!(objects.user_objects("T"), [t1]);
        assert_eq!(objects.clear_user().collect::<Vec<_>>(), [t1]);
        assert_eq!(objects.find("TABLETIN"), Some(tablet));
        assert_eq!(objects.find("T1"), None);
    }
}
