//! Loss of chains and belts.

pub mod efficiency;
pub mod spicer;
pub mod typical;
