//! Laws fitted to tables of measured or computed values.

pub mod columns;
mod drag_law;
pub mod openfoam;

pub use drag_law::DragLaw;
