//! The gearloss program.
fn main() {}
