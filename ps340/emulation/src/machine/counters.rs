//! What the machine has counted.

use std::fmt;

/// Counters since the start of the machine, except where "now" is stated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Frames.
    pub frame: u64,
    /// Updates of the picture.
    pub updates: u64,
    /// Vectors that went into the latest update.
    pub vectors: u64,
    /// Strokes that came out of the latest update.
    pub strokes: u64,
    /// Time that the beam needs for the picture of now, microseconds.
    pub refresh_micros: u64,
    /// Frames from a refresh of it to the next.
    pub refresh_frames: u64,
    /// Function firings.
    pub firings: u64,
    /// Commands carried out.
    pub commands: u64,
    /// Bytes from all hosts.
    pub bytes_in: u64,
    /// Messages to the host.
    pub messages_out: u64,
    /// Numbered messages of the machine.
    pub messages: u64,
    /// Bytes from hosts that were no packet and no text.
    pub noise: u64,
    /// Objects now.
    pub objects: u64,
    /// Bytes of mass memory now.
    pub bytes: u64,
}

impl fmt::Display for Counters {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "frame={} updates={} vectors={} strokes={} refresh_micros={} refresh_rate={} firings={} commands={} bytes_in={} messages_out={} messages={} \
             noise={} objects={} bytes={}",
            self.frame,
            self.updates,
            self.vectors,
            self.strokes,
            self.refresh_micros,
            60.0 / self.refresh_frames.max(1) as f32,
            self.firings,
            self.commands,
            self.bytes_in,
            self.messages_out,
            self.messages,
            self.noise,
            self.objects,
            self.bytes
        )
    }
}
