//! The initial structures: CURSOR and PICK_LOCATION, with what feeds them.
//!
//! # Source
//! Both names, that CURSOR is shown by the system and may be redefined, and `<2>` of PICK_LOCATION are confirmed. The
//! shape of the cross and the size of the pick box are ours.

use crate::{
    functions::devices::initial,
    memory::{MassMemory, Refusal},
    structure::{Node, Operation},
};
use glam::DVec2;
use protocol::command::{Fourth, Input, VectorClass, VectorList};

/// Half the size of the cross, in screen units.
const CROSS: f32 = 0.04;
/// Half the size of the pick box.
const PICK_BOX: DVec2 = DVec2::new(0.01, 0.01);

/// Makes the initial structures, which DELETE and INITIALIZE restore.
///
/// # Errors
/// [`Refusal`], if a name of the tables is wrong.
fn define_structures(memory: &mut MassMemory) -> Result<(), Refusal> {
    memory.define_initial_node("CURSOR", Node::Vectors(Box::new(cross().into())))?;
    let operation = Operation::PickLocation { center: DVec2::ZERO, size: PICK_BOX };
    memory.define_initial_node("PICK_LOCATION", Node::operate(operation, None))?;
    memory.connect_initial("TABLETIN", 1, "PICK_LOCATION", Input::Number(1));
    Ok(())
}

fn cross() -> VectorList {
    let point = |x, y| [x, y, 0.0, 1.0];
    VectorList {
        block_normalized: false,
        fourth: Fourth::Intensity,
        internal_units: false,
        class: VectorClass::Separate,
        dimension: 2,
        estimate: None,
        points: vec![point(-CROSS, 0.0), point(CROSS, 0.0), point(0.0, -CROSS), point(0.0, CROSS)],
        lines: Vec::new(),
    }
}

/// The mass memory after the start: the initial function instances exist.
pub(super) fn initial_memory() -> MassMemory {
    let mut memory = MassMemory::default();
    for initial in initial() {
        let made = memory.define_initial(&initial);
        debug_assert!(made.is_ok(), "{initial:?}: {made:?}");
    }
    let structures = define_structures(&mut memory);
    debug_assert!(structures.is_ok(), "{structures:?}");
    memory.objects.seal_system();
    memory
}
