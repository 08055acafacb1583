//! Loss of gear meshes.

pub mod anderson_loewenthal;
pub mod efficiency;
pub mod even_share;
mod factor;
pub mod iso14179_1;
pub mod iso14179_2;
pub mod ohlendorf;
pub mod path_integral;
pub mod tabulated;
pub mod wimmer;
