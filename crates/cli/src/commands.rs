//! The commands, each with its arguments beside it.

pub mod bake;
pub mod inspect;
pub mod render;
