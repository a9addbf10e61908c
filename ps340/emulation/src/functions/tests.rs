//! Facts about the whole table of functions.

use super::{Confidence, FunctionExample, all, devices};
use crate::port::Literal;

/// The names of the functions that are believed to have existed.
const NAMES: &str = "ACCUMULATE ADD ADDC AND ANDC ATSCALE AVERAGE BOOLEAN_CHOOSE BROUTE BROUTEC CBROUTE CCONCATENATE \
    CDIV CEILING CGE CGT CHANGEQTYPE CHARCONVERT CHARMASK CI CIROUTE CLCSECONDS CLE CLFRAMES CLT CLTICKS CMUL COLOR \
    COMP_STRING CONCATENATE CONCATENATEC CONCATXDATA CONSTANT CROTATE CROUTE CSCALE CSUB CVEC DELTA DEPACKET DIV DIVC \
    DSCALE DXROTATE DYROTATE DZROTATE EDGE_DETECT EQ EQC FETCH FIND_STRING FIX FLOAT FOV GATHER_GENFCN GATHER_STRING GE \
    GEC GT GTC INPUTS_CHOOSE KBHANDLER LABEL LBL_EXTRACT LE LEC LENGTH_STRING LIMIT LINEEDITOR LIST LOOKAT LOOKFROM LT \
    LTC MATRIX2 MATRIX3 MATRIX4 MCAT_STRING MOD MODC MUL MULC NE NEC NOP NOT OR ORC PACKET PARTS PASSTHRU PICK PICKINFO \
    PRINT PUT_STRING RANGE_SELECT READDISK READSTREAM ROUND ROUTE ROUTEC SCALE SCREENSAVE SEND SINCOS SPLIT SQROOT \
    STRING_TO_NUM SUB SUBC SYNC TAKE_STRING TEC TIMEOUT TRANS_STRING VEC VECC WINDOW WRITEDISK XFORMDATA XOR XORC \
    XROTATE XVECTOR YROTATE YVECTOR ZROTATE ZVECTOR";

/// Functions that stand in other tables of the reference.
const ALSO: &str = "MCONCATENATE RASTERSTREAM";

/// Those that a program of the time is known to use.
const USED: &str = "ACCUMULATE ADDC CONCATENATE CONSTANT DELTA DSCALE DXROTATE DYROTATE DZROTATE FOV LIST LOOKAT MATRIX3 \
    MULC NOP PICKINFO PRINT ROUTE SCALE SUBC WINDOW XFORMDATA XVECTOR YVECTOR ZVECTOR ZROTATE";

#[test]
fn every_function_that_is_believed_to_have_existed_has_a_row() {
    for name in NAMES.split_whitespace().chain(ALSO.split_whitespace()) {
        let initial = devices::rows().any(|row| row.name == name);
        assert!(super::find(name).is_some() || initial, "{name} is missing");
    }
    assert_eq!(NAMES.split_whitespace().count(), 128);
}

#[test]
fn functions_that_programs_used_are_confirmed_and_only_few_others() {
    let is_confirmed = |name: &str| super::find(name).is_some_and(|row| row.source.confidence == Confidence::Confirmed);
    for name in USED.split_whitespace() {
        assert!(is_confirmed(name), "{name}");
    }
    // PICK is confirmed as an initial instance.
    let others: Vec<_> = all().map(|row| row.name).filter(|name| is_confirmed(name)).collect();
    let others: Vec<_> = others.into_iter().filter(|name| !USED.split_whitespace().any(|used| used == *name)).collect();
    assert_eq!(others, ["PICK"]);
}

#[test]
fn every_function_has_two_examples_and_one_of_them_with_a_result_or_a_fault() {
    let rows = || all().filter(|row| row.clock.is_none());
    let few: Vec<_> = rows().filter(|row| row.examples.len() < 2).map(|row| row.name).collect();
    assert!(few.is_empty(), "{few:?}");
    let says_nothing = |example: &FunctionExample| example.results.is_empty() && example.faults.is_empty();
    let idle: Vec<_> = rows().filter(|row| row.examples.iter().all(says_nothing)).map(|row| row.name).collect();
    assert!(idle.is_empty(), "{idle:?}");
}

#[test]
fn values_that_only_functions_make_are_faults_where_they_are_not_wanted() {
    let made = [Literal::Label([0.0; 3], "A", true), Literal::Vectors(&[]), Literal::T([[0.0; 4]; 4])];
    for value in made.map(|literal| literal.value()) {
        let takers = all().filter(|row| row.inputs.iter().any(|port| port.kinds.contains(value.kind())));
        let arithmetic = ["ADD", "GT", "AND", "VEC", "CONCATENATE", "PICKINFO", "ROUND"];
        let wrong: Vec<_> = takers.map(|row| row.name).filter(|name| arithmetic.contains(name)).collect();
        assert!(wrong.is_empty(), "{} is taken by {wrong:?}", value.kind());
    }
}
