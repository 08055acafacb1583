//! Documents: from YAML text to nodes with places, and to values in SI by one walk along a compiled schema that collects all errors.

pub mod archive;
mod by_type;
mod code;
pub mod codes;
pub mod data;
mod diagnostic;
pub mod expression;
pub mod files;
mod misplaced;
mod node;
mod ordered;
mod places;
mod publish;
mod quantity;
mod schema;
mod unit;
mod visible;
mod walk;
mod yaml;

pub use by_type::records_by_type;
pub use code::{Code, CodeEntry};
pub use diagnostic::distance;
pub use diagnostic::{
    Diagnostic, FilePlace, PlacedDiagnostic, RelatedPlace, Severity, Sources, classify, did_you_mean,
};
pub use node::{Content, Key, Node, Span};
pub use ordered::Ordered;
pub use places::{Place, Places};
pub use publish::publish;
pub use quantity::{QuantityFault, number_length, parse_quantity};
pub use schema::{Field, Schema, Shape, Unsupported};
pub use unit::{Conversion, Dimension, Unit, UnitFault};
pub use visible::{visible, visible_json};
pub use walk::{Walked, walk, walk_at, walk_shape};
pub use yaml::{Read, read_yaml};
