//! Tests of slides: the angle of repose is kept, volume too, nothing overshoots.

use super::account::sum_of;
use super::ground::ErodibleGround;
use super::thermal::Slides;

const SIDE: usize = 41;

fn cone(steepness: f64) -> Vec<f64> {
    let middle = (SIDE / 2) as f64;
    let distance = |k: usize| ((k % SIDE) as f64 - middle).hypot((k / SIDE) as f64 - middle);
    (0..SIDE * SIDE).map(|k| (10.0 - steepness * distance(k)).max(0.0)).collect()
}

fn steepest(bed: &[f64], side: usize) -> f64 {
    let mut most = 0.0_f64;
    for k in 0..bed.len() {
        let (column, row) = (k % side, k / side);
        for (x, z) in [(1, 0), (0, 1), (1, 1), (-1, 1)] {
            let (Some(column), Some(row)) = (column.checked_add_signed(x), row.checked_add_signed(z)) else { continue };
            if column < side && row < side {
                let distance = ((x * x + z * z) as f64).sqrt();
                most = most.max((bed[row * side + column] - bed[k]).abs() / distance);
            }
        }
    }
    most
}

fn slid(heights: &[f64], size: [usize; 2], slides: Slides, steps: usize) -> ErodibleGround {
    let mut ground = ErodibleGround::new(size, heights);
    (0..steps).for_each(|_| slides.step(&mut ground, &|| false));
    ground
}

#[test]
fn a_cone_slides_to_the_angle_of_repose_and_keeps_its_volume() {
    let before = cone(2.0);
    let ground = slid(&before, [SIDE, SIDE], Slides::new(30.0, 1.0, 1.0), 4000);
    let (slope, repose) = (steepest(&ground.bed, SIDE), 30.0_f64.to_radians().tan());
    assert!(slope <= repose * (1.0 + 1e-3) && slope > 0.9 * repose, "{slope} {repose}");
    let [volume, after] = [&before, &ground.bed].map(|heights| sum_of(heights, |height| height));
    assert!((after / volume - 1.0).abs() < 1e-12, "{volume} {after}");
    // As round as eight neighbours allow.
    let (middle, off) = (SIDE / 2, 4);
    let at = |x: usize, z: usize| ground.bed[z * SIDE + x];
    assert_eq!(at(middle + off, middle), at(middle, middle - off));
    assert_eq!(at(middle + off, middle + 1), at(middle - 1, middle - off));
}

#[test]
fn nothing_leaves_the_range_of_its_neighbours() {
    let mut before = vec![0.0; SIDE * SIDE];
    for (k, height) in before.iter_mut().enumerate() {
        *height = ((k * 7919) % 101) as f64 * if k % 3 == 0 { 1e6 } else { 1e-6 };
    }
    for angle in [0.0, 10.0, 89.9] {
        let ground = slid(&before, [SIDE, SIDE], Slides::new(angle, 1.0, 1.0), 1);
        for k in 0..before.len() {
            let (column, row) = (k % SIDE, k / SIDE);
            let near = |of: usize, at: usize| at.abs_diff(of) < 2;
            let around = before.iter().enumerate().filter(|(j, _)| near(j % SIDE, column) && near(j / SIDE, row));
            let [low, high] = around.fold([f64::MAX, f64::MIN], |[a, b], (_, h)| [a.min(*h), b.max(*h)]);
            assert!(ground.bed[k] >= low - 1e-6 && ground.bed[k] <= high + 1e-6, "{angle} {k}");
        }
    }
    let flat = slid(&before, [SIDE, SIDE], Slides::new(0.0, 1.0, 1.0), 6000);
    assert!(steepest(&flat.bed, SIDE) < 1e-3 * 1e8, "an angle of 0 levels out");
}

#[test]
fn a_single_row_and_gentle_slopes_are_no_trouble() {
    let before: Vec<f64> = (0..50).map(|k| if k == 20 { 30.0 } else { 0.0 }).collect();
    let ground = slid(&before, [50, 1], Slides::new(45.0, 1.0, 1.0), 3000);
    assert!(ground.bed.windows(2).all(|pair| (pair[0] - pair[1]).abs() <= 1.0 + 1e-3));
    assert!((ground.bed.iter().sum::<f64>() - 30.0).abs() < 1e-12);
    let gentle = cone(0.5);
    assert_eq!(slid(&gentle, [SIDE, SIDE], Slides::new(30.0, 1.0, 1.0), 5).bed, gentle);
}
