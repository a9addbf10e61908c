//! Tables of numbers in the buffers of a file.

use super::super::{Fault, MeshProblem};
use super::document::LocatedValue;
use crate::memory;

/// The type of a component.
#[derive(Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(at: LocatedValue) -> Result<Component, Fault> {
        Ok(match at.count()? {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return Err(at.expected("a component type, 5120 to 5123, 5125 or 5126")),
        })
    }

    fn bytes(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The number at the beginning of `bytes`, which are enough; 1 is the greatest if it is `normalized`.
    fn number(self, bytes: &[u8], normalized: bool) -> f64 {
        let byte = |k: usize| bytes.get(k).copied().unwrap_or(0);
        let [a, b, c, d] = [0, 1, 2, 3].map(byte);
        let (value, most) = match self {
            Component::I8 => (f64::from(a as i8), 127.0),
            Component::U8 => (f64::from(a), 255.0),
            Component::I16 => (f64::from(i16::from_le_bytes([a, b])), 32767.0),
            Component::U16 => (f64::from(u16::from_le_bytes([a, b])), 65535.0),
            Component::U32 => (f64::from(u32::from_le_bytes([a, b, c, d])), f64::from(u32::MAX)),
            Component::F32 => return f64::from(f32::from_le_bytes([a, b, c, d])),
        };
        if normalized { (value / most).max(-1.0) } else { value }
    }
}

/// The buffers of a file.
pub struct Buffers<'a> {
    /// The document.
    pub root: LocatedValue<'a>,
    /// The bytes of each buffer.
    pub bytes: Vec<Vec<u8>>,
    /// Bytes of all of them and of the document: no table has more rows.
    pub total: usize,
}

/// Rows of a table in a buffer.
struct Rows<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: Component,
    normalized: bool,
}

impl Rows<'_> {
    fn number(&self, row: usize, column: usize) -> f64 {
        let at = row * self.stride + column * self.component.bytes();
        self.component.number(self.bytes.get(at..).unwrap_or_default(), self.normalized)
    }
}

impl<'a> Buffers<'a> {
    /// Rows `count` from the buffer view that `view` names on; `owner` says where they begin in it.
    fn rows(
        &self,
        owner: LocatedValue<'a>,
        view: LocatedValue<'a>,
        count: usize,
        columns: usize,
    ) -> Result<Rows<'_>, Fault> {
        let component = Component::of(owner.need("componentType")?)?;
        self.rows_of(owner, view, count, columns, component)
    }

    fn rows_of(
        &self,
        owner: LocatedValue<'a>,
        view: LocatedValue<'a>,
        count: usize,
        columns: usize,
        component: Component,
    ) -> Result<Rows<'_>, Fault> {
        let place = view.named(&self.root, "bufferViews")?;
        let buffer_at = place.need("buffer")?;
        let buffer = buffer_at.count()?;
        let outside = || {
            let count = self.bytes.len();
            buffer_at.fault(MeshProblem::Index { index: buffer as i64, count, table: "buffers" })
        };
        let bytes = self.bytes.get(buffer).ok_or_else(outside)?;
        let (begin, length) = (place.count_or("byteOffset", 0)?, place.need("byteLength")?.count()?);
        let end = begin.checked_add(length).filter(|end| *end <= bytes.len());
        let end = end.ok_or_else(|| place.fault(MeshProblem::Outside { length: bytes.len() }))?;
        let view = &bytes[begin..end];
        let width = columns * component.bytes();
        let stride = match place.get("byteStride") {
            Some(at) => {
                at.count().ok().filter(|stride| *stride >= width).ok_or_else(|| at.expected("a longer stride"))?
            }
            None => width,
        };
        let offset = owner.count_or("byteOffset", 0)?;
        let needed = count.saturating_sub(1).checked_mul(stride).and_then(|all| all.checked_add(width));
        let needed = if count == 0 { Some(0) } else { needed };
        let is_inside = needed.and_then(|needed| needed.checked_add(offset)).is_some_and(|end| end <= view.len());
        if !is_inside {
            return Err(owner.fault(MeshProblem::Outside { length: view.len() }));
        }
        let normalized = owner.flag("normalized")?;
        Ok(Rows { bytes: &view[offset..], stride, component, normalized })
    }

    /// How many rows the accessor has that `at` names.
    pub fn count(&self, at: LocatedValue<'a>) -> Result<usize, Fault> {
        let count_at = at.named(&self.root, "accessors")?.need("count")?;
        let count = count_at.count()?;
        if count > self.total {
            let (count, limit) = (count as u64, self.total as u64);
            return Err(count_at.fault(MeshProblem::TooMany { what: "rows", count, limit }));
        }
        Ok(count)
    }

    /// All rows of the accessor that `at` names.
    ///
    /// - `kind`: the type that it must have, such as VEC3, of N columns.
    pub fn table<const N: usize>(&self, at: LocatedValue<'a>, kind: &'static str) -> Result<Vec<[f64; N]>, Fault> {
        let accessor = at.named(&self.root, "accessors")?;
        let found = accessor.need("type")?;
        if found.text()? != kind {
            return Err(found.expected(kind));
        }
        let count = self.count(at)?;
        memory::reserve((count * size_of::<[f64; N]>()) as u64, || format!("reading {count} rows"))
            .map_err(|excess| accessor.fault(excess.into()))?;
        let mut table = vec![[0.0; N]; count];
        if let Some(view) = accessor.get("bufferView") {
            let rows = self.rows(accessor, view, count, N)?;
            for (k, row) in table.iter_mut().enumerate() {
                *row = std::array::from_fn(|column| rows.number(k, column));
            }
        }
        if let Some(sparse) = accessor.get("sparse") {
            self.replace(accessor, sparse, &mut table)?;
        }
        Ok(table)
    }

    /// Replaces some rows of a table.
    fn replace<const N: usize>(
        &self,
        accessor: LocatedValue<'a>,
        sparse: LocatedValue<'a>,
        table: &mut [[f64; N]],
    ) -> Result<(), Fault> {
        let count = sparse.need("count")?.count()?;
        let (indices, values) = (sparse.need("indices")?, sparse.need("values")?);
        let places = self.rows(indices, indices.need("bufferView")?, count, 1)?;
        let component = Component::of(accessor.need("componentType")?)?;
        let mut rows = self.rows_of(values, values.need("bufferView")?, count, N, component)?;
        rows.normalized = accessor.flag("normalized")?;
        for k in 0..count {
            let index = places.number(k, 0);
            let length = table.len();
            let outside = || indices.fault(MeshProblem::Index { index: index as i64, count: length, table: "rows" });
            let row = table.get_mut(index as usize).filter(|_| index >= 0.0).ok_or_else(outside)?;
            *row = std::array::from_fn(|column| rows.number(k, column));
        }
        Ok(())
    }

    /// The indices of the accessor that `at` names.
    pub fn indices(&self, at: LocatedValue<'a>) -> Result<Vec<u32>, Fault> {
        let component = at.named(&self.root, "accessors")?.need("componentType")?;
        if !matches!(component.count()?, 5121 | 5123 | 5125) {
            return Err(component.expected("an unsigned component type, 5121, 5123 or 5125"));
        }
        Ok(self.table::<1>(at, "SCALAR")?.into_iter().map(|[index]| index as u32).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalized_integers_are_fractions() {
        let number = |component: Component, bytes: &[u8]| component.number(bytes, true);
        assert_eq!(number(Component::I8, &[0x80]), -1.0);
        assert_eq!(number(Component::U8, &[255]), 1.0);
        assert_eq!(number(Component::I16, &[0xFF, 0x7F]), 1.0);
        assert_eq!(number(Component::U16, &[0, 0]), 0.0);
        assert_eq!(Component::I16.number(&[0xFE, 0xFF], false), -2.0);
    }
}
