//! A scene prepared to be shown.

use super::arguments::ShowArguments;
use crate::cli::source::warn_of_emptiness;
use crate::cli::{CommandFailure, progress};
use crate::{
    production::{Model, tiling},
    render::tiles::Tiling,
    scene::Scene,
    workstation::InitialView,
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
