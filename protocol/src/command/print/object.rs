//! What a name can be, as text.

use super::printer::{List, Number, Printer};
use crate::{
    Name,
    command::{
        syntax::{
            Attributes, Bspline, CornerColor, Fourth, Illumination, Object, Pattern, Polygon, Polynomial, SurfaceColor,
            VectorClass, VectorList,
        },
        words::{self, Word},
    },
};
use glam::{DVec2, DVec3};

impl Printer<'_> {
    pub(super) fn object(&mut self, object: &Object) {
        match object {
            Object::Nil => self.word(Word::Nil),
            Object::BeginStructure => self.word(Word::BeginStructure),
            Object::BeginFont => self.word(Word::BeginFont),
            Object::Instance(names) => self.instance(names),
            Object::VectorList(list) => self.vector_list(list),
            Object::Characters(characters) => {
                self.word(Word::Characters);
                if characters.position != DVec3::ZERO {
                    self.put(format_args!(" {}", List(&characters.position.to_array())));
                }
                if characters.step != DVec2::X {
                    self.put(format_args!(" STEP {}", List(&characters.step.to_array())));
                }
                self.text(" ");
                self.quoted(&characters.text);
            }
            Object::Labels(labels) => {
                self.word(Word::Labels);
                for label in &labels.labels {
                    self.put(format_args!("\n {} ", List(&label.position.to_array())));
                    self.quoted(&label.text);
                }
            }
            Object::Operate { operate, applied_to } => {
                operate.print(self);
                if let Some(name) = applied_to {
                    self.put(format_args!(" APPLIED TO {name}"));
                }
            }
            Object::Function { function, size: None } => self.put(format_args!("F:{function}")),
            Object::Function { function, size: Some(size) } => self.put(format_args!("F:{function}({size})")),
            Object::Alias(name) => {
                // A lone word that is a whole object would be that object.
                let complete = Word::find(words::COMPLETE, name.as_str().as_bytes()).is_some();
                self.put(format_args!("{name}{}", if complete { "," } else { "" }));
            }
            Object::Polygons(polygons) => self.polygons(polygons),
            Object::Attributes(attributes) => self.attributes(attributes),
            Object::Illumination(light) => self.illumination(light),
            Object::Bspline(curve) => self.bspline(curve),
            Object::Polynomial(curve) => self.polynomial(curve),
            Object::Pattern(pattern) => self.pattern(pattern),
            Object::RawBlock(bytes) => self.put(format_args!("RAWBLOCK {bytes}")),
            Object::Copy { source, start, count } => {
                self.put(format_args!("COPY {source} START = {start} COUNT = {count}"));
            }
        }
    }

    fn instance(&mut self, names: &[Name]) {
        self.text("INSTANCE OF");
        if !names.is_empty() {
            self.text(" ");
            self.names(names);
        }
        // A lone name that reads as NIL would mean no name at all.
        if let [only] = names
            && Word::Nil.accepts(only.as_str().as_bytes())
        {
            self.text(",");
        }
    }

    fn vector_list(&mut self, list: &VectorList) {
        self.word(Word::VectorList);
        if list.block_normalized {
            self.text(" BLOCK_NORMALIZED");
        }
        self.text(match list.fourth {
            Fourth::Intensity => "",
            Fourth::Hue => " COLOR",
            Fourth::Table => " TABULATED",
        });
        self.text(match list.class {
            VectorClass::Connected => " CONNECTED_LINES",
            VectorClass::Dots => " DOTS",
            VectorClass::Itemized => " ITEMIZED",
            VectorClass::Separate => " SEPARATE_LINES",
        });
        if list.points.is_empty() && list.dimension == 3 {
            self.text(" Y=0 Z=0");
        }
        if list.internal_units {
            self.text(" INTERNAL_UNITS");
        }
        if let Some(estimate) = list.estimate {
            self.put(format_args!(" N={estimate}"));
        }
        let letter = match list.fourth {
            Fourth::Intensity => 'I',
            Fourth::Hue => 'H',
            Fourth::Table => 'T',
        };
        for (index, &[x, y, z, fourth]) in list.points.iter().enumerate() {
            self.text("\n ");
            if list.class == VectorClass::Itemized {
                self.text(if list.lines.get(index) == Some(&true) { "L " } else { "P " });
            }
            self.put(format_args!("{},{}", Number(x), Number(y)));
            if list.dimension == 3 {
                self.put(format_args!(",{}", Number(z)));
            }
            if fourth != list.fourth.absent() {
                self.put(format_args!(" {letter}={}", Number(fourth)));
            }
        }
    }

    fn polygons(&mut self, polygons: &[Polygon]) {
        for (index, polygon) in polygons.iter().enumerate() {
            self.text(if index > 0 { "\n " } else { "" });
            if let Some(name) = &polygon.attributes {
                self.put(format_args!("WITH ATTRIBUTES {name} "));
            }
            if let Some(hue) = polygon.outline {
                self.put(format_args!("OUTLINE {} ", Number(hue)));
            }
            self.text(if polygon.coplanar { "POLYGON COPLANAR" } else { "POLYGON" });
            for vertex in &polygon.vertices {
                let [x, y, z] = vertex.position.map(Number);
                self.put(format_args!("\n {}{x},{y},{z}", if vertex.soft { "S " } else { "" }));
                if let Some(normal) = vertex.normal {
                    let [x, y, z] = normal.map(Number);
                    self.put(format_args!(" N {x},{y},{z}"));
                }
                if let Some(CornerColor { front, back }) = vertex.color {
                    for (word, color) in [("C", Some(front)), ("AND", back)] {
                        if let Some([h, s, i]) = color.map(|color| color.map(Number)) {
                            self.put(format_args!(" {word} {h},{s},{i}"));
                        }
                    }
                }
            }
        }
    }

    fn attributes(&mut self, attributes: &Attributes) {
        self.word(Word::Attributes);
        self.side(&attributes.front);
        if let Some(back) = &attributes.back {
            self.text(" AND");
            self.side(back);
        }
    }

    fn side(&mut self, side: &SurfaceColor) {
        let SurfaceColor { color, diffuse, specular, opaque } = side;
        self.put(format_args!(" COLOR {} DIFFUSE {}", List(color), Number(*diffuse)));
        self.put(format_args!(" SPECULAR {specular} OPAQUE {}", Number(*opaque)));
    }

    fn illumination(&mut self, light: &Illumination) {
        self.put(format_args!("ILLUMINATION {}", List(&light.direction.to_array())));
        self.put(format_args!(" COLOR {} AMBIENT {}", List(&light.color), Number(light.ambient)));
    }

    /// Rows of curves, with their fourth component if they are rational.
    fn rows(&mut self, dimension: u8, rational: bool, rows: &[[f64; 4]]) {
        for &[x, y, z, w] in rows {
            self.put(format_args!("\n {},{}", Number(x), Number(y)));
            if dimension == 3 {
                self.put(format_args!(",{}", Number(z)));
            }
            if rational {
                self.put(format_args!(",{}", Number(w)));
            }
        }
    }

    fn bspline(&mut self, curve: &Bspline) {
        self.text(if curve.rational { "RATIONAL BSPLINE" } else { "BSPLINE" });
        self.put(format_args!(" ORDER = {}", curve.order));
        self.text(if curve.closed { " CLOSED" } else { " OPEN" });
        self.text(if curve.periodic { " PERIODIC" } else { " NONPERIODIC" });
        if let Some(estimate) = curve.estimate {
            self.put(format_args!(" N = {estimate}"));
        }
        self.text(" VERTICES =");
        self.rows(curve.dimension, curve.rational, &curve.vertices);
        if let Some(knots) = &curve.knots {
            self.put(format_args!("\n KNOTS = {}", List(knots)));
        }
        self.put(format_args!("\n CHORDS = {}", curve.chords));
    }

    fn polynomial(&mut self, curve: &Polynomial) {
        self.text(if curve.rational { "RATIONAL POLYNOMIAL" } else { "POLYNOMIAL" });
        if let Some(order) = curve.order {
            self.put(format_args!(" ORDER = {order}"));
        }
        self.text(" COEFFICIENTS =");
        self.rows(curve.dimension, curve.rational, &curve.coefficients);
        self.put(format_args!("\n CHORDS = {}", curve.chords));
    }

    fn pattern(&mut self, pattern: &Pattern) {
        self.word(Word::Pattern);
        for segment in &pattern.segments {
            self.put(format_args!(" {}", Number(*segment)));
        }
        self.text(if pattern.around_corners { " AROUND_CORNERS" } else { "" });
        self.text(if pattern.matched { " MATCH" } else { " NOMATCH" });
        self.put(format_args!(" LENGTH {}", Number(pattern.length)));
    }
}
