//! The classes of the corpus, and how their cases are made.

mod shapes;
mod pairs;
mod surfaces;
mod trees;

use super::CorpusCase;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

/// A kind of difficulty.
pub struct Class {
    /// What it is called.
    pub name: &'static str,
    /// Number of its cases.
    pub cases: u32,
    make: fn(&mut Pcg64Mcg) -> CorpusCase,
}

impl Class {
    /// A case; always the same for a number.
    pub fn case(&self, number: u32) -> CorpusCase {
        (self.make)(&mut Pcg64Mcg::seed_from_u64(u64::from(number)))
    }
}

/// All classes.
pub const CLASSES: &[Class] = &[
    Class { name: "coincident faces", cases: 100, make: pairs::coincident },
    Class { name: "nearly coincident, 1e-3 to 1e-15", cases: 80, make: pairs::nearly_coincident },
    Class { name: "cubes turned by 1e-3 to 1e-15", cases: 100, make: pairs::tiny_turn },
    Class { name: "spheres turned by 1e-3 to 1e-15", cases: 60, make: pairs::spheres_turned },
    Class { name: "bunnies turned by 1e-1 to 1e-15", cases: 40, make: pairs::bunnies_turned },
    Class { name: "slivers", cases: 80, make: pairs::slivers },
    Class { name: "needles", cases: 80, make: pairs::needles },
    Class { name: "tangent spheres", cases: 80, make: pairs::tangent_spheres },
    Class { name: "sizes 1e-6 to 1e6 in one model", cases: 80, make: pairs::sizes },
    Class { name: "1e7 from the origin", cases: 80, make: pairs::far },
    Class { name: "nested shells", cases: 60, make: pairs::nested },
    Class { name: "touching themselves", cases: 60, make: pairs::self_touching },
    Class { name: "crossing themselves", cases: 80, make: surfaces::self_crossing },
    Class { name: "thin bodies inside out", cases: 1000, make: surfaces::slivers },
    Class { name: "empty results", cases: 60, make: pairs::empty },
    Class { name: "results as operands", cases: 80, make: trees::chain },
    Class { name: "boxes of one lattice, turned", cases: 4000, make: trees::lattice },
    Class { name: "nested trees", cases: 1500, make: trees::nested },
    Class { name: "thin plates", cases: 1500, make: trees::plates },
    Class { name: "scanned meshes", cases: 500, make: trees::scanned },
    Class { name: "results into results, ten deep", cases: 500, make: trees::deep },
    Class { name: "results in single precision", cases: 1000, make: trees::single },
];
