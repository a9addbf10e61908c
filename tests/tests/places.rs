//! How many places a new kind of each family touches: those that name one that is there, counted.

use std::collections::BTreeSet;
use std::path::Path;
use tests::source_tree::{CRATES, code, read, root, sources};

/// A family of kinds, and one of them.
struct Family {
    name: &'static str,
    /// The names by which the code knows this kind.
    kind: &'static [&'static str],
    /// The files that name it: its own, its row, and where scripts or scenes ask for it.
    files: &'static [&'static str],
}

/// The families that grow; a new kind touches as many files as the kind that stands here.
const FAMILIES: &[Family] = &[
    Family {
        name: "function of the PS 340",
        kind: &["average"],
        files: &["ps340/emulation/src/functions/accumulation.rs"],
    },
    Family {
        name: "operate command",
        kind: &["SetRate"],
        files: &["protocol/src/command/operate/attribute.rs", "ps340/emulation/src/structure/operation/attribute.rs"],
    },
    Family {
        name: "solid",
        kind: &["Paraboloid"],
        files: &["host/src/script/solids.rs", "host/modelling/src/solid/primitive/kind.rs"],
    },
    Family {
        name: "distribution",
        kind: &["Blinn", "blinn"],
        files: &[
            "host/synthesis/src/illumination/distribution/blinn.rs",
            "host/synthesis/src/illumination/distribution/mod.rs",
        ],
    },
    Family {
        name: "lobe",
        kind: &["MirrorLobe"],
        files: &[
            "host/synthesis/src/illumination/optics/builder.rs",
            "host/synthesis/src/illumination/optics/lobes.rs",
            "host/synthesis/src/illumination/optics/mirror.rs",
        ],
    },
    Family {
        name: "light",
        kind: &["SpotProfile", "Spot"],
        files: &[
            "host/synthesis/src/illumination/light/mod.rs",
            "host/synthesis/src/illumination/light/spot.rs",
            "host/src/script/lighting.rs",
        ],
    },
    Family {
        name: "texture",
        kind: &["Marble"],
        files: &["host/synthesis/src/illumination/texture/motif/mod.rs", "host/src/script/texturing.rs"],
    },
    Family {
        name: "renderer",
        kind: &["ScanLine"],
        files: &[
            "host/synthesis/src/render/renderers.rs",
            "host/synthesis/src/render/scan_line/mod.rs",
            // Which renderers are studied if nobody says.
            "host/src/study/rendering/setup.rs",
        ],
    },
    Family { name: "sub-command", kind: &["diff"], files: &["host/src/cli/mod.rs", "host/src/cli/program.rs"] },
    Family {
        name: "knob of a study",
        kind: &["leaf_size"],
        files: &["host/src/study/knobs.rs", "host/src/study/octree.rs"],
    },
    Family { name: "function of scripts", kind: &["sharpen_vertices"], files: &["host/src/script/subdividing.rs"] },
];

/// Whether a file holds code that is not for tests only.
fn is_product(path: &Path) -> bool {
    let text = path.to_string_lossy();
    !(text.ends_with("tests.rs") || text.contains("/tests/"))
}

#[test]
fn a_kind_is_named_in_its_file_its_row_and_where_it_is_asked_for() {
    let root = root();
    let products = CRATES.iter().filter(|one| one.name != "tests");
    let files = products.flat_map(|one| sources(&root.join(one.folder).join("src"))).filter(|path| is_product(path));
    let texts: Vec<(String, String)> = files
        .map(|path| {
            let text = code(&read(&path));
            let end = text.find("\nmod tests {").unwrap_or(text.len());
            let name = path.strip_prefix(&root).expect("below the root").to_string_lossy().into_owned();
            (name, text[..end].to_owned())
        })
        .collect();
    for Family { name, kind, files } in FAMILIES {
        let has =
            |text: &str| text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| kind.contains(&word));
        let found: BTreeSet<&str> = texts.iter().filter(|(_, text)| has(text)).map(|(name, _)| name.as_str()).collect();
        assert_eq!(found, files.iter().copied().collect(), "{name}");
    }
}
