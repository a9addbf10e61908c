//! Words of the language, names and start bytes that mutations put in, and what a command is made of.

use crate::session;
use protocol::command::{Command, print, words::Word};
use ps340::functions;
use std::{collections::HashSet, sync::OnceLock};

/// Punctuation, inputs, values, packet starts, operator commands.
const PIECES: &[&str] = &[
    ";",
    ":=",
    ",",
    "'",
    "''",
    "{",
    "}",
    "(",
    ")",
    "<",
    ">",
    "=",
    ".",
    ":",
    "\n",
    "!RESET",
    "\n!RESET\n",
    "<1>",
    "<2>",
    "<3>",
    "<append>",
    "<clear>",
    "<delete>",
    "<last>",
    "<position>",
    "<step>",
    "<-1>",
    "<65535>",
    " THEN ",
    " APPLIED TO ",
    "A",
    "B",
    "V",
    "A.B",
    "NIL",
    "TRUE",
    "FALSE",
    "FIX(1)",
    "V2D(1,2)",
    "V3D(1,2,3)",
    "V4D(1,2,3,4)",
    "M2D(1,0 0,1)",
    "M3D(1,0,0 0,1,0 0,0,1)",
    "'text'",
    "CHAR(13)",
    "CONNECT A<1>:<1>A;",
    "CONNECT A<1>:<2>B;",
    "CONNECT A<1>:<1>HOST_MESSAGE;",
    "SEND TRUE TO <1>A;",
    "SEND 1 TO <1>A;",
    "SEND FIX(3) TO <2>A;",
    "SEND 'A' TO <1>A;",
    "INCLUDE A IN B;",
    "A := BEGIN_STRUCTURE ",
    "END_STRUCTURE;",
    "BEGIN;",
    "END;",
    "DISPLAY A;",
    "DELETE *;",
    "DELETE A*;",
    "INITIALIZE;",
    "INIT CONN;",
    "FORGET A;",
    "A := B;",
    "A := INSTANCE OF A,B;",
    "SEND V3D(1,2,3) TO <append>V;",
    "PREFIX V WITH SCALE BY 2;",
    "FOLLOW V WITH SET COLOR 120,1;",
    "REMOVE PREFIX OF V;",
    "REMOVE FOLLOWER OF V;",
    "V := VEC ITEM N=3 P 0,0 L 1,1 L 1,0;",
    "COMMAND STATUS;",
    "\x16",
    "\x16\x16",
    "\x1c",
    "\x1c 0",
    "\x1d",
    "\x10",
    "\x1b[",
    "\x1b[2J",
    "\x1b[9999;9999H",
    "\r\n",
];

/// What a mutation may put in.
pub fn vocabulary() -> &'static [Vec<u8>] {
    static WORDS: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    WORDS.get_or_init(|| {
        let words = Word::ALL.iter().map(|word| format!(" {} ", word.upper()).into_bytes());
        let shortest = Word::ALL.iter().map(|word| word.least().as_bytes().to_vec());
        let made = functions::all().map(|row| format!("A := F:{};", row.name).into_bytes());
        let sized = functions::all().map(|row| format!("B := F:{}(3);", row.name).into_bytes());
        let names = functions::all().map(|row| row.name.as_bytes().to_vec());
        let pieces = PIECES.iter().map(|piece| piece.as_bytes().to_vec());
        let acts = session::ACTS.iter().map(|act| vec![session::MARK, *act]);
        words.chain(shortest).chain(made).chain(sized).chain(names).chain(pieces).chain(acts).collect()
    })
}

/// Calls `each` with every pair of neighbouring words of the language in the printed form of a command.
pub fn pairs(command: &Command, mut each: impl FnMut(&str, &str)) {
    static KNOWN: OnceLock<HashSet<String>> = OnceLock::new();
    let known = KNOWN.get_or_init(|| {
        let functions = functions::all().map(|row| row.name.to_owned());
        Word::ALL.iter().map(|word| word.upper()).chain(functions).collect()
    });
    let mut text = Vec::new();
    print(command, &mut text);
    let text = String::from_utf8_lossy(&text[..text.len().min(500)]);
    let mut before = "";
    for word in text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| known.contains(*word)) {
        each(before, word);
        before = word;
    }
}
