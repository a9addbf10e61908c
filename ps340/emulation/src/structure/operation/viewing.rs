//! Rows of the views.

use protocol::command::Boundaries;

/// Front and back when a view does not give them: about what the manuals name, and what a client passed.
const DEFAULT_BOUNDARIES: Boundaries = Boundaries { front: 1e-15, back: 1e15 };

/// Front and back of a view.
pub(super) fn depth(boundaries: Option<Boundaries>) -> [f64; 2] {
    let b = boundaries.unwrap_or(DEFAULT_BOUNDARIES);
    [b.front, b.back]
}

macro_rules! viewing_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

    /// WINDOW, FIELD_OF_VIEW, EYE, MATRIX_4X4.
    Projective(matrix: DMat4) = {
        named "MATRIX_4X4";
        from Operate::Matrix4(m) => Operation::Projective(m);
        from Operate::Window { x, y, boundaries } => Operation::Projective(
            matrices::window(x, y, depth(boundaries))
                .ok_or(Degenerate("WINDOW needs three ranges that are not empty"))?,
        );
        from Operate::FieldOfView { angle, boundaries } => Operation::Projective(
            matrices::field_of_view(angle, depth(boundaries))
                .ok_or(Degenerate("FIELD_OF_VIEW needs an angle between 0 and 180 and FRONT before BACK"))?,
        );
        from Operate::Eye { back, right, up, width, boundaries } => Operation::Projective(
            matrices::eye(back, right, up, width, depth(boundaries))
                .ok_or(Degenerate("EYE needs a distance and a width above 0 and FRONT before BACK"))?,
        );
        at FIRST takes MATRIX_4, given => *matrix = given.matrix4()?;
        below state => state.project(matrix);
        shows {
            let c = matrix.to_cols_array_2d();
            rows(&[&c[0], &c[1], &c[2], &c[3]])
        };
    }

    /// VIEWPORT, relative to the enclosing one.
    Viewport {
        /// Left and right.
        horizontal: [f64; 2],
        /// Bottom and top.
        vertical: [f64; 2],
        /// Intensity at the back and at the front.
        intensity: Option<[f64; 2]>,
    } = {
        named "VIEWPORT";
        from Operate::Viewport { horizontal, vertical, intensity } =>
            Operation::Viewport { horizontal, vertical, intensity };
        odd Operate::Viewport { horizontal, vertical, .. } =>
            both(doubtful_limits("HORIZONTAL", horizontal), doubtful_limits("VERTICAL", vertical));
        at FIRST takes MATRIX_2.or(MATRIX_3), given => {
            let limits = given.viewport()?;
            (*horizontal, *vertical, *intensity) = (limits.0, limits.1, limits.2.or(*intensity));
        };
        below state => {
            let [across, upward] = [inside(state.horizontal, *horizontal), inside(state.vertical, *vertical)];
            state.look_through(across, upward, *intensity);
        };
        shows limits(horizontal, vertical, intensity);
    }

    /// LOAD VIEWPORT: replaces the enclosing one.
    LoadViewport {
        /// Left and right on the screen.
        horizontal: [f64; 2],
        /// Bottom and top.
        vertical: [f64; 2],
        /// Intensity at the back and at the front.
        intensity: Option<[f64; 2]>,
    } = {
        named "LOAD VIEWPORT";
        from Operate::LoadViewport { horizontal, vertical, intensity } =>
            Operation::LoadViewport { horizontal, vertical, intensity };
        odd Operate::LoadViewport { horizontal, vertical, .. } =>
            both(doubtful_limits("HORIZONTAL", horizontal), doubtful_limits("VERTICAL", vertical));
        at FIRST takes MATRIX_2.or(MATRIX_3), given => {
            let limits = given.viewport()?;
            (*horizontal, *vertical, *intensity) = (limits.0, limits.1, limits.2.or(*intensity));
        };
        below state => state.look_through(*horizontal, *vertical, *intensity);
        shows limits(horizontal, vertical, intensity);
    }
    } };
}

pub(super) use viewing_rows;
