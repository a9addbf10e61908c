//! Objects of commands become nodes: references are looked up, curves expanded, numbers checked.

use super::Message;
use crate::{
    curve,
    memory::{MassMemory, Refusal},
    port::ObjectId,
    structure::{self, Labels, Node, Operation, Polygons, Vectors},
};
use glam::DVec2;
use protocol::{
    Name,
    command::{
        FontCharacter, Fourth, Object, Operate, Polygon, PolygonVertex, VectorClass, VectorList,
        reference::name_of_operate,
    },
};
use std::collections::{BTreeMap, HashSet};

/// Most bytes of one RAWBLOCK: the mass memory of a large machine of the time, four times. Ours.
const MAX_RAWBLOCK: u32 = 16 << 20;

/// What a name can be made to denote.
#[derive(Debug)]
pub(super) enum Content {
    /// What one command defines.
    Object(Object),
    /// What stood between BEGIN_FONT and END_FONT.
    Font(BTreeMap<u8, FontCharacter>),
    /// A node that needed nothing but its command: a curve.
    Node(Box<Node>),
}

/// Where references are looked up.
#[derive(Clone, Copy)]
pub(super) enum Scope<'a> {
    /// Names are full.
    Outside,
    /// In the structure `path`, of whose whole `names` are named.
    Inside { path: &'a Name, names: &'a HashSet<Name> },
}

impl Scope<'_> {
    /// The full name that a reference means: what is named in the structure first, then in those around it.
    pub(super) fn full(self, reference: &Name) -> Name {
        let Scope::Inside { path, names } = self else { return reference.clone() };
        let mut scope = Some(path.as_str());
        while let Some(outer) = scope {
            let inner = Name::new(outer).and_then(|o| o.join(reference));
            if let Some(found) = inner.ok().and_then(|n| names.get(&n)) {
                return found.clone();
            }
            scope = outer.rsplit_once('.').map(|(rest, _)| rest);
        }
        reference.clone()
    }

    /// The object that a reference means.
    fn object(self, reference: &Name, memory: &mut MassMemory) -> Result<ObjectId, Refusal> {
        memory.object(&self.full(reference))
    }
}

impl Content {
    /// What one command defines, with its numbers checked: in a structure too, a fault is found where it stands.
    ///
    /// - `of`: what to call it in messages.
    ///
    /// # Errors
    /// Numbers that are out of range, or go together to nothing.
    pub(super) fn checked(object: Object, of: impl Fn() -> String) -> Result<Content, Message> {
        let range = |text: String| Message::Range { of: of(), text };
        Ok(match object {
            Object::Bspline(spline) => {
                let expanded = curve::bspline(&spline).map_err(|e| range(e.to_string()))?;
                Content::Node(Box::new(curve(expanded, spline.dimension)))
            }
            Object::Polynomial(polynomial) => {
                let expanded = curve::polynomial(&polynomial).map_err(|e| range(e.to_string()))?;
                Content::Node(Box::new(curve(expanded, polynomial.dimension)))
            }
            Object::Polygons(polygons) => {
                check_polygons(&polygons).map_err(range)?;
                Content::Object(Object::Polygons(polygons))
            }
            Object::Operate { operate, applied_to } => {
                // What a name means is known only where the definition ends up.
                if Operation::named_in(&operate).is_none() {
                    Operation::new(&operate, None, 0).map_err(|e| range(e.to_string()))?;
                }
                Content::Object(Object::Operate { operate, applied_to })
            }
            object => Content::Object(object),
        })
    }

    /// Bytes that it takes beside itself.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Content::Font(font) => font.values().map(font_bytes).sum(),
            Content::Node(node) => node.bytes(),
            Content::Object(object) => match object {
                Object::VectorList(list) => size_of_val(list.points.as_slice()) + list.lines.len(),
                Object::Characters(characters) => characters.text.len(),
                Object::Instance(names) => size_of_val(names.as_slice()),
                Object::Polygons(all) => all.iter().map(polygon_bytes).sum(),
                Object::Labels(l) => {
                    size_of_val(l.labels.as_slice()) + l.labels.iter().map(|l| l.text.len()).sum::<usize>()
                }
                Object::Pattern(pattern) => size_of_val(pattern.segments.as_slice()),
                _ => 0,
            },
        }
    }
}

fn polygon_bytes(polygon: &Polygon) -> usize {
    size_of::<Polygon>() + size_of_val::<[PolygonVertex]>(polygon.vertices.as_slice())
}

/// What a character of a font takes.
pub(super) fn font_bytes(character: &FontCharacter) -> usize {
    size_of::<FontCharacter>() + size_of_val(character.points.as_slice())
}

/// Makes `content` the definition of a name.
pub(super) fn define(
    name: &Name,
    content: Content,
    scope: Scope<'_>,
    memory: &mut MassMemory,
) -> Result<ObjectId, Message> {
    if let Content::Object(Object::Alias(target)) = &content {
        let target = scope.object(target, memory)?;
        return Ok(memory.define_alias(name, target)?);
    }
    let node = node(content, scope, memory)?;
    Ok(memory.define_node(name, node)?)
}

/// The node of a definition that was [checked](Content::checked).
pub(super) fn node(content: Content, scope: Scope<'_>, memory: &mut MassMemory) -> Result<Node, Message> {
    let object = match content {
        Content::Font(font) => return Ok(Node::Font(Box::new(font))),
        Content::Node(node) => return Ok(*node),
        Content::Object(object) => object,
    };
    Ok(match object {
        Object::Nil => Node::Nil,
        Object::Instance(names) => {
            Node::Instance(names.iter().map(|name| scope.object(name, memory)).collect::<Result<_, _>>()?)
        }
        Object::Alias(target) => Node::Instance(vec![scope.object(&target, memory)?]),
        Object::VectorList(list) => Node::Vectors(Box::new(list.into())),
        Object::Characters(characters) => Node::Characters(Box::new(characters)),
        Object::Labels(labels) => Node::Labels(Box::new(Labels {
            labels: labels.labels.into_iter().map(|label| (label, true)).collect(),
            step: DVec2::X,
        })),
        Object::Operate { operate, applied_to } => {
            let operation = operation(name_of_operate(&operate), &operate, scope, memory)?;
            Node::operate(operation, applied_to.map(|below| scope.object(&below, memory)).transpose()?)
        }
        Object::Polygons(polygons) => Node::Polygons(Box::new(self::polygons(polygons, scope, memory)?)),
        Object::Attributes(attributes) => Node::Attributes(attributes),
        Object::Illumination(light) => Node::Illumination(light),
        Object::Pattern(pattern) => Node::Pattern(pattern),
        Object::RawBlock(bytes)
            if bytes > MAX_RAWBLOCK || memory.bytes() + bytes as usize > crate::memory::MASS_MEMORY =>
        {
            return Err(Refusal::Full.into());
        }
        Object::RawBlock(bytes) => Node::RawBlock(vec![0; bytes as usize]),
        Object::Copy { source, start, count } => copy(&scope.full(&source), start, count, memory)?,
        Object::BeginStructure
        | Object::BeginFont
        | Object::Function { .. }
        | Object::Bspline(_)
        | Object::Polynomial(_) => {
            return Err(Message::Structure("this object cannot stand here".into()));
        }
    })
}

/// The operation of an operate command.
///
/// - `of`: of what, for messages.
pub(super) fn operation(
    of: &str,
    operate: &Operate,
    scope: Scope<'_>,
    memory: &mut MassMemory,
) -> Result<Operation, Message> {
    let font = Operation::named_in(operate).map(|font| scope.object(font, memory)).transpose()?;
    let made = Operation::new(operate, font, memory.structures.frame());
    made.map_err(|e| Message::Range { of: of.into(), text: e.to_string() })
}

fn check_polygons(polygons: &[Polygon]) -> Result<(), String> {
    for (number, polygon) in (1..).zip(polygons) {
        let vertices = polygon.vertices.len();
        if !(3..=Polygon::MAX_VERTICES).contains(&vertices) {
            return Err(format!("polygon {number} has {vertices} vertices, not 3 to {}", Polygon::MAX_VERTICES));
        }
        let normals = polygon.vertices.iter().filter(|v| v.normal.is_some()).count();
        if normals != 0 && normals != vertices {
            return Err(format!("polygon {number} has a normal at {normals} of its {vertices} vertices"));
        }
        let colors = polygon.vertices.iter().filter(|v| v.color.is_some()).count();
        if colors != 0 && colors != vertices {
            return Err(format!("polygon {number} has a color at {colors} of its {vertices} vertices"));
        }
    }
    Ok(())
}

/// The polygons with the objects that their attributes are; those hold until others are named.
fn polygons(polygons: Vec<Polygon>, scope: Scope<'_>, memory: &mut MassMemory) -> Result<Polygons, Message> {
    let mut at_hand = None;
    let mut attributes = Vec::with_capacity(polygons.len());
    for polygon in &polygons {
        if let Some(name) = &polygon.attributes {
            at_hand = Some(scope.object(name, memory)?);
        }
        attributes.push(at_hand);
    }
    Ok(Polygons { polygons, attributes })
}

/// A curve as the connected list of its points.
fn curve(expanded: curve::Expanded, dimension: u8) -> Node {
    let list = VectorList {
        block_normalized: false,
        class: VectorClass::Connected,
        dimension,
        estimate: None,
        fourth: Fourth::Intensity,
        internal_units: false,
        points: expanded.points,
        lines: Vec::new(),
    };
    Node::Vectors(Box::new(Vectors { list, parameters: Some(expanded.parameters), dashed: None }))
}

fn copy(source: &Name, start: u32, count: u32, memory: &MassMemory) -> Result<Node, Refusal> {
    let node = memory.target(source).and_then(|id| memory.structures.node(id));
    let node = node.ok_or_else(|| Refusal::NotFound(source.clone()))?;
    structure::copy(node, start, count).map_err(|fault| Refusal::Copy(source.clone(), fault))
}
