//! The framework of gearloss: description, registry, kinematics, loads, evaluation. It does not refer to any concrete loss model.
//!
//! # Your own model
//! A model is a struct with its parameters, an `impl` of the trait of its mechanism, and a registration. [`prelude`] has all names
//! that it needs. The doc comments become the schema, the tooltips of editors and the reference; a doc comment of a quantity ends
//! with its unit.
//!
//! ```
//! use gearloss_framework::prelude::*;
//!
//! terms! { DRAG = no_load("drag"); }
//!
//! /// Seal with a friction torque proportional to the diameter.
//! #[derive(Debug, Deserialize, JsonSchema)]
//! struct Proportional {
//!     /// Friction torque per diameter. [N]
//!     #[schemars(range(min = 0.0, max = 100.0))]
//!     force: f64,
//! }
//!
//! impl SealModel for Proportional {
//!     fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
//!         Ok(Loss::MOMENTS.with(&DRAG, self.force * at.part.diameter))
//!     }
//! }
//!
//! register!(Seal, "proportional", Proportional,
//!     source: "rig report 31, 2026",
//!     example: "{ type: proportional, force: 0.5 }",
//!     evidence: [formula(Evidence::OneSource, "one seal, one oil")],
//!     checks: [
//!         Check {
//!             input: "{ part: { diameter: 40 mm }, at: { speed: 1000 rpm } }",
//!             values: &[("moment", "0.02 Nm")],
//!             tolerance: 1e-12,
//!             because: "the product is exact",
//!             source: "by hand: 0.5 N at 40 mm",
//!         },
//!     ],
//!     terms: [DRAG]);
//!
//! // In a test of the crate: evaluates the check values, and requirements of the framework on a grid of inputs.
//! gearloss_framework::testing::conformance();
//! ```
//!
//! The guide to your own models (`docs/plugin-guide.md`) continues with ranges, files, nested models and mechanisms.
//!
//! A model in `f64` is evaluated point by point. A law over [`Real`](real::Real), such as a
//! [`BearingLaw`](mechanism::bearing::BearingLaw), serves one point and several points of a map with the same text and the same bits.
//!
//! # From a file to a point
//! [`Language`](language::Language) defines the valid documents. [`Gearbox`](gearbox::Gearbox) is a document as read and checked,
//! [`Resolved`](resolve::Resolved) the same with catalogue values and a model for every component under a
//! [`Choice`](resolve::Choice), [`Transmission`](transmission::Transmission) the result with indices and built models. It evaluates
//! points without allocating. Programs find these names in `gearloss::api`.

// For authors of models.
pub mod prelude;
pub mod testing;

// Contents of a document: sections, schemas, models, choices.
pub mod checks;
pub mod codes;
pub mod coefficients;
pub mod description;
pub mod eval;
pub mod formula;
pub mod function;
pub mod gearbox;
pub mod generic;
pub mod language;
pub mod registry;
pub mod resolve;
pub mod table;

// What loses power: mechanisms, where their parts are attached, and what models return.
pub mod attach;
pub mod conformance;
pub mod loss;
mod maker;
pub mod mechanism;
pub mod rating;
mod registration;

// What models and the solver calculate with: numbers, teeth, contacts, rolling bearings, oils, motors.
pub mod contact;
pub mod geometry;
pub mod hydraulics;
pub mod immersion;
pub mod lubricant;
pub mod machine;
pub mod material;
pub mod motor;
mod random;
pub mod real;
pub mod rolling;
pub mod sump;

// The solver: speeds, torques, bearing loads, points, temperatures.
pub mod evaluate;
pub mod flow;
mod kinematics;
pub mod loads;
pub mod thermal;
pub mod transmission;
pub mod variants;

pub use gearloss_document as document;
pub use gearloss_document::files;
pub use schemars;
