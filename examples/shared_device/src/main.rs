//! A window whose device diacaustic shares: the picture is rendered into a texture that egui shows, without leaving the GPU.
//!
//!     cargo run --release -p shared-device
//!
//! Sliders change the glass, the light and the energy map; each change starts the picture anew, and it gets better while you look.

mod ball;

use diacaustic::{Error, RenderParams, Renderer, RendererOptions, wgpu};
use eframe::{egui, egui_wgpu};

use crate::ball::{Controls, SIZE, ball};

/// Photons of a picture, and how many come between two frames.
const PHOTONS: u64 = 400_000;
const PHOTONS_A_FRAME: u64 = 50_000;
/// Samples of each pixel of a finished picture.
const SAMPLES: u32 = 64;

fn main() -> eframe::Result {
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    // Whatever egui needs as well is below these.
    setup.device_descriptor = std::sync::Arc::new(|_| wgpu::DeviceDescriptor {
        label: Some("shared device"),
        required_limits: Renderer::required_limits(),
        ..Default::default()
    });
    let mut options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_inner_size([860.0, 560.0]),
        ..Default::default()
    };
    options.wgpu_options.wgpu_setup = egui_wgpu::WgpuSetup::CreateNew(setup);
    eframe::run_native("diacaustic", options, Box::new(|context| Ok(Box::new(Viewer::new(context)?))))
}

/// The window's content.
struct Viewer {
    renderer: Renderer,
    controls: Controls,
    exposure: f32,
    /// What the renderer has been given.
    rendered: Option<Controls>,
    photons: u64,
    samples: u32,
    texture: wgpu::TextureView,
    image: egui::TextureId,
    /// What the last change led to, if it went wrong.
    failure: Option<Error>,
}

impl Viewer {
    fn new(context: &eframe::CreationContext<'_>) -> Result<Self, Box<dyn std::error::Error + Send + Sync>> {
        let state = context.wgpu_render_state.as_ref().ok_or("the window has no wgpu device")?;
        let renderer = Renderer::new(&state.device, &state.queue, &RendererOptions::default())?;
        let texture = state.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            // What egui takes; diacaustic encodes sRGB into it.
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let texture = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut egui_renderer = state.renderer.write();
        let image = egui_renderer.register_native_texture(&state.device, &texture, wgpu::FilterMode::Linear);
        Ok(Self {
            renderer,
            controls: Controls::default(),
            exposure: 2.0,
            rendered: None,
            photons: 0,
            samples: 0,
            texture,
            image,
            failure: None,
        })
    }

    /// Starts anew after a change, and goes on with photons, then with samples; a little of it each time.
    fn render(&mut self) -> Result<(), Error> {
        if self.rendered != Some(self.controls) {
            self.rendered = Some(self.controls);
            (self.photons, self.samples) = (0, 0);
            self.renderer.set_scene(&ball(&self.controls))?;
        }
        if self.photons < PHOTONS {
            self.renderer.emit_photons(self.photons..self.photons + PHOTONS_A_FRAME)?;
            self.photons += PHOTONS_A_FRAME;
            // A preview, lit by the photons so far.
            self.renderer.restart_samples()?;
            self.samples = 0;
        }
        if self.samples < SAMPLES {
            self.renderer.add_samples(1)?;
            self.samples += 1;
        }
        let params = RenderParams { exposure: self.exposure, ..RenderParams::default() };
        self.renderer.render_to_texture(&self.texture, &params)
    }

    fn show_controls(&mut self, ui: &mut egui::Ui) {
        ui.heading("diacaustic");
        let controls = &mut self.controls;
        ui.add(egui::Slider::new(&mut controls.index, 1.0..=2.5).text("index"));
        ui.add(egui::Slider::new(&mut controls.flux, 1.0..=100.0).text("light, W"));
        ui.add(egui::Slider::new(&mut controls.height, 1.0..=4.0).text("light's height, m"));
        ui.add(egui::Slider::new(&mut controls.map_size, 16..=1024).logarithmic(true).text("map, texels"));
        ui.add(egui::Slider::new(&mut self.exposure, -2.0..=6.0).text("exposure, stops"));
        ui.label(format!("{} photons, samples: {}", self.photons, self.samples));
        if let Some(failure) = &self.failure {
            ui.colored_label(egui::Color32::LIGHT_RED, failure.to_string());
        }
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if let Err(error) = self.render() {
            self.failure = Some(error);
        }
        egui::Panel::left("controls").show(ui, |ui| self.show_controls(ui));
        egui::CentralPanel::default().show(ui, |ui| {
            let side = ui.available_size().min_elem();
            ui.image(egui::load::SizedTexture::new(self.image, [side, side]));
        });
        if self.failure.is_none() && self.samples < SAMPLES {
            ui.ctx().request_repaint();
        }
    }
}
