//! `peris animate`: a scene that is a function of the time to frames, and to a moving picture.

mod arguments;
mod fingerprint;
mod frames;
mod sequence;

use super::progress::Progress;
use super::{CommandFailure, Exit, SubcommandRow, interrupts, output, progress, rendering};
use crate::memory;
use crate::picture::{Picture, animated_png, y4m_frame, y4m_header};
use crate::stages::stage;
use arguments::AnimateArguments;
use clap::{Args, FromArgMatches};
use files::{Destination, Folder};
use sequence::{FrameOrigin, Sequence};
use std::io::{Error, IsTerminal};
use std::path::PathBuf;
use std::time::Duration;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "animate",
    summary: "Renders a scene that is a function of the time into frames, and into a moving picture.",
    arguments: AnimateArguments::augment_args,
    run: |matches| run(&AnimateArguments::from_arg_matches(matches)?),
};

/// What was done so far.
#[derive(Default)]
struct Account {
    done: u32,
    rendered: u32,
    copied: u32,
    /// Wall-clock time of those that were rendered, seconds.
    seconds: f64,
    /// The largest part of the pixels of a frame that miss the error, 0..=1.
    missing: f64,
}

fn run(arguments: &AnimateArguments) -> Result<(), CommandFailure> {
    arguments.check()?;
    if arguments.y4m && std::io::stdout().is_terminal() {
        let message = "--y4m writes no text: lead standard output to an encoder, or into a file";
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    Folder::make(&arguments.output)?;
    let movie = arguments.movie()?;
    if !arguments.overwrite {
        frames::check_own(arguments)?;
    }
    output::say_errors_once();
    let account = make_frames(arguments)?;
    if let Some(movie) = &movie {
        write_movie(arguments, movie)?;
    }
    report(arguments, &account);
    rendering::check_error(&arguments.rendering, account.missing, "the frames are")
}

/// Sees to it that all frames are there.
fn make_frames(arguments: &AnimateArguments) -> Result<Account, CommandFailure> {
    let count = arguments.count();
    let mut sequence = Sequence::new(arguments);
    let mut account = Account::default();
    let mut size = None;
    for number in arguments.frames.clone() {
        let saved = format!("{} of {count} frames are there; the same command goes on", account.done);
        interrupts::note_saved(saved);
        progress::lead(&format!("frame {} of {count}{}", account.done + 1, left(&account, count)));
        let origin = sequence.make(number)?;
        if arguments.y4m {
            stream(arguments, number, &mut size)?;
        }
        tell(arguments, number, &origin);
        account.done += 1;
        match origin {
            FrameOrigin::Kept => {}
            FrameOrigin::Copied => account.copied += 1,
            FrameOrigin::Rendered { seconds, missing, .. } => {
                account.rendered += 1;
                account.seconds += seconds;
                account.missing = account.missing.max(missing);
            }
        }
    }
    interrupts::note_saved(format!("all {count} frames are there; the same command goes on"));
    Ok(account)
}

/// The time that is left if all further frames are rendered, and take as long as those before.
fn left(account: &Account, count: u32) -> String {
    let done = f64::from(account.rendered);
    let all = done + f64::from(count - account.done);
    progress::left(&Progress { done, all, unit: String::new() }, Duration::from_secs_f64(account.seconds))
}

/// Reports on a frame, unless it was there.
fn tell(arguments: &AnimateArguments, number: u32, origin: &FrameOrigin) {
    let files = arguments.files(number);
    let time = arguments.rate.time(number);
    if arguments.json {
        let (word, mut known) = match origin {
            FrameOrigin::Kept => ("kept", serde_json::json!({ "files": files })),
            FrameOrigin::Copied => ("copied", serde_json::json!({ "files": files })),
            FrameOrigin::Rendered { known, .. } => ("rendered", known.clone()),
        };
        (known["frame"], known["time"], known["origin"]) = (number.into(), time.into(), word.into());
        return output::report_line(&known);
    }
    let names: Vec<String> = files.iter().map(|path| path.display().to_string()).collect();
    let names = names.join(", ");
    match origin {
        _ if arguments.y4m => {}
        FrameOrigin::Kept => {}
        FrameOrigin::Copied => say!("{names}: at {time:.3} s, the same picture as the frame before"),
        FrameOrigin::Rendered { seconds, .. } => say!("{names}: at {time:.3} s, rendered in {seconds:.3} s"),
    }
}

/// Says what was done in all.
fn report(arguments: &AnimateArguments, account: &Account) {
    let Account { done, rendered, copied, .. } = *account;
    let kept = done - rendered - copied;
    if arguments.json || arguments.y4m {
        return;
    }
    let memory = memory::readable(memory::peak());
    say!("{done} frames: {rendered} rendered, {copied} copied, {kept} were there already; in {memory}");
    if let Some(movie) = &arguments.movie {
        say!("{}: {done} frames, {} a second", movie.display(), arguments.rate);
    }
}

/// A frame as it is shown: its file, columns and rows, and three bytes of sRGB a pixel.
fn shown(arguments: &AnimateArguments, number: u32) -> Result<(PathBuf, [u32; 2], Vec<u8>), CommandFailure> {
    let path = arguments.files(number).swap_remove(0);
    let picture = Picture::read(&path)?;
    Ok((path, [picture.width(), picture.height()], picture.to_srgb8()))
}

/// Writes a frame to standard output, and what comes before the first one.
///
/// - `size`: columns and rows of the first frame, once it is known.
fn stream(arguments: &AnimateArguments, number: u32, size: &mut Option<[u32; 2]>) -> Result<(), CommandFailure> {
    let (path, own, bytes) = shown(arguments, number)?;
    if size.is_none() {
        output::write_bytes(y4m_header(own, arguments.rate).as_bytes())?;
    }
    let first = *size.get_or_insert(own);
    check_size(&path, own, first)?;
    Ok(output::write_bytes(&y4m_frame(&bytes))?)
}

/// Writes the moving picture.
fn write_movie(arguments: &AnimateArguments, movie: &Destination) -> Result<(), CommandFailure> {
    let count = arguments.count();
    progress::lead("all frames are there");
    let stage = stage!("writing the moving picture", f64::from(count), "frames");
    let (_, size, _) = shown(arguments, arguments.frames.start)?;
    let frame = |index: u32| {
        let read = shown(arguments, arguments.frames.start + index).and_then(|(path, own, bytes)| {
            check_size(&path, own, size)?;
            Ok(bytes)
        });
        stage.progress(f64::from(index + 1));
        read.map_err(|failure| Error::other(failure.error))
    };
    Ok(movie.write(|file| animated_png(file, size, arguments.rate, count, frame))?)
}

/// Refuses a frame of another size than the first.
fn check_size(path: &std::path::Path, [width, height]: [u32; 2], first: [u32; 2]) -> Result<(), CommandFailure> {
    if [width, height] == first {
        return Ok(());
    }
    let message = format!(
        "{}: {width} x {height} pixels, and those before have {} x {}: a moving picture has one size, which --width and \
         --height set",
        path.display(),
        first[0],
        first[1]
    );
    Err(CommandFailure::new(Exit::Scene, anyhow::anyhow!(message)))
}
