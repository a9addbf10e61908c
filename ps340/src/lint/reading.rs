//! Reading the files: commands, what the machine replies to each, and where one program ends and the next begins.

use super::{
    Finding, Level, Note, flow, names, ports,
    program::Program,
    source_file::{Location, SourceFile},
};
use crate::{
    line::LineId,
    machine::{Input, Machine, Settings},
};
use protocol::{
    command::{Command, CommandReader, Initialize, Object, print},
    name::is_name_character,
};

const LINE: LineId = LineId(1);

/// Finds what is wrong in files, which are read one after the other as if one host sent them.
///
/// - `files`: name and content of each. Lines that begin with `@` are directives for the player; those that write files
///   or end the machine are found, the others passed over.
/// - Returns the findings by file and location.
pub fn lint(files: &[(String, Vec<u8>)]) -> Vec<Finding> {
    let sources: Vec<SourceFile> = files.iter().map(|(name, text)| SourceFile::new(name, text)).collect();
    let mut reading = Reading {
        sources: &sources,
        machine: machine(),
        message_count: 0,
        program: Program::default(),
        messages: Vec::new(),
        latest: None,
        notes: Vec::new(),
    };
    for file in 0..sources.len() {
        reading.file(file);
    }
    reading.end_of_program();
    let mut notes = reading.notes;
    notes.sort_by_key(|note| (note.location, note.level));
    notes.dedup_by(|a, b| a.location == b.location && a.text == b.text);
    let finding = |note: Note| {
        let source = &sources[note.location.file];
        let (line, column) = source.line_and_column(note.location.at);
        Finding { file: source.name.clone(), line, column, level: note.level, text: note.text }
    };
    notes.into_iter().map(finding).collect()
}

fn machine() -> Machine {
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    machine
}

struct Reading<'s> {
    sources: &'s [SourceFile],
    /// Carries every command out.
    machine: Machine,
    /// The number of messages that it has sent.
    message_count: u64,
    program: Program,
    /// The messages of the machine about the commands of this program.
    messages: Vec<MachineMessage>,
    /// The command that was read last.
    latest: Option<Location>,
    notes: Vec<Note>,
}

/// A message of the machine.
struct MachineMessage {
    location: Location,
    text: String,
    /// Whether the command is a CONNECT or a definition, about which more is known at the end.
    known: bool,
    /// The input that the command itself sends to, as `<1>NAME`.
    sent_to: Option<String>,
}

impl Reading<'_> {
    fn file(&mut self, file: usize) {
        let source = &self.sources[file];
        for (at, order) in &source.outgoing {
            let text = format!("'{order}' writes a file or ends the machine, which is done with --orders only");
            self.note(Location { file, at: *at }, Level::Warning, text);
        }
        let mut reader = CommandReader::default();
        reader.push(&source.text);
        while let Some(item) = reader.next() {
            let begin = reader.position() as usize;
            match item {
                Ok(spanned) => {
                    for warning in &spanned.warnings {
                        self.note(Location { file, at: begin + warning.span.start }, Level::Warning, warning.message());
                    }
                    let location = Location { file, at: begin + spanned.span.start };
                    let text = &source.text[location.at..(begin + spanned.span.end).min(source.text.len())];
                    self.command(&spanned.command, text, location);
                }
                Err(error) => {
                    self.program.fail(reader.statement(), Location { file, at: begin });
                    let location = Location { file, at: begin + error.span.start };
                    self.note(location, Level::Error, error.message());
                }
            }
        }
        if let Some((problem, at)) = reader.open() {
            self.note(Location { file, at: at as usize }, Level::Error, problem.to_string());
        } else if reader.is_unfinished() {
            let at = reader.unfinished_position() as usize;
            self.note(Location { file, at }, Level::Error, "the last statement has no ;".into());
        }
        while let Some((name, place)) = self.program.open().cloned() {
            self.note(place, Level::Error, format!("BEGIN_STRUCTURE of {name} has no END_STRUCTURE"));
            self.program.close();
            self.send_text(b"!RESET;".to_vec());
        }
    }

    fn command(&mut self, command: &Command, text: &[u8], location: Location) {
        if matches!(command, Command::Initialize(Initialize::All | Initialize::Names)) {
            self.end_of_program();
        }
        self.latest = Some(location);
        self.program.add(command, text, location);
        let known = match command {
            Command::Connect(_) | Command::ConnectSeveral { .. } => true,
            Command::Define { object: Object::Function { function, .. }, .. } => {
                crate::functions::find(function.as_str()).is_none()
            }
            _ => false,
        };
        let sent_to = match command {
            Command::Send { destination, .. }
            | Command::SendVariable { destination, .. }
            | Command::SendVectors { destination, .. }
            | Command::SendMarks { destination, .. } => Some(format!("{}{}", destination.input, destination.name)),
            _ => None,
        };
        for text in self.send_command(command) {
            self.messages.push(MachineMessage { location, text, known, sent_to: sent_to.clone() });
        }
    }

    /// Sends the machine a command and returns its messages.
    fn send_command(&mut self, command: &Command) -> Vec<String> {
        let mut text = Vec::new();
        print(command, &mut text);
        text.push(b'\n');
        self.send_text(text)
    }

    /// Sends the machine a text and returns its messages.
    fn send_text(&mut self, text: Vec<u8>) -> Vec<String> {
        self.machine.step([Input::Bytes(LINE, text)], 0);
        let said = self.machine.counters().messages;
        let new = usize::try_from(said - self.message_count).unwrap_or(usize::MAX);
        self.message_count = said;
        let kept = self.machine.log().count();
        self.machine.log().skip(kept.saturating_sub(new)).map(str::to_owned).collect()
    }

    /// Looks at the program that was read, and begins a new one.
    fn end_of_program(&mut self) {
        // What the picture shows only, such as a structure that contains itself.
        self.machine.renew_picture();
        let shown = self.send_text(Vec::new());
        for text in shown.into_iter().filter(|text| text.starts_with('E')) {
            if let Some(location) = self.latest {
                self.note(location, Level::Error, format!("up to here, when it is displayed: {text}"));
            }
        }
        let program = std::mem::take(&mut self.program);
        let sources = self.sources;
        let line_of = |location: Location| {
            let source = &sources[location.file];
            format!("at {}:{}", source.name, source.line_and_column(location.at).0)
        };
        let mut notes = names::check(&program, &self.machine, line_of);
        notes.extend(ports::check(&program, &self.machine));
        let flow = flow::check(&program, &self.machine);
        for said in std::mem::take(&mut self.messages) {
            let (text, _) = said.text.split_once("; did you mean ").unwrap_or((&said.text, ""));
            let undefined =
                notes.iter().any(|note| note.text.contains("never defined") && text.ends_with(note_name(note)));
            // Messages about a function that could not be made follow from that.
            let unmade = text.starts_with("E 2 ") && program.is_undefined(text.rsplit(' ').next().unwrap_or(""));
            // What comes along an arc that clashes is reported of the arc; what the command itself sends there is not.
            let follows = |input: &String| mentions(text, input) && said.sent_to.as_ref() != Some(input);
            let clashes = flow.clashes.iter().any(follows);
            if said.known || undefined || unmade || clashes {
                continue;
            }
            let level = match said.text.as_bytes() {
                // Redefinitions are reported with the location of the first definition.
                [b'I', ..] | [b'W', b' ', b'3', b' ', ..] => continue,
                [b'E', ..] => Level::Error,
                _ => Level::Warning,
            };
            notes.push(Note { location: said.location, level, text: readable(&said.text) });
        }
        notes.extend(flow.notes);
        self.notes.extend(notes);
    }

    fn note(&mut self, location: Location, level: Level, text: String) {
        self.notes.push(Note { location, level, text });
    }
}

/// Whether a text is about an input, given as `<1>NAME`, and not of one whose name only begins so.
fn mentions(text: &str, input: &str) -> bool {
    text.match_indices(input).any(|(at, _)| {
        let next = text.as_bytes().get(at + input.len());
        next.is_none_or(|byte| !is_name_character(*byte))
    })
}

/// The name at the beginning of a note about one.
fn note_name(note: &Note) -> &str {
    note.text.split(' ').next().unwrap_or_default()
}

/// `E 5 *** Text` as `Text (E 5)`.
fn readable(message: &str) -> String {
    match message.split_once(" *** ") {
        Some((number, text)) => format!("{text} ({number})"),
        None => message.into(),
    }
}
