//! The film on a texture of the application's.

use diacaustic_scene::ToneCurve;
use diacaustic_shaders::{DISPLAY, DisplayParams};

use crate::gpu::{Binding, Gpu};

/// How a picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RenderParams {
    /// Stops of exposure: radiance is multiplied by 2^exposure.
    pub exposure: f32,
    /// The tone curve.
    pub tone: ToneCurve,
}

/// The pipelines that show the film, one for each texture format met so far.
#[derive(Debug)]
pub(crate) struct DisplayPass {
    layout: wgpu::BindGroupLayout,
    params: wgpu::Buffer,
    pipelines: Vec<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
}

impl DisplayPass {
    pub fn new(gpu: &Gpu) -> Self {
        let layout = gpu.layout("display", wgpu::ShaderStages::FRAGMENT, &[Binding::Uniform, Binding::Read]);
        Self { layout, params: gpu.uniform::<DisplayParams>("display"), pipelines: Vec::new() }
    }

    /// Submits the drawing of a film of `size` pixels over the whole of `view`.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        film: &wgpu::Buffer,
        size: [u32; 2],
        view: &wgpu::TextureView,
        how: &RenderParams,
    ) {
        let format = view.texture().format();
        let params = DisplayParams {
            exposure: how.exposure.exp2(),
            filmic: u32::from(how.tone == ToneCurve::Filmic),
            // Wider formats take linear values, sRGB formats encode by themselves.
            encode_srgb: u32::from(
                !format.is_srgb() && format.components() == 4 && format.block_copy_size(None) == Some(4),
            ),
            width: size[0],
            height: size[1],
            ..Default::default()
        };
        gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
        let group = gpu.bind(&self.layout, &[&self.params, film]);
        let pipeline = self.pipeline(gpu, format);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("display"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        }
        gpu.queue.submit([encoder.finish()]);
    }

    fn pipeline(&mut self, gpu: &Gpu, format: wgpu::TextureFormat) -> &wgpu::RenderPipeline {
        if let Some(known) = self.pipelines.iter().position(|(made_for, _)| *made_for == format) {
            return &self.pipelines[known].1;
        }
        let pipeline = display_pipeline(gpu, &self.layout, format);
        self.pipelines.push((format, pipeline));
        &self.pipelines[self.pipelines.len() - 1].1
    }
}

fn display_pipeline(gpu: &Gpu, layout: &wgpu::BindGroupLayout, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(DISPLAY.name),
        source: wgpu::ShaderSource::Wgsl(DISPLAY.source.into()),
    });
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(DISPLAY.name),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(DISPLAY.name),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover_target"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("show_pixel"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
