//! An image for the raster screen of the workstation.

use protocol::raster::{RASTER_HEIGHT, RASTER_WIDTH, RasterCommand, Run};

/// Runs in one command, so that no packet grows large.
const RUNS: usize = 16_384;

/// The operations that show an image, centred on the raster screen; what does not fit is cut off.
///
/// - `pixels`: 8-bit red, green and blue, row by row from the top, as they are to appear on the screen.
pub fn commands(width: u32, height: u32, pixels: &[[u8; 3]]) -> Vec<RasterCommand> {
    let (columns, rows) = (width.min(RASTER_WIDTH), height.min(RASTER_HEIGHT));
    let mut commands = vec![RasterCommand::LookupRamp { min: 0, max: 255 }, RasterCommand::Erase { color: [0; 3] }];
    if columns == 0 || rows == 0 || pixels.len() < width as usize * height as usize {
        return commands;
    }
    let (left, bottom) = ((RASTER_WIDTH - columns) / 2, (RASTER_HEIGHT - rows) / 2);
    let limit = |x: u32| u16::try_from(x).unwrap_or(u16::MAX);
    commands.push(RasterCommand::Window {
        x_min: limit(left),
        y_min: limit(bottom),
        x_max: limit(left + columns - 1),
        y_max: limit(bottom + rows - 1),
    });
    commands.push(RasterCommand::Position { x: limit(left), y: limit(bottom) });
    let (skip_x, skip_y) = (((width - columns) / 2) as usize, ((height - rows) / 2) as usize);
    let mut runs: Vec<Run> = Vec::new();
    // The screen fills upwards, images are stored from the top.
    for row in (0..rows as usize).rev() {
        let start = (skip_y + row) * width as usize + skip_x;
        for &color in &pixels[start..start + columns as usize] {
            match runs.last_mut() {
                Some(run) if run.color == color && run.count < u16::MAX => run.count += 1,
                _ => {
                    if runs.len() == RUNS {
                        commands.push(RasterCommand::Runs(std::mem::take(&mut runs)));
                    }
                    runs.push(Run { count: 1, color });
                }
            }
        }
    }
    commands.push(RasterCommand::Runs(runs));
    commands
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_sent_bottom_row_first_in_runs() {
        let (a, b) = ([1, 2, 3], [4, 5, 6]);
        let commands = commands(3, 2, &[a, a, b, b, b, b]);
        let runs = vec![Run { count: 3, color: b }, Run { count: 2, color: a }, Run { count: 1, color: b }];
        assert_eq!(commands.last(), Some(&RasterCommand::Runs(runs)));
        let window = RasterCommand::Window { x_min: 318, y_min: 239, x_max: 320, y_max: 240 };
        assert_eq!(commands[2], window);
    }

    #[test]
    fn a_large_image_is_cut_around_its_centre() {
        let (width, height) = (RASTER_WIDTH + 2, RASTER_HEIGHT + 2);
        let pixels: Vec<[u8; 3]> = (0..width * height).map(|i| [(i % 251) as u8, (i / 251 % 251) as u8, 7]).collect();
        let sent: u32 = commands(width, height, &pixels)
            .iter()
            .map(|c| if let RasterCommand::Runs(runs) = c { runs.iter().map(|r| u32::from(r.count)).sum() } else { 0 })
            .sum();
        assert_eq!(sent, RASTER_WIDTH * RASTER_HEIGHT);
    }
}
