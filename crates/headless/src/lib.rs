//! Opens a GPU without a window, for diacaustic's command line, tests and benches.
//!
//! The library crate `diacaustic` renders on a device that its application brings; this is how a program without one gets it.
//! wgpu's environment variables are heeded: `WGPU_BACKEND` (such as `vulkan` or `dx12,vulkan`) and `WGPU_ADAPTER_NAME` (a part
//! of a name, in any case).
//!
//! ```no_run
//! let gpu = diacaustic_headless::open(&diacaustic_headless::OpenOptions::default())?;
//! println!("rendering on {}", gpu.adapter_info.name);
//! # Ok::<(), diacaustic_headless::Error>(())
//! ```

use std::sync::{Arc, Mutex, PoisonError};

use diacaustic::Renderer;

/// Which adapter to open.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenOptions {
    /// A part of the adapter's name, in any case; if none, `WGPU_ADAPTER_NAME`, and if that is not set, wgpu's choice.
    pub adapter_name: Option<String>,
    /// Which adapter wgpu should choose.
    pub power_preference: wgpu::PowerPreference,
}

impl Default for OpenOptions {
    fn default() -> Self {
        Self { adapter_name: None, power_preference: wgpu::PowerPreference::HighPerformance }
    }
}

/// An open GPU.
#[derive(Debug)]
pub struct Gpu {
    /// What the adapter says about itself.
    pub adapter_info: wgpu::AdapterInfo,
    /// The device, with the limits that the renderer needs and buffers as large as the adapter allows.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    first_error: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// Reports the first error that the device raised outside every error scope, where wgpu would panic by default.
    ///
    /// # Errors
    /// If there was one.
    pub fn check(&self) -> Result<(), Error> {
        match self.first_error.lock().unwrap_or_else(PoisonError::into_inner).as_ref() {
            Some(problem) => Err(Error::Failed { adapter: self.adapter_info.name.clone(), problem: problem.clone() }),
            None => Ok(()),
        }
    }
}

/// Why there is no device, or no longer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The system has no adapter that wgpu can use.
    #[error(
        "no GPU adapter was found: install a driver for your GPU or, for any machine, Vulkan's loader and its software driver \
         (on Debian: apt-get install libvulkan1 mesa-vulkan-drivers)"
    )]
    NoAdapter(#[source] wgpu::RequestAdapterError),
    /// No adapter has the name asked for.
    #[error("no GPU adapter's name contains {name:?}; there are: {}", found.join(", "))]
    NoSuchAdapter {
        /// The part of a name that was asked for.
        name: String,
        /// The adapters that there are.
        found: Vec<String>,
    },
    /// The adapter opens no device with the limits that the renderer needs.
    #[error("the adapter {adapter} opens no device that diacaustic can use")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// What it says.
        source: wgpu::RequestDeviceError,
    },
    /// The device failed while it worked.
    #[error("the device of {adapter} failed: {problem}")]
    Failed {
        /// The adapter's name.
        adapter: String,
        /// What it says.
        problem: String,
    },
}

/// Opens an adapter and a device on it. Blocks: up to seconds, while drivers load.
///
/// # Errors
/// If there is no adapter, none of the name asked for, or it has not what the renderer needs.
pub fn open(options: &OpenOptions) -> Result<Gpu, Error> {
    pollster::block_on(open_async(options))
}

async fn open_async(options: &OpenOptions) -> Result<Gpu, Error> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = choose_adapter(&instance, options).await?;
    let adapter_info = adapter.get_info();
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("diacaustic"),
        required_limits: device_limits(&adapter.limits()),
        ..Default::default()
    };
    let (device, queue) = adapter
        .request_device(&descriptor)
        .await
        .map_err(|source| Error::NoDevice { adapter: adapter_info.name.clone(), source })?;
    let first_error = Arc::new(Mutex::new(None));
    let slot = Arc::clone(&first_error);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        slot.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| error.to_string());
    }));
    Ok(Gpu { adapter_info, device, queue, first_error })
}

async fn choose_adapter(instance: &wgpu::Instance, options: &OpenOptions) -> Result<wgpu::Adapter, Error> {
    let from_environment = || std::env::var("WGPU_ADAPTER_NAME").ok().filter(|name| !name.is_empty());
    if let Some(name) = options.adapter_name.clone().or_else(from_environment) {
        let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
        let found: Vec<_> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
        let wanted = name.to_lowercase();
        if let Some(index) = found.iter().position(|name| name.to_lowercase().contains(&wanted)) {
            return Ok(adapters.swap_remove(index));
        }
        if !found.is_empty() {
            return Err(Error::NoSuchAdapter { name, found });
        }
    }
    let request = wgpu::RequestAdapterOptions { power_preference: options.power_preference, ..Default::default() };
    instance.request_adapter(&request).await.map_err(Error::NoAdapter)
}

/// What the renderer needs, with buffers as large as the adapter allows.
fn device_limits(adapter: &wgpu::Limits) -> wgpu::Limits {
    let needed = Renderer::required_limits();
    wgpu::Limits {
        max_storage_buffer_binding_size: needed
            .max_storage_buffer_binding_size
            .max(adapter.max_storage_buffer_binding_size),
        max_buffer_size: needed.max_buffer_size.max(adapter.max_buffer_size),
        ..needed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buffers_grow_to_the_adapters_and_no_other_limit_does() {
        let needed = Renderer::required_limits();
        let adapter = wgpu::Limits {
            max_storage_buffer_binding_size: 1 << 40,
            max_buffer_size: 1 << 41,
            max_bind_groups: 32,
            ..needed.clone()
        };
        let asked = device_limits(&adapter);
        assert_eq!((asked.max_storage_buffer_binding_size, asked.max_buffer_size), (1 << 40, 1 << 41));
        assert_eq!(asked.max_bind_groups, needed.max_bind_groups);
        let small = wgpu::Limits { max_buffer_size: 1, ..needed.clone() };
        assert_eq!(device_limits(&small), needed);
    }

    #[test]
    fn a_missing_adapter_names_the_packages() {
        let error = Error::NoAdapter(wgpu::RequestAdapterError::EnvNotSet);
        assert!(error.to_string().contains("apt-get install libvulkan1 mesa-vulkan-drivers"));
    }
}
