//! How full of lines the parts of the screen are.

/// Cells along each side of the screen.
const CELLS: usize = 48;
/// Length of lines for each unit of area, in halves of the side of the screen, on which the next instance is drawn a step
/// coarser: lines of an ordinary width cover a sixth of it then.
const LAYER: f64 = 45.0;

/// Lengths of lines in the cells of the screen.
pub(super) struct Ink(Vec<f64>);

impl Default for Ink {
    fn default() -> Ink {
        Ink(vec![0.0; CELLS * CELLS])
    }
}

impl Ink {
    /// How many layers of lines lie where something is drawn; 0 where there is less than one.
    ///
    /// - `at`: its middle, -1 to 1. `size`: its radius.
    pub(super) fn layers(&self, at: [f32; 2], size: f64) -> usize {
        let cells = Ink::cells(at, size);
        let (sum, count) = cells.fold((0.0, 0), |(sum, count), cell| (sum + self.0[cell], count + 1));
        let side = 2.0 / CELLS as f64;
        (sum / (f64::from(count.max(1)) * side * side) / LAYER) as usize
    }

    /// Draws lines of a length, evenly where something is.
    pub(super) fn add(&mut self, at: [f32; 2], size: f64, length: f64) {
        let count = Ink::cells(at, size).count().max(1) as f64;
        Ink::cells(at, size).for_each(|cell| self.0[cell] += length / count);
    }

    /// The cells of the screen that a square covers.
    fn cells(at: [f32; 2], size: f64) -> impl Iterator<Item = usize> {
        let cell = |place: f64| ((place + 1.0) / 2.0 * CELLS as f64).floor().clamp(-1.0, CELLS as f64) as isize;
        let [columns, rows] = at.map(|middle| {
            // Half of the circle's square, so that neighbours that touch do not count.
            let [first, last] = [-0.7, 0.7].map(|side| cell(f64::from(middle) + side * size));
            first.max(0)..=last.min(CELLS as isize - 1)
        });
        rows.flat_map(move |row| columns.clone().map(move |column| row as usize * CELLS + column as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_fill_the_cells_that_they_cross() {
        let mut ink = Ink::default();
        assert_eq!(ink.layers([0.0, 0.0], 0.2), 0);
        // It covers eight cells each way.
        ink.add([0.0, 0.0], 0.2, (8.0 / 24.0_f64).powi(2) * 2.5 * LAYER);
        assert_eq!(ink.layers([0.0, 0.0], 0.2), 2);
        assert_eq!([[0.5, 0.0], [0.0, -0.5], [3.0, 0.0]].map(|at| ink.layers(at, 0.1)), [0; 3]);
        ink.add([5.0, f32::NAN], 1e9, 1.0);
    }
}
