//! The keyboard of the window: typed characters and keys become operator commands.

use super::{mapping::Mapping, operator_commands::OperatorCommands};
use egui::{Event, Key, Modifiers};

/// The operator commands that events of the keyboard mean.
///
/// A key of the mapping is its operator command; CONTROL with a letter is the control character; other text is typed.
fn commands_of(events: &[Event], mapping: &Mapping) -> Vec<String> {
    let mut orders: Vec<String> = Vec::new();
    let mut typed = String::new();
    for event in events {
        match event {
            // A pasted text is typed; its line ends are those of the key RETURN.
            Event::Text(text) => typed.push_str(&escape(text)),
            Event::Paste(text) => typed.push_str(&escape(&text.replace("\r\n", "\r").replace('\n', "\r"))),
            Event::Key { key, pressed: true, modifiers, .. } => {
                let order = mapping.key(*key, *modifiers).map(str::to_owned);
                if let Some(order) = order.or_else(|| control(*key, *modifiers)) {
                    flush(&mut typed, &mut orders);
                    orders.push(order);
                }
            }
            _ => {}
        }
    }
    flush(&mut typed, &mut orders);
    orders
}

/// Gives the operator commands.
pub fn type_events(events: &[Event], mapping: &Mapping, orders: &mut OperatorCommands) {
    commands_of(events, mapping).into_iter().for_each(|order| orders.give(order));
}

fn flush(typed: &mut String, orders: &mut Vec<String>) {
    if !typed.is_empty() {
        orders.push(format!("type {}", std::mem::take(typed)));
    }
}

/// CONTROL with a letter, as the operator command that types its control character.
fn control(key: Key, held: Modifiers) -> Option<String> {
    let mut letters = key.name().bytes();
    match (letters.next(), letters.next()) {
        (Some(letter @ b'A'..=b'Z'), None) if held.ctrl && !held.alt => Some(format!("type \\x{:02x}", letter - b'@')),
        _ => None,
    }
}

/// Text as the operator command `type` has it: the machine's characters are ASCII, others are left out.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars().filter(char::is_ascii) {
        match character {
            // An operator command loses blanks at its ends.
            '\\' => escaped.push_str("\\\\"),
            ' ' => escaped.push_str("\\x20"),
            '!'..='~' => escaped.push(character),
            other => escaped.push_str(&format!("\\x{:02x}", u32::from(other))),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    #[test]
    fn text_is_typed_and_keys_are_orders_in_their_order() {
        let events = [
            key(Key::D, Modifiers::NONE),
            Event::Text("d".into()),
            Event::Text(" \\".into()),
            key(Key::Enter, Modifiers::NONE),
            key(Key::F3, Modifiers::SHIFT),
            key(Key::C, Modifiers::CTRL),
        ];
        let orders = commands_of(&events, &Mapping::default());
        assert_eq!(orders, ["type d\\x20\\\\", "key return", "key 3 shift", "type \\x03"]);
    }

    #[test]
    fn what_is_not_ascii_is_left_out_and_pasted_lines_end_with_return() {
        let events = [Event::Text("é".into()), Event::Paste("A;\nB;\r\n".into())];
        assert_eq!(commands_of(&events, &Mapping::default()), ["type A;\\x0dB;\\x0d"]);
    }

    #[test]
    fn every_order_is_one_that_the_machine_reads() {
        for letter in 'A'..='Z' {
            let events = [key(Key::from_name(&letter.to_string()).unwrap(), Modifiers::CTRL)];
            for order in commands_of(&events, &Mapping::default()) {
                assert!(crate::operator::parse(&order).is_ok(), "{order}");
            }
        }
    }
}
