//! Scoring of cases.

use super::{Class, CorpusCase, Score, points};
use crate::simple;
use host::mesh::Mesh;
use host::numeric::exact::{ExactNumber, cross, dot};
use host::solid::{Expression, Outcome, Solid};
use std::{panic::catch_unwind, sync::mpsc, time::Duration};

/// Runs a case in a thread of its own. One that takes longer than `limit` is left to itself.
pub fn score(class: &'static Class, number: u32, limit: Duration) -> Score {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        let score = catch_unwind(|| score_case(&class.case(number)).unwrap_or_else(|score| score));
        let _ = sender.send(score.unwrap_or(Score::Crashed));
    });
    receiver.recv_timeout(limit).unwrap_or(Score::TimedOut)
}

fn score_case(case: &CorpusCase) -> Result<Score, Score> {
    match case {
        CorpusCase::Pair { solids, common } => pair(solids, *common)?,
        CorpusCase::Chain(meshes) => chain(meshes)?,
        CorpusCase::Tree { solids, expression, volume } => tree(solids, expression, *volume)?,
        CorpusCase::Single(meshes) => single(meshes)?,
        CorpusCase::NotSimple { mesh, volume } => not_simple(mesh, *volume)?,
    }
    Ok(Score::Passed)
}

fn solid(mesh: &Mesh) -> Result<Solid, Score> {
    Solid::new(mesh.clone()).map_err(|error| Score::Refused(error.to_string()))
}

/// The mesh of what an expression over solids gives, if it is a solid and is marked as one.
///
/// # Errors
/// [`Score::Refused`] with the reason, [`Score::Wrong`] if an exact test finds a fault.
pub fn evaluated(operands: &[&Solid], expression: &Expression) -> Result<Mesh, Score> {
    let evaluated = Solid::evaluate(operands, expression);
    let (solid, Outcome { sources, .. }) = evaluated.map_err(|error| Score::Refused(error.to_string()))?;
    let mesh = solid.into_mesh();
    if sources.len() != mesh.triangles.len() {
        return Err(Score::Wrong("a triangle has no source".into()));
    }
    simple::check(&mesh).map_err(|fault| Score::Wrong(fault.to_string()))?;
    match Solid::new(mesh.clone()) {
        Ok(again) if again.mesh().triangles.len() == mesh.triangles.len() => Ok(mesh),
        Ok(_) => Err(Score::Wrong("the result is not regular".into())),
        Err(error) => Err(Score::Wrong(error.to_string())),
    }
}

/// The volume inside a mesh, without rounding but for the last.
fn volume(mesh: &Mesh) -> f64 {
    let sixfold = (0..mesh.triangles.len()).fold(ExactNumber::default(), |sum, triangle| {
        let [a, b, c] = mesh.corners(triangle).map(|p| p.to_array().map(ExactNumber::from));
        sum + dot(&a, &cross(&b, &c))
    });
    sixfold.over(&ExactNumber::from(6.0))
}

/// What rounding each vertex by some units in its last place can make of a volume.
fn bound(meshes: &[&Mesh]) -> f64 {
    let coordinates = meshes.iter().flat_map(|mesh| &mesh.vertices).map(|v| v.abs().max_element());
    16.0 * f64::EPSILON * coordinates.fold(0.0, f64::max) * meshes.iter().map(|mesh| mesh.area()).sum::<f64>()
}

fn close(what: &str, found: f64, expected: f64, bound: f64) -> Result<(), Score> {
    if (found - expected).abs() <= bound {
        return Ok(());
    }
    Err(Score::Wrong(format!("{what}: {found:e} is not {expected:e} but for {bound:e}")))
}

fn pair(solids: &[Mesh; 2], common: Option<f64>) -> Result<(), Score> {
    let [one, two] = [solid(&solids[0])?, solid(&solids[1])?];
    let (a, b) = (Expression::Operand(0), Expression::Operand(1));
    let both = vec![a.clone(), b.clone()];
    let all = [
        Expression::Union(both.clone()),
        Expression::Intersection(both.clone()),
        Expression::difference(a, b),
        Expression::SymmetricDifference(both),
    ];
    let mut found = [0.0; 4];
    for (volume, expression) in found.iter_mut().zip(&all) {
        *volume = self::volume(&evaluated(&[&one, &two], expression)?);
    }
    let bound = bound(&[one.mesh(), two.mesh()]);
    let [a, b] = [volume(one.mesh()), volume(two.mesh())];
    let [union, intersection, difference, symmetric] = found;
    close("union and intersection", union + intersection, a + b, bound)?;
    close("difference", difference, a - intersection, bound)?;
    close("symmetric difference", symmetric, union - intersection, bound)?;
    if intersection < -bound || difference < -bound || union + bound < a.max(b) {
        return Err(Score::Wrong(format!("union {union:e}, intersection {intersection:e}, difference {difference:e}")));
    }
    common.map_or(Ok(()), |common| close("intersection", intersection, common, bound))
}

fn chain(meshes: &[Mesh]) -> Result<(), Score> {
    let bound = bound(&meshes.iter().collect::<Vec<_>>());
    let solids = meshes.iter().map(solid).collect::<Result<Vec<Solid>, Score>>()?;
    let operands: Vec<&Solid> = solids.iter().collect();
    let (mut step, mut whole) = (solids[0].clone(), Expression::Operand(0));
    for (index, next) in solids.iter().enumerate().skip(1) {
        let combined = |one: Expression, two: Expression| match index % 3 {
            0 => Expression::difference(one, two),
            1 => Expression::Union(vec![one, two]),
            _ => Expression::SymmetricDifference(vec![one, two]),
        };
        step = solid(&evaluated(&[&step, next], &combined(Expression::Operand(0), Expression::Operand(1)))?)?;
        whole = combined(whole, Expression::Operand(index));
        let at_once = volume(&evaluated(&operands[..=index], &whole)?);
        close("step by step", volume(step.mesh()), at_once, bound * index as f64)?;
    }
    Ok(())
}

fn tree(meshes: &[Mesh], expression: &Expression, expected: Option<f64>) -> Result<(), Score> {
    let solids = meshes.iter().map(solid).collect::<Result<Vec<Solid>, Score>>()?;
    let operands: Vec<&Solid> = solids.iter().collect();
    let mesh = evaluated(&operands, expression)?;
    points::compare(meshes, expression, &mesh).map_err(Score::Wrong)?;
    let found = volume(&mesh);
    let bound = bound(&meshes.iter().collect::<Vec<_>>());
    if let Some(expected) = expected {
        return close("the expression", found, expected, bound);
    }
    // It and the rest are all there is.
    let all = Expression::Union((0..meshes.len()).map(Expression::Operand).collect());
    let rest = volume(&evaluated(&operands, &Expression::difference(all.clone(), expression.clone()))?);
    close("the expression and the rest", found + rest, volume(&evaluated(&operands, &all)?), bound)
}

fn single(meshes: &[Mesh; 3]) -> Result<(), Score> {
    let both = || vec![Expression::Operand(0), Expression::Operand(1)];
    let [one, two, third] = [solid(&meshes[0])?, solid(&meshes[1])?, solid(&meshes[2])?];
    let mut rounded = evaluated(&[&one, &two], &Expression::Union(both()))?;
    let exact = volume(&rounded);
    rounded.vertices.iter_mut().for_each(|vertex| *vertex = vertex.as_vec3().as_dvec3());
    let (read, _) = Solid::resolved(rounded.clone()).map_err(|error| Score::Refused(error.to_string()))?;
    simple::check(read.mesh()).map_err(|fault| Score::Wrong(format!("read: {fault}")))?;
    let coarse = f64::from(f32::EPSILON) / f64::EPSILON;
    close("in single precision", volume(read.mesh()), exact, coarse * bound(&[&rounded]))?;
    let [union, common] = [Expression::Union(both()), Expression::Intersection(both())]
        .map(|expression| Ok(volume(&evaluated(&[&read, &third], &expression)?)));
    let bound = bound(&[read.mesh(), third.mesh()]);
    close("union and intersection", union? + common?, volume(read.mesh()) + volume(third.mesh()), bound)
}

fn not_simple(mesh: &Mesh, expected: f64) -> Result<(), Score> {
    if Solid::new(mesh.clone()).is_ok() {
        return Err(Score::Wrong("not refused".into()));
    }
    let (solid, _) = Solid::repaired(mesh.clone()).map_err(|error| Score::Refused(error.to_string()))?;
    simple::check(solid.mesh()).map_err(|fault| Score::Wrong(fault.to_string()))?;
    let again = Solid::new(solid.mesh().clone());
    again.map_err(|error| Score::Wrong(error.to_string()))?;
    close("repaired", volume(solid.mesh()), expected, bound(&[mesh]))
}
