//! Inference on the parameters of a fit: covariance, intervals, verdicts, checks of residuals, comparison of models.
//!
//! All functions use the residuals and their central Jacobian at the optimum, [`Fit`]; no solver is needed. Profiles need a function that
//! refits.

mod derived;
mod ensemble;
mod factors;
mod fit;
mod folds;
mod gamma;
mod interval;
mod lack_of_fit;
mod models;
mod normality;
mod paired;
mod parameter;
mod prediction;
pub mod probability;
mod profile;
mod profile_interval;
mod random_effects;
mod regions;
mod residuals;
mod robust;
mod separation;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
mod verdict;
mod words;

pub use derived::{Breakdown, Derived, hull};
pub use ensemble::{Draws, Ensemble, Marginal};
pub use fit::{Accuracy, Fit};
pub use folds::{FOLDS, Fold, Validation, folds, labelled_folds, random_folds};
pub use interval::Interval;
pub use lack_of_fit::{LackOfFit, PureError, pure_error};
pub use models::{Comparison, FLOOR, FittedModel, Reason, akaike, ranking};
pub use normality::{AndersonDarling, anderson_darling};
pub use paired::{Decision, Paired};
pub use parameter::{Parameter, Scale, Side, Standing};
pub use prediction::{Coverage, Prediction, Widening};
pub use profile::{Profile, ProfileEnd, ProfileFault, Reach, Refit};
pub use profile_interval::ProfileInterval;
pub use random_effects::{Further, Group};
pub use regions::{ErrorSummary, PlacedError, Region, regions};
pub use residuals::{BandMean, Succession, band_means, succession};
pub use robust::RobustRows;
pub use separation::{ErrorModel, PointSet, Separation, VISIBLE, neighbours};
pub use verdict::{Combination, Determination, Verdict};
