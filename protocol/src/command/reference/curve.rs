//! Rows of the curves: B-splines and polynomials.

use super::row::{CommandRow, PLAIN, option};

pub(super) const ROWS: &[CommandRow] = &[
    CommandRow {
        name: "BSPLINE",
        section: "B.4",
        summary: "A B-spline curve as a vector list, also rational",
        syntax: &[
            "name := [RATIONAL] BSpline ORDER = k [OPEN | CLOSED] [NONPERIODIC | PERIODIC] [N = n]",
            "        [VERTICES =] x,y[,z][,w] ... [KNOTS = t1, t2, ...] CHORDS = q;",
        ],
        options: &[
            option("RATIONAL", "the vertices have a weight w", "", "off"),
            option("ORDER = k", "degree + 1", "1 to 10", ""),
            option("CLOSED", "the last vertex joins the first", "", "OPEN"),
            option("PERIODIC", "uniform knots; else end knots are repeated", "", "that of CLOSED, not of OPEN"),
            option("N = n", "estimate of the number of vertices", "0 and up", "the count"),
            option("VERTICES", "the commas in the first say whether they have a z", "up to 65536", ""),
            option("KNOTS", "increasing parameters", "up to 65536", "by PERIODIC"),
            option("CHORDS = q", "number of straight pieces", "1 to 1048576", ""),
        ],
        routines: &["PBSPL", "PRBSPL"],
        example: "RING := BSPLINE ORDER=4 CLOSED VERTICES = 1,0  0,1  -1,0  0,-1  CHORDS=40;",
        ..PLAIN
    },
    CommandRow {
        name: "POLYNOMIAL",
        section: "B.4",
        summary: "A polynomial curve over 0 to 1 as a vector list, also rational",
        syntax: &["name := [RATIONAL] POLYnomial [ORDER = i] COEFFicients = x,y[,z][,w] ... CHORDS = q;"],
        options: &[
            option("RATIONAL", "x, y and z are divided by the polynomial w", "", "off"),
            option("ORDER = i", "degree: one less than the number of rows", "0 to 10", "by the rows"),
            option("COEFFicients", "a row for each power, the highest first", "1 to 11 rows", ""),
            option("CHORDS = q", "number of straight pieces", "1 to 1048576", ""),
        ],
        routines: &["PPOLY", "PRPOLY"],
        example: "ARC := RATIONAL POLYNOMIAL ORDER=2 COEFFICIENTS = -1,0,1  0,2,0  1,0,1  CHORDS=20;",
        ..PLAIN
    },
];
