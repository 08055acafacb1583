//! The frame of gearloss.
