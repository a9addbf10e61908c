//! The thread that draws the vector screen, so that neither the machine nor the window waits for it.

use crate::{calligraphic::Beam, machine::PictureVersion, traversal::Stroke};
use egui::ColorImage;
use std::sync::{Arc, Condvar, Mutex};

/// What is to be drawn.
#[derive(Clone)]
pub struct Wanted {
    /// Which picture the strokes are.
    pub version: PictureVersion,
    /// What to draw.
    pub strokes: Arc<Vec<Stroke>>,
    /// Width and height in pixels.
    pub size: u32,
}

impl Wanted {
    fn is(&self, version: PictureVersion, size: u32) -> bool {
        self.version == version && self.size == size
    }
}

/// What the two threads share.
#[derive(Default)]
struct Easel {
    wanted: Option<Wanted>,
    painted: Option<Arc<ColorImage>>,
    closed: bool,
}

/// Draws what was wanted last, as often as it can.
pub struct Painter {
    easel: Arc<(Mutex<Easel>, Condvar)>,
    asked: Option<(PictureVersion, u32)>,
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
        let same = self.asked.is_some_and(|(version, size)| wanted.is(version, size));
        if same || wanted.size == 0 {
            return;
        }
        self.asked = Some((wanted.version, wanted.size));
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
        let picture = Beam { size: wanted.size, ..Beam::default() }.picture(&wanted.strokes);
        let size = [picture.width() as usize, picture.height() as usize];
        let image = ColorImage::from_rgb(size, &picture.to_srgb());
        lock(easel).painted = Some(Arc::new(image));
        context.request_repaint();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}
