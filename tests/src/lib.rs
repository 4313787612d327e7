//! What the tests share: a device, scenes from text, renders, and comparisons.

mod comparison;
mod patterns;
mod render;
mod shared_files;

pub use comparison::{Comparison, compare_pictures, mean};
pub use patterns::{normal_pattern, pattern};
pub use render::{emit, gpu, photons_of, render, renderer, samples_of, scene};
pub use shared_files::{Layers, read_exr, repository, shared_file};
