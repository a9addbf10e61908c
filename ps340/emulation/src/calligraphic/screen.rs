//! The one display of the vector screen, for all who look at it.
//!
//! # One picture
//! A window draws on a thread of its own, so that neither it nor the machine waits for the other; pictures for files
//! are requested of the machine. Both look at this one display: a file holds what the window shows, to the byte,
//! afterglow and flicker included. Two displays with one rule for what they were shown would agree only as long as both
//! had the same size and neither ever left a frame out, and a window that cannot keep up must leave some out.
//!
//! Whoever looks brings the display to the scene. One that is older than what is shown already changes nothing, so that
//! it does not matter who comes first. A picture of another size than the window's is drawn by itself, and has no past.

use super::{Controls, Display, Drawer};
use crate::traversal::Stroke;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Width and height of the display by default, in pixels.
pub const DISPLAY_SIZE: [u32; 2] = [1024, 1024];

/// What the vector screen is to show at a moment of the machine. No number of a later scene is less.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The frame, of 1/60 s.
    pub frame: u64,
    /// A number that stays as long as the strokes do.
    pub version: u64,
    /// What to draw.
    pub strokes: Arc<Vec<Stroke>>,
    /// A number that stays as long as the controls do.
    pub settings: u64,
    /// Knobs, phosphor, and which screen is looked at.
    pub controls: Controls,
}

impl Scene {
    fn is_older(&self, other: &Scene) -> bool {
        self.frame < other.frame || self.version < other.version || self.settings < other.settings
    }
}

/// The display that all look at.
#[derive(Debug, Default)]
pub struct SharedDisplay {
    drawer: Drawer,
    state: Mutex<Option<DisplayState>>,
}

/// The state of the display, once somebody has looked.
#[derive(Debug)]
struct DisplayState {
    display: Display,
    scene: Scene,
    /// How often other pixels were shown.
    shown: u64,
}

/// What the display looks like to somebody who looks.
pub struct DisplayLook<'a> {
    /// The display at the scene, or at a later one.
    pub display: &'a Display,
    /// Another number for other pixels.
    pub shown: u64,
    /// Whether the next frame looks different though the strokes stay.
    pub is_animated: bool,
}

impl SharedDisplay {
    /// A screen that nobody has looked at yet.
    pub fn new(drawer: Drawer) -> Self {
        Self { drawer, state: Mutex::default() }
    }

    /// Who writes its light.
    pub fn drawer(&self) -> &Drawer {
        &self.drawer
    }

    /// Width and height in pixels, once somebody has looked.
    pub fn size(&self) -> Option<[u32; 2]> {
        self.lock().as_ref().map(|state| state.display.size())
    }

    /// Brings the display to a scene, unless it is past it, and lets `see` look at it.
    ///
    /// - `size`: width and height in pixels; without one, those it has, or [`DISPLAY_SIZE`].
    pub fn with_display<T>(&self, scene: &Scene, size: Option<[u32; 2]>, see: impl FnOnce(DisplayLook<'_>) -> T) -> T {
        let mut guard = self.lock();
        let made = || {
            let display = Display::drawn_by(self.drawer.clone(), scene.controls, size.unwrap_or(DISPLAY_SIZE));
            DisplayState { display, scene: scene.clone(), shown: 0 }
        };
        let DisplayState { display, scene: latest, shown } = guard.get_or_insert_with(made);
        if !scene.is_older(latest) {
            latest.clone_from(scene);
        }
        if let Some(size) = size {
            display.resize(size);
        }
        if *display.controls() != latest.controls {
            display.set_controls(latest.controls);
        }
        if display.awaits(latest.version, latest.frame) {
            display.show(&latest.strokes, latest.version, latest.frame);
            *shown += 1;
        }
        let goes_on = latest.controls.remembers() && display.awaits(latest.version, latest.frame + 1);
        see(DisplayLook { display, shown: *shown, is_animated: goes_on })
    }

    /// Releases the memory that the display keeps for pictures as large as those before.
    pub fn shrink(&self) {
        if let Some(state) = &mut *self.lock() {
            state.display.shrink();
        }
    }

    /// A thread that panicked with the lock leaves a display that can be shown again.
    fn lock(&self) -> MutexGuard<'_, Option<DisplayState>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calligraphic::phosphor;

    fn scene(frame: u64, version: u64, x: f32) -> Scene {
        let stroke = Stroke { start: [x, -0.5], end: [x, 0.5], intensity: [1.0; 2], color: [1.0; 3] };
        let controls = Controls { phosphor: phosphor("P39").unwrap(), ..Controls::default() };
        Scene { frame, version, strokes: Arc::new(vec![stroke]), settings: 0, controls }
    }

    fn bytes(screen: &SharedDisplay, scene: &Scene) -> Vec<u8> {
        screen.with_display(scene, Some([40, 30]), |seen| seen.display.frame().to_vec())
    }

    #[test]
    fn a_scene_that_is_older_than_what_is_shown_changes_nothing() {
        let screen = SharedDisplay::default();
        let (old, new) = (scene(5, 1, -0.5), scene(6, 2, 0.5));
        let first = bytes(&screen, &old);
        let then = bytes(&screen, &new);
        assert_ne!(first, then);
        assert_eq!(bytes(&screen, &old), then);
        assert_eq!(bytes(&screen, &Scene { frame: 6, ..old }), then);
        let resized = screen.with_display(&scene(5, 1, -0.5), Some([20, 20]), |seen| seen.display.frame().to_vec());
        let mut alone = Display::new(new.controls, [20, 20]);
        alone.show(&new.strokes, 1, 6);
        assert_eq!(resized, alone.frame(), "another size shows the latest scene");
    }

    #[test]
    fn the_size_stays_unless_another_is_asked_for() {
        let screen = SharedDisplay::default();
        assert_eq!(screen.size(), None);
        assert_eq!(screen.with_display(&scene(0, 0, 0.0), None, |seen| seen.display.size()), DISPLAY_SIZE);
        assert_eq!(screen.with_display(&scene(0, 0, 0.0), Some([9, 8]), |seen| seen.display.size()), [9, 8]);
        assert_eq!(screen.with_display(&scene(1, 0, 0.0), None, |seen| seen.display.size()), [9, 8]);
        assert_eq!(screen.size(), Some([9, 8]));
    }

    #[test]
    fn other_pixels_have_another_number() {
        let screen = SharedDisplay::default();
        let mut plain = Scene { controls: Controls::default(), ..scene(0, 1, 0.0) };
        let number = |scene: &Scene| screen.with_display(scene, Some([9, 9]), |seen| (seen.shown, seen.is_animated));
        let first = number(&plain);
        assert!(!first.1);
        plain.frame = 7;
        assert_eq!(number(&plain), first);
        plain.version = 2;
        assert!(number(&plain) > first);
    }
}
