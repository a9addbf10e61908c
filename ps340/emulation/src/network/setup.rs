//! SETUP CNESS: inputs become constants or queues while the network runs.

use super::Network;
use crate::{
    functions::Rule,
    port::{Cause, Fault, ObjectId, QueueRole},
};
use protocol::command::Input;

impl Network {
    /// Makes an input of a function a constant or a queue.
    ///
    /// - `constant`: TRUE makes it a constant, with the message that came last, if one waits; the others go. FALSE
    ///   makes it a queue, with the constant, a default included, as its first message.
    ///
    /// A function waits for a first value of an input made constant, unless it could do without one as it was
    /// instanced, or fires on any input. One whose inputs are all constant never fires. What a function accumulates
    /// in a constant input it does not accumulate in a queue. Instancing anew gives the inputs of the table again.
    ///
    /// # Errors
    /// A fault if the object is no function or has no such input; nothing changes then.
    ///
    /// # Source
    /// The command is remembered; what becomes of messages that wait is ours.
    pub fn setup_cness(&mut self, id: ObjectId, input: Input, constant: bool) -> Result<(), Fault> {
        let Some((row, instance)) = self.function(id).zip(self.instances.get_mut(id.index())) else {
            return Err(Fault { function: "", cause: Cause::NotAFunction });
        };
        let Some(place) = instance.input(input) else {
            return Err(Fault { function: row.name, cause: Cause::NoSuchInput(input) });
        };
        let ports = &mut self.ports.get_mut(instance.ports)[..usize::from(instance.inputs)];
        let port = &mut ports[place];
        if port.is_active() != constant {
            return Ok(());
        }
        if constant {
            let role = row.input_of_size(instance.size, place as u16 + 1).map(|spec| spec.role);
            let required = match role {
                Some(QueueRole::Active) => row.rule == Rule::All,
                Some(QueueRole::Constant) => true,
                _ => false,
            };
            self.string_bytes -= port.string_bytes(&self.backlog);
            port.make_constant(required, &mut self.backlog);
            self.string_bytes += port.string_bytes(&self.backlog);
        } else {
            port.make_active();
        }
        instance.count(ports);
        self.queue_if_ready(id);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        network::tests::Bench,
        port::{
            Effect,
            Literal::{B, I, R, S},
        },
    };

    impl Bench {
        /// `SETUP CNESS`.
        fn cness(&mut self, constant: bool, input: u32, name: &str) -> &mut Bench {
            let id = self.id(name);
            self.network.setup_cness(id, Input::Number(input), constant).unwrap();
            self
        }
    }

    #[test]
    fn an_input_made_constant_is_used_again_and_again() {
        let mut bench = Bench::default();
        bench.define("A:=F:ADD").connect("A<1>:<1>X").cness(true, 2, "A");
        assert_eq!(bench.send(I(1), 1, "A").run(), [], "it waits for a first constant");
        assert_eq!(bench.send(I(10), 2, "A").arrived("X"), [I(11).value()]);
        assert_eq!(bench.send(I(2), 1, "A").send(I(3), 1, "A").arrived("X"), [I(12).value(), I(13).value()]);
        assert_eq!(bench.send(I(20), 2, "A").run(), [], "a constant fires nothing");
        assert_eq!(bench.send(I(1), 1, "A").arrived("X"), [I(21).value()]);
    }

    #[test]
    fn an_input_made_active_is_a_queue_that_begins_with_the_constant() {
        let mut bench = Bench::default();
        bench.define("A:=F:ADDC").connect("A<1>:<1>X").send(I(5), 2, "A").cness(false, 2, "A");
        assert_eq!(bench.send(I(1), 1, "A").send(I(2), 1, "A").arrived("X"), [I(6).value()]);
        assert_eq!(bench.send(I(7), 2, "A").send(I(8), 2, "A").arrived("X"), [I(9).value()]);
        assert_eq!(bench.send(I(0), 1, "A").arrived("X"), [I(8).value()]);
    }

    #[test]
    fn of_a_queue_made_constant_the_last_message_stays() {
        let mut bench = Bench::default();
        bench.define("A:=F:CONCATENATE").connect("A<1>:<1>X");
        for text in ["one", "two", "three"] {
            bench.send(S(text), 2, "A");
        }
        bench.cness(true, 2, "A");
        assert_eq!(bench.network.string_bytes, 5);
        for text in ["a ", "b "] {
            bench.send(S(text), 1, "A");
        }
        assert_eq!(bench.arrived("X"), [S("a three").value(), S("b three").value()]);
        assert_eq!(bench.network.string_bytes, 5);
    }

    #[test]
    fn a_function_whose_inputs_are_all_constant_never_fires() {
        let mut bench = Bench::default();
        bench.define("A:=F:ADDC").connect("A<1>:<1>X").send(I(1), 2, "A").send(I(1), 1, "A");
        bench.cness(true, 1, "A");
        assert_eq!(bench.send(I(2), 1, "A").run(), [], "though it was ready before");
        assert_eq!(bench.cness(false, 1, "A").arrived("X"), [I(3).value()], "the last message was kept");
    }

    #[test]
    fn an_input_made_constant_may_let_a_function_fire_that_waits() {
        let mut bench = Bench::default();
        bench.define("P:=F:PASSTHRU(2)").connect("P<1>:<1>X P<2>:<1>Y").cness(true, 1, "P").send(I(9), 1, "P");
        assert_eq!(bench.run(), []);
        assert_eq!(bench.send(I(1), 2, "P").run().len(), 2, "each message of <2> takes the constant with it");
        let mut clock = Bench::default();
        clock.define("C:=F:CLFRAMES").cness(false, 4, "C").send(B(true), 4, "C");
        clock.run();
        assert_eq!(clock.network.counters().firings, 2, "the default and the message were consumed");
    }

    #[test]
    fn instancing_anew_gives_the_inputs_of_the_table_again() {
        let mut bench = Bench::default();
        bench.define("A:=F:ADD").cness(true, 1, "A").cness(true, 1, "A").cness(true, 2, "A").define("A:=F:ADD");
        bench.connect("A<1>:<1>X").send(R(1.0), 1, "A").send(R(2.0), 2, "A");
        assert_eq!(bench.arrived("X"), [R(3.0).value()]);
    }

    #[test]
    fn what_is_not_there_cannot_be_set_up() {
        let mut bench = Bench::default();
        bench.define("A:=F:ADD").connect("A<1>:<1>X");
        let (a, x) = (bench.id("A"), bench.id("X"));
        let fault = bench.network.setup_cness(a, Input::Number(3), true).unwrap_err();
        assert_eq!(fault.text("A"), "W 9 *** No such input <3> of A");
        let fault = bench.network.setup_cness(x, Input::Number(1), true).unwrap_err();
        assert_eq!(fault.text("X"), "W 9 *** X is no function");
        assert!(!bench.run().iter().any(|effect| matches!(effect, Effect::Fault { .. })));
    }
}
