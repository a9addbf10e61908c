//! The Stanford bunny, where it is a part of the program.

use super::{Mesh, compact};

/// The Stanford bunny was left out when the program was built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the Stanford bunny is not in this program: it was built without the feature `bunny` of crate `host`")]
pub struct NoBunny;

/// The Stanford bunny, closed: 34,835 vertices and 69,666 triangles, about 2 units high, y up, facing the viewer.
///
/// Coordinates are rounded to 1/65535 of the longest side of its box. Please acknowledge the Stanford Computer
/// Graphics Laboratory in what you publish with it; no commercial use without its permission (`data/README.md`).
///
/// # Errors
/// [`NoBunny`] in a program that was built without the feature `bunny`.
///
/// # Source
/// Stanford 3D Scanning Repository, scan of Greg Turk and Marc Levoy, 1994; the holes of its base are filled.
pub fn bunny() -> Result<Mesh, NoBunny> {
    #[cfg(feature = "bunny")]
    let file = Some(include_bytes!("../../../data/bunny.cmesh"));
    #[cfg(not(feature = "bunny"))]
    let file = None::<&[u8]>;
    let file = file.ok_or(NoBunny)?;
    Ok(compact::parse(file).expect("the embedded bunny is well formed; a test reads it"))
}
