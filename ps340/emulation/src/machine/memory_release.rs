//! Memory release: memory is given back when a picture or a structure was much larger than it is now.
//!
//! Lists of strokes, tables of nodes and the like keep their memory from frame to frame, since the next one is usually
//! as large. When much of what was there has gone, as after INITIALIZE, that memory is released.

/// Bytes by which structures and strokes must have shrunk from their most before memory is released.
const RELEASE_BYTES: usize = 8 << 20;

/// How much memory there was, and whether the process should release it.
#[derive(Debug, Default)]
pub(super) struct MemoryRelease {
    /// Most bytes of structures and strokes since the latest release.
    most: usize,
    is_due: bool,
}

impl MemoryRelease {
    /// Whether a release is needed: much of what was there has gone, now that there are so many bytes of structures and
    /// strokes.
    pub(super) fn is_needed(&mut self, burden: usize) -> bool {
        if burden + RELEASE_BYTES > self.most {
            self.most = self.most.max(burden);
            return false;
        }
        *self = MemoryRelease { most: burden, is_due: true };
        true
    }

    /// Whether much memory was freed since this was asked last.
    pub(super) fn take_due(&mut self) -> bool {
        std::mem::take(&mut self.is_due)
    }
}

#[cfg(test)]
mod tests {
    use crate::{line::LineId, machine::*};

    #[test]
    fn the_room_of_a_large_picture_goes_with_it() {
        let mut machine = Machine::new(Settings::default());
        machine.step([Input::Attach(LineId(1))], 0);
        let mut tell = |text: &str| {
            machine.step([Input::Bytes(LineId(1), text.as_bytes().to_vec())], 0);
            machine.renew_picture();
            machine.next_frame();
            let shown = machine.vector_frame([64, 64]).chunks_exact(4).any(|pixel| pixel[1] > 0);
            (machine.was_relieved(), shown, machine.latest.update.strokes.capacity(), machine.display_strokes())
        };
        let vectors = "-1,0 1,0 ".repeat(200_000);
        let (relieved, shown, room, seen) = tell(&format!("A := VECTOR_LIST {vectors}; DISPLAY A;"));
        assert!(!relieved && shown && room > 300_000 && seen > 300_000);
        assert_eq!(tell("INITIALIZE;"), (true, false, 0, 0));
        assert!(!tell("A := VECTOR_LIST -1,0 1,0; DISPLAY A;").0);
    }
}
