//! The commands, each with its arguments beside it.

pub mod bake;
pub mod experiment;
pub mod inspect;
pub mod render;
