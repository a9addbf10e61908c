//! Commands about the machine itself: status, password, configuration, interfaces.

use super::{Interpreter, Message, draft::Draft};
use crate::{
    memory::{MASS_MEMORY, MassMemory, Refusal},
    port::Effect,
};
use protocol::Name;

/// Names of open structures that COMMAND STATUS shows.
const SHOWN_LEVELS: usize = 8;

impl Interpreter {
    /// COMMAND STATUS: what is open on this line, its privilege, and what the machine holds.
    pub(super) fn status(&self, memory: &MassMemory, messages: &mut Vec<Message>) {
        let open = self.structure.as_ref().map_or(&[][..], |draft| draft.open());
        let mut structures = format!("{} BEGIN_STRUCTURE open", open.len());
        if !open.is_empty() {
            let names: Vec<&str> = open.iter().take(SHOWN_LEVELS).map(Name::as_str).collect();
            let more = if open.len() > SHOWN_LEVELS { ", ..." } else { "" };
            structures = format!("{structures}: {}{more}", names.join(", "));
        }
        let on = |on: bool| if on { "on" } else { "off" };
        let users = memory.objects.len().saturating_sub(memory.objects.system_len());
        let lines = [
            structures,
            self.held(memory),
            format!("{} BEGIN_FONT open", u32::from(self.font.is_some())),
            format!("OPTIMIZE STRUCTURE {}", on(self.optimizing)),
            format!("configure mode {}", on(self.privileged)),
            format!("{users} objects of users, {} of the system", memory.objects.system_len()),
            format!("{} units", memory.objects.units()),
            format!("{} of {MASS_MEMORY} bytes in use", memory.bytes()),
            format!("{} bytes of working storage", memory.system.working_storage),
        ];
        messages.extend(lines.into_iter().map(Message::Information));
    }

    /// How many BEGIN are open on this line, and who keeps the picture from changing.
    fn held(&self, memory: &MassMemory) -> String {
        let others = memory.structures.holds().saturating_sub(u32::from(self.begun > 0));
        let who = match (self.begun > 0, others) {
            (false, 0) => return "0 BEGIN open".into(),
            (true, 0) => "until END".into(),
            (true, n) => format!("until END, and that of {n} other lines"),
            (false, n) => format!("until END on {n} other lines"),
        };
        format!("{} BEGIN open; the picture stands still {who}", self.begun)
    }

    /// What is open on this line, for a prompt: `2 ROBOT.ARM` for structures, `BEGIN`; none if nothing is.
    pub fn open(&self) -> Option<String> {
        let levels = self.structure.as_ref().map(Draft::open).unwrap_or_default();
        let structure = levels.last().map(|path| format!("{} {path}", levels.len()));
        let font = self.font.as_ref().map(|_| "BEGIN_FONT".to_owned());
        let begun =
            (self.begun > 0).then(|| if self.begun == 1 { "BEGIN".into() } else { format!("BEGIN {}", self.begun) });
        let open: Vec<String> = [begun, structure, font].into_iter().flatten().collect();
        (!open.is_empty()).then(|| open.join(", "))
    }

    /// CONFIGURE: this line may change what belongs to the system.
    pub(super) fn configure(&mut self, password: &Name, memory: &MassMemory) -> Result<(), Message> {
        admitted(password, memory)?;
        self.privileged = true;
        Ok(())
    }

    /// FINISH CONFIGURATION.
    pub(super) fn finish_configuration(&mut self) -> Result<(), Message> {
        if !std::mem::take(&mut self.privileged) {
            return Err(Message::Structure("FINISH CONFIGURATION without CONFIGURE".into()));
        }
        Ok(())
    }

    /// SETUP PASSWORD, in configure mode only.
    pub(super) fn setup_password(&self, password: Name, memory: &mut MassMemory) -> Result<(), Message> {
        if !self.privileged {
            return Err(Message::Structure("SETUP PASSWORD needs CONFIGURE".into()));
        }
        memory.system.password = Some(password);
        Ok(())
    }

    /// REBOOT: the machine starts again. Only the password stays.
    pub(super) fn reboot(&mut self, password: &Name, memory: &mut MassMemory) -> Result<(), Message> {
        admitted(password, memory)?;
        self.abandon(memory);
        self.privileged = false;
        memory.effects.push(Effect::Restart);
        Ok(())
    }
}

fn admitted(password: &Name, memory: &MassMemory) -> Result<(), Message> {
    if memory.system.admits(password) { Ok(()) } else { Err(Message::Structure("the password is wrong".into())) }
}

/// SETUP INTERFACE.
pub(super) fn setup_interface(
    port: Name,
    options: Vec<(Name, String)>,
    memory: &mut MassMemory,
) -> Result<(), Message> {
    if memory.system.set_interface(port, options) { Ok(()) } else { Err(Refusal::Full.into()) }
}

/// SHOW INTERFACE.
pub(super) fn show_interface(port: &Name, memory: &MassMemory, messages: &mut Vec<Message>) {
    let options = memory.system.interface(port).unwrap_or_else(|| "nothing is set".into());
    messages.push(Message::Information(format!("interface {port}: {options}")));
}

/// SHOW INTERRUPTS: those that this machine has, one a frame.
pub(super) fn show_interrupts(memory: &MassMemory, messages: &mut Vec<Message>) {
    messages.push(Message::Information(format!("{} interrupts of the refresh clock", memory.structures.frame())));
}
