//! By what a frame that is there is known again: a hash of all that its picture depends on.

use crate::cli::CommandFailure;
use crate::cli::rendering_arguments::RenderingArguments;
use crate::cli::source::{is_mesh, stem};
use crate::memory;
use crate::picture::display::Exposure;
use crate::render::ContentHash;
use crate::script::Evaluated;
use serde_json::Value;
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Rises when pictures or their files are made in another way, so that frames of before are made anew.
const FORM: u32 = 1;
/// Bytes of a file that are read at a time.
const PIECE: usize = 1 << 16;
/// Longest glTF file that is searched for the names of others, bytes.
const MOST_TEXT: u64 = 1 << 30;

/// A hash of all that the picture of a frame depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FrameFingerprint(u128);

impl std::fmt::Display for FrameFingerprint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// When a file was written, and its bytes.
type Stamp = (SystemTime, u64);

/// What is known of a file.
#[derive(Clone)]
struct ReadFile {
    stamp: Stamp,
    content: u128,
    /// The files that it names.
    beside: Vec<PathBuf>,
}

/// Finds fingerprints of frames. Files are read once, as long as they stay the same.
#[derive(Default)]
pub(super) struct Fingerprints {
    files: HashMap<PathBuf, ReadFile>,
}

impl Fingerprints {
    /// The fingerprint of a frame.
    ///
    /// - `script`: as it was called. `evaluated`: the scene of the frame.
    /// - `metered`: the scene by which it is exposed, if a meter exposes it.
    ///
    /// # Errors
    /// A [`CommandFailure`] for options that no picture can be made with.
    pub(super) fn of(
        &mut self,
        script: &str,
        arguments: &RenderingArguments,
        evaluated: &Evaluated,
        metered: Option<&Evaluated>,
    ) -> Result<FrameFingerprint, CommandFailure> {
        let mut hash = ContentHash::new();
        let RenderingArguments { renderer, everything, layers, .. } = arguments;
        let program = env!("CARGO_PKG_VERSION");
        hash.add(&(FORM, program, stem(script), renderer, everything, layers));
        for evaluated in [Some(evaluated), metered].into_iter().flatten() {
            let mut scene = evaluated.scene.clone();
            scene.display = arguments.display_of(&scene)?;
            // The meter sees the size of the scene's own pictures.
            hash.add(&[scene.settings.image.width, scene.settings.image.height]);
            arguments.set(&mut scene.settings);
            let order = arguments.order(&scene.settings, None)?;
            // Pictures do not depend on the number of threads.
            hash.add(&format!("{:?}", crate::render::RenderOrder { threads: None, ..order }));
            hash.add_scene(&scene);
            let own = Some(Path::new(script)).filter(|path| is_mesh(path));
            for path in own.into_iter().chain(evaluated.files.iter().map(PathBuf::as_path)) {
                hash.add(&self.of_file(path));
            }
        }
        Ok(FrameFingerprint(hash.value()))
    }

    /// A hash of a file and of those that it names; none if it cannot be read.
    fn of_file(&mut self, path: &Path) -> Option<u128> {
        let about = path.metadata().ok()?;
        let stamp = (about.modified().ok()?, about.len());
        let known = self.files.get(path).filter(|known| known.stamp == stamp).cloned();
        let read = || Some(ReadFile { stamp, content: content(path).ok()?, beside: buffers(path) });
        let file = known.or_else(read)?;
        let mut hash = ContentHash::new();
        hash.add(&file.content);
        file.beside.iter().for_each(|beside| hash.add(&self.of_file(beside)));
        self.files.insert(path.into(), file);
        Some(hash.value())
    }
}

/// Whether a picture is exposed by a meter.
pub(super) fn is_metered(exposure: Exposure) -> bool {
    matches!(exposure, Exposure::Auto { .. })
}

/// A hash of the content of a file.
fn content(path: &Path) -> io::Result<u128> {
    let mut file = File::open(path)?;
    let mut hash = ContentHash::new();
    let mut piece = vec![0; PIECE];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(hash.value()),
            read => hash.add_bytes(&piece[..read]),
        }
    }
}

/// The files of numbers that a glTF file names, which lie beside it; none of other files.
fn buffers(path: &Path) -> Vec<PathBuf> {
    let is_text = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gltf"));
    let text = is_text.then(|| memory::read_text(path, MOST_TEXT).ok()).flatten();
    let root: Option<Value> = text.and_then(|text| serde_json::from_str(&text).ok());
    let buffers = root.as_ref().and_then(|root| root["buffers"].as_array()).into_iter().flatten();
    let names = buffers.filter_map(|buffer| buffer["uri"].as_str()).filter(|name| !name.starts_with("data:"));
    names.filter(|name| !name.to_ascii_lowercase().ends_with(".gltf")).map(|name| path.with_file_name(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::script::{Inputs, load_file};
    use clap::{Args, Command, FromArgMatches};

    /// The fingerprint of a script beside a mesh, with options.
    fn fingerprint(folder: &Path, text: &str, options: &str) -> FrameFingerprint {
        let script = folder.join("a.rhai");
        std::fs::write(&script, text).expect("written");
        let words = std::iter::once("animate").chain(options.split_whitespace());
        let matches = RenderingArguments::augment_args(Command::new("animate")).get_matches_from(words);
        let arguments = RenderingArguments::from_arg_matches(&matches).expect("options");
        let evaluated = load_file(&script, &Inputs::default()).expect("a scene");
        let found = Fingerprints::default().of("a.rhai", &arguments, &evaluated, None);
        found.unwrap_or_else(|failure| panic!("{}", failure.error))
    }

    #[test]
    fn fingerprints_differ_where_pictures_may_and_not_with_the_threads() {
        let folder = tempfile::tempdir().expect("a folder");
        let of = |text: &str, options: &str| fingerprint(folder.path(), text, options);
        let own = of("cube(1);", "");
        assert_eq!([of("cube(1);", "--threads 3"), of("cube( 1 );", "")], [own; 2]);
        let options = ["--samples 3", "--seed 8", "--exposure 1", "--tone linear", "--matte", "--denoise --samples 9"];
        let all: Vec<FrameFingerprint> = options.iter().map(|options| of("cube(1);", options)).collect();
        let others = [of("cube(2);", ""), of("cube(1); exposure(2);", ""), of("cube(1);", "--layers")];
        let mut seen = vec![own];
        for other in all.into_iter().chain(others) {
            assert!(!seen.contains(&other), "{} of {seen:?}", seen.len());
            seen.push(other);
        }
    }

    #[test]
    fn the_content_of_files_counts_and_so_do_the_buffers_beside_them() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
        let hash = |name: &str| Fingerprints::default().of_file(&folder.path().join(name));
        write("a.obj", "v 0 0 0");
        let before = hash("a.obj");
        write("a.obj", "v 0 0 1");
        assert!(before.is_some() && hash("a.obj") != before && hash("none.obj").is_none());
        write("a.gltf", r#"{ "buffers": [{ "uri": "a.bin" }, { "uri": "data:;base64,AA" }] }"#);
        write("a.bin", "1");
        let before = hash("a.gltf");
        write("a.bin", "2");
        assert_ne!(hash("a.gltf"), before);
    }
}
