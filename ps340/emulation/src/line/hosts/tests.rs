//! Facts about conditioned lines, with the host as the other end of a pipe.

use super::*;
use protocol::address::LineAddress;
use std::time::Duration;
use tokio::io::{DuplexStream, ReadHalf, WriteHalf};
use tokio::sync::mpsc;

/// The machine's end of a line: what it receives, and the transport to the host.
struct Line {
    events: mpsc::Receiver<LineEvent>,
    writer: Option<Writer>,
    from_machine: ReadHalf<DuplexStream>,
    to_machine: WriteHalf<DuplexStream>,
}

async fn attach(conditions: &str, room: usize) -> Line {
    let address: LineAddress = format!("pty:,{conditions}").parse().unwrap();
    let (sender, mut events) = mpsc::channel(room);
    let (near, far) = tokio::io::duplex(1 << 20);
    tokio::spawn(serve(
        far,
        Host::stream("pipe".into(), address.conditions),
        LineContext { events: sender, capture: None },
    ));
    let Some(LineEvent::Attached { writer, .. }) = events.recv().await else { panic!("it attaches first") };
    let (from_machine, to_machine) = tokio::io::split(near);
    Line { events, writer: Some(writer), from_machine, to_machine }
}

impl Line {
    /// Bytes that reach the machine, until there are so many.
    async fn arrived(&mut self, count: usize) -> Vec<u8> {
        let mut all = Vec::new();
        while all.len() < count {
            match self.events.recv().await {
                Some(LineEvent::Bytes(_, bytes)) => all.extend(bytes),
                other => panic!("{other:?}"),
            }
        }
        all
    }

    fn tell(&self, bytes: &[u8]) {
        assert!(self.writer.as_ref().unwrap().send(bytes.to_vec()));
    }

    async fn read(&mut self, count: usize) -> Vec<u8> {
        let mut bytes = vec![0; count];
        self.from_machine.read_exact(&mut bytes).await.unwrap();
        bytes
    }
}

fn run(test: impl Future<Output = ()>) {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
    let patience = Duration::from_secs(30);
    runtime.block_on(async { tokio::time::timeout(patience, test).await.expect("it does not hang") });
}

#[test]
fn a_slow_line_takes_its_time_in_both_directions() {
    run(async {
        let mut line = attach("speed=2400", 64).await;
        let begin = Instant::now();
        // 60 bytes are 600 bits: a quarter of a second; a frame may be saved.
        let bytes: Vec<u8> = (0..60).collect();
        line.to_machine.write_all(&bytes).await.unwrap();
        line.tell(&bytes);
        line.tell(b"x");
        let (mut arrived, mut pieces) = (Vec::new(), 0);
        while arrived.len() < bytes.len() {
            arrived.extend(line.arrived(1).await);
            pieces += 1;
        }
        assert_eq!(arrived, bytes);
        assert!(pieces >= 15, "a frame of this line has four bytes, and they came in {pieces} pieces");
        assert!(begin.elapsed() >= Duration::from_millis(230), "{:?}", begin.elapsed());
        assert_eq!(line.read(61).await, [&bytes[..], b"x"].concat());
        assert!(begin.elapsed() >= Duration::from_millis(235), "{:?}", begin.elapsed());
    });
}

#[test]
fn the_host_stops_the_machine_with_xoff() {
    run(async {
        let mut line = attach("flow=xonxoff", 16).await;
        line.to_machine.write_all(b"a\x13b").await.unwrap();
        assert_eq!(line.arrived(2).await, b"ab");
        line.tell(b"held");
        let nothing = tokio::time::timeout(Duration::from_millis(50), line.from_machine.read_u8()).await;
        assert!(nothing.is_err(), "{nothing:?}");
        line.to_machine.write_all(b"\x11").await.unwrap();
        assert_eq!(line.read(4).await, b"held");
    });
}

#[test]
fn a_host_that_leaves_after_xoff_is_let_go() {
    run(async {
        let mut line = attach("flow=xonxoff", 16).await;
        line.to_machine.write_all(b"\x13").await.unwrap();
        line.tell(b"told");
        line.to_machine.shutdown().await.unwrap();
        assert!(matches!(line.events.recv().await, Some(LineEvent::Closed { error: None, .. })));
        line.writer = None;
        let mut rest = Vec::new();
        line.from_machine.read_to_end(&mut rest).await.unwrap();
        assert_eq!(rest, b"told");
    });
}

#[test]
fn a_busy_machine_stops_the_host_and_lets_it_go_on() {
    run(async {
        // The machine takes nothing: one piece waits for it, and then the queue fills.
        let mut line = attach("flow=xonxoff,speed=10000000", 1).await;
        let bytes: Vec<u8> = (0..20_000_u32).map(|i| b'a' + (i % 26) as u8).collect();
        let mut sent = 0;
        let mut control = [0];
        while sent < bytes.len() {
            tokio::select! {
                biased;
                read = line.from_machine.read_exact(&mut control) => { read.unwrap(); break }
                () = tokio::time::sleep(Duration::from_millis(2)) => {
                    line.to_machine.write_all(&bytes[sent..sent + 500]).await.unwrap();
                    sent += 500;
                }
            }
        }
        assert_eq!(control, [XOFF]);
        assert!(sent < bytes.len());
        // A host that does not obey loses nothing.
        line.to_machine.write_all(&bytes[sent..]).await.unwrap();
        assert!(line.arrived(bytes.len()).await == bytes);
        assert_eq!(line.read(1).await, [XON]);
    });
}

#[test]
fn the_six_bit_form_passes_a_line_of_seven_bits_with_flow_control() {
    use protocol::command::parse;
    use protocol::wire::{DataForm, PacketForm, Sending, write_commands_as};
    run(async {
        let mut line = attach("flow=xonxoff,bits=7", 16).await;
        let command = parse(b"SEND M2D(17,19 -1,1e300) TO <1>A;").unwrap();
        for packets in [PacketForm::Count, PacketForm::Escape] {
            let mut stream = Vec::new();
            write_commands_as(Sending { packets, data: DataForm::SixBit }, [&command], &mut stream).unwrap();
            line.to_machine.write_all(&stream).await.unwrap();
            assert_eq!(line.arrived(stream.len()).await, stream);
        }
        line.tell(b"\xc1b");
        assert_eq!(line.read(2).await, b"Ab");
    });
}
