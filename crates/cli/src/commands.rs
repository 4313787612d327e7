//! The commands, each with its arguments beside it.

pub mod bake;
pub mod completions;
pub mod experiment;
pub mod inspect;
pub mod render;
