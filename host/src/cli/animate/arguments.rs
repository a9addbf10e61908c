//! The arguments of `peris animate`, and what they say of frames and their files.

use crate::cli::rendering_arguments::RenderingArguments;
use crate::cli::source::DefinitionArguments;
use crate::cli::values::{MOST_SECONDS, frames};
use crate::cli::{CommandFailure, Exit, SCRIPT_HELP};
use crate::picture::FrameRate;
use crate::script::Inputs;
use clap::{Args, ValueEnum};
use files::Destination;
use std::ops::Range;
use std::path::PathBuf;

/// Letters of the number of a frame in the name of its file, at least.
const LEAST_DIGITS: usize = 4;
/// The part of the time from frame to frame in which the shutter is open, if the script does not say it.
const SHUTTER: f64 = 0.5;

#[derive(Args, Debug)]
pub(super) struct AnimateArguments {
    #[arg(help = SCRIPT_HELP, value_name = "SCRIPT")]
    pub(super) script: String,
    #[command(flatten)]
    pub(super) definitions: DefinitionArguments,
    /// The frames: 0..240 are 240, the last of which is 239; 200 is one. Frame K shows the scene at the time K / RATE,
    /// the same whatever other frames are rendered. An exposure that is left to the meter is metered once, at the time 0:
    /// one that followed the scene would flicker
    #[arg(long, value_name = "A..B", value_parser = frames)]
    pub(super) frames: Range<u32>,
    /// Frames a second, such as 25, 23.976 or 24000/1001
    #[arg(long, value_name = "RATE", value_parser = FrameRate::parse, default_value = "24")]
    pub(super) rate: FrameRate,
    /// The folder for the frames, frame-0000.png and so on; it is made if need be. Frames that are there already, of the
    /// same scene and options, are left as they are
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
    /// The files of each frame
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_enum, default_value = "png")]
    pub(super) format: Vec<FrameFormat>,
    /// Renders over files of the same names that are no frames of this command; without it, they are refused
    #[arg(long)]
    pub(super) overwrite: bool,
    /// Writes all frames as a moving picture, too: an animated PNG (.png, .apng) that begins anew for ever
    #[arg(long, value_name = "FILE")]
    pub(super) movie: Option<PathBuf>,
    /// Writes each frame to standard output as soon as it is there, uncompressed (YUV4MPEG2, 4:4:4, BT.709), for an
    /// encoder: peris animate ... --y4m | ffmpeg -i - film.mp4
    #[arg(long, conflicts_with = "json")]
    pub(super) y4m: bool,
    #[command(flatten)]
    pub(super) rendering: RenderingArguments,
    /// Reports each frame as a line of JSON on standard output as soon as it is there
    #[arg(long)]
    pub(super) json: bool,
}

/// A kind of file in which a frame is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum FrameFormat {
    /// Eight-bit sRGB, as it is shown
    Png,
    /// Linear radiance, coverage as alpha
    Exr,
}

impl FrameFormat {
    /// The ending of its files.
    fn ending(self) -> &'static str {
        match self {
            FrameFormat::Png => "png",
            FrameFormat::Exr => "exr",
        }
    }
}

impl AnimateArguments {
    /// Refuses options that do not go together.
    pub(super) fn check(&self) -> Result<(), CommandFailure> {
        self.rendering.check(&[])?;
        let wrong = |message: String| Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
        let last = self.rate.time(self.frames.end);
        if last > MOST_SECONDS {
            return wrong(format!("frame {} is at {last:e} s, beyond {MOST_SECONDS:e}", self.frames.end));
        }
        let is_shown = self.format.contains(&FrameFormat::Png);
        match [("--movie", self.movie.is_some()), ("--y4m", self.y4m)].into_iter().find(|(_, given)| *given) {
            Some((name, _)) if !is_shown => wrong(format!("{name} is made of PNG files: add --format png,exr")),
            _ => Ok(()),
        }
    }

    /// The number of frames.
    pub(super) fn count(&self) -> u32 {
        self.frames.end - self.frames.start
    }

    /// What the script is given for a frame.
    pub(super) fn inputs(&self, number: u32) -> Inputs {
        self.definitions.inputs(self.rate.time(number), Some([0.0, SHUTTER * self.rate.time(1)]))
    }

    /// The files of a frame, that which is shown first.
    pub(super) fn files(&self, number: u32) -> Vec<PathBuf> {
        let digits = (self.frames.end - 1).checked_ilog10().map_or(1, |most| most as usize + 1).max(LEAST_DIGITS);
        let name = |format: &FrameFormat| format!("frame-{number:0digits$}.{}", format.ending());
        let wanted = [FrameFormat::Png, FrameFormat::Exr].into_iter().filter(|format| self.format.contains(format));
        wanted.map(|format| self.output.join(name(&format))).collect()
    }

    /// Where the moving picture will be written, tested.
    ///
    /// # Errors
    /// A [`CommandFailure`], also for the name of a frame.
    pub(super) fn movie(&self) -> Result<Option<Destination>, CommandFailure> {
        let Some(path) = &self.movie else { return Ok(None) };
        let wrong =
            |message: String| CommandFailure::new(Exit::Usage, anyhow::anyhow!("{}: {message}", path.display()));
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        if !matches!(ending.as_deref(), Some("png" | "apng")) {
            return Err(wrong("the name of a moving picture ends in .png or .apng".into()));
        }
        let is_inside = path.parent().is_some_and(|folder| {
            let real = |folder: &std::path::Path| folder.canonicalize().ok();
            folder == self.output || real(folder).is_some_and(|folder| real(&self.output) == Some(folder))
        });
        if is_inside && path.file_stem().is_some_and(|stem| stem.to_string_lossy().starts_with("frame-")) {
            return Err(wrong("this is the name of a frame: give the moving picture another one".into()));
        }
        Ok(Some(Destination::of(path)?))
    }
}
