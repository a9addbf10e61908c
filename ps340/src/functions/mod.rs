//! The functions of the machine: one row each, by families.
//!
//! A row says everything that is known about a function: its inputs and outputs, where the knowledge comes from,
//! what it does, and examples that a test runs. The network, messages and pages of help are made from the rows.

mod row;

pub mod accumulation;
pub mod algebra;
pub mod arithmetic;
pub mod characters;
pub mod clocks;
pub mod comparison;
pub mod devices;
pub mod host;
pub mod labels;
pub mod logic;
pub mod names;
pub mod printing;
pub mod routing;
pub mod selection;
pub mod strings;
pub mod transformation;
pub mod vectors;
pub mod viewing;

pub use row::{Behaviour, Clock, Confidence, Example, Family, FunctionRow, MAX_SIZE, Rule, Shape, SizeError, Source};

use std::{collections::HashMap, sync::LazyLock};

/// The families of functions that a command can instance, in the order of the manuals.
pub static FAMILIES: [(&str, &[FunctionRow]); 16] = [
    ("arithmetic", arithmetic::ROWS),
    ("logic", logic::ROWS),
    ("comparison", comparison::ROWS),
    ("vectors", vectors::ROWS),
    ("transformation", transformation::ROWS),
    ("viewing", viewing::ROWS),
    ("routing", routing::ROWS),
    ("accumulation", accumulation::ROWS),
    ("clocks", clocks::ROWS),
    ("strings", strings::ROWS),
    ("characters", characters::ROWS),
    ("printing", printing::ROWS),
    ("selection", selection::ROWS),
    ("labels", labels::ROWS),
    ("names", names::ROWS),
    ("host line and disk", host::ROWS),
];

/// The rows of all functions that a command can instance.
pub fn all() -> impl Iterator<Item = &'static FunctionRow> {
    FAMILIES.iter().flat_map(|(_, rows)| rows.iter())
}

/// System functions of which a user can make further instances. They do what the initial ones do, but nothing of the
/// devices comes to them.
const ALSO_FUNCTIONS: [&str; 2] = ["KBHANDLER", "SCREENSAVE"];

/// The row of a function.
///
/// - `name`: the type without `F:`, upper case.
pub fn find(name: &str) -> Option<&'static FunctionRow> {
    static BY_NAME: LazyLock<HashMap<&'static str, &'static FunctionRow>> = LazyLock::new(|| {
        let system = devices::rows().filter(|row| ALSO_FUNCTIONS.contains(&row.name));
        all().chain(system).map(|row| (row.name, row)).collect()
    });
    BY_NAME.get(name).copied()
}

#[cfg(test)]
mod tests {
    use super::find;

    /// The names of section C.13 of the reference, and those that its tables add.
    const NAMES: &str = "ACCUMULATE ADD ADDC AND ANDC ATSCALE AVERAGE BOOLEAN_CHOOSE BROUTE BROUTEC CBROUTE CCONCATENATE \
        CDIV CEILING CGE CGT CHANGEQTYPE CHARCONVERT CHARMASK CI CIROUTE CLCSECONDS CLE CLFRAMES CLT CLTICKS CMUL COLOR \
        COMP_STRING CONCATENATE CONCATENATEC CONCATXDATA CONSTANT CROTATE CROUTE CSCALE CSUB CVEC DELTA DEPACKET DIV \
        DIVC DSCALE DXROTATE DYROTATE DZROTATE EDGE_DETECT EQ EQC FETCH FIND_STRING FIX FLOAT FOV GATHER_GENFCN \
        GATHER_STRING GE GEC GT GTC INPUTS_CHOOSE KBHANDLER LABEL LBL_EXTRACT LE LEC LENGTH_STRING LIMIT LINEEDITOR LIST \
        LOOKAT LOOKFROM LT LTC MATRIX2 MATRIX3 MATRIX4 MCAT_STRING MCONCATENATE MOD MODC MUL MULC NE NEC NOP NOT OR ORC \
        PACKET PARTS PASSTHRU PICK PICKINFO PRINT PUT_STRING RANGE_SELECT RASTERSTREAM READDISK READSTREAM ROUND ROUTE \
        ROUTEC SCALE SCREENSAVE SEND SINCOS SPLIT SQROOT STRING_TO_NUM SUB SUBC SYNC TAKE_STRING TEC TIMEOUT TRANS_STRING \
        VEC VECC WINDOW WRITEDISK XFORMDATA XOR XORC XROTATE XVECTOR YROTATE YVECTOR ZROTATE ZVECTOR";

    #[test]
    fn every_function_that_is_known_of_has_a_row() {
        let missing: Vec<&str> = NAMES.split_whitespace().filter(|name| find(name).is_none()).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
