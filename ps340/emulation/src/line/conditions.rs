//! What the conditions of a line do to its bytes: the lost eighth bit, and XON and XOFF.

use protocol::address::Conditions;

/// The byte that lets the other side send again: DC1, control-Q.
pub(super) const XON: u8 = 17;
/// The byte that asks the other side to stop: DC3, control-S.
pub(super) const XOFF: u8 = 19;

/// Bytes that wait for the machine on a line with flow control; then nothing more is read from the host. Ours: about
/// what the message pool of the machine held for a line.
pub(super) const INPUT_QUEUE: usize = 4096;

/// Who is to wait on a line with flow control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Flow {
    /// The host sent XOFF: nothing may be sent to it.
    pub(super) host_holds: bool,
    /// The input queue is nearly full: XOFF is sent to the host.
    pub(super) machine_holds: bool,
}

impl Flow {
    /// Takes the bytes that the host sent: what is left of them is data.
    pub(super) fn receive(&mut self, conditions: Conditions, bytes: &mut Vec<u8>) {
        if conditions.seven_bits {
            bytes.iter_mut().for_each(|byte| *byte &= 0x7f);
        }
        if conditions.flow {
            bytes.retain(|byte| {
                match *byte {
                    XOFF => self.host_holds = true,
                    XON => self.host_holds = false,
                    _ => return true,
                }
                false
            });
        }
    }

    /// Notes how many bytes wait in the input queue: at three quarters of it the host is to stop, at one quarter it may
    /// go on.
    pub(super) fn waiting(&mut self, conditions: Conditions, bytes: usize) {
        if !conditions.flow || bytes <= INPUT_QUEUE / 4 {
            self.machine_holds = false;
        } else if bytes >= INPUT_QUEUE / 4 * 3 {
            self.machine_holds = true;
        }
    }
}

/// The bytes as they leave for the host.
pub(super) fn leave(conditions: Conditions, bytes: &mut [u8]) {
    if conditions.seven_bits {
        bytes.iter_mut().for_each(|byte| *byte &= 0x7f);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOW: Conditions = Conditions { speed: None, flow: true, seven_bits: true };

    #[test]
    fn xon_and_xoff_are_no_data() {
        let (mut flow, mut bytes) = (Flow::default(), b"a\x13b\xc1".to_vec());
        flow.receive(FLOW, &mut bytes);
        assert_eq!((flow.host_holds, &bytes[..]), (true, &b"abA"[..]));
        let mut bytes = b"\x11".to_vec();
        flow.receive(FLOW, &mut bytes);
        assert!(!flow.host_holds && bytes.is_empty());
        let mut bytes = b"\x13\xff".to_vec();
        flow.receive(Conditions::default(), &mut bytes);
        assert_eq!((flow.host_holds, &bytes[..]), (false, &b"\x13\xff"[..]));
    }

    #[test]
    fn the_host_stops_at_three_quarters_and_goes_on_at_one() {
        let mut flow = Flow::default();
        let mut holds = |bytes| {
            flow.waiting(FLOW, bytes);
            flow.machine_holds
        };
        assert_eq!(
            [0, 2000, 3071, 3072, 4096, 1025, 1024, 2000].map(&mut holds),
            [false, false, false, true, true, true, false, false]
        );
    }
}
