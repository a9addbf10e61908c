//! Files from which an interrupted rendering goes on: its film, and beside it what was found before there was one.

use super::arguments::RenderArguments;
use crate::cli::CommandFailure;
use crate::cli::rendering_arguments::RenderingArguments;
use crate::plan::{Plan, Stage};
use crate::render::{Film, Fingerprint, Memo, RenderOrder, RenderState, StateError};
use files::Destination;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where films are kept, and what was found there.
pub(super) struct Saved<'a> {
    destination: &'a Destination,
    fingerprint: Fingerprint,
    /// Views that were finished.
    views: usize,
    /// The one after them.
    film: Option<Film>,
    /// Time from one writing to the next.
    pub(super) every: Duration,
}

impl Saved<'_> {
    /// Reads what is there, if anything is.
    ///
    /// - `every`: time from one writing to the next.
    ///
    /// # Errors
    /// [`StateError`] as [`CommandFailure`]: the file is damaged, or of another rendering.
    pub(super) fn read<'a>(
        arguments: &RenderArguments,
        every: Duration,
        destination: &'a Destination,
        mut fingerprint: Fingerprint,
        options: &RenderOrder,
    ) -> Result<Saved<'a>, CommandFailure> {
        if let Some(views) = arguments.views {
            // Views that are finished get no more samples.
            let RenderOrder { samples, target, .. } = options;
            fingerprint = fingerprint.with(&format!("{views} {:?} {samples} {target:?}", arguments.turn));
        }
        let mut saved = Saved { destination, fingerprint, views: 0, film: None, every };
        if destination.path().exists() {
            let RenderState { views, film } = RenderState::read(destination.path(), options, fingerprint)?;
            (saved.views, saved.film) = (views as usize, Some(film));
        }
        Ok(saved)
    }

    /// Whether a view was finished, and its pictures are there.
    pub(super) fn has_finished(&self, number: usize, outputs: &[Destination]) -> bool {
        number < self.views && outputs.iter().all(|file| file.path().exists())
    }

    /// The film of a view, if it was begun.
    pub(super) fn take(&mut self, number: usize) -> Option<Film> {
        if number == self.views { self.film.take() } else { None }
    }

    /// Keeps the film of a view.
    pub(super) fn write(&self, number: usize, film: &Film) -> Result<(), StateError> {
        film.write_state(self.destination, self.fingerprint, number as u32)
    }

    /// Keeps that a view is the next one, and not begun.
    pub(super) fn write_next(&self, number: usize, before: &Film) -> Result<(), StateError> {
        let film = Film::new(before.width(), before.height())?;
        let film = if before.features().is_empty() { film } else { film.with_features() };
        film.write_state(self.destination, self.fingerprint, number as u32)
    }
}

/// Files beside that of the film, for work that is done before samples are taken and may take long. They are removed
/// when the rendering is finished.
pub(super) struct Intermediate {
    /// Photons that were traced from lamps.
    light: Option<PathBuf>,
    /// What was found for radiosity.
    radiosity: Option<PathBuf>,
}

impl Intermediate {
    /// Those that a rendering needs.
    pub(super) fn of(arguments: &RenderArguments, plan: &Plan) -> Intermediate {
        let beside = |ending: &str| {
            let mut name = arguments.resume.as_ref()?.as_os_str().to_owned();
            name.push(ending);
            Some(PathBuf::from(name))
        };
        let row = arguments.rendering.renderer.row();
        let is_followed = row.can_map_photons && arguments.light.is_none() && plan.needs(Stage::PhotonMap);
        let is_solved = row.solves_radiosity || (row.adds_samples && plan.needs(Stage::Radiosity));
        Intermediate {
            light: is_followed.then(|| beside(".light")).flatten(),
            radiosity: is_solved.then(|| beside(".radiosity")).flatten(),
        }
    }

    /// The database for photons, and whether it is to last.
    pub(super) fn light<'a>(&'a self, arguments: &'a RenderArguments) -> Option<(&'a Path, bool)> {
        let lasting = arguments.light.as_deref().map(|path| (path, true));
        lasting.or_else(|| self.light.as_deref().map(|path| (path, false)))
    }

    /// What was found for radiosity.
    ///
    /// # Errors
    /// [`StateError`] as [`CommandFailure`].
    pub(super) fn memo(
        &self,
        arguments: &RenderArguments,
        fingerprint: Option<&Fingerprint>,
    ) -> Result<Option<Memo>, CommandFailure> {
        let (Some(path), Some(fingerprint)) = (&self.radiosity, fingerprint) else { return Ok(None) };
        // What is left out depends on the views.
        let RenderArguments { views, turn, rendering: RenderingArguments { everything, renderer, .. }, .. } = arguments;
        let fingerprint = fingerprint.of_scene(&format!("{views:?} {turn:?} {everything} {renderer:?}"));
        Ok(Some(Memo::open(path, fingerprint)?))
    }

    /// Removes them; that one cannot be removed harms nobody.
    pub(super) fn remove(&self) {
        [&self.light, &self.radiosity].into_iter().flatten().for_each(|path| {
            let _ = std::fs::remove_file(path);
        });
    }
}
