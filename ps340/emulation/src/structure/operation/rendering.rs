//! Rows of surfaces, and of data that is read back.

macro_rules! rendering_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

    /// SURFACE_RENDERING and SOLID_RENDERING.
    Rendering {
        /// Whether the polygons below are the boundary of a solid.
        solid: bool,
    } = {
        named if *solid { "SOLID_RENDERING" } else { "SURFACE_RENDERING" };
        from Operate::SurfaceRendering => Operation::Rendering { solid: false };
        from Operate::SolidRendering => Operation::Rendering { solid: true };
        at FIRST takes KindSet::INTEGER.or(KindSet::BOOLEAN).or(KindSet::STRING), given => given.request()?;
        at SECOND takes KindSet::BOOLEAN, given => *solid = given.boolean()?;
        asks Asked::Rendering;
    }

    /// SECTIONING_PLANE.
    SectioningPlane = {
        named "SECTIONING_PLANE";
        from Operate::SectioningPlane => Operation::SectioningPlane;
        below state => state.factors.iter_mut().for_each(|factors| factors.cut());
    }

    /// XFORM MATRIX.
    XformMatrix = {
        named "XFORM MATRIX";
        from Operate::XformMatrix => Operation::XformMatrix;
        asks Asked::Matrix;
    }

    /// XFORM VECTOR.
    XformVector = {
        named "XFORM VECTOR";
        from Operate::XformVector => Operation::XformVector;
        asks Asked::Vectors;
    }

    /// CANCEL XFORM.
    CancelXform = {
        named "CANCEL XFORM";
        from Operate::CancelXform => Operation::CancelXform;
        below state => state.gatherer = None;
    }

    /// WRITEBACK.
    WriteBack = {
        named "WRITEBACK";
        from Operate::WriteBack => Operation::WriteBack;
        at FIRST takes KindSet::BOOLEAN, given => given.request()?;
        asks Asked::Strokes;
    }
    } };
}

pub(super) use rendering_rows;
