//! How full of lines the parts of the screen are.

/// Cells along each side of the screen.
const CELLS: usize = 48;
/// Length of lines for each unit of area, in halves of the side of the screen, on which the next instance is drawn a step
/// coarser: lines of an ordinary width cover a sixth of it then.
const LAYER: f64 = 45.0;

/// Area of a cell, in the square of half the side of the screen.
const CELL_AREA: f64 = (2.0 / CELLS as f64) * (2.0 / CELLS as f64);
/// Half the side of the square inside of a circle, as a part of its radius.
const INSIDE: f64 = std::f64::consts::FRAC_1_SQRT_2;

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
        let (sum, count) = Ink::cells(at, size).fold((0.0, 0), |(sum, count), cell| (sum + self.0[cell], count + 1));
        (sum / (f64::from(count) * CELL_AREA) / LAYER) as usize
    }

    /// Draws lines of a length evenly where something is, as far as that is on the screen.
    pub(super) fn add(&mut self, at: [f32; 2], size: f64, length: f64) {
        let count = Ink::cells(at, size).count() as f64;
        let seen = (count * CELL_AREA / (2.0 * INSIDE * size).powi(2)).min(1.0);
        Ink::cells(at, size).for_each(|cell| self.0[cell] += length * seen / count);
    }

    /// The cells of the screen that a square covers.
    fn cells(at: [f32; 2], size: f64) -> impl Iterator<Item = usize> {
        let cell = |place: f64| ((place + 1.0) / 2.0 * CELLS as f64).clamp(0.0, CELLS as f64 - 1.0) as usize;
        let [columns, rows] = at.map(|middle| {
            // What has its middle outside is drawn at the border.
            let middle = f64::from(middle).clamp(-1.0, 1.0);
            // The square inside of the circle, so that neighbours that touch do not count.
            cell(middle - INSIDE * size)..=cell(middle + INSIDE * size)
        });
        rows.flat_map(move |row| columns.clone().map(move |column| row * CELLS + column))
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
        assert_eq!([[0.5, 0.0], [0.0, -0.5]].map(|at| ink.layers(at, 0.1)), [0; 2]);
        ink.add([1.1, 0.0], 0.1, 0.1 * LAYER);
        assert!(ink.layers([1.05, 0.0], 0.1) > 0 && ink.layers([0.7, 0.0], 0.1) == 0);
        ink.add([5.0, f32::NAN], 1e9, 1.0);
    }
}
