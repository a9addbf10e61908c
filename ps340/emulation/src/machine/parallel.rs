//! The machine's side of the parallel interface: command words, look-up, logical and physical reads and writes.

use super::{
    Machine,
    addresses::Addresses,
    host_line::HostLine,
    mailbox::Mailbox,
    parallel_line::{Attached, ParallelLine, ParallelState},
};
use crate::{interpreter::Message, structure::PhysicalFault};
use protocol::{
    Name,
    parallel::{
        AddressList, Code, CommandWord, DONE, ERROR, INFORMATION, MAX_BLOCK_BYTES, MAX_LOOKUP, ParallelError,
        ParallelFrame, swap, write_block, write_word,
    },
};

/// Frames that the words and blocks of a command may take: half a minute. Ours; the driver of the time gave up after
/// half a second, but there was no network between.
const TRANSFER_FRAMES: u64 = 1800;
impl ParallelLine {
    /// Takes bytes from the host, and carries out what they request; the answers are appended to `out`.
    pub(super) fn receive(&mut self, bytes: &[u8], machine: &mut Machine, out: &mut Vec<u8>) {
        self.frames.push(bytes);
        while let Some(frame) = self.frames.next() {
            let before = std::mem::take(&mut self.noise);
            match frame {
                ParallelFrame::Word(word) => self.word(word, machine, out),
                ParallelFrame::Block(block) => self.block(block, machine, out),
                ParallelFrame::Reset => self.reset(0, machine, out),
                ParallelFrame::Noise(_) => {
                    self.noise = before + 1;
                    machine.counters.noise += 1;
                    if before == 0 {
                        let text = "bytes on the parallel interface begin no frame and are dropped";
                        machine.report(Message::Line(text.into()));
                        fail(0, ParallelError::Command, out);
                    }
                }
            }
        }
    }

    fn word(&mut self, word: u16, machine: &mut Machine, out: &mut Vec<u8>) {
        match std::mem::replace(&mut self.state, ParallelState::Idle) {
            ParallelState::Count(command) => match check_count(command.code, word) {
                Ok(()) => self.state = ParallelState::Flag(command, word),
                Err(error) => fail(command.word(), error, out),
            },
            ParallelState::Flag(command, count) if command.code == Code::ReadNet => {
                self.read_net(command, count, word != 0, machine, out);
            }
            ParallelState::Flag(command, count) => self.state = ParallelState::Block(command, count, word != 0),
            ParallelState::Block(command, _, _) => fail(command.word(), ParallelError::Command, out),
            // While it waits, a command may be aborted, and any other gives it up too.
            ParallelState::Idle | ParallelState::Mail(_) | ParallelState::Refresh(_, _) => {
                match CommandWord::from_word(word) {
                    Some(command) => self.command(command, machine, out),
                    None => fail(word & 0xf00f, ParallelError::Command, out),
                }
            }
        }
    }

    fn command(&mut self, command: CommandWord, machine: &mut Machine, out: &mut Vec<u8>) {
        let allowed = match command.code {
            Code::ReadNet | Code::WriteNet => self.attached == Some(Attached::ForAll),
            code => !code.has_transfer() || self.attached.is_some(),
        };
        if !allowed {
            return fail(command.word(), ParallelError::Command, out);
        }
        match command.code {
            Code::Reset => return self.reset(command.unit, machine, out),
            Code::Attach | Code::DiagnosticAttach => {
                let for_all = command.code == Code::Attach;
                self.attached = Some(if for_all { Attached::ForAll } else { Attached::ForMemory });
                machine.lines.mailbox(self.line).open = for_all;
            }
            Code::Detach => self.let_go(machine),
            Code::ReadNet => {
                self.state = ParallelState::Mail(command);
                return self.serve_mail(machine, out);
            }
            _ => {}
        }
        write_word(command.word(), out);
        if command.code.has_transfer() {
            self.deadline = machine.frame + TRANSFER_FRAMES;
            self.state = ParallelState::Count(command);
        }
    }

    fn reset(&mut self, unit: u8, machine: &mut Machine, out: &mut Vec<u8>) {
        self.let_go(machine);
        self.state = ParallelState::Idle;
        write_word(CommandWord { code: Code::Reset, unit }.word(), out);
    }

    /// The host is no longer attached; what it began is given up.
    fn let_go(&mut self, machine: &mut Machine) {
        self.attached = None;
        self.addresses = Addresses::default();
        *machine.lines.mailbox(self.line) = Mailbox::default();
        if let Some(open) = self.host.abandon(&mut machine.memory) {
            machine.report(Message::Structure(format!("the host left while {open} was open")));
        }
        self.host = HostLine::new(self.line, self.plain_text);
    }

    /// Answers RDNET if a message is there.
    pub(super) fn serve_mail(&mut self, machine: &mut Machine, out: &mut Vec<u8>) {
        let ParallelState::Mail(command) = self.state else { return };
        let mailbox = machine.lines.mailbox(self.line);
        let lost = std::mem::take(&mut mailbox.lost);
        if !mailbox.messages.is_empty() {
            write_word(command.word(), out);
            self.deadline = machine.frame + TRANSFER_FRAMES;
            self.state = ParallelState::Count(command);
        }
        if lost > 0 {
            let text = format!("{lost} messages to a host on the parallel interface were lost: it does not read them");
            machine.report(Message::Line(text));
        }
    }

    fn read_net(&mut self, command: CommandWord, count: u16, swapped: bool, machine: &mut Machine, out: &mut Vec<u8>) {
        let mut message = machine.lines.mailbox(self.line).pop().unwrap_or_default();
        // A buffer that is too small gets the beginning, as in the library of the time.
        message.truncate(usize::from(count));
        give(command, message, swapped, out);
    }

    fn block(&mut self, mut block: Vec<u8>, machine: &mut Machine, out: &mut Vec<u8>) {
        let (command, count, swapped) = match std::mem::replace(&mut self.state, ParallelState::Idle) {
            ParallelState::Block(command, count, swapped) => (command, usize::from(count), swapped),
            state => {
                let word = match state {
                    ParallelState::Count(command) | ParallelState::Flag(command, _) => command.word(),
                    _ => 0,
                };
                return fail(word, ParallelError::Command, out);
            }
        };
        if block.len() != count.next_multiple_of(2) {
            return fail(command.word(), ParallelError::ByteCount, out);
        }
        if swapped {
            swap(&mut block);
        }
        block.truncate(count);
        let result = match command.code {
            Code::WriteNet => {
                self.host.receive(&block, machine);
                done(command, out);
                Ok(())
            }
            Code::Lookup => self.look_up(&block, machine).map(|address| {
                done(command, out);
                write_word(command.word() | INFORMATION, out);
                write_word((address >> 16) as u16, out);
                write_word(address as u16, out);
            }),
            Code::ReadPhysical => self.read_memory(&block, machine).map(|bytes| give(command, bytes, swapped, out)),
            Code::WritePhysical => self.write_memory(&block, machine).map(|()| done(command, out)),
            Code::WritePhysicalSync => {
                self.state = ParallelState::Refresh(command, block);
                Ok(())
            }
            _ => Err(ParallelError::Command),
        };
        if let Err(error) = result {
            fail(command.word(), error, out);
        }
    }

    /// A refresh begins: what waited for it is written. A command that takes too long is given up.
    pub(super) fn frame(&mut self, machine: &mut Machine, out: &mut Vec<u8>) {
        match &self.state {
            ParallelState::Refresh(command, block) => {
                match self.write_memory(block, machine) {
                    Ok(()) => done(*command, out),
                    Err(error) => fail(command.word(), error, out),
                }
                self.state = ParallelState::Idle;
            }
            ParallelState::Count(command) | ParallelState::Flag(command, _) | ParallelState::Block(command, _, _)
                if machine.frame >= self.deadline =>
            {
                fail(command.word(), ParallelError::Timeout, out);
                self.state = ParallelState::Idle;
            }
            _ => {}
        }
    }

    fn look_up(&mut self, name: &[u8], machine: &Machine) -> Result<u32, ParallelError> {
        let text = std::str::from_utf8(name).map_err(|_| ParallelError::Name)?;
        let name = Name::new(text.trim_end_matches(['\0', ' '])).map_err(|_| ParallelError::Name)?;
        let id = machine.memory.objects.find(name.as_str()).filter(|id| machine.memory.is_defined(*id));
        let words = machine.memory.physical_words(id.ok_or(ParallelError::Name)?);
        self.addresses.give(&name, u32::try_from(words).map_err(|_| ParallelError::Address)?)
    }

    fn read_memory(&self, block: &[u8], machine: &Machine) -> Result<Vec<u8>, ParallelError> {
        let (list, _) = AddressList::read(block)?;
        if 2 * list.words() > MAX_BLOCK_BYTES {
            return Err(ParallelError::ByteCount);
        }
        let mut bytes = Vec::with_capacity(2 * list.words());
        for piece in &list.0 {
            let (name, offset) = self.addresses.find(piece.address)?;
            let id = machine.memory.objects.find(name.as_str()).ok_or(ParallelError::Address)?;
            let words = machine.memory.physical_read(id, offset, piece.words.into()).map_err(parallel_error)?;
            bytes.extend(words.into_iter().flat_map(u16::to_be_bytes));
        }
        Ok(bytes)
    }

    fn write_memory(&self, block: &[u8], machine: &mut Machine) -> Result<(), ParallelError> {
        let (list, data) = AddressList::read(block)?;
        if data.len() != 2 * list.words() {
            return Err(ParallelError::ByteCount);
        }
        let words: Vec<u16> = data.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
        let mut rest = words.as_slice();
        for piece in &list.0 {
            let (now, later) = rest.split_at(piece.words.into());
            let (name, offset) = self.addresses.find(piece.address)?;
            let id = machine.memory.objects.find(name.as_str()).ok_or(ParallelError::Address)?;
            machine.memory.physical_write(id, offset, now).map_err(parallel_error)?;
            rest = later;
        }
        Ok(())
    }
}

/// Whether a command may have a byte count.
fn check_count(code: Code, count: u16) -> Result<(), ParallelError> {
    let allowed = match code {
        Code::Lookup => (1..=MAX_LOOKUP).contains(&count.into()),
        Code::ReadNet | Code::WriteNet => (1..=MAX_BLOCK_BYTES).contains(&count.into()),
        _ => count > 0 && count.is_multiple_of(2),
    };
    if allowed { Ok(()) } else { Err(ParallelError::ByteCount) }
}

fn parallel_error(fault: PhysicalFault) -> ParallelError {
    match fault {
        PhysicalFault::Outside(..) => ParallelError::Address,
        PhysicalFault::NotFinite(_) | PhysicalFault::Mark(_) => ParallelError::Data,
    }
}

/// Gives the host a block, with its byte count before it.
fn give(command: CommandWord, mut bytes: Vec<u8>, swapped: bool, out: &mut Vec<u8>) {
    write_word(command.word() | INFORMATION, out);
    write_word(bytes.len() as u16, out);
    if bytes.len() % 2 == 1 {
        bytes.push(0);
    }
    if swapped {
        swap(&mut bytes);
    }
    write_block(&bytes, out);
    done(command, out);
}

fn done(command: CommandWord, out: &mut Vec<u8>) {
    write_word(command.word() | DONE, out);
}

fn fail(word: u16, error: ParallelError, out: &mut Vec<u8>) {
    write_word(word | ERROR, out);
    write_word(error as u16, out);
}

#[cfg(test)]
mod tests;
