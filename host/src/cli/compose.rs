//! `peris compose`: two pictures made one.

use super::output::warn;
use super::{CommandFailure, Exit, SubcommandRow, output};
use crate::picture::{self, Deep, Operator, Picture};
use clap::{Args, FromArgMatches};
use files::Destination;
use std::path::PathBuf;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "compose",
    summary: "Makes one picture of two: by their coverage, by their depth, or by adding their light.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A picture (.png, .exr). One that is put before another must have no background of its own, as from `peris render
    /// --matte`: its colours are premultiplied by its coverage. PNG files without alpha cover everything
    #[arg(value_name = "A")]
    a: PathBuf,
    /// How the two are combined; the light of pixels is linear, and coverage tells how much of each pixel is taken
    #[arg(value_name = "OP", value_enum)]
    operator: Operator,
    /// Another picture of the same size (.png, .exr)
    #[arg(value_name = "B")]
    b: PathBuf,
    /// The file to write: .exr with the coverage as alpha, .png as it looks before black
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// For over: at each pixel the nearer picture is over the farther one. A and B are EXR files of `peris render --layers
    /// --matte` from the same eye; an EXR file that is written has depth, too
    #[arg(long)]
    depth: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments { a, operator, b, output, depth, json } = arguments;
    let destination = Picture::destination(output)?;
    let picture = match depth {
        true => by_depth(arguments, &destination)?,
        false => {
            let (first, second) = (Picture::read_finite(a)?, Picture::read_finite(b)?);
            let [a_as_matte, b_as_matte] = operator.needs_mattes();
            warn_of_background(arguments, [(a_as_matte, &first), (b_as_matte, &second)]);
            let picture = picture::compose(&first, *operator, &second)?;
            picture.write(&destination)?;
            picture
        }
    };
    let covered: f64 = picture.pixels().iter().map(|pixel| f64::from(pixel.coverage)).sum();
    let (width, height, coverage) = (picture.width(), picture.height(), covered / picture.pixels().len() as f64);
    if *json {
        let known = serde_json::json!({ "file": output, "width": width, "height": height, "coverage": coverage });
        output::report(known);
    } else {
        say!("{}: {width} x {height} pixels, {:.1}% covered", output.display(), 100.0 * coverage);
    }
    Ok(())
}

/// Combines the pictures by their depth, and writes the result.
fn by_depth(arguments: &Arguments, destination: &Destination) -> Result<Picture, CommandFailure> {
    let Arguments { a, operator, b, .. } = arguments;
    let wrong = |message: String| CommandFailure::new(Exit::Usage, anyhow::anyhow!(message));
    if *operator != Operator::Over {
        return Err(wrong("--depth is for the operator over".into()));
    }
    if let Some(path) = [a, b].into_iter().find(|path| !Picture::is_exr(path)) {
        return Err(wrong(format!("{}: only EXR files have depth", path.display())));
    }
    let (first, second) = (Deep::read(a)?, Deep::read(b)?);
    warn_of_background(arguments, [(true, first.picture()), (true, second.picture())]);
    let both = picture::compose_by_depth(&first, &second)?;
    match Picture::is_exr(destination.path()) {
        true => both.write(destination)?,
        false => both.picture().write(destination)?,
    }
    Ok(both.picture().clone())
}

/// Says on standard error which picture should be a matte and is none.
fn warn_of_background(arguments: &Arguments, pictures: [(bool, &Picture); 2]) {
    for (path, (as_matte, picture)) in [&arguments.a, &arguments.b].into_iter().zip(pictures) {
        if as_matte && !picture.is_matte() {
            let name = path.display();
            warn(&format!(
                "{name} has light where it covers nothing, which is added; peris render --matte leaves it out"
            ));
        }
    }
}
