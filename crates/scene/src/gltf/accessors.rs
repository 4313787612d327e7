//! Numbers in buffers: of every component type, strided, sparse, normalised.

use gltf_json::{
    Root,
    accessor::{ComponentType, GenericComponentType, IndexComponentType, Type},
    validation::Checked,
};

use super::{
    buffers::Buffers,
    fault::{Fault, Result, entry, place},
};

/// The most elements of an accessor without bytes, which are zero.
const MOST_ZEROS: usize = 1 << 24;

/// An accessor whose every element is known to lie within its bytes.
pub(super) struct Accessor<'a> {
    pub(super) place: String,
    pub(super) count: usize,
    component: ComponentType,
    components: usize,
    normalized: bool,
    /// The elements, or none where all are zero but those of `sparse`.
    dense: Option<Strided<'a>>,
    /// Elements that stand for those of the same index, in rising order of it.
    sparse: Option<(Vec<u32>, Strided<'a>)>,
}

/// Elements at even distances.
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl<'a> Strided<'a> {
    /// Checks that `count` elements of `size` bytes are there.
    fn new(bytes: &'a [u8], offset: u64, stride: usize, size: usize, count: usize, place: &str) -> Result<Self> {
        let needed = count.saturating_sub(1).checked_mul(stride).and_then(|last| last.checked_add(size));
        let bytes = usize::try_from(offset).ok().and_then(|offset| bytes.get(offset..)).unwrap_or_default();
        if count > 0 && needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(Fault::new(
                place,
                format!(
                    "has {count} elements of {size} bytes, one every {stride} bytes, more than the {} bytes that its \
                     bufferView has from its offset on",
                    bytes.len()
                ),
            ));
        }
        Ok(Self { bytes, stride })
    }

    fn element(&self, index: usize) -> &'a [u8] {
        &self.bytes[index * self.stride..]
    }
}

impl<'a> Accessor<'a> {
    /// The accessor of an index, which must have `components` numbers in each element; `user` names what asks for it.
    pub(super) fn new(
        root: &Root,
        buffers: &'a Buffers<'_>,
        index: usize,
        components: Type,
        user: &str,
    ) -> Result<Self> {
        let accessor = entry(&root.accessors, "accessors", index, user)?;
        let place = place("accessors", index, accessor.name.as_deref());
        let fault = |problem: String| Fault::new(&place, problem);
        let Checked::Valid(GenericComponentType(component)) = accessor.component_type else {
            return Err(fault("has an unknown componentType; it must be 5120 to 5123, 5125 or 5126".to_owned()));
        };
        let Checked::Valid(kind) = accessor.type_ else {
            return Err(fault("has an unknown type; it must be SCALAR, VEC2, VEC3, VEC4 or MAT4".to_owned()));
        };
        if kind != components {
            return Err(fault(format!("is of type {kind:?}, but {user} needs {components:?}")));
        }
        let size = component.size() * kind.multiplicity();
        let count = usize::try_from(accessor.count.0).map_err(|_| fault("has too many elements".to_owned()))?;
        let dense = match accessor.buffer_view {
            Some(view) => {
                let view = buffers.view(view.value(), &place)?;
                let stride = view.stride.unwrap_or(size);
                if stride < size {
                    return Err(fault(format!("has elements of {size} bytes, but its byteStride is {stride}")));
                }
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                Some(Strided::new(view.bytes, offset, stride, size, count, &place)?)
            }
            None if count > MOST_ZEROS => {
                return Err(fault(format!(
                    "has {count} elements and no bufferView; at most {MOST_ZEROS} can have none"
                )));
            }
            None => None,
        };
        let mut read = Self {
            count,
            component,
            components: kind.multiplicity(),
            normalized: accessor.normalized,
            dense,
            sparse: None,
            place: place.clone(),
        };
        if let Some(sparse) = &accessor.sparse {
            read.sparse = Some(read_sparse(sparse, buffers, &read, size)?);
        }
        Ok(read)
    }

    /// An element as numbers; normalised whole numbers are from 0 or −1 to 1.
    ///
    /// # Panics
    /// If the element is out of range or does not have `N` numbers.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> [f32; N] {
        debug_assert_eq!(self.components, N);
        let Some(bytes) = self.bytes_of(index) else { return [0.0; N] };
        let size = self.component.size();
        std::array::from_fn(|k| number(&bytes[k * size..], self.component, self.normalized))
    }

    /// A whole number, of an accessor of scalars.
    pub(super) fn whole(&self, index: usize) -> u32 {
        self.bytes_of(index).map_or(0, |bytes| whole(bytes, self.component))
    }

    /// Whole numbers, of an accessor of vectors.
    pub(super) fn wholes<const N: usize>(&self, index: usize) -> [u32; N] {
        let Some(bytes) = self.bytes_of(index) else { return [0; N] };
        std::array::from_fn(|k| whole(&bytes[k * self.component.size()..], self.component))
    }

    /// Whether its numbers are whole and not negative.
    pub(super) fn is_unsigned(&self) -> bool {
        matches!(self.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
    }

    fn bytes_of(&self, index: usize) -> Option<&'a [u8]> {
        if let Some((indices, values)) = &self.sparse
            && let Ok(at) = indices.binary_search(&(index as u32))
        {
            return Some(values.element(at));
        }
        self.dense.as_ref().map(|dense| dense.element(index))
    }
}

fn read_sparse<'a>(
    sparse: &gltf_json::accessor::sparse::Sparse,
    buffers: &'a Buffers<'_>,
    of: &Accessor<'_>,
    size: usize,
) -> Result<(Vec<u32>, Strided<'a>)> {
    let place = format!("{}.sparse", of.place);
    let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type else {
        return Err(Fault::new(place, "has an unknown componentType of indices; it must be 5121, 5123 or 5125"));
    };
    let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
    let strided = |view: usize, offset: u64, size: usize| {
        Strided::new(buffers.view(view, &place)?.bytes, offset, size, size, count, &place)
    };
    let places = strided(sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, component.size())?;
    let values = strided(sparse.values.buffer_view.value(), sparse.values.byte_offset.0, size)?;
    let indices: Vec<_> = (0..count).map(|index| whole(places.element(index), component)).collect();
    if !indices.is_sorted_by(|a, b| a < b) || indices.last().is_some_and(|last| *last as usize >= of.count) {
        return Err(Fault::new(place, format!("has indices that do not rise from one to the next below {}", of.count)));
    }
    Ok((indices, values))
}

fn number(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let share = |number: f32, most: f32| if normalized { (number / most).max(-1.0) } else { number };
    match component {
        ComponentType::I8 => share(f32::from(bytes[0] as i8), f32::from(i8::MAX)),
        ComponentType::U8 => share(f32::from(bytes[0]), f32::from(u8::MAX)),
        ComponentType::I16 => share(f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), f32::from(i16::MAX)),
        ComponentType::U16 => share(f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), f32::from(u16::MAX)),
        ComponentType::U32 => share(four(bytes, u32::from_le_bytes) as f32, u32::MAX as f32),
        ComponentType::F32 => four(bytes, f32::from_le_bytes),
    }
}

fn whole(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::I8 | ComponentType::U8 => u32::from(bytes[0]),
        ComponentType::I16 | ComponentType::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        ComponentType::U32 | ComponentType::F32 => four(bytes, u32::from_le_bytes),
    }
}

fn four<T>(bytes: &[u8], decode: impl Fn([u8; 4]) -> T) -> T {
    decode([bytes[0], bytes[1], bytes[2], bytes[3]])
}
