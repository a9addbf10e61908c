//! The scenes that ship with the program.

/// A scene that ships with the program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// What it is called on the command line.
    pub name: &'static str,
    /// What it shows.
    pub summary: &'static str,
    /// Its script.
    pub text: &'static str,
}

/// The scenes that ship with the program; the first is the default.
pub const EMBEDDED: [Embedded; 21] = [
    Embedded {
        name: "teapot",
        summary: "the Utah teapot on a table top, beside a mirroring sphere and a box",
        text: include_str!("../../scenes/teapot.rhai"),
    },
    Embedded {
        name: "primitives",
        summary: "every primitive shape, in a row",
        text: include_str!("../../scenes/primitives.rhai"),
    },
    Embedded {
        name: "flange",
        summary: "a machine part of solids that are united, intersected and subtracted",
        text: include_str!("../../scenes/flange.rhai"),
    },
    Embedded {
        name: "chess",
        summary: "a game of chess: revolved profiles, swept polygons, and what is cut out of them",
        text: include_str!("../../scenes/chess.rhai"),
    },
    Embedded {
        name: "car",
        summary: "a car of sculptured surfaces that are joined smoothly, closed, cut and trimmed",
        text: include_str!("../../scenes/car.rhai"),
    },
    Embedded {
        name: "crystal",
        summary: "polyhedra between sharp and smooth, by subdivision with creases",
        text: include_str!("../../scenes/crystal.rhai"),
    },
    Embedded {
        name: "manifold",
        summary: "pipes with the accurate curves in which they meet, on saddles with rounded edges",
        text: include_str!("../../scenes/manifold.rhai"),
    },
    Embedded {
        name: "materials",
        summary: "metals, glass that disperses, varnish, plastic, glaze and plain colors under lights that have a size",
        text: include_str!("../../scenes/materials.rhai"),
    },
    Embedded {
        name: "textures",
        summary: "wood, marble, tiles and plaster: patterns through bodies and on surfaces, and reliefs",
        text: include_str!("../../scenes/textures.rhai"),
    },
    Embedded {
        name: "room",
        summary: "a living room with the sun in its window, a mirror and glass; three views",
        text: include_str!("../../scenes/room.rhai"),
    },
    Embedded {
        name: "cornell",
        summary: "the box of Cornell's Program of Computer Graphics, for light that goes from surface to surface",
        text: include_str!("../../scenes/cornell.rhai"),
    },
    Embedded {
        name: "caustic",
        summary: "a glass ball over a plane under a small lamp, which it gathers to a bright spot",
        text: include_str!("../../scenes/caustic.rhai"),
    },
    Embedded {
        name: "ring",
        summary: "a gold ring and a glass ball on paper, with the caustics of the textbooks",
        text: include_str!("../../scenes/ring.rhai"),
    },
    Embedded {
        name: "spectrum",
        summary: "a prism that paints a spectrum on a screen",
        text: include_str!("../../scenes/spectrum.rhai"),
    },
    Embedded {
        name: "mirror",
        summary: "a hand mirror that throws the sun on the wall of a room",
        text: include_str!("../../scenes/mirror.rhai"),
    },
    Embedded {
        name: "flowers",
        summary: "a vase of coloured glass in the evening sun",
        text: include_str!("../../scenes/flowers.rhai"),
    },
    Embedded {
        name: "pool",
        summary: "a swimming pool in the sun, with the net of light that its waves throw",
        text: include_str!("../../scenes/pool.rhai"),
    },
    Embedded {
        name: "afternoon",
        summary: "a room that the low sun lights through the window, and a glass of water on the table",
        text: include_str!("../../scenes/afternoon.rhai"),
    },
    Embedded {
        name: "vases",
        summary: "a copper vase in one light by three forms of Cook and Torrance's idea, side by side",
        text: include_str!("../../scenes/vases.rhai"),
    },
    Embedded {
        name: "corner",
        summary: "a corner of a room where every knob of the renderers has something to do, for studies",
        text: include_str!("../../scenes/corner.rhai"),
    },
    Embedded {
        name: "motion",
        summary: "a wheel that rolls, a ball that falls and a propeller, while the shutter is open",
        text: include_str!("../../scenes/motion.rhai"),
    },
];
