//! The device: which, and how much of its memory.

use std::convert::Infallible;

use bytesize::ByteSize;
use diacaustic::RendererOptions;
use diacaustic_headless::{AdapterChoice, Gpu, OpenOptions};

use crate::Error;

/// What every command that opens a device takes.
#[derive(Clone, Debug, Default, PartialEq, clap::Args)]
pub struct DeviceArguments {
    /// The GPU: its number in the list of `diacaustic inspect`, or a part of its name in any case
    ///
    /// Without it, WGPU_ADAPTER_NAME, and if that is not set, the fastest there is. WGPU_BACKEND (such as vulkan) says how GPUs are reached.
    #[arg(long, value_name = "NAME|NUMBER", value_parser = parse_adapter)]
    pub adapter: Option<AdapterChoice>,

    /// The most memory that scene, energy maps and film may take on the device, such as 512MiB or 4GB
    ///
    /// The sums of energy maps whose size the scene leaves open take a quarter of it at most; what still does not fit is refused, with the sizes.
    #[arg(long, value_name = "SIZE", value_parser = parse_size)]
    pub device_memory: Option<u64>,
}

fn parse_adapter(text: &str) -> Result<AdapterChoice, Infallible> {
    text.parse()
}

fn parse_size(text: &str) -> Result<u64, String> {
    let size = text.parse::<ByteSize>().map(|size| size.as_u64());
    size.ok().filter(|&bytes| bytes > 0).ok_or_else(|| "expected a size such as 512MiB or 4GB".to_owned())
}

impl DeviceArguments {
    /// Opens the device. Blocks.
    ///
    /// # Errors
    /// If there is none, or none that was asked for.
    pub fn open(&self) -> Result<Gpu, Error> {
        Ok(diacaustic_headless::open(&OpenOptions { adapter: self.adapter.clone(), ..OpenOptions::default() })?)
    }

    /// The options that the renderer gets.
    pub fn renderer_options(&self) -> RendererOptions {
        RendererOptions { memory: self.device_memory, ..RendererOptions::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        let read = ["1000", "64KiB", "512MiB", "4 GB", "1.5GiB"].map(parse_size);
        assert_eq!(read, [1000, 65_536, 512 << 20, 4_000_000_000, 3 << 29].map(Ok));
        for bad in ["", "0", "-1", "4 apples", "GB", "nan"] {
            assert!(parse_size(bad).is_err(), "{bad:?}");
        }
    }
}
