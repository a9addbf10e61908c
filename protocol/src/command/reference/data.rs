//! Vectors, polygons and what they look like.

use super::row::{CommandRow, Confidence::*, InputRow, PLAIN, input, option};

/// Inputs of a vector list.
const VECTORS: &[InputRow] = &[
    input("<i>", "2D, 3D or 4D vector", "replaces vector i; the fourth component is the intensity"),
    input("<i>", "Boolean", "TRUE makes vector i a line, FALSE a position"),
    input("<last>", "vector, Boolean", "the same for the last vector"),
    input("<append>", "vector", "adds a vector, as a line"),
    input("<delete>", "integer", "removes so many vectors from the end"),
    input("<clear>", "any", "removes all"),
];

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "VECTOR_LIST",
        section: "B.4",
        confidence: Confirmed,
        summary: "Lines, separate lines or dots",
        syntax: &[
            "name := VECtor_list [BLOCK_normalized] [COLOR]",
            "        [CONNected_lines | SEParate_lines | DOTs | ITEMized | TABulated]",
            "        [Y = y [DY = dy] [Z = z [DZ = dz]]] [INTERNAL_units] [N = n]",
            "        vector ...;",
            "vector: [P | L] x [,y [,z]] [I = i | H = hue | T = t]",
        ],
        options: &[
            option("BLOCK_normalized", "one exponent for all vectors", "", "one for each"),
            option("COLOR", "each vector has a hue H; needs SET COLOR BLENDING", "", "off"),
            option("CONNected_lines", "the first vector is a move, the others are lines", "", "this class"),
            option("SEParate_lines", "pairs: odd vectors are moves, even ones lines", "", ""),
            option("DOTs", "a dot at each point", "", ""),
            option("ITEMized", "each vector says P (position) or L (line)", "", ""),
            option("TABulated", "itemized, with an index T into a table; later models", "", ""),
            option("Y = y DY = dy", "vector k has the y component y + (k-1) dy", "", "none; dy 0"),
            option("Z = z DZ = dz", "vector k has the z component z + (k-1) dz", "", "none; dz 0"),
            option("INTERNAL_units", "numbers are those of the machine; itemized without a class", "", "off"),
            option("N = n", "estimate of the count", "0 and up", "the count"),
            option("I = i", "intensity of the end of the vector", "0 to 1; more is clamped", "1"),
            option("H = hue", "hue of the end of the vector, degrees", "0 to 720", "0"),
            option("T = t", "index into a table", "", "0"),
        ],
        inputs: VECTORS,
        routines: &["PVCBEG", "PVCMAX", "PVCLIS", "PVCEND"],
        example: "SQUARE := VECTOR_LIST ITEMIZED N = 5\n  P 0,0  L 1,0  L 1,1 I=0.5  L 0,1  L 0,0;",
    },
    CommandRow {
        name: "POLYGON",
        section: "B.4",
        confidence: Confirmed,
        summary: "Surfaces and solids of polygons",
        syntax: &[
            "name := [WITH [ATTRibutes] attr] [[WITH] OUTLINE h] POLYGon [COPLANar] vertex vertex vertex ...",
            "        [[WITH [ATTRibutes] attr] [[WITH] OUTLINE h] POLYGon [COPLANar] vertex ...] ...;",
            "vertex: [S] x,y,z [N nx,ny,nz] [C h[,s[,i]] [AND h[,s[,i]]]]",
        ],
        options: &[
            option("attr", "an ATTRIBUTES object, for this polygon and those after it", "", "white"),
            option("OUTLINE h", "hue of the edges, for this polygon and those after it", "", "the colour set"),
            option("COPLANar", "belongs to the polygon before: a hole or a further outline", "", "off"),
            option("vertex", "clockwise seen from outside; the closing edge is implied", "3 to 250", ""),
            option("S", "the edge that ends here is soft: smoothed in shading", "", "hard"),
            option("N nx,ny,nz", "normal; for all vertices of a polygon or for none", "", "computed"),
            option(
                "C h,s,i",
                "color there, AND that of the reverse; for all vertices of a polygon or for none",
                "0 to 360, 0 to 1, 0 to 1",
                "that of attr; s and i 1",
            ),
        ],
        routines: &["PPLYGB", "PPLYGA", "PPLYGO", "PPLYGL", "PPLYGE", "PPLYGR", "PPLYGH"],
        example: "PLATE := WITH ATTRIBUTES STEEL POLYGON 0,0,0  0,1,0  1,1,0  1,0,0\n  \
                  POLYGON COPLANAR 0.4,0.4,0  0.6,0.4,0  0.5,0.6,0;",
        ..PLAIN
    },
    CommandRow {
        name: "ATTRIBUTES",
        section: "B.4",
        confidence: Confirmed,
        summary: "What the sides of polygons look like when they are shaded",
        syntax: &[
            "name := ATTRibutes [COLOR h [,s [,i]]] [DIFFUSE d] [SPECular s] [OPAQUE t]",
            "        [AND [COLOR h [,s [,i]]] [DIFFUSE d] [SPECular s] [OPAQUE t]];",
        ],
        options: &[
            option(
                "COLOR h,s,i",
                "hue in degrees, saturation, intensity",
                "0 to 360, 0 to 1, 0 to 1",
                "0,0,1; s and i 1",
            ),
            option("DIFFUSE d", "share of diffuse reflection", "0 to 1", "0.75"),
            option("SPECular s", "concentration of the highlight", "0 to 10", "4"),
            option("OPAQUE t", "1 opaque, 0 transparent; no effect on this model", "0 to 1", "1"),
            option("AND", "what follows is for the reverse sides", "", "like the front"),
        ],
        routines: &["PATTR", "PATTR2"],
        example: "STEEL := ATTRIBUTES COLOR 300,0.1 SPECULAR 8 AND COLOR 120;",
        ..PLAIN
    },
    CommandRow {
        name: "ILLUMINATION",
        section: "B.4",
        confidence: Confirmed,
        summary: "A light at infinity; stands in a structure like data",
        syntax: &["name := ILLUMination x,y,z [COLOR h [,s [,i]]] [AMBIENT a];"],
        options: &[
            option("x,y,z", "where the light goes: 0,0,1 comes from behind the viewer", "", ""),
            option("COLOR h,s,i", "as in ATTRIBUTES", "", "0,0,1"),
            option("AMBIENT a", "its share in the ambient light", "0 to 1", "1"),
        ],
        inputs: &[
            input("<1>", "3D vector", "direction"),
            input("<2>", "3D vector", "hue, saturation, intensity"),
            input("<3>", "real", "ambient share"),
        ],
        routines: &["PILLUM"],
        example: "SUN := ILLUMINATION -1,-1,1 COLOR 180,0.2,0.9 AMBIENT 0.3;",
    },
    CommandRow {
        name: "PATTERN",
        section: "B.4",
        summary: "Lengths of dashes and gaps, for PATTERN WITH",
        syntax: &["name := PATtern i [i ...] [AROUND_corners] [MATCH | NOMATCH] LENgth r;"],
        options: &[
            option("i", "lengths of dashes and gaps in turn, relative to each other", "1 to 32 of them", ""),
            option("AROUND_corners", "goes on from one vector to the next", "", "begins anew"),
            option("MATCH", "the length is adjusted to come out whole", "", "MATCH"),
            option("LENgth r", "length of one repetition in the coordinates of the data", "", ""),
        ],
        routines: &["PDEFPA"],
        example: "DASHED := PATTERN 3 1 AROUND_CORNERS LENGTH 0.2;",
        ..PLAIN
    },
    CommandRow {
        name: "PATTERN WITH",
        section: "B.4",
        confidence: Confirmed,
        summary: "Replaces a vector list or curve by its dashed form",
        syntax: &["PATtern name1 WITH pattern;"],
        routines: &["PPATWI"],
        example: "PATTERN CURVE WITH DASHED;",
        ..PLAIN
    },
    CommandRow {
        name: "ERASE PATTERN",
        section: "B.4",
        summary: "Restores a list that PATTERN WITH made dashed",
        syntax: &["ERASE PATtern FROM name1;"],
        routines: &["PERAPA"],
        example: "ERASE PATTERN FROM CURVE;",
        ..PLAIN
    },
];
