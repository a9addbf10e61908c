//! Rows of the views.

use crate::command::reference::row::{InputRow, OptionRow, input, option};

/// The input of the views.
pub(super) const MATRIX_4: &[InputRow] =
    &[input("<1>", "4x4 matrix", "replaces the view, as F:WINDOW and F:FOV make it")];

/// Boundaries in depth.
pub(super) const DEPTH: OptionRow = option("FRONT, BACK", "nearest and farthest z", "", "1E-15 and 1E15");

/// The input of viewports.
pub(super) const LIMITS: &[InputRow] = &[
    input("<1>", "3x3 matrix", "rows hmin,hmax,0 and vmin,vmax,0 and imin,imax,0"),
    input("<1>", "2x2 matrix", "rows hmin,hmax and vmin,vmax"),
];

macro_rules! viewing_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

VIEWING {
    /// `WINDOW X = a:b Y = c:d FRONT = f BACK = b`.
    Window {
        /// Left and right.
        x: [f64; 2] = after(Word::X, equal(Interval)),
        /// Bottom and top.
        y: [f64; 2] = after(Word::Y, equal(Interval)),
        /// Front and back; a wide default if not given.
        boundaries: Option<Boundaries> = DepthBoundaries,
    } "WINDOW" [Window] record 0x28 help {
        section: "B.6",
        confidence: Confirmed,
        summary: "An orthographic view of a box",
        syntax: &[
            "name := WINDOW X = xmin:xmax Y = ymin:ymax",
            "        [FRONT [BOUNDary] = zmin BACK [BOUNDary] = zmax] [APPLied TO name1];",
        ],
        options: &[DEPTH],
        inputs: MATRIX_4,
        routines: &["PWINDO"],
        example: "WINDOW X = -10:10 Y = -10:10 FRONT = 0 BACK = 20 APPLIED TO CAR;",
    };

    /// `FIELD_OF_VIEW angle FRONT = f BACK = b`.
    FieldOfView {
        /// Full angle in degrees.
        angle: f64 = Real,
        /// Front and back; a wide default if not given.
        boundaries: Option<Boundaries> = DepthBoundaries,
    } "FIELD_OF_VIEW" [FieldOfView] record 0x29 help {
        section: "B.6",
        confidence: Confirmed,
        summary: "A perspective view from the eye of LOOK",
        syntax: &["name := FIELD_OF_VIEW angle [FRONT [BOUNDary] = zmin BACK [BOUNDary] = zmax] [APPLied TO name1];"],
        options: &[option("angle", "full angle in degrees", "above 0, below 180", ""), DEPTH],
        inputs: MATRIX_4,
        routines: &["PFOV"],
        example: "VIEW := FIELD_OF_VIEW 30 FRONT BOUNDARY = 6 BACK BOUNDARY = 14 APPLIED TO CAR;",
    };

    /// `EYE BACK z LEFT|RIGHT x UP|DOWN y FROM SCREEN AREA w WIDE FRONT = f BACK = b`.
    Eye {
        /// Distance of the eye before the screen.
        back: f64 = after(Word::Back, Real),
        /// Offset of the eye from the middle of the screen, positive to the right.
        right: f64 = SideOffset { sides: &[Word::Left, Word::Right], negative: Word::Left },
        /// Offset upward.
        up: f64 = SideOffset { sides: &[Word::Up, Word::Down], negative: Word::Down },
        /// Width of the screen.
        width: f64 = ScreenWidth,
        /// Front and back; a wide default if not given.
        boundaries: Option<Boundaries> = DepthBoundaries,
    } "EYE" [Eye] help {
        section: "B.6",
        confidence: Confirmed,
        summary: "An oblique perspective view through a screen of a given width",
        syntax: &[
            "name := EYE BACK z [LEFT | RIGHT x] [UP | DOWN y] FROM SCREEN AREA w WIDE",
            "        [FRONT [BOUNDary] = zmin BACK [BOUNDary] = zmax] [APPLied TO name1];",
        ],
        options: &[
            option("BACK z", "distance of the eye from the screen", "", ""),
            option("LEFT, RIGHT x", "offset of the eye from the middle of the screen", "", "0"),
            option("UP, DOWN y", "offset of the eye from the middle of the screen", "", "0"),
            option("w", "width of the screen", "", ""),
            DEPTH,
        ],
        inputs: MATRIX_4,
        routines: &["PEYEBK"],
        example: "LEFT_EYE := EYE BACK 30 LEFT 1.5 FROM SCREEN AREA 12 WIDE FRONT = 20 BACK = 50 APPLIED TO CAR;",
    };

    /// `VIEWPORT HORIZONTAL = a:b VERTICAL = c:d INTENSITY = e:f`.
    Viewport {
        /// Left and right, -1..=1 of the enclosing viewport.
        horizontal: [f64; 2] = after(Word::Horizontal, equal(Interval)),
        /// Bottom and top.
        vertical: [f64; 2] = after(Word::Vertical, equal(Interval)),
        /// Intensity at the back and at the front, 0..=1; that of the enclosing viewport if not given.
        intensity: Option<[f64; 2]> = OptionalAfter(Word::Intensity, equal(Interval)),
    } "VIEWPORT" [Viewport] record 0x2a help {
        section: "B.6",
        confidence: Confirmed,
        summary: "The part of the enclosing viewport where the picture goes",
        syntax: &[
            "name := VIEWport HORizontal = hmin:hmax VERTical = vmin:vmax",
            "        [INTENsity = imin:imax] [APPLied TO name1];",
        ],
        options: &[
            option("HORizontal", "left and right of the enclosing viewport", "-1 to 1", ""),
            option("VERTical", "bottom and top of the enclosing viewport", "-1 to 1", ""),
            option("INTENsity", "at the back and at the front: depth cueing", "0 to 1", "that outside; 0:1"),
        ],
        inputs: LIMITS,
        routines: &["PVIEWP"],
        example: "CORNER := VIEWPORT HORIZONTAL = 0:1 VERTICAL = 0:1 INTENSITY = 0.5:1 APPLIED TO CAR;",
    };

    /// `LOAD VIEWPORT ...`: replaces the enclosing viewport. Of later models.
    LoadViewport {
        /// Left and right on the screen, -1..=1.
        horizontal: [f64; 2] = after(Word::Horizontal, equal(Interval)),
        /// Bottom and top.
        vertical: [f64; 2] = after(Word::Vertical, equal(Interval)),
        /// Intensity at the back and at the front.
        intensity: Option<[f64; 2]> = OptionalAfter(Word::Intensity, equal(Interval)),
    } "LOAD VIEWPORT" [Load Viewport] help {
        section: "B.6",
        summary: "Replaces the enclosing viewport; later models",
        syntax: &[
            "name := LOAD VIEWport HORizontal = hmin:hmax VERTical = vmin:vmax [INTENsity = imin:imax] [APPLied TO name1];",
        ],
        options: &[
            option("HORizontal", "left and right on the screen", "-1 to 1", ""),
            option("VERTical", "bottom and top on the screen", "-1 to 1", ""),
            option("INTENsity", "at the back and at the front", "0 to 1", "that outside"),
        ],
        inputs: LIMITS,
        example: "LOAD VIEWPORT HORIZONTAL = -1:0 VERTICAL = -1:0 APPLIED TO CAR;",
        ..PLAIN
    };
}
    } };
}

pub(super) use viewing_rows;
