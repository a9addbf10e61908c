//! Records drawn: spectra as curves, materials and geometry as pictures.

use super::record_address::RecordAddress;
use crate::cli::{CommandFailure, progress};
use crate::color::Color;
use crate::database::{Curves, Record, RecordContent};
use crate::illumination::material::Material;
use crate::picture::Picture;
use crate::plan::Plan;
use crate::render::ray_tracer;
use crate::render::{RenderOrder, Renderer};
use crate::scene::{Object, Prepared, Scene, Shape, Studio};
use crate::solid::Primitive;
use crate::study::{Axis, Plot, PlotPoint, Series};
use files::{Destination, Folder};
use glam::{DMat4, DVec3};
use std::path::PathBuf;

/// The range of wavelengths in a plot, nm.
const VISIBLE_RANGE: (f64, f64) = (360.0, 830.0);

/// Writes the files of a record, and says which.
pub(super) fn plot(record: &Record, place: &RecordAddress, folder: &Folder) -> Result<(), CommandFailure> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    let name: String = record.name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    let written = match &record.content {
        RecordContent::Spectrum(curves) => curve(record, curves).write(folder, &name)?.to_vec(),
        RecordContent::Light(light) => match light.strength().1 {
            Color::Spectrum(spectrum) => curve(record, &Curves::Light(spectrum.clone())).write(folder, &name)?.to_vec(),
            Color::Bands(bands) => {
                return Err(anyhow::anyhow!("the light \"{}\" has no spectrum, but {bands}", record.name).into());
            }
        },
        RecordContent::Photons(_) => {
            return Err(anyhow::anyhow!("stored photons are seen in their scene only: render that with --light").into());
        }
        RecordContent::Texture(picture) => {
            let file = picture_file(folder, &name)?;
            picture.write(&file)?;
            vec![file.path().into()]
        }
        RecordContent::Material(material) => {
            let ball = Object {
                name: name.clone(),
                shape: Shape::from(Primitive::Sphere { radius: 1.0 }),
                transform: DMat4::from_translation(DVec3::Y),
                material: Some((**material).clone()),
                tolerance: None,
            };
            vec![render(ball, &picture_file(folder, &name)?)?]
        }
        RecordContent::Geometry(grouped) => {
            if grouped.mesh.triangles.is_empty() {
                return Err(anyhow::anyhow!("the mesh is empty").into());
            }
            let (_, database) = place.library()?.record(record.kind(), &record.name)?;
            let object = Object {
                name: name.clone(),
                shape: Shape::Stored { database, name: record.name.clone() },
                transform: DMat4::IDENTITY,
                material: Some(Material::default()),
                tolerance: None,
            };
            vec![render(object, &picture_file(folder, &name)?)?]
        }
    };
    let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
    say!("{}", names.join(", "));
    Ok(())
}

/// Where the picture of a record will be.
fn picture_file(folder: &Folder, name: &str) -> Result<Destination, CommandFailure> {
    Ok(Picture::destination(&folder.path().join(format!("{name}.png")))?)
}

/// Curves over the wavelengths that are seen.
fn curve(record: &Record, curves: &Curves) -> Plot {
    let of = |(name, spectrum): (&str, &crate::color::Spectrum)| {
        let within =
            spectrum.samples().filter(|(wavelength, _)| (VISIBLE_RANGE.0..=VISIBLE_RANGE.1).contains(wavelength));
        let points = within.map(|(x, y)| PlotPoint { x, y, label: String::new() }).collect();
        Series { name: name.to_owned(), points }
    };
    let y_label = match curves {
        Curves::Reflectance(_) => "reflected fraction",
        Curves::Light(_) => "relative power",
        Curves::Metal(_) => "index n, extinction k",
        Curves::Functions(_) => "value",
    };
    let source = &record.origin.source;
    let short: String = source.chars().take(110).collect();
    Plot {
        title: record.name.clone(),
        x_label: "wavelength (nm)".into(),
        y_label: y_label.into(),
        note: if short.len() < source.len() { short + " ..." } else { short },
        x_axis: Axis::Linear,
        y_axis: Axis::Linear,
        series: curves.named().into_iter().map(of).collect(),
    }
}

/// A picture of an object in the studio.
fn render(object: Object, file: &Destination) -> Result<PathBuf, CommandFailure> {
    let mut scene = Scene { objects: vec![object], studio: Some(Studio::Lit), ..Scene::default() }.lit()?;
    (scene.settings.image.width, scene.settings.image.height, scene.settings.image.samples) = (360, 360, 48);
    let prepared = Prepared::new(&scene)?;
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let order = RenderOrder::of(&prepared.settings);
    let rendering = ray_tracer(&prepared, &plan)?.render(&view, &order, &progress::watch())?;
    rendering.picture.write(file)?;
    Ok(file.path().to_owned())
}
