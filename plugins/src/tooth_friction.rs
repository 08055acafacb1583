//! Local friction between flanks.

pub mod xu;
