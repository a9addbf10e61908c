//! Figures of "The Algorithmic Beauty of Plants" as grammars.

/// A figure of Prusinkiewicz and Lindenmayer 1990, "The Algorithmic Beauty of Plants".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AbopFigure {
    /// Name of the grammar, of small letters and `_`.
    pub name: &'static str,
    /// Where it stands in the book.
    pub place: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// What is to be seen, in a line.
    pub description: &'static str,
    /// The text of its grammar, for [`LSystem::parse`](super::LSystem::parse).
    pub grammar: &'static str,
}

/// The row of a figure, with its grammar beside the sources.
macro_rules! figure {
    ($name:literal, $place:literal, $title:literal, $description:literal) => {
        AbopFigure {
            name: $name,
            place: $place,
            title: $title,
            description: $description,
            grammar: include_str!(concat!("../../../grammars/", $name, ".lsys")),
        }
    };
}

/// The figures, in the order of the book.
pub const ABOP_FIGURES: &[AbopFigure] = &[
    figure!(
        "anabaena_lineage",
        "figure 1.4",
        "Anabaena catenula, lineage",
        "A filament of long and short cells of two polarities; the numbers of cells are those of Fibonacci."
    ),
    figure!("koch_island", "figure 1.6", "Quadratic Koch island", "A closed curve around an island, of dimension 3/2."),
    figure!(
        "koch_island_wide",
        "figure 1.7 a",
        "Quadratic Koch island of eighteen edges",
        "A closed curve around an island, of dimension log 18 / log 6."
    ),
    figure!(
        "snowflake_quadratic",
        "figure 1.7 b",
        "Quadratic snowflake curve",
        "An open curve with right angles over a segment, of dimension log 5 / log 3."
    ),
    figure!(
        "islands_and_lakes",
        "figure 1.8",
        "Islands and lakes",
        "Many closed curves at once: moves set islands and lakes apart from each other."
    ),
    figure!("koch_variant_a", "figure 1.9 a", "Koch curve, variant a", "Rings of islands along a ring of rings."),
    figure!("koch_variant_b", "figure 1.9 b", "Koch curve, variant b", "A carpet of squares."),
    figure!("koch_variant_c", "figure 1.9 c", "Koch curve, variant c", "Bricks over a square, not all closed."),
    figure!("koch_variant_d", "figure 1.9 d", "Koch curve, variant d", "Crystals that grow into a square."),
    figure!("koch_variant_e", "figure 1.9 e", "Koch curve, variant e", "A filled island with a fractal border."),
    figure!("koch_variant_f", "figure 1.9 f", "Koch curve, variant f", "An island of crossing squares."),
    figure!(
        "dragon",
        "figure 1.10 a",
        "Dragon curve",
        "A curve that touches itself in corners and passes no edge twice."
    ),
    figure!(
        "sierpinski",
        "figure 1.10 b",
        "Sierpinski gasket",
        "One curve whose limit is the triangle without its middle triangles, of dimension log 3 / log 2."
    ),
    figure!(
        "gosper_hexagonal",
        "figure 1.11 a",
        "Hexagonal Gosper curve",
        "A curve that fills an island of hexagons and never touches itself."
    ),
    figure!(
        "gosper_quadratic",
        "figure 1.11 b",
        "Quadratic Gosper curve",
        "A curve that fills a square: one corner in each cell."
    ),
    figure!(
        "hilbert",
        "section 1.4",
        "Hilbert curve",
        "Node rewriting: a curve through the middles of all cells of a square, of side 2 to the n."
    ),
    figure!(
        "peano",
        "section 1.4",
        "Peano curve",
        "Node rewriting: a curve through the middles of all cells of a square, of side 3 to the n."
    ),
    figure!(
        "hilbert_in_space",
        "figure 1.19",
        "Hilbert curve in space",
        "A curve through the middles of all cells of a cube."
    ),
    figure!("branching_a", "figure 1.24 a", "Branching plant a", "A stem with whorls of branches to both sides."),
    figure!("branching_b", "figure 1.24 b", "Branching plant b", "A dense plant that leans to one side."),
    figure!("branching_c", "figure 1.24 c", "Branching plant c", "A shrub whose branches curve."),
    figure!("branching_d", "figure 1.24 d", "Branching plant d", "A tree of two main branches with flat crown."),
    figure!("branching_e", "figure 1.24 e", "Branching plant e", "A symmetrical tree."),
    figure!("branching_f", "figure 1.24 f", "Branching plant f", "A herb whose branches sway to one side."),
    figure!(
        "bush",
        "figure 1.25",
        "Bush in space",
        "A trunk that divides in three again and again, with leaves on all its pieces."
    ),
    figure!(
        "flowering_plant",
        "figure 1.26",
        "Flowering plant",
        "A slender plant with leaves in pairs and flowers of five petals at its tips."
    ),
    figure!("branching_by_chance", "figure 1.27", "Stochastic branching", "Plants of one kind, each another one."),
    figure!("flower_field", "figure 1.28", "Flower field", "The flowering plant with chance in its internodes."),
    figure!(
        "signal",
        "figure 1.30",
        "Acropetal signal",
        "A signal runs from the root to all tips, one internode a step."
    ),
    figure!("hogeweg_hesper_a", "figure 1.31 a", "Plant of two cell states a", "Plumes one above the other."),
    figure!("hogeweg_hesper_b", "figure 1.31 b", "Plant of two cell states b", "A plant with branches that droop."),
    figure!("hogeweg_hesper_c", "figure 1.31 c", "Plant of two cell states c", "A slender plume."),
    figure!(
        "hogeweg_hesper_d",
        "figure 1.31 d",
        "Plant of two cell states d",
        "A tuft whose branches curl at their tips."
    ),
    figure!("hogeweg_hesper_e", "figure 1.31 e", "Plant of two cell states e", "An open plant with straight branches."),
    figure!(
        "row_of_trees",
        "figure 1.37",
        "Row of trees",
        "A curve with edges of different ages: a row of trees, the higher to the left."
    ),
    figure!(
        "anabaena",
        "section 1.10",
        "Anabaena with heterocysts",
        "A filament whose heterocysts keep a distance from each other."
    ),
    figure!("monopodial", "figure 2.6", "Monopodial tree of Honda", "One straight trunk; boughs spread flat."),
    figure!(
        "sympodial",
        "figure 2.7",
        "Sympodial tree of Aono and Kunii",
        "No trunk: at each apex one branch goes on, the other goes aside."
    ),
    figure!(
        "ternary",
        "figure 2.8",
        "Tree of three branches with tropism",
        "A bare trunk and a round crown whose branches hang."
    ),
    figure!("crocus", "section 3.1", "Crocus", "Leaves, and then one flower at the end of a bare stem."),
    figure!(
        "lychnis",
        "section 3.2",
        "Lychnis coronaria",
        "Two branches and a flower at each apex; one branch is ahead of the other."
    ),
    figure!(
        "capsella",
        "figure 3.5",
        "Capsella bursa-pastoris",
        "Leaves below, then pods, and flowers at the top: the youngest are the highest."
    ),
    figure!(
        "mycelis",
        "section 3.3",
        "Mycelis muralis",
        "A panicle that flowers from the top downwards by signals; its lower branches are the longer ones."
    ),
    figure!("vogel_disc", "figure 4.1", "Florets on a disc", "Spirals of both senses whose numbers are of Fibonacci."),
    figure!(
        "sunflower_head",
        "figure 4.4",
        "Sunflower head",
        "Seeds in the middle, then florets, then rays in three rows."
    ),
    figure!(
        "cylinder_phyllotaxis",
        "section 4.2",
        "Scales on a cylinder",
        "Scales of equal size in spirals around a cylinder."
    ),
    figure!(
        "cordate_leaf",
        "figure 5.5",
        "Cordate leaf",
        "A leaf in the form of a heart, of triangles around its base."
    ),
    figure!(
        "simple_leaf",
        "figure 5.6",
        "Simple leaf",
        "A leaf whose form follows from how fast midrib and veins grow."
    ),
    figure!("rose_leaf", "figure 5.8", "Rose leaf", "A leaf with teeth at the ends of its veins."),
    figure!("compound_leaf_a", "figure 5.11 a", "Compound leaf a", "Opposite leaflets, each like the leaf above it."),
    figure!(
        "compound_leaf_b",
        "figure 5.11 b",
        "Compound leaf b",
        "Opposite leaflets, each like the whole leaf 1 steps before."
    ),
    figure!(
        "compound_leaf_c",
        "figure 5.11 c",
        "Compound leaf c",
        "Opposite leaflets, each like the whole leaf 2 steps before."
    ),
    figure!(
        "compound_leaf_d",
        "figure 5.11 d",
        "Compound leaf d",
        "Opposite leaflets, each like the whole leaf 4 steps before."
    ),
    figure!(
        "compound_leaf_e",
        "figure 5.11 e",
        "Compound leaf e",
        "Opposite leaflets, each like the whole leaf 7 steps before."
    ),
    figure!(
        "compound_leaf_alternating",
        "figure 5.12",
        "Alternating compound leaf",
        "Leaflets to the left and right in turn, each like the whole leaf before."
    ),
];
