//! A scene prepared to be shown.

use super::arguments::ShowArguments;
use crate::cli::source::warn_of_emptiness;
use crate::cli::{CommandFailure, load, progress};
use crate::{
    production::{Model, tiling},
    render::tiles::Tiling,
    scene::Scene,
    workstation::{FlipBook, InitialView},
};

/// The scene ready to be shown as the arguments say, with the light of its surfaces if that is to be shown.
///
/// - `initial`: from where it is seen, instead of by its own camera.
pub(super) fn modelled(
    scene: &Scene,
    arguments: &ShowArguments,
    initial: Option<InitialView>,
) -> Result<(Model, Option<Tiling>), CommandFailure> {
    let light = if arguments.radiosity {
        warn_of_emptiness(scene);
        let light = tiling(scene, arguments.threads, &progress::watch())?;
        Some(light)
    } else {
        None
    };
    let model = Model::new(scene, &arguments.drawing(), light.as_ref(), initial)?;
    Ok((model, light))
}

/// The pictures of a scene at several times ready to be shown, one after the other.
///
/// - `first`: the scene of the first picture. `times`: of the others, seconds.
pub(super) fn flip_book(
    first: &Scene,
    times: impl Iterator<Item = f64>,
    arguments: &ShowArguments,
) -> Result<Model, CommandFailure> {
    let mut rest = Vec::new();
    for time in times {
        rest.push(load(&arguments.script, &arguments.definitions.at(time))?.scene.lit()?);
    }
    let book = FlipBook::new(first.clone(), rest, arguments.rate);
    Ok(Model::of_pictures(book, &arguments.drawing())?)
}
