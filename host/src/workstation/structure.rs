//! A scene as a display structure of the PS 340.
//!
//! The modelling space of PERIS is right-handed (z towards the viewer), that of the PS 340 left-handed (z into the
//! screen): every z is negated on the way.

use super::{
    Drawing, InitialView, StructureCommands, WorkstationError,
    facets::{self, mirrored},
    flip_book::{self, ChangingObject, FlipBook},
    instancing::{self, CHOSEN_LEVEL, ShownInstances},
    motion,
    names::{DETAIL, ROOT, name},
    parts::{Fineness, MaterialPart, parts},
    tiles,
};
use crate::{
    numeric::bounds::Bounds,
    render::tiles::Tiling,
    scene::{Camera, Object, Scene, Shape},
    surface::Tolerance,
};
use glam::{DMat3, DVec2, DVec3};
use protocol::command::{Axis, Boundaries, Command, NamePattern, Object as Node, Operate, Scopes};
use std::collections::HashMap;

/// The front boundary is no nearer than this part of the back one, when the camera does not say where it is.
const NEAREST_PART: f64 = 1e-3;
/// How many times farther than the scene nothing is cut, when the camera cuts in front only.
const FAR_REACHES: f64 = 1e6;
/// Working storage that the machine needs for a vertex of a polygon, bytes.
const BYTES_PER_VERTEX: u64 = 50;
/// Intensity at the back of the scene; 1 at its front.
const BACK_INTENSITY: f64 = 0.25;

/// Deletes whatever a scene has on the workstation: its structure, its networks, and what its polygons look like.
pub fn delete() -> Command {
    Command::Delete(vec![NamePattern::Prefix(ROOT.to_string())])
}

/// Deletes the objects of a scene whose structure is about to be defined anew, what their polygons look like, what their
/// instances place, and what moves them. Its other nodes, and the arcs to them, stay.
pub fn delete_objects() -> Command {
    let nodes = [motion::NODE_PREFIX, flip_book::PICTURES].map(|node| format!("{ROOT}.{node}"));
    let others = [motion::NETWORK_PREFIX, flip_book::STRUCTURE_PREFIX].map(str::to_owned);
    let objects = [format!("{ROOT}.O"), format!("{ROOT}_A"), format!("{ROOT}_I")];
    Command::Delete(objects.into_iter().chain(nodes).chain(others).map(NamePattern::Prefix).collect())
}

/// The commands that build the structure [`ROOT`] and display it; [`delete`] comes before them.
///
/// Its nodes `CLIP`, `VIEW`, `LOOK`, `T`, `RX`, `RY`, `RZ`, `S` take values from networks; `MATRIX` is an XFORM
/// MATRIX node below them all, whose matrix takes scene coordinates (z negated) to clip space. `PICK` is a SET PICKING,
/// OFF at first: what is picked of object n has the identifier `On`. In a scene with instances, `DETAIL` is a
/// SET LEVEL_OF_DETAIL that all of them obey. What moves alike is in one structure `MOVEn`, whose nodes `T` and `R` a
/// network moves and turns; its commands are the last.
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
    assembled(scene, initial, bounds, drawing, light, Vec::new())
}

/// The commands that [`commands`] gives for the first scene of a flip-book, and the others, which a network shows one after
/// the other. Nothing moves in them otherwise.
///
/// # Errors
/// [`WorkstationError::Scene`], if an object cannot be tessellated, if instances are not the same, or for too many points.
pub fn pictures(
    book: &FlipBook,
    initial: &InitialView,
    bounds: &Bounds,
    drawing: &Drawing,
) -> Result<StructureCommands, WorkstationError> {
    let changing = book.changing()?;
    let (count, drawing) = (changing.len(), Drawing { motion: None, ..*drawing });
    let mut out = assembled(book.first(), initial, bounds, &drawing, None, changing)?;
    if count > 0 {
        let (network, drawn) = book.network(count);
        out.commands.extend(network);
        out.motion = Some(drawn);
    }
    Ok(out)
}

/// - `changing`: objects that are not the same in all pictures of a flip-book, whose first one this is.
fn assembled(
    scene: &Scene,
    initial: &InitialView,
    bounds: &Bounds,
    drawing: &Drawing,
    light: Option<&Tiling>,
    changing: Vec<ChangingObject<'_>>,
) -> Result<StructureCommands, WorkstationError> {
    let camera = &initial.camera;
    let mut out =
        StructureCommands { depth_clipping: camera.far.is_some() || camera.near > 0.0, ..StructureCommands::default() };
    let angle = scene.settings.geometry.angle;
    let made = |object: &Object, surfaces: &str, out: &mut StructureCommands| {
        let fineness = Fineness {
            tolerance: Tolerance::new(drawing.tolerance * object.shape.extent().unwrap_or(1.0), angle),
            eye: camera.from,
            most_triangles: None,
        };
        match object.shape {
            Shape::Instances(_) => Ok(Vec::new()),
            _ => parts(object, surfaces, &fineness, drawing, out),
        }
    };
    let mut stands = vec![true; scene.objects.len()];
    changing.iter().filter(|object| object.index < scene.objects.len()).for_each(|object| stands[object.index] = false);
    let mut objects = Vec::with_capacity(scene.objects.len());
    for ((number, object), stands) in (1..).zip(&scene.objects).zip(&stands) {
        let surfaces = format!("{ROOT}_A{number}");
        objects.push(if *stands { made(object, &surfaces, &mut out)? } else { Vec::new() });
    }
    let mut forms = Vec::new();
    for object in &changing {
        for (number, form) in object.forms.iter().enumerate() {
            let surfaces = format!("{ROOT}_A{}_F{}", object.index + 1, number + 1);
            forms.push((object.index, object.structure(number), made(form, &surfaces, &mut out)?));
            flip_book::check_points(out.points)?;
        }
    }
    let shown = instancing::instances(scene, initial, drawing, out.lines, &mut out)?;
    let mut placed = HashMap::new();
    if let Some(ShownInstances { objects, drawn }) = shown {
        out.lines += drawn.lines;
        out.instances = Some(drawn);
        placed.extend(objects);
    }
    let shaded = if drawing.facets { out.lines } else { light.map_or(0, Tiling::corners) };
    if shaded > 0 {
        let bytes = u32::try_from(shaded as u64 * BYTES_PER_VERTEX).unwrap_or(u32::MAX);
        out.commands.push(Command::ReserveWorkingStorage(bytes));
    }
    for (index, structure, parts) in forms {
        // The level of detail of the root numbers the pictures.
        let level = Operate::SetLevelOfDetail(CHOSEN_LEVEL);
        let level = Command::Define { name: None, object: Node::Operate { operate: level, applied_to: None } };
        let nodes = placed.remove(&index).map(|nodes| std::iter::once(level).chain(nodes).collect());
        self::object(&mut out, &structure, index, parts, nodes);
    }
    flip_book::define_pictures(&changing, &mut out);
    out.begin(ROOT);
    view(&mut out, initial, bounds);
    if drawing.facets {
        out.operate(Some("SHADE"), Operate::SurfaceRendering);
        let lights = facets::illumination(&scene.lights, bounds.center());
        let lights = lights.into_iter().map(|light| Command::Define { name: None, object: Node::Illumination(light) });
        out.commands.extend(lights);
    }
    if out.instances.is_some() {
        out.operate(Some(DETAIL), Operate::SetLevelOfDetail(CHOSEN_LEVEL));
    }
    out.operate(Some("PICK"), Operate::SetPicking(false));
    let moving = if drawing.motion.is_some() { motion::groups(scene) } else { Vec::new() };
    moving.iter().flat_map(|group| &group.objects).for_each(|index| stands[*index] = false);
    for index in (0..objects.len()).filter(|index| stands[*index]) {
        self::object(&mut out, &own(index), index, std::mem::take(&mut objects[index]), placed.remove(&index));
    }
    for (number, group) in (1..).zip(&moving) {
        group.begin(number, &mut out);
        for &index in &group.objects {
            self::object(&mut out, &own(index), index, std::mem::take(&mut objects[index]), placed.remove(&index));
        }
        out.end();
    }
    if !changing.is_empty() {
        flip_book::place_pictures(&changing, &mut out);
    }
    if let Some(light) = light {
        out.operate(None, Operate::SetDisplays { scopes: Scopes::All, on: false });
        out.operate(Some("SHADE"), Operate::SurfaceRendering);
        let polygons = tiles::polygons(light)?;
        out.commands.extend(polygons.into_iter().map(|object| Command::Define { name: None, object }));
    }
    out.end();
    out.commands.push(Command::Display(name(ROOT)));
    if let Some(period) = drawing.motion.filter(|_| !moving.is_empty()) {
        let (network, drawn) = motion::network(&moving, period);
        out.commands.extend(network);
        out.motion = Some(drawn);
    }
    Ok(out)
}

/// The name of an object in the root, and what is picked of it.
///
/// - `index`: its number in the scene, from 0.
fn own(index: usize) -> String {
    format!("O{}", index + 1)
}

/// The structure of an object.
///
/// - `structure`: its name. `index`: the number of the object in the scene, from 0. `placed`: the nodes of its instances, if
///   it has any.
fn object(
    out: &mut StructureCommands,
    structure: &str,
    index: usize,
    parts: Vec<MaterialPart>,
    placed: Option<Vec<Command>>,
) {
    out.begin(structure);
    out.operate(None, Operate::SetPickingIdentifier(name(&own(index))));
    out.commands.extend(placed.into_iter().flatten());
    for (k, MaterialPart { material, data }) in (1..).zip(parts) {
        // The colour of vectors has no value: brightness comes from the intensity.
        let [hue, saturation] = facets::hue_saturation(facets::main_color(&material));
        out.operate(None, Operate::SetColor { hue, saturation });
        let node = if k == 1 { "D".to_owned() } else { format!("D{k}") };
        out.commands.push(Command::Define { name: Some(name(&node)), object: data });
    }
    out.end();
}

/// Viewport, projection, eye, and what the dials change.
fn view(out: &mut StructureCommands, initial: &InitialView, bounds: &Bounds) {
    let InitialView { camera, center, elongation } = initial;
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    let axes = mirror * initial.axes() * mirror;
    let (horizontal, vertical) = ([-1.0, 1.0], [-1.0, 1.0]);
    out.operate(None, Operate::Viewport { horizontal, vertical, intensity: Some([BACK_INTENSITY, 1.0]) });
    out.operate(Some("CLIP"), Operate::SetDepthClipping(out.depth_clipping));
    let boundaries = Some(boundaries(camera, initial.depth(bounds.center()), bounds.diagonal() / 2.0));
    match camera.parallel {
        None => {
            let angle = 2.0 * (camera.half_tangent() * elongation).atan().to_degrees();
            out.operate(Some("VIEW"), Operate::FieldOfView { angle, boundaries });
        }
        Some(parallel) => {
            let half = parallel.height / 2.0 * elongation;
            out.operate(Some("VIEW"), Operate::Window { x: [-half, half], y: [-half, half], boundaries });
        }
    }
    // In the coordinates of the eye: what dials 5 and 6 move goes along the sides of the screen.
    out.operate(Some("T"), Operate::Translate(DVec3::ZERO));
    let oblique = camera.parallel.map(|parallel| parallel.oblique).filter(|oblique| *oblique != DVec2::ZERO);
    if let Some(oblique) = oblique {
        let distance = DVec3::new(0.0, 0.0, (camera.at - camera.from).length());
        let shear = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(-oblique.x, -oblique.y, 1.0));
        out.operate(None, Operate::Translate(distance));
        out.operate(None, Operate::Matrix3(shear));
        out.operate(None, Operate::Translate(-distance));
    }
    let (at, from) = (mirrored(camera.at), mirrored(camera.from));
    // The workstation takes UP as a point above AT.
    out.operate(Some("LOOK"), Operate::Look { at, from, up: Some(at + mirrored(camera.up)) });
    out.operate(None, Operate::Translate(mirrored(*center)));
    out.operate(None, Operate::Matrix3(axes));
    for (node, axis) in [("RX", Axis::X), ("RY", Axis::Y), ("RZ", Axis::Z)] {
        out.operate(Some(node), Operate::Rotate { axis, angle: 0.0 });
    }
    out.operate(Some("S"), Operate::Scale(DVec3::ONE));
    out.operate(None, Operate::Matrix3(axes.transpose()));
    out.operate(None, Operate::Translate(mirrored(-*center)));
    out.operate(Some("MATRIX"), Operate::XformMatrix);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        color::Color,
        illumination::material::Classic,
        scene::{Composite, Object, Operation},
        solid::Primitive,
        workstation::DrawnEdges,
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
