//! Ray queries: what an application asks to pick objects, tests to compare and benchmarks to time.

use diacaustic_shaders::{INTERSECT, NONE, QueryHit, QueryRay, WORKGROUP_SIZE};
use glam::Vec3;

use crate::{
    Error,
    gpu::{Binding, Gpu, Purpose},
};

const RAYS: Purpose = Purpose { what: "the rays of a query", remedy: "ask about fewer rays at once" };
const HITS: Purpose = Purpose { what: "the hits of a query", remedy: "ask about fewer rays at once" };

/// What poisons a hit before the kernel writes it: no triangle has this index.
const UNWRITTEN: u32 = NONE - 1;
/// Rays that one dispatch takes: WebGPU's most workgroups along a dimension.
const MAX_RAYS: usize = 65_535 * WORKGROUP_SIZE as usize;

/// A ray to ask about, world frame, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// How far it goes.
    pub t_max: f32,
}

/// The triangle that a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the triangle in the object's mesh.
    pub triangle: usize,
    /// Distance along the ray, metres.
    pub t: f32,
}

/// The pipeline of ray queries.
#[derive(Debug)]
pub(crate) struct QueryPass {
    rays_layout: wgpu::BindGroupLayout,
    hits_layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

/// Rays on the device.
#[derive(Debug)]
pub struct RayBatch {
    count: u32,
    hits: wgpu::Buffer,
    rays_group: wgpu::BindGroup,
    hits_group: wgpu::BindGroup,
}

impl QueryPass {
    pub fn new(gpu: &Gpu, scene_layout: &wgpu::BindGroupLayout) -> Self {
        let rays_layout = gpu.layout("query rays", wgpu::ShaderStages::COMPUTE, &[Binding::Read]);
        let hits_layout = gpu.layout("query hits", wgpu::ShaderStages::COMPUTE, &[Binding::ReadWrite]);
        let pipeline = {
            // Queries ask for the surface, whole or not.
            let layouts = [scene_layout, &rays_layout, &hits_layout];
            gpu.specialised_pipeline(INTERSECT, &layouts, &[("has_holes", 0.0)])
        };
        Self { rays_layout, hits_layout, pipeline }
    }

    pub fn upload(&self, gpu: &Gpu, rays: &[Ray], any_hit: bool) -> Result<RayBatch, Error> {
        if rays.len() > MAX_RAYS {
            let bytes = |count: usize| (count * size_of::<QueryRay>()) as u64;
            let (asked, available) = (bytes(rays.len()), bytes(MAX_RAYS));
            return Err(Error::BufferTooLarge { what: RAYS.what, asked, available, remedy: RAYS.remedy });
        }
        let packed: Vec<_> = rays
            .iter()
            .map(|ray| QueryRay {
                origin: ray.origin.into(),
                t_max: ray.t_max,
                direction: ray.direction.into(),
                any_hit: u32::from(any_hit),
            })
            .collect();
        let poison =
            vec![QueryHit { triangle: UNWRITTEN, t: f32::NAN, barycentric_1: 0.0, barycentric_2: 0.0 }; rays.len()];
        let rays_buffer = gpu.filled(RAYS, &packed)?;
        let hits = gpu.filled(HITS, &poison)?;
        Ok(RayBatch {
            count: rays.len() as u32,
            rays_group: gpu.bind(&self.rays_layout, &[&rays_buffer]),
            hits_group: gpu.bind(&self.hits_layout, &[&hits]),
            hits,
        })
    }

    pub fn run(&self, gpu: &Gpu, scene_group: &wgpu::BindGroup, batch: &RayBatch) {
        let groups = [scene_group, &batch.rays_group, &batch.hits_group];
        gpu.dispatch(&self.pipeline, &groups, [batch.count.div_ceil(WORKGROUP_SIZE), 1]);
    }
}

impl RayBatch {
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Vec<QueryHit>, Error> {
        if self.count == 0 {
            return Ok(Vec::new());
        }
        let hits: Vec<QueryHit> = gpu.read(&self.hits, 0..u64::from(self.count))?;
        if hits.iter().any(|hit| hit.triangle == UNWRITTEN) {
            return Err(Error::Device("a ray query left hits unwritten".into()));
        }
        Ok(hits)
    }
}
