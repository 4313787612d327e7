//! Buffers, pipelines and read-back on the application's device.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use bytemuck::Pod;
use diacaustic_shaders::{Kernel, RECORDS_WIDTH_BITS};
use wgpu::util::DeviceExt as _;

use crate::Error;

/// The application's device and queue.
#[derive(Clone, Debug)]
pub(crate) struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// What its buffers and textures may take, if that is limited.
    pub limit: Option<MemoryLimit>,
}

/// A limit on what buffers and textures may take together.
#[derive(Clone, Debug)]
pub(crate) struct MemoryLimit {
    bytes: u64,
    taken: Arc<AtomicU64>,
}

impl MemoryLimit {
    pub fn new(bytes: u64) -> Self {
        Self { bytes, taken: Arc::default() }
    }

    /// Takes a part, or refuses it.
    fn take(&self, purpose: Purpose, asked: u64) -> Result<(), Error> {
        let left = self.bytes.saturating_sub(self.taken.fetch_add(asked, Ordering::Relaxed));
        if asked <= left {
            return Ok(());
        }
        Err(Error::OverMemoryLimit { what: purpose.what, asked, left, limit: self.bytes, remedy: purpose.remedy })
    }
}

/// How a binding is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Binding {
    Uniform,
    Read,
    ReadWrite,
    /// A texture of records, read texel by texel as unsigned integers.
    Records,
    /// A texture of `Rgba32Float`, read texel by texel.
    Texels,
    /// A texture of `Rgba32Float`, written texel by texel.
    WriteTexels,
}

/// What a buffer is for, and what to do if it does not fit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Purpose {
    pub what: &'static str,
    pub remedy: &'static str,
}

impl Gpu {
    /// The same device with a limit on what is made from now on.
    pub fn limited_to(&self, bytes: Option<u64>) -> Self {
        Self { limit: bytes.map(MemoryLimit::new), ..self.clone() }
    }

    fn take(&self, purpose: Purpose, bytes: u64) -> Result<(), Error> {
        self.limit.as_ref().map_or(Ok(()), |limit| limit.take(purpose, bytes))
    }

    /// Refuses a storage buffer that the device cannot bind.
    pub fn check_size(&self, purpose: Purpose, asked: u64) -> Result<(), Error> {
        let limits = self.device.limits();
        let available = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if asked > available {
            return Err(Error::BufferTooLarge { what: purpose.what, asked, available, remedy: purpose.remedy });
        }
        Ok(())
    }

    /// A storage buffer that holds `content`, or one zeroed element if that is empty.
    pub fn filled<T: Pod>(&self, purpose: Purpose, content: &[T]) -> Result<wgpu::Buffer, Error> {
        let filler = [T::zeroed()];
        let content = if content.is_empty() { &filler } else { content };
        self.check_size(purpose, size_of_val(content) as u64)?;
        self.take(purpose, size_of_val(content) as u64)?;
        Ok(self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(purpose.what),
            contents: bytemuck::cast_slice(content),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        }))
    }

    /// A zeroed storage buffer of at least 16 bytes.
    pub fn zeroed(&self, purpose: Purpose, size: u64) -> Result<wgpu::Buffer, Error> {
        self.check_size(purpose, size)?;
        self.take(purpose, size.max(16))?;
        Ok(self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(purpose.what),
            size: size.max(16),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        }))
    }

    /// A uniform buffer for one `T`.
    pub fn uniform<T: Pod>(&self, label: &'static str) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: size_of::<T>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// A layout with one binding for each entry, in order.
    pub fn layout(
        &self,
        label: &'static str,
        stages: wgpu::ShaderStages,
        bindings: &[Binding],
    ) -> wgpu::BindGroupLayout {
        let entries: Vec<_> = bindings
            .iter()
            .enumerate()
            .map(|(number, binding)| wgpu::BindGroupLayoutEntry {
                binding: number as u32,
                visibility: stages,
                ty: binding_type(*binding),
                count: None,
            })
            .collect();
        self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
    }

    /// A bind group of whole buffers, in order.
    pub fn bind(&self, layout: &wgpu::BindGroupLayout, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
        let resources: Vec<_> = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
        self.bind_resources(layout, resources)
    }

    /// A bind group of any resources, in order.
    pub fn bind_resources(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: Vec<wgpu::BindingResource>,
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = resources
            .into_iter()
            .enumerate()
            .map(|(number, resource)| wgpu::BindGroupEntry { binding: number as u32, resource })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    /// A texture of 16-byte texels that holds `records` one after the other, row by row.
    pub fn records<T: Pod>(&self, purpose: Purpose, records: &[T]) -> Result<wgpu::Texture, Error> {
        let bytes: &[u8] = bytemuck::cast_slice(records);
        let row = 16usize << RECORDS_WIDTH_BITS;
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let texels = (bytes.len() / 16) as u64;
        let texture = self.texels(purpose, wgpu::TextureFormat::Rgba32Uint, usage, texels)?;
        let (whole_rows, rest) = bytes.split_at(bytes.len() / row * row);
        self.write_rows(&texture, 0, whole_rows);
        if !rest.is_empty() {
            let mut last = rest.to_vec();
            last.resize(row, 0);
            self.write_rows(&texture, (whole_rows.len() / row) as u32, &last);
        }
        Ok(texture)
    }

    /// Bytes that a texture of records may have.
    pub fn most_record_bytes(&self) -> u64 {
        u64::from(self.device.limits().max_texture_dimension_2d) * (16 << RECORDS_WIDTH_BITS)
    }

    /// A zeroed texture of at least `count` texels of 16 bytes, in rows of 2^`RECORDS_WIDTH_BITS`.
    pub fn texels(
        &self,
        purpose: Purpose,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
        count: u64,
    ) -> Result<wgpu::Texture, Error> {
        let height = count.div_ceil(1 << RECORDS_WIDTH_BITS).max(1);
        let available = self.most_record_bytes();
        if height * (16 << RECORDS_WIDTH_BITS) > available {
            return Err(Error::BufferTooLarge {
                what: purpose.what,
                asked: 16 * count,
                available,
                remedy: purpose.remedy,
            });
        }
        self.take(purpose, height * (16 << RECORDS_WIDTH_BITS))?;
        let width = 1 << RECORDS_WIDTH_BITS;
        Ok(self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(purpose.what),
            size: wgpu::Extent3d { width, height: height as u32, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        }))
    }

    /// Writes whole rows of a texture of records.
    fn write_rows(&self, texture: &wgpu::Texture, first_row: u32, bytes: &[u8]) {
        let row = 16u32 << RECORDS_WIDTH_BITS;
        let height = bytes.len() as u32 / row;
        if height == 0 {
            return;
        }
        self.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: first_row, z: 0 },
                aspect: wgpu::TextureAspect::All,
            },
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
            wgpu::Extent3d { width: 1 << RECORDS_WIDTH_BITS, height, depth_or_array_layers: 1 },
        );
    }

    /// The pipeline of a compute kernel; `groups` are its bind groups' layouts, in order.
    pub fn compute_pipeline(&self, kernel: Kernel, groups: &[&wgpu::BindGroupLayout]) -> wgpu::ComputePipeline {
        self.specialised_pipeline(kernel, groups, &[])
    }

    /// The pipeline of a kernel with values for its override constants.
    pub fn specialised_pipeline(
        &self,
        kernel: Kernel,
        groups: &[&wgpu::BindGroupLayout],
        constants: &[(&str, f64)],
    ) -> wgpu::ComputePipeline {
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(kernel.name),
            source: wgpu::ShaderSource::Wgsl(kernel.source.into()),
        });
        let layouts: Vec<_> = groups.iter().map(|layout| Some(*layout)).collect();
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(kernel.name),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(kernel.name),
            layout: Some(&layout),
            module: &module,
            entry_point: kernel.entry_point,
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            cache: None,
        })
    }

    /// Submits one dispatch.
    pub fn dispatch(&self, pipeline: &wgpu::ComputePipeline, groups: &[&wgpu::BindGroup], size: [u32; 2]) {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            for (number, group) in groups.iter().enumerate() {
                pass.set_bind_group(number as u32, *group, &[]);
            }
            pass.dispatch_workgroups(size[0], size[1], 1);
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Sets a buffer to zero.
    pub fn clear(&self, buffer: &wgpu::Buffer) {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(buffer, 0, None);
        self.queue.submit([encoder.finish()]);
    }

    /// Copies elements `range` of a buffer to the host. Blocks until the device has done all submitted work.
    pub fn read<T: Pod>(&self, buffer: &wgpu::Buffer, range: std::ops::Range<u64>) -> Result<Vec<T>, Error> {
        let element = size_of::<T>() as u64;
        let size = (range.end - range.start) * element;
        let staging = self.poisoned_staging(size)?;
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, range.start * element, &staging, 0, size);
        self.read_staging(encoder, &staging)
    }

    /// Copies texels `range`, of 16 bytes each, to the host. Blocks until the device has done all submitted work.
    pub fn read_texels<T: Pod>(&self, texture: &wgpu::Texture, range: std::ops::Range<u64>) -> Result<Vec<T>, Error> {
        let rows = range.start >> RECORDS_WIDTH_BITS..range.end.div_ceil(1 << RECORDS_WIDTH_BITS);
        let height = (rows.end - rows.start) as u32;
        let row = 16u32 << RECORDS_WIDTH_BITS;
        let staging = self.poisoned_staging(u64::from(row) * u64::from(height))?;
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: rows.start as u32, z: 0 },
                aspect: wgpu::TextureAspect::All,
            },
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
            },
            wgpu::Extent3d { width: 1 << RECORDS_WIDTH_BITS, height, depth_or_array_layers: 1 },
        );
        let mut texels = self.read_staging(encoder, &staging)?;
        let first = (range.start - (rows.start << RECORDS_WIDTH_BITS)) as usize;
        texels.truncate(first + (range.end - range.start) as usize);
        texels.drain(..first);
        Ok(texels)
    }

    /// Submits copies into a staging buffer, and reads it. Blocks.
    fn read_staging<T: Pod>(&self, encoder: wgpu::CommandEncoder, staging: &wgpu::Buffer) -> Result<Vec<T>, Error> {
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        staging.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // The receiver outlives the wait below, so that a failed send cannot lose a result.
            let _ = sender.send(result);
        });
        self.wait()?;
        receiver
            .recv()
            .map_err(|_| Error::Device("the device never answered a read-back".into()))?
            .map_err(|error| Error::Device(error.to_string()))?;
        let view = staging.slice(..).get_mapped_range().map_err(|error| Error::Device(error.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }

    /// A buffer to copy results into, poisoned so that a copy which did not happen cannot look like zeros.
    fn poisoned_staging(&self, size: u64) -> Result<wgpu::Buffer, Error> {
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read-back"),
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: true,
        });
        let poison = vec![0xa5; size as usize];
        staging
            .slice(..)
            .get_mapped_range_mut()
            .map_err(|error| Error::Device(error.to_string()))?
            .copy_from_slice(&poison);
        staging.unmap();
        Ok(staging)
    }

    /// Blocks until the device has done all submitted work.
    pub fn wait(&self) -> Result<(), Error> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|error| Error::Device(error.to_string()))
    }

    /// Runs `work`, and reports what the device ran out of or refused in it.
    pub fn guarded<T>(&self, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        let refused = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let exhausted = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let result = work();
        let exhausted = pollster::block_on(exhausted.pop());
        let refused = pollster::block_on(refused.pop());
        if let Some(error) = exhausted {
            return Err(Error::OutOfMemory(error.to_string()));
        }
        if let Some(error) = refused {
            return Err(Error::Device(error.to_string()));
        }
        result
    }
}

fn binding_type(binding: Binding) -> wgpu::BindingType {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let texture = |sample_type| wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    match binding {
        Binding::Uniform => buffer(wgpu::BufferBindingType::Uniform),
        Binding::Read => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
        Binding::ReadWrite => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
        Binding::Records => texture(wgpu::TextureSampleType::Uint),
        Binding::Texels => texture(wgpu::TextureSampleType::Float { filterable: false }),
        Binding::WriteTexels => wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: wgpu::TextureFormat::Rgba32Float,
            view_dimension: wgpu::TextureViewDimension::D2,
        },
    }
}

/// Bytes of a texture of 16-byte texels.
pub(crate) fn texture_bytes(texture: &wgpu::Texture) -> u64 {
    16 * u64::from(texture.width()) * u64::from(texture.height())
}

/// The 64-bit integer that the kernels keep in two words, the low one first.
pub(crate) fn wide([low, high]: [u32; 2]) -> u64 {
    u64::from(high) << 32 | u64::from(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_counts_everything_and_names_what_is_too_much() {
        let limit = MemoryLimit::new(100);
        let purpose = Purpose { what: "the maps", remedy: "lower map_size" };
        limit.take(purpose, 60).unwrap();
        limit.take(purpose, 40).unwrap();
        let message = limit.take(purpose, 1).unwrap_err().to_string();
        assert_eq!(
            message,
            "the maps need 1 bytes, and of the 100 that may be taken on the device 0 are left: lower map_size"
        );
    }
}
