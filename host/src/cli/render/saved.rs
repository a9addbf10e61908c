//! Films in a file, from which an interrupted rendering goes on.

use super::Arguments;
use crate::cli::Failure;
use crate::render::{Film, Fingerprint, Order, State, StateError};
use crate::scene::{Prepared, Scene};
use files::Destination;
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
    /// [`StateError`] as [`Failure`]: the file is damaged, or of another rendering.
    pub(super) fn read<'a>(
        arguments: &Arguments,
        every: Duration,
        destination: &'a Destination,
        scene: &Scene,
        prepared: &Prepared,
        order: &Order,
    ) -> Result<Saved<'a>, Failure> {
        let mut fingerprint = Fingerprint::of(scene, prepared, order);
        if let Some(views) = arguments.views {
            // Views that are finished get no more samples.
            let Order { samples, target, .. } = order;
            fingerprint = fingerprint.with(&format!("{views} {:?} {samples} {target:?}", arguments.turn));
        }
        let mut saved = Saved { destination, fingerprint, views: 0, film: None, every };
        if destination.path().exists() {
            let State { views, film } = State::read(destination.path(), order, fingerprint)?;
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
        Film::new(before.width(), before.height())?.write_state(self.destination, self.fingerprint, number as u32)
    }
}
