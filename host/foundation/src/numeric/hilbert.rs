//! The Hilbert curve: an order of the cells of a square in which neighbours in the order touch each other.

/// The place of a cell of a square along Hilbert's curve, which begins in the cell at 0, 0 and ends in the other corner of
/// the first row.
///
/// - `bits`: the square has 2^`bits` cells along each side, 0..=32.
/// - `cell`: column and row, each below 2^`bits`.
/// - Returns 0..4^`bits`. Cells whose places differ by 1 have a side in common.
///
/// # Source
/// Hilbert, "Über die stetige Abbildung einer Linie auf ein Flächenstück", 1891.
pub fn hilbert_place(bits: u32, cell: [u32; 2]) -> u64 {
    let [mut x, mut y] = cell;
    let mut place = 0;
    for bit in (0..bits).rev() {
        let [right, upper] = [x, y].map(|coordinate| coordinate >> bit & 1);
        place = place << 2 | u64::from((3 * right) ^ upper);
        // Within a quarter the curve is mirrored, so that it begins where the last quarter ended.
        if upper == 0 {
            if right == 1 {
                let last = (1u32 << bit).wrapping_sub(1);
                (x, y) = (last ^ x, last ^ y);
            }
            (x, y) = (y, x);
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_is_that_of_one_cell_and_neighbours_touch() {
        for bits in [0, 1, 2, 5] {
            let side = 1 << bits;
            let mut cells = vec![None; 1 << (2 * bits)];
            for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
                let place = hilbert_place(bits, [x, y]) as usize;
                assert_eq!(cells[place].replace([x, y]), None, "{x} {y}");
            }
            let cells: Vec<[u32; 2]> = cells.into_iter().flatten().collect();
            assert!(cells.windows(2).all(|of| of[0][0].abs_diff(of[1][0]) + of[0][1].abs_diff(of[1][1]) == 1));
            assert_eq!([cells[0], cells[cells.len() - 1]], [[0, 0], [side - 1, 0]]);
        }
    }

    #[test]
    fn the_largest_square_has_64_bits() {
        assert_eq!(hilbert_place(32, [0, 0]), 0);
        assert_eq!(hilbert_place(32, [u32::MAX, 0]), u64::MAX);
    }
}
