//! Carrying out the commands of a line one by one.

use super::{
    Interpreter, MAX_BEGINS, Message,
    definition::{self, Content, Scope},
    draft::Draft,
    edit, flow, service,
    session::FontDraft,
};
use crate::{
    memory::{MASS_MEMORY, MassMemory, Refusal},
    structure::Operation,
};
use protocol::{
    Name,
    command::{Command, FontCharacter, Initialize, Object, Operate, reference::name_of_object},
};
use std::collections::BTreeMap;

/// The warning about numbers of an operate command that are probably not meant.
fn doubtful(operate: &Operate, of: impl Fn() -> String) -> Option<Message> {
    Operation::doubt(operate).map(|text| Message::Doubtful { of: of(), text })
}

impl Interpreter {
    /// Carries out one command; what it has to report goes to `messages`.
    pub fn execute(&mut self, command: Command, memory: &mut MassMemory, messages: &mut Vec<Message>) {
        memory.privileged = self.privileged;
        if let Err(message) = self.try_execute(command, memory, messages) {
            messages.push(self.explain(message));
        }
        memory.privileged = false;
    }

    /// Reports of a name that is not found, if it is in the structure that is open, when it will be.
    fn explain(&self, message: Message) -> Message {
        match &message {
            Message::Refused(Refusal::NotFound(name)) => self.still_open(name).unwrap_or(message),
            _ => message,
        }
    }

    /// The message about a name of a node that is inside the open structure, and so not made yet.
    fn still_open(&self, name: &Name) -> Option<Message> {
        let draft = self.structure.as_ref()?;
        let full = draft.member(name)?;
        let text =
            format!("{name} is inside {}, which is still open: say this after END_STRUCTURE, of {full}", draft.title());
        Some(Message::Structure(text))
    }

    /// INCLUDE acts at once, so it cannot reach into the structure that is open; it would make other nodes instead.
    fn include(&self, name: &Name, into: &Name, memory: &mut MassMemory) -> Result<(), Message> {
        let defined = |name: &Name| memory.target(name).is_some_and(|id| memory.is_defined(id));
        // A member that is to be included under its full name will be there when the structure is.
        let named = self.structure.as_ref().and_then(|draft| draft.member(name)).filter(|full| full != name);
        let inside = named.map(|_| name).into_iter().chain([into]).find(|name| !defined(name));
        inside.and_then(|name| self.still_open(name)).map_or_else(|| edit::include(name, into, memory), Err)
    }

    fn try_execute(
        &mut self,
        command: Command,
        memory: &mut MassMemory,
        messages: &mut Vec<Message>,
    ) -> Result<(), Message> {
        match command {
            Command::Define { name, object } => self.define(name, object, memory, messages)?,
            Command::EndStructure => self.end_structure(memory, messages)?,
            Command::FontCharacter(character) => self.font_character(character, memory)?,
            Command::EndFont => self.end_font(memory, messages)?,
            Command::Begin => self.begin(memory)?,
            Command::End => self.end(memory)?,
            Command::Display(name) => edit::display(&name, memory)?,
            Command::Remove(name) => edit::remove(&name, memory),
            Command::Include { name, into } => self.include(&name, &into, memory)?,
            Command::RemoveFrom { name, from } => edit::remove_from(&name, &from, memory),
            Command::Delete(patterns) => edit::delete(&patterns, memory, messages),
            Command::Forget(name) => edit::forget(&name, memory)?,
            Command::ForgetUnit(unit) => edit::forget_unit(&unit, memory)?,
            Command::Prefix { name, operate } => {
                edit::prefix(&name, &operate, memory)?;
                messages.extend(doubtful(&operate, || format!("PREFIX {name}")));
            }
            Command::Follow { name, operate } => {
                edit::follow(&name, &operate, memory)?;
                messages.extend(doubtful(&operate, || format!("FOLLOW {name}")));
            }
            Command::RemovePrefix(name) => memory.remove_prefix(&name)?,
            Command::RemoveFollower(name) => memory.remove_follower(&name)?,
            Command::PatternWith { name, pattern } => edit::pattern_with(&name, &pattern, memory)?,
            Command::ErasePattern(name) => edit::erase_pattern(&name, memory)?,
            Command::Connect(arc) => flow::connect(&arc.source, arc.output, &arc.destination, memory)?,
            Command::ConnectSeveral { source, output, destinations } => {
                flow::connect_several(&source, output, &destinations, memory, messages);
            }
            Command::Disconnect { source, output, destination } => {
                flow::disconnect(&source, output, destination.as_ref(), memory);
            }
            Command::Send { value, destination } => flow::send(value, &destination, memory)?,
            Command::SendVectors { list, destination } => flow::send_vectors(&list, &destination, memory)?,
            Command::SendMarks { count, lines, destination } => flow::send_marks(count, lines, &destination, memory)?,
            Command::SendVariable { variable, destination } => flow::send_variable(&variable, &destination, memory)?,
            Command::Variable(names) => flow::variables(names, memory, messages),
            Command::SetupCness { constant, destination } => flow::setup_cness(constant, &destination, memory)?,
            Command::Initialize(what) => self.initialize(what, memory),
            Command::OptimizeStructure => self.optimize(true)?,
            Command::EndOptimize => self.optimize(false)?,
            Command::ReserveWorkingStorage(bytes) => memory.reserve(bytes)?,
            Command::CommandStatus => self.status(memory, messages),
            Command::Configure(password) => self.configure(&password, memory)?,
            Command::FinishConfiguration => self.finish_configuration()?,
            Command::SetupPassword(password) => self.setup_password(password, memory)?,
            Command::Reboot(password) => self.reboot(&password, memory)?,
            Command::SetupInterface { port, options } => service::setup_interface(port, options, memory)?,
            Command::ShowInterface(port) => service::show_interface(&port, memory, messages),
            Command::ShowInterrupts => service::show_interrupts(memory, messages),
            // The memory needs no packing, the network runs between any two commands, and all vectors are reals.
            Command::OptimizeMemory | Command::GiveUpCpu | Command::AllowVecnorm => {}
            Command::Reset => {
                self.abandon(memory);
            }
        }
        Ok(())
    }

    fn define(
        &mut self,
        name: Option<Name>,
        object: Object,
        memory: &mut MassMemory,
        messages: &mut Vec<Message>,
    ) -> Result<(), Message> {
        match object {
            Object::BeginStructure => self.begin_structure(name, memory),
            Object::BeginFont if self.font.is_some() => {
                Err(Message::Structure("BEGIN_FONT before END_FONT of the font before".into()))
            }
            Object::BeginFont => {
                self.font = Some(FontDraft { name, characters: BTreeMap::new() });
                Ok(())
            }
            Object::Function { function, size } => {
                // A function is made at once, also while a structure is open: its name is a full path.
                let name = name.ok_or_else(|| Message::Structure("a function needs a name".into()))?;
                flow::instance(name, &function, size, memory, messages)
            }
            object => {
                let of = self.title(name.as_ref(), &object);
                let doubt = match &object {
                    Object::Operate { operate, .. } => doubtful(operate, &of),
                    _ => None,
                };
                let content = Content::checked(object, of)?;
                self.add(name, content, memory, messages)?;
                messages.extend(doubt);
                Ok(())
            }
        }
    }

    /// What to call an object in messages: its full name, or what it is and where.
    fn title(&self, name: Option<&Name>, object: &Object) -> impl Fn() -> String + use<> {
        let path = self.structure.as_ref().and_then(|draft| draft.open().last()).cloned();
        let name = name.cloned();
        let word = name_of_object(object);
        move || match (&name, &path) {
            (Some(name), Some(path)) => format!("{path}.{name}"),
            (Some(name), None) => name.to_string(),
            (None, Some(path)) => format!("a {word} inside {path}"),
            (None, None) => format!("a {word}"),
        }
    }

    /// Makes an object, or keeps it for the structure that is open.
    fn add(
        &mut self,
        name: Option<Name>,
        content: Content,
        memory: &mut MassMemory,
        messages: &mut Vec<Message>,
    ) -> Result<(), Message> {
        if let Some(draft) = &mut self.structure {
            if memory.bytes() + draft.bytes() + content.bytes() > MASS_MEMORY {
                return Err(Refusal::Full.into());
            }
            return draft.push(name, content);
        }
        let name = name.ok_or_else(|| Message::Structure("only a structure holds objects without names".into()))?;
        let known = memory.objects.find(name.as_str()).is_some_and(|id| memory.is_defined(id));
        definition::define(&name, content, Scope::Outside, memory)?;
        if known {
            messages.push(Message::Redefined(name));
        }
        Ok(())
    }

    fn begin_structure(&mut self, name: Option<Name>, memory: &MassMemory) -> Result<(), Message> {
        match (&mut self.structure, name) {
            (Some(draft), _) if memory.bytes() + draft.bytes() > MASS_MEMORY => Err(Refusal::Full.into()),
            (Some(draft), name) => draft.begin(name),
            (None, Some(name)) => {
                self.structure = Some(Draft::new(name));
                Ok(())
            }
            (None, None) => Err(Message::Structure("BEGIN_STRUCTURE needs a name".into())),
        }
    }

    fn end_structure(&mut self, memory: &mut MassMemory, messages: &mut Vec<Message>) -> Result<(), Message> {
        let mut draft =
            self.structure.take().ok_or_else(|| Message::Structure("END_STRUCTURE without BEGIN_STRUCTURE".into()))?;
        if draft.end() {
            draft.commit(memory, messages);
        } else {
            self.structure = Some(draft);
        }
        Ok(())
    }

    fn font_character(&mut self, character: FontCharacter, memory: &MassMemory) -> Result<(), Message> {
        let without = || Message::Structure("a character of a font without BEGIN_FONT".into());
        let font = self.font.as_mut().ok_or_else(without)?;
        let held = font.characters.values().map(definition::font_bytes).sum::<usize>();
        if memory.bytes() + held + definition::font_bytes(&character) > MASS_MEMORY {
            return Err(Refusal::Full.into());
        }
        font.characters.insert(character.code, character);
        Ok(())
    }

    fn end_font(&mut self, memory: &mut MassMemory, messages: &mut Vec<Message>) -> Result<(), Message> {
        let font = self.font.take().ok_or_else(|| Message::Structure("END_FONT without BEGIN_FONT".into()))?;
        self.add(font.name, Content::Font(font.characters), memory, messages)
    }

    /// BEGIN: the picture stands still until the END of it. What is commanded and sent in between acts in order.
    fn begin(&mut self, memory: &mut MassMemory) -> Result<(), Message> {
        if self.begun >= MAX_BEGINS {
            return Err(Message::Structure(format!("BEGIN nests at most {MAX_BEGINS} deep")));
        }
        if self.begun == 0 {
            memory.structures.hold();
        }
        self.begun += 1;
        Ok(())
    }

    fn end(&mut self, memory: &mut MassMemory) -> Result<(), Message> {
        match self.begun {
            0 => return Err(Message::Structure("END without BEGIN".into())),
            1 => memory.structures.release(),
            _ => {}
        }
        self.begun -= 1;
        Ok(())
    }

    fn optimize(&mut self, on: bool) -> Result<(), Message> {
        match (self.optimizing, on) {
            (true, true) => Err(Message::Structure("OPTIMIZE STRUCTURE before END OPTIMIZE".into())),
            (false, false) => Err(Message::Structure("END OPTIMIZE without OPTIMIZE STRUCTURE".into())),
            _ => {
                self.optimizing = on;
                Ok(())
            }
        }
    }

    fn initialize(&mut self, what: Initialize, memory: &mut MassMemory) {
        match what {
            Initialize::All => {
                self.abandon(memory);
                memory.initialize();
            }
            Initialize::Connections => memory.restore_arcs(),
            Initialize::Displays => memory.structures.clear_displayed(),
            Initialize::Names => {
                let users = memory.objects.user_objects("");
                memory.undefine_all(users);
                memory.restore_structures();
            }
        }
    }
}
