//! Every reader of bytes from outside, one row each: what mutated files and fuzzing are tried on.
//!
//! A reader may refuse what it gets; it must not panic, and what it accepts must bear being written and read again.

mod machine;
mod meshes;
mod pictures;
mod place;
mod records;
mod sums;
mod work;

/// A reader.
#[derive(Clone, Copy, Debug)]
pub struct Reader {
    /// What it reads; the folder of its inputs in `tests/fuzz/corpus`, too.
    pub name: &'static str,
    /// Gives it bytes.
    ///
    /// # Panics
    /// Where it panics, or contradicts itself: a fault that is to be found.
    pub read: fn(&[u8]),
}

/// Every reader: pictures, meshes, data, states of work and scripts of the host, then what comes to the PS 340.
pub const READERS: [Reader; 27] = [
    Reader { name: "png", read: pictures::png },
    Reader { name: "exr", read: pictures::exr },
    Reader { name: "layers", read: pictures::layers },
    Reader { name: "environment", read: pictures::environment },
    Reader { name: "obj", read: meshes::obj },
    Reader { name: "stl", read: meshes::stl },
    Reader { name: "ply", read: meshes::ply },
    Reader { name: "gltf", read: meshes::gltf },
    Reader { name: "glb", read: meshes::glb },
    Reader { name: "cmesh", read: meshes::compact },
    Reader { name: "octree", read: meshes::octree },
    Reader { name: "luminaire", read: records::luminaire },
    Reader { name: "columns", read: records::columns },
    Reader { name: "sheet", read: records::sheet },
    Reader { name: "record", read: records::record },
    Reader { name: "database", read: records::database },
    Reader { name: "state", read: work::state },
    Reader { name: "memo", read: work::memo },
    Reader { name: "script", read: work::script },
    Reader { name: "commands", read: machine::commands },
    Reader { name: "binary", read: machine::binary },
    Reader { name: "packets", read: machine::packets },
    Reader { name: "parallel", read: machine::parallel },
    Reader { name: "capture", read: machine::capture },
    Reader { name: "orders", read: machine::operator_commands },
    Reader { name: "play", read: machine::play },
    Reader { name: "lint", read: machine::lint },
];

/// The reader of a name.
pub fn reader(name: &str) -> Option<Reader> {
    READERS.into_iter().find(|reader| reader.name == name)
}
