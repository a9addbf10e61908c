//! The requests to a rendering node.

use protocol::Name;

/// A way to render the polygons below a node: the numbers 1 to 8 at its input `<1>`.
///
/// # Source
/// 3, 4 and 7 are seen in a client, the others are remembered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rendering {
    /// 1: where the sectioning plane cuts the polygons, as vectors.
    CrossSection,
    /// 2: what lies behind the sectioning plane, as vectors.
    Sectioned,
    /// 3: without the polygons of a solid that face away, as vectors.
    BackFace,
    /// 4: without the lines that polygons hide, as vectors.
    HiddenLine,
    /// 5: filled with unlit colour, on the raster screen.
    Wash,
    /// 6: one light for a polygon.
    Flat,
    /// 7: light that changes evenly between the corners.
    Gouraud,
    /// 8: a normal and a light for each pixel.
    Phong,
}

impl Rendering {
    /// All, by their numbers from 1.
    pub const ALL: [Rendering; 8] = [
        Rendering::CrossSection,
        Rendering::Sectioned,
        Rendering::BackFace,
        Rendering::HiddenLine,
        Rendering::Wash,
        Rendering::Flat,
        Rendering::Gouraud,
        Rendering::Phong,
    ];

    /// The rendering with a number; none for other numbers than 1 to 8.
    pub fn from_number(number: i32) -> Option<Rendering> {
        usize::try_from(number).ok().and_then(|n| Rendering::ALL.get(n.checked_sub(1)?).copied())
    }

    /// Whether it is an image on the raster screen, not vectors.
    pub const fn is_shaded(self) -> bool {
        matches!(self, Rendering::Wash | Rendering::Flat | Rendering::Gouraud | Rendering::Phong)
    }

    /// Whether it needs a sectioning plane.
    pub const fn is_cut(self) -> bool {
        matches!(self, Rendering::CrossSection | Rendering::Sectioned)
    }
}

/// A message at input `<1>` of a rendering node.
#[derive(Clone, Debug, PartialEq)]
pub enum RenderingRequest {
    /// A rendering is to be made and shown.
    Render(Rendering),
    /// TRUE: the last rendering in vectors is shown; FALSE: the original.
    Show(bool),
    /// FIX(0): whichever of the two is not shown.
    Toggle,
    /// A string: the last rendering in vectors gets a name of its own.
    Save(Name),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_one_to_eight_are_renderings() {
        for (number, rendering) in (1..).zip(Rendering::ALL) {
            assert_eq!(Rendering::from_number(number), Some(rendering));
            assert_eq!(rendering.is_shaded(), number >= 5);
            assert_eq!(rendering.is_cut(), number <= 2);
        }
        for number in [0, 9, -1, i32::MIN, i32::MAX] {
            assert_eq!(Rendering::from_number(number), None);
        }
    }
}
