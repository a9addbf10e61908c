//! Readers of the states of work, and of scene scripts.

use super::place::with_file;
use super::sums;
use host::render::{Fingerprint, Memo, RenderOrder, RenderState};
use host::scene::Settings;
use host::script;
use std::convert::Infallible;
use std::path::Path;

/// What a state of a rendering begins with: name and version.
const STATE: &[u8; 8] = b"PERISF\x00\x03";
/// What a log of results begins with: name and version, and the fingerprint of what is computed.
const MEMO: &[u8; 12] = b"PERISM\x00\x07\x07\0\0\0";
/// How many results are asked for.
const RESULTS: usize = 4;

/// The film of three by two pixels is read, if it is one of them.
pub fn state(bytes: &[u8]) {
    let order = RenderOrder::of(&Settings::of_size(3, 2, 16));
    let fingerprint = r#"{"scene": 1, "geometry": 2, "order": 3}"#;
    let fingerprint: Fingerprint = serde_json::from_str(fingerprint).expect("three numbers");
    let beginning: Vec<u8> = [1_u32, 2, 3].iter().flat_map(|part| part.to_le_bytes()).collect();
    let bytes = sums::state(&[&STATE[..], &beginning].concat(), bytes);
    if let Ok(state) = with_file("a.state", &bytes, |path| RenderState::read(path, &order, fingerprint)) {
        assert_eq!((state.film.width(), state.film.height()), (3, 2));
    }
}

/// Results that were kept, or are computed anew, are there the next time.
pub fn memo(bytes: &[u8]) {
    with_file("a.memo", &sums::memo(*MEMO, bytes), |path| {
        let results = || -> Vec<Vec<(u32, String)>> {
            let memo = Memo::open(path, 7).expect("its head is right");
            let next = |_| {
                let Ok(found) = Memo::next(Some(&memo), || Ok::<_, Infallible>(vec![(1, "new".to_owned())]));
                found
            };
            (0..RESULTS).map(next).collect()
        };
        assert_eq!(results(), results());
    });
}

/// A scene is made, within the limits of scripts.
pub fn script(bytes: &[u8]) {
    let _ =
        script::evaluate(&String::from_utf8_lossy(bytes), "script", Path::new("no folder"), &script::Inputs::default());
}
