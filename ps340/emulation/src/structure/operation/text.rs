//! Rows of text and fonts.

macro_rules! text_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

    /// CHARACTER FONT; none for STANDARD FONT.
    Font(font: Option<ObjectId>) = {
        named if font.is_some() { "CHARACTER FONT" } else { "STANDARD FONT" };
        from Operate::CharacterFont(_), in context =>
            Operation::Font(Some(context.font.ok_or(Degenerate("FONT needs a name"))?));
        from Operate::StandardFont => Operation::Font(None);
        below state => state.font = *font;
    }

    /// MATRIX_2X2: multiplies the character matrix.
    Character(matrix: DMat2) = {
        named "MATRIX_2X2";
        from Operate::Matrix2(m) => Operation::Character(m);
        from Operate::CharacterRotate(angle) => {
            let (sine, cosine) = matrices::sine_and_cosine(angle);
            Operation::Character(DMat2::from_cols_array(&[cosine, sine, 0.0 - sine, cosine]))
        };
        from Operate::CharacterScale(factors) => Operation::Character(DMat2::from_diagonal(factors));
        at FIRST takes MATRIX_2, given => *matrix = given.matrix2()?;
        below state => state.characters *= *matrix;
        shows rows(&[&matrix.x_axis.to_array(), &matrix.y_axis.to_array()]);
    }

    /// TEXT SIZE: replaces the character matrix.
    TextSize(size: f64) = {
        named "TEXT SIZE";
        from Operate::TextSize(size) => Operation::TextSize(size);
        at FIRST takes MATRIX_2.or(KindSet::NUMBER), given => *size = given.text_size()?;
        below state => state.characters = DMat2::from_diagonal(DVec2::splat(*size));
        shows size.to_string();
    }
    } };
}

pub(super) use text_rows;
