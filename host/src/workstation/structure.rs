//! A scene as a display structure of the PS 340.
//!
//! The modelling space of PERIS is right-handed (z towards the viewer), that of the PS 340 left-handed (z into the
//! screen): every z is negated on the way.

use super::{
    InitialView, WorkstationError,
    facets::{self, mirrored},
    names::{ROOT, name},
    tiles,
};
use crate::{
    illumination::Material,
    mesh::{EdgeSelection, Polylines, Viewer, polylines_of_groups},
    numeric::bounds::Bounds,
    render::tiles::Tiling,
    scene::{Camera, Object, Scene},
    surface::Tolerance,
};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use protocol::{
    Name,
    command::{Axis, Boundaries, Command, NamePattern, Object as Node, Operate, Scopes, VectorClass, VectorList},
};

/// The front boundary is no nearer than this part of the back one, when the camera does not say where it is.
const NEAREST_PART: f64 = 1e-3;
/// How many times farther than the scene nothing is cut, when the camera cuts in front only.
const FAR_REACHES: f64 = 1e6;
/// Working storage that the machine needs for a vertex of a polygon, bytes.
const BYTES_PER_VERTEX: u64 = 50;
/// Intensity at the back of the scene; 1 at its front.
const BACK_INTENSITY: f64 = 0.25;

/// The lines of objects that are sent, and how they are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawing {
    /// The edges of the objects that are sent.
    pub lines: DrawnEdges,
    /// Edges at which two triangles meet at more than this angle are sent whatever `lines` says, degrees.
    pub crease_degrees: f64,
    /// Largest distance between a curved surface and its triangles, as a part of the object's diagonal.
    pub tolerance: f64,
    /// Whether polygons are sent instead of vectors, with materials and lights, below a node `SHADE` that renders them:
    /// a SURFACE_RENDERING. The lines are then those of its pictures without hidden lines.
    pub facets: bool,
}

/// The edges of objects that are sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum DrawnEdges {
    /// Creases, boundaries, and the parameter lines of curved surfaces; all edges of a mesh that has none.
    Grid,
    /// Creases and boundaries, and the outline that the camera sees.
    Outline,
    /// All edges of all triangles.
    All,
}

impl Default for Drawing {
    fn default() -> Drawing {
        Drawing { lines: DrawnEdges::Grid, crease_degrees: 25.0, tolerance: 1.0 / 400.0, facets: false }
    }
}

/// What a scene becomes on the workstation.
#[derive(Clone, Debug, Default)]
pub struct StructureCommands {
    /// The commands, to be sent in order.
    pub commands: Vec<Command>,
    /// Vectors drawn.
    pub lines: usize,
    /// Points sent: lines and moves.
    pub points: usize,
    /// Whether front and back clip.
    pub depth_clipping: bool,
}

/// Deletes whatever a scene has on the workstation: its structure, its networks, and what its polygons look like.
pub fn delete() -> Command {
    Command::Delete(vec![NamePattern::Prefix(ROOT.to_string())])
}

/// Deletes the objects of a scene whose structure is about to be defined anew. Its nodes, and the arcs to them, stay.
pub fn delete_objects() -> Command {
    Command::Delete([format!("{ROOT}.O"), format!("{ROOT}_A")].map(NamePattern::Prefix).into())
}

/// The commands that build the structure [`ROOT`] and display it; [`delete`] comes before them.
///
/// Its nodes `CLIP`, `VIEW`, `LOOK`, `T`, `RX`, `RY`, `RZ`, `S` take values from networks; `MATRIX` is an XFORM
/// MATRIX node below them all, whose matrix takes scene coordinates (z negated) to clip space.
///
/// - `initial`: from where it is seen. `bounds`: a box around what is looked at, over which the depth cue runs.
///
/// # Errors
/// [`WorkstationError::Scene`], if an object cannot be tessellated.
pub fn commands(
    scene: &Scene,
    initial: &InitialView,
    bounds: &Bounds,
    drawing: &Drawing,
) -> Result<StructureCommands, WorkstationError> {
    with_light(scene, initial, bounds, drawing, None)
}

/// The commands that [`commands`] gives, and the light of a solution by radiosity, which the node `SHADE` shades on the
/// raster screen when it gets FIX(5); its polygons are not drawn as vectors.
///
/// # Errors
/// [`WorkstationError::Scene`], if an object cannot be tessellated.
pub fn with_light(
    scene: &Scene,
    initial: &InitialView,
    bounds: &Bounds,
    drawing: &Drawing,
    light: Option<&Tiling>,
) -> Result<StructureCommands, WorkstationError> {
    let camera = &initial.camera;
    let mut out =
        StructureCommands { depth_clipping: camera.far.is_some() || camera.near > 0.0, ..StructureCommands::default() };
    let angle = scene.settings.geometry.angle;
    let objects: Result<Vec<Vec<MaterialPart>>, WorkstationError> = (1..)
        .zip(&scene.objects)
        .map(|(number, object)| data(number, object, angle, camera, drawing, &mut out))
        .collect();
    let shaded = if drawing.facets { out.points } else { light.map_or(0, Tiling::corners) };
    if shaded > 0 {
        let bytes = u32::try_from(shaded as u64 * BYTES_PER_VERTEX).unwrap_or(u32::MAX);
        out.commands.push(Command::ReserveWorkingStorage(bytes));
    }
    begin(&mut out.commands, ROOT);
    view(&mut out.commands, initial, bounds, out.depth_clipping);
    if drawing.facets {
        operate(&mut out.commands, Some("SHADE"), Operate::SurfaceRendering);
        let lights = facets::illumination(&scene.lights, bounds.center());
        let lights = lights.into_iter().map(|light| Command::Define { name: None, object: Node::Illumination(light) });
        out.commands.extend(lights);
    }
    for (number, parts) in (1..).zip(objects?) {
        begin(&mut out.commands, &format!("O{number}"));
        for (k, MaterialPart { material, data }) in (1..).zip(parts) {
            // The colour of vectors has no value: brightness comes from the intensity.
            let [hue, saturation] = facets::hue_saturation(facets::main_color(&material));
            operate(&mut out.commands, None, Operate::SetColor { hue, saturation });
            let node = if k == 1 { "D".to_owned() } else { format!("D{k}") };
            out.commands.push(Command::Define { name: Some(name(&node)), object: data });
        }
        out.commands.push(Command::EndStructure);
    }
    if let Some(light) = light {
        operate(&mut out.commands, None, Operate::SetDisplays { scopes: Scopes::All, on: false });
        operate(&mut out.commands, Some("SHADE"), Operate::SurfaceRendering);
        let polygons = tiles::polygons(light)?;
        out.commands.extend(polygons.into_iter().map(|object| Command::Define { name: None, object }));
    }
    out.commands.push(Command::EndStructure);
    out.commands.push(Command::Display(name(ROOT)));
    Ok(out)
}

fn begin(commands: &mut Vec<Command>, structure: &str) {
    commands.push(Command::Define { name: Some(name(structure)), object: Node::BeginStructure });
}

fn operate(commands: &mut Vec<Command>, node: Option<&str>, operate: Operate) {
    let name: Option<Name> = node.map(name);
    commands.push(Command::Define { name, object: Node::Operate { operate, applied_to: None } });
}

/// Viewport, projection, eye, and what the dials change.
fn view(commands: &mut Vec<Command>, initial: &InitialView, bounds: &Bounds, depth_clipping: bool) {
    let InitialView { camera, center, elongation } = initial;
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    let axes = mirror * initial.axes() * mirror;
    let (horizontal, vertical) = ([-1.0, 1.0], [-1.0, 1.0]);
    operate(commands, None, Operate::Viewport { horizontal, vertical, intensity: Some([BACK_INTENSITY, 1.0]) });
    operate(commands, Some("CLIP"), Operate::SetDepthClipping(depth_clipping));
    let boundaries = Some(boundaries(camera, initial.depth(bounds.center()), bounds.diagonal() / 2.0));
    match camera.parallel {
        None => {
            let angle = 2.0 * (camera.half_tangent() * elongation).atan().to_degrees();
            operate(commands, Some("VIEW"), Operate::FieldOfView { angle, boundaries });
        }
        Some(parallel) => {
            let half = parallel.height / 2.0 * elongation;
            operate(commands, Some("VIEW"), Operate::Window { x: [-half, half], y: [-half, half], boundaries });
        }
    }
    // In the coordinates of the eye: what dials 5 and 6 move goes along the sides of the screen.
    operate(commands, Some("T"), Operate::Translate(DVec3::ZERO));
    let oblique = camera.parallel.map(|parallel| parallel.oblique).filter(|oblique| *oblique != DVec2::ZERO);
    if let Some(oblique) = oblique {
        let distance = DVec3::new(0.0, 0.0, (camera.at - camera.from).length());
        let shear = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(-oblique.x, -oblique.y, 1.0));
        operate(commands, None, Operate::Translate(distance));
        operate(commands, None, Operate::Matrix3(shear));
        operate(commands, None, Operate::Translate(-distance));
    }
    let (at, from) = (mirrored(camera.at), mirrored(camera.from));
    // The workstation takes UP as a point above AT.
    operate(commands, Some("LOOK"), Operate::Look { at, from, up: Some(at + mirrored(camera.up)) });
    operate(commands, None, Operate::Translate(mirrored(*center)));
    operate(commands, None, Operate::Matrix3(axes));
    for (node, axis) in [("RX", Axis::X), ("RY", Axis::Y), ("RZ", Axis::Z)] {
        operate(commands, Some(node), Operate::Rotate { axis, angle: 0.0 });
    }
    operate(commands, Some("S"), Operate::Scale(DVec3::ONE));
    operate(commands, None, Operate::Matrix3(axes.transpose()));
    operate(commands, None, Operate::Translate(mirrored(-*center)));
    operate(commands, Some("MATRIX"), Operate::XformMatrix);
}

/// Front and back for a scene whose middle lies at `depth` from the eye, and which is no larger than a sphere of
/// `radius`.
///
/// Where the camera does not say, the depth cue runs over that sphere. A camera that cuts in front only gets a back so
/// far away that nothing is cut there.
fn boundaries(camera: &Camera, depth: f64, radius: f64) -> Boundaries {
    let reach = (depth.abs() + radius).max(f64::MIN_POSITIVE.sqrt());
    match (camera.near > 0.0, camera.far) {
        (true, Some(back)) => Boundaries { front: camera.near, back },
        (true, None) => Boundaries { front: camera.near, back: FAR_REACHES * reach.max(camera.near) },
        (false, Some(back)) => Boundaries { front: back * NEAREST_PART, back },
        (false, None) => Boundaries { front: (depth - radius).max(reach * NEAREST_PART), back: reach },
    }
}

/// What an object has of one material.
struct MaterialPart {
    material: Material,
    data: Node,
}

/// The vectors or polygons of one object, those of each of its materials; what its polygons look like is defined on the
/// way.
fn data(
    number: usize,
    object: &Object,
    angle: f64,
    camera: &Camera,
    drawing: &Drawing,
    out: &mut StructureCommands,
) -> Result<Vec<MaterialPart>, WorkstationError> {
    let failed = |e: String| WorkstationError::Scene(format!("{}: {e}", object.name));
    let chord = drawing.tolerance * object.shape.extent().unwrap_or(1.0);
    let coarse = object.shape.tessellate(Tolerance::new(chord, angle)).map_err(|e| failed(e.to_string()))?;
    let mesh = coarse.mesh.transformed(&DAffine3::from_mat4(object.transform));
    let (materials, material_of) = object.materials(&coarse.operand_of);
    let selection = match drawing.lines {
        DrawnEdges::Grid => EdgeSelection::grid(drawing.crease_degrees),
        // The machine finds the outline of polygons itself, from wherever they are seen.
        DrawnEdges::Outline if drawing.facets => EdgeSelection::creases(drawing.crease_degrees),
        DrawnEdges::Outline => EdgeSelection::drawing(drawing.crease_degrees, Viewer::Point(camera.from)),
        DrawnEdges::All => EdgeSelection::ALL,
    };
    let mut lines = coarse.lines;
    if !drawing.facets || !lines.points.is_empty() {
        let to_scene = |point: &mut DVec3| *point = object.transform.transform_point3(*point);
        lines.points.iter_mut().for_each(to_scene);
        let mut runs = polylines_of_groups(&mesh, &selection, &material_of, materials.len());
        if let Some(first) = runs.first_mut() {
            first.extend(lines);
        }
        let part = |(material, runs): (Material, &Polylines)| {
            let data = vectors(runs, out).map(Node::VectorList).map_err(failed)?;
            Ok(MaterialPart { material, data })
        };
        return materials.into_iter().zip(&runs).map(part).collect();
    }
    let surface = |k: usize| if k == 0 { format!("{ROOT}_A{number}") } else { format!("{ROOT}_A{number}_{}", k + 1) };
    let surfaces: Vec<String> = (0..materials.len()).map(surface).collect();
    let groups = facets::polygons(&mesh, &selection, &material_of, &surfaces).map_err(failed)?;
    for (surface, material) in surfaces.iter().zip(&materials) {
        let attributes = Node::Attributes(facets::attributes(material));
        out.commands.push(Command::Define { name: Some(name(surface)), object: attributes });
    }
    let corners = 3 * groups.iter().map(Vec::len).sum::<usize>();
    out.points += corners;
    out.lines += corners;
    Ok(materials
        .into_iter()
        .zip(groups)
        .map(|(material, group)| MaterialPart { material, data: Node::Polygons(group) })
        .collect())
}

/// Runs of lines in scene coordinates.
fn vectors(runs: &Polylines, out: &mut StructureCommands) -> Result<VectorList, String> {
    let mut list = VectorList {
        block_normalized: false,
        fourth: protocol::command::Fourth::Intensity,
        internal_units: false,
        class: VectorClass::Itemized,
        dimension: 3,
        estimate: u32::try_from(runs.points.len()).ok(),
        points: Vec::with_capacity(runs.points.len()),
        lines: Vec::with_capacity(runs.points.len()),
    };
    for run in runs.runs() {
        for (i, p) in run.iter().enumerate() {
            let point = mirrored(*p).as_vec3();
            if !point.is_finite() {
                return Err(format!("the point {p} is too far away for the workstation"));
            }
            list.points.push([point.x, point.y, point.z, 1.0]);
            list.lines.push(i > 0);
        }
    }
    out.lines += runs.lines();
    out.points += list.points.len();
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        color::Color,
        illumination::material::Classic,
        scene::{Composite, Operation, Shape},
        solid::Primitive,
    };
    use glam::DMat4;

    /// A red plate with a blue hole.
    fn drilled() -> Scene {
        let operand = |primitive, diffuse| Object {
            name: "operand".into(),
            shape: Shape::from(primitive),
            transform: DMat4::IDENTITY,
            material: Some(Classic { diffuse: Color::Bands(diffuse).into(), ..Classic::default() }.into()),
            tolerance: None,
        };
        let plate = operand(Primitive::Box { size: DVec3::new(4.0, 1.0, 4.0) }, DVec3::X);
        let drill = operand(Primitive::Cylinder { radius: 1.0, height: 3.0 }, DVec3::Z);
        let whole = Composite { operation: Operation::Difference, operands: vec![plate.clone(), drill], nesting: 1 };
        let object = Object { shape: Shape::Composite(Box::new(whole)), material: None, ..plate };
        Scene { objects: vec![object], ..Scene::default() }
    }

    /// What follows each colour: hue, name of the node, number of lines or polygons.
    fn colored(drawing: &Drawing) -> Vec<(f64, String, usize)> {
        let bounds = Bounds::of([DVec3::splat(-2.0), DVec3::splat(2.0)]);
        let initial = InitialView { camera: Camera::framing(&bounds), center: bounds.center(), elongation: 1.0 };
        let out = commands(&drilled(), &initial, &bounds, drawing).unwrap();
        let mut found = Vec::new();
        let mut hue_now = f64::NAN;
        for command in &out.commands {
            let Command::Define { name, object } = command else { continue };
            let named = name.as_ref().map(ToString::to_string).unwrap_or_default();
            match object {
                Node::Operate { operate: Operate::SetColor { hue, .. }, .. } => hue_now = *hue,
                Node::VectorList(list) => {
                    found.push((hue_now, named, list.lines.iter().filter(|line| **line).count()));
                }
                Node::Polygons(polygons) => found.push((hue_now, named, polygons.len())),
                _ => {}
            }
        }
        found
    }

    #[test]
    fn each_material_of_a_composite_has_its_color() {
        let vectors = colored(&Drawing { lines: DrawnEdges::Outline, ..Drawing::default() });
        let [(red, first, edges), (blue, second, rims)] = &vectors[..] else { panic!("{vectors:?}") };
        assert_eq!((*red, first.as_str(), *edges), (120.0, "D", 12));
        assert!((*blue, second.as_str()) == (0.0, "D2") && *rims > 2 * 12, "the rims belong to the hole: {vectors:?}");
        let polygons = colored(&Drawing { facets: true, ..Drawing::default() });
        assert!(matches!(&polygons[..], [(120.0, _, _), (0.0, _, _)]), "{polygons:?}");
    }
}
