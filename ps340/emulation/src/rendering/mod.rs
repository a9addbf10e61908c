//! Local rendering of polygons: vectors without what is hidden or cut off, and shaded images.
//!
//! [`Facets`] are all that is below a rendering node, in one mesh. A [`Task`] makes a rendering of them in pieces of
//! bounded work, so that nothing else has to wait; [`render`] makes it at once.
//!
//! Not modelled: transparency, the time that the machine took, and the order in which it painted.

mod fault;
mod surface;
mod triangulate;
mod facets;
mod outcome;
mod solid;
mod normals;
mod project;
mod scan;
mod back_face;
mod section;
mod hidden_line;
mod shade;
mod task;
mod members;

pub use facets::{BYTES_PER_VERTEX, Facets, MAX_VERTICES};
pub use fault::RenderingFault;
pub use members::members;
pub use outcome::{Image, RenderingResult, Segment};
pub use task::{Task, render};

#[cfg(test)]
mod tests;
