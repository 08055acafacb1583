//! Tables and models of other programs.
