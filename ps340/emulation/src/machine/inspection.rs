//! Looking into the machine: pictures, texts, counters, objects; and single steps of its network.

use super::{Counters, Machine, Panel, WORK_PER_STEP, describe};
use crate::{
    disk::Disk, memory::MassMemory, network::Network, picture::Picture, port::ObjectId, raster::FrameBuffer,
    terminal::Terminal, traversal::Update,
};

impl Machine {
    /// Whether a function other than the system's takes what stylus or puck of the tablet send.
    pub fn tablet_is_read(&self) -> bool {
        let objects = &self.memory.objects;
        let (Some(tablet), location) = (objects.find("TABLETIN"), objects.find("PICK_LOCATION")) else { return false };
        self.memory.network.arcs(tablet).any(|(_, to)| Some(to.object) != location)
    }

    /// The memory behind the raster screen.
    pub fn frame_buffer(&self) -> &FrameBuffer {
        &self.frame_buffer
    }

    /// What the raster screen shows now.
    pub fn raster_picture(&self) -> Picture {
        self.frame_buffer.picture()
    }

    /// The latest update.
    pub fn latest_update(&self) -> &Update {
        &self.latest.update
    }

    /// The terminal emulator: its text, cursor and modes.
    pub fn terminal(&self) -> &Terminal {
        &self.terminal
    }

    /// Labels, lights and texts around the screens.
    pub fn panel(&self) -> &Panel {
        &self.panel
    }

    /// The files that functions read and write.
    pub fn disk(&self) -> &Disk {
        &self.disk
    }

    /// The files that functions read and write, to put some there before the machine starts.
    pub fn disk_mut(&mut self) -> &mut Disk {
        &mut self.disk
    }

    /// The latest messages of the machine, oldest first.
    pub fn log(&self) -> impl Iterator<Item = &str> {
        self.reports.log()
    }

    /// What the machine has counted. Strokes and refresh are those of the latest picture that was drawn: one of many
    /// vectors is drawn when somebody looks ([`Machine::renew_picture`]).
    pub fn counters(&self) -> Counters {
        let refresh = self.refresh();
        Counters {
            frame: self.frame,
            objects: self.memory.objects.len() as u64,
            bytes: self.memory.bytes() as u64,
            vectors: self.latest.update.vectors,
            refresh_micros: refresh.micros as u64,
            refresh_frames: refresh.frames,
            ..self.counters
        }
    }

    /// The oldest message to the host that was not taken here before.
    pub fn take_message(&mut self) -> Option<Vec<u8>> {
        self.to_host.pop()
    }

    /// Objects, structure and network, to look at.
    pub fn memory(&self) -> &MassMemory {
        &self.memory
    }

    /// The network, to set traces, breaks and counters in it.
    pub fn instruments(&mut self) -> &mut Network {
        &mut self.memory.network
    }

    /// Lets the first function that is ready fire, and stops the network. Returns which it was.
    pub fn fire_one(&mut self) -> Option<ObjectId> {
        let fired = self.memory.network.step_one(&mut self.memory.effects);
        self.counters.firings += u64::from(fired.is_some());
        self.settle();
        fired
    }

    /// Lets a network that stands go on.
    pub fn resume(&mut self) {
        self.memory.network.resume();
        self.work_left = WORK_PER_STEP;
        self.settle();
    }

    /// What an object is, in one line; none if the name is unknown.
    pub fn describe(&self, name: &str) -> Option<String> {
        let id = self.memory.objects.find(name)?;
        Some(describe::describe(&self.memory, id))
    }

    /// What an object is, in one line, whether it has a name or not.
    pub fn describe_object(&self, id: ObjectId) -> String {
        describe::describe(&self.memory, id)
    }

    /// Counts anew what network and structure keep books of, for tests.
    ///
    /// # Errors
    /// What does not agree.
    pub fn audit(&self) -> Result<(), String> {
        self.memory.network.audit()?;
        self.memory.structures.audit()
    }
}
