//! One pixel, explained.

use super::arguments::RenderArguments;
use crate::cli::{CommandFailure, Exit};
use crate::render::RenderOrder;
use crate::render::ray_tracing::{Explanation, RayTracer};
use crate::scene::View;
use glam::DVec3;

/// Most samples of a pixel that are explained.
const EXPLAINED: usize = 4;

/// Prints what is known of one pixel.
pub(super) fn explain(
    arguments: &RenderArguments,
    tracer: &RayTracer<'_>,
    view: &View,
    options: &RenderOrder,
    [x, y]: [u32; 2],
) -> Result<(), CommandFailure> {
    if x >= options.width || y >= options.height {
        let message = format!("pixel {x},{y} is outside the picture of {} x {}", options.width, options.height);
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    let samples = tracer.explain(view, options, [x, y], options.samples)?;
    let mean = samples.iter().map(|sample| DVec3::from_array(sample.radiance)).sum::<DVec3>() / samples.len() as f64;
    let told = if arguments.explain { EXPLAINED.min(samples.len()) } else { 0 };
    if arguments.json {
        let json = serde_json::json!({ "pixel": [x, y], "radiance": mean.to_array(), "samples": &samples[..told] });
        say!("{}", serde_json::to_string_pretty(&json)?);
        return Ok(());
    }
    say!("pixel {x},{y}: radiance {:.6} {:.6} {:.6}, mean of {} samples", mean.x, mean.y, mean.z, samples.len());
    for Explanation { sample, wavelengths, notes, radiance: [r, g, b] } in &samples[..told] {
        say!("sample {}: {r:.6} {g:.6} {b:.6}", sample + 1);
        if let Some(wavelengths) = wavelengths {
            say!("  wavelengths {} nm", short(wavelengths, 1));
        }
        for note in notes {
            let indent = "  ".repeat(note.depth as usize + 1);
            let at = note.at.map_or(String::new(), |p| format!(" at {:.4} {:.4} {:.4}", p.x, p.y, p.z));
            let adds = note.adds.as_ref().map_or(String::new(), |adds| format!(": {}", short(adds, 6)));
            say!("{indent}{}{at}{adds}", note.what);
        }
    }
    Ok(())
}

fn short(values: &[f64], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(" ")
}
