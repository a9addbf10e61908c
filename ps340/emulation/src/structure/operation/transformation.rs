//! Rows of the transformations.

macro_rules! transformation_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

    /// ROTATE, SCALE, MATRIX_3X3.
    Linear(matrix: DMat3) = {
        named "MATRIX_3X3";
        from Operate::Rotate { axis, angle } => Operation::Linear(matrices::rotation(axis, angle));
        from Operate::Scale(factors) => Operation::Linear(DMat3::from_diagonal(factors));
        from Operate::Matrix3(m) => Operation::Linear(m);
        at FIRST takes MATRIX_3, given => *matrix = given.matrix3()?;
        below state => state.transform(DMat4::from_mat3(*matrix));
        shows rows(&[&matrix.x_axis.to_array(), &matrix.y_axis.to_array(), &matrix.z_axis.to_array()]);
    }

    /// TRANSLATE.
    Translate(by: DVec3) = {
        named "TRANSLATE";
        from Operate::Translate(by) => Operation::Translate(by);
        at FIRST takes POSITION, given => *by = given.position()?;
        below state => state.transform(DMat4::from_translation(*by));
        shows rows(&[&by.to_array()]);
    }

    /// LOOK, MATRIX_4X3.
    Affine(matrix: DMat4) = {
        named "MATRIX_4X3";
        from Operate::Matrix4x3(m) => Operation::Affine(m);
        from Operate::Look { at, from, up } => Operation::Affine(
            matrices::look(at, from, up.unwrap_or(at + DVec3::Y))
                .ok_or(Degenerate("LOOK needs FROM and AT apart, and UP across the line of sight"))?,
        );
        at FIRST takes MATRIX_4X3, given => *matrix = given.matrix4x3()?;
        below state => state.transform(*matrix);
        shows {
            let c = matrix.to_cols_array_2d();
            rows(&[&c[0][..3], &c[1][..3], &c[2][..3], &c[3][..3]])
        };
    }
    } };
}

pub(super) use transformation_rows;
