//! The speed of a line: when bytes have passed. Time is an argument.

use std::time::Duration;

/// Bits that a byte takes on an asynchronous line: start, eight of data, stop.
const BITS_A_BYTE: u64 = 10;
/// How far a line may catch up when it was looked at too late: one frame.
const SLACK: Duration = Duration::from_nanos(1_000_000_000 / 60);

/// Passes bytes at a number of bits a second, smoothly: never more than a frame's worth at once.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    speed: Option<u32>,
    free_at: Duration,
}

impl Pace {
    /// A line of so many bits a second; none for one that takes no time.
    pub(super) fn new(speed: Option<u32>) -> Pace {
        Pace { speed, free_at: Duration::ZERO }
    }

    /// Bytes that may pass at once: those of a frame, at least one. None if there is no limit.
    pub(super) fn piece(&self) -> Option<usize> {
        self.speed.map(|speed| ((u64::from(speed) / BITS_A_BYTE / 60) as usize).max(1))
    }

    /// Lets bytes pass that are there at `now`; returns when the last of them has passed.
    pub(super) fn pass(&mut self, bytes: usize, now: Duration) -> Duration {
        let Some(speed) = self.speed else { return now };
        let nanos = bytes as u64 * BITS_A_BYTE * 1_000_000_000 / u64::from(speed.max(1));
        self.free_at = self.free_at.max(now.saturating_sub(SLACK)) + Duration::from_nanos(nanos);
        self.free_at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_busy_line_passes_a_byte_in_ten_bits() {
        for speed in [300, 9600, 115_200, 10_000_000] {
            let mut pace = Pace::new(Some(speed));
            let piece = pace.piece().unwrap();
            assert!(piece == 1 || piece as u32 <= speed / 600);
            let (mut now, mut bytes) = (Duration::from_secs(5), 0);
            while now < Duration::from_secs(15) {
                // Whoever waits wakes a millisecond too late.
                now = pace.pass(piece, now).max(now) + Duration::from_millis(1);
                bytes += piece;
            }
            let expected = f64::from(speed);
            assert!((bytes as f64 - expected).abs() <= 0.01 * expected + 2.0, "{speed}: {bytes} bytes in ten seconds");
        }
    }

    #[test]
    fn an_idle_line_saves_no_more_than_a_frame() {
        let mut pace = Pace::new(Some(9600));
        pace.pass(1, Duration::ZERO);
        let hour = Duration::from_secs(3600);
        let passed = pace.pass(960, hour);
        assert!(passed >= hour + Duration::from_secs(1) - SLACK && passed <= hour + Duration::from_secs(1));
    }

    #[test]
    fn a_line_without_speed_takes_no_time() {
        let mut pace = Pace::new(None);
        assert_eq!((pace.pass(1 << 30, SLACK), pace.piece()), (SLACK, None));
    }
}
