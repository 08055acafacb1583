//! Loss of joints between shafts at an angle.

pub mod cross;
pub mod efficiency;
