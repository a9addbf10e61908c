//! What is seen of the machine: the display with its settings, and which strokes it shows.
//!
//! The light on the screen is made when somebody looks. Only where what is seen depends on what was seen before, with a
//! phosphor that glows on or a picture that may flicker, does the display go along with every frame.

use super::Machine;
use crate::{
    calligraphic::{Controls, Display, Refresh},
    picture::Picture,
};
use std::cell::Cell;

/// Width and height of the display if nobody says otherwise, in pixels.
pub const DISPLAY_SIZE: [u32; 2] = [1024, 1024];

/// The display, once somebody has looked.
#[derive(Debug, Default)]
pub(super) struct Sight {
    controls: Controls,
    display: Option<Box<Display>>,
    /// Of what the strokes were made.
    of: Option<PictureVersion>,
    /// Changes with it.
    version: u64,
    /// The refresh that was reckoned last, and of what.
    refresh: Cell<Option<(PictureVersion, Refresh)>>,
}

/// Of what the strokes on the screen are made: other strokes have another version.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PictureVersion {
    updates: u64,
    overlay: u64,
    graphics: bool,
    blanked: bool,
    screen: u8,
}

impl Machine {
    /// Knobs, phosphor, and which screen is looked at.
    pub fn controls(&self) -> &Controls {
        &self.sight.controls
    }

    /// Sets them.
    pub fn set_controls(&mut self, controls: Controls) {
        let other_screen = controls.screen != self.sight.controls.screen;
        self.sight.controls = controls;
        if other_screen {
            self.tube.forget_overlay();
            self.update_overlay();
        }
        if let Some(display) = &mut self.sight.display {
            display.set_controls(controls);
        } else {
            let display = Box::new(Display::new(controls, DISPLAY_SIZE));
            self.sight.display = display.remembers().then_some(display);
        }
    }

    /// How long the beam needs for the picture of now, on all screens together.
    pub fn refresh(&self) -> Refresh {
        let key = self.picture_version();
        if let Some((of, refresh)) = self.sight.refresh.get()
            && of == key
        {
            return refresh;
        }
        let tube = &self.tube;
        let structure = if tube.graphics { self.update.strokes.as_slice() } else { &[] };
        let strokes = structure.iter().chain(self.overlay()).filter(|_| !tube.blanked);
        let refresh = Refresh::of(strokes);
        self.sight.refresh.set(Some((key, refresh)));
        refresh
    }

    /// Which picture the vector screen shows.
    pub fn picture_version(&self) -> PictureVersion {
        PictureVersion {
            updates: self.counters.updates,
            overlay: self.tube.overlay_version(),
            graphics: self.tube.graphics,
            blanked: self.tube.blanked,
            screen: self.sight.controls.screen,
        }
    }

    /// The pixels of the vector screen now, red, green, blue (sRGB) and 255, row after row from the top.
    ///
    /// - `size`: width and height in pixels, at most [`crate::calligraphic::MAX_SIZE`].
    pub fn vector_frame(&mut self, size: [u32; 2]) -> &[u8] {
        self.look(size).frame()
    }

    /// The vector screen now: what [`Machine::vector_frame`] shows, in linear floats.
    ///
    /// - `size`: width and height in pixels; those of the display if none are given. A picture of another size shows
    ///   no afterglow.
    pub fn vector_picture(&mut self, size: Option<[u32; 2]>) -> Picture {
        let standing = self.sight.display.as_ref().map(|display| display.size());
        let wanted = size.or(standing).unwrap_or(DISPLAY_SIZE);
        if standing.is_none_or(|standing| standing == wanted) {
            return self.look(wanted).picture();
        }
        self.renew_picture();
        let mut display = Display::new(self.sight.controls, wanted);
        display.show(&self.visible_strokes(), 0, self.frame);
        display.picture()
    }

    /// The display with the picture of now.
    fn look(&mut self, size: [u32; 2]) -> &Display {
        self.renew_picture();
        let made = || Box::new(Display::new(self.sight.controls, size));
        let mut display = self.sight.display.take().unwrap_or_else(made);
        display.resize(size);
        self.show(&mut display);
        self.sight.display.insert(display)
    }

    /// Lets a display that remembers go along with the frame.
    pub(super) fn follow_frame(&mut self) {
        if let Some(mut display) = self.sight.display.take_if(|display| display.remembers()) {
            self.show(&mut display);
            self.sight.display = Some(display);
        }
    }

    fn show(&mut self, display: &mut Display) {
        let key = self.picture_version();
        if self.sight.of != Some(key) {
            self.sight.of = Some(key);
            self.sight.version += 1;
        }
        if display.awaits(self.sight.version, self.frame) {
            display.show(&self.visible_strokes(), self.sight.version, self.frame);
        }
    }
}
