//! Rows of the attributes of what is below.

use crate::command::reference::row::{InputRow, OptionRow, input, option};

/// The input of switches.
pub(super) const SWITCH_INPUT: &[InputRow] = &[input("<1>", "Boolean", "TRUE for ON, FALSE for OFF")];

/// The option of switches.
pub(super) const ON_OFF: OptionRow = option("ON | OFF", "whether it holds below", "", "");

macro_rules! attribute_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

ATTRIBUTES {
    /// `SET COLOR hue, saturation`.
    SetColor {
        /// Degrees on the circle that starts at blue.
        hue: f64 = Real,
        /// 0 white, 1 pure.
        saturation: f64 = NextReal,
    } "SET COLOR" [Set Color] record 0x2b help {
        section: "B.7",
        confidence: Confirmed,
        summary: "Colour of what is below",
        syntax: &["name := SET COLOR h,s [APPLied TO name1];"],
        options: &[
            option("h", "hue: blue 0, red 120, yellow 180, green 240", "0 to 360", ""),
            option("s", "saturation: 0 white, 1 pure", "0 to 1", ""),
        ],
        inputs: &[input("<1>", "real", "hue"), input("<2>", "real", "saturation")],
        routines: &["PSECOL"],
        example: "PAINT := SET COLOR 120,1 APPLIED TO CAR;",
    };

    /// `SET COLOR BLENDING saturation`.
    SetColorBlending(saturation: f64 = Real) "SET COLOR BLENDING" [Set Color Blending] help {
        section: "B.7",
        summary: "Vector lists with COLOR show the hues of their vectors",
        syntax: &["name := SET COLOR BLENDING s [APPLied TO name1];"],
        options: &[option("s", "saturation", "0 to 1", "")],
        inputs: &[input("<1>", "real", "saturation")],
        routines: &["PSECBL"],
        example: "SET COLOR BLENDING 1 APPLIED TO MAP;",
        ..PLAIN
    };

    /// `SET INTENSITY ON|OFF imin:imax`.
    SetIntensity {
        /// OFF ignores the range.
        on: bool = SWITCH,
        /// Intensity at the back and at the front.
        range: [f64; 2] = Interval,
    } "SET INTENSITY" [Set Intensity] record 0x2c help {
        section: "B.7",
        confidence: Confirmed,
        summary: "Intensities instead of those of the viewport",
        syntax: &["name := SET INTENsity ON | OFF imin:imax [APPLied TO name1];"],
        options: &[
            option("ON | OFF", "OFF leaves those of the viewport", "", ""),
            option("imin:imax", "at the back and at the front", "0 to 1", ""),
        ],
        inputs: &[input("<1>", "Boolean", "ON or OFF"), input("<1>", "2D vector", "imin, imax")],
        routines: &["PSEINT"],
        example: "SET INTENSITY ON 0.5:1 APPLIED TO CAR;",
    };

    /// `SET CONTRAST TO c`, 0..=1.
    SetContrast(contrast: f64 = optional(Word::To, Real)) "SET CONTRAST" [Set Contrast] help {
        section: "B.7",
        summary: "Contrast of what is below",
        syntax: &["name := SET CONTRAST [TO] c [APPLied TO name1];"],
        options: &[option("c", "contrast", "0 to 1", "")],
        inputs: &[input("<1>", "real", "contrast")],
        routines: &["PSECON"],
        example: "SET CONTRAST TO 0.5 APPLIED TO CAR;",
        ..PLAIN
    };

    /// `SET CSM ON|OFF`: drive of the colour tube.
    SetCsm(on: bool = SWITCH) "SET CSM" [Set Csm] help {
        section: "B.7",
        summary: "Drive of the colour tube: slower and brighter",
        syntax: &["name := SET CSM ON | OFF [APPLied TO name1];"],
        options: &[ON_OFF],
        inputs: SWITCH_INPUT,
        routines: &["PSECSM"],
        example: "SET CSM ON APPLIED TO CAR;",
        ..PLAIN
    };

    /// `SET DEPTH_CLIPPING ON|OFF`.
    SetDepthClipping(on: bool = SWITCH) "SET DEPTH_CLIPPING" [Set DepthClipping] record 0x2d help {
        section: "B.7",
        confidence: Confirmed,
        summary: "Clips at the front and back boundary",
        syntax: &["name := SET DEPTH_CLipping ON | OFF [APPLied TO name1];"],
        options: &[option("ON | OFF", "whether it holds below", "", "OFF at the root")],
        inputs: SWITCH_INPUT,
        routines: &["PSEDCL"],
        example: "CLIP := SET DEPTH_CLIPPING ON APPLIED TO CAR;",
    };

    /// `SET DISPLAYS ALL ON|OFF`, `SET DISPLAY n, m... ON|OFF`.
    SetDisplays {
        /// The screens.
        scopes: Scopes = Screens,
        /// ON or OFF.
        on: bool = SWITCH,
    } "SET DISPLAYS" as "SET DISPLAY" [Set Displays] help {
        section: "B.7",
        summary: "On which screens the picture is shown",
        syntax: &[
            "name := SET DISPlays ALL ON | OFF [APPLied TO name1];",
            "name := SET DISPlays n [,m ...] ON | OFF [APPLied TO name1];",
        ],
        options: &[option("n", "number of a screen", "0 to 3", "")],
        inputs: SWITCH_INPUT,
        routines: &["PSEDAL", "PSEDOF"],
        example: "SET DISPLAY 0,2 OFF APPLIED TO CAR;",
        ..PLAIN
    };

    /// `SET CHARACTERS WORLD_ORIENTED|SCREEN_ORIENTED[/FIXED]`.
    SetCharacters(orientation: CharacterOrientation = Orientation) "SET CHARACTERS" [Set Characters] help {
        section: "B.7",
        summary: "How characters stand",
        syntax: &["name := SET CHARacters WORLD_oriented | SCREEN_oriented [/FIXED] [APPLied TO name1];"],
        options: &[
            option("WORLD_oriented", "transformed like vectors", "", "at the root"),
            option("SCREEN_oriented", "not rotated, but scaled", "", ""),
            option("/FIXED", "not scaled either, and at full intensity", "", "off"),
        ],
        routines: &["PSECHW", "PSECHS", "PSECHF"],
        example: "SET CHARACTERS SCREEN_ORIENTED/FIXED APPLIED TO TITLE;",
        ..PLAIN
    };

    /// `SET PICKING ON|OFF`.
    SetPicking(on: bool = PICKING) "SET PICKING" [Set Picking] help {
        section: "B.7",
        confidence: Confirmed,
        summary: "Whether what is below can be picked",
        syntax: &["name := SET PICKing ON | OFF [APPLied TO name1];"],
        options: &[option("ON | OFF", "whether it holds below", "", "OFF at the root")],
        inputs: SWITCH_INPUT,
        routines: &["PSEPOF"],
        example: "PICKABLE := SET PICKING ON APPLIED TO MENU;",
    };

    /// `SET PICKING IDENTIFIER = id`.
    SetPickingIdentifier(id: Name = equal(ObjectName)) "SET PICKING IDENTIFIER" [Set Picking Identifier] help {
        section: "B.7",
        confidence: Confirmed,
        summary: "A name that a pick of what is below reports",
        syntax: &["name := SET PICKing IDentifier = id [APPLied TO name1];"],
        routines: &["PSEPID"],
        example: "SET PICKING IDENTIFIER = OPEN_ITEM APPLIED TO ITEM;",
        ..PLAIN
    };

    /// `SET PICKING LOCATION = x,y sx,sy`.
    SetPickingLocation {
        /// Centre of the pick box on the screen, -1..=1.
        center: DVec2 = equal(Vector2),
        /// Half its size.
        size: Option<DVec2> = OptionalNumber(Vector2),
    } "SET PICKING LOCATION" [Set Picking Location] help {
        section: "B.7",
        summary: "The pick box",
        syntax: &["name := SET PICKing LOCation = x,y [sx,sy] [APPLied TO name1];"],
        options: &[
            option("x,y", "its centre on the screen", "-1 to 1", ""),
            option("sx,sy", "half its size", "", "as it is"),
        ],
        inputs: &[input("<1>", "2D vector", "centre"), input("<2>", "2D vector", "half the size")],
        routines: &["PSEPLO"],
        example: "PICK_BOX := SET PICKING LOCATION = 0,0 0.01,0.01;",
        ..PLAIN
    };

    /// `SET LEVEL_OF_DETAIL TO n`, 0..=32767.
    SetLevelOfDetail(level: u16 = optional(Word::To, LEVEL)) "SET LEVEL_OF_DETAIL" [Set LevelOfDetail] help {
        section: "B.7",
        summary: "The level that IF LEVEL_OF_DETAIL compares",
        syntax: &["name := SET LEVel_of_detail [TO] n [APPLied TO name1];"],
        options: &[option("n", "the level", "0 to 32767", "0 at the root")],
        inputs: &[input("<1>", "integer", "the level")],
        routines: &["PSELOD"],
        example: "DETAIL := SET LEVEL_OF_DETAIL TO 3 APPLIED TO CAR;",
        ..PLAIN
    };

    /// `INCREMENT LEVEL_OF_DETAIL`.
    IncrementLevelOfDetail "INCREMENT LEVEL_OF_DETAIL" [Increment LevelOfDetail] help {
        section: "B.7",
        summary: "One level more below",
        syntax: &["name := INCRement LEVel_of_detail [APPLied TO name1];"],
        routines: &["PINCLO"],
        example: "INCREMENT LEVEL_OF_DETAIL APPLIED TO CAR;",
        ..PLAIN
    };

    /// `DECREMENT LEVEL_OF_DETAIL`.
    DecrementLevelOfDetail "DECREMENT LEVEL_OF_DETAIL" [Decrement LevelOfDetail] help {
        section: "B.7",
        summary: "One level less below",
        syntax: &["name := DECRement LEVel_of_detail [APPLied TO name1];"],
        routines: &["PDECLO"],
        example: "DECREMENT LEVEL_OF_DETAIL APPLIED TO CAR;",
        ..PLAIN
    };

    /// `SET CONDITIONAL_BIT n ON|OFF`.
    SetConditionalBit {
        /// 0..=14.
        bit: u8 = BIT,
        /// ON or OFF.
        on: bool = SWITCH,
    } "SET CONDITIONAL_BIT" [Set ConditionalBit] help {
        section: "B.7",
        confidence: Confirmed,
        summary: "A bit that IF CONDITIONAL_BIT looks at",
        syntax: &["name := SET CONDitional_bit n ON | OFF [APPLied TO name1];"],
        options: &[option("n", "which bit", "0 to 14", ""), ON_OFF],
        inputs: SWITCH_INPUT,
        routines: &["PSEBIT"],
        example: "VISIBLE := SET CONDITIONAL_BIT 2 ON APPLIED TO CAR;",
    };

    /// `SET RATE on off ON|OFF delay`.
    SetRate(rate: Rate = PhaseRate) "SET RATE" [Set Rate] help {
        section: "B.7",
        summary: "Phases that IF PHASE looks at",
        syntax: &[
            "name := SET RATE on off [ON | OFF] [delay] [APPLied TO name1];",
            "name := SET RATE EXTernal [APPLied TO name1];",
        ],
        options: &[
            option("on, off", "refresh frames of the two phases", "0 and up", ""),
            option("ON | OFF", "the phase at the beginning", "", "ON"),
            option("delay", "refresh frames before the first phase", "0 and up", "0"),
            option("EXTernal", "the phase comes as Booleans", "", ""),
        ],
        inputs: &[
            input("<1>", "integer", "frames on; of EXTERNAL, a Boolean: the phase"),
            input("<2>", "integer", "frames off"),
            input("<3>", "Boolean", "the phase at the beginning"),
            input("<4>", "integer", "delay"),
        ],
        routines: &["PSER", "PSEREX"],
        example: "BLINKER := SET RATE 20 10 ON 5 APPLIED TO LAMP;\nDOOR := SET RATE EXTERNAL APPLIED TO LAMP;",
        ..PLAIN
    };

    /// `SET RATE EXTERNAL`.
    SetRateExternal "SET RATE" as "SET RATE EXTERNAL" [Set Rate External];

    /// `SET BLINKING ON|OFF`. Of later models.
    SetBlinking(on: bool = SWITCH) "SET BLINKING" [Set Blinking] help {
        section: "B.7",
        summary: "Makes what is below blink; later models",
        syntax: &["name := SET BLINKing ON | OFF [APPLied TO name1];"],
        options: &[ON_OFF],
        inputs: SWITCH_INPUT,
        example: "SET BLINKING ON APPLIED TO LAMP;",
        ..PLAIN
    };

    /// `SET BLINK RATE n`, frames of a phase. Of later models.
    SetBlinkRate(frames: u32 = COUNT) "SET BLINK RATE" [Set Blinking Rate] help {
        section: "B.7",
        summary: "How fast SET BLINKING blinks; later models",
        syntax: &["name := SET BLINKing RATE n [APPLied TO name1];"],
        options: &[option("n", "refresh frames of a phase", "0 and up", "")],
        inputs: &[input("<1>", "integer", "frames")],
        example: "SET BLINK RATE 30 APPLIED TO LAMP;",
        ..PLAIN
    };

    /// `SET PLOTTER ON|OFF`.
    SetPlotter(on: bool = SWITCH) "SET PLOTTER" [Set Plotter] help {
        section: "B.7",
        confidence: Uncertain,
        summary: "Marks data for the plotter in what WRITEBACK reads",
        syntax: &["name := SET PLOTter ON | OFF [APPLied TO name1];"],
        options: &[ON_OFF],
        inputs: SWITCH_INPUT,
        routines: &["PSEPLT"],
        example: "SET PLOTTER ON APPLIED TO CAR;",
    };

    /// `SET PRIORITY n`. Of later models.
    SetPriority(priority: i32 = SIGNED) "SET PRIORITY" [Set Priority] help {
        section: "B.7",
        confidence: Uncertain,
        summary: "Order of drawing; later models",
        syntax: &["name := SET PRIORity n [APPLied TO name1];"],
        options: &[option("n", "the priority", "32 bits with sign", "")],
        example: "SET PRIORITY 2 APPLIED TO CAR;",
        ..PLAIN
    };

    /// `SET LINE_TEXTURE AROUND_CORNERS n`. Of later models.
    SetLineTexture {
        /// Whether the texture goes on from one vector to the next.
        around_corners: bool = Flag(Word::AroundCorners),
        /// The texture.
        texture: u32 = COUNT,
    } "SET LINE_TEXTURE" [Set LineTexture] help {
        section: "B.7",
        confidence: Uncertain,
        summary: "Dashes made by the line generator; later models",
        syntax: &["name := SET LINE_texture [AROUND_corners] n [APPLied TO name1];"],
        options: &[
            option("AROUND_corners", "goes on from one vector to the next", "", "begins anew"),
            option("n", "which texture", "0 and up", ""),
        ],
        inputs: &[input("<1>", "integer", "the texture")],
        example: "SET LINE_TEXTURE AROUND_CORNERS 3 APPLIED TO CAR;",
        ..PLAIN
    };
}
    } };
}

pub(super) use attribute_rows;
