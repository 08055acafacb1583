//! The gearloss program.
