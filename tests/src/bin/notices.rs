//! Makes the notices of crates of others anew: `cargo run -p tests --bin notices`.

use std::path::Path;
use tests::notices::{self, NoticesError};

fn main() -> Result<(), NoticesError> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let path = root.join(notices::PATH);
    let text = notices::print(&root)?;
    std::fs::write(&path, text).map_err(|source| NoticesError::File { path, source })
}
