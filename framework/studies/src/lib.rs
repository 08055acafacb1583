//! Studies of gearloss: documents, measured data, cycles, identification and analyses.

// For authors of analyses.
pub mod prelude;

// The document of a study, its data and its duties.
pub mod codes;
pub mod duty;
pub mod measured;
pub mod study;

// Sets of data that judge models.
pub mod corpus;

// Analyses: entries and outcomes, what computes them, how a study is run, results as columns.
pub mod analyses;
pub mod distributed;
pub mod engine;
pub mod results;
pub mod run;
pub mod table;
pub mod tasks;

// What `check` finds and `models --needs` lists.
pub mod bearings;
pub mod checked;
pub mod checked_study;
pub mod needs;

// What analyses share: corrections, limits of quantities, numbers in results, points, varied quantities, identification, fits of columns, lists
// without repetition.
pub mod correction;
pub mod distinct;
pub mod fit;
pub mod identify;
pub mod limits;
pub mod numbers;
pub mod pairs;
pub mod points;
pub mod ratings;
pub mod varied;
