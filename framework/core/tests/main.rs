//! Tests of the framework with its registered mechanisms, and a model of its own where one is needed.

mod crossed;
