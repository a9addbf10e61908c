//! The arguments of `peris show`.

use crate::cli::timeouts::TimeoutArguments;
use crate::cli::values::frames;
use crate::cli::{SCRIPT_HELP, ScriptArguments};
use crate::workstation::{Drawing, DrawnEdges, MotionPeriod};
use clap::Args;
use protocol::address::Address;
use std::{num::NonZeroUsize, ops::Range, path::PathBuf};

/// Most pictures of a flip-book.
const MOST_PICTURES: u32 = 1_000;

#[derive(Args, Clone, Debug)]
pub(super) struct ShowArguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    pub(super) script: String,
    #[command(flatten)]
    pub(super) definitions: ScriptArguments,
    /// The host line of a PS 340 that runs already (tcp:HOST:PORT or unix:PATH); without it, one is started, with a
    /// window if there is a display, and the lines of standard input are operator commands ('help' lists them)
    #[arg(long, value_name = "LINE")]
    pub(super) to: Option<Address>,
    /// Sends the scene and ends, without waiting for keys
    #[arg(long, requires = "to")]
    pub(super) once: bool,
    /// Shows the scene anew whenever its script, or a file that this reads, is saved. The view stays as dials have set
    /// it, unless the script asks for another camera than before
    #[arg(long, conflicts_with = "once")]
    pub(super) watch: bool,
    /// Denoises what key 1 renders, when all samples are there
    #[arg(long, conflicts_with = "once")]
    pub(super) denoise: bool,
    /// Samples of a pixel that key 1 takes, instead of those of the scene
    #[arg(long, value_name = "COUNT", conflicts_with = "once", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    pub(super) samples: Option<u32>,
    /// Reports what was sent as JSON on standard output
    #[arg(long)]
    pub(super) json: bool,
    /// The edges that are sent
    #[arg(long, value_enum, default_value = "grid")]
    pub(super) lines: DrawnEdges,
    /// Edges that bend more than this are always sent, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = Drawing::default().crease_degrees)]
    pub(super) crease: f64,
    /// Sends polygons, materials and lights instead of vectors; the machine renders them itself when a host or operator
    /// sends FIX(1) to FIX(8) to <1>PERIS.SHADE, such as FIX(4), hidden lines, and FIX(8), Phong
    #[arg(long)]
    pub(super) facets: bool,
    /// Solves for the light that goes from diffuse surface to diffuse surface, and sends it as colours at the corners
    /// of polygons beside the vectors; the machine shades them on its raster screen whenever the dials have stood still
    #[arg(long, conflicts_with = "facets")]
    pub(super) radiosity: bool,
    /// Distance between curved surfaces and the lines sent, as a part of the object's diagonal
    #[arg(long, value_name = "PART", default_value_t = Drawing::default().tolerance, value_parser = crate::cli::values::part)]
    pub(super) tolerance: f64,
    /// Vectors of the picture, or with --facets corners of its polygons, to which instances are thinned out: those that
    /// are small in it are drawn coarsely, as outlines, as strokes, and then not at all. Other objects are drawn in full
    /// [default: 40000, which the machine draws 30 times a second, and 200000 corners]
    #[arg(long, value_name = "COUNT", value_parser = crate::cli::values::vectors)]
    pub(super) most: Option<usize>,
    /// What moves begins anew after so many seconds; the unit of time of a script is a second [default: when all that only
    /// turns is back where it was, and 4 s where something moves along]
    #[arg(long = "loop", value_name = "SECONDS", value_parser = crate::cli::values::period)]
    pub(super) period: Option<f64>,
    /// Shows a scene that is a function of the time as a flip-book: 0..48 are 48 pictures, picture K of the time K / RATE, in
    /// a loop. What changes is sent for all of them, an object of which only the place changes once
    #[arg(long, value_name = "A..B", value_parser = pictures, conflicts_with_all = ["time", "watch", "radiosity", "period"])]
    pub(super) frames: Option<Range<u32>>,
    /// Pictures in a second of a flip-book, 1 to 60
    #[arg(long, default_value_t = 24, requires = "frames", value_parser = clap::value_parser!(u32).range(1..=60))]
    pub(super) rate: u32,
    /// Opens no window, even if there is a display: operator commands from standard input do all
    #[arg(long, conflicts_with = "to")]
    pub(super) headless: bool,
    /// Threads that render [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = crate::cli::values::threads)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Writes the line of a script that asks for the view into this file, when key 3 is pressed and in the end
    #[arg(long, value_name = "FILE", conflicts_with = "once")]
    pub(super) camera: Option<PathBuf>,
    /// The folder below which operator commands such as 'picture vector a.png' write files
    #[arg(long, value_name = "DIR", default_value = ".", conflicts_with = "to")]
    pub(super) files: PathBuf,
    #[command(flatten)]
    pub(super) waits: TimeoutArguments,
}

impl ShowArguments {
    /// The times of the pictures of a flip-book, seconds; none if it is none.
    pub(super) fn times(&self) -> Option<impl Iterator<Item = f64> + use<>> {
        let rate = f64::from(self.rate);
        self.frames.clone().map(|frames| frames.map(move |number| f64::from(number) / rate))
    }

    /// The lines that are sent, and how they are made.
    pub(super) fn drawing(&self) -> Drawing {
        Drawing {
            lines: self.lines,
            crease_degrees: self.crease,
            tolerance: self.tolerance,
            facets: self.facets,
            most: self.most,
            motion: Some(self.period.map_or(MotionPeriod::Seamless, MotionPeriod::Seconds)),
        }
    }
}

/// Reads which pictures of a flip-book there are.
fn pictures(text: &str) -> Result<Range<u32>, String> {
    let frames = frames(text)?;
    let is_short = frames.len() <= MOST_PICTURES as usize;
    if is_short { Ok(frames) } else { Err(format!("a flip-book has at most {MOST_PICTURES} pictures")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_a_range_that_is_neither_empty_nor_long() {
        assert_eq!((pictures("0..48"), pictures("5..1005")), (Ok(0..48), Ok(5..1005)));
        for text in ["", "4..4", "0..1001", "0..4294967295"] {
            assert!(pictures(text).is_err(), "{text}");
        }
    }
}
