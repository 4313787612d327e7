//! The device, opened while the scene is read.

use std::{
    thread::JoinHandle,
    time::{Duration, Instant},
};

use diacaustic::Renderer;
use diacaustic_headless::Gpu;

use crate::{Error, device::DeviceArguments};

/// A device with a renderer on it.
pub(crate) struct Opened {
    pub gpu: Gpu,
    pub renderer: Renderer,
    /// Time that it took to open the device, and to compile the kernels of every scene.
    pub device: Duration,
    pub kernels: Duration,
}

/// A device that is being opened on a thread of its own.
pub(crate) struct Opening(Option<JoinHandle<Result<Opened, Error>>>);

impl Opening {
    /// Begins to open the device.
    pub fn begin(arguments: &DeviceArguments) -> Self {
        let arguments = arguments.clone();
        Self(Some(std::thread::spawn(move || open(&arguments))))
    }

    /// Blocks until the device is open.
    ///
    /// # Errors
    /// If there is none, or it cannot be used.
    pub fn finish(mut self) -> Result<Opened, Error> {
        match self.0.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(panic)) => std::panic::resume_unwind(panic),
            None => unreachable!("taken only here and when dropped"),
        }
    }
}

impl Drop for Opening {
    /// A process must not end while a driver starts.
    fn drop(&mut self) {
        if let Some(thread) = self.0.take() {
            let _ = thread.join();
        }
    }
}

fn open(arguments: &DeviceArguments) -> Result<Opened, Error> {
    let start = Instant::now();
    let gpu = arguments.open()?;
    let device = start.elapsed();
    let start = Instant::now();
    let renderer = Renderer::new(&gpu.device, &gpu.queue, &arguments.renderer_options())?;
    Ok(Opened { gpu, renderer, device, kernels: start.elapsed() })
}
