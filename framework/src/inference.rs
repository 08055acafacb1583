//! What a fit says of its parameters.

mod parameter;

pub use parameter::{Parameter, Scale, Side, Standing};
