//! `peris diff`: how far a picture is from a reference.

use super::{CommandFailure, Exit, SubcommandRow, output};
use crate::picture::{self, Difference, Flip, PIXELS_PER_DEGREE, PIXELS_PER_DEGREE_RANGE, Picture};
use clap::{Args, FromArgMatches};
use std::path::PathBuf;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "diff",
    summary: "Says how far a picture is from a reference: in radiance, and to the eye (FLIP); the exit code tells too, if \
              there is a tolerance.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A picture (.png, .exr)
    #[arg(value_name = "PICTURE")]
    picture: PathBuf,
    /// Another of the same size (.png, .exr), which the relative error counts as right
    #[arg(value_name = "REFERENCE")]
    reference: PathBuf,
    /// The greatest RMSE of linear radiance that is no failure
    #[arg(long, value_name = "RMSE", value_parser = tolerance)]
    tolerance: Option<f64>,
    /// Writes the FLIP error of each pixel, .png in colours from black, 0, to light yellow, 1, .exr in numbers
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Pixels to a degree of the visual field, 1 to 1000; the default is that of a display 0.7 m away with 3840 pixels in 0.7 m
    #[arg(long, value_name = "COUNT", default_value_t = PIXELS_PER_DEGREE, value_parser = pixels_per_degree)]
    ppd: f64,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments { picture, reference, tolerance, map, ppd, json } = arguments;
    let map = map.as_deref().map(Picture::destination).transpose()?;
    let (a, b) = (Picture::read_finite(picture)?, Picture::read_finite(reference)?);
    let found = picture::difference(&a, &b)?;
    let flip = picture::flip(&a, &b, *ppd)?;
    if let Some(map) = map {
        let shown = match Picture::is_exr(map.path()) {
            true => numbers(&a, &flip)?,
            false => picture::error_map(a.width(), a.height(), &flip.map)?,
        };
        shown.write(&map)?;
    }
    let Difference { rmse, relative_mse, largest, percentile_99, coverage, silhouette } = found;
    let is_within = tolerance.is_none_or(|tolerance| rmse <= tolerance);
    if *json {
        let known = serde_json::json!({
            "width": a.width(), "height": a.height(), "rmse": rmse, "relative_mse": relative_mse, "flip": flip.mean,
            "pixels_per_degree": ppd, "largest": largest, "percentile_99": percentile_99, "coverage": coverage,
            "silhouette": silhouette, "tolerance": tolerance, "within": is_within,
        });
        output::report(known);
    } else {
        say!("RMSE                {rmse:.6}");
        say!("relative MSE        {relative_mse:.6}");
        say!("FLIP                {:.6}", flip.mean);
        say!("largest difference  {largest:.6}");
        say!("99th percentile     {percentile_99:.6}");
        say!("coverage            {coverage:.6}");
        say!("silhouette          {silhouette:.6}");
    }
    match (is_within, tolerance) {
        (false, Some(tolerance)) => {
            let names = format!("{} and {}", picture.display(), reference.display());
            let message = format!("{names} have an RMSE of {rmse}, more than {tolerance}");
            Err(CommandFailure::new(Exit::Failed, anyhow::anyhow!(message)))
        }
        _ => Ok(()),
    }
}

/// A grey picture of the errors themselves.
fn numbers(like: &Picture, flip: &Flip) -> Result<Picture, CommandFailure> {
    let mut picture = Picture::new(like.width(), like.height())?;
    for (pixel, error) in picture.pixels_mut().iter_mut().zip(&flip.map) {
        *pixel = picture::Pixel { radiance: [*error; 3], coverage: 1.0 };
    }
    Ok(picture)
}

/// Reads the greatest error that is allowed.
fn tolerance(text: &str) -> Result<f64, String> {
    let tolerance = text.parse().ok().filter(|tolerance| *tolerance >= 0.0 && *tolerance < f64::INFINITY);
    tolerance.ok_or_else(|| "give a number, 0 or more".to_string())
}

/// Reads the pixels to a degree.
fn pixels_per_degree(text: &str) -> Result<f64, String> {
    let (least, most) = PIXELS_PER_DEGREE_RANGE;
    let density = text.parse().ok().filter(|density| (least..=most).contains(density));
    density.ok_or_else(|| format!("give a number of {least} to {most}"))
}
