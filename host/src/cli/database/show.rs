//! A record in full, as text.

use crate::cli::CommandFailure;
use crate::color::columns;
use crate::database::{Record, RecordContent};
use crate::mesh::Grouped;
use crate::picture::Picture;

/// Prints a record.
pub(super) fn show(record: &Record, json: bool) -> Result<(), CommandFailure> {
    if json {
        let mut all = record.json().unwrap_or_else(|| serde_json::to_value(record.entry(0)).unwrap_or_default());
        let more = match &record.content {
            RecordContent::Geometry(grouped) => geometry_json(grouped),
            RecordContent::Texture(picture) => {
                serde_json::json!({ "width": picture.width(), "height": picture.height(), "mean": mean(picture) })
            }
            RecordContent::Photons(photons) => {
                let bounds = photons.bounds().map(|corners| corners.map(|corner| corner.to_array()));
                serde_json::json!({ "ways": photons.paths(), "caught": photons.len(), "bounds": bounds })
            }
            _ => serde_json::Value::Null,
        };
        if let (Some(all), serde_json::Value::Object(more)) = (all.as_object_mut(), more) {
            all.extend(more);
        }
        say!("{all:#}");
        return Ok(());
    }
    say!("{} \"{}\": {}", record.kind(), record.name, record.content.summary());
    let origin = &record.origin;
    for (key, text) in [("what", &origin.what), ("source", &origin.source), ("terms", &origin.terms)] {
        if !text.is_empty() {
            say!("{key:<8}  {text}");
        }
    }
    match &record.content {
        RecordContent::Geometry(grouped) => show_geometry(grouped),
        RecordContent::Texture(picture) => {
            let [red, green, blue] = mean(picture);
            say!("mean      {red} {green} {blue} (linear)");
        }
        RecordContent::Spectrum(curves) => match columns::print(&Default::default(), &curves.named()) {
            Some(text) => say_on!("{text}"),
            None => {
                for curve in curves.named() {
                    say_on!("{}", columns::print(&Default::default(), &[curve]).unwrap_or_default());
                }
            }
        },
        RecordContent::Material(material) => say!("{}", serde_json::to_string_pretty(material)?),
        RecordContent::Photons(photons) => {
            if let Some([low, high]) = photons.bounds() {
                say!("bounds    {low} to {high}");
            }
        }
        RecordContent::Light(light) => say!("{}", serde_json::to_string_pretty(light)?),
    }
    Ok(())
}

fn show_geometry(grouped: &Grouped) {
    if let Some(bounds) = grouped.mesh.bounds() {
        say!("bounds    {} to {}", bounds.min, bounds.max);
    }
    let has = |table: bool| if table { "yes" } else { "no" };
    say!("normals   {}", has(!grouped.mesh.corner_normals.is_empty()));
    say!("texture coordinates  {}", has(!grouped.mesh.corner_parameters.is_empty()));
    if !grouped.names.is_empty() {
        say!("groups    {}", grouped.names.join(", "));
    }
}

fn geometry_json(grouped: &Grouped) -> serde_json::Value {
    let bounds = grouped.mesh.bounds().map(|bounds| [bounds.min.to_array(), bounds.max.to_array()]);
    serde_json::json!({
        "vertices": grouped.mesh.vertices.len(), "triangles": grouped.mesh.triangles.len(), "bounds": bounds,
        "groups": grouped.names,
    })
}

/// The mean radiance of red, green and blue.
fn mean(picture: &Picture) -> [f64; 3] {
    let count = picture.pixels().len() as f64;
    [0, 1, 2].map(|band| picture.pixels().iter().map(|p| f64::from(p.radiance[band])).sum::<f64>() / count)
}
