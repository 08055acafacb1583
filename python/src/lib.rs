//! The extension module of the Python package: gearboxes, points, studies and results as columns. The package itself is `gearloss/`,
//! which adds arrays of any shape, data frames and plots.

mod arrow;
mod distributed;
mod errors;
mod function;
mod gearbox;
mod json;
mod point;
mod points;
mod quantity;
mod reference;
mod study;
mod table;
mod work;

use pyo3::prelude::*;

/// What the package shares with the program.
#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::distributed::{Distribution, compute};
    #[pymodule_export]
    use crate::errors::{Findings, call};
    #[pymodule_export]
    use crate::function::add_function;
    #[pymodule_export]
    use crate::gearbox::{Gearbox, Transmission};
    #[pymodule_export]
    use crate::point::Solution;
    #[pymodule_export]
    use crate::quantity::quantity;
    #[pymodule_export]
    use crate::reference::{catalogue, models, schema};
    #[pymodule_export]
    use crate::study::{Outcome, Study};
    #[pymodule_export]
    use crate::table::{Column, Table};

    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // As Python writes it: 0.2.0rc1 is 0.2.0-rc.1 of Cargo.
        module.add("__version__", env!("CARGO_PKG_VERSION").replace("-rc.", "rc"))
    }
}
