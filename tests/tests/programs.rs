//! Several programs at one machine, each with questions and answers of its own.

use protocol::wire::{MessageForm, MessageReader};
use std::{
    io::{Read, Write},
    net::TcpStream,
    thread,
};
use tests::{Machine, TIMEOUT};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");

/// Questions of each program.
const QUESTIONS: usize = 10_000;
/// Questions that are on their way before the answers are read.
const AHEAD: usize = 100;

/// A program with messages of its own.
struct Program {
    stream: TcpStream,
    reader: MessageReader,
}

impl Program {
    fn attach(line: &str) -> Program {
        let stream = TcpStream::connect(line).expect("the machine listens");
        stream.set_read_timeout(Some(TIMEOUT)).expect("a time limit can be set");
        let mut program = Program { stream, reader: MessageReader::default() };
        let mut request = Vec::new();
        MessageForm::Own.write_request(&mut request);
        program.reader.expect(MessageForm::Own);
        program.send(&request);
        program
    }

    fn send(&mut self, bytes: &[u8]) {
        self.stream.write_all(bytes).expect("the machine reads");
    }

    fn message(&mut self) -> String {
        let mut buffer = [0; 4096];
        loop {
            if let Some(message) = self.reader.next() {
                return String::from_utf8(message.expect("it is whole")).expect("it is text");
            }
            let count = self.stream.read(&mut buffer).expect("an answer within the time limit");
            assert!(count > 0, "the machine closed the line");
            self.reader.push(&buffer[..count]);
        }
    }
}

/// Asks, reads the answers, and makes a mistake with every tenth question; each answer and each error is its own.
///
/// The network hands the number of the question back, after the name of the program.
fn ask(line: &str, name: &str) {
    let mut program = Program::attach(line);
    let network = format!(
        "{name}P := F:PRINT; {name}C := F:CCONCATENATE; SEND '{name} ' TO <1>{name}C; CONNECT {name}P<1>:<2>{name}C;
         CONNECT {name}C<1>:<1>HOST_MESSAGE;"
    );
    program.send(network.as_bytes());
    for first in (0..QUESTIONS).step_by(AHEAD) {
        let mut text = String::new();
        for number in first..first + AHEAD {
            text += &format!("SEND FIX({number}) TO <1>{name}P;");
            if number % 10 == 0 {
                text += &format!("SEND 0 TO <1>{name}X{number};");
            }
        }
        program.send(text.as_bytes());
        for number in first..first + AHEAD {
            assert_eq!(program.message(), format!("{name} {number}"));
        }
    }
    program.send(b"SEND 'end' TO <1>HOST_MESSAGE;");
    assert_eq!(program.message(), "end");
    for number in (0..QUESTIONS).step_by(10) {
        let report = program.reader.next_report().expect("one report a mistake");
        assert!(report.starts_with(&format!("E 2 *** Name not found: {name}X{number}")), "{report}");
    }
    assert_eq!(program.reader.next_report(), None);
}

#[test]
fn neither_of_two_programs_reads_what_is_the_others() {
    let machine = Machine::start(PS340, &[]);
    let mut plain = machine.attach();
    plain.send("CONNECT ERROR<1>:<1>HOST_MESSAGE; CONNECT WARNING<1>:<1>HOST_MESSAGE;");
    plain.synchronize();
    thread::scope(|scope| {
        for name in ["A", "B"] {
            let line = machine.line.clone();
            scope.spawn(move || ask(&line, name));
        }
    });
    // Nothing of all that reached a line that typed commands, and its own errors still do.
    plain.send("SEND 0 TO <1>NOBODY;");
    assert!(plain.message().starts_with("E 2 *** Name not found: NOBODY"));
}
