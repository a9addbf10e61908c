//! `peris render`: a scene to a picture file.

use super::source::stem;
use super::{Definitions, Exit, Failure, Progress, Row, SCRIPT_HELP, load, watch_interrupts};
use crate::picture::Picture;
use crate::plan::Plan;
use crate::render::ray_tracing::RayTracer;
use crate::render::{Order, Renderer, Rendering, Watch};
use crate::scene::Prepared;
use clap::{Args, FromArgMatches};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Instant;

pub(super) const ROW: Row = Row {
    name: "render",
    summary: "Renders a scene by ray tracing into a PNG or EXR file.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: Definitions,
    /// Picture file, .png (sRGB) or .exr (linear, coverage as alpha); may be given more than once [default: NAME.png]
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Columns, instead of those of the scene; alone, the rows follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    width: Option<u32>,
    /// Rows, instead of those of the scene; alone, the columns follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    height: Option<u32>,
    /// Samples in each pixel, instead of those of the scene
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::threads)]
    threads: Option<NonZeroUsize>,
    /// Seed of the sample positions, instead of that of the scene
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Tessellation tolerance in scene units, instead of that of the scene
    #[arg(long, value_name = "LENGTH")]
    tolerance: Option<f64>,
    /// Leaves nothing out; the picture is the same
    #[arg(long)]
    everything: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let cancelled = watch_interrupts();
    let mut outputs = arguments.output.clone();
    if outputs.is_empty() {
        outputs.push(PathBuf::from(format!("{}.png", stem(&arguments.script))));
    }
    outputs.iter().try_for_each(|path| Picture::check_name(path)).map_err(|e| Failure::new(Exit::Usage, e))?;
    let mut scene = load(&arguments.script, &arguments.definitions)?.scene;
    super::warn_of_darkness(&scene);
    let settings = &mut scene.settings;
    (settings.width, settings.height) = size(settings.width, settings.height, arguments.width, arguments.height);
    settings.samples = arguments.samples.unwrap_or(settings.samples);
    settings.seed = arguments.seed.unwrap_or(settings.seed);
    settings.tolerance = arguments.tolerance.or(settings.tolerance);
    let start = Instant::now();
    let prepared = Prepared::new(&scene)?;
    let view = prepared.view();
    let plan = if arguments.everything { Plan::everything(&prepared, &view) } else { Plan::new(&prepared, &view) };
    let tracer = RayTracer::new(&prepared, &plan)?;
    let build_seconds = start.elapsed().as_secs_f64();
    let order = Order { threads: arguments.threads, ..Order::of(&prepared.settings) };
    let progress = Progress::new("rendering", arguments.json);
    let watch = Watch { cancelled, progress: &|done, all| progress.update(done, all) };
    let rendering = tracer.render(&view, &order, &watch);
    progress.finish();
    let rendering = rendering?;
    outputs.iter().try_for_each(|path| rendering.picture.write(path))?;
    report(arguments, &outputs, &prepared, &rendering, build_seconds)?;
    if rendering.complete {
        Ok(())
    } else {
        let [least, most] = rendering.film.samples();
        let message = format!("interrupted; pixels have {least} to {most} samples, which are kept");
        Err(Failure::new(Exit::Interrupted, anyhow::anyhow!(message)))
    }
}

/// The size of the picture, when the command line gives one side or both.
fn size(width: u32, height: u32, new_width: Option<u32>, new_height: Option<u32>) -> (u32, u32) {
    let scaled = |side: u32, new: u32, old: u32| {
        (f64::from(side) * f64::from(new) / f64::from(old)).round().clamp(1.0, f64::from(u32::MAX)) as u32
    };
    match (new_width, new_height) {
        (None, None) => (width, height),
        (Some(w), None) => (w, scaled(height, w, width)),
        (None, Some(h)) => (scaled(width, h, height), h),
        (Some(w), Some(h)) => (w, h),
    }
}

fn report(
    arguments: &Arguments,
    outputs: &[PathBuf],
    prepared: &Prepared,
    rendering: &Rendering,
    build_seconds: f64,
) -> Result<(), Failure> {
    let picture = &rendering.picture;
    if arguments.json {
        let json = serde_json::json!({
            "files": outputs,
            "width": picture.width(),
            "height": picture.height(),
            "samples": prepared.settings.samples,
            "seed": prepared.settings.seed,
            "triangles": prepared.triangles.len(),
            "build_seconds": build_seconds,
            "render_seconds": rendering.seconds,
            "threads": rendering.threads,
            "rays": rendering.rays,
            "complete": rendering.complete,
        });
        say!("{}", serde_json::to_string_pretty(&json)?);
        return Ok(());
    }
    let names: Vec<String> = outputs.iter().map(|p| p.display().to_string()).collect();
    let rays = rendering.rays;
    say!(
        "{}: {} x {} pixels, {} samples each",
        names.join(", "),
        picture.width(),
        picture.height(),
        prepared.settings.samples
    );
    say!("{} triangles, built in {build_seconds:.3} s", prepared.triangles.len());
    say!(
        "{} rays (primary {}, shadow {}, reflected {}) in {:.3} s on {} threads: {:.2} million a second",
        rays.total(),
        rays.primary,
        rays.shadow,
        rays.reflected,
        rendering.seconds,
        rendering.threads,
        rendering.mega_rays_per_second()
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_side_of_the_picture_takes_the_other_with_it() {
        assert_eq!(size(640, 480, None, None), (640, 480));
        assert_eq!(size(640, 480, Some(320), None), (320, 240));
        assert_eq!(size(640, 480, None, Some(1)), (1, 1));
        assert_eq!(size(640, 480, Some(10), Some(20)), (10, 20));
    }
}
