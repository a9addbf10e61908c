//! Octrees as bytes.

use super::*;
use crate::octree::FileError;
use crate::octree::build::Leaves;

fn octree() -> Octree {
    let mut octree = torus(8).octree();
    let small = ball(2).moved(|p| p * 0.2);
    octree.insert(&small.vertices, &small.triangles).expect("inside");
    octree.with_walk(Walk::Index)
}

/// The bytes with another checksum, which is that of what follows it.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum = crc32fast::hash(&bytes[16..]);
    bytes[12..16].copy_from_slice(&sum.to_le_bytes());
    bytes
}

#[test]
fn what_is_written_is_read_again() {
    let octree = octree();
    let bytes = octree.to_bytes().expect("written");
    let again = Octree::from_bytes(&bytes).expect("read");
    assert_eq!(again.to_bytes().expect("written"), bytes);
    assert_eq!(again.statistics(), octree.statistics());
    assert_eq!((again.leaves(), &again.nodes().homes), (octree.leaves(), &octree.nodes().homes));
    let mut stream = RandomStream::new(61, 0);
    for _ in 0..500 {
        let ray = chord(DVec3::ZERO, 1.4, &mut stream);
        assert_eq!(again.closest(&ray, 0.0, f64::INFINITY), octree.closest(&ray, 0.0, f64::INFINITY));
    }
    // What was read can be changed as what was built.
    let (mut one, mut other) = (octree, again);
    assert!(one.remove(0) && other.remove(0));
    assert_eq!(one.leaves(), other.leaves());
    let nothing = Octree::build(&[], &[], &OctreeSettings::default()).expect("nothing is fine");
    assert!(Octree::from_bytes(&nothing.to_bytes().expect("written")).is_ok());
}

#[test]
fn what_is_no_octree_is_refused() {
    let bytes = octree().to_bytes().expect("written");
    let error = |bytes: &[u8]| Octree::from_bytes(bytes).map(|_| ()).expect_err("refused");
    assert_eq!(error(b""), FileError::Name);
    assert_eq!(error(b"solid a mesh of something\n"), FileError::Name);
    assert_eq!(error(&bytes[..bytes.len() - 1]), FileError::Checksum);
    let mut other = bytes.clone();
    other[8] = 9;
    assert_eq!(error(&other), FileError::Version { found: 9 });
    let mut longer = bytes.clone();
    longer.push(0);
    assert_eq!(error(&longer), FileError::Checksum);
    assert!(matches!(error(&sealed(longer)), FileError::Fields(_)));
    assert!(matches!(error(&sealed(bytes[..bytes.len() / 2].to_vec())), FileError::Fields(_)));
    // A length of 2^63 where the objects should be: the fields before them have 24 + 8 + 1 + 1 bytes.
    let mut huge = bytes[..50].to_vec();
    huge.extend([253, 0, 0, 0, 0, 0, 0, 0, 128]);
    assert!(matches!(error(&sealed(huge)), FileError::Fields(_)));
}

#[test]
fn files_that_lack_a_reference_or_a_node_are_refused() {
    let whole = octree();
    let message = |octree: &Octree| {
        let bytes = octree.to_bytes().expect("written");
        Octree::from_bytes(&bytes).map(|_| ()).expect_err("refused").to_string()
    };
    for leaf in [0, whole.leaves().codes.len() / 2, whole.leaves().codes.len() - 1] {
        let mut forged = whole.clone();
        let range = forged.leaves().range(leaf..leaf + 1);
        let (begin, count) = (range.start, range.len());
        let without = |leaves: &mut Leaves, from: usize, number: usize| {
            leaves.triangles.drain(from..from + number);
            leaves.ends[leaf..].iter_mut().for_each(|end| *end -= number);
        };
        if count > 1 {
            without(&mut forged.nodes.get_mut().expect("divided").leaves, begin, 1);
            assert!(message(&forged).contains("just the triangles that touch it"), "{}", message(&forged));
        }
        let mut forged = whole.clone();
        without(&mut forged.nodes.get_mut().expect("divided").leaves, begin, count);
        let leaves = &mut forged.nodes.get_mut().expect("divided").leaves;
        leaves.ends.remove(leaf);
        leaves.codes.remove(leaf);
        assert!(message(&forged).contains("where there is no node"), "{}", message(&forged));
    }
}

#[test]
fn no_change_of_bytes_makes_it_panic() {
    let octree = octree();
    let bytes = octree.to_bytes().expect("written");
    let mut stream = RandomStream::new(62, 0);
    let mut refused = 0;
    for _ in 0..800 {
        let mut changed = bytes.clone();
        for _ in 0..1 + stream.below(3) {
            let at = 16 + stream.below(bytes.len() - 16);
            changed[at] = [0, 1, 127, 255, changed[at] ^ 1, stream.below(256) as u8][stream.below(6)];
        }
        match Octree::from_bytes(&sealed(changed)) {
            // Another place of a vertex, for instance: an octree all the same, which answers.
            Ok(mut octree) => {
                octree.closest(&chord(DVec3::ZERO, 1.4, &mut stream), 0.0, f64::INFINITY);
                octree.containment(DVec3::X);
                octree.remove(0);
            }
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 200, "{refused}");
}
