//! The binary chunk of a glTF file.

use bytemuck::Pod;
use gltf_json::{
    Accessor, Buffer, Index, Root,
    accessor::{ComponentType, GenericComponentType, Type},
    buffer::{Target, View},
    validation::Checked::Valid,
};

/// Numbers and pictures, each from a multiple of four bytes on.
#[derive(Default)]
pub(super) struct Bytes(Vec<u8>);

impl Bytes {
    /// Adds numbers, and the accessor by which they are read.
    pub fn push<T: Pod>(
        &mut self,
        root: &mut Root,
        elements: &[T],
        (component, shape): (ComponentType, Type),
        target: Target,
    ) -> Index<Accessor> {
        let view = self.push_view(root, bytemuck::cast_slice(elements), Some(target));
        root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: elements.len().into(),
            component_type: Valid(GenericComponentType(component)),
            extensions: None,
            extras: None,
            type_: Valid(shape),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }

    /// Adds bytes. The numbers of this machine are taken for little-endian, as the format wants them.
    pub fn push_view(&mut self, root: &mut Root, bytes: &[u8], target: Option<Target>) -> Index<View> {
        self.0.resize(self.0.len().next_multiple_of(4), 0);
        let byte_offset = Some(self.0.len().into());
        self.0.extend(bytes);
        root.push(View {
            buffer: Index::new(0),
            byte_length: bytes.len().into(),
            byte_offset,
            byte_stride: None,
            name: None,
            target: target.map(Valid),
            extensions: None,
            extras: None,
        })
    }

    /// The whole of it, which the file's only buffer is.
    pub fn finish(self, root: &mut Root) -> Vec<u8> {
        root.push(Buffer { byte_length: self.0.len().into(), name: None, uri: None, extensions: None, extras: None });
        self.0
    }
}
