//! Tests of commands about the machine.

use super::{DOT, MAX_BEGINS, told};
use crate::{memory::INITIAL_WORKING_STORAGE, port::Effect};

#[test]
fn the_status_says_what_is_open() {
    let mut desk = told("A := BEGIN_STRUCTURE B := BEGIN_STRUCTURE BEGIN; BEGIN; OPTIMIZE STRUCTURE; CONFIGURE X;");
    let said = desk.tell("COMMAND STATUS;");
    assert!(said.iter().all(|line| line.starts_with("I 11 *** ")), "{said:?}");
    for expected in [
        "2 BEGIN_STRUCTURE open: A, A.B",
        "2 BEGIN open; the picture stands still until END",
        "OPTIMIZE STRUCTURE on",
        "configure mode on",
    ] {
        assert!(said.iter().any(|line| line.ends_with(expected)), "{expected}: {said:?}");
    }
    desk.tell("!RESET;");
    let said = desk.tell("COMMAND STATUS;");
    for expected in ["*** 0 BEGIN_STRUCTURE open", "*** 0 BEGIN open", "OPTIMIZE STRUCTURE off"] {
        assert!(said.iter().any(|line| line.ends_with(expected)), "{expected}: {said:?}");
    }
    assert!(!desk.memory.structures.is_held());
}

#[test]
fn ends_without_beginnings_are_errors() {
    let mut desk = told("");
    for command in ["END;", "END_STRUCTURE;", "END OPTIMIZE;", "FINISH CONFIGURATION;", "END_FONT;"] {
        let said = desk.tell(command);
        assert!(
            said.len() == 1 && said[0].starts_with("E 4 *** ") && said[0].contains("without"),
            "{command}: {said:?}"
        );
    }
    desk.tell(&"BEGIN;".repeat(MAX_BEGINS as usize));
    assert_eq!(desk.tell("BEGIN;"), ["E 4 *** BEGIN nests at most 1000 deep"]);
    assert!(desk.tell(&"END;".repeat(MAX_BEGINS as usize)).is_empty());
    assert!(!desk.memory.structures.is_held());
}

#[test]
fn only_the_outermost_end_shows_what_changed() {
    let mut desk = told(&format!("BEGIN; {DOT} BEGIN; DISPLAY D; END;"));
    let held = desk.memory.structures.version();
    assert!(desk.memory.structures.is_held());
    desk.tell("END;");
    assert!(!desk.memory.structures.is_held() && desk.memory.structures.version() > held);
}

#[test]
fn two_lines_between_begin_and_end_wait_for_each_other() {
    let mut desk = told("BEGIN;");
    let mut other = super::Interpreter::default();
    other.execute(protocol::command::Command::Begin, &mut desk.memory, &mut desk.messages);
    desk.tell("END;");
    assert!(desk.memory.structures.is_held());
    assert_eq!(other.abandon(&mut desk.memory).as_deref(), Some("BEGIN"));
    assert!(!desk.memory.structures.is_held());
}

#[test]
fn the_password_guards_configuration_and_reboot() {
    let mut desk = told("CONFIGURE ANYTHING; SETUP PASSWORD SESAME; FINISH CONFIGURATION;");
    assert_eq!(desk.tell("SETUP PASSWORD X;"), ["E 4 *** SETUP PASSWORD needs CONFIGURE"]);
    assert_eq!(desk.tell("CONFIGURE X; REBOOT X;"), ["E 4 *** the password is wrong"; 2]);
    assert!(desk.memory.effects.is_empty());
    assert!(desk.tell("CONFIGURE sesame; FINISH CONFIGURATION; REBOOT SESAME;").is_empty());
    assert_eq!(desk.memory.effects, [Effect::Restart]);
}

#[test]
fn configure_mode_may_change_what_is_the_systems() {
    let mut desk = told("SYSTEM := F:NOP;");
    desk.memory.objects.seal_system();
    let refusal = "E 9 *** SYSTEM belongs to the system";
    assert_eq!(desk.tell("DELETE SYSTEM; FORGET SYSTEM; SYSTEM := F:ADD; SYSTEM := NIL;"), [refusal; 4]);
    assert_eq!(desk.tell("CONFIGURE X; SYSTEM := F:ADD;"), ["W 3 *** SYSTEM redefined"]);
    assert!(desk.tell("DELETE SYSTEM; FINISH CONFIGURATION;").is_empty());
    assert!(!desk.memory.is_defined(desk.id("SYSTEM")));
}

#[test]
fn interfaces_are_kept_and_shown() {
    let mut desk = told("SETUP INTERFACE PORT1/SPEED=9600/PARITY=EVEN; SETUP INTERFACE PORT1/SPEED=300;");
    assert_eq!(desk.tell("SHOW INTERFACE PORT1;"), ["I 11 *** interface PORT1: PARITY=EVEN SPEED=300"]);
    assert_eq!(desk.tell("SHOW INTERFACE PORT2;"), ["I 11 *** interface PORT2: nothing is set"]);
    desk.memory.structures.set_frame(77);
    assert_eq!(desk.tell("SHOW INTERRUPTS;"), ["I 11 *** 77 interrupts of the refresh clock"]);
    let many: String = (0..100).map(|n| format!("SETUP INTERFACE P{n}/A=1;")).collect();
    assert!(desk.tell(&many).iter().all(|said| said == "E 8 *** Insufficient memory"));
}

#[test]
fn working_storage_only_grows_until_initialize() {
    let mut desk = told("RESERVE_WORKING_STORAGE 100000;");
    let bytes = desk.memory.bytes();
    desk.tell("RESERVE_WORKING_STORAGE 500;");
    assert_eq!(desk.memory.system.working_storage, 100_000);
    desk.tell("RESERVE_WORKING_STORAGE 100500;");
    assert_eq!(desk.memory.bytes(), bytes + 500);
    assert_eq!(desk.tell("RESERVE_WORKING_STORAGE 4000000000;"), ["E 8 *** Insufficient memory"]);
    desk.tell("INITIALIZE;");
    assert_eq!(desk.memory.system.working_storage, INITIAL_WORKING_STORAGE);
}

#[test]
fn commands_without_an_effect_are_accepted() {
    assert!(told("").tell("GIVE_UP_CPU; ALLOW_VECNORM; OPTIMIZE MEMORY; OPTIMIZE STRUCTURE; END OPTIMIZE;").is_empty());
}

#[test]
fn initialize_in_each_form_clears_its_own_class() {
    let setup = format!("{DOT} DISPLAY D; F := F:NOP; VARIABLE V; CONNECT F<1>:<1>V;");
    let mut desk = told(&format!("{setup} INITIALIZE CONNECTIONS; SEND 1 TO <1>F;"));
    assert!(desk.delivered().is_empty() && desk.picture().len() == 1);
    let mut desk = told(&format!("{setup} INITIALIZE DISPLAYS; SEND 1 TO <1>F;"));
    assert!(desk.delivered().len() == 1 && desk.picture().is_empty() && desk.memory.is_defined(desk.id("D")));
    let mut desk = told(&format!("{setup} INITIALIZE NAMES;"));
    assert!(!desk.memory.is_defined(desk.id("D")));
    desk.tell(DOT);
    assert_eq!(desk.picture().len(), 1, "the display list stays");
    let desk = told(&format!("{setup} A := BEGIN_STRUCTURE BEGIN; PREFIX D WITH SCALE BY 2; INITIALIZE;"));
    let held = desk.memory.structures.is_held();
    assert!(desk.memory.objects.is_empty() && desk.memory.bytes() == INITIAL_WORKING_STORAGE as usize && !held);
    assert_eq!(desk.memory.structures.displayed().count(), 0);
}
