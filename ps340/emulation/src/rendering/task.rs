//! A rendering as a task in pieces of bounded work.

use super::{
    Facets, RenderingFault, RenderingResult, Segment,
    back_face::back_face_removal,
    hidden_line::HiddenLine,
    section::{cross_section, sectioned},
    shade::Shading,
    solid::check,
};
use crate::{functions::devices::shading::ShadingEnvironment, port::Rendering};

/// A rendering in progress.
#[derive(Debug)]
pub struct Task(Stage);

#[derive(Debug)]
enum Stage {
    Lines(Vec<Segment>),
    HiddenLine(Box<HiddenLine>),
    Shading(Box<Shading>),
}

impl Task {
    /// Begins a rendering.
    ///
    /// # Errors
    /// A solid is none, or a cut has no plane.
    pub fn new(kind: Rendering, facets: Facets, environment: &ShadingEnvironment) -> Result<Task, RenderingFault> {
        if facets.solid {
            check(&facets)?;
        }
        let plane = || facets.plane.ok_or(RenderingFault::NoPlane);
        Ok(Task(match kind {
            Rendering::CrossSection => Stage::Lines(cross_section(&facets, &plane()?)),
            Rendering::Sectioned => Stage::Lines(sectioned(&facets, &plane()?)),
            Rendering::BackFace => Stage::Lines(back_face_removal(&facets)),
            Rendering::HiddenLine => Stage::HiddenLine(Box::new(HiddenLine::new(&facets))),
            Rendering::Wash | Rendering::Flat | Rendering::Gouraud | Rendering::Phong => {
                Stage::Shading(Box::new(Shading::new(kind, facets, environment)))
            }
        }))
    }

    /// Goes on for about so many units of work, each some ten nanoseconds. Returns what was made, once it is done.
    pub fn advance(&mut self, units: u64) -> Option<RenderingResult> {
        match &mut self.0 {
            Stage::Lines(segments) => Some(RenderingResult::Lines(std::mem::take(segments))),
            Stage::HiddenLine(lines) => lines.advance(units).map(RenderingResult::Lines),
            Stage::Shading(shading) => shading.advance(units).map(RenderingResult::Image),
        }
    }
}

/// Makes a rendering at once.
///
/// # Errors
/// A solid is none, or a cut has no plane.
pub fn render(
    kind: Rendering,
    facets: Facets,
    environment: &ShadingEnvironment,
) -> Result<RenderingResult, RenderingFault> {
    let mut task = Task::new(kind, facets, environment)?;
    loop {
        if let Some(outcome) = task.advance(u64::MAX) {
            return Ok(outcome);
        }
    }
}
