//! The vector display of the machine: its settings, and which strokes it shows.
//!
//! The light on the screen is computed when somebody looks. Only where what is seen depends on what was seen before,
//! with a phosphor that glows on or a picture that may flicker, does the display go along with every frame: by the
//! machine, or by the window that shares the screen ([`Machine::share_screen`]), as fast as it can.

use super::{
    Machine,
    vector_display::{PictureVersion, VectorDisplay},
};
use crate::{
    calligraphic::{Controls, DISPLAY_SIZE, Display, Refresh, Scene, SharedDisplay},
    picture::Picture,
    traversal,
};
use std::sync::Arc;

impl Machine {
    /// Takes another screen to show the picture on.
    ///
    /// - `is_watched`: whether its other owner looks at it in every frame.
    pub fn share_screen(&mut self, screen: Arc<SharedDisplay>, is_watched: bool) {
        self.vector_display.screen = screen;
        self.vector_display.is_watched = is_watched;
    }

    /// The screen that shows the picture.
    pub fn screen(&self) -> &SharedDisplay {
        &self.vector_display.screen
    }

    /// Knobs, phosphor, and which screen is looked at.
    pub fn controls(&self) -> &Controls {
        &self.vector_display.controls
    }

    /// Sets them.
    pub fn set_controls(&mut self, controls: Controls) {
        let other_screen = controls.screen != self.vector_display.controls.screen;
        self.vector_display.controls = controls;
        self.vector_display.settings += 1;
        if other_screen {
            self.tube.forget_overlay();
            self.update_overlay();
        }
    }

    /// How long the beam needs for the picture, on all screens together: that of now, or the latest that was drawn.
    pub fn refresh(&self) -> Refresh {
        let key = self.picture_version();
        if let Some((of, refresh)) = self.vector_display.refresh.get()
            && (of == key || self.latest.update.is_counted_only)
        {
            return refresh;
        }
        let tube = &self.tube;
        let structure = if tube.graphics { self.latest.update.strokes.as_slice() } else { &[] };
        let strokes = structure.iter().chain(self.overlay()).filter(|_| !tube.blanked);
        let refresh = Refresh::of(strokes);
        self.vector_display.refresh.set(Some((key, refresh)));
        refresh
    }

    fn picture_version(&self) -> PictureVersion {
        PictureVersion {
            updates: self.counters.updates,
            overlay: self.tube.overlay_version(),
            graphics: self.tube.graphics,
            blanked: self.tube.blanked,
            screen: self.vector_display.controls.screen,
        }
    }

    /// What the vector screen is to show now.
    pub fn scene(&mut self) -> &Scene {
        let key = self.picture_version();
        if self.vector_display.of != Some(key) {
            let strokes = Arc::new(self.visible_strokes().into_owned());
            self.vector_display.of = Some(key);
            self.vector_display.scene.version += 1;
            self.vector_display.scene.strokes = strokes;
        }
        let VectorDisplay { scene, settings, controls, .. } = &mut self.vector_display;
        (scene.frame, scene.settings, scene.controls) = (self.frame, *settings, *controls);
        scene
    }

    /// The pixels of the vector screen now, red, green, blue (sRGB) and 255, row after row from the top.
    ///
    /// - `size`: width and height in pixels, at most [`crate::calligraphic::MAX_SIZE`].
    pub fn vector_frame(&mut self, size: [u32; 2]) -> Vec<u8> {
        self.renew_picture();
        self.with_display(Some(size), |display| display.frame().to_vec())
    }

    /// The vector screen now: what [`Machine::vector_frame`] shows, and the window, in linear floats.
    ///
    /// - `size`: width and height in pixels; those of the display if none are given. A picture of another size shows
    ///   no afterglow.
    pub fn vector_picture(&mut self, size: Option<[u32; 2]>) -> Picture {
        if !self.is_followed() {
            self.update_display();
            if self.latest.update.is_counted_only {
                return self.large_picture(size);
            }
        }
        self.renew_picture();
        let current_size = self.vector_display.screen.size();
        if let Some(size) = size.filter(|size| current_size.is_some_and(|current| current != *size)) {
            let drawer = self.vector_display.screen.drawer().clone();
            let mut display = Display::drawn_by(drawer, self.vector_display.controls, size);
            display.show(&self.visible_strokes(), 0, self.frame);
            return display.picture();
        }
        self.with_display(size, Display::picture)
    }

    /// A picture of so many vectors that their strokes are written as they are made, and not stored.
    fn large_picture(&self, size: Option<[u32; 2]>) -> Picture {
        let VectorDisplay { screen, controls, .. } = &self.vector_display;
        let size = size.or(screen.size()).unwrap_or(DISPLAY_SIZE);
        let mut display = Display::drawn_by(screen.drawer().clone(), *controls, size);
        display.show_parts(|take| {
            if self.tube.graphics && !self.tube.blanked {
                traversal::draw_in_parts(&self.memory.structures, self.frame, controls.screen, take);
            }
            if !self.tube.blanked {
                take(self.overlay());
            }
        });
        display.picture()
    }

    /// Whether each frame is looked at: by a window, or since the display glows on or flickers.
    pub(super) fn is_followed(&self) -> bool {
        self.vector_display.is_watched || self.vector_display.controls.remembers()
    }

    /// Lets nothing refer to earlier strokes, and releases their memory.
    pub(super) fn shrink_display(&mut self) {
        match self.vector_display.screen.size() {
            Some(_) => self.with_display(None, |_| ()),
            None => drop(self.scene()),
        }
        self.vector_display.screen.shrink();
    }

    /// How many strokes the latest scene has.
    #[cfg(test)]
    pub(super) fn display_strokes(&self) -> usize {
        self.vector_display.scene.strokes.len()
    }

    /// Looks at the display with the scene of now.
    fn with_display<T>(&mut self, size: Option<[u32; 2]>, see: impl FnOnce(&Display) -> T) -> T {
        self.scene();
        self.vector_display.screen.with_display(&self.vector_display.scene, size, |seen| see(seen.display))
    }

    /// Lets a display that remembers go along with the frame.
    pub(super) fn follow_frame(&mut self) {
        if self.vector_display.controls.remembers() && !self.vector_display.is_watched {
            self.with_display(None, |_| ());
        }
    }
}
