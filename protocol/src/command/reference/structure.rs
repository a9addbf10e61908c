//! Commands that build and edit display structures.

use super::row::{CommandRow, Confidence::*, PLAIN, input, option};

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "NIL",
        section: "B.3",
        summary: "A null definition: may be referred to, draws nothing",
        syntax: &["name := NIL;"],
        routines: &["PNIL"],
        example: "CURSOR := NIL;",
        ..PLAIN
    },
    CommandRow {
        name: "ALIAS",
        section: "B.3",
        confidence: Uncertain,
        summary: "Another name for an object",
        syntax: &["name := name1;"],
        options: &[option("name1", "the object; a comma behind it makes NIL and the like a name", "", "")],
        example: "WHEEL := RIM;",
        ..PLAIN
    },
    CommandRow {
        name: "BEGIN_STRUCTURE",
        section: "B.3",
        confidence: Confirmed,
        summary: "A group of commands as one object; operate commands in it apply to all that follows them",
        syntax: &["name := BEGIN_Structure", "  [name1 :=] command; ...", "END_Structure;"],
        options: &[
            option("name1", "the node is called name.name1", "", "no name"),
            option("command", "data, operate and instance commands; SEND and the like act at once", "", ""),
        ],
        routines: &["PBEGS", "PENDS"],
        example: "ARM := BEGIN_STRUCTURE\n  TURN := ROTATE IN Z 0;\n  INSTANCE OF BONE;\nEND_STRUCTURE;",
        ..PLAIN
    },
    CommandRow {
        name: "BEGIN",
        section: "B.3",
        summary: "The effect of the commands up to END is seen all at once",
        syntax: &["BEGIN command; ... END;"],
        routines: &["PBEGIN", "PEND"],
        example: "BEGIN\n  DISPLAY A;\n  REMOVE B;\nEND;",
        ..PLAIN
    },
    CommandRow {
        name: "INSTANCE OF",
        section: "B.3",
        confidence: Confirmed,
        summary: "A node with any number of descendants, drawn in their order",
        syntax: &["name := INSTance OF name1 [, name2 ...];", "name := INSTance OF NIL;"],
        options: &[option("name1", "descendants; INCLUDE adds further ones", "", "none")],
        routines: &["PINST"],
        example: "CAR := INSTANCE OF BODY, WHEELS;",
        ..PLAIN
    },
    CommandRow {
        name: "INCLUDE",
        section: "B.3",
        confidence: Confirmed,
        summary: "Adds a descendant at the end of an instance node",
        syntax: &["INCLude name1 IN name2;"],
        options: &[option("name2", "an instance node or a structure; made if it does not exist", "", "")],
        routines: &["PINCL"],
        example: "INCLUDE DOOR IN CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "REMOVE FROM",
        section: "B.3",
        confidence: Confirmed,
        summary: "Takes a descendant out of an instance node; harmless if it is not there",
        syntax: &["REMove name1 FROM name2;"],
        routines: &["PREMFR"],
        example: "REMOVE DOOR FROM CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "PREFIX",
        section: "B.3",
        summary: "Inserts an operate node above what a name denotes",
        syntax: &["PREfix name WITH operate_command;"],
        options: &[option("operate_command", "without name and without APPLIED TO", "", "")],
        routines: &["PPREF"],
        example: "PREFIX CAR WITH ROTATE IN Y 30;",
        ..PLAIN
    },
    CommandRow {
        name: "FOLLOW",
        section: "B.3",
        summary: "Inserts an operate node below an operate node",
        syntax: &["FOLLow name WITH operate_command;"],
        options: &[option("operate_command", "without name and without APPLIED TO", "", "")],
        routines: &["PFOLL"],
        example: "FOLLOW ARM.TURN WITH SCALE BY 2;",
        ..PLAIN
    },
    CommandRow {
        name: "REMOVE PREFIX",
        section: "B.3",
        summary: "Takes back the last PREFIX",
        syntax: &["REMove PREfix OF name;"],
        routines: &["PREMPR"],
        example: "REMOVE PREFIX OF CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "REMOVE FOLLOWER",
        section: "B.3",
        summary: "Takes back the last FOLLOW",
        syntax: &["REMove FOLLOWer OF name;"],
        routines: &["PREMFO"],
        example: "REMOVE FOLLOWER OF ARM.TURN;",
        ..PLAIN
    },
    CommandRow {
        name: "DISPLAY",
        section: "B.3",
        confidence: Confirmed,
        summary: "Adds a name to the display list; no effect if it is there",
        syntax: &["DISPlay name;"],
        routines: &["PDISP"],
        example: "DISPLAY CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "REMOVE",
        section: "B.3",
        summary: "Takes a name off the display list",
        syntax: &["REMove name;"],
        routines: &["PREM"],
        example: "REMOVE CAR;",
        ..PLAIN
    },
    CommandRow {
        name: "DELETE",
        section: "B.3",
        confidence: Confirmed,
        summary: "Blanks objects and forgets their names",
        syntax: &["DELete name [, name ...];", "DELete prefix*;"],
        options: &[option("prefix*", "all user names that begin so; the names of the system are spared", "", "")],
        routines: &["PDELET", "PDELW"],
        example: "DELETE DOOR, T*;",
        ..PLAIN
    },
    CommandRow {
        name: "FORGET",
        section: "B.3",
        summary: "Removes a name only; what refers to the object keeps it",
        syntax: &["FORget name;", "FORget (unit_name);"],
        options: &[option("unit_name", "a unit: a group of names", "", "")],
        routines: &["PFORG"],
        example: "FORGET DOOR;\nFORGET (PARTS);",
        ..PLAIN
    },
    CommandRow {
        name: "OPTIMIZE STRUCTURE",
        section: "B.3",
        summary: "Structures up to END OPTIMIZE need not be changed later",
        syntax: &["OPTIMIZE STRUCTURE;", "  command; ...", "END OPTIMIZE;"],
        routines: &["POPTS", "PENDOP"],
        example: "OPTIMIZE STRUCTURE;\nA := INSTANCE OF B;\nEND OPTIMIZE;",
        ..PLAIN
    },
    CommandRow {
        name: "OPTIMIZE MEMORY",
        section: "B.3",
        confidence: Uncertain,
        summary: "Compacts free memory",
        syntax: &["OPTIMIZE MEMORY;"],
        example: "OPTIMIZE MEMORY;",
        ..PLAIN
    },
    CommandRow {
        name: "RAWBLOCK",
        section: "B.3",
        summary: "A named block of memory that the host manages",
        syntax: &["name := RAWBLOCK i;"],
        options: &[option("i", "its size in bytes", "0 to 4294967295", "")],
        routines: &["PRAWBL"],
        example: "BUFFER := RAWBLOCK 4096;",
        ..PLAIN
    },
    CommandRow {
        name: "COPY",
        section: "B.3",
        summary: "A new list with some elements of another",
        syntax: &["name := COPY name1 [START =] i [,] [COUNT =] n;"],
        options: &[
            option("name1", "vector list, characters or labels", "", ""),
            option("START = i", "the first element", "1 and up", ""),
            option("COUNT = n", "how many", "0 and up", ""),
        ],
        inputs: &[input("as name1", "", "those of the copied kind")],
        routines: &["PCOPYV"],
        example: "HALF := COPY WHOLE START = 1 COUNT = 8;",
        ..PLAIN
    },
];
