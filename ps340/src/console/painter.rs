//! The thread that draws the vector screen, so that neither the machine nor the window waits for it.

use crate::{
    calligraphic::{Controls, Display},
    machine::PictureVersion,
    traversal::Stroke,
};
use egui::ColorImage;
use std::sync::{Arc, Condvar, Mutex};

/// What is to be drawn.
#[derive(Clone)]
pub struct Wanted {
    /// Which picture the strokes are.
    pub version: PictureVersion,
    /// What to draw.
    pub strokes: Arc<Vec<Stroke>>,
    /// Knobs, phosphor, and which screen.
    pub controls: Controls,
    /// The frame of the machine.
    pub frame: u64,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl Wanted {
    fn is(&self, other: &Wanted) -> bool {
        self.version == other.version && self.size == other.size && self.controls == other.controls
    }
}

/// What the two threads share.
#[derive(Default)]
struct Easel {
    wanted: Option<Wanted>,
    painted: Option<Arc<ColorImage>>,
    /// Whether what is seen depends on what was seen before.
    remembers: bool,
    closed: bool,
}

/// Draws what was wanted last, as often as it can.
pub struct Painter {
    easel: Arc<(Mutex<Easel>, Condvar)>,
    asked: Option<Wanted>,
}

impl Painter {
    /// Starts the thread; it asks `context` for a repaint after each picture.
    pub fn new(context: egui::Context) -> Painter {
        let easel = Arc::new((Mutex::new(Easel::default()), Condvar::new()));
        let shared = easel.clone();
        std::thread::spawn(move || paint(&shared, &context));
        Painter { easel, asked: None }
    }

    /// Says what is to be seen. A picture that is drawn already, or being drawn, is not drawn again.
    pub fn want(&mut self, wanted: Wanted) {
        let same = self.asked.as_ref().is_some_and(|asked| asked.is(&wanted));
        // A display that remembers goes along with every frame.
        let goes_on =
            lock(&self.easel.0).remembers && self.asked.as_ref().is_none_or(|asked| asked.frame != wanted.frame);
        if same && !goes_on {
            return;
        }
        self.asked = Some(wanted.clone());
        let (easel, changed) = &*self.easel;
        lock(easel).wanted = Some(wanted);
        changed.notify_one();
    }

    /// The latest picture, if it was not taken before.
    pub fn take(&self) -> Option<Arc<ColorImage>> {
        lock(&self.easel.0).painted.take()
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        let (easel, changed) = &*self.easel;
        lock(easel).closed = true;
        changed.notify_one();
    }
}

/// The thread.
fn paint((easel, changed): &(Mutex<Easel>, Condvar), context: &egui::Context) {
    let mut display: Option<Display> = None;
    let mut versions = Versions::default();
    loop {
        let mut guard = lock(easel);
        let wanted = loop {
            if guard.closed {
                return;
            }
            if let Some(wanted) = guard.wanted.take() {
                break wanted;
            }
            guard = changed.wait(guard).unwrap_or_else(|poisoned| poisoned.into_inner());
        };
        drop(guard);
        let display = display.get_or_insert_with(|| Display::new(wanted.controls, wanted.size));
        display.resize(wanted.size);
        if *display.controls() != wanted.controls {
            display.set_controls(wanted.controls);
        }
        let version = versions.number(wanted.version);
        let awaits = display.awaits(version, wanted.frame);
        if awaits {
            display.show(&wanted.strokes, version, wanted.frame);
        }
        let size = display.size().map(|pixels| pixels as usize);
        let mut guard = lock(easel);
        guard.remembers = display.remembers() && display.awaits(version, wanted.frame + 1);
        if awaits {
            guard.painted = Some(Arc::new(ColorImage::from_rgba_unmultiplied(size, display.frame())));
        }
        let again = guard.remembers || awaits;
        drop(guard);
        if again {
            context.request_repaint();
        }
    }
}

/// Numbers for versions, as the display wants them.
#[derive(Default)]
struct Versions {
    latest: PictureVersion,
    number: u64,
}

impl Versions {
    fn number(&mut self, version: PictureVersion) -> u64 {
        if version != self.latest {
            self.latest = version;
            self.number += 1;
        }
        self.number
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}
