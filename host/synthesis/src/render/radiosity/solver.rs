//! Solves for the light that elements reflect to each other: conjugate gradients with a coarse level.
//!
//! The irradiance I by light of other elements is A I = M (b0 + ρ I), with b0 what elements send before any of it. With
//! y = √ρ I the matrix is symmetric: (A − √ρ M √ρ) y = √ρ M b0, and positive definite where ρ < 1. In a closed room
//! with ρ near 1, its smallest eigenvalues belong to light that is nearly the same everywhere: aggregates of elements,
//! on each of which I is the same, know it, and are solved directly beside a diagonal.

use super::exchange::Exchange;
use crate::color::{Channels, LANES};
use crate::render::RadiosityError;

/// Aggregates of the coarse level, and where a rough solution will do or as much of all light is lost at each reflection.
const AGGREGATES: usize = 24;
const FEW_AGGREGATES: usize = 4;
const ROUGH: f64 = 1e-3;
const LOSSY: f64 = 0.3;
/// Steps at the most.
pub(super) const MOST_STEPS: u32 = 400;

/// A smaller part of light that is lost is none: rounding errors are about as much.
const NO_LOSS: f64 = 1e-13;

/// Light that elements send each other.
#[derive(Clone, Debug)]
pub(super) struct SolvedIrradiance {
    /// Irradiance of each leaf by light of others, W/m².
    pub(super) irradiance: Vec<Channels>,
    pub(super) steps: u32,
    /// A bound of the error of any irradiance, as a part of the greatest.
    pub(super) error: f64,
}

/// The system of equations.
struct System<'a> {
    exchange: &'a Exchange<'a>,
    areas: Vec<f64>,
    /// √ρ
    roots: Vec<Channels>,
    /// The aggregate of each leaf.
    aggregate: Vec<usize>,
    /// For each lane, the factor of the matrix of the aggregates.
    coarse: Vec<Factor>,
}

/// Solves for the irradiance of leaves by light of others.
///
/// - `reflectance`: of each leaf, 0..=1. `sent`: what each sends at first, W/m².
/// - `tolerance`: of the error, as a part of the greatest irradiance.
/// - `stopped`: asked before each step.
///
/// # Errors
/// [`RadiosityError`].
pub(super) fn solve(
    exchange: &Exchange<'_>,
    reflectance: &[Channels],
    sent: &[Channels],
    tolerance: f64,
    stopped: &dyn Fn() -> bool,
) -> Result<SolvedIrradiance, RadiosityError> {
    let greatest = |of: &[Channels]| of.iter().fold(0.0f64, |most, c| most.max(c.max()));
    let is_sound = |c: &Channels| c.is_finite() && c.0.iter().all(|value| *value >= 0.0);
    let most = greatest(reflectance);
    if !reflectance.iter().chain(sent).all(is_sound) || most > 1.0 {
        return Err(RadiosityError::Value { reflectance: most, exitance: greatest(sent) });
    }
    let areas = exchange.areas();
    let roots: Vec<Channels> = reflectance.iter().map(|rho| rho.map(f64::sqrt)).collect();
    let first = exchange.apply(sent);
    let per_area =
        |flux: &[Channels]| -> Vec<Channels> { flux.iter().zip(&areas).map(|(f, a)| *f * a.recip()).collect() };
    if most == 0.0 || greatest(&first) == 0.0 {
        return Ok(SolvedIrradiance { irradiance: per_area(&first), steps: 0, error: 0.0 });
    }
    // With what a leaf sees at the most, no light is reflected more often than this.
    let seen = exchange.apply(&vec![1.0; areas.len()]);
    let losses = seen.iter().zip(&areas).zip(reflectance).map(|((seen, area), rho)| 1.0 - seen / area * rho.max());
    let losses: Vec<f64> = losses.collect();
    if losses.iter().all(|loss| *loss < NO_LOSS) {
        return Err(RadiosityError::NoLoss);
    }
    let least_loss = losses.into_iter().fold(1.0, f64::min).max(f64::EPSILON);
    let count = if tolerance > ROUGH || least_loss > LOSSY { FEW_AGGREGATES } else { AGGREGATES };
    let aggregate = aggregates(exchange, count);
    let mut system = System { exchange, areas: areas.clone(), roots, aggregate, coarse: Vec::new() };
    system.coarse = system.coarse_matrices();
    let right = times(&system.roots, &first);
    let (mut y, mut steps) = (vec![Channels::ZERO; right.len()], 0);
    // The irradiance of a leaf is what it receives, which smooths the last step's error once more.
    let gathered = |y: &[Channels]| {
        let reflected = times(&system.roots, y);
        let all: Vec<Channels> = reflected.iter().zip(sent).map(|(a, b)| *a + *b).collect();
        per_area(&exchange.apply(&all))
    };
    let mut goal = tolerance * least_loss;
    loop {
        steps += system.descend(&right, &mut y, goal, MOST_STEPS - steps, stopped);
        let irradiance = gathered(&y);
        // The residual of the irradiance itself, once it is put in: what one more reflection changes.
        let next = per_area(&exchange.apply(
            &irradiance.iter().zip(reflectance).zip(sent).map(|((i, rho), s)| *i * *rho + *s).collect::<Vec<_>>(),
        ));
        let change = irradiance.iter().zip(&next).map(|(a, b)| (*a - *b).map(f64::abs).max()).fold(0.0, f64::max);
        let error = change / least_loss / greatest(&irradiance).max(f64::MIN_POSITIVE);
        if error <= tolerance || steps >= MOST_STEPS || stopped() || goal < 1e-18 {
            if error >= 1.0 && least_loss < NO_LOSS && !stopped() {
                return Err(RadiosityError::NoLoss);
            }
            let irradiance = next.into_iter().map(|i| i.map(|value| value.max(0.0))).collect();
            return Ok(SolvedIrradiance { irradiance, steps, error });
        }
        goal *= 0.1;
    }
}

fn times(a: &[Channels], b: &[Channels]) -> Vec<Channels> {
    a.iter().zip(b).map(|(a, b)| *a * *b).collect()
}

fn dot(a: &[Channels], b: &[Channels]) -> Channels {
    a.iter().zip(b).fold(Channels::ZERO, |sum, (a, b)| sum + *a * *b)
}

/// A quotient, 0 where nothing is divided.
fn over(a: Channels, b: Channels) -> Channels {
    Channels(std::array::from_fn(|lane| if b.0[lane] > 0.0 { a.0[lane] / b.0[lane] } else { 0.0 }))
}

/// Cuts the hierarchy into a few nodes of about the same area; tells for each leaf which it is below.
fn aggregates(exchange: &Exchange<'_>, count: usize) -> Vec<usize> {
    let nodes = exchange.nodes();
    let mut cut = vec![0usize];
    while cut.len() < count {
        let divisible = cut.iter().enumerate().filter(|(_, node)| !nodes[**node].is_leaf());
        let Some((place, _)) = divisible.max_by(|a, b| nodes[*a.1].area.total_cmp(&nodes[*b.1].area)) else { break };
        let node = cut.swap_remove(place);
        cut.extend(nodes[node].children());
    }
    let mut of = vec![usize::MAX; nodes.len()];
    cut.iter().enumerate().for_each(|(number, node)| of[*node] = number);
    for node in 0..nodes.len() {
        if of[node] != usize::MAX {
            nodes[node].children().for_each(|child| of[child] = of[node]);
        }
    }
    exchange.leaves.iter().map(|leaf| of[*leaf as usize]).collect()
}

impl System<'_> {
    /// (A − √ρ M √ρ) y
    fn apply(&self, y: &[Channels]) -> Vec<Channels> {
        let sent = times(&self.roots, y);
        let received = times(&self.roots, &self.exchange.apply(&sent));
        y.iter().zip(&received).zip(&self.areas).map(|((y, r), area)| *y * *area - *r).collect()
    }

    /// For each lane, what the aggregates are to each other.
    fn coarse_matrices(&self) -> Vec<Factor> {
        let count = self.aggregate.iter().max().map_or(0, |most| most + 1);
        let mut matrices = vec![vec![0.0; count * count]; LANES];
        for column in 0..count {
            let is_in = |(of, root): (&usize, &Channels)| if *of == column { *root } else { Channels::ZERO };
            let unit: Vec<Channels> = self.aggregate.iter().zip(&self.roots).map(is_in).collect();
            let image = times(&self.roots, &self.apply(&unit));
            for (row, value) in self.aggregate.iter().zip(image) {
                matrices.iter_mut().zip(value.0).for_each(|(matrix, value)| matrix[row * count + column] += value);
            }
        }
        matrices.into_iter().map(|matrix| Factor::new(matrix, count)).collect()
    }

    /// About what the inverse does: by the diagonal, and by the aggregates.
    fn precondition(&self, residual: &[Channels]) -> Vec<Channels> {
        let count = self.aggregate.iter().max().map_or(0, |most| most + 1);
        let mut sums = vec![Channels::ZERO; count];
        for ((of, root), value) in self.aggregate.iter().zip(&self.roots).zip(residual) {
            sums[*of] += *root * *value;
        }
        for (lane, factor) in self.coarse.iter().enumerate() {
            let mut values: Vec<f64> = sums.iter().map(|sum| sum.0[lane]).collect();
            factor.solve(&mut values);
            sums.iter_mut().zip(values).for_each(|(sum, value)| sum.0[lane] = value);
        }
        let of =
            |(i, value): (usize, &Channels)| *value * self.areas[i].recip() + self.roots[i] * sums[self.aggregate[i]];
        residual.iter().enumerate().map(of).collect()
    }

    /// Steps of conjugate gradients, all lanes side by side, until no residual is greater than `goal` times the
    /// greatest right side, per area. Tells how many.
    fn descend(&self, right: &[Channels], y: &mut [Channels], goal: f64, most: u32, stopped: &dyn Fn() -> bool) -> u32 {
        let image = self.apply(y);
        let mut residual: Vec<Channels> = right.iter().zip(&image).map(|(a, b)| *a - *b).collect();
        let size = |of: &[Channels]| {
            of.iter().zip(&self.areas).map(|(value, area)| value.map(f64::abs).max() / area).fold(0.0, f64::max)
        };
        let goal = goal * size(right);
        let mut better = self.precondition(&residual);
        let mut direction = better.clone();
        let mut product = dot(&residual, &better);
        for step in 0..most {
            if size(&residual) <= goal || stopped() {
                return step;
            }
            let image = self.apply(&direction);
            let length = over(product, dot(&direction, &image));
            for i in 0..y.len() {
                y[i] += direction[i] * length;
                residual[i] = residual[i] - image[i] * length;
            }
            better = self.precondition(&residual);
            let next = dot(&residual, &better);
            let keep = over(next, product);
            direction.iter_mut().zip(&better).for_each(|(direction, better)| *direction = *better + *direction * keep);
            product = next;
        }
        most
    }
}

/// Cholesky's factor of a small matrix; rows without a pivot are left out.
struct Factor {
    lower: Vec<f64>,
    count: usize,
}

impl Factor {
    fn new(mut matrix: Vec<f64>, count: usize) -> Factor {
        for column in 0..count {
            let whole = matrix[column * count + column];
            let taken: f64 = (0..column).map(|k| matrix[column * count + k].powi(2)).sum();
            let pivot = whole - taken;
            // A pivot that rounding has eaten up would be noise.
            let root = if pivot > 1e-14 * whole.abs() && pivot > 0.0 { pivot.sqrt() } else { 0.0 };
            matrix[column * count + column] = root;
            for row in column + 1..count {
                let taken: f64 = (0..column).map(|k| matrix[row * count + k] * matrix[column * count + k]).sum();
                let value = matrix[row * count + column] - taken;
                matrix[row * count + column] = if root > 0.0 { value / root } else { 0.0 };
            }
        }
        Factor { lower: matrix, count }
    }

    fn solve(&self, values: &mut [f64]) {
        let at = |row: usize, column: usize| self.lower[row * self.count + column];
        for row in 0..self.count {
            let known: f64 = (0..row).map(|k| at(row, k) * values[k]).sum();
            values[row] = if at(row, row) > 0.0 { (values[row] - known) / at(row, row) } else { 0.0 };
        }
        for row in (0..self.count).rev() {
            let known: f64 = (row + 1..self.count).map(|k| at(k, row) * values[k]).sum();
            values[row] = if at(row, row) > 0.0 { (values[row] - known) / at(row, row) } else { 0.0 };
        }
    }
}
