//! What rendering needs beside nodes.

use super::row::{CommandRow, Confidence::*, PLAIN, option};

pub(super) const ROWS: &[CommandRow] = &[CommandRow {
    name: "RESERVE_WORKING_STORAGE",
    section: "B.3",
    confidence: Confirmed,
    summary: "Memory for rendering; to be given before, unless 1,000 vertices are enough",
    syntax: &["RESERVE_WORKING_STORAGE bytes;"],
    options: &[option("bytes", "about 50 for each vertex; a larger request replaces the first", "0 and up", "")],
    routines: &["PRSVST"],
    example: "RESERVE_WORKING_STORAGE 100000;",
    ..PLAIN
}];
