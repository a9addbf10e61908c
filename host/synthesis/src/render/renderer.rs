//! The interface of every renderer.

use super::error::RenderError;
use super::order::RenderOrder;
use super::rendering::Rendering;
use super::watch::Watch;
use crate::scene::View;

/// A renderer that has taken up a scene and can make pictures of it.
pub trait Renderer: Send + Sync {
    /// Features of a scene that pictures of a view do not show, in words.
    fn left_out(&self, view: &View) -> Vec<&'static str>;

    /// Renders one view.
    ///
    /// The picture does not depend on the number of threads.
    ///
    /// # Errors
    /// [`RenderError`] for a view that sees nothing, or when no memory or thread can be had. Being cancelled is no
    /// error: the rendering then holds the rows that were finished.
    fn render(&self, view: &View, order: &RenderOrder, watch: &Watch<'_>) -> Result<Rendering, RenderError>;
}
