//! Commands to the system.

use super::row::{CommandRow, Confidence::*, PLAIN, option};

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "INITIALIZE",
        section: "B.11",
        confidence: Confirmed,
        summary: "Removes user names, connections and the display list; the system stays",
        syntax: &["INITialize [CONNections | DISPlays | NAMES];"],
        options: &[option("CONNections | ...", "only these", "", "all three")],
        routines: &["PINIT", "PINITC", "PINITD", "PINITN"],
        example: "INITIALIZE;\nINITIALIZE DISPLAYS;",
        ..PLAIN
    },
    CommandRow {
        name: "COMMAND STATUS",
        section: "B.11",
        summary: "Reports what is begun and not ended",
        syntax: &["COMMAND STATus;"],
        example: "COMMAND STATUS;",
        ..PLAIN
    },
    CommandRow {
        name: "!RESET",
        section: "B.11",
        confidence: Uncertain,
        summary: "Gives up what is begun and not ended, also a text or comment if it begins a line",
        syntax: &["!RESET;"],
        example: "!RESET;",
        ..PLAIN
    },
    CommandRow {
        name: "REBOOT",
        section: "B.11",
        summary: "Starts the machine anew",
        syntax: &["REBOOT password;"],
        example: "REBOOT SESAME;",
        ..PLAIN
    },
    CommandRow {
        name: "CONFIGURE",
        section: "B.11",
        summary: "System functions may be changed up to FINISH CONFIGURATION",
        syntax: &["CONFIGURE password;", "FINISH CONFIGURATION;"],
        example: "CONFIGURE SESAME;\nFINISH CONFIGURATION;",
        ..PLAIN
    },
    CommandRow {
        name: "SETUP PASSWORD",
        section: "B.11",
        summary: "Sets the password of REBOOT and CONFIGURE",
        syntax: &["SETUP PASSWORD password;"],
        example: "SETUP PASSWORD SESAME;",
        ..PLAIN
    },
    CommandRow {
        name: "SETUP INTERFACE",
        section: "B.11",
        summary: "Parameters of a serial port",
        syntax: &["SETUP INTERFACE port/option[=value] ...;"],
        options: &[option("option", "such as SPEED, BITS, STOP, PARITY, XON", "", "as it is")],
        example: "SETUP INTERFACE PORT1/SPEED=9600/PARITY=EVEN;",
        ..PLAIN
    },
    CommandRow {
        name: "SHOW INTERFACE",
        section: "B.11",
        summary: "Reports the parameters of a serial port",
        syntax: &["SHOW INTERFACE port;"],
        example: "SHOW INTERFACE PORT1;",
        ..PLAIN
    },
    CommandRow {
        name: "SHOW INTERRUPTS",
        section: "B.11",
        confidence: Uncertain,
        summary: "Diagnosis",
        syntax: &["SHOW INTERRUPTS;"],
        example: "SHOW INTERRUPTS;",
        ..PLAIN
    },
    CommandRow {
        name: "GIVE_UP_CPU",
        section: "B.11",
        confidence: Uncertain,
        summary: "Lets other processes run during a long file of commands",
        syntax: &["GIVE_UP_CPU;"],
        example: "GIVE_UP_CPU;",
        ..PLAIN
    },
    CommandRow {
        name: "ALLOW_VECNORM",
        section: "B.11",
        confidence: Uncertain,
        summary: "Permits an exponent for each vector where that is not the rule; later models",
        syntax: &["ALLOW_VECNORM;"],
        example: "ALLOW_VECNORM;",
        ..PLAIN
    },
];
