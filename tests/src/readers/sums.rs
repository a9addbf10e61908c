//! Checksums made right, so that a change of bytes reaches what follows them.

use host::database::RecordKind;

/// Bytes of an octree before its fields: name, version, checksum.
const OCTREE_HEAD: usize = 16;
/// Bytes of a record of a database before its head: version, checksum.
const RECORD_HEAD: usize = 8;
/// Bytes of a log of results before its first record: name and version, fingerprint.
const MEMO_HEAD: usize = 12;
/// Bytes of a record of such a log before its content: length, checksum.
const MEMO_RECORD: usize = 12;

/// The bytes of an octree file with the checksum of its fields.
pub fn octree(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if let Some((head, fields)) = bytes.split_at_mut_checked(OCTREE_HEAD) {
        head[12..].copy_from_slice(&crc32fast::hash(fields).to_le_bytes());
    }
    bytes
}

/// The bytes of a record of a database with the checksum for its kind and name.
pub fn record(kind: RecordKind, name: &str, bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if let Some((head, rest)) = bytes.split_at_mut_checked(RECORD_HEAD) {
        let summed = [kind.word().as_bytes(), &[0], name.as_bytes(), &[0], &head[..4], rest].concat();
        head[4..].copy_from_slice(&crc32fast::hash(&summed).to_le_bytes());
    }
    bytes
}

/// The bytes of the state of a rendering with a beginning that is right, and with their checksum after them.
///
/// - `beginning`: takes the place of as many bytes.
pub fn state(beginning: &[u8], bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let common = beginning.len().min(bytes.len());
    bytes[..common].copy_from_slice(&beginning[..common]);
    bytes.truncate(bytes.len().saturating_sub(4).max(common));
    let sum = crc32fast::hash(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// The bytes of a log of results with the checksum of each record.
///
/// - `head`: takes the place of its first bytes.
pub fn memo(head: [u8; MEMO_HEAD], bytes: &[u8]) -> Vec<u8> {
    let mut bytes = [&head[..], bytes.get(MEMO_HEAD..).unwrap_or_default()].concat();
    let mut at = MEMO_HEAD;
    while let Some(record) = bytes.get_mut(at..).filter(|record| record.len() >= MEMO_RECORD) {
        let (head, rest) = record.split_at_mut(MEMO_RECORD);
        let length = head[..8].iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte));
        let Some(content) = usize::try_from(length).ok().and_then(|length| rest.get(..length)) else { break };
        head[8..].copy_from_slice(&crc32fast::hash(content).to_le_bytes());
        at += MEMO_RECORD + content.len();
    }
    bytes
}
