//! The names used by crates of loss models: `use gearloss_framework::prelude::*;`.
//!
//! This is the part of the framework with stability guarantees for other crates (CONTRIBUTING.md, "Stability").

pub use schemars::JsonSchema;
pub use serde::Deserialize;

pub use crate::attach::{Clearance, ClearanceSite, MemberSite, Oil, OnMember, Support, SupportSite};
pub use crate::document::Diagnostic;
pub use crate::loss::{Limit, Loss, Notes, Observed, Term, Undefined};
pub use crate::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
pub use crate::mechanism::bearing::{
    Bearing, BearingAt, BearingKind, BearingLaw, BearingModel, BearingPart, Lubrication,
};
pub use crate::mechanism::chain::{Chain, ChainAt, ChainKind, ChainLaw, ChainModel, ChainPart};
pub use crate::mechanism::clutch::{Clutch, ClutchAt, ClutchModel, ClutchPart};
pub use crate::mechanism::differential::{
    Differential, DifferentialAt, DifferentialGears, DifferentialLaw, DifferentialModel, DifferentialPart,
};
pub use crate::mechanism::gear_drag::{Covers, DragPart, GearBody, GearDrag, GearDragAt, GearDragModel, Scope};
pub use crate::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw, GearMeshModel, MeshPart};
pub use crate::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, HousingPart, WarmSide,
};
pub use crate::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel, HeatLinkPart};
pub use crate::mechanism::joint::{Joint, JointAt, JointKind, JointLaw, JointModel, JointPart};
pub use crate::mechanism::mean_friction::{MeanFriction, MeanFrictionAt, MeanFrictionLaw, MeanFrictionModel};
pub use crate::mechanism::planetary_drag::{PlanetaryDrag, PlanetaryDragAt, PlanetaryDragModel, PlanetaryPart};
pub use crate::mechanism::seal::{Seal, SealAt, SealKind, SealMaterial, SealModel, SealPart};
pub use crate::mechanism::synchronizer::{CouplingKind, CouplingPart, Synchronizer, SynchronizerAt, SynchronizerModel};
pub use crate::mechanism::tooth_friction::{
    Along, ContactAt, FrictionLimits, PathAt, PathExtent, PathNode, ToothFriction, ToothFrictionLaw, ToothFrictionModel,
};
pub use crate::mechanism::{
    Answers, Component, Lookup, Mechanism, ModelRef, NamedSlots, NoPart, Quantity, Scalar, ShopUnits, Slot,
};
pub use crate::rating::{Bound, Figure, Over, Rated, Rating};
pub use crate::real::{Mask, Points, Real};
pub use crate::registry::{
    Build, Catalogue, Check, Evidence, ShippedCycle, ShippedSet, default_of, formula, inventory,
};
pub use crate::table::{Interpolation, Outside, Reading};
pub use crate::{
    answered_by, coefficients, context, limits, observed, origin, register, register_component, register_mechanism,
    register_rating, terms,
};
