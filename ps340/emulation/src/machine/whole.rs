//! The machine as a whole: the parts that it owns.

use super::{
    Counters, Panel, Settings, WORK_PER_STEP, devices::Devices, host_messages::HostMessages, initial::initial_memory,
    keyboard::Keyboard, latest_update::LatestUpdate, lines::Lines, memory_release::MemoryRelease, monitor::Monitor,
    outgoing::Outgoing, renderings::Renderings, reports::Reports, streams::Streams, tube::Tube,
    vector_display::VectorDisplay,
};
use crate::{disk::Disk, memory::MassMemory, raster::FrameBuffer, terminal::Terminal};

/// The PS 340.
#[derive(Debug)]
pub struct Machine {
    pub(super) settings: Settings,
    pub(super) memory: MassMemory,
    pub(super) lines: Lines,
    pub(super) devices: Devices,
    pub(super) keyboard: Keyboard,
    pub(super) terminal: Terminal,
    pub(super) tube: Tube,
    pub(super) vector_display: VectorDisplay,
    pub(super) monitor: Monitor,
    pub(super) panel: Panel,
    pub(super) frame_buffer: FrameBuffer,
    pub(super) frame: u64,
    pub(super) work_left: u64,
    pub(super) network_idle: bool,
    pub(super) latest: LatestUpdate,
    pub(super) renderings: Renderings,
    pub(super) memory_release: MemoryRelease,
    pub(super) streams: Streams,
    pub(super) disk: Disk,
    pub(super) reports: Reports,
    pub(super) to_host: HostMessages,
    pub(super) outputs: Outgoing,
    pub(super) counters: Counters,
}

impl Machine {
    /// A machine as after its start: the initial function instances exist, nothing is displayed.
    pub fn new(settings: Settings) -> Machine {
        let mut machine = Machine {
            settings,
            memory: initial_memory(),
            lines: Lines::default(),
            devices: Devices::default(),
            keyboard: Keyboard::default(),
            terminal: Terminal::default(),
            tube: Tube::default(),
            vector_display: VectorDisplay::default(),
            monitor: Monitor::default(),
            panel: Panel::default(),
            frame_buffer: FrameBuffer::default(),
            frame: 0,
            work_left: WORK_PER_STEP,
            network_idle: true,
            latest: LatestUpdate::default(),
            renderings: Renderings::default(),
            memory_release: MemoryRelease::default(),
            streams: Streams::default(),
            disk: Disk::default(),
            reports: Reports::default(),
            to_host: HostMessages::default(),
            outputs: Outgoing::default(),
            counters: Counters::default(),
        };
        machine.switch_keyboard(settings.keyboard);
        machine
    }
}
