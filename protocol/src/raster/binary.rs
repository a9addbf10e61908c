//! The records of raster packets: an opcode and fields, little-endian, 8 bits a colour. Ours.

use super::{LookupEntry, RasterCommand, Run};
use crate::record::{BinaryError, BinaryProblem, EncodeError, Reader, Witness, Writer, within};

/// Most runs in one record; a longer command is several records. Ours.
pub const MAX_RUNS: usize = 65_535;

/// Most entries in one lookup-table record. Ours: as many as the tables have.
pub const MAX_LOOKUP_ENTRIES: usize = 256;

/// Runs and entries that are reported to the witness one by one.
const LISTED: usize = 4;

/// Bytes of a run: count and colour.
const RUN: usize = 5;

/// What a raster record is: its first byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum RasterOpcode {
    /// Fills the screen.
    Erase = 1,
    /// The window of pixels.
    Window = 2,
    /// The current pixel.
    Position = 3,
    /// Runs of pixels.
    Runs = 4,
    /// Lookup-table entries.
    LookupTable = 5,
    /// A ramp in the lookup tables.
    LookupRamp = 6,
}

impl RasterOpcode {
    /// Every opcode, with the word for listings and the routine of the library of the time.
    pub const ALL: [(RasterOpcode, &str); 6] = [
        (RasterOpcode::Erase, "erase (PRASER)"),
        (RasterOpcode::Window, "window (PRASLD)"),
        (RasterOpcode::Position, "position (PRASCP)"),
        (RasterOpcode::Runs, "runs (PRASWP)"),
        (RasterOpcode::LookupTable, "lookup table (PRASLU)"),
        (RasterOpcode::LookupRamp, "lookup ramp (PRASLR)"),
    ];
}

/// Appends the records of a raster command: one, or several for more than [`MAX_RUNS`] runs.
///
/// # Errors
/// More than [`MAX_LOOKUP_ENTRIES`] entries; `out` is then as it was.
pub fn encode(command: &RasterCommand, out: &mut Vec<u8>) -> Result<(), EncodeError> {
    if let RasterCommand::LookupTable { entries, .. } = command {
        within("the number of lookup-table entries", entries.len(), MAX_LOOKUP_ENTRIES)?;
    }
    let mut writer = Writer::new(out);
    match command {
        RasterCommand::Erase { color } => {
            writer.u8(RasterOpcode::Erase as u8);
            writer.bytes(color);
        }
        RasterCommand::Window { x_min, y_min, x_max, y_max } => {
            writer.u8(RasterOpcode::Window as u8);
            [x_min, y_min, x_max, y_max].into_iter().for_each(|limit| writer.u16(*limit));
        }
        RasterCommand::Position { x, y } => {
            writer.u8(RasterOpcode::Position as u8);
            writer.u16(*x);
            writer.u16(*y);
        }
        RasterCommand::Runs(runs) => {
            // An empty list is a record too, so that decoding gives back what was encoded.
            let mut rest = runs.as_slice();
            loop {
                let (now, later) = rest.split_at(rest.len().min(MAX_RUNS));
                writer.u8(RasterOpcode::Runs as u8);
                writer.u16(now.len() as u16);
                for run in now {
                    writer.u16(run.count);
                    writer.bytes(&run.color);
                }
                if later.is_empty() {
                    break;
                }
                rest = later;
            }
        }
        RasterCommand::LookupTable { index, entries } => {
            writer.u8(RasterOpcode::LookupTable as u8);
            writer.u8(*index);
            writer.u16(entries.len() as u16);
            for entry in entries {
                writer.u8(entry.count);
                writer.bytes(&entry.color);
            }
        }
        RasterCommand::LookupRamp { min, max } => {
            writer.u8(RasterOpcode::LookupRamp as u8);
            writer.u8(*min);
            writer.u8(*max);
        }
    }
    Ok(())
}

/// The commands in the body of a raster packet; an error ends it.
pub fn decode(body: &[u8]) -> impl Iterator<Item = Result<RasterCommand, BinaryError>> {
    let mut at = 0;
    std::iter::from_fn(move || (at < body.len()).then(|| record(body, &mut at, &mut ())))
}

/// Reads one record of `body` from `at` on and moves `at` past it, or to the end after an error.
///
/// # Errors
/// [`BinaryError`] with the offset in `body`.
pub fn record<W: Witness>(body: &[u8], at: &mut usize, witness: &mut W) -> Result<RasterCommand, BinaryError> {
    let mut reader = Reader::new(body, *at, witness);
    *at = body.len();
    let code = reader.take(1, "opcode")?[0];
    let Some(&(opcode, word)) = RasterOpcode::ALL.iter().find(|row| row.0 as u8 == code) else {
        return Err(reader.error(1, "opcode", BinaryProblem::Unknown(code.into())));
    };
    reader.report(1, "opcode", format_args!("{word}"));
    let command = match opcode {
        RasterOpcode::Erase => RasterCommand::Erase { color: reader.color("colour")? },
        RasterOpcode::Window => RasterCommand::Window {
            x_min: reader.u16("first column")?,
            y_min: reader.u16("first line")?,
            x_max: reader.u16("last column")?,
            y_max: reader.u16("last line")?,
        },
        RasterOpcode::Position => RasterCommand::Position { x: reader.u16("column")?, y: reader.u16("line")? },
        RasterOpcode::Runs => runs(&mut reader)?,
        RasterOpcode::LookupTable => {
            let index = reader.u8("first entry")?;
            let count = usize::from(reader.u16("count")?);
            if count > MAX_LOOKUP_ENTRIES {
                let problem = BinaryProblem::TooMany { found: count, limit: MAX_LOOKUP_ENTRIES };
                return Err(reader.error(2, "count", problem));
            }
            let mut entries = Vec::with_capacity(count);
            for _ in 0..count {
                entries.push(LookupEntry { count: reader.u8("how many")?, color: reader.color("colour")? });
            }
            RasterCommand::LookupTable { index, entries }
        }
        RasterOpcode::LookupRamp => {
            RasterCommand::LookupRamp { min: reader.u8("first entry")?, max: reader.u8("last entry")? }
        }
    };
    *at = reader.at();
    Ok(command)
}

fn runs<W: Witness>(reader: &mut Reader<'_, '_, W>) -> Result<RasterCommand, BinaryError> {
    let count = usize::from(reader.u16("count")?);
    let place = reader.at();
    let bytes = reader.take(count * RUN, "runs")?;
    let run = |b: &[u8]| Run { count: u16::from_le_bytes([b[0], b[1]]), color: [b[2], b[3], b[4]] };
    let runs: Vec<Run> = bytes.chunks_exact(RUN).map(run).collect();
    for (index, Run { count, color: [r, g, b] }) in runs.iter().take(LISTED).enumerate() {
        let meaning = format_args!("{count} pixels of red {r}, green {g}, blue {b}");
        reader.report_at(place + index * RUN, RUN, "run", meaning);
    }
    if count > LISTED {
        reader.report((count - LISTED) * RUN, "runs", format_args!("{} more", count - LISTED));
    }
    Ok(RasterCommand::Runs(runs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn commands() -> impl Strategy<Value = RasterCommand> {
        let color = || any::<[u8; 3]>();
        let run = (any::<u16>(), color()).prop_map(|(count, color)| Run { count, color });
        let entry = (any::<u8>(), color()).prop_map(|(count, color)| LookupEntry { count, color });
        prop_oneof![
            color().prop_map(|color| RasterCommand::Erase { color }),
            any::<[u16; 4]>().prop_map(|[x_min, y_min, x_max, y_max]| RasterCommand::Window {
                x_min,
                y_min,
                x_max,
                y_max
            }),
            any::<[u16; 2]>().prop_map(|[x, y]| RasterCommand::Position { x, y }),
            prop::collection::vec(run, 0..20).prop_map(RasterCommand::Runs),
            (any::<u8>(), prop::collection::vec(entry, 0..20))
                .prop_map(|(index, entries)| RasterCommand::LookupTable { index, entries }),
            any::<[u8; 2]>().prop_map(|[min, max]| RasterCommand::LookupRamp { min, max }),
        ]
    }

    #[test]
    fn many_runs_become_several_records_of_the_same_runs() {
        let all: Vec<Run> = (0..MAX_RUNS + 10).map(|i| Run { count: i as u16, color: [1, 2, 3] }).collect();
        let mut body = Vec::new();
        encode(&RasterCommand::Runs(all.clone()), &mut body).unwrap();
        let decoded: Vec<RasterCommand> = decode(&body).map(Result::unwrap).collect();
        assert_eq!(decoded, [RasterCommand::Runs(all[..MAX_RUNS].into()), RasterCommand::Runs(all[MAX_RUNS..].into())]);
    }

    #[test]
    fn too_many_entries_are_refused_on_both_sides() {
        let entries = vec![LookupEntry { count: 1, color: [0; 3] }; 257];
        let mut out = Vec::new();
        assert!(encode(&RasterCommand::LookupTable { index: 0, entries }, &mut out).is_err());
        let error = decode(&[5, 0, 1, 1]).next().unwrap().unwrap_err();
        assert_eq!(error.problem, BinaryProblem::TooMany { found: 257, limit: 256 });
    }

    proptest! {
        #[test]
        fn decoding_what_was_encoded_gives_the_commands(commands in prop::collection::vec(commands(), 1..6)) {
            let mut body = Vec::new();
            commands.iter().for_each(|command| encode(command, &mut body).unwrap());
            let decoded: Result<Vec<RasterCommand>, BinaryError> = decode(&body).collect();
            prop_assert_eq!(decoded, Ok(commands));
        }

        #[test]
        fn any_bytes_end_in_commands_and_at_most_one_error(body in prop::collection::vec(0_u8..10, 0..60)) {
            let items: Vec<_> = decode(&body).collect();
            prop_assert!(items.iter().rev().skip(1).all(Result::is_ok));
        }
    }
}
