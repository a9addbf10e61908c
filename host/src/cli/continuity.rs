//! `peris continuity`: how smoothly the sculptured surfaces of a scene meet.

use super::{CommandFailure, Exit, SCRIPT_HELP, ScriptArguments, SubcommandRow, load};
use crate::scene::{Object, Sculpture, Shape};
use clap::{Args, FromArgMatches};
use glam::{DAffine3, DMat4};
use std::collections::BTreeMap;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "continuity",
    summary: "Measures along all joints of the sculptured surfaces of a scene the gap, the angle, and the difference of curvatures.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

/// Angle that counts as none, degrees.
const NO_ANGLE: f64 = 1e-6;
/// Difference of curvatures that counts as none, as a part of the curvature, or of that of a sphere around the object.
const NO_DIFFERENCE: f64 = 1e-6;

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "car", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// Points of each joint at which it is measured
    #[arg(long, value_name = "COUNT", default_value_t = 33, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    samples: u32,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

/// The joints between two surfaces of an object, or between the patches of one.
#[derive(Default)]
struct JointGroup {
    joints: usize,
    gap: f64,
    angle: f64,
    curvature_difference: f64,
    curvature: f64,
}

impl JointGroup {
    /// The highest continuity that holds along all of them.
    fn class(&self, extent: f64) -> &'static str {
        if self.angle > NO_ANGLE {
            "G0"
        } else if self.curvature_difference > NO_DIFFERENCE * self.curvature.max(1.0 / extent) {
            "G1"
        } else {
            "G2"
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let scene = load(&arguments.script, &arguments.definitions)?.scene;
    let mut sculptures = Vec::new();
    scene.objects.iter().for_each(|object| collect(object, &DMat4::IDENTITY, &mut sculptures));
    if sculptures.is_empty() {
        let why = "the scene has no sculptured surfaces";
        return Err(CommandFailure::new(Exit::Failed, anyhow::anyhow!(why)));
    }
    let mut rows = Vec::new();
    if !arguments.json {
        say!(
            "{:<16} {:>8} {:>7} {:>10} {:>12} {:>12}",
            "object",
            "surfaces",
            "joints",
            "gap",
            "angle/deg",
            "curvature"
        );
    }
    for (name, sculpture) in sculptures {
        let failed = |error| CommandFailure::new(Exit::Scene, anyhow::anyhow!("{name}: {error}"));
        let mut pairs: BTreeMap<[usize; 2], JointGroup> = BTreeMap::new();
        for joint in sculpture.joints(arguments.samples as usize).map_err(failed)? {
            let [(a, _), (b, _)] = joint.sides;
            let found = pairs.entry([a.min(b), a.max(b)]).or_default();
            found.joints += 1;
            found.gap = found.gap.max(joint.gap);
            found.angle = found.angle.max(joint.angle);
            found.curvature_difference = found.curvature_difference.max(joint.curvature_difference);
            found.curvature = found.curvature.max(joint.curvature);
        }
        for ([a, b], found) in pairs {
            let class = found.class(sculpture.extent());
            let JointGroup { joints, gap, angle, curvature_difference, curvature } = found;
            if !arguments.json {
                let surfaces = if a == b { format!("{a}") } else { format!("{a} - {b}") };
                say!(
                    "{name:<16} {surfaces:>8} {joints:>7} {gap:>10.1e} {angle:>12.1e} {curvature_difference:>12.1e}  {class}"
                );
            }
            rows.push(serde_json::json!({
                "object": name, "surfaces": [a, b], "joints": joints, "gap": gap, "angle_degrees": angle,
                "curvature_difference": curvature_difference, "curvature": curvature, "continuity": class,
            }));
        }
    }
    if arguments.json {
        say!("{:#}", serde_json::Value::from(rows));
    }
    Ok(())
}

/// The sculptures of an object and its operands, placed.
fn collect(object: &Object, to_scene: &DMat4, found: &mut Vec<(String, Sculpture)>) {
    let to_scene = *to_scene * object.transform;
    match &object.shape {
        Shape::Sculpture(sculpture) => {
            found.push((object.name.clone(), sculpture.transformed(&DAffine3::from_mat4(to_scene))));
        }
        Shape::Composite(composite) => composite.operands.iter().for_each(|part| collect(part, &to_scene, found)),
        _ => {}
    }
}
