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
//!
//! On Linux without a Wayland session, a layer of Mesa's prints `XDG_RUNTIME_DIR is invalid or not set` to the standard error while devices are listed. It means
//! nothing here; a program that sets the environment variable `NODEVICE_SELECT` to 1 before any thread starts, or is started with it, is rid of it.

use std::{
    convert::Infallible,
    str::FromStr,
    sync::{Arc, Mutex, PoisonError},
};

use diacaustic::Renderer;

/// Which adapter to open.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenOptions {
    /// Which of the system's adapters; if none, the one whose name `WGPU_ADAPTER_NAME` is a part of, and if that is not set, wgpu's choice.
    pub adapter: Option<AdapterChoice>,
    /// Which adapter wgpu should choose.
    pub power_preference: wgpu::PowerPreference,
}

impl Default for OpenOptions {
    fn default() -> Self {
        Self { adapter: None, power_preference: wgpu::PowerPreference::HighPerformance }
    }
}

/// One of the system's adapters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AdapterChoice {
    /// The first whose name has this part, in any case.
    Name(String),
    /// Its place in the list of [`adapters`].
    Number(usize),
}

impl FromStr for AdapterChoice {
    type Err = Infallible;

    /// A number, or else a part of a name.
    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(text.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Number))
    }
}

impl AdapterChoice {
    /// Which of the names it stands for, if any.
    fn among(&self, found: &[String]) -> Option<usize> {
        match self {
            Self::Name(part) => found.iter().position(|name| name.to_lowercase().contains(&part.to_lowercase())),
            Self::Number(number) => (*number < found.len()).then_some(*number),
        }
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
    #[error("no GPU adapter's name contains {name:?}; there are: {}", list(found))]
    NoSuchAdapter {
        /// The part of a name that was asked for.
        name: String,
        /// The adapters that there are.
        found: Vec<String>,
    },
    /// There are not so many adapters.
    #[error("there is no GPU adapter {number}; there are: {}", list(found))]
    NoAdapterNumber {
        /// The number that was asked for.
        number: usize,
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

/// The adapters' names with their numbers.
fn list(found: &[String]) -> String {
    let numbered = found.iter().enumerate().map(|(number, name)| format!("{number} {name}"));
    numbered.collect::<Vec<_>>().join(", ")
}

/// What the system's adapters say about themselves, in the order of their numbers. Blocks: up to seconds, while drivers load.
pub fn adapters() -> Vec<wgpu::AdapterInfo> {
    let found = pollster::block_on(instance().enumerate_adapters(wgpu::Backends::all()));
    found.iter().map(wgpu::Adapter::get_info).collect()
}

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env())
}

/// Opens an adapter and a device on it. Blocks: up to seconds, while drivers load.
///
/// # Errors
/// If there is no adapter, none of the name asked for, or it has not what the renderer needs.
pub fn open(options: &OpenOptions) -> Result<Gpu, Error> {
    pollster::block_on(open_async(options))
}

async fn open_async(options: &OpenOptions) -> Result<Gpu, Error> {
    let adapter = choose_adapter(&instance(), options).await?;
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
    if let Some(choice) = options.adapter.clone().or_else(|| from_environment().map(AdapterChoice::Name)) {
        let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
        let found: Vec<_> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
        if let Some(index) = choice.among(&found) {
            return Ok(adapters.swap_remove(index));
        }
        if !found.is_empty() {
            return Err(match choice {
                AdapterChoice::Name(name) => Error::NoSuchAdapter { name, found },
                AdapterChoice::Number(number) => Error::NoAdapterNumber { number, found },
            });
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
    fn adapters_are_chosen_by_name_or_number() {
        let found = ["NVIDIA A".to_owned(), "llvmpipe (LLVM 15)".to_owned()];
        let chosen =
            ["nvidia", "LLVM", "1", "2", "intel"].map(|text| text.parse().map(|c: AdapterChoice| c.among(&found)));
        assert_eq!(chosen, [Some(0), Some(1), Some(1), None, None].map(Ok));
        let error = Error::NoAdapterNumber { number: 2, found: found.into() };
        assert_eq!(error.to_string(), "there is no GPU adapter 2; there are: 0 NVIDIA A, 1 llvmpipe (LLVM 15)");
    }

    #[test]
    fn a_missing_adapter_names_the_packages() {
        let error = Error::NoAdapter(wgpu::RequestAdapterError::EnvNotSet);
        assert!(error.to_string().contains("apt-get install libvulkan1 mesa-vulkan-drivers"));
    }
}
