//! Selection of models by measured losses: combinations of the models of some mechanisms, cross-validated, ranked and weighted.
//!
//! Loss, loss torque and efficiency of a point are equivalent measurements, so there is one residual for each point: calculated loss minus
//! measured loss over the standard deviation of the measured loss. The accuracy of any of the three determines that of the loss exactly,
//! and no ranking depends on the one in the file.
//!
//! Losses of mechanisms are added, so that the loss of a combination is linear in the optional factors, one for each mechanism.

mod errors;
mod losses;
mod ranking;
mod shortlist;
mod winner;

pub use errors::LossErrors;
pub use losses::{Losses, MeasuredLosses};
pub use ranking::{Bounds, Combination, Printed, rank, validate};
pub use shortlist::{Shortlist, shortlist};
pub use winner::{Standing, Winner, compare_pair, winner};
