//! An image for the raster screen of the workstation.

use protocol::raster::{RASTER_HEIGHT, RASTER_WIDTH, RasterCommand, Run};

/// Runs in one command, so that no packet grows large.
const RUNS: usize = 16_384;

/// The operations that make the raster screen ready for an image: it is black, and shows numbers as they are.
pub fn begin() -> Vec<RasterCommand> {
    vec![RasterCommand::LookupRamp { min: 0, max: 255 }, RasterCommand::Erase { color: [0; 3] }]
}

/// The operations that show rows of an image, centred on the raster screen; what does not fit is cut off.
///
/// - `pixels`: 8-bit red, green and blue, row by row from the top, as they are to appear on the screen.
/// - `is_shown`: which rows, counted from the top.
pub fn rows([width, height]: [u32; 2], pixels: &[[u8; 3]], is_shown: impl Fn(u32) -> bool) -> Vec<RasterCommand> {
    let (columns, rows) = (width.min(RASTER_WIDTH), height.min(RASTER_HEIGHT));
    let mut commands = Vec::new();
    if columns == 0 || pixels.len() < width as usize * height as usize {
        return commands;
    }
    let (left, bottom) = ((RASTER_WIDTH - columns) / 2, (RASTER_HEIGHT - rows) / 2);
    let (skip_x, skip_y) = ((width - columns) / 2, (height - rows) / 2);
    let limit = |x: u32| u16::try_from(x).unwrap_or(u16::MAX);
    let mut runs: Vec<Run> = Vec::new();
    let mut is_open = false;
    // The screen fills upwards, images are stored from the top.
    for up in 0..rows {
        let row = skip_y + rows - 1 - up;
        if !is_shown(row) {
            is_open = false;
            continue;
        }
        if !is_open {
            is_open = true;
            close(&mut runs, &mut commands);
            let [x_min, y_min] = [left, bottom + up].map(limit);
            let [x_max, y_max] = [left + columns - 1, bottom + rows - 1].map(limit);
            commands.push(RasterCommand::Window { x_min, y_min, x_max, y_max });
            commands.push(RasterCommand::Position { x: x_min, y: y_min });
        }
        let start = row as usize * width as usize + skip_x as usize;
        for &color in &pixels[start..start + columns as usize] {
            match runs.last_mut() {
                Some(run) if run.color == color && run.count < u16::MAX => run.count += 1,
                _ => {
                    if runs.len() == RUNS {
                        close(&mut runs, &mut commands);
                    }
                    runs.push(Run { count: 1, color });
                }
            }
        }
    }
    close(&mut runs, &mut commands);
    commands
}

/// Makes a command of runs, if there are any.
fn close(runs: &mut Vec<Run>, commands: &mut Vec<RasterCommand>) {
    if !runs.is_empty() {
        commands.push(RasterCommand::Runs(std::mem::take(runs)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_sent_bottom_row_first_in_runs() {
        let (a, b) = ([1, 2, 3], [4, 5, 6]);
        let image = [a, a, b, b, b, b];
        let commands = rows([3, 2], &image, |_| true);
        let runs = vec![Run { count: 3, color: b }, Run { count: 2, color: a }, Run { count: 1, color: b }];
        assert_eq!(commands.last(), Some(&RasterCommand::Runs(runs)));
        let window = RasterCommand::Window { x_min: 318, y_min: 239, x_max: 320, y_max: 240 };
        assert_eq!(commands[0], window);
    }

    #[test]
    fn rows_that_are_left_out_are_passed_over() {
        let color = |row: u8| [row, 0, 0];
        let image: Vec<[u8; 3]> = (0..5).flat_map(|row| [color(row); 2]).collect();
        let commands = rows([2, 5], &image, |row| row != 2);
        let begin = |y| RasterCommand::Position { x: 319, y };
        let runs = |rows: [u8; 2]| RasterCommand::Runs(rows.map(|row| Run { count: 2, color: color(row) }).to_vec());
        // From the bottom: rows 4 and 3, then, above a row that stays, 1 and 0.
        let found: Vec<_> = commands.into_iter().filter(|c| !matches!(c, RasterCommand::Window { .. })).collect();
        assert_eq!(found, [begin(237), runs([4, 3]), begin(240), runs([1, 0])]);
    }

    #[test]
    fn a_large_image_is_cut_around_its_centre() {
        let (width, height) = (RASTER_WIDTH + 2, RASTER_HEIGHT + 2);
        let pixels: Vec<[u8; 3]> = (0..width * height).map(|i| [(i % 251) as u8, (i / 251 % 251) as u8, 7]).collect();
        let sent: u32 = rows([width, height], &pixels, |_| true)
            .iter()
            .map(|c| if let RasterCommand::Runs(runs) = c { runs.iter().map(|r| u32::from(r.count)).sum() } else { 0 })
            .sum();
        assert_eq!(sent, RASTER_WIDTH * RASTER_HEIGHT);
    }
}
