//! The machine as a whole: the parts that it owns.

use super::{
    Counters, Panel, Settings, WORK_PER_STEP, devices::Devices, host_line::HostLine, initial::initial_memory,
    kept::Kept, keyboard::Keyboard, mailbox::Mailbox, outgoing::Outgoing, parallel_line::ParallelLine, relief::Relief,
    renderings::Renderings, sight::Sight, streams::Streams, tube::Tube, waiting::Waiting, watch::Watch,
};
use crate::{
    disk::Disk, interpreter::Message, line::LineId, memory::MassMemory, raster::FrameBuffer, terminal::Terminal,
    traversal::Update,
};
use protocol::wire::MessageWriter;
use std::collections::{BTreeMap, VecDeque};

/// The PS 340.
#[derive(Debug)]
pub struct Machine {
    pub(super) settings: Settings,
    pub(super) memory: MassMemory,
    pub(super) lines: BTreeMap<LineId, HostLine>,
    pub(super) parallels: BTreeMap<LineId, ParallelLine>,
    /// Messages for the hosts of `parallels`.
    pub(super) mailboxes: BTreeMap<LineId, Mailbox>,
    /// How messages go to each host.
    pub(super) writers: BTreeMap<LineId, MessageWriter>,
    /// The line whose commands are carried out, if it asked for messages of its own.
    pub(super) speaking: Option<LineId>,
    pub(super) devices: Devices,
    pub(super) keyboard: Keyboard,
    pub(super) terminal: Terminal,
    pub(super) tube: Tube,
    pub(super) sight: Sight,
    pub(super) watch: Watch,
    pub(super) panel: Panel,
    pub(super) frame_buffer: FrameBuffer,
    pub(super) frame: u64,
    pub(super) work_left: u64,
    /// Messages of the machine since the latest frame: all, those given to ERROR, WARNING or INFORMATION, and those that
    /// were too many for these.
    pub(super) reported: u64,
    pub(super) emitted: u64,
    pub(super) unheard: u64,
    pub(super) network_idle: bool,
    pub(super) update: Update,
    /// Version of the structure that `update` shows; none before the first.
    pub(super) updated: Option<u64>,
    /// What functions want of the next update.
    pub(super) waiting: Waiting,
    pub(super) renderings: Renderings,
    pub(super) relief: Relief,
    pub(super) streams: Streams,
    pub(super) disk: Disk,
    pub(super) messages: Vec<Message>,
    pub(super) log: VecDeque<String>,
    pub(super) to_host: Kept,
    pub(super) outputs: Outgoing,
    pub(super) counters: Counters,
}

impl Machine {
    /// A machine as after its start: the initial function instances exist, nothing is displayed.
    pub fn new(settings: Settings) -> Machine {
        let mut machine = Machine {
            settings,
            memory: initial_memory(),
            lines: BTreeMap::new(),
            parallels: BTreeMap::new(),
            mailboxes: BTreeMap::new(),
            writers: BTreeMap::new(),
            speaking: None,
            devices: Devices::default(),
            keyboard: Keyboard::default(),
            terminal: Terminal::default(),
            tube: Tube::default(),
            sight: Sight::default(),
            watch: Watch::default(),
            panel: Panel::default(),
            frame_buffer: FrameBuffer::default(),
            frame: 0,
            work_left: WORK_PER_STEP,
            reported: 0,
            emitted: 0,
            unheard: 0,
            network_idle: true,
            update: Update::default(),
            updated: None,
            waiting: Waiting::default(),
            renderings: Renderings::default(),
            relief: Relief::default(),
            streams: Streams::default(),
            disk: Disk::default(),
            messages: Vec::new(),
            log: VecDeque::new(),
            to_host: Kept::default(),
            outputs: Outgoing::default(),
            counters: Counters::default(),
        };
        machine.switch_keyboard(settings.keyboard);
        machine
    }
}
