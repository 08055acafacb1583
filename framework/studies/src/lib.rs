//! Studies of gearloss: documents, measured data, cycles, identification and analyses.
//!
//! [`Study`](study::Study) is a study as read and checked, with its gearboxes. [`StudyRun`](run::StudyRun) computes the outcomes of
//! its analyses, each of a type of its own with tables of columns. An analysis of your own is a file of your crate: it implements
//! [`Entry`](analyses::Entry), [`Analysis`](analyses::Analysis) and [`Outcome`](analyses::Outcome), whose names [`prelude`] has, and
//! registers itself with [`register_analysis!`](crate::register_analysis).

// For authors of analyses.
pub mod prelude;

// The document of a study, its data and its duties.
pub mod codes;
pub mod duty;
pub mod measured;
pub mod study;

// Analyses: how a study is run, entries and outcomes, results as columns.
pub mod analyses;
pub mod results;
pub mod run;
pub mod table;
pub mod tasks;

// What analyses share: points, varied quantities, identification, fits of columns.
pub mod analysis;
pub mod fit;
pub mod identify;
pub mod varied;
