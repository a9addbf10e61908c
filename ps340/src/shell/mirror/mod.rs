//! What people see of the machine, copied by its thread for a window.
//!
//! The window requests what it shows ([`MirrorRequest`]), and only that is copied; what has not changed since is shared
//! with the copy before. Neither thread waits for the other longer than a pointer takes to move.

mod network;
mod structure;
mod traffic;

pub use network::{ArcShown, FunctionShown, InputShown};
pub use structure::NodeShown;
pub use traffic::{Traffic, TrafficEntry};

use crate::{
    calligraphic::{Drawer, Refresh, Scene, SharedDisplay},
    line::LineId,
    machine::{Counters, KeyboardMode, Machine, Panel, time_of_frame},
    raster::FrameBuffer,
};
use std::sync::{Arc, Mutex, MutexGuard};

/// Frames between two copies of what people read: texts at ten a second are as many as anyone follows.
const READ_FRAMES: u64 = 6;

/// What a window shows besides screens and panel.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MirrorRequest {
    /// The functions whose names hold this text, in capital letters; none if the network is not shown.
    pub network: Option<String>,
    /// Whether the display structure is shown.
    pub structure: bool,
    /// Whether the bytes on the host lines are shown.
    pub traffic: bool,
    /// Whether the messages of the machine are shown.
    pub log: bool,
    /// Whether the refresh of the display is shown.
    pub refresh: bool,
}

/// What people see of the machine at a frame.
#[derive(Clone, Debug, Default)]
pub struct MirrorFrame {
    /// The frame.
    pub frame: u64,
    /// Its time in microseconds.
    pub micros: u64,
    /// What the vector screen shows.
    pub scene: Scene,
    /// Who writes its light.
    pub drawer: Drawer,
    /// What the raster screen shows.
    pub raster: Arc<FrameBuffer>,
    /// Labels, lights, message line.
    pub panel: Panel,
    /// Where typed characters go.
    pub mode: KeyboardMode,
    /// Whether a program takes what stylus or puck of the tablet send.
    pub tablet_is_read: bool,
    /// What the machine has counted.
    pub counters: Counters,
    /// Hosts that are attached: who, in the order of their lines.
    pub hosts: Vec<String>,
    /// The latest messages of the machine, oldest first.
    pub log: Arc<Vec<String>>,
    /// The functions that were asked for.
    pub network: Arc<Vec<FunctionShown>>,
    /// The display structure as a tree.
    pub structure: Arc<Vec<NodeShown>>,
    /// How long the beam needs for the picture, if that is asked.
    pub refresh: Option<Refresh>,
    /// What passed on the host lines lately.
    pub traffic: Arc<Vec<TrafficEntry>>,
}

/// A copy of what people see, renewed by the machine's thread and read by the window's.
pub struct Mirror {
    requested: Mutex<MirrorRequest>,
    shown: Mutex<Arc<MirrorFrame>>,
    traffic: Mutex<Traffic>,
    screen: Arc<SharedDisplay>,
    /// Called after each copy that differs from the one before.
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Mirror {
    /// A mirror without a picture; `wake` is called by the machine's thread when there is something new.
    ///
    /// - `drawer`: who writes the light of the vector screen.
    pub fn new(drawer: Drawer, wake: impl Fn() + Send + Sync + 'static) -> Mirror {
        Mirror {
            requested: Mutex::default(),
            shown: Mutex::default(),
            traffic: Mutex::default(),
            screen: Arc::new(SharedDisplay::new(drawer)),
            wake: Box::new(wake),
        }
    }

    /// The vector screen, which machine and window share.
    pub fn screen(&self) -> &Arc<SharedDisplay> {
        &self.screen
    }

    /// Requests what is copied from now on.
    pub fn request(&self, requested: &MirrorRequest) {
        let mut now = lock(&self.requested);
        if *now != *requested {
            now.clone_from(requested);
        }
    }

    /// The latest copy.
    pub fn shown(&self) -> Arc<MirrorFrame> {
        lock(&self.shown).clone()
    }

    /// Bytes pass on a host line.
    pub(super) fn pass(&self, line: LineId, from_host: bool, bytes: &[u8], machine: &Machine) {
        if lock(&self.requested).traffic {
            lock(&self.traffic).record(time_of_frame(machine.frame()), line, from_host, bytes);
        }
    }

    /// Copies what people see now.
    ///
    /// - `hosts`: who is attached.
    pub(super) fn renew<'a>(&self, machine: &mut Machine, hosts: impl Iterator<Item = &'a str>) {
        let before = self.shown();
        let frame = machine.frame();
        let mut shown = MirrorFrame {
            frame,
            micros: time_of_frame(frame),
            panel: machine.panel().clone(),
            scene: machine.scene().clone(),
            drawer: machine.screen().drawer().clone(),
            mode: machine.keyboard_mode(),
            tablet_is_read: machine.tablet_is_read(),
            counters: machine.counters(),
            hosts: hosts.map(str::to_owned).collect(),
            ..MirrorFrame::clone(&before)
        };
        let mut is_new = shown.panel != before.panel
            || shown.mode != before.mode
            || shown.tablet_is_read != before.tablet_is_read
            || shown.scene.settings != before.scene.settings
            || shown.scene.version != before.scene.version
            || shown.hosts != before.hosts;
        if *machine.frame_buffer() != *before.raster {
            shown.raster = Arc::new(machine.frame_buffer().clone());
            is_new = true;
        }
        if frame / READ_FRAMES != before.frame / READ_FRAMES {
            is_new |= self.renew_texts(&mut shown, machine)
                || Counters { frame: 0, ..shown.counters } != Counters { frame: 0, ..before.counters };
        }
        *lock(&self.shown) = Arc::new(shown);
        if is_new {
            (self.wake)();
        }
    }

    /// Copies what people read; whether something of it is new.
    fn renew_texts(&self, shown: &mut MirrorFrame, machine: &mut Machine) -> bool {
        let requested = lock(&self.requested).clone();
        let mut is_new = false;
        if let Some(pattern) = &requested.network {
            if !machine.memory().network.counts_activity() {
                machine.instruments().count_activity(true);
            }
            is_new |= renew(&mut shown.network, network::functions(machine, pattern));
        }
        if requested.structure {
            is_new |= renew(&mut shown.structure, structure::tree(machine));
        }
        if requested.log
            && (shown.log.len() != machine.log().count()
                || shown.log.last().map(String::as_str) != machine.log().last())
        {
            is_new |= renew(&mut shown.log, machine.log().map(str::to_owned).collect());
        }
        if requested.refresh {
            let refresh = Some(machine.refresh());
            is_new |= refresh != shown.refresh;
            shown.refresh = refresh;
        }
        let mut traffic = lock(&self.traffic);
        if !requested.traffic {
            traffic.clear();
        } else if traffic.take_change() {
            shown.traffic = Arc::new(traffic.entries().cloned().collect());
            is_new = true;
        }
        is_new
    }
}

/// Replaces a shared list if it is another now.
fn renew<T: PartialEq>(shared: &mut Arc<Vec<T>>, now: Vec<T>) -> bool {
    let differs = **shared != now;
    if differs {
        *shared = Arc::new(now);
    }
    differs
}

/// A thread that panicked with the lock leaves a whole value: each is replaced at once.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

#[cfg(test)]
mod tests;
