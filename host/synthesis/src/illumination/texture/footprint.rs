//! The footprint of a texture: where on a surface, and in a body, it is looked up, and over how large a part.

use glam::{DVec2, DVec3};

/// The footprint of a texture: a point of a surface with the parallelogram about it over which the mean is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureFootprint {
    /// Parameters of the exact surface, of which the domain is 0..1, or texture coordinates of a file.
    pub uv: DVec2,
    /// The point in the coordinates of the object.
    pub own: DVec3,
    /// The sides of the parallelogram, whose middle is the point; tangents of the surface, at right angles in the
    /// scene.
    pub sides: [FootprintSide; 2],
    /// The derivatives of the point in the scene by u and v, as far as the triangle tells; 0 where it does not.
    pub along: [DVec3; 2],
    /// By which instances of one kind differ; 0 for what is no instance.
    pub variation: u16,
}

/// A vector along the surface, in three coordinate systems.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FootprintSide {
    /// In the scene.
    pub scene: DVec3,
    /// In parameters.
    pub uv: DVec2,
    /// In the coordinates of the object.
    pub own: DVec3,
}

impl FootprintSide {
    /// A multiple of the vector.
    pub fn scaled(&self, factor: f64) -> FootprintSide {
        FootprintSide { scene: self.scene * factor, uv: self.uv * factor, own: self.own * factor }
    }
}

impl TextureFootprint {
    /// A footprint without extent.
    pub fn point(uv: DVec2, own: DVec3) -> TextureFootprint {
        TextureFootprint { uv, own, ..TextureFootprint::default() }
    }

    /// The footprint at the end of a vector, as large as this one.
    pub fn moved(&self, way: &FootprintSide) -> TextureFootprint {
        TextureFootprint { uv: self.uv + way.uv, own: self.own + way.own, ..*self }
    }
}
