//! Facts about databases.

use super::*;
use crate::color::shipped::ComplexIndex;
use crate::color::{Color, Extrapolation, Origin, Spectrum, shipped as colors};
use crate::encoding::{Integers, decode, encode};
use crate::illumination::distribution::Tabulated;
use crate::illumination::light::{Goniometry, Light, LightShape, SkyMap};
use crate::illumination::material::{
    Classic, Coated, Distributed, DistributionForm, Material, MaterialKind, RefractiveIndex, Transparent,
};
use crate::illumination::texture::{Motif, Paint, Pattern, TextureMapping};
use crate::mesh::{self, Grouped, Mesh, MetallicRoughness};
use crate::picture::Picture;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::path::Path;
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

fn origin() -> Origin {
    Origin { what: "A thing.".into(), source: "Ours.".into(), terms: "MIT or Apache-2.0.".into() }
}

fn record(name: &str, content: RecordContent) -> Record {
    Record { name: name.into(), origin: origin(), content }
}

fn material(name: &str, diffuse: f64) -> Record {
    let classic = Classic { diffuse: Color::grey(diffuse).into(), ..Classic::default() };
    record(name, RecordContent::Material(Box::new(classic.into())))
}

fn square() -> Grouped {
    let mesh = Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::new(0.0, 1.0, 0.1 + 0.2)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        corner_normals: vec![[DVec3::Z; 3]; 2],
        corner_parameters: vec![[DVec2::new(0.25, 0.5); 3]; 2],
        surfaces: vec![0, 1],
    };
    let look = MetallicRoughness { base: DVec3::new(0.1, 0.2, 0.3), metallic: 0.0, roughness: 0.5 };
    Grouped { mesh, names: vec!["a".into(), "b".into()], materials: vec![Some(look), None] }
}

fn picture() -> Picture {
    let mut picture = Picture::new(3, 2).expect("a picture");
    for (index, pixel) in picture.pixels_mut().iter_mut().enumerate() {
        (pixel.radiance, pixel.coverage) = ([index as f32 / 7.0, 0.1, 2.5], 1.0);
    }
    picture
}

/// Materials and lights of every form.
fn many() -> Vec<Record> {
    let copper = colors::metal("copper").expect("copper");
    let red = Color::Spectrum(colors::reflectance("red_brick").expect("a brick"));
    let table = Tabulated::new("mine", 4, |_, view| view.z).expect("a table");
    let glass = RefractiveIndex::Dispersive(colors::glass("SF11").expect("a glass"));
    let coat = Coated { diffuse: red.clone().into(), index: 1.5, roughness: 0.1.into() };
    let bodies = [
        MaterialKind::Coated(coat.clone()),
        MaterialKind::Shaped(Distributed { reflectance: red.clone().into(), form: DistributionForm::Table(table) }),
        MaterialKind::Transparent(Transparent { absorption: Color::grey(0.25), ..Transparent::clear(glass) }),
    ];
    let table = Goniometry::new(vec![0.0, 90.0], vec![0.0], vec![100.0, 0.0]).expect("a table");
    let luminaire = Light::Luminaire {
        at: DVec3::Y,
        down: DVec3::NEG_Y,
        front: DVec3::Z,
        goniometry: table,
        color: Color::grey(1.0),
    };
    let disc = LightShape::Disc { center: DVec3::Y, normal: DVec3::NEG_Y, radius: 0.5 };
    let lamp =
        Light::Lamp { patch: disc, radiance: Color::grey(2.0), material: Box::new(MaterialKind::Coated(coat).into()) };
    let lights = [luminaire, Light::Area { patch: disc, radiance: red }, lamp];
    let functions = Curves::Functions(vec![("x".into(), colors::D65.clone()), ("y".into(), copper.k.clone())]);
    let mut all = vec![
        record("square", RecordContent::Geometry(Box::new(square()))),
        record("checks", RecordContent::Texture(Box::new(picture()))),
        material("grey", 0.5),
        record("D65", RecordContent::Spectrum(Curves::Light(colors::D65.clone()))),
        record("copper", RecordContent::Spectrum(Curves::Metal(copper))),
        record("functions", RecordContent::Spectrum(functions)),
    ];
    let number = |index: usize, content| record(&format!("thing {index}"), content);
    all.extend(
        bodies.into_iter().enumerate().map(|(i, body)| number(i, RecordContent::Material(Box::new(body.into())))),
    );
    all.extend(lights.into_iter().enumerate().map(|(i, light)| number(i, RecordContent::Light(Box::new(light)))));
    all.push(record("beam", RecordContent::Photons(Box::new(beam()))));
    all
}

fn beam() -> StoredPhotons {
    let block = PhotonBlock {
        target: 1,
        number: 2,
        paths: 1024,
        balance: [1.0, 0.5, -0.1, 0.2, 0.9, 0.2, 0.1, 0.0],
        positions: vec![[0.1, 0.2, -0.3], [1e9, 0.0, 0.0]],
        towards: vec![[0.0, 1.0, 0.0], [0.6, 0.8, 0.0]],
        flux: vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
        sides: vec![3, 77],
        wavelength_sets: vec![0, 0x83],
    };
    StoredPhotons { lanes: 3, blocks: vec![block] }
}

fn filled(path: &Path) -> Vec<Record> {
    let records = many();
    Store::open_to_write(path).expect("a new database").add(&records, false).expect("added");
    records
}

#[test]
fn every_kind_of_record_comes_back_to_the_last_bit() {
    let folder = folder();
    let path = folder.path().join("a.redb");
    let records = filled(&path);
    let store = Store::open(&path).expect("it is there");
    for record in &records {
        assert_eq!(&store.record(record.kind(), &record.name).expect("it is there"), record);
    }
    let entries = store.entries(None).expect("a list");
    assert_eq!(entries.len(), records.len());
    for RecordEntry { kind, name, summary, source, terms, bytes, .. } in entries {
        let record = store.record(kind, &name).expect("it is there");
        assert_eq!((summary, &*source, &*terms), (record.content.summary(), "Ours.", "MIT or Apache-2.0."));
        assert!(bytes > 0);
    }
    assert_eq!(
        DatabaseReport::of(&path).expect("a report"),
        DatabaseReport { whole: records.len(), ..DatabaseReport::default() }
    );
}

#[test]
fn everything_that_ships_is_whole_and_tells_its_source() {
    let all = shipped::entries(None);
    assert_eq!(all.len(), usize::from(cfg!(feature = "bunny")) + 46 + 5 + 26 + 70 + 2);
    for entry in &all {
        assert!(!entry.source.is_empty() && !entry.terms.is_empty() && !entry.summary.is_empty(), "{entry:?}");
        let record = shipped::record(entry.kind, &entry.name).expect("it ships");
        let bytes = record.to_bytes().expect("it can be stored");
        assert_eq!(Record::of_bytes(entry.kind, &entry.name, &bytes).expect("whole"), record);
    }
    let message = shipped::record(RecordKind::Material, "walnut").expect_err("unknown").to_string();
    assert!(message.starts_with("no material is called \"walnut\"; there are copper, gold,"), "{message}");
}

#[test]
#[cfg(not(feature = "bunny"))]
fn a_bunny_that_was_left_out_is_told_with_the_feature() {
    assert_eq!(shipped::names(RecordKind::Geometry), [""; 0]);
    let error = shipped::find(RecordKind::Geometry, "bunny").expect_err("it was left out").to_string();
    assert!(error.contains("feature `bunny`"), "{error}");
}

#[test]
fn a_record_is_replaced_or_removed_only_when_that_is_asked_for() {
    let folder = folder();
    let store = Store::open_to_write(folder.path().join("a.redb")).expect("a new database");
    store.add(&[material("paint", 0.5)], false).expect("added");
    let error = store.add(&[material("other", 0.1), material("paint", 0.2)], false).expect_err("there is one");
    assert_eq!(error.to_string(), "there is a material \"paint\" already");
    assert_eq!(store.names(RecordKind::Material).expect("names"), ["paint"], "nothing of the transaction is left");
    store.add(&[material("paint", 0.2)], true).expect("replaced");
    assert_eq!(store.record(RecordKind::Material, "paint").expect("there"), material("paint", 0.2));
    let error =
        store.remove(&[(RecordKind::Material, "paint"), (RecordKind::Material, "varnish")]).expect_err("unknown");
    assert!(error.to_string().starts_with("no material is called \"varnish\""), "{error}");
    assert_eq!(store.names(RecordKind::Material).expect("names"), ["paint"]);
    store.remove(&[(RecordKind::Material, "paint")]).expect("removed");
    assert_eq!(store.entries(None).expect("a list"), []);
}

#[test]
fn patterns_without_end_are_refused_when_they_are_read() {
    let plain = Paint::Plain(Color::grey(0.5));
    let nested = |depth: usize| {
        (0..depth).fold(plain.clone(), |paint, _| {
            let paints = vec![paint, plain.clone()];
            Paint::Pattern(Box::new(Pattern { motif: Motif::Checker, laying: TextureMapping::default(), paints }))
        })
    };
    let read = |depth: usize| {
        let bytes = encode(&nested(depth), Integers::Compact).expect("bytes");
        decode::<Paint, 1_000_000>(&bytes, Integers::Compact).map(|(paint, _)| paint)
    };
    assert_eq!(read(10).expect("a pattern"), nested(10));
    assert!(read(1000).is_err_and(|error| error.to_string().contains("nested")));
}

#[test]
fn names_are_checked() {
    let folder = folder();
    let store = Store::open_to_write(folder.path().join("a.redb")).expect("a new database");
    let longest = "n".repeat(LONGEST_NAME);
    for name in ["", " a", "a ", "a\nb", "a\0", &"n".repeat(LONGEST_NAME + 1)] {
        assert!(matches!(store.add(&[material(name, 0.5)], false), Err(DatabaseError::Name(_))), "{name:?}");
    }
    for name in ["a", "Nußbaum", "two words", "../x", &longest] {
        store.add(&[material(name, 0.5)], false).expect(name);
    }
    assert_eq!(store.names(RecordKind::Material).expect("names").len(), 5);
}

#[test]
fn impossible_content_is_not_stored() {
    let folder = folder();
    let store = Store::open_to_write(folder.path().join("a.redb")).expect("a new database");
    let map = SkyMap { file: "evening.exr".into(), ..SkyMap::default() };
    let sky = Light::Sky { map: Some(map), radiance: Color::grey(1.0), turned: 0.0 };
    let mut open = square();
    open.mesh.triangles[0] = [0, 1, 9];
    let bright = Spectrum::regular(400.0, 10.0, vec![0.5, 1.5], Extrapolation::Held).expect("a spectrum");
    for content in [
        RecordContent::Light(Box::new(sky)),
        RecordContent::Geometry(Box::new(open)),
        RecordContent::Spectrum(Curves::Reflectance(bright)),
        RecordContent::Spectrum(Curves::Functions(Vec::new())),
        RecordContent::Photons(Box::new(StoredPhotons {
            blocks: vec![PhotonBlock { flux: vec![1.0], ..PhotonBlock::default() }],
            ..beam()
        })),
        RecordContent::Material(Box::new(Material { emission: Color::grey(-1.0), ..Material::default() })),
    ] {
        let error = store.add(&[record("x", content)], false).expect_err("impossible");
        assert!(matches!(error, DatabaseError::Record { .. }), "{error}");
    }
    assert_eq!(store.entries(None).expect("a list"), []);
}

#[test]
fn a_record_of_a_later_program_is_named_and_the_others_can_be_had() {
    let folder = folder();
    let path = folder.path().join("a.redb");
    let store = Store::open_to_write(&path).expect("a new database");
    store.add(&[material("now", 0.5)], false).expect("added");
    let mut later = material("later", 0.5).to_bytes().expect("bytes");
    later[0] += 1;
    store.put_bytes(RecordKind::Material, "later", &later).expect("written");
    let message = store.record(RecordKind::Material, "later").expect_err("newer").to_string();
    assert_eq!(message, "material \"later\" has the form 4; this program knows forms up to 3. Use a later one");
    assert!(store.record(RecordKind::Material, "now").is_ok());
    drop(store);
    let report = DatabaseReport::of(&path).expect("a report");
    assert_eq!((report.whole, report.problems.len(), report.is_whole()), (1, 1, false));
    assert_eq!(report.problems[0].name, "later");
}

#[test]
fn stored_forms_have_not_changed_without_a_new_version() {
    // When this fails, records of before cannot be read any more: raise the version of the kind, and read the old form.
    let sum = |record: &Record| crc32fast::hash(&record.to_bytes().expect("bytes"));
    // The table of a distribution holds sines, which may differ in the last bit from machine to machine.
    let is_table = |record: &Record| record.kind() == RecordKind::Material && record.name == "thing 1";
    let sums: Vec<u32> = many().iter().filter(|record| !is_table(record)).map(sum).collect();
    assert_eq!(sums, SUMS, "{sums:?}");
}

const SUMS: [u32; 12] = [
    1872215458, 1801010235, 3640075512, 634917729, 2474976611, 2318298726, 608143039, 2628831415, 3684917333,
    1684273069, 693977362, 3506456096,
];

#[test]
fn materials_of_the_first_form_are_read() {
    use super::materials_v1::{BodyV1 as First, MaterialV1 as FirstMaterial};
    let glass = RefractiveIndex::Dispersive(colors::glass("SF11").expect("a glass"));
    let red = Color::Spectrum(colors::reflectance("red_brick").expect("a brick"));
    let paints = || [0.0; 3].map(Paint::grey);
    let [specular, mirror, transparency] = paints();
    // The sums with which these records were stored by programs that knew no other form.
    for (name, body, sum) in [
        (
            "grey",
            First::Classic { diffuse: Paint::grey(0.5), specular, exponent: 50.0, mirror, transparency },
            2680844193,
        ),
        ("thing 0", First::Coated { diffuse: red.into(), index: 1.5, roughness: 0.1 }, 4158595621),
        ("thing 2", First::Transparent { index: glass, roughness: 0.0, absorption: Color::grey(0.25) }, 3341079355),
    ] {
        let now = many().into_iter().find(|r| r.name == name && r.kind() == RecordKind::Material).expect("it is there");
        let first = FirstMaterial { body, emission: Color::BLACK, relief: None };
        let bytes = record::earlier_for_tests(&now, 1, &first);
        assert_eq!(crc32fast::hash(&bytes), sum, "{name}");
        assert_eq!(Record::of_bytes(RecordKind::Material, name, &bytes).expect("whole"), now);
    }
}

#[test]
fn materials_of_the_second_form_are_read() {
    use super::materials_v2::{BodyV2 as Second, MaterialV2 as SecondMaterial};
    let glass = RefractiveIndex::Dispersive(colors::glass("SF11").expect("a glass"));
    let red = Color::Spectrum(colors::reflectance("red_brick").expect("a brick"));
    let grey = Classic { diffuse: Color::grey(0.5).into(), ..Classic::default() };
    let clear = Second::Transparent { index: glass, roughness: 0.0.into(), absorption: Color::grey(0.25), priority: 0 };
    // The sums with which these records were stored by programs that knew no later form.
    for (name, body, sum) in [
        ("grey", Second::Classic(grey), 164064954),
        ("thing 0", Second::Coated(Coated { diffuse: red.into(), index: 1.5, roughness: 0.1.into() }), 720515940),
        ("thing 2", clear, 1995761753),
    ] {
        let now = many().into_iter().find(|r| r.name == name && r.kind() == RecordKind::Material).expect("it is there");
        let second = SecondMaterial { body, emission: Color::BLACK, relief: None };
        let bytes = record::earlier_for_tests(&now, 2, &second);
        assert_eq!(crc32fast::hash(&bytes), sum, "{name}");
        assert_eq!(Record::of_bytes(RecordKind::Material, name, &bytes).expect("whole"), now);
    }
}

#[test]
fn lights_of_the_first_form_are_read() {
    // The sums with which these records were stored by programs that knew no lamps that reflect.
    for (name, sum) in [("thing 0", 183571543), ("thing 1", 1195059199)] {
        let now = many().into_iter().find(|r| r.name == name && r.kind() == RecordKind::Light).expect("it is there");
        let RecordContent::Light(light) = &now.content else { panic!("{name}") };
        let bytes = record::earlier_for_tests(&now, 1, light);
        assert_eq!(crc32fast::hash(&bytes), sum, "{name}");
        assert_eq!(Record::of_bytes(RecordKind::Light, name, &bytes).expect("whole"), now);
    }
}

#[test]
fn a_record_under_another_name_is_damaged() {
    let bytes = material("paint", 0.5).to_bytes().expect("bytes");
    assert!(Record::of_bytes(RecordKind::Material, "paint", &bytes).is_ok());
    assert!(Record::of_bytes(RecordKind::Material, "pain", &bytes).is_err());
    assert!(Record::of_bytes(RecordKind::Light, "paint", &bytes).is_err());
}

proptest! {
    #[test]
    fn any_change_of_a_record_is_found(which in 0_usize..13, at in any::<prop::sample::Index>(), flip in 1_u8..) {
        let record = &many()[which];
        let mut bytes = record.to_bytes().expect("bytes");
        let at = at.index(bytes.len());
        bytes[at] ^= flip;
        prop_assert!(Record::of_bytes(record.kind(), &record.name, &bytes).is_err());
        prop_assert!(Record::of_bytes(record.kind(), &record.name, &bytes[..at]).is_err());
    }

    #[test]
    fn any_bytes_are_a_record_or_an_error(mut bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        for kind in RecordKind::ALL {
            if let Some(version) = bytes.get_mut(..4) {
                version.copy_from_slice(&[1, 0, 0, 0]);
            }
            // The checksum is made right, so that the content is read.
            let sum = record::checksum_for_tests(kind, "x", &bytes);
            if let Some(place) = bytes.get_mut(4..8) {
                place.copy_from_slice(&sum.to_le_bytes());
            }
            let _ = Record::of_bytes(kind, "x", &bytes);
            let _ = RecordEntry::of_bytes(kind, "x", &bytes);
        }
    }

    #[test]
    fn spectra_come_back_to_the_last_bit(values in prop::collection::vec(0.0_f64..=1.0, 2..50), first in 1.0_f64..900.0, step in 0.1_f64..20.0) {
        let spectrum = Spectrum::regular(first, step, values, Extrapolation::Held).expect("a spectrum");
        let record = record("any", RecordContent::Spectrum(Curves::Reflectance(spectrum)));
        let bytes = record.to_bytes().expect("bytes");
        prop_assert_eq!(Record::of_bytes(RecordKind::Spectrum, "any", &bytes).expect("whole"), record);
    }
}

#[test]
fn flipped_bytes_of_the_file_are_an_error_or_harmless_but_never_wrong() {
    let folder = folder();
    let path = folder.path().join("a.redb");
    let records = filled(&path);
    let whole = std::fs::read(&path).expect("a file");
    let damaged = folder.path().join("b.redb");
    let mut stream = 0x9e37_79b9_7f4a_7c15_u64;
    let (mut clean, mut refused) = (0, 0);
    for round in 0..400 {
        let mut bytes = whole.clone();
        for _ in 0..1 + round % 8 {
            stream = stream.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // Half of them where the pages begin, that is where the structure is.
            let far = if round % 2 == 0 { bytes.len() } else { bytes.len().min(8192) };
            let at = (stream >> 20) as usize % far;
            bytes[at] ^= (stream >> 8) as u8 | 1;
        }
        std::fs::write(&damaged, &bytes).expect("written");
        if let Ok(store) = Store::open(&damaged) {
            let _ = store.entries(None);
            for record in &records {
                if let Ok(Some(found)) = store.find(record.kind(), &record.name) {
                    assert_eq!(&found, record, "a record came back, but another one");
                }
            }
        }
        match DatabaseReport::of(&damaged) {
            Ok(report) if report.is_whole() && report.whole == records.len() => clean += 1,
            Ok(_) | Err(_) => refused += 1,
        }
    }
    println!("{clean} clean, {refused} refused");
    assert!(refused > 100, "{clean} clean, {refused} refused");
}

#[test]
fn cut_files_and_other_files_are_errors() {
    let folder = folder();
    let path = folder.path().join("a.redb");
    filled(&path);
    let whole = std::fs::read(&path).expect("a file");
    let other = folder.path().join("b.redb");
    for length in [1, 9, 100, 4096, whole.len() / 2] {
        std::fs::write(&other, &whole[..length]).expect("written");
        assert!(Store::open(&other).and_then(|store| store.entries(None)).is_err(), "{length} bytes");
        assert!(DatabaseReport::of(&other).map_or(true, |report| !report.is_whole()), "{length} bytes");
    }
    std::fs::write(&other, "# not a database\n".repeat(1000)).expect("written");
    assert!(matches!(Store::open(&other), Err(DatabaseError::Other { .. })));
    assert!(matches!(Store::open_to_write(&other), Err(DatabaseError::Other { .. })));
    assert!(matches!(Store::open(folder.path().join("none.redb")), Err(DatabaseError::File { .. })));
    let foreign = folder.path().join("c.redb");
    let database = redb::Database::create(&foreign).expect("a database");
    let write = database.begin_write().expect("a transaction");
    write.open_table(redb::TableDefinition::<u64, u64>::new("numbers")).expect("a table");
    write.commit().expect("committed");
    drop(database);
    let error = Store::open_to_write(&foreign).err().expect("not ours").to_string();
    assert!(error.contains("not a database of PERIS: it holds other tables"), "{error}");
}

#[test]
fn readers_see_all_of_a_transaction_or_nothing_while_one_writes() {
    let folder = folder();
    let path = folder.path().join("a.redb");
    let writer = Store::open_to_write(&path).expect("a new database");
    let done = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        for own in [false, true] {
            let (writer, path, done) = (&writer, &path, &done);
            scope.spawn(move || {
                let opened = Store::open(path);
                let reader = if own { opened.as_ref().expect("readers beside a writer") } else { writer };
                let mut most = 0;
                while !done.load(std::sync::atomic::Ordering::Relaxed) {
                    let count = reader.entries(None).expect("a list").len();
                    assert!(count % 3 == 0 && count >= most, "{count} after {most}");
                    most = count;
                }
            });
        }
        for round in 0..40 {
            let three = ["a", "b", "c"].map(|name| material(&format!("{name}{round}"), 0.5));
            writer.add(&three, false).expect("added");
        }
        done.store(true, std::sync::atomic::Ordering::Relaxed);
    });
    assert_eq!(Store::open(&path).expect("there").entries(None).expect("a list").len(), 120);
}

#[test]
fn a_second_writer_waits_and_is_then_told() {
    let folder = folder();
    let path = folder.path().join("a.redb");
    let first = Store::open_to_write(&path).expect("a new database");
    let error = Store::open_to_write(&path).err().expect("there is one");
    assert!(matches!(error, DatabaseError::Busy { .. }), "{error}");
    std::thread::scope(|scope| {
        let second = scope.spawn(|| Store::open_to_write(&path).and_then(|s| s.add(&[material("second", 0.5)], false)));
        std::thread::sleep(std::time::Duration::from_millis(200));
        first.add(&[material("first", 0.5)], false).expect("added");
        drop(first);
        second.join().expect("no panic").expect("it had its turn");
    });
    assert_eq!(Store::open(&path).expect("there").names(RecordKind::Material).expect("names"), ["first", "second"]);
}

#[test]
fn a_mesh_of_a_million_triangles_comes_back() {
    let side = 708_u32;
    let place = |index: u32| DVec3::new(f64::from(index % side), f64::from(index / side), f64::from(index).sin());
    let corner = |x: u32, y: u32| y * side + x;
    let cell = |index: u32| {
        let (x, y) = (index % (side - 1), index / (side - 1));
        [[corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)], [corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)]]
    };
    let mesh = Mesh {
        vertices: (0..side * side).map(place).collect(),
        triangles: (0..(side - 1) * (side - 1)).flat_map(cell).collect(),
        ..Mesh::default()
    };
    assert_eq!(mesh.triangles.len(), 999_698);
    let record = record("large", RecordContent::Geometry(Box::new(mesh.into())));
    let folder = folder();
    let path = folder.path().join("a.redb");
    Store::open_to_write(&path).expect("a new database").add(std::slice::from_ref(&record), false).expect("added");
    assert_eq!(Store::open(&path).expect("there").record(RecordKind::Geometry, "large").expect("there"), record);
}

#[test]
fn files_that_are_exported_come_back_to_the_last_bit() {
    let folder = folder();
    for record in many() {
        let endings: &[&str] = match &record.content {
            RecordContent::Geometry(_) => &["obj"],
            RecordContent::Texture(_) => &["exr"],
            RecordContent::Spectrum(Curves::Functions(_)) => &["json"],
            RecordContent::Spectrum(_) => &["txt", "json"],
            RecordContent::Photons(_) => &[],
            _ => &["json"],
        };
        if endings.is_empty() {
            assert!(
                write(&record, &files::Destination::of(folder.path().join("a.json")).expect("a destination")).is_err(),
                "it is of use in its database only"
            );
        }
        for ending in endings {
            let path = folder.path().join(format!("{}.{ending}", record.name));
            write(&record, &files::Destination::of(&path).expect("a destination")).expect("written");
            let quantity =
                matches!(record.content, RecordContent::Spectrum(Curves::Light(_))).then_some(ColumnQuantity::Light);
            let back = read(&path, None, quantity).expect("read").pop().expect("a record");
            let mut expected = record.content.clone();
            if let RecordContent::Geometry(grouped) = &mut expected {
                // What glTF alone can tell.
                grouped.materials = vec![None, None];
            }
            let mut found = back.content;
            if let RecordContent::Geometry(grouped) = &mut found {
                grouped.materials = vec![None, None];
            }
            assert_eq!((found, &back.name), (expected, &record.name), "{ending}");
            if ["txt", "json"].contains(ending) {
                assert_eq!(back.origin, record.origin);
            }
        }
    }
}

#[test]
fn files_that_give_no_record_are_told_with_the_place() {
    let folder = folder();
    let problem = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        let error = read(&path, None, None).expect_err("no record").to_string();
        error.replace(&folder.path().display().to_string(), "")
    };
    assert_eq!(problem("a.txt", "nm a\n400 1\n410 x\n"), "/a.txt: line 3: invalid float literal");
    assert!(problem("a.txt", "nm lamp\n400 1\n410 80\n").ends_with("within 0 and 1.001 (or is it a light?)"));
    assert!(problem("a.json", "{\n \"material\": 1 }").contains("line 2 column"));
    assert!(problem("a.json", "{}").ends_with("it must hold one of material, light and spectrum"));
    assert!(problem("a.json", "{\"colour\": 1}").contains("unknown field `colour`"));
    assert!(problem("a.doc", "").contains("unknown kind of file; known are meshes (.obj,"));
    assert!(read(&folder.path().join("none.obj"), None, None).is_err());
    let two = folder.path().join("two.txt");
    std::fs::write(&two, "# What.\n# Source: me.\nnm oak ash\n400 0.1 0.2\n410 0.2 0.3\n").expect("written");
    let records = read(&two, None, None).expect("two records");
    assert_eq!(records.iter().map(|r| &*r.name).collect::<Vec<_>>(), ["oak", "ash"]);
    assert!(records.iter().all(|r| r.origin.source == "me." && r.kind() == RecordKind::Spectrum));
    assert!(read(&two, Some("both"), None).is_err());
    let metal = folder.path().join("brass.txt");
    std::fs::write(&metal, "nm n k\n400 1.4 1.7\n500 1.2 2.0\n").expect("written");
    let brass = read(&metal, None, None).expect("a metal").pop().expect("one");
    assert!(
        matches!(brass.content, RecordContent::Spectrum(Curves::Metal(ComplexIndex { .. }))) && brass.name == "brass"
    );
    let mesh = folder.path().join("square.ply");
    mesh::write_grouped(&square(), &mesh::destination(&mesh).expect("a destination")).expect("written");
    assert_eq!(read(&mesh, Some("tile"), None).expect("a mesh")[0].name, "tile");
}
