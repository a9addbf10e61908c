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
    identities: Vec<Identity>,
    /// Numbers that were given back.
    free: Vec<ObjectId>,
    /// Objects that were deleted; something may still refer to them.
    deleted: Vec<ObjectId>,
    system: usize,
}

/// What an object is known by.
#[derive(Debug)]
enum Identity {
    Named(Name),
    /// It had a name; what refers to it keeps it.
    Forgotten,
    /// DELETE took name and definition away; what refers to it refers to nothing.
    Deleted,
    /// It never had a name: PREFIX, FOLLOW or a structure without a name made it.
    Anonymous,
    /// Given back.
    Free,
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
        let id = self.make(Identity::Named(name.clone()))?;
        self.ids.insert(name.clone(), id);
        Ok(id)
    }

    /// An object without a name. Its maker sees to it that nothing refers to it any more when it is
    /// [released](Self::release).
    ///
    /// # Errors
    /// [`TooManyObjects`].
    pub fn anonymous(&mut self) -> Result<ObjectId, TooManyObjects> {
        self.make(Identity::Anonymous)
    }

    /// Gives an anonymous object back, for its number to be used again. Others stay as they are.
    pub fn release(&mut self, id: ObjectId) {
        if let Some(identity @ Identity::Anonymous) = self.identities.get_mut(id.index()) {
            *identity = Identity::Free;
            self.free.push(id);
        }
    }

    /// Takes the name from an object whose definition has gone. Its number is used again after
    /// [`reuse_deleted`](Self::reuse_deleted).
    pub fn delete(&mut self, id: ObjectId) {
        let Some(identity @ (Identity::Named(_) | Identity::Forgotten)) = self.identities.get_mut(id.index()) else {
            return;
        };
        if let Identity::Named(name) = std::mem::replace(identity, Identity::Deleted) {
            self.ids.remove(&name);
        }
        self.deleted.push(id);
    }

    /// Whether an object was deleted.
    pub fn is_deleted(&self, id: ObjectId) -> bool {
        matches!(self.identities.get(id.index()), Some(Identity::Deleted))
    }

    /// How many objects were deleted and not given back.
    pub fn deleted(&self) -> usize {
        self.deleted.len()
    }

    /// Gives the deleted objects back, for their numbers to be used again. Nothing may refer to them any more.
    pub fn reuse_deleted(&mut self) {
        for id in &self.deleted {
            self.identities[id.index()] = Identity::Free;
        }
        self.free.append(&mut self.deleted);
    }

    /// Whether an object never had a name.
    pub fn is_anonymous(&self, id: ObjectId) -> bool {
        matches!(self.identities.get(id.index()), Some(Identity::Anonymous))
    }

    fn make(&mut self, identity: Identity) -> Result<ObjectId, TooManyObjects> {
        if let Some(id) = self.free.pop() {
            self.identities[id.index()] = identity;
            return Ok(id);
        }
        if self.identities.len() >= MAX_OBJECTS {
            return Err(TooManyObjects);
        }
        let id = ObjectId::new(self.identities.len());
        self.identities.push(identity);
        Ok(id)
    }

    /// The object of a name, if the name is known.
    pub fn find(&self, name: &str) -> Option<ObjectId> {
        self.ids.get(name).copied()
    }

    /// The name of an object; `?` for one that has none.
    pub fn name(&self, id: ObjectId) -> &str {
        match self.identities.get(id.index()) {
            Some(Identity::Named(name)) => name.as_str(),
            _ => "?",
        }
    }

    /// Whether an object has a name.
    pub fn has_name(&self, id: ObjectId) -> bool {
        matches!(self.identities.get(id.index()), Some(Identity::Named(_)))
    }

    /// The names in a range, by name.
    pub fn names<'o>(&'o self, range: (Bound<&'o str>, Bound<&'o str>)) -> impl Iterator<Item = &'o str> {
        self.ids.range::<str, _>(range).map(|(name, _)| name.as_str())
    }

    /// All objects so far belong to the system: INITIALIZE and wildcards spare them.
    pub fn seal_system(&mut self) {
        self.system = self.identities.len();
    }

    /// Whether an object belongs to the system.
    pub fn is_system(&self, id: ObjectId) -> bool {
        id.index() < self.system
    }

    /// Takes the name from an object; what refers to the object keeps it. Its number is used again after
    /// [`clear_user`](Self::clear_user) only.
    pub fn forget(&mut self, name: &str) -> Option<ObjectId> {
        let id = self.ids.remove(name)?;
        self.identities[id.index()] = Identity::Forgotten;
        Some(id)
    }

    /// The user's objects whose names begin with `prefix`, by name.
    pub fn user_objects(&self, prefix: &str) -> Vec<ObjectId> {
        let from = self.ids.range::<str, _>((Bound::Included(prefix), Bound::Unbounded));
        let matching = from.take_while(|(name, _)| name.as_str().starts_with(prefix));
        matching.map(|(_, id)| *id).filter(|id| !self.is_system(*id)).collect()
    }

    /// The names that a unit holds: the name itself and all that begins with `unit.`, by name.
    pub fn unit(&self, unit: &str) -> Vec<Name> {
        let from = self.ids.range::<str, _>((Bound::Included(unit), Bound::Unbounded)).map(|(name, _)| name);
        let near = from.take_while(|name| name.as_str().starts_with(unit));
        let inside = |name: &&Name| matches!(name.as_str().as_bytes().get(unit.len()), None | Some(b'.'));
        near.filter(inside).cloned().collect()
    }

    /// How many units there are: names with something named inside them, those inside others not counted.
    pub fn units(&self) -> usize {
        let mut units: Vec<&str> = self.ids.keys().filter_map(|n| Some(n.as_str().split_once('.')?.0)).collect();
        units.dedup();
        units.len()
    }

    /// All user objects, also those without a name.
    pub fn users(&self) -> impl Iterator<Item = ObjectId> + use<> {
        (self.system..self.identities.len()).map(ObjectId::new)
    }

    /// Gives up all user objects; their numbers are used again.
    pub fn clear_user(&mut self) {
        let system = self.system;
        self.ids.retain(|_, id| id.index() < system);
        self.identities.truncate(system);
        self.free.clear();
        self.deleted.clear();
    }

    /// Releases the memory of objects that have gone.
    pub fn shrink(&mut self) {
        self.identities.shrink_to_fit();
        self.free.shrink_to_fit();
        self.deleted.shrink_to_fit();
    }

    /// How many objects there are, the system's and those that were deleted and not given back included.
    pub fn len(&self) -> usize {
        self.identities.len() - self.free.len()
    }

    /// How many objects belong to the system.
    pub fn system_len(&self) -> usize {
        self.system
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
        assert_eq!(objects.users().collect::<Vec<_>>(), [t1]);
        objects.clear_user();
        assert_eq!(objects.find("TABLETIN"), Some(tablet));
        assert_eq!(objects.find("T1"), None);
    }

    #[test]
    fn anonymous_objects_are_used_again_and_named_ones_are_not() {
        let mut objects = Objects::default();
        let a = objects.object(&name("A")).unwrap();
        let anonymous = objects.anonymous().unwrap();
        assert_eq!(objects.name(anonymous), "?");
        objects.release(a);
        objects.release(anonymous);
        objects.release(anonymous);
        assert_eq!(objects.len(), 1);
        assert_eq!(objects.anonymous().unwrap(), anonymous);
        assert_ne!(objects.anonymous().unwrap(), anonymous);
        assert_eq!(objects.find("A"), Some(a));
    }

    #[test]
    fn a_deleted_object_has_no_name_and_its_number_comes_back_when_nothing_refers_to_it() {
        let mut objects = Objects::default();
        let a = objects.object(&name("A")).unwrap();
        objects.delete(a);
        objects.delete(a);
        assert_eq!((objects.find("A"), objects.is_deleted(a), objects.deleted()), (None, true, 1));
        let b = objects.object(&name("A")).unwrap();
        assert_ne!(a, b);
        objects.reuse_deleted();
        assert_eq!((objects.is_deleted(a), objects.deleted(), objects.len()), (false, 0, 1));
        assert_eq!(objects.object(&name("C")).unwrap(), a);
    }

    #[test]
    fn a_unit_is_a_name_and_what_is_named_inside_it() {
        let mut objects = Objects::default();
        for text in ["S", "S.A", "S.A.B", "S1", "SA.S", "S$"] {
            objects.object(&name(text)).unwrap();
        }
        assert_eq!(objects.unit("S"), [name("S"), name("S.A"), name("S.A.B")]);
        assert!(objects.unit("T").is_empty());
        assert_eq!(objects.units(), 2, "S and SA");
    }
}
