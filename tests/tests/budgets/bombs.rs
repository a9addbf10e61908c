//! Fifty bombs, made anew.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// A small file that asks for much.
pub struct Bomb {
    pub name: &'static str,
    /// Makes the file, and others that it needs, in a folder.
    pub make: fn(&Path),
    /// What is done with it.
    pub command: &'static str,
    /// What standard error holds.
    pub says: &'static str,
}

const fn bomb(name: &'static str, command: &'static str, says: &'static str, make: fn(&Path)) -> Bomb {
    Bomb { name, make, command, says }
}

const CONVERT_PNG: &str = "convert a.png b.exr";
const CONVERT_EXR: &str = "convert a.exr b.png";
const PLAN: &str = "plan a.rhai";
const RENDER: &str = "render a.rhai -o a.png --samples 1";

pub const BOMBS: &[Bomb] = &[
    // Pictures.
    bomb("png: 16k x 16k grey zeros", CONVERT_PNG, "16384 x 16384", |f| png(f, [16_384; 2], 0, 8, 64)),
    bomb("png: 16k x 16k of 64 bits", CONVERT_PNG, "16384 x 16384", |f| png(f, [16_384; 2], 6, 16, 1)),
    bomb("png: header of 2^31 x 2^31", CONVERT_PNG, "rows", |f| {
        png(f, [0x7fff_ffff; 2], 2, 8, 0);
    }),
    bomb("png: one row of 2^28 pixels", CONVERT_PNG, "rows", |f| {
        png(f, [1 << 28, 1], 6, 16, 0);
    }),
    bomb("png: texture of 16k x 16k", PLAN, "16384 x 16384", |f| {
        png(f, [16_384; 2], 2, 8, 1);
        script(f, "sphere(1).material(picture(\"a.png\"));");
    }),
    bomb("png: texture of 8k x 8k of 64 bits", PLAN, "8192 x 8192", |f| {
        png(f, [8192; 2], 6, 16, 1);
        script(f, "sphere(1).material(picture(\"a.png\"));");
    }),
    bomb("png: a text of 200 MB in 200 KB", CONVERT_PNG, "", |f| png_with_text(f, 200 << 20)),
    bomb("exr: 16k x 16k", CONVERT_EXR, "16384 x 16384", |f| exr(f, [16_384; 2], &["A", "B", "G", "R"], None)),
    bomb("exr: a tile of 16k x 16k", CONVERT_EXR, "blocks", |f| {
        exr(f, [16_384; 2], &["A", "B", "G", "R"], Some([16_384; 2]));
    }),
    bomb("exr: header of 2^30 x 2^30", CONVERT_EXR, "window", |f| exr(f, [1 << 30; 2], &["B", "G", "R"], None)),
    bomb("exr: tiles of one pixel", CONVERT_EXR, "", |f| exr(f, [8192; 2], &["B", "G", "R"], Some([1; 2]))),
    bomb("exr: a thousand channels", CONVERT_EXR, "blocks", |f| {
        let names: Vec<String> = (0..1000).map(|n| format!("B{n:04}")).collect();
        let mut all: Vec<&str> = names.iter().map(String::as_str).collect();
        all.extend(["G", "R"]);
        all.insert(0, "B");
        exr(f, [16_384, 4096], &all, None);
    }),
    bomb("exr: 16k x 16k with depth", "compose a.exr over a.exr --depth -o b.exr", "16384 x 16384", |f| {
        exr(f, [16_384; 2], &["B", "G", "R", "Z"], None);
    }),
    bomb("exr: compared with itself", "diff a.exr a.exr", "8192 x 8192", |f| exr(f, [8192; 2], &["B", "G", "R"], None)),
    // Scripts.
    bomb("script: prints a megabyte for ever", PLAN, "", |f| {
        script(f, "let t = \"\"; t.pad(1000000, 'x'); for i in 0..100000 { print(t); }");
    }),
    bomb("script: names of a megabyte", PLAN, "at most 200 characters", |f| {
        script(f, "let t = \"\"; t.pad(1000000, 'x'); for i in 0..60000 { sphere(1).name(t + i); }");
    }),
    bomb("script: lists of long texts", PLAN, "too large", |f| {
        script(f, "let t = \"\"; t.pad(1000000, 'x'); let a = []; for i in 0..16000 { a.push(t + i); }");
    }),
    bomb("script: lists of lists", PLAN, "too large", |f| {
        script(f, "let a = [1]; for i in 0..40 { a = [a, a]; }");
    }),
    bomb("script: maps of maps", PLAN, "", |f| {
        script(f, "let a = #{ a: 1 }; for i in 0..40 { a = #{ a: a, b: a }; }");
    }),
    bomb("script: a text that doubles", PLAN, "too large", |f| {
        script(f, "let t = \"0123456789\"; loop { t += t; }");
    }),
    bomb("script: a million parameters", PLAN, "at most 1000 parameters", |f| {
        script(f, "for i in 0..1000000 { parameter(\"p\" + i, 1, \"one\"); }");
    }),
    bomb("script: meanings of a megabyte", PLAN, "at most 4096 bytes", |f| {
        script(f, "let t = \"\"; t.pad(1000000, 'x'); for i in 0..900 { parameter(\"p\" + i, 1, t); }");
    }),
    bomb("script: functions that keep long texts", PLAN, "more memory than there is", |f| {
        script(f, "let t = \"\"; t.pad(900000, 'x'); let a = []; for i in 0..10000 { let u = t + i; a.push(|| u); }");
    }),
    bomb("script: more objects than there may be", PLAN, "more than 100000 objects", |f| {
        script(f, "for i in 0..200000 { sphere(1).translate(i, 0, 0); }");
    }),
    bomb("script: has no end", PLAN, "does it end", |f| script(f, "loop { }")),
    bomb("script: calls itself", PLAN, "recursion", |f| script(f, "fn f(n) { f(n + 1) } f(0);")),
    bomb("script: a sphere of a tolerance of 1e-9", PLAN, "", |f| {
        script(f, "tolerance(1e-9); sphere(1).translate(1, 0, 0) - box(1, 1, 1);")
    }),
    bomb("script: a torus of a tolerance of 1e-10", "tessellate a.rhai -o a.obj", "", |f| {
        script(f, "tolerance(1e-10); torus(3, 1);");
    }),
    bomb("script: a picture of 16k x 16k", RENDER, "", |f| script(f, "image(16384, 16384); sphere(1); ambient(1);")),
    bomb("script: a surface of 8 million points", PLAN, "", |f| {
        script(
            f,
            "let r = []; for i in 0..10000 { r.push([i, i % 7, 0]); } let a = []; for j in 0..800 { a.push(r); } surface(a);",
        );
    }),
    bomb("script: copies of the bunny", RENDER, "", |f| {
        script(f, "let b = bunny(); for i in 0..5000 { b.copy().translate(i, 0, 0); } ambient(1);");
    }),
    // Meshes.
    bomb("ply: header of 4 thousand million vertices", "check a.ply", "a.ply", |f| {
        ply(f, "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n", &[0; 100]);
    }),
    bomb("ply: a face of 4 thousand million corners", "check a.ply", "a.ply", |f| {
        ply(f, "element face 1\nproperty list uint uint vertex_indices\n", &[0xee; 64]);
    }),
    bomb("stl: header of 4 thousand million triangles", "check a.stl", "a.stl", |f| {
        let mut bytes = vec![b' '; 80];
        bytes.extend(0xeeee_eeee_u32.to_le_bytes());
        bytes.extend([0; 500]);
        write(f, "a.stl", &bytes);
    }),
    bomb("stl: a gigabyte of nothing", "check a.stl", "its content", |f| sparse(f, "a.stl", 1 << 30)),
    bomb("obj: a face of two million corners", "convert a.obj b.stl", "", |f| {
        let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
        (0..2_000_000).for_each(|i| text.push_str([" 1", " 2", " 3"][i % 3]));
        write(f, "a.obj", text.as_bytes());
    }),
    bomb("glb: a length of 4 GB", "check a.glb", "a.glb", |f| {
        let mut bytes = b"glTF\x02\0\0\0\xff\xff\xff\xff\xf0\xff\xff\xffJSON".to_vec();
        bytes.extend(b"{\"asset\":{\"version\":\"2.0\"}}");
        write(f, "a.glb", &bytes);
    }),
    bomb("gltf: an accessor of 4 thousand million", "check a.gltf", "a.gltf", |f| gltf(f, 4_000_000_000, 1)),
    bomb("gltf: accessors without data", "check a.gltf", "", |f| gltf(f, 300_000_000, 0)),
    bomb("gltf: nodes that double 30 times", "check a.gltf", "a.gltf", doubling),
    bomb("gltf: 50,000 instances of 10,000 triangles as one mesh", "check a.gltf", "would take", instanced),
    bomb("gltf: lists in lists", "check a.gltf", "a.gltf", |f| {
        write(f, "a.gltf", "[".repeat(1_000_000).as_bytes());
    }),
    bomb("cmesh: header of 4 thousand million", "check a.cmesh", "a.cmesh", |f| {
        let mut bytes = b"PCM1".to_vec();
        bytes.extend([0xff; 200]);
        write(f, "a.cmesh", &bytes);
    }),
    // Soups of triangles.
    bomb("soup: 100 triangles that cross", "check a.obj --repair b.obj", "is open", |f| soup(f, 100)),
    bomb("soup: 20,000 triangles that cross", "check a.obj --repair b.obj", "crosses itself too often", |f| {
        soup(f, 20_000)
    }),
    bomb("soup: a grid of 300 by 300 slabs", "check a.obj --repair b.obj", "crosses itself too often", slabs),
    // Light, octrees, databases.
    bomb("ies: a thousand million angles", PLAN, "a.ies", |f| {
        let text = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 1000000000 1000000000 1 2 0 0 0\n1 1 100\n0 90\n";
        write(f, "a.ies", text.as_bytes());
        script(f, "luminaire(#{ at: [0, 3, 0], file: \"a.ies\" }); sphere(1);");
    }),
    bomb("ies: two million words", PLAN, "a.ies", |f| {
        let text =
            format!("IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2000 1000 1 2 0 0 0\n1 1 100\n{}", "7 ".repeat(2_000_000));
        write(f, "a.ies", text.as_bytes());
        script(f, "luminaire(#{ at: [0, 3, 0], file: \"a.ies\" }); sphere(1);");
    }),
    bomb("octree: eight gigabytes of nothing", "octree a.octree", "a.octree", |f| sparse(f, "a.octree", 8 << 30)),
    bomb("json: lists in lists", "db add a.redb a.json", "a.json", |f| {
        write(f, "a.json", "[".repeat(1_000_000).as_bytes())
    }),
    bomb("database: a gigabyte of nothing", "db list a.redb", "a.redb", |f| sparse(f, "a.redb", 1 << 30)),
];

fn write(folder: &Path, name: &str, bytes: &[u8]) {
    std::fs::write(folder.join(name), bytes).expect("written");
}

fn script(folder: &Path, text: &str) {
    write(folder, "a.rhai", text.as_bytes());
}

/// A file that is long and takes no place on the disk.
fn sparse(folder: &Path, name: &str, bytes: u64) {
    File::create(folder.join(name)).and_then(|file| file.set_len(bytes)).expect("made");
}

/// A file of zeros as [`zero_png`] makes it.
fn png(folder: &Path, size: [u32; 2], color: u8, depth: u8, rows: u32) {
    write(folder, "a.png", &zero_png(size, color, depth, rows));
}

/// A PNG file of zeros, whose last rows may be missing.
///
/// - `color`: 0 for grey, 2 for red, green and blue, 6 for these and coverage.
/// - `depth`: bits of a number.
pub fn zero_png([width, height]: [u32; 2], color: u8, depth: u8, rows: u32) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut bytes, b"IHDR", &[&width.to_be_bytes()[..], &height.to_be_bytes(), &[depth, color, 0, 0, 0]].concat());
    let bands = [1, 0, 3, 0, 0, 0, 4][usize::from(color)];
    let row = 1 + u64::from(width) * bands * u64::from(depth / 8);
    chunk(&mut bytes, b"IDAT", &zeros(row * u64::from(rows)));
    chunk(&mut bytes, b"IEND", &[]);
    bytes
}

fn png_with_text(folder: &Path, length: u64) {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut bytes, b"IHDR", &[0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0]);
    chunk(&mut bytes, b"zTXt", &[b"Comment\0\0", &zeros(length)[..]].concat());
    chunk(&mut bytes, b"iCCP", &[b"profile\0\0", &zeros(length)[..]].concat());
    chunk(&mut bytes, b"IDAT", &zeros(2));
    chunk(&mut bytes, b"IEND", &[]);
    write(folder, "a.png", &bytes);
}

fn chunk(png: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    png.extend((data.len() as u32).to_be_bytes());
    let begin = png.len();
    png.extend(kind);
    png.extend(data);
    let check = crc(&png[begin..]);
    png.extend(check.to_be_bytes());
}

/// The check number of a chunk of a PNG file.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 })
    })
}

/// So many zeros, deflated to less than a hundredth: a pair of codes stands for 258 of them.
///
/// # Source
/// RFC 1950 and 1951: one block of fixed codes.
fn zeros(count: u64) -> Vec<u8> {
    let mut bits = Bits { bytes: vec![0x78, 0x01], filled: 8 };
    bits.add(0b110, 3);
    let pairs = count.saturating_sub(1) / 258;
    (0..count - 258 * pairs).for_each(|_| bits.add(0b0011_0000, 8));
    for _ in 0..pairs {
        bits.add(0b1100_0101, 8);
        bits.add(0, 5);
    }
    bits.add(0, 7);
    let sum = ((count % 65_521) as u32) << 16 | 1;
    [bits.bytes, sum.to_be_bytes().to_vec()].concat()
}

/// Bits, the lowest of each byte first.
struct Bits {
    bytes: Vec<u8>,
    /// Bits of the last byte that are taken.
    filled: u32,
}

impl Bits {
    /// Adds a code, its highest bit first.
    fn add(&mut self, code: u32, length: u32) {
        for place in (0..length).rev() {
            if self.filled == 8 {
                self.bytes.push(0);
                self.filled = 0;
            }
            if let Some(last) = self.bytes.last_mut() {
                *last |= ((code >> place & 1) as u8) << self.filled;
            }
            self.filled += 1;
        }
    }
}

/// An EXR file without a pixel: its header, and a table of blocks that are nowhere.
fn exr(folder: &Path, [width, height]: [u32; 2], channels: &[&str], tile: Option<[u32; 2]>) {
    let flags = if tile.is_some() { 0x200u32 } else { 0 };
    let mut bytes = [0x0131_2f76u32, 2 | flags].map(u32::to_le_bytes).concat();
    let mut attribute = |name: &str, kind: &str, data: &[u8]| {
        bytes.extend(
            [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &(data.len() as u32).to_le_bytes(), data].concat(),
        );
    };
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    // Numbers of 32 bits, one for each pixel.
    let channel = |name: &&str| [name.as_bytes(), b"\0", &words(&[2, 0, 1, 1])].concat();
    attribute("channels", "chlist", &[channels.iter().flat_map(channel).collect(), vec![0]].concat());
    attribute("compression", "compression", &[3]);
    let window = words(&[0, 0, width - 1, height - 1]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    if let Some(tile) = tile {
        attribute("tiles", "tiledesc", &[words(&tile), vec![0]].concat());
    }
    bytes.push(0);
    bytes.extend([0; 4096]);
    write(folder, "a.exr", &bytes);
}

fn ply(folder: &Path, elements: &str, data: &[u8]) {
    let header = format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n");
    write(folder, "a.ply", &[header.as_bytes(), data].concat());
}

/// A glTF file of triangles whose positions are so many; of no buffer, if `views` is 0.
fn gltf(folder: &Path, count: u64, views: usize) {
    let view = if views == 0 { "" } else { "\"bufferView\":0," };
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{{view}"componentType":5126,"count":{count},"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        "A".repeat(48)
    );
    write(folder, "a.gltf", text.as_bytes());
}

/// A glTF file of a mesh that is placed by a table without data.
fn instanced(folder: &Path) {
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"mesh":0,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":2}}}}}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
        {{"bufferView":1,"componentType":5121,"count":30000,"type":"SCALAR"}},
        {{"componentType":5126,"count":50000,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteLength":30000}}],
        "buffers":[{{"byteLength":30000,"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        "A".repeat(40_000)
    );
    write(folder, "a.gltf", text.as_bytes());
}

/// A glTF file of nodes each of which has the next one twice.
fn doubling(folder: &Path) {
    let mut nodes = String::new();
    for node in 1..=30 {
        let _ = write!(nodes, "{{\"children\":[{node},{node}]}},");
    }
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        "A".repeat(48)
    );
    write(folder, "a.gltf", text.as_bytes());
}

/// Triangles of corners anywhere in a cube.
fn soup(folder: &Path, triangles: u32) {
    let mut file = BufWriter::new(File::create(folder.join("a.obj")).expect("made"));
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(u32::MAX)
    };
    for triangle in 0..triangles {
        for _ in 0..3 {
            writeln!(file, "v {} {} {}", next(), next(), next()).expect("written");
        }
        let first = 3 * triangle + 1;
        writeln!(file, "f {first} {} {}\nf {first} {} {}", first + 1, first + 2, first + 2, first + 1)
            .expect("written");
    }
}

/// Thin boxes that stand upright, each of one direction across each of the other.
fn slabs(folder: &Path) {
    let mut file = BufWriter::new(File::create(folder.join("a.obj")).expect("made"));
    let mut corners = 0;
    for slab in 0..600u32 {
        let low = f64::from(slab / 2) + 0.1;
        let [x, z] = if slab % 2 == 0 { [[low, low + 0.5], [0.0, 301.0]] } else { [[0.0, 301.0], [low, low + 0.5]] };
        for corner in 0..8usize {
            writeln!(file, "v {} {} {}", x[corner & 1], corner >> 1 & 1, z[corner >> 2]).expect("written");
        }
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let [a, b, c, d] = face.map(|corner| corners + corner + 1);
            writeln!(file, "f {a} {b} {c}\nf {a} {c} {d}").expect("written");
        }
        corners += 8;
    }
}
