//! A 4x3 matrix as its twelve numbers, row by row of the machine.

use glam::{DMat4, DVec4};

/// The numbers of a 4x3 matrix.
pub(super) fn four_by_three(matrix: &DMat4) -> [f64; 12] {
    let columns = matrix.to_cols_array();
    std::array::from_fn(|i| columns[i / 3 * 4 + i % 3])
}

/// The 4x3 matrix of twelve numbers, completed with 0, 0, 0, 1.
pub(super) fn from_four_by_three(rows: &[f64; 12]) -> DMat4 {
    let row = |i: usize, w: f64| DVec4::new(rows[3 * i], rows[3 * i + 1], rows[3 * i + 2], w);
    DMat4::from_cols(row(0, 0.0), row(1, 0.0), row(2, 0.0), row(3, 1.0))
}
