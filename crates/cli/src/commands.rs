//! The commands, each with its arguments beside it.

pub mod inspect;
pub mod render;
