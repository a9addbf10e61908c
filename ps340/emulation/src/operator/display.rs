//! Display commands: knobs, phosphor, steadiness, which screen, and pictures in files.

use super::{
    DisplayCommand, OperatorCommand, OperatorCommandError, OperatorCommandRow, Screen, fault::REFUSED,
    word_reader::WordReader,
};
use crate::{
    calligraphic::{self, Controls, KNOBS, MAX_SIZE, PHOSPHORS, Phosphor, SCREENS},
    machine::Machine,
    picture::Picture,
};
use files::Sandbox;
use protocol::raster::{RASTER_HEIGHT, RASTER_WIDTH};
use std::io::Write;
use std::path::Path;

/// The rows of these commands.
pub(super) const DISPLAY_ROWS: &[OperatorCommandRow] = &[
    OperatorCommandRow {
        word: "picture",
        arguments: "vector|raster FILE [SIZE|WIDTHxHEIGHT]",
        summary: "write a screen as .png or .exr, the strokes of the vector screen as .svg or .txt",
        read: picture,
    },
    OperatorCommandRow {
        word: "knob",
        arguments: "[brightness|contrast|focus 0..1]",
        summary: "turn a knob of the display; alone: how they stand",
        read: knob,
    },
    OperatorCommandRow {
        word: "phosphor",
        arguments: "[NAME]",
        summary: "give the screen another phosphor; alone: list them",
        read: read_phosphor,
    },
    OperatorCommandRow {
        word: "steady",
        arguments: "[on|off]",
        summary: "whether a picture that takes long to draw stands still (on) or flickers as it did (off)",
        read: steady,
    },
    OperatorCommandRow {
        word: "screen",
        arguments: "[0..3]",
        summary: "look at another of the screens that SET DISPLAYS tells apart",
        read: screen,
    },
    OperatorCommandRow {
        word: "refresh",
        arguments: "",
        summary: "how long the beam needs for the picture, how often it draws it, and which processor makes its light",
        read: |_| Ok(OperatorCommand::Display(DisplayCommand::Refresh)),
    },
    OperatorCommandRow {
        word: "pixel",
        arguments: "X Y",
        summary: "red, green and blue, 0 to 255, of a pixel of the raster screen: columns from the left, lines from the bottom",
        read: pixel,
    },
];

fn bad<T>(found: &str, expected: &'static str) -> Result<T, OperatorCommandError> {
    Err(OperatorCommandError::Bad { found: found.into(), expected })
}

fn knob(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let Some(word) = words.next() else { return Ok(OperatorCommand::Display(DisplayCommand::Knob(None))) };
    let Some(knob) = KNOBS.iter().find(|knob| knob.name.eq_ignore_ascii_case(word)) else {
        return bad(word, "'brightness', 'contrast' or 'focus'");
    };
    let to = words.real(0.0, 1.0, "a number, 0 to 1")?;
    Ok(OperatorCommand::Display(DisplayCommand::Knob(Some((knob, to as f32)))))
}

fn read_phosphor(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let Some(word) = words.next() else { return Ok(OperatorCommand::Display(DisplayCommand::Phosphor(None))) };
    match calligraphic::phosphor(word) {
        Some(row) => Ok(OperatorCommand::Display(DisplayCommand::Phosphor(Some(row)))),
        None => bad(word, "a phosphor of the list 'phosphor'"),
    }
}

fn steady(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let on = match words.next() {
        None => None,
        Some("on") => Some(true),
        Some("off") => Some(false),
        Some(other) => return bad(other, "'on' or 'off'"),
    };
    Ok(OperatorCommand::Display(DisplayCommand::Steady(on)))
}

fn screen(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    if words.rest.is_empty() {
        return Ok(OperatorCommand::Display(DisplayCommand::Screen(None)));
    }
    let screen = words.integer(0, SCREENS - 1, "a screen, 0 to 3")?;
    Ok(OperatorCommand::Display(DisplayCommand::Screen(Some(screen))))
}

fn picture(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let screen = match words.required("'vector' or 'raster'")? {
        "vector" => Screen::Vector,
        "raster" => Screen::Raster,
        other => return bad(other, "'vector' or 'raster'"),
    };
    let rest = std::mem::take(&mut words.rest);
    // The size is the last word if it looks like one; file names may hold blanks.
    let (file, size) = match rest.rsplit_once(char::is_whitespace) {
        Some((file, last)) if screen == Screen::Vector && looks_like_a_size(last) => match size(last) {
            Some(size) => (file.trim_end(), Some(size)),
            None => return bad(last, "a size, 1 to 8192, or WIDTHxHEIGHT"),
        },
        _ => (rest, None),
    };
    if file.is_empty() {
        return Err(OperatorCommandError::Missing("a file name"));
    }
    Ok(OperatorCommand::Display(DisplayCommand::Picture { screen, file: file.into(), size }))
}

fn pixel(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let x = words.integer(0, RASTER_WIDTH - 1, "a column, 0 to 639")?;
    let y = words.integer(0, RASTER_HEIGHT - 1, "a line, 0 to 479")?;
    Ok(OperatorCommand::Display(DisplayCommand::Pixel { x, y }))
}

/// Whether a word is a number, or two with an x between them.
fn looks_like_a_size(word: &str) -> bool {
    let number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    word.split_once('x').map_or(number(word), |(width, height)| number(width) && number(height))
}

fn size(word: &str) -> Option<[u32; 2]> {
    let (width, height) = word.split_once('x').unwrap_or((word, word));
    let pixels = |part: &str| part.parse().ok().filter(|pixels| (1..=MAX_SIZE).contains(pixels));
    Some([pixels(width)?, pixels(height)?])
}

/// Carries out one of these commands.
///
/// # Errors
/// The reason why a file was not written.
pub(super) fn perform(
    order: &DisplayCommand,
    machine: &mut Machine,
    files: Option<&Sandbox>,
) -> Result<String, String> {
    let mut controls = *machine.controls();
    match order {
        DisplayCommand::Knob(None) => {}
        DisplayCommand::Knob(Some((knob, to))) => knob.set(&mut controls, *to),
        DisplayCommand::Phosphor(None) => return Ok(phosphors(&controls)),
        DisplayCommand::Phosphor(Some(row)) => controls.phosphor = row,
        DisplayCommand::Steady(on) => controls.steady = on.unwrap_or(controls.steady),
        DisplayCommand::Screen(screen) => controls.screen = screen.unwrap_or(controls.screen),
        DisplayCommand::Refresh => return Ok(refresh(machine)),
        DisplayCommand::Pixel { x, y } => {
            let [red, green, blue] = machine.frame_buffer().shown(*x, *y).unwrap_or_default();
            return Ok(format!("{red} {green} {blue}"));
        }
        DisplayCommand::Picture { screen, file, size } => {
            return write(machine, *screen, file, *size, files.ok_or(REFUSED)?);
        }
    }
    machine.set_controls(controls);
    Ok(match order {
        DisplayCommand::Knob(_) => {
            let stand = KNOBS.iter().map(|knob| format!("{} {}", knob.name, knob.get(&controls)));
            stand.collect::<Vec<_>>().join(", ")
        }
        DisplayCommand::Steady(_) => format!("steady {}", if controls.steady { "on" } else { "off" }),
        DisplayCommand::Screen(_) => format!("screen {}", controls.screen),
        _ => controls.phosphor.name.into(),
    })
}

/// The phosphors, a line each, the present one marked; with their sources.
fn phosphors(controls: &Controls) -> String {
    let line = |row: &Phosphor| {
        let mark = if row == controls.phosphor { '*' } else { ' ' };
        format!("{mark} {:<4} {} ({})", row.name, row.summary, row.source)
    };
    PHOSPHORS.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn refresh(machine: &mut Machine) -> String {
    machine.renew_picture();
    let refresh = machine.refresh().describe(machine.controls().steady);
    format!("{refresh}, drawn by {}", machine.screen().drawer())
}

/// Writes a picture or a drawing, by the ending of the file's name.
fn write(
    machine: &mut Machine,
    screen: Screen,
    file: &str,
    size: Option<[u32; 2]>,
    files: &Sandbox,
) -> Result<String, String> {
    let path = Path::new(file);
    let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    let drawing = match (screen, ending.as_deref()) {
        (Screen::Vector, Some("svg")) => calligraphic::svg,
        (Screen::Vector, Some("txt")) => |strokes: &_| calligraphic::text(strokes, usize::MAX) + "\n",
        _ => {
            let destination = Picture::destination_below(files, path).map_err(|e| e.to_string())?;
            let picture = match screen {
                Screen::Vector => machine.vector_picture(size),
                Screen::Raster => machine.raster_picture(),
            };
            picture.write(&destination).map_err(|e| e.to_string())?;
            return Ok(format!("{file} {}x{}", picture.width(), picture.height()));
        }
    };
    let destination = files.destination(path).map_err(|e| e.to_string())?;
    machine.renew_picture();
    let strokes = machine.visible_strokes();
    let text = drawing(&strokes);
    destination.write(|file| file.write_all(text.as_bytes())).map_err(|e| e.to_string())?;
    Ok(format!("{file} {} strokes", strokes.len()))
}
